"""A process that computes answers, so that a request that is no longer wanted can be ended.

It reads pickled requests (name of the answer, study, arguments) from its standard input and writes pickled messages to its
standard output: ("progress", done, all), ("done", answer, seconds), ("refused", message).
"""

from __future__ import annotations

import os
import pickle
import queue
import signal
import sys
import threading
import time
from typing import Any, BinaryIO


def write(stream: BinaryIO, message: object) -> None:
    """Writes a message."""
    pickle.dump(message, stream, protocol=pickle.HIGHEST_PROTOCOL)
    stream.flush()


def listen(requests: queue.Queue[Any]) -> None:
    """Reads requests until the explorer ends, with which this process ends at once."""
    while True:
        try:
            requests.put(pickle.load(sys.stdin.buffer))
        except Exception:  # noqa: BLE001  the end of the stream, or of the explorer within a request
            os._exit(0)


def answer(name: str, study: Any, arguments: tuple[Any, ...], out: BinaryIO) -> object:
    """The message that answers a request."""
    from .._errors import QuellError
    from ._tasks import REPORTING, TASKS

    begin = time.perf_counter()
    keywords: dict[str, Any] = {}
    if name in REPORTING:
        keywords["progress"] = lambda done, every: write(out, ("progress", done, every))
    try:
        found = TASKS[name](study, *arguments, **keywords)
    except QuellError as refused:
        return ("refused", str(refused))
    except Exception as failure:  # noqa: BLE001  the explorer shows it and goes on
        return ("refused", f"{name}: {type(failure).__name__}: {failure}")
    return ("done", found, time.perf_counter() - begin)


def main() -> None:
    """Serves requests until the standard input ends."""
    # Ctrl-C ends the explorer, and with it this process.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(os, "nice"):
        # The page answers first.
        os.nice(int(sys.argv[1]) if len(sys.argv) > 1 else 0)
    out = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    # Only messages may reach the pipe.
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    requests: queue.Queue[Any] = queue.Queue()
    threading.Thread(target=listen, args=(requests,), daemon=True).start()
    while True:
        name, study, arguments = requests.get()
        write(out, answer(name, study, arguments, out))


if __name__ == "__main__":
    main()
