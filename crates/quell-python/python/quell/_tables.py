"""Tables of a study: the given values by key."""

from __future__ import annotations

from typing import Any, NoReturn, Union

__all__ = ["Number", "Table", "given"]

Number = Union[float, str]
"""A number in the unit of its key, or in SI for a study in SI; or a text with a unit, such as ``"5kN"``."""


class Table:
    """Keys and values of one table of a study file.

    Nothing is checked until the study is made of its tables; then all errors are reported at once.
    """

    _path: str = ""

    given: dict[str, Any]
    """The given values, by key."""

    def __init__(self, **given: Any) -> None:
        self.given = {name: value for name, value in given.items() if value is not None}

    def __repr__(self) -> str:
        inside = ", ".join(f"{name}={value!r}" for name, value in self.given.items())
        return f"quell.{type(self).__name__}({inside})"

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and other.__dict__ == self.__dict__

    __hash__ = None  # type: ignore[assignment]


Unknown = NoReturn
"""Unknown keys: a type checker rejects them, and at run time the error names the nearest valid key."""


def given(names: dict[str, Any], *others: str) -> dict[str, Any]:
    """The arguments of an ``__init__`` by name, from ``given(locals())`` in its first line, without those in ``others``."""
    left_out = {"self", "__class__", "unknown", *others}
    known = {name: value for name, value in names.items() if name not in left_out}
    return {**known, **names.get("unknown", {})}
