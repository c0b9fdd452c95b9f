"""The matrix of the doors: each row is refused, and the right one passes."""

import asyncio
import socket
from contextlib import suppress

import pytest

from trocar.web.doors import CONTENT_SECURITY_POLICY, Doors
from trocar.web.sessions import Sessions


def filled(visitor, headers):
    """Put the visitor's own values where a row names them."""
    known = {
        "cookie": visitor.cookie,
        "origin": visitor.origin,
        "other port": visitor.origin.rpartition(":")[0] + ":1",
        "tls": visitor.origin.replace("http", "https"),
        "name": visitor.cookie.partition("=")[0],
        "port": str(visitor.served.port),
    }
    return {key: value and value.format(**known) for key, value in headers.items()}


WEBSOCKETS = [
    ({"Cookie": "{cookie}", "Origin": "{origin}"}, 101),
    ({"Cookie": "a=b; {cookie}; c=d", "Origin": "{origin}"}, 101),
    ({"Origin": "{origin}"}, 401),
    ({"Cookie": "{name}=guess", "Origin": "{origin}"}, 401),
    ({"Cookie": "{name}=", "Origin": "{origin}"}, 401),
    ({"Cookie": "other-{cookie}", "Origin": "{origin}"}, 401),
    ({"Cookie": "{cookie}", "Origin": None}, 403),
    ({"Cookie": "{cookie}", "Origin": "null"}, 403),
    ({"Cookie": "{cookie}", "Origin": "https://example.org"}, 403),
    ({"Cookie": "{cookie}", "Origin": "{other port}"}, 403),
    ({"Cookie": "{cookie}", "Origin": "{tls}"}, 403),
    ({"Cookie": "{cookie}", "Origin": "{origin}.example.org"}, 403),
    ({"Cookie": "{cookie}", "Origin": "http://localhost:{port}"}, 403),
    ({"Cookie": "{cookie}", "Origin": "{origin}", "Host": "example.org"}, 400),
    ({"Cookie": "{cookie}", "Origin": "http://example.org:{port}", "Host": "example.org:{port}"}, 400),
    ({"Cookie": "{cookie}", "Origin": "{origin}", "Host": "127.0.0.1"}, 400),
    ({"Cookie": "{cookie}", "Origin": "{origin}", "Host": "127.0.0.1:1"}, 400),
    ({"Cookie": "{cookie}", "Origin": "{origin}", "Host": ""}, 400),
]


@pytest.mark.parametrize(("headers", "status"), WEBSOCKETS)
def test_websocket(visitor, headers, status):
    assert visitor.handshake(filled(visitor, headers)) == status


def test_a_second_name_of_loopback_is_ours_with_its_own_origin(visitor):
    host = f"localhost:{visitor.served.port}"
    headers = {"Cookie": visitor.cookie, "Host": host, "Origin": f"http://{host}"}
    assert visitor.handshake(headers) == 101


def test_a_websocket_anywhere_else_is_refused(visitor):
    headers = {"Cookie": visitor.cookie, "Origin": visitor.origin}
    assert visitor.handshake(headers, "/elsewhere") == 403
    assert visitor.handshake({"Origin": visitor.origin}, "/elsewhere") == 401
    assert visitor.handshake({"Origin": visitor.origin}, "/healthz") == 401


REQUESTS = [
    ("GET", "/", {"Cookie": "{cookie}"}, 200),
    ("HEAD", "/", {"Cookie": "{cookie}"}, 200),
    ("GET", "/", {"Cookie": "{cookie}", "Origin": "{origin}"}, 200),
    ("GET", "/", {"Cookie": "{cookie}", "Origin": "null"}, 403),
    ("GET", "/", {"Cookie": "{cookie}", "Origin": "{other port}"}, 403),
    ("GET", "/", {"Cookie": "{cookie}", "Host": "example.org"}, 400),
    ("GET", "/", {"Cookie": "{cookie}", "Host": "example.org:{port}"}, 400),
    ("GET", "/?token=guess", {}, 401),
    ("GET", "/?token=", {}, 401),
    ("GET", "/?token=%F0%9F%98%80%FF", {}, 401),
    ("GET", "/api/hello", {"Cookie": "{cookie}"}, 200),
    ("POST", "/api/hello", {"Cookie": "{cookie}"}, 403),
    ("POST", "/api/hello", {"Cookie": "{cookie}", "Origin": "https://example.org"}, 403),
    ("POST", "/api/hello", {"Cookie": "{cookie}", "Origin": "{origin}"}, 405),
    ("GET", "/nowhere", {"Cookie": "{cookie}"}, 404),
    ("GET", "/live", {"Cookie": "{cookie}"}, 404),
    ("GET", "/docs", {"Cookie": "{cookie}"}, 404),
    ("GET", "/healthz", {}, 200),
    ("GET", "/healthz", {"Host": "example.org"}, 400),
    ("GET", "/healthz", {"Origin": "https://example.org"}, 403),
]


