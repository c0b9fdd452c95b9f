"""The doors: nothing reaches the application, page or WebSocket, before it has passed here.

| asked of | checked | else |
|---|---|---|
| every request | exactly one Host, and one of ours (a foreign name that resolves here is DNS rebinding) | 400 |
| every request but `/healthz` and the exchange | the cookie of an open session | 401 |
| every request | Origin is our own; only GET, HEAD and OPTIONS may come without one, a WebSocket not | 403 |
| every request with a body | its length is said, and at most 64 KiB | 411, 413 |
| `GET /?token=...` | the token; the answer is a redirect that sets the cookie | 401 |

SameSite alone would not do: another port of this machine is the same *site*, and a WebSocket asks nobody
before it connects. A WebSocket is refused before the upgrade.
"""

from __future__ import annotations

import logging
from collections.abc import Collection
from http import HTTPStatus
from urllib.parse import parse_qs

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from trocar.web.sessions import Sessions

CONTENT_SECURITY_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; "
    "font-src 'self'; worker-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
RESPONSE_HEADERS = {
    "Content-Security-Policy": CONTENT_SECURITY_POLICY,
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Embedder-Policy": "require-corp",
    "Cross-Origin-Resource-Policy": "same-origin",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-cache",  # kept, but asked for again each time: the session may have ended
}
_WHERE_THE_ADDRESS_IS = """\
<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="dark">
<title>Trocar: not this address</title>
<h1>This address does not open the trainer</h1>
<p>Open the one that <code>trocar train</code> (or <code>make run</code>) printed in its terminal, whole, up to its
last character.</p>
<p>It is another one each time the trainer is started: one from before, or a bookmark, does not work any more.</p>
</html>
"""  # a colour scheme, for the policy lets in no style from elsewhere than behind the doors
_LOG = logging.getLogger(__name__)
_LARGEST_BODY = 65536  # bytes
_HARMLESS = {"GET", "HEAD", "OPTIONS"}  # what a browser may send without an Origin


class Doors:
    """Stand before an ASGI application.

    Args:
        application: what lies behind.
        sessions: who is inside.
        hosts: the values of Host that mean this server, lower case.
        cookie: name of the session's cookie; cookies do not know ports, so it names the port.
        secure: whether the server speaks TLS.
    """

    def __init__(
        self, application: ASGIApp, *, sessions: Sessions, hosts: Collection[str], cookie: str, secure: bool
    ) -> None:
        self._application = application
        self._sessions = sessions
        self._hosts = frozenset(hosts)
        self._cookie = cookie
        self._secure = secure

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let one request or WebSocket pass, or answer in its place."""
        if scope["type"] not in {"http", "websocket"}:
            await self._application(scope, receive, send)
            return

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                for name, value in RESPONSE_HEADERS.items():
                    headers[name] = value
            await send(message)

        headers = Headers(scope=scope)
        token = _token(scope)
        exchange = token is not None and self._sessions.is_token(token)
        refused = self._refusal(scope, headers, exchange=exchange)
        if refused is not None:
            status, text = refused
            is_read = status is HTTPStatus.UNAUTHORIZED and "text/html" in headers.get("accept", "")
            shown = _WHERE_THE_ADDRESS_IS if is_read else text
            await _answer(
                scope, send_with_headers, status, shown, kind="text/html" if is_read else "text/plain"
            )
        elif exchange:
            await _answer(scope, send_with_headers, HTTPStatus.SEE_OTHER, "", headers=self._welcome())
        else:
            try:
                await self._application(scope, receive, send_with_headers)
            except Exception:
                _LOG.exception("%s %s failed", scope["type"], scope["path"])
                raise

    def _refusal(self, scope: Scope, headers: Headers, *, exchange: bool) -> tuple[HTTPStatus, str] | None:
        if not self._is_ours(headers):
            return HTTPStatus.BAD_REQUEST, "This server has another name."
        is_open = exchange or (scope["type"] == "http" and scope["path"] == "/healthz")
        if not is_open and not any(map(self._sessions.knows, self._ids(headers))):
            return HTTPStatus.UNAUTHORIZED, "Open the address that was printed when the trainer started."
        origins = headers.getlist("origin")
        may_lack = scope["type"] == "http" and scope["method"] in _HARMLESS
        if origins != [self._own_origin(headers)] and not (may_lack and not origins):
            return HTTPStatus.FORBIDDEN, "This was asked from another page."
        return None if scope["type"] != "http" else _too_much(headers)

    def _is_ours(self, headers: Headers) -> bool:
        hosts = headers.getlist("host")
        return len(hosts) == 1 and hosts[0].lower() in self._hosts

    def _own_origin(self, headers: Headers) -> str:
        return f"{'https' if self._secure else 'http'}://{headers['host'].lower()}"

    def _ids(self, headers: Headers) -> list[str]:
        pairs = (
            pair.strip().partition("=") for line in headers.getlist("cookie") for pair in line.split(";")
        )
        return [value for name, _, value in pairs if name == self._cookie]

    def _welcome(self) -> dict[str, str]:
        secure = "; Secure" if self._secure else ""
        return {
            "Location": "/",
            "Set-Cookie": f"{self._cookie}={self._sessions.open()}; Path=/; HttpOnly; SameSite=Strict{secure}",
        }


def _too_much(headers: Headers) -> tuple[HTTPStatus, str] | None:
    """Return why a body is not read, if it is not: nobody here asks for a large one."""
    if "transfer-encoding" in headers:
        return HTTPStatus.LENGTH_REQUIRED, "Say how long the body is."
    length = headers.get("content-length", "0")
    if not length.isdigit() or int(length) > _LARGEST_BODY:
        return HTTPStatus.REQUEST_ENTITY_TOO_LARGE, f"A body of at most {_LARGEST_BODY} bytes is read."
    return None


def _token(scope: Scope) -> str | None:
    """Return the token of `GET /?token=...`; None for every other request."""
    if scope["type"] != "http" or scope["method"] != "GET" or scope["path"] != "/":
        return None
    tokens = parse_qs(scope["query_string"].decode("latin-1")).get("token", [])
    return tokens[0] if len(tokens) == 1 else None


async def _answer(
    scope: Scope,
    send: Send,
    status: HTTPStatus,
    text: str,
    *,
    kind: str = "text/plain",
    headers: dict[str, str] | None = None,
) -> None:
    body = f"{text}\n".encode() if text else b""
    raw = [
        (b"content-type", f"{kind}; charset=utf-8".encode()),
        (b"content-length", str(len(body)).encode()),
    ]
    raw += [(name.lower().encode(), value.encode()) for name, value in (headers or {}).items()]
    prefix = ""
    if scope["type"] == "websocket":
        if "websocket.http.response" not in scope.get("extensions", {}):
            await send({"type": "websocket.close"})
            return
        prefix = "websocket."
    await send({"type": f"{prefix}http.response.start", "status": int(status), "headers": raw})
    shown = b"" if scope.get("method") == "HEAD" else body
    await send({"type": f"{prefix}http.response.body", "body": shown})
