"""Why a client's connection is closed: the codes it sees, and the exception that carries one.

Codes from 4000 on are free for applications (RFC 6455, section 7.4.2); 1001 is "going away". The WebSocket
library itself answers a message above the size limit with 1009, text that is no UTF-8 with 1007 and a broken
frame with 1002.
"""

from __future__ import annotations

from enum import IntEnum


class Closing(IntEnum):
    """A code with which the server closes the live stream."""

    STOPPED = 1001
    MALFORMED = 4000
    OUT_OF_RANGE = 4001
    TOO_MANY_MESSAGES = 4002
    IDLE = 4003
    SLOW = 4004
    FULL = 4005


class Farewell(Exception):  # noqa: N818 - it ends a conversation, which is no error of ours
    """Ends the conversation with one client.

    Args:
        closing: the code the client sees.
        reason: a sentence; a close frame holds 123 bytes of it.
    """

    def __init__(self, closing: Closing, reason: str) -> None:
        super().__init__(reason)
        self.closing = closing
        self.reason = reason
