"""Axes of maps, and how they are given."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal, Union

import numpy as np
import numpy.typing as npt

from ._tables import Number, Table, Unknown

__all__ = ["Axes", "Axis", "axes_tables"]

Numbers = Union["npt.ArrayLike", Sequence[float]]


class Axis(Table):
    """One axis of a map: ``Axis("dither.amplitude", 0.05, 1.0, 100)`` or ``Axis("dither.amplitude", values=[…])``.

    Parameters
    ----------
    parameter :
        Path of the number that is varied, SI twins included, such as ``belt.belt_velocity``.
    from_, to, points :
        Both ends included, in the unit of the parameter or as texts with units. An axis of a disc's speed gets further points beside
        every meeting of waves.
    values :
        The values themselves instead, in any order.
    spacing :
        "linear" (equal steps) or "log" (equal ratios).
    """

    _path = "sweep"

    def __init__(
        self,
        parameter: str | None = None,
        from_: Number | None = None,
        to: Number | None = None,
        points: int | None = None,
        *,
        values: Numbers | None = None,
        spacing: Literal["linear", "log"] | None = None,
        **unknown: Unknown,
    ) -> None:
        given = None if values is None else np.asarray(values, dtype=object).tolist()
        super().__init__(
            parameter=parameter, to=to, points=points, values=given, spacing=spacing, **unknown
        )
        if from_ is not None:
            self.given["from"] = from_


Axes = Union[Mapping[str, "Numbers | Axis"], Iterable[Axis], Axis]


def axes_tables(axes: Axes | None) -> list[Any] | None:
    """Axes as tables; what is none is left for the reader to refuse."""
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
