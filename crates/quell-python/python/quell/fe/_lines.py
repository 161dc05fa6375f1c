"""Text files of other programs: their lines, and the numbers in them, with file and line in every complaint."""

from __future__ import annotations

import errno
import math
import os
import re
import stat
from collections.abc import Iterator
from pathlib import Path
from typing import NoReturn

from .._errors import Complaint, StudyError, StudyFileNotFoundError, complaint

__all__ = ["Refusal", "check_kind", "is_cut_off", "lines_of", "number_of", "of_line", "regular", "whole_of"]

LONGEST = 100_000
"""Longest line in characters: a file without line ends is no text of a finite-element program."""

SHOWN = 60
"""Characters of a line that a complaint shows."""

NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+))(?:[EeDd]?([+-]\d+)|[EeDd](\d+))?", re.ASCII)
"""A real number of Fortran, such as 1.5, 2.D-3 or 1.5-3, which is 1.5e-3."""

WHOLE = re.compile(r"[+-]?\d+", re.ASCII)


def number_of(text: str) -> float:
    """A finite real number.

    Raises
    ------
    ValueError
        The text is not a number, or has no finite value.
    """
    found = NUMBER.fullmatch(text.strip())
    if found is None:
        raise ValueError(text)
    digits, signed, unsigned = found.groups()
    value = float(f"{digits}e{signed or unsigned or '0'}")
    if not math.isfinite(value):
        raise ValueError(text)
    return value


def whole_of(text: str) -> int:
    """A whole number.

    Raises
    ------
    ValueError
        The text is not a whole number.
    """
    if WHOLE.fullmatch(text.strip()) is None:
        raise ValueError(text)
    return int(text)


def regular(argument: str, path: str | os.PathLike[str]) -> Path:
    """The path of an existing file with an end: devices and pipes may never have one.

    Raises
    ------
    quell.StudyError
        It is no path, or not that of a regular file that can be read.
    quell.StudyFileNotFoundError
        There is no such file.
    """
    try:
        place = os.fspath(path)
        kind = os.stat(place).st_mode
    except TypeError:
        raise StudyError([complaint(argument, path, "a path", "path")]) from None
    except (OSError, ValueError) as why:
        wrong = complaint(argument, str(path), f"{path}: {getattr(why, 'strerror', None) or why}", "path")
        if isinstance(why, OSError) and why.errno == errno.ENOENT:
            raise StudyFileNotFoundError([wrong], str(path)) from None
        raise StudyError([wrong]) from None
    if not stat.S_ISREG(kind):
        raise StudyError([complaint(argument, str(path), f"{path}: expected a regular file", "path")])
    return Path(os.fsdecode(place))


KINDS = (
    (b"\x1f\x8b", "a file that gzip has compressed: unpack it first"),
    (b"PK\x03\x04", "a zip archive: unpack it first"),
    (b"\x89HDF", "an HDF5 file, whose binary results are not read"),
)
"""First bytes of files that are known by name, and what they are."""

WORDS_OF_BINARY = (
    (b"NASTRAN FORT TAPE", "an op2 file, the binary results of Nastran, which is not read; {}"),
    (b"XXXXXXXX", "an op2 file, the binary results of Nastran, which is not read; {}"),
)
"""Words near the beginning of binary files."""


def check_kind(argument: str, path: str | os.PathLike[str], instead: str) -> Path:
    """Rejects binary and compressed files by what they are; ``instead`` says what to give.

    Raises
    ------
    quell.StudyError
        As :func:`regular`, and the name of what the file is.
    """
    place = regular(argument, path)
    try:
        with place.open("rb") as file:
            first = file.read(4096)
    except OSError as why:
        raise StudyError([complaint(argument, str(path), f"{path}: {why.strerror}", "path")]) from None
    found = next((what for head, what in KINDS if first.startswith(head)), None)
    if found is None and b"\0" in first:
        what = next((what for word, what in WORDS_OF_BINARY if word in first), "a binary file, not text; {}")
        found = what.format(instead)
    if found is None and not first.strip():
        found = f"empty; {instead}"
    if found is not None:
        raise StudyError([complaint(argument, str(path), f"{path} is {found}", "path")])
    return place


def is_cut_off(path: str | os.PathLike[str]) -> bool:
    """Whether a file ends without the end of a line."""
    with open(os.fspath(path), "rb") as file:
        if file.seek(0, os.SEEK_END) == 0:
            return False
        file.seek(-1, os.SEEK_END)
        return file.read(1) not in b"\r\n"


def lines_of(argument: str, path: str | os.PathLike[str]) -> Iterator[tuple[int, str]]:
    """The lines of a text file with their numbers, from 1.

    Raises
    ------
    quell.StudyError
        The file cannot be read, or is not text.
    """
    place = regular(argument, path)
    try:
        with place.open(encoding="utf-8-sig", errors="replace") as file:
            number = 0
            while line := file.readline(LONGEST):
                number += 1
                if len(line) == LONGEST or "\0" in line:
                    raise StudyError([of_line(argument, path, number, line, "a line of text")])
                yield number, line.rstrip("\r\n")
    except OSError as why:
        raise StudyError([complaint(argument, str(path), f"{path}: {why.strerror}", "path")]) from None


class Refusal:
    """Complains about lines of a file."""

    def __init__(self, argument: str, path: object) -> None:
        self.argument, self.path = argument, path

    def __call__(self, number: int, line: str, allowed: str) -> NoReturn:
        raise StudyError([of_line(self.argument, self.path, number, line, allowed)])

    def met(self, number: int, what: str) -> NoReturn:
        """Complains about a thing that a line begins, in words."""
        found = complaint(self.argument, str(self.path), f"{self.path}, line {number}: {what}", "path")
        raise StudyError([{**found, "line": number}])


def of_line(argument: str, path: object, number: int, line: str, allowed: str) -> Complaint:
    """The complaint about a line of a file."""
    shown = line[:SHOWN]
    found = complaint(argument, shown, allowed)
    return {**found, "line": number, "message": f"{argument}: {path}, line {number}: {shown!r} must be {allowed}"}