def knock(extensions, *headers):
    """Ask the doors themselves, as another server than ours might, and return what they send."""
    sent = []

    async def send(message):
        sent.append(message)

    async def behind(scope, receive, send):
        raise AssertionError("it was let in")

    sessions = Sessions()
    doors = Doors(behind, sessions=sessions, hosts={"trocar:1"}, cookie="trocar", secure=True)
    raw = [(name, value.format(id=sessions.open()).encode()) for name, value in headers]
    scope = {
        "type": "websocket",
        "path": "/live",
        "query_string": b"",
        "headers": raw,
        "extensions": extensions,
    }
    asyncio.run(doors(scope, None, send))
    return sent


def test_a_second_host_is_refused_even_where_the_server_lets_it_pass():
    headers = [
        (b"host", "trocar:1"),
        (b"host", "trocar:1"),
        (b"cookie", "trocar={id}"),
        (b"origin", "https://trocar:1"),
    ]
    start, _ = knock({"websocket.http.response": {}}, *headers)
    assert start["status"] == 400


def test_where_a_server_knows_no_other_refusal_the_websocket_is_closed():
    assert knock({}, (b"host", "trocar:1")) == [{"type": "websocket.close"}]


@pytest.mark.parametrize(("method", "path", "headers", "status"), REQUESTS)
def test_request(visitor, method, path, headers, status):
    assert visitor.request(method, path, filled(visitor, headers))["status"] == status


PATHS = ["/", "/index.html", "/scene.js", "/api/hello", "/api/openapi.json", "/live", "/nowhere", "//healthz"]
PATHS += ["/healthz/", "/healthz/../api/hello", "/HEALTHZ", "/..%2f..%2fetc/passwd", "/../secret.txt", "/%00"]


@pytest.mark.parametrize("method", ["GET", "HEAD", "POST", "DELETE", "OPTIONS"])
@pytest.mark.parametrize("path", PATHS)
def test_without_the_cookie_every_path_known_or_not_answers_the_same(visitor, method, path):
    answer = visitor.request(method, path)
    assert answer["status"] == 401
    if method != "HEAD":
        assert answer["body"] == visitor.get("/")["body"]


@pytest.mark.parametrize(
    "path",
    [
        "/../secret.txt",
        "/..%2fsecret.txt",
        "/%2e%2e/secret.txt",
        "/a/../../secret.txt",
        "//etc/passwd",
        "/%00",
        "/x" * 900,
    ],
)
def test_no_path_leads_out_of_the_client(visitor, path):
    answer = visitor.get_inside(path)
    assert answer["status"] == 404
    assert "secret" not in answer["body"]


@pytest.mark.parametrize("path", ["/", "/?token=guess", "/api/tasks"])
def test_a_reader_is_told_where_the_right_address_is(visitor, path):
    answer = visitor.get(path, {"Accept": "text/html,application/xhtml+xml,*/*;q=0.8"})
    assert (answer["status"], answer["content-type"]) == (401, "text/html; charset=utf-8")
    assert "<code>trocar train</code>" in answer["body"]
    assert 'name="color-scheme" content="dark"' in answer["body"]
    assert answer["content-security-policy"] == CONTENT_SECURITY_POLICY
    assert "guess" not in answer["body"]
    assert visitor.get(path)["content-type"] == "text/plain; charset=utf-8"


def test_the_token_is_exchanged_for_a_cookie_that_is_not_the_token(visitor):
    token = visitor.target.partition("token=")[2]
    answers = [visitor.get(visitor.target) for _ in range(2)]
    cookies = [answer["set-cookie"] for answer in answers]
    assert [(answer["status"], answer["location"]) for answer in answers] == [(303, "/")] * 2
    for cookie in cookies:
        assert token not in cookie
        assert {"HttpOnly", "SameSite=Strict", "Path=/"} <= set(cookie.split("; "))
        assert "Secure" not in cookie
        assert visitor.get("/", {"Cookie": cookie.partition(";")[0]})["status"] == 200
    assert cookies[0] != cookies[1]


