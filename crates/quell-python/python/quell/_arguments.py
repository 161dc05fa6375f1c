"""Arguments of methods: taken one by one, and refused all at once."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np

from . import _toml
from ._errors import Complaint, StudyError, complaint

__all__ = ["Arguments", "changes_of"]


class Arguments:
    """Takes arguments of a method and gathers complaints about them."""

    def __init__(self) -> None:
        self.wrong: list[Complaint] = []

    def number(self, name: str, given: object, allowed: str = "a finite number") -> float:
        """A finite number."""
        try:
            if isinstance(given, (str, bytes, bool)):
                raise TypeError
            value = float(given)  # type: ignore[arg-type]
        except (TypeError, ValueError, OverflowError):
            value = float("nan")
        if not np.isfinite(value):
            self.wrong.append(complaint(name, given, allowed))
        return value

    def whole(self, name: str, given: object, least: int, most: int) -> int:
        """A whole number between two others."""
        if isinstance(given, (int, np.integer)) and not isinstance(given, bool) and least <= given <= most:
            return int(given)
        self.wrong.append(complaint(name, given, f"a whole number from {least} to {most}"))
        return least

    def pair(self, name: str, given: Any, allowed: str) -> tuple[float, float]:
        """Two finite numbers."""
        try:
            first, second = given
            pair = (float(first), float(second))
        except (TypeError, ValueError, OverflowError):
            pair = (float("nan"), float("nan"))
        if not np.isfinite(pair).all():
            self.wrong.append(complaint(name, given, allowed))
        return pair

    def path(self, name: str, given: object) -> str:
        """A path."""
        try:
            found = os.fspath(given)  # type: ignore[call-overload]
        except TypeError:
            found = None
        if not isinstance(found, str):
            self.wrong.append(complaint(name, given, "a path", "path"))
            return ""
        return found

    def text(self, name: str, given: object, allowed: str) -> str:
        """A string."""
        if not isinstance(given, str):
            self.wrong.append(complaint(name, given, allowed))
            return ""
        return given.encode("utf-8", "replace").decode("utf-8")

    def done(self) -> None:
        """Raises where anything was wrong."""
        if self.wrong:
            raise StudyError(self.wrong)


def changes_of(changes: object, arguments: Arguments) -> list[tuple[str, str]]:
    """Changes as pairs of path and value."""
    if changes is None:
        return []
    if not isinstance(changes, Mapping):
        arguments.wrong.append(complaint("set", changes, "a dict of paths and values"))
        return []
    return [
        (arguments.text("set", path, "a path such as belt.belt_velocity"), _toml.value(value))
        for path, value in changes.items()
    ]
