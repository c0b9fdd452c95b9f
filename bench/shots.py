"""Take pictures of the running trainer with headless Chromium (make shots).

They are of rest, press, slide, lift, oblique ports, a headset and an organ.

A trainer's stream is filmed as it runs, without a browser, and the best moments are chosen. Then the trainer's own
page is opened, with the trainer behind it, and is shown those very frames and no others until it has drawn each: so a
machine without a graphics processor, which draws a frame in a second or two, gets the same pictures as a fast one.

Without an address it starts `trocar train` itself, twice: with the recording of a press, a slide and a lift, and with
simulated hands through oblique ports. With --address it films the trainer that runs there: anything that presses,
slides and lifts within --seconds. That gives all but the oblique picture, which needs other ports, and the organ.
There the page's own hand presses, by the wheel.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import urlsplit

from browsing import chromium
from film import Moment, choose, film
from playwright.sync_api import BrowserContext, Page, WebSocketRoute

ROOT = Path(__file__).parents[1]
RECORDING = ROOT / "examples" / "press-slide-lift.csv"
EMULATOR = ROOT / "client" / "node_modules" / "iwer" / "build" / "iwer.min.js"
OUT = ROOT / "docs" / "_static" / "trainer"
WINDOW = {"width": 1280, "height": 800}  # [px]
STARTING = 400.0  # the first start compiles the tick, or prepares an organ [s]
ORGAN_FORCE = 0.06  # [N] on the organ in its picture
STOPPING = 15.0  # [s]
LEAN = "xrDevice.position.set(0, 1.34, -0.23)"  # towards the block, as one does to see 60 mm of it
PATIENCE = 120_000  # until a page has drawn what it was given [ms]
HEADSET = """
;window.xrDevice = new IWER.XRDevice(IWER.metaQuest3);
xrDevice.installRuntime({forceInstall: true});
xrDevice.stereoEnabled = true;
xrDevice.position.set(0, 1.6, 0);
xrDevice.quaternion.set(-0.389, 0, 0, 0.921);
window.xrTurns = 0;
const ask = XRSession.prototype.requestAnimationFrame;
XRSession.prototype.requestAnimationFrame = function (turn) {
  return ask.call(this, (...given) => { turn(...given); window.xrTurns += 1; });
};
"""  # the head looks down by 46 degrees, towards where the block is put


class ShotError(Exception):
    """A picture could not be taken; the message says why in a sentence."""


@contextmanager
def trainer(*options: str) -> Iterator[str]:
    """Run `trocar train`, and yield its address."""
    command = [sys.executable, "-m", "trocar", "train", *options, "--no-browser", "--port", "0"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT)
    late = threading.Timer(STARTING, process.kill)
    late.start()
    try:
        assert process.stdout is not None
        address = next((line.strip() for line in process.stdout if line.startswith("http")), None)
        late.cancel()
        if address is None:
            raise ShotError(
                f"`trocar train {' '.join(options)}` printed no address; what it said stands above"
            )
        yield address
    finally:
        late.cancel()
        process.terminate()
        try:
            process.wait(STOPPING)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        process.stdout.close()


class Stage:
    """Stands between the page and its trainer: the page sees the frames it is shown, the trainer a page that keeps up.

    Args:
        page: not opened yet.
    """

    def __init__(self, page: Page) -> None:
        self._page = page
        self._route: WebSocketRoute | None = None
        self._shown = 0
        self._drawn = 0
        page.route_web_socket("**/live", self._connect)

    def show(self, moment: Moment) -> None:
        """Show a moment and wait until the page has drawn it.

        Raises:
            ShotError: it did not.
        """
        until(self._page, lambda: self._route is not None, "the page never asked for the stream")
        for _ in range(2):  # when it takes the second, the first has been drawn: it is the same picture
            self._shown += 1
            frame = moment.frame[:4] + self._shown.to_bytes(4, "little") + moment.frame[8:]
            self._route.send(frame)
            until(self._page, lambda: self._drawn >= self._shown, "the page did not draw a frame")
        self._page.wait_for_timeout(300)  # figures beside the picture change ten times a second

    def _connect(self, route: WebSocketRoute) -> None:
        server = route.connect_to_server()

        def from_server(message: str | bytes) -> None:
            if isinstance(message, bytes):
                sequence = int.from_bytes(message[4:8], "little")
                server.send(json.dumps({"type": "ack", "sequence": sequence}))
            else:
                route.send(message)
                self._route = route  # the greeting comes first; frames may follow it

        def from_page(message: str | bytes) -> None:
            if isinstance(message, bytes):
                server.send(message)
            elif (told := json.loads(message))["type"] == "ack":
                self._drawn = told["sequence"]

        server.on_message(from_server)
        route.on_message(from_page)


def until(page: Page, told: Callable[[], object], otherwise: str) -> None:
    """Wait until something is so.

    Raises:
        ShotError: it never was.
    """
    for _ in range(PATIENCE // 50):
        if told():
            return
        page.wait_for_timeout(50)
    raise ShotError(otherwise)


def wait_for_turns(page: Page) -> None:
    """Wait until the headset has been drawn for some more turns."""
    reached = page.evaluate("xrTurns") + 3
    until(page, lambda: page.evaluate("xrTurns") >= reached, "the headset was not drawn")


def photograph(
    context: BrowserContext, origin: str, moments: dict[str, Moment], out: Path, script: str = ""
) -> None:
    """Open a trainer's page and write a picture of every moment.

    Args:
        context: holds the cookie.
        origin: the trainer's.
        moments: by the pictures' names.
        out: the folder.
        script: a headset's emulator, to show the moments in it.
    """
    page = context.new_page()
    try:
        if script:
            page.add_init_script(script)
        stage = Stage(page)
        page.goto(origin)
        page.select_option("#sharpness", "sharp")
        if script:
            page.get_by_role("button", name="Enter the headset").click()
            said = "document.getElementById('headset').textContent"
            until(
                page,
                lambda: page.evaluate(said) == "Leave the headset",
                "the headset's session did not begin",
            )
            wait_for_turns(page)  # the block is put before the head when that is first tracked
            page.evaluate(LEAN)
            wait_for_turns(page)
        for name, moment in moments.items():
            stage.show(moment)
            out.mkdir(parents=True, exist_ok=True)
            path = out / f"{name}.jpg"
            image = page.screenshot(path=path, type="jpeg", quality=88, timeout=PATIENCE)
            print(f"{path}: {len(image) / 1000:.0f} kB", flush=True)
    finally:
        page.close()


def filmed(
    context: BrowserContext, address: str, seconds: float, *names: str
) -> tuple[str, dict[str, Moment]]:
    """Exchange the token, film, and return the trainer's origin and the moments of some names.

    Raises:
        ShotError: one of them did not come.
    """
    context.request.get(address)  # the token becomes a cookie
    origin = "{0.scheme}://{0.netloc}".format(urlsplit(address))
    cookie = "; ".join(f"{each['name']}={each['value']}" for each in context.cookies(origin))
    moments = film(origin, cookie, seconds)
    found = choose(moments)
    missing = [name for name in names if name not in found]
    if missing:
        raise ShotError(f"{len(moments)} moments in {seconds:g} s, and none of them of: {', '.join(missing)}")
    return origin, {name: found[name] for name in names}


def press_an_organ(context: BrowserContext, address: str, out: Path) -> None:
    """Press the trainer's organ by the page's right hand, and write a picture of it.

    Raises:
        ShotError: the hand never reached it.
    """
    page = context.new_page()
    try:
        page.goto(address)
        page.select_option("#sharpness", "sharp")
        page.wait_for_timeout(3000)
        page.mouse.move(500, 400)
        page.mouse.wheel(0, -1)

        def pressed() -> bool:
            page.mouse.wheel(0, -40)
            page.wait_for_timeout(300)
            return float(page.locator(".bar").nth(1).inner_text().split(" N")[0].split()[-1]) > ORGAN_FORCE

        until(page, pressed, "the hand did not reach the organ")
        page.wait_for_timeout(2000)
        path = out / "organ.jpg"
        image = page.screenshot(path=path, type="jpeg", quality=88, timeout=PATIENCE)
        print(f"{path}: {len(image) / 1000:.0f} kB", flush=True)
    finally:
        page.close()


def take(context: BrowserContext, arguments: argparse.Namespace) -> None:
    """Take every picture there is to take."""
    if not EMULATOR.is_file():
        raise ShotError("the headset's emulator is missing: `python hatch_build.py check` installs it")
    emulator = EMULATOR.read_text(encoding="utf-8") + HEADSET

    def scenes(address: str) -> None:
        origin, found = filmed(context, address, arguments.seconds, "rest", "press", "slide", "lift")
        photograph(context, origin, found, arguments.out)
        photograph(context, origin, {"headset": found["press"]}, arguments.out, emulator)

    if arguments.address:
        scenes(arguments.address)
        print("oblique, organ: left out, for they need other trainers; run without --address")
        return
    with trainer("--device", "recorded", "--recording", str(RECORDING)) as address:
        scenes(address)
    with trainer("--device", "simulated", "--ports", arguments.oblique_ports) as address:
        origin, found = filmed(context, address, arguments.seconds, "press")
        photograph(context, origin, {"oblique": found["press"]}, arguments.out)
    with trainer("--mesh", "liver", "--tissue", "liver") as address:
        press_an_organ(context, address, arguments.out)


def main(words: list[str] | None = None) -> int:
    """Read the command line and take the pictures."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--address", help="of a running trainer, token included, as `trocar train` prints it")
    parser.add_argument(
        "--seconds", type=float, default=30.0, help="how long to film (the recording lasts 25)"
    )
    parser.add_argument("--oblique-ports", default="oblique", metavar="NAME", help="the other ports' name")
    parser.add_argument("--out", type=Path, default=OUT)
    arguments = parser.parse_args(words)
    try:
        with chromium() as browser:
            take(browser.new_context(viewport=WINDOW), arguments)
    except (FileNotFoundError, ShotError) as error:
        print(f"shots: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
