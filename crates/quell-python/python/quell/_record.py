"""Arguments about measured records, shared by the fits and the comparison."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from ._arguments import Arguments
from ._errors import complaint
from ._values import plain

__all__ = ["Record", "columns_of", "names_of", "record_of"]

Record = tuple[str | None, str | None, str | None, str | None, list[str]]
"""Column, quantity, gain and window of a record, as texts, and its columns by other names."""


def record_of(
    arguments: Arguments,
    column: str | None,
    quantity: str | None,
    gain: float | None,
    window: tuple[float, float] | None,
    columns: Mapping[str, str] | None,
) -> Record:
    """How a record is read."""
    name = None if column is None else arguments.text("column", column, "the name of a column")
    shown = None if quantity is None else arguments.text("quantity", quantity, "displacement, velocity or acceleration")
    factor = None if gain is None else repr(arguments.number("gain", gain))
    part = None
    if window is not None:
        first, last = arguments.pair("window", window, "two times of the record")
        part = f"{first!r}:{last!r}"
    return (name, shown, factor, part, columns_of(arguments, columns))


def columns_of(arguments: Arguments, columns: Mapping[str, str] | None) -> list[str]:
    """Columns by other names, as texts ``QUANTITY=COLUMN``."""
    if columns is None:
        return []
    if not isinstance(columns, Mapping):
        allowed = 'a dictionary of quantities and columns, such as {"slip_velocity": "V"}'
        arguments.wrong.append(complaint("columns", str(columns), allowed, "value"))
        return []
    return [f"{name}={arguments.text('columns', column, 'the name of a column')}" for name, column in columns.items()]


def names_of(arguments: Arguments, name: str, given: str | Iterable[str] | None) -> list[str]:
    """One text, or several."""
    given = plain(given)
    listed: list[Any] = [given] if isinstance(given, str) else list(given or [])
    return [arguments.text(name, one, "a text or a list of texts") for one in listed]