def test_the_token_is_taken_only_where_it_belongs(visitor):
    query = visitor.target.partition("?")[2]
    assert visitor.get(f"/api/hello?{query}")["status"] == 401
    assert visitor.get(f"/?{query}&{query}")["status"] == 401
    assert visitor.request("POST", f"/?{query}")["status"] == 401
    assert visitor.get(f"/?{query}", {"Host": "example.org"})["status"] == 400
    assert visitor.get(f"/?{query}", {"Origin": "https://example.org"})["status"] == 403
    assert visitor.handshake({"Origin": visitor.origin}, f"/?{query}") == 401
    token = query.partition("=")[2]
    name = visitor.cookie.partition("=")[0]
    assert visitor.get("/", {"Cookie": f"{name}={token}"})["status"] == 401


def test_healthz_says_nothing_else(visitor):
    assert visitor.get("/healthz")["body"] == "ok\n"


@pytest.mark.parametrize("path", ["/", "/healthz", "/nowhere", "/scene.js"])
@pytest.mark.parametrize("inside", [True, False])
def test_every_answer_carries_the_headers(visitor, path, inside):
    answer = visitor.get_inside(path) if inside else visitor.get(path)
    assert answer["content-security-policy"] == CONTENT_SECURITY_POLICY
    assert answer["cross-origin-opener-policy"] == "same-origin"
    assert answer["cross-origin-embedder-policy"] == "require-corp"
    assert answer["x-content-type-options"] == "nosniff"
    assert answer["referrer-policy"] == "no-referrer"
    assert "server" not in answer


def test_the_policy_is_the_one_that_was_decided():
    assert CONTENT_SECURITY_POLICY == (
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; "
        "font-src 'self'; worker-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    )


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({"Content-Length": "70000"}, 413),
        ({"Content-Length": "99999999999999999999"}, 413),
        ({"Transfer-Encoding": "chunked"}, 411),
    ],
)
def test_a_large_body_or_one_without_a_length_is_not_read(visitor, headers, status):
    """The answer comes before the body would: nothing of it is sent here."""
    inside = {"Cookie": visitor.cookie, "Origin": visitor.origin}
    assert visitor.request("POST", "/api/attempts", inside | headers)["status"] == status
    without = {"Origin": visitor.origin} | headers
    assert visitor.request("POST", "/api/attempts", without)["status"] == 401


def test_two_hosts_in_one_request_are_refused(visitor):
    lines = f"GET /healthz HTTP/1.1\r\nHost: {visitor.host}\r\nHost: example.org\r\n\r\n"
    with socket.create_connection(("127.0.0.1", visitor.served.port), timeout=5) as plain:
        plain.sendall(lines.encode())
        with plain.makefile("rb") as stream:
            assert b" 400 " in stream.readline()


def test_what_is_no_http_is_answered_and_closed(visitor):
    with socket.create_connection(("127.0.0.1", visitor.served.port), timeout=5) as plain:
        plain.sendall(b"\x16\x03\x01 hello\r\n\r\n")
        with plain.makefile("rb") as stream:
            assert b" 400 " in stream.readline()
            assert stream.read()[-1:] == b"."


def test_endless_headers_are_cut_off(visitor):
    with socket.create_connection(("127.0.0.1", visitor.served.port), timeout=5) as plain:
        plain.sendall(f"GET /healthz HTTP/1.1\r\nHost: {visitor.host}\r\n".encode())
        answer = b""
        with suppress(ConnectionError):  # it may close while we still talk
            for _ in range(100):
                plain.sendall(b"X-Long: " + b"x" * 4096 + b"\r\n")
            plain.sendall(b"\r\n")
            answer = plain.recv(100)
    assert answer == b"" or answer.startswith(b"HTTP/1.1 400 ")


def test_the_oldest_of_many_sessions_ends(guest):
    first = guest.cookie
    others = [guest.get(guest.target)["set-cookie"].partition(";")[0] for _ in range(8)]
    assert guest.get("/api/hello", {"Cookie": first})["status"] == 401
    assert all(guest.get("/api/hello", {"Cookie": cookie})["status"] == 200 for cookie in others)
