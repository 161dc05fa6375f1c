"""Errors: invalid input, and computations that failed."""

from __future__ import annotations

import errno
import os
from collections.abc import Sequence
from typing import Any, TypedDict

__all__ = ["Complaint", "QuellError", "RunError", "StudyError", "StudyFileNotFoundError"]


class Complaint(TypedDict):
    """One complaint about the input, as the command line prints it with ``--json``."""

    key: str
    """Path of the key, such as ``dither[1].amplitude``, or the argument, such as ``until``."""
    line: int | None
    """Line of the study file; ``None`` if the study was not read from a file."""
    value: Any
    """The given value."""
    allowed: str | None
    """What is allowed instead."""
    suggestion: str | None
    """The nearest valid key or value."""
    fault: str
    """The kind of error: "value", "unknown", "missing", "conflict", "mixed", "path", …"""
    message: str
    """The whole complaint in one line."""


class QuellError(Exception):
    """Base class of the errors that Quell raises."""


class StudyError(QuellError, ValueError):
    """Invalid input. No computation was started, and no file was written.

    ``errors`` has every :class:`Complaint`; the message has one line for each.
    """

    errors: list[Complaint]

    def __init__(self, errors: Sequence[Complaint]) -> None:
        self.errors = list(errors)
        lines = [error["message"] for error in self.errors]
        if len(lines) > 1:
            lines.append(f"{len(lines)} errors; no computation was started")
        super().__init__("\n".join(lines))

    def __reduce__(self) -> tuple[type[StudyError], tuple[list[Complaint]]]:
        return type(self), (self.errors,)


class StudyFileNotFoundError(StudyError, FileNotFoundError):
    """The study file does not exist: a :class:`StudyError` that is also a :class:`FileNotFoundError` with its ``filename``."""

    def __init__(self, errors: Sequence[Complaint], filename: str) -> None:
        super().__init__(errors)
        self.errno, self.filename = errno.ENOENT, filename
        self.strerror = os.strerror(errno.ENOENT)

    def __str__(self) -> str:
        return "\n".join(error["message"] for error in self.errors)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.errors, self.filename)


class RunError(QuellError, RuntimeError):
    """The input is valid, but the computation failed: ``key`` names it, and ``why`` is the reason."""

    key: str
    why: str

    def __init__(self, key: str, why: str) -> None:
        self.key, self.why = key, why
        super().__init__(f"{key}: {why}")

    def __reduce__(self) -> tuple[type[RunError], tuple[str, str]]:
        return type(self), (self.key, self.why)


def complaint(argument: str, value: object, allowed: str, fault: str = "value") -> Complaint:
    """A complaint about an argument."""
    given = value if isinstance(value, (bool, int, float, str, type(None))) else repr(value)[:80]
    message = f"{argument} = {given}: must be {allowed}" if fault == "value" else f"{argument}: {allowed}"
    return {
        "key": argument,
        "line": None,
        "value": given,
        "allowed": allowed,
        "suggestion": None,
        "fault": fault,
        "message": message,
    }
