"""A process that writes records until it is stopped: `python writing_process.py FOLDER [LIMIT_BYTES]`.

It says on stdout which pieces are acknowledged, one line each, and the sentence of an error that it meets.
"""

import resource
import signal
import sys
from itertools import count

from trocar.errors import TrocarError
from trocar.records.store import Records


def say(text):
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()


def piece(number):
    return number.to_bytes(4, "big") * 5000


def main(folder, limit=None):
    with Records.open(folder) as records:
        attempt = records.begin(
            records.trainee("Anna"), task="palpate", level=1, device="web", header={}, dt=1e-3
        )
        say(f"begun {attempt}")
        if limit is not None:
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (int(limit), resource.RLIM_INFINITY))
        for number in count():
            try:
                records.add(attempt, piece(number), 20)
            except TrocarError as error:
                say(f"{type(error).__name__} {error}")
                resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
                records.add(attempt, piece(number), 20)
                say(number)
                return
            say(number)


if __name__ == "__main__":
    main(*sys.argv[1:])
