"""What results declare for type checkers is what the verbs give."""

from __future__ import annotations

from typing import Any, Literal, get_args, get_origin, get_type_hints

import declare
import gallery
import numpy as np
import pytest

import quell
from quell._result import REPORTED_ELSEWHERE

CLASSES = [cls for name, cls in vars(quell.results).items() if isinstance(cls, type) and issubclass(cls, quell.results.Result)]

WITHOUT_EXAMPLE = {"Result", "Shard"}
"""Classes that no call of the gallery gives: the base, and a part of a map, which needs a store."""


def hints(cls: type) -> dict[str, Any]:
    """Declared names and their types."""
    found = get_type_hints(cls, localns={"Study": quell.Study})
    return {name: hint for name, hint in found.items() if not name.startswith("_") and name not in ("verb", "study")}


def attribute(fact: str) -> str:
    """The attribute of a fact: ``from`` is a keyword."""
    return "from_" if fact == "from" else fact


def fits(value: Any, hint: Any) -> bool:
    """Whether a value has a declared type; of lists and dicts only the container."""
    if hint is Any:
        return True
    if get_origin(hint) is Literal:
        return value in get_args(hint)
    if hint is float:
        return isinstance(value, (int, float)) and not isinstance(value, bool)
    if get_origin(hint) in (list, dict):
        return isinstance(value, get_origin(hint))
    if get_origin(hint) is np.ndarray:
        kind = get_args(get_args(hint)[1])[0]
        return isinstance(value, np.ndarray) and (kind is Any or np.issubdtype(value.dtype, kind))
    if get_args(hint):
        return any(fits(value, one) for one in get_args(hint))
    return isinstance(value, hint)


@pytest.mark.parametrize("call", gallery.CALLS)
def test_every_fact_and_array_is_declared_with_its_type(call: str) -> None:
    result = gallery.result(call)
    declared = hints(type(result))
    # A fit of laws, which has no study, has a fact of this name: its tables.
    known = set(declared) | set(dir(type(result))) | {"study"}
    assert isinstance(result.facts.get("why", {}), dict)
    facts = {attribute(name) for name in result.facts if name not in REPORTED_ELSEWHERE}
    assert facts <= known, f"not declared: {sorted(facts - known)}"
    arrays = {name for name in result.arrays if name.isidentifier()} - declare.of_the_study(result) - set(result.facts)
    assert arrays <= known, f"not declared: {sorted(arrays - known)}"
    wrong = {}
    for name, hint in declared.items():
        there = name in facts or (name in arrays and not result._declares(name))
        if there and not fits(getattr(result, name), hint):
            wrong[name] = (hint, getattr(result, name))
    assert not wrong


def test_every_declared_name_is_given_by_some_verb() -> None:
    given: dict[type, set[str]] = {}
    for call in gallery.CALLS:
        result = gallery.result(call)
        names = {attribute(name) for name in result.facts} | set(result.arrays)
        given.setdefault(type(result), set()).update(names)
    quantities = {name.replace("-", "_") for names in quell.quantities().values() for name in names}
    given[quell.results.Map] |= quantities | {f"{name}_status" for name in quantities}
    for cls in CLASSES:
        if cls.__name__ not in WITHOUT_EXAMPLE:
            nowhere = set(hints(cls)) - given[cls] - {"sentence"}
            assert not nowhere, f"{cls.__name__}: {sorted(nowhere)}"


def test_the_file_of_columns_is_up_to_date() -> None:
    assert declare.FILE.read_text("utf-8") == declare.text(), "python tests/declare.py writes it"


def test_facts_come_before_arrays_and_every_name_is_an_entry() -> None:
    orbit = gallery.result("orbit in SI")
    # A fact is a number, an entry the variable with its unit.
    assert orbit.displacement == float(orbit["displacement_value"]) and orbit["displacement"].dims == ("time",)
    assert isinstance(orbit.displacement, float)  # type: ignore[attr-defined]
    run = gallery.result("simulate in SI")
    assert isinstance(run.time, np.ndarray) and run.time[-1] == run.final["time"]  # type: ignore[attr-defined]
    for name in run:
        assert name in run and name in dir(run) and run[name] is not None
    assert len(run) == len(list(run)) == len(run.keys())
    assert {"time", "displacement", "sentence", "events"} <= set(run) and "units" not in run
    assert run["sentence"] == run.sentence and {"from_", "to"} <= set(dir(gallery.result("thresholds")))
    thresholds = gallery.result("thresholds")
    assert thresholds.from_ == thresholds.facts["from"] == 0.3  # type: ignore[attr-defined]
    system = gallery.result("simulate a system")
    assert np.array_equal(system.velocity_motor, system.arrays["velocity_motor"].values)  # type: ignore[attr-defined]
    over = gallery.result("basins over a parameter")
    assert over["quiet_fraction"].shape == (2,)
    with pytest.raises(AttributeError, match=r"no fact quiet_fraction, but an array: result\['quiet_fraction'\]"):
        _ = over.quiet_fraction  # type: ignore[attr-defined]
    assert list(gallery.result("map of a disc"))[0] == "disc_load_speed" and len(gallery.result("map")) > 1


def test_misspelt_names_are_answered_with_the_nearest() -> None:
    response = gallery.result("response")
    with pytest.raises(AttributeError, match="Response has no residual_vibratoin; did you mean residual_vibration?"):
        _ = response.residual_vibratoin  # type: ignore[attr-defined]
    with pytest.raises(KeyError, match="did you mean spectrum_amplitude?"):
        _ = response["spectrum_amplitud"]
    with pytest.raises(AttributeError, match="did you mean spectrum_amplitude?"):
        _ = response.spectrum_amplitud  # type: ignore[attr-defined]
    with pytest.raises(KeyError, match="did you mean displacement?"):
        _ = response.arrays["displacment"]
    assert not hasattr(response, "__array__") and not hasattr(response, "_repr_png_")


def test_names_are_completed() -> None:
    response = gallery.result("response")
    assert {"residual_vibration", "time", "plot"} <= set(dir(response)) and "time" in response._ipython_key_completions_()
