"""Values of other packages as numbers, lists and texts with units: NumPy, pandas, xarray, pint, and any array interface.

None of these packages but NumPy is imported here.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

__all__ = ["is_quantity", "plain"]

SYMBOLS = {"[length]": "m", "[mass]": "kg", "[time]": "s"}
"""SI units of the dimensions that studies have."""

ANGLES = ("radian", "degree")
"""Words in the names of units of angles, which pint takes as dimensionless."""

TURNS = ("revolution", "turn", "rpm")
"""Words in the names of units that count revolutions: in Quell a revolution per second is a hertz, in pint 2π."""


def is_quantity(given: object) -> bool:
    """Whether an object is a number or array with a unit of pint."""
    return all(hasattr(given, name) for name in ("magnitude", "dimensionality", "to_base_units"))


def plain(given: Any) -> Any:
    """An array as nested lists, a number as a number, a quantity as texts with units; anything else as it is."""
    if isinstance(given, (bool, int, float, str, bytes, list, tuple, Mapping)) or given is None:
        return [plain(it) for it in given] if isinstance(given, (list, tuple)) else given
    if is_quantity(given):
        return with_unit(given)
    inner = getattr(given, "data", None)
    if is_quantity(inner):
        return with_unit(inner)
    if isinstance(given, (np.generic, np.ndarray)):
        return given.tolist()
    if isinstance(given, memoryview) or any(hasattr(given, name) for name in ("__array__", "__array_interface__")):
        return np.asarray(given).tolist()
    if hasattr(given, "__dlpack__"):
        return np.from_dlpack(given).tolist()
    if type(given).__name__ == "array" and hasattr(given, "typecode"):
        return given.tolist()
    return given


def with_unit(quantity: Any) -> Any:
    """A quantity as a text with an SI unit, or nested lists of such texts; as numbers if it has no dimension and no angle."""
    turning, angular = (any(word in str(quantity.units) for word in words) for words in (TURNS, ANGLES))
    powers = {str(name): float(power) for name, power in quantity.dimensionality.items()}
    if not powers:
        value = quantity.to("radian" if angular else "").magnitude
        return plain(np.asarray(value).tolist()) if not angular else texts(np.asarray(value).tolist(), "rad")
    if turning and powers == {"[time]": -1.0}:
        return texts(np.asarray(quantity.to("revolution/second").magnitude).tolist(), "Hz")
    if angular and powers == {"[time]": -1.0}:
        return texts(np.asarray(quantity.to("radian/second").magnitude).tolist(), "rad/s")
    if not set(powers) <= set(SYMBOLS) or any(power != int(power) for power in powers.values()):
        return texts(np.asarray(quantity.magnitude).tolist(), str(quantity.units).replace(" ", ""))
    if powers == {"[time]": -1.0}:
        return texts(np.asarray(quantity.to("hertz").magnitude).tolist(), "Hz")
    over = [SYMBOLS[name] for name, power in powers.items() for _ in range(int(max(power, 0.0)))]
    under = [SYMBOLS[name] for name, power in powers.items() for _ in range(int(max(-power, 0.0)))]
    base = quantity.to("*".join(["1", *over]) if not under else "*".join(["1", *over]) + "/(" + "*".join(under) + ")")
    return texts(np.asarray(base.magnitude).tolist(), "*".join(over or ["1"]) + "".join(f"/{symbol}" for symbol in under))


def texts(values: Any, unit: str) -> Any:
    """Numbers with their unit as texts, in nested lists as the numbers."""
    return [texts(it, unit) for it in values] if isinstance(values, list) else f"{float(values)!r} {unit}"
