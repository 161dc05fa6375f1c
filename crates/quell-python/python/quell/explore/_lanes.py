"""Lanes of requests: each lane computes one answer at a time, and a newer request replaces one of the same name."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

from .._study import Study

PATIENCE = 0.5
"""Time in seconds after which a computation that is no longer wanted is ended."""

LONGEST = 120.0
"""Time in seconds after which a computation is ended in any case."""

Kind = Literal["waiting", "running", "progress", "done", "failed", "dropped"]


@dataclass(frozen=True)
class Event:
    """What happened to a request."""

    name: str
    kind: Kind
    answer: dict[str, Any] | None = None
    seconds: float = 0.0
    words: str = ""
    tag: object = None
    """The tag of the request."""


@dataclass(frozen=True)
class Request:
    """A request for an answer."""

    name: str
    study: Study
    arguments: tuple[Any, ...]
    tag: object


class Ended(Exception):
    """The process of a lane was ended."""


class Process:
    """A process that computes answers; ``patient`` is its niceness."""

    def __init__(self, patient: int = 0) -> None:
        self._patient = patient
        self._process: subprocess.Popen[bytes] | None = None
        self._lock = threading.Lock()
        self._closed = False

    def start(self) -> subprocess.Popen[bytes]:
        """The process, started if necessary."""
        with self._lock:
            if self._closed:
                raise Ended
            if self._process is None or self._process.poll() is not None:
                environment = {**os.environ, "PYTHONPATH": os.pathsep.join(it for it in sys.path if it)}
                command = [sys.executable, "-m", "quell.explore._worker", str(self._patient)]
                self._process = subprocess.Popen(
                    command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment
                )
            return self._process

    def compute(self, request: Request, progress: Callable[[int, int], None]) -> tuple[str, Any, float]:
        """The answer to a request: its kind, the answer or words, seconds."""
        try:
            process = self.start()
            assert process.stdin is not None and process.stdout is not None
            pickle.dump((request.name, request.study, request.arguments), process.stdin)
            process.stdin.flush()
            while True:
                message = pickle.load(process.stdout)
                if message[0] == "progress":
                    progress(message[1], message[2])
                elif message[0] == "done":
                    return "done", message[1], message[2]
                else:
                    return "failed", message[1], 0.0
        except (OSError, EOFError, pickle.UnpicklingError, ValueError) as gone:
            raise Ended from gone

    def end(self) -> None:
        """Ends the process; the next request starts another."""
        with self._lock:
            if self._process is not None:
                self._process.kill()
                self._process.wait()
                for stream in (self._process.stdin, self._process.stdout):
                    if stream is not None:
                        try:
                            stream.close()
                        except (OSError, ValueError):
                            pass
                self._process = None

    def close(self) -> None:
        """Ends the process for good."""
        with self._lock:
            self._closed = True
        self.end()


class Here:
    """Computes short answers in this process."""

    def start(self) -> None:
        """Nothing needs to be started."""

    def compute(self, request: Request, progress: Callable[[int, int], None]) -> tuple[str, Any, float]:
        """The answer to a request."""
        from .._errors import QuellError
        from ._tasks import TASKS

        begin = time.perf_counter()
        try:
            found = TASKS[request.name](request.study, *request.arguments)
        except QuellError as refused:
            return "failed", str(refused), 0.0
        except Exception as failure:  # noqa: BLE001  the explorer shows it and goes on
            return "failed", f"{request.name}: {type(failure).__name__}: {failure}", 0.0
        return "done", found, time.perf_counter() - begin

    def end(self) -> None:
        """A short answer is not ended."""

    def close(self) -> None:
        """Nothing is left."""


class Lane:
    """Computes requests one at a time in the order of their first submission.

    ``deliver`` is called from the thread of the lane with every event. A request that waits is dropped for a newer one of the
    same name. One that runs is ended for a newer one if it has run longer than ``patience``.
    """

    def __init__(
        self,
        deliver: Callable[[Event], None],
        engine: Process | Here,
        patience: float = PATIENCE,
        longest: float = LONGEST,
    ) -> None:
        self._deliver = deliver
        self._engine = engine
        self._patience = patience
        self._longest = longest
        self._waiting: dict[str, Request] = {}
        self._changed = threading.Condition()
        self._running: tuple[Request, float] | None = None
        self._why = ""
        self._closed = False
        threads = (threading.Thread(target=it, daemon=True) for it in (self._work, self._watch))
        for thread in threads:
            thread.start()

    def submit(self, name: str, study: Study, *arguments: Any, tag: object = None) -> None:
        """Asks for an answer in place of any earlier request of the same name."""
        with self._changed:
            dropped = self._waiting.pop(name, None)
            self._waiting[name] = Request(name, study, arguments, tag)
            self._changed.notify_all()
        if dropped is not None:
            self._deliver(Event(name, "dropped", tag=dropped.tag))

    def cancel(self, name: str) -> None:
        """Drops the request of this name, and ends it if it is running."""
        with self._changed:
            dropped = self._waiting.pop(name, None)
            is_running = self._running is not None and self._running[0].name == name
            if is_running:
                self._why = "stopped"
                self._engine.end()
        if dropped is not None and not is_running:
            self._deliver(Event(name, "dropped", tag=dropped.tag))

    def close(self) -> None:
        """Ends the lane."""
        with self._changed:
            self._closed = True
            self._waiting.clear()
            self._changed.notify_all()
        self._engine.close()

    @property
    def is_idle(self) -> bool:
        """Whether nothing runs or waits."""
        with self._changed:
            return self._running is None and not self._waiting

    def _work(self) -> None:
        try:
            self._engine.start()
        except Exception:  # noqa: BLE001  the first request reports it
            pass
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._waiting or self._closed)
                if self._closed:
                    return
                name = next(iter(self._waiting))
                request = self._waiting.pop(name)
                self._running = (request, time.monotonic())
                self._why = ""
            self._deliver(Event(name, "running", tag=request.tag))
            event = self._computed(request)
            with self._changed:
                self._running = None
            if not self._closed:
                self._deliver(event)

    def _computed(self, request: Request) -> Event:
        name, tag = request.name, request.tag

        def progress(done: int, every: int) -> None:
            self._deliver(Event(name, "progress", words=f"{done} of {every}", tag=tag))

        try:
            kind, found, seconds = self._engine.compute(request, progress)
        except Ended:
            self._engine.end()
            return Event(name, "dropped" if self._why == "newer" else "failed", words=self._why or "the process ended", tag=tag)
        except Exception as failure:  # noqa: BLE001  a lane never ends
            return Event(name, "failed", words=f"{type(failure).__name__}: {failure}", tag=tag)
        if kind == "done":
            return Event(name, "done", found, seconds, tag=tag)
        return Event(name, "failed", words=str(found), tag=tag)

    def _watch(self) -> None:
        """Ends requests that are no longer wanted, or that take too long."""
        while not self._closed:
            time.sleep(0.05)
            with self._changed:
                if self._running is None:
                    continue
                request, since = self._running
                age = time.monotonic() - since
                if request.name in self._waiting and age > self._patience:
                    self._why = "newer"
                elif age > self._longest:
                    self._why = f"stopped after {self._longest:.0f} s"
                else:
                    continue
                # The lock is held, so that the next request is not ended instead.
                self._engine.end()
