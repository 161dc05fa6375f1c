"""Answers over two numbers or over one: maps, thresholds, basins, eigenvalues."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from .._study import Study
from ._moment import of_a_moment
from ._reading import Answer, Array, array_name, said, unit, values

Progress = Callable[[int, int], object]
Axis = tuple[str, float, float, bool]
"""Path of a number, the ends of its axis, and whether it is logarithmic."""

QUANTITY = {"belt": "growth", "disc": "growth", "system": "growth"}
GRID = (44, 32)


def spaced(start: float, stop: float, count: int, logarithmic: bool) -> Array:
    """Values of an axis."""
    if logarithmic and start > 0.0:
        return np.geomspace(start, stop, count)
    return np.linspace(start, stop, count)


@of_a_moment
def plane(study: Study, across: Axis, up: Axis) -> Answer:
    """The averaged growth rate over two parameters."""
    first, second = (spaced(it[1], it[2], count, it[3]) for it, count in zip((across, up), GRID, strict=True))
    quantity = QUANTITY[study._native.kind]
    found: Any = study.map(quantity, {across[0]: first, up[0]: second}, threads=1)
    name = quantity.replace("-", "_")
    return {
        "x": first,
        "y": second,
        "growth": values(found, name).T,
        "unit": unit(found, name),
        "tongues": tongues(study, across),
        "warnings": found.warnings,
    }


def tongues(study: Study, across: Axis) -> list[Answer]:
    """Speeds of a disc at which waves meet, with the edges of the tongue at its friction."""
    if study._native.kind != "disc" or across[0] != "disc.load.speed":
        return []
    facts = study.resonances(speeds=(max(0.0, across[1]), across[2])).facts
    both = [*((it, False) for it in facts["undithered"]), *((it, True) for it in facts["dithered"])]
    return [
        {"speed": it["speed"], "edges": it.get("edges"), "pair": it["pair"], "dithered": dithered}
        for it, dithered in both
        if it["pair_can_be_unstable"] and it["speed"] > 0.0
    ]


@of_a_moment
def curves(study: Study, across: Axis, up: Axis) -> Answer:
    """The exact thresholds in two parameters as curves."""
    found: Any = study.thresholds(up[0], up[1], up[2], along=across[0], between=(across[1], across[2]))
    exact = [{"x": np.array(twin(it, "along")), "y": np.array(twin(it, "value")), "kind": it["kind"]} for it in found.facts["curves"]]
    return {"curves": exact, **said(found)}


def twin(facts: Mapping[str, Any], name: str) -> Any:
    """A fact in SI, if it is there, otherwise as it is."""
    return next((value for key, value in facts.items() if key.startswith(f"{name}_")), facts[name])


@of_a_moment
def basins(study: Study, grid: tuple[int, int], progress: Progress | None = None) -> Answer:
    """The motions on which starts end."""
    found: Any = study.basins(grid=grid, threads=1, progress=progress)
    first, second = ("displacement", "velocity")
    plane_names = found.facts.get("plane")
    if plane_names:
        first, second = (str(it) for it in plane_names)
    x, y = values(found, array_name(first)), values(found, array_name(second))
    return {
        "x": x,
        "y": y,
        "ends": values(found, "attractor"),
        "words": [str(it["words"]) for it in found.facts["attractors"]],
        "quiet": [bool(it.get("quiet")) for it in found.facts["attractors"]],
        "fractions": [float(it["fraction"]) for it in found.facts["attractors"]],
        "names": (first, second),
        "units": (unit(found, array_name(first)), unit(found, array_name(second))),
        **said(found),
    }


@of_a_moment
def eigenvalues(study: Study, parameter: str, start: float, stop: float) -> Answer:
    """Growth rates and frequencies of a system over a parameter."""
    found: Any = study.stability(parameter, start, stop)
    return {
        "parameter": values(found, "parameter"),
        "growth": values(found, "growth_rate"),
        "frequency": values(found, "frequency"),
        "unit": unit(found, "growth_rate"),
        "local": [float(it["value"]) for it in found.facts["local"]],
        **said(found),
    }
