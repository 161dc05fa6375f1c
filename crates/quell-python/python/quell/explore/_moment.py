"""Studies that vary in time: the moment whose steady study answers questions about a steady one."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

from .._errors import QuellError
from .._study import Study
from ._reading import Answer

PROFILES = ("drive", "load", "envelope")
"""Tables of profiles."""

TIMES = ("time", "time_s")
"""Keys of the times of knots."""

MOST_MOMENTS = 40
"""Most moments that are tried."""

Answering = TypeVar("Answering", bound=Callable[..., Answer])


def profiles(node: Any) -> Iterator[tuple[str, dict[str, Any]]]:
    """The tables of profiles of a document with their names. A load of a disc is a body, and its table over time is inside."""
    if isinstance(node, list):
        for inner in node:
            yield from profiles(inner)
    elif isinstance(node, dict):
        for name, inner in node.items():
            if name in PROFILES and isinstance(inner, dict) and ({*TIMES, "file", "oscillation"} & set(inner)):
                yield name, inner
            else:
                yield from profiles(inner)


def knot_times(study: Study) -> list[float]:
    """The times of the knots of all profiles in ascending order, without those of files and texts."""
    found = {0.0}
    for _, table in profiles(study._native.document()):
        for key in TIMES:
            given = table.get(key)
            found |= {float(it) for it in given if isinstance(it, (int, float))} if isinstance(given, list) else set()
    return sorted(found)


def varies(study: Study) -> bool:
    """Whether a drive, a load or an amplitude varies in time."""
    return any(True for _ in profiles(study._native.document()))


def steady(study: Study) -> tuple[Study, str]:
    """The study itself, or its steady study at the first knot at which most of the dither acts; and the moment in words."""
    if not varies(study):
        return study, ""
    times = knot_times(study)
    stride = max(1, len(times) // MOST_MOMENTS)
    best: tuple[float, float, Study] | None = None
    refused: QuellError | None = None
    for time in times[::stride]:
        try:
            one = study.at_time(time)
        except QuellError as why:
            refused = refused or why
            continue
        acting = sum(float(it) for path, it in one.settings.items() if ".amplitude" in path and isinstance(it, (int, float)))
        if best is None or acting > best[0]:
            best = acting, time, one
    if best is None:
        assert refused is not None
        raise refused
    return best[2], f"At time {best[1]:g}, with the values of that moment: "


def of_a_moment(answer: Answering) -> Answering:
    """The answer about a steady study for any study: of one that varies in time, about the moment of :func:`steady`."""

    @functools.wraps(answer)
    def about(study: Study, *rest: Any, **named: Any) -> Answer:
        one, words = steady(study)
        found = answer(one, *rest, **named)
        return {**found, "sentence": words + str(found["sentence"])} if words and "sentence" in found else found

    return about  # type: ignore[return-value]
