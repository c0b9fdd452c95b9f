"""A trainee in an emulated headset who does as he is told: each controller is a handle, its trigger the jaw.

The board that eyes in a headset see is a canvas, so `BOARD` keeps what is written on it; it is run in the page first.
"""

import numpy as np

from browser.obedient import ABOVE, Obedient

FARTHEST = 0.03  # [m] that a hand goes in one movement
BOARD = """
  window.written = [];
  const {fillRect, fillText} = CanvasRenderingContext2D.prototype;
  CanvasRenderingContext2D.prototype.fillRect = function (...given) {  // the board is wiped
    window.written = [];
    fillRect.apply(this, given);
  };
  CanvasRenderingContext2D.prototype.fillText = function (text, ...given) {
    window.written.push(text);
    fillText.call(this, text, ...given);
  };
"""
SIDES = ("left", "right")


class ByControllers(Obedient):
    """Hands that hold both controllers of a headset whose session has begun."""

    def __init__(self, page, watcher):
        super().__init__(page, watcher)
        place = "(side) => (({x, y, z}) => [x, y, z])(xrDevice.controllers[side].position)"
        self.places = [np.array(page.evaluate(place, side)) for side in SIDES]

    def board(self):
        """Return what stands on the board."""
        return " ".join(self.page.evaluate("written"))

    def squeeze(self, share):
        """Squeeze both triggers."""
        for side in SIDES:
            self.trigger(side, share)

    def trigger(self, side, share):
        self.page.evaluate(
            "([side, share]) => xrDevice.controllers[side].updateButtonValue('trigger', share)", [side, share]
        )

    def raised(self):
        """Raise tips that are low, and return whether both are out of the tissue."""
        self.state = self.watcher.look()
        low = [hand for hand in (0, 1) if self.tip(hand)[2] < 0.5 * ABOVE]
        for hand in low:
            self.move(hand, [*self.tip(hand)[:2], ABOVE], seen=self.tip(hand))
        return not low

    def take(self, hand):
        """Do nothing: both hands hold theirs all the time."""

    def jaw(self, hand, *, is_open):
        self.trigger(SIDES[hand], 0.0 if is_open else 1.0)

    def send(self, hand, to, *, seen):
        """Move a controller as the handle has to, x to the right, y up, z towards the trainee."""
        step = self.handle(hand, np.asarray(to)) - self.handle(hand, np.asarray(seen))
        x, y, z = step * min(1.0, FARTHEST / max(np.linalg.norm(step), 1e-9))
        self.places[hand] = self.places[hand] + np.array([x, z, -y])
        self.page.evaluate(
            "([side, [x, y, z]]) => xrDevice.controllers[side].position.set(x, y, z)",
            [SIDES[hand], self.places[hand].tolist()],
        )

    def handle(self, hand, tip):
        """Return where the handle is of a tip at a place [m]."""
        shape = self.watcher.hello["instruments"][hand]
        out = np.array(shape["port_m"]) - tip
        return tip + shape["length_m"] * out / np.linalg.norm(out)
