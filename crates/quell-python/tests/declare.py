"""``python tests/declare.py`` writes ``results/_columns.py``: declarations of what results have next to their documented facts.

These are the arrays of datasets, the columns of facts that are lists, and the facts of discs in SI. A test compares the file
with this program, so that type checkers know every fact and array that the verbs give.
"""

from __future__ import annotations

import re
from pathlib import Path

import gallery
import numpy as np

import quell
from quell import results
from quell._names import attributes
from quell._result import REPORTED_ELSEWHERE

FILE = Path(__file__).parents[1] / "python" / "quell" / "results" / "_columns.py"

HEAD = '''"""Arrays of results, and columns of facts that are lists.

Written by tests/declare.py from what the verbs give. Arrays are in the units of the study; a column such as ``local_value`` has
one entry for each entry of the fact ``local``.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .._frozen import Frozen
'''

KINDS = {"f": "np.float64", "u": "np.uint8", "U": "np.str_"}
"""Columns of whole numbers and truth values are numbers where one is unknown."""

TWIN = re.compile(r"_(n_s_per_m|n|m_per_s|m|km_per_h|hz|s|w|s_per_m|per_s|rpm|kg|db_per_s)$")


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
    depending |= {name for name in result.arrays if name.startswith(("indices_", "sensitivity_"))}
    depending |= {f"state_{name}" for name in attributes(set(facts.get("state_names", []))).values()}
    scheduled = {name for name in result.arrays if name.startswith("schedule_")}
    depending |= {name for name in scheduled if not name.startswith(("schedule_amplitude", "schedule_objective"))}
    return found | depending | {name for name in result.arrays if re.search(r"_\d+$", name)}


def type_of(value: object) -> str:
    """The type of a twin."""
    if isinstance(value, list):
        return "list[float | None]"
    return "float | None" if value is None else type(value).__name__


def type_of_array(variable: results.Variable) -> str:
    """The type of an array, or of the one number of a variable without dimension."""
    kind = variable.values.dtype.kind
    if not variable.dims:
        return "float" if kind == "f" else "Any"
    return f"npt.NDArray[{KINDS.get(kind, 'Any')}]"


def declared() -> dict[str, dict[str, str]]:
    """Names and types by class."""
    found: dict[str, dict[str, set[str]]] = {name: {} for name in results.__all__ if name not in ("Arrays", "Result", "Variable", "Shard")}
    for call in gallery.CALLS:
        result = gallery.result(call)
        names = found[type(result).__name__]
        known, left_out = documented(type(result)), of_the_study(result)
        for name, value in result.facts.items():
            if name not in REPORTED_ELSEWHERE and name not in known and TWIN.search(name):
                names.setdefault(name, set()).add(type_of(value))
        for name in result.arrays:
            variable = result.arrays[name]
            if name not in known and name not in result.facts and name not in left_out and name.isidentifier():
                names.setdefault(name, set()).add(type_of_array(variable))
    for quantities in quell.quantities().values():
        for name in (it.replace("-", "_") for it in quantities):
            found["Map"].setdefault(name, {"npt.NDArray[Any]"})
            found["Map"].setdefault(f"{name}_status", {"npt.NDArray[np.uint8]"})
    return {cls: {name: one_of(types) for name, types in sorted(names.items())} for cls, names in found.items()}


def one_of(types: set[str]) -> str:
    """The type that covers all of these."""
    if len(types) == 1:
        return next(iter(types))
    if types <= {"float", "float | None"}:
        return "float | None"
    return "npt.NDArray[Any]" if all(it.startswith("npt") for it in types) else "Any"


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
