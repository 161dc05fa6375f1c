"""Arguments about measured records, shared by the fits and the comparison."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ._arguments import Arguments
from ._values import plain

__all__ = ["Record", "names_of", "record_of"]

Record = tuple[str | None, str | None, str | None, str | None]
"""Column, quantity, gain and window of a record, as texts."""


def record_of(
    arguments: Arguments, column: str | None, quantity: str | None, gain: float | None, window: tuple[float, float] | None
) -> Record:
    """How a record is read."""
    name = None if column is None else arguments.text("column", column, "the name of a column")
    shown = None if quantity is None else arguments.text("quantity", quantity, "displacement, velocity or acceleration")
    factor = None if gain is None else repr(arguments.number("gain", gain))
    part = None
    if window is not None:
        first, last = arguments.pair("window", window, "two times of the record")
        part = f"{first!r}:{last!r}"
    return (name, shown, factor, part)


def names_of(arguments: Arguments, name: str, given: str | Iterable[str] | None) -> list[str]:
    """One text, or several."""
    given = plain(given)
    listed: list[Any] = [given] if isinstance(given, str) else list(given or [])
    return [arguments.text(name, one, "a text or a list of texts") for one in listed]
