"""Who is inside: one token for the process, exchanged for sessions that a cookie names."""

from __future__ import annotations

import hmac
import secrets
from collections import deque

_BYTES = 32  # 256 random bits: nothing to guess, so tries need no counting
_MOST_SESSIONS = 8  # a few browsers; one more ends the oldest


class Sessions:
    """Exchange the token for session ids, and know them again.

    The token stays valid while the process lives, so the printed address may be opened twice. A session id is
    random and tells nothing about the token. Both are compared in constant time and neither is ever shown.
    """

    def __init__(self) -> None:
        self.token = secrets.token_urlsafe(_BYTES)
        self._open: deque[str] = deque(maxlen=_MOST_SESSIONS)

    def is_token(self, token: str) -> bool:
        """Return whether this is the token."""
        return _same(token, self.token)

    def open(self) -> str:
        """Return the id of a new session, for someone who brought the token."""
        session = secrets.token_urlsafe(_BYTES)
        self._open.append(session)
        return session

    def knows(self, session: str) -> bool:
        """Return whether this is the id of an open session."""
        # A sum, not any(): the time tells nothing of the place.
        return sum(_same(session, known) for known in self._open) > 0


def _same(given: str, right: str) -> bool:
    return hmac.compare_digest(given.encode(errors="surrogatepass"), right.encode())
