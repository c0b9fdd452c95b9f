"""Somebody at the trainer's page, who chooses, begins, reads cards and looks at films."""

import time

PATIENCE = 120.0  # [s] for a page drawn by software on a busy machine; nothing here is about speed


class Trainee:
    """Somebody at the page."""

    def __init__(self, page, watcher):
        self.page, self.watcher = page, watcher

    def until(self, told, what):
        end = time.monotonic() + PATIENCE
        while not told():
            assert time.monotonic() < end, f"it never came to this: {what}"
            self.page.wait_for_timeout(30)

    def button(self, name):
        return self.page.get_by_role("button", name=name, exact=True)

    def choose(self, name, level=1, who="Ada"):
        self.button("Choose a task").or_(self.button("Another task")).click()
        self.page.wait_for_selector("#choose[open]")
        self.page.fill("#trainee", who)
        self.page.check(f"input[value='{name} {level}']")
        self.button("Go on").click()

    def begin(self, button="Begin"):
        """Begin the attempt and return its number."""
        before = self.watcher.guiding["attempt"] if self.watcher.guiding else 0
        self.button(button).click()
        self.until(
            lambda: self.watcher.guiding is not None and self.watcher.guiding["attempt"] > before,
            "the attempt begins",
        )
        return self.watcher.guiding["attempt"]

    def card(self):
        """Wait for the score card and return the verdict."""
        self.page.wait_for_selector("#card[open]", timeout=1e3 * PATIENCE)
        return self.page.inner_text("#card .verdict")

    def kept(self, number):
        """Return what the trainer keeps of an attempt."""
        return self.page.request.get(f"{self.page.url.partition('?')[0]}api/attempts/{number}").json()

    def figures_are_drawn(self, where):
        """Wait until every picture in a dialog is there, and large."""
        self.until(
            lambda: all(
                self.page.locator(f"{where} figure img").evaluate_all(
                    "all => all.map((each) => each.complete && each.naturalWidth > 300)"
                )
            ),
            f"the pictures of {where}",
        )
        assert self.page.locator(f"{where} figure img").count() >= 2

    def squeezes(self, hands):
        """Begin the attempt with both triggers and return its number."""
        before = self.watcher.guiding["attempt"] if self.watcher.guiding else 0
        hands.squeeze(1.0)
        self.until(
            lambda: self.watcher.guiding is not None and self.watcher.guiding["attempt"] > before, "it begins"
        )
        hands.squeeze(0.0)
        return self.watcher.guiding["attempt"]

    def looks_half_a_second_before_a_step_was_done(self, steps):
        """Let a film begin that shows two attempts, and put its timeline to where the tip pressed."""
        page = self.page
        page.wait_for_selector("#beside:not([hidden])", timeout=1e3 * PATIENCE)
        self.until(lambda: not page.inner_text("#film-told").startswith("0.0"), "the film runs")
        duration = float(page.get_attribute("#film-time", "max"))
        share = page.locator("#film-ticks .step").evaluate_all(
            "all => all.map((each) => parseFloat(each.style.left))"
        )
        assert len(share) == steps
        done = 0.01 * share[0] * duration
        page.locator("#film-time").fill(f"{0.04 * round((done - 0.5) / 0.04):.2f}")
        self.until(
            lambda: "touching" in page.inner_text("#bars"),
            "half a second before it was done the tip pressed",
        )
        both = [page.locator(each).screenshot() for each in ("#canvas", "#beside-canvas")]
        assert both[0] != both[1]

    def closes_the_film(self):
        self.page.locator("#film-close").click()
        assert not self.page.locator("#beside").is_visible()
        self.until(lambda: "free" in self.page.inner_text("#bars"), "the live tissue is there again")

    def closes(self, dialog):
        self.page.locator(dialog).get_by_role("button", name="Close", exact=True).click()
        assert not self.page.locator(dialog).is_visible()
