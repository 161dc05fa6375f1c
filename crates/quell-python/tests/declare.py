"""``python tests/declare.py`` writes ``results/_columns.py``: declarations of the arrays that results have next to their documented facts.

A test compares the file with this program, so that type checkers know every array that the verbs give.
"""

from __future__ import annotations

import re
from pathlib import Path

import gallery
import numpy as np

import quell
from quell import results
from quell._names import attributes

FILE = Path(__file__).parents[1] / "python" / "quell" / "results" / "_columns.py"

HEAD = '''"""Arrays of results over their coordinates, in the units of the study. Written by tests/declare.py from what the verbs give."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .._frozen import Frozen
'''

KINDS = {"f": "np.float64", "u": "np.uint8"}
"""Types of arrays: numbers and codes."""


def documented(cls: type) -> set[str]:
    """Names that a class declares itself, with their documentation."""
    known: set[str] = set()
    for base in cls.__mro__:
        if not base.__name__.endswith("Columns"):
            known |= set(vars(base)) | set(base.__dict__.get("__annotations__", {}))
    return known


def of_the_study(result: results.Result) -> set[str]:
    """Names of arrays that depend on the study: coordinates, contacts and parameters, and uncertain numbers."""
    facts = result.facts
    names = {it for key in ("coordinates", "state_names", "plane") for it in facts.get(key, [])}
    names |= {it["parameter"] for it in facts.get("axes", [])} | {str(facts.get(key)) for key in ("parameter", "along")}
    names |= {name.removeprefix("belt.") for name in names}
    found = set(attributes(names).values())
    study = result.study
    contacts = [it["name"] for it in study.check().facts.get("contacts", [])] if isinstance(study, quell.System) else []
    starts = [f"{attributes([name])[name]}_" for name in contacts] + ["shape_", "slip_of_", "velocity_"]
    depending = {name for name in result.arrays if isinstance(study, quell.System) and name.startswith(tuple(starts))}
    depending -= {name for name in depending if name.startswith("shape_at")}
    depending |= {f"state_{name}" for name in attributes(set(facts.get("state_names", []))).values()}
    return found | depending | {name for name in result.arrays if re.search(r"_\d+$", name)}


def declared() -> dict[str, dict[str, str]]:
    """Names and types by class."""
    found: dict[str, dict[str, set[str]]] = {name: {} for name in results.__all__}
    for call in gallery.CALLS:
        result = gallery.result(call)
        names = found[type(result).__name__]
        known, left_out = documented(type(result)), of_the_study(result)
        for name, one in result.arrays.items():
            if name not in known and name not in result.arrays.paths and name not in left_out and name.isidentifier():
                names.setdefault(name, set()).add(f"npt.NDArray[{KINDS[one.values.dtype.kind]}]")
    for quantities in quell.quantities().values():
        for name in (it.replace("-", "_") for it in quantities):
            found["Map"].setdefault(name, {"npt.NDArray[Any]"})
            found["Map"].setdefault(f"{name}_status", {"npt.NDArray[np.uint8]"})
    return {cls: {name: one_of(types) for name, types in sorted(names.items())} for cls, names in found.items() if names}


def one_of(types: set[str]) -> str:
    """The type that covers all of these."""
    return next(iter(types)) if len(types) == 1 else "npt.NDArray[Any]"


def text() -> str:
    """The file."""
    parts = [HEAD]
    for cls, names in declared().items():
        lines = [f"    {name}: {kind}" for name, kind in names.items()]
        parts.append(f'\n\nclass {cls}Columns(Frozen):\n    """Of :class:`quell.results.{cls}`."""\n\n' + "\n".join(lines) + "\n")
    return "".join(parts)


if __name__ == "__main__":
    np.seterr(all="ignore")
    FILE.write_text(text(), encoding="utf-8")
