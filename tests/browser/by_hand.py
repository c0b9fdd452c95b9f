"""A trainee at the page who does as he is told with mouse and keyboard.

Tips follow the mouse by the lever: across the view the tip goes the other way, the wheel slides it in and out.
"""

import numpy as np

from browser.obedient import SIDES, Obedient

FIELD = np.radians(72)  # of the endoscope's view
WORKING_DISTANCE = 0.07  # [m] from eye to target
TWO_FRAMES = "() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"
NOTCH = 100 / 0.002  # [px/m] of the wheel


class ByHand(Obedient):
    """Hands on mouse and keyboard; the picture must be focused."""

    def __init__(self, page, watcher, lump=None):
        super().__init__(page, watcher, lump)
        self.box = page.locator("#picture").bounding_box()
        self.active = SIDES[page.inner_text("#active").split()[0]]
        self.jaw_open = [True, True]
        self.mouse = None
        page.keyboard.press("c")

    def take(self, hand):
        """Change hands."""
        if hand != self.active:
            self.page.keyboard.press("Tab")
            self.active = hand

    def jaw(self, hand, *, is_open):
        if self.jaw_open[hand] != is_open:
            self.take(hand)
            self.page.keyboard.press("Space")
            self.jaw_open[hand] = is_open

    def send(self, hand, to, *, seen):
        """Move the mouse so that the tip goes to a place [m]."""
        shape = self.watcher.hello["instruments"][hand]
        port = np.array(shape["port_m"])
        along = seen - port
        inside = np.linalg.norm(along)
        along = along / inside
        ratio = inside / (shape["length_m"] - inside)
        delta = np.asarray(to) - seen
        slide = float(delta @ along)
        beside = delta - slide * along
        camera = self.watcher.hello["camera"]
        forward = np.subtract(camera["target_m"], camera["port_m"])
        forward /= np.linalg.norm(forward)
        right = np.cross(forward, [0, 0, 1.0])
        right /= np.linalg.norm(right)
        up = np.cross(right, forward)
        pixel = 2 * WORKING_DISTANCE * np.tan(FIELD / 2) / self.box["height"]
        self.shift(-float(beside @ right) / (ratio * pixel), float(beside @ up) / (ratio * pixel))
        if abs(slide) > 1e-6:
            self.page.mouse.wheel(0, -slide * NOTCH)

    def see(self, hand, seen, distance):
        self.page.evaluate(TWO_FRAMES)  # a slow page takes a mouse and its wheel in different ones
        super().see(hand, seen, distance)

    def shift(self, right, down):
        """Move the mouse by so much [px]; before it would leave the picture it is put back to the middle."""
        middle = np.array([self.box["x"] + self.box["width"] / 2, self.box["y"] + self.box["height"] / 2])
        reach = 0.45 * min(self.box["width"], self.box["height"])
        step = np.clip([right, down], -reach, reach)
        if self.mouse is None or np.abs(self.mouse + step - middle).max() > reach:
            self.page.mouse.move(1.0, 1.0)  # off the picture: coming back elsewhere moves nothing
            self.mouse = middle - 0.5 * step
            self.page.mouse.move(*self.mouse)
        self.mouse = self.mouse + step
        self.page.mouse.move(*self.mouse)
