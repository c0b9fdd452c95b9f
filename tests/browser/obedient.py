"""A trainee who does as he is told: the marks, the bars and the hint, and no more.

The hint says what would bring the step nearer; a hand that sees where its tip is and how hard it presses obeys it. What
the hand holds, a mouse or a headset's controller, is said by who inherits.
"""

import re
import time
from abc import ABC, abstractmethod

import numpy as np

ABOVE = 9e-3  # [m] over the tissue, on the way to a mark: a swing about the port dips
LATEST = 3.0  # [s] after which a movement is seen, by a page drawn by software
AT_REST = 5e-5  # [m] that a tip at rest may move
RESTING = 0.06  # [s] after which it is taken to rest
FOLLOWED = 0.25  # [s] in which a tip that may follow has followed, once the trainer has the pose
AHEAD = 4  # marks from where a cut ends to a bite further on
SIDES = {"left": 0, "right": 1}


class Obedient(ABC):
    """Hands at a page.

    Args:
        page: of the trainer.
        watcher: what is seen of tips and forces, and what is said.
        lump: where something hidden lies [m]: a mouse has no feeling, so it is told.
    """

    def __init__(self, page, watcher, lump=None):
        self.page, self.watcher, self.lump = page, watcher, lump
        self.going = None  # where a gliding tip is on its way to [m]
        self.state = watcher.look()

    @abstractmethod
    def take(self, hand):
        """Be about to use a hand."""

    @abstractmethod
    def jaw(self, hand, *, is_open):
        """Open a jaw, or close it."""

    @abstractmethod
    def send(self, hand, to, *, seen):
        """Move a tip that was seen at a place [m] to another, without waiting for it."""

    def do(self, number, patience):
        """Do the attempt of a number as it is asked for; return the last that was said."""
        end = time.monotonic() + patience
        while time.monotonic() < end:
            said = self.watcher.guiding
            self.state = self.watcher.look()
            if said is None or said["attempt"] != number:
                continue
            if said["state"] != "running":
                return said
            self.obey(said)
        raise AssertionError(f"not done in {patience} s: {self.watcher.guiding}")

    def obey(self, said):
        hint = said["hint"]
        side, _, rest = hint.partition(": ")
        if side.lower() in SIDES:
            hand, hint = SIDES[side.lower()], rest
        else:
            hand = SIDES[re.search(r"the (left|right) (?:hand|jaw)", said["words"])[1]]
        marks = [mark for mark in said["marks"] if SIDES[mark["hand"]] == hand]
        self.take(hand)
        tip, force = self.tip(hand), float(np.linalg.norm(self.state.instruments[hand].force))
        next_bite = min(AHEAD, len(marks) - 1) if "scissors" in said["words"] else 0
        place = np.array(marks[next_bite]["place_m"]) if marks else tip[:2]
        least, most = said["least_n"][hand], said["most_n"][hand]
        wanted = min(0.5 * (least + most), 0.038) if most else 0.03
        match hint:
            case "Go to the mark." | "Go to the mark, jaw open." | "Go to where the cut ends, blades open.":
                self.jaw(hand, is_open=True)
                away = np.hypot(*(place - tip[:2]))
                height = self.height(tip)
                up = ABOVE if away > 2 * marks[0]["radius_m"] else max(height, 0.5e-3)
                self.move(hand, self.over(place if height > 0.6 * up else tip[:2], up), seen=tip)
            case "Keep touching it.":
                self.press(hand, tip[:2], tip, force, wanted)
            case "Down, until it touches." | "Touch the line." | "Press lightly, jaw open.":
                self.press(hand, place, tip, force, wanted)
            case "A little harder." | "Softer.":
                self.press(hand, place, tip, force, wanted)
            case "On along the line." if force < 0.7 * wanted:
                self.press(hand, tip[:2], tip, force, wanted)
            case "On along the line.":
                self.glide(hand, marks, tip, force, wanted)
            case "Hold it so.":
                if least and not 0.8 * wanted < force < 1.3 * wanted:
                    self.press(hand, tip[:2], tip, force, wanted)
            case "Close the jaw on it." | "Close the blades.":
                self.jaw(hand, is_open=False)
            case "On along the line, by a bite.":
                self.move(hand, [*place, tip[2]], seen=tip)
            case "Feel where less gives way, and close the jaw on it there.":
                self.take_hold(hand, np.array(self.lump), tip, force, wanted)
            case "Raise it, straight up.":
                self.move(hand, [*place, tip[2] + 1.2e-4], seen=tip)
            case (
                "Open the jaw."
                | "Open the blades."
                | "Open the jaw again: it closed on nothing."
                | "Nothing is here. Open the jaw, and feel on."
            ):
                self.jaw(hand, is_open=True)
            case "Up.":
                self.move(hand, [*tip[:2], tip[2] + 1e-3], seen=tip)
            case _ if hint.endswith("tip out of the tissue first."):
                self.move(hand, self.over(tip[:2], ABOVE), seen=tip)
            case _:
                assert hint in {"", "Get ready."}, f"nobody knows what to do at {hint!r}"

    def glide(self, hand, marks, tip, force, wanted):
        """Go on by a little from where the hand is going anyway, without waiting to see it."""
        if self.going is None or np.linalg.norm(self.going - tip) > 2e-3:
            self.going = tip
        ahead = np.array(marks[min(6, len(marks) - 1)]["place_m"])
        way = ahead - self.going[:2]
        way *= min(1.0, 8e-4 / max(np.hypot(*way), 1e-9))
        down = np.clip((wanted - force) / 2000.0, -1e-5, 1e-5)
        seen, self.going = self.going, self.going + np.array([*way, -down])
        self.send(hand, self.going, seen=seen)
        self.page.wait_for_timeout(40)

    def press(self, hand, place, tip, force, wanted):
        """Bring the force nearer to what is wanted, at a place."""
        self.going = None
        way = place - tip[:2]
        if force == 0.0:  # the surface is near zero; from there on it is felt
            height = self.height(tip)
            down = height - 2e-4 if height > 4e-4 else 8e-5
        else:
            down = np.clip((wanted - force) / 350.0, -2e-4, 6e-5)  # [N/m] stiffer than the tissue is
        self.move(hand, self.over(tip[:2] + way, self.height(tip) - down), seen=tip)

    def take_hold(self, hand, place, tip, force, wanted):
        """Close the jaw on the tissue at a place, once it is pressed a little."""
        away = np.hypot(*(place - tip[:2]))
        if force == 0.0 and away > 1e-3:
            self.move(hand, self.over(place if self.height(tip) > 0.6 * ABOVE else tip[:2], ABOVE), seen=tip)
        elif force < 0.5 * wanted:
            self.press(hand, place, tip, force, wanted)
        else:
            self.jaw(hand, is_open=False)

    def ground(self, place):
        """Return how high the lowest point of a round tip is when it touches the tissue at rest at a place [m]."""
        if self.watcher.hello["shape"] is None:
            return 0.0
        step = 1e-3
        slope = [
            (self.drawn(np.add(place, way)) - self.drawn(np.subtract(place, way))) / (2 * step)
            for way in ((step, 0.0), (0.0, step))
        ]
        radius = max(one["shaft_radius_m"] for one in self.watcher.hello["instruments"])
        return self.drawn(place) + radius * (np.sqrt(1 + np.dot(slope, slope)) - 1)

    def drawn(self, place):
        """Return how high an organ at rest is drawn at a place [m]."""
        hello = self.watcher.hello
        nx, ny = hello["grid"]
        i, j = np.clip(
            np.asarray(place) / hello["tissue"]["size_m"] * (nx - 1, ny - 1), 0, (nx - 1.001, ny - 1.001)
        )
        rest = np.array(hello["shape"]["rest_m"], dtype=float).reshape(ny, nx)
        a, b = i % 1, j % 1
        corners = rest[int(j) : int(j) + 2, int(i) : int(i) + 2]
        return float(np.nan_to_num([1 - b, b] @ corners @ [1 - a, a]))

    def height(self, tip):
        """Return how high a tip is over the tissue at rest [m]."""
        return tip[2] - self.ground(tip[:2])

    def over(self, place, height):
        """Return the place so high over the tissue [m]."""
        return [*place, self.ground(place) + height]

    def tip(self, hand):
        return np.array(self.state.instruments[hand].tip)

    def move(self, hand, to, *, seen):
        """Move the tip to a place [m], as far as one movement brings it, and wait until it is there."""
        self.send(hand, to, seen=seen)
        self.see(hand, seen, np.linalg.norm(np.asarray(to) - seen))

    def see(self, hand, seen, distance):
        """Wait until most of a movement is seen and the tip rests, or until no more will come: tissue holds back."""
        before = self.state.pose_sequence[hand]
        rests, since = np.array(seen), time.monotonic()
        end = time.monotonic() + LATEST
        while time.monotonic() < end:
            self.page.wait_for_timeout(5)
            self.state = self.watcher.look()
            if np.linalg.norm(self.tip(hand) - rests) > AT_REST:
                rests, since = self.tip(hand), time.monotonic()
            moved = np.linalg.norm(self.tip(hand) - seen) > 0.7 * distance
            if moved and time.monotonic() - since > RESTING:
                return
            if self.state.pose_sequence[hand] > before:
                before, end = self.state.pose_sequence[hand], min(end, time.monotonic() + FOLLOWED)
