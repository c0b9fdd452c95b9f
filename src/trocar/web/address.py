"""Where the server listens: checked, and bound. Little is imported here, so that a mistake is told at once."""

from __future__ import annotations

import errno
import socket
import ssl
from ipaddress import ip_address
from pathlib import Path

from trocar.errors import InputError, TrocarError

_STUCK_TIME = 5.0  # after which the kernel gives up a connection whose other end takes nothing [s]


def check_address(host: str, port: int, cert: Path | None, key: Path | None) -> None:
    """Refuse a host, port, certificate and key that `serve` would refuse, before anything slow is begun.

    Raises:
        InputError: they do not go together, or cannot be used.
        TrocarError: the address cannot be bound.
    """
    bound(host, port, secure=checked_tls(cert, key)).close()  # never listened on, so it is free again at once


def checked_tls(cert: Path | None, key: Path | None) -> bool:
    """Return whether there is a certificate and its key.

    Raises:
        InputError: there is one without the other, or they cannot be used.
    """
    if cert is None and key is None:
        return False
    if cert is None or key is None:
        raise InputError(
            "cert and key", "both or neither", "one", "give the certificate chain and its private key"
        )
    try:
        ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER).load_cert_chain(cert, key)
    except OSError as error:  # ssl.SSLError is one
        raise InputError("cert and key", "two PEM files that belong together", str(error)) from error
    return True


def bound(host: str, port: int, *, secure: bool) -> socket.socket:
    """Return a socket bound to an address, not yet listening.

    Args:
        host: address or name of this machine.
        port: 0 takes a free one.
        secure: whether it is served under TLS, as every host but this machine itself must be.

    Raises:
        InputError: the host is not one that may be listened on.
        TrocarError: it cannot be bound.
    """
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    except (OSError, ValueError, OverflowError) as error:
        advice = (error.strerror if isinstance(error, OSError) else None) or str(error)
        raise InputError("host", "an address or name of this machine", host, advice) from error
    found = ip_address(str(address[0]).partition("%")[0])
    if found.is_unspecified:
        advice = "name one, so that requests made out to any other can be refused"
        raise InputError("host", "one address of this machine", host, advice)
    if not found.is_loopback and not secure:
        raise InputError(
            "host", "this machine alone without cert and key", host, "give both, or listen on 127.0.0.1"
        )
    listener = socket.socket(family, kind, protocol)
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        if hasattr(socket, "TCP_USER_TIMEOUT"):  # Linux; accepted connections inherit it
            listener.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, int(1e3 * _STUCK_TIME))
        listener.bind(address)
    except OSError as error:
        listener.close()
        sentence = f"cannot listen on {host}, port {port}: {error.strerror}"
        if error.errno == errno.EADDRINUSE:
            sentence += "; choose another port, or 0 for a free one"
        raise TrocarError(sentence) from error
    return listener
