"""The routes behind the doors: the live stream, its greeting, a sign of life, and the browser client's files."""

from __future__ import annotations

from pathlib import Path

from fastapi import FastAPI
from starlette.exceptions import HTTPException
from starlette.responses import HTMLResponse, PlainTextResponse, Response
from starlette.staticfiles import StaticFiles
from starlette.types import Receive, Scope, Send
from starlette.websockets import WebSocket

from trocar import __version__
from trocar.web.api import routes, say_errors
from trocar.web.lessons import Lessons
from trocar.web.live import Live
from trocar.web.messages import Hello

CLIENT = Path(__file__).parent / "static"

_NOT_BUILT = """\
<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>Trocar: the browser client is not built</title>
<h1>The browser client is not built</h1>
<p>The trainer runs, but the page that shows it is missing from this installation.</p>
<p>In a checkout, build it with <code>npm ci</code> and <code>npm run build</code> in <code>client/</code>, or
install Trocar again: the install builds it. Then load this page again; the trainer need not be restarted.</p>
</html>
"""


class ClientFiles:
    """Serve the built client, or say how to build it where it is missing.

    Args:
        folder: where `index.html` and what it loads lie.
    """

    def __init__(self, folder: Path) -> None:
        self._index = folder / "index.html"
        self._files = StaticFiles(directory=folder, html=True, check_dir=False)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request; a WebSocket has no business here."""
        if scope["type"] == "http" and scope["path"].startswith("/api/"):
            raise HTTPException(404)  # by any method: no route of the interface took it
        answer: Response | StaticFiles = self._files
        if scope["type"] == "http" and not self._index.is_file():
            if self._files.get_path(scope) != ".":
                raise HTTPException(404)
            answer = HTMLResponse(_NOT_BUILT, status_code=503)
        await answer(scope, receive, send)


def application(live: Live, lessons: Lessons | None = None, *, client: Path = CLIENT) -> FastAPI:
    """Return the application, doors not included.

    Args:
        live: the stream and its source.
        lessons: tasks to do with it, and their records; without, there is free practice alone.
        client: folder of the built browser client.
    """
    app = FastAPI(
        title="Trocar",
        version=__version__,
        openapi_url="/api/openapi.json",
        docs_url=None,
        redoc_url=None,
        redirect_slashes=False,
    )

    @app.get("/healthz", include_in_schema=False)
    async def healthz() -> PlainTextResponse:
        return PlainTextResponse("ok\n")

    @app.get("/api/hello", summary="What the stream says first: tissue, grid, instruments, camera")
    async def hello() -> Hello:
        return live.source.hello()

    @app.websocket("/live")
    async def stream(websocket: WebSocket) -> None:
        await live.converse(websocket)

    say_errors(app)
    if lessons is not None:
        app.include_router(routes(lessons))
    app.router.default = ClientFiles(
        client
    )  # no mount: that would take what a route has but by another method
    return app
