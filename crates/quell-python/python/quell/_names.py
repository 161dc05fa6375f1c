"""Names: of variables in datasets, and the valid name nearest to a misspelt one."""

from __future__ import annotations

import keyword
from collections import Counter
from collections.abc import Iterable

__all__ = ["attribute", "attributes", "key_of", "nearest", "singular", "suggestion"]

UNCHANGED = ("ss", "us", "is", "series", "species")
"""Endings of words that are singular, or equal in singular and plural."""

WITH_E = ("sses", "shes", "ches", "xes", "zzes")
"""Endings of plurals in -es."""

IRREGULAR = {"axes": "axis", "bases": "basis", "matrices": "matrix", "indices": "index"}
"""Plurals that follow none of the rules."""


def singular(name: str) -> str:
    """The singular of a name whose last word is a plural; a singular stays: ``unstable_surface_velocities`` has entries
    ``unstable_surface_velocity``, and ``hysteresis`` stays.
    """
    before, line, word = name.rpartition("_")
    start = before + line
    if word in IRREGULAR:
        return start + IRREGULAR[word]
    if not word.endswith("s") or word.endswith(UNCHANGED):
        return name
    if word.endswith("ies"):
        return f"{start}{word[:-3]}y"
    return start + word[: -2 if word.endswith(WITH_E) else -1]


def attributes(names: Iterable[str]) -> dict[str, str]:
    """Names that are also attributes: ``velocity.x`` is ``velocity_x``, and ``dither[1].phase`` is ``dither_1_phase``, as the
    axes in stores of maps. Names that would become equal stay.
    """
    wanted = {name: key_of(name) for name in names}
    of_several = Counter(wanted.values())
    return {name: name if of_several[now] > 1 else now for name, now in wanted.items()}


def attribute(name: str) -> str:
    """A name, which can be a path, as one of Python: ``dither.amplitude`` is ``dither_amplitude``, and ``from`` is ``from_``."""
    plain = key_of(name)
    return f"{plain}_" if keyword.iskeyword(plain) else plain


def key_of(path: str) -> str:
    """A name, which can be a path, without dots and brackets."""
    return path.replace(".", "_").replace("[", "_").replace("]", "")


def nearest(name: str, known: Iterable[str]) -> str | None:
    """The known name nearest to a misspelt one, if one is near."""
    import difflib

    found = difflib.get_close_matches(str(name), [str(it) for it in known], n=1, cutoff=0.6)
    return found[0] if found else None


def suggestion(name: str, known: Iterable[str]) -> str:
    """``; did you mean …?`` with the nearest known name, or nothing."""
    found = nearest(name, known)
    return "" if found is None else f"; did you mean {found}?"
