"""Numbers over time: drives, loads and envelopes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Literal

from ._tables import Number, Table, key

__all__ = ["Profile"]


class Profile(Table):
    """A number over time, given at knots or as an oscillation: a drive, a load or an envelope.

    Before the first knot the first value holds, after the last one the last.

    Parameters
    ----------
    time :
        Times of the knots in ascending order, from the start of the run. In SI ``time_s``, in seconds.
    velocity, speed, load, share :
        Values at these times: of a drive ``velocity``, of the drive of a disc ``speed``, of a load ``load``, of an envelope ``share``,
        the share of the amplitude, or of the load of a disc.
    velocity_m_per_s, speed_hz, load_n :
        The same in SI.
    shape :
        "linear", straight between the knots, or "smooth", a cubic with slope zero at them [default: "linear"].
    file :
        CSV file of times and values, instead of the lists.
    oscillation :
        Of a drive or a load (of a disc its envelope), instead of knots: a sine added to the constant value, as ``{"amplitude": a, "frequency_ratio": r,
        "phase": p}`` (systems: ``frequency``).
    """

    _path = "profile"

    time: Iterable[float] | None = key(default=None, kw_only=False)
    velocity: Iterable[float] | None = None
    speed: Iterable[float] | None = None
    load: Iterable[float] | None = None
    share: Iterable[float] | None = None
    time_s: Iterable[float] | None = None
    velocity_m_per_s: Iterable[float] | None = None
    speed_hz: Iterable[float] | None = None
    load_n: Iterable[float] | None = None
    shape: Literal["linear", "smooth"] | None = None
    file: str | None = None
    oscillation: Mapping[str, Number] | None = None
