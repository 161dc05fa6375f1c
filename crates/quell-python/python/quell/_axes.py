"""Axes of maps."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, Literal, Union

import numpy as np
import numpy.typing as npt

from ._tables import Number, Table, key
from ._values import plain

__all__ = ["Axes", "Axis", "axes_tables"]

Numbers = Union["npt.ArrayLike", Sequence[float]]


class Axis(Table):
    """One axis of a map: ``Axis("dither.amplitude", 0.05, 1.0, 100)`` or ``Axis("dither.amplitude", values=[…])``.

    Parameters
    ----------
    parameter :
        Path of the number that is varied, such as ``belt.belt_velocity``, or its SI twin.
    from_, to, points :
        First and last value, in the unit of the parameter or as texts with units, and the number of values. An axis over the
        speed of a disc gets additional points next to every meeting of waves.
    values :
        The values themselves instead, in any order.
    spacing :
        "linear" (equal steps) or "log" (equal ratios).
    """

    _path = "sweep"

    parameter: str | None = key(default=None, kw_only=False)
    from_: Number | None = key(default=None, kw_only=False)
    to: Number | None = key(default=None, kw_only=False)
    points: int | None = key(default=None, kw_only=False)
    values: Numbers | None = None
    spacing: Literal["linear", "log"] | None = None

    def _read(self, keys: dict[str, Any]) -> dict[str, Any]:
        if keys.get("values") is not None:
            keys["values"] = listed(keys["values"])
        return {"from" if name == "from_" else name: value for name, value in keys.items()}


def listed(values: Any) -> Any:
    """Values of an axis as a list; numbers that are no list are one value."""
    found = plain(list(values) if isinstance(values, (range, Iterator)) else values)
    return np.asarray(found, dtype=object).tolist() if isinstance(found, list) else found


Axes = Union[Mapping[str, "Numbers | Axis"], Iterable[Axis], Axis]


def axes_tables(axes: Axes | None) -> list[Any] | None:
    """Axes as tables; invalid values are passed through and rejected by the reader."""
    if axes is None:
        return None
    if isinstance(axes, Table):
        return [axes]
    if isinstance(axes, Mapping):
        return [
            values if isinstance(values, Table) else Axis(path, values=values)
            for path, values in axes.items()
        ]
    if isinstance(axes, Iterable) and not isinstance(axes, (str, bytes)):
        return list(axes)
    return [axes]
