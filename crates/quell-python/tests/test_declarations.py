"""What results declare for type checkers is what the verbs give."""

from __future__ import annotations

import copy
import pickle
import re
from typing import Any, Literal, get_args, get_origin, get_type_hints

import gallery
import numpy as np
import pytest

import quell
from quell import _frozen, results
from quell._names import attributes
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


def fits(value: Any, hint: Any) -> bool:
    """Whether a value has a declared type; of lists and dicts only the container."""
    if hint is Any:
        return True
    if get_origin(hint) is Literal:
        return value in get_args(hint)
    if hint is float:
        return isinstance(value, (int, float)) and not isinstance(value, bool)
    if get_origin(hint) in (list, results.FrozenDict):
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
    arrays = {name for name in result.arrays if name.isidentifier()} - of_the_study(result) - set(result.arrays.paths)
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


def test_facts_come_before_arrays_and_every_name_is_an_entry() -> None:
    orbit = gallery.result("orbit in SI")
    # A fact is a number, an entry the variable with its unit.
    assert orbit.displacement == float(orbit["displacement_value"]) and orbit["displacement"].dims == ("time",)
    assert isinstance(orbit.displacement, float)  # type: ignore[attr-defined]
    run = gallery.result("simulate in SI")
    assert isinstance(run.time, np.ndarray) and run.time[-1] == run.final["time"]  # type: ignore[attr-defined]
    for name in run:
        assert name in run and run[name] is not None
    assert set(run) - set(run.arrays.paths) <= set(dir(run)) and "final_time" in run and "final_time" not in dir(run)
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


def test_parts_of_facts_are_attributes() -> None:
    actuator, design = gallery.result("actuator"), gallery.result("design")
    assert actuator.best.amplitude == actuator.best["amplitude"] == float(actuator["best_amplitude"])  # type: ignore[attr-defined]
    assert actuator.own.drive.force.peak == actuator.facts["own"]["drive"]["force"]["peak"]  # type: ignore[attr-defined]
    assert np.array_equal(actuator.own.contacts.slip_velocity, actuator.arrays["own_contact_slip_velocity"].values)  # type: ignore[attr-defined]
    assert actuator.sufficient.from_[0] == actuator.sufficient[0]["from"] == actuator.sufficient[0].from_  # type: ignore[attr-defined]
    assert actuator.sufficient.best.frequency[0] == actuator.sufficient[0].best.frequency  # type: ignore[attr-defined]
    assert design.critical.dither_amplitude == design.critical["dither.amplitude"]  # type: ignore[attr-defined]
    assert {"frequency", "keys"} <= set(dir(actuator.best)) and {"from_", "best"} <= set(dir(actuator.sufficient))  # type: ignore[attr-defined]
    local = gallery.result("thresholds").local  # type: ignore[attr-defined]
    assert np.array_equal(local.value, [one.value for one in local]) and np.array_equal(local["value"], local.value)
    assert local.kind.dtype.kind == "U" and not local.value.flags.writeable
    with pytest.raises(AttributeError, match=r"Actuator has no best_amplitude, but best\.amplitude, and with its unit result\['best_amplitude'\]"):
        _ = actuator.best_amplitude  # type: ignore[attr-defined]
    with pytest.raises(AttributeError, match="no amplitud; did you mean amplitude"):
        _ = actuator.best.amplitud  # type: ignore[attr-defined]
    with pytest.raises(AttributeError, match="no column valeu; did you mean value"):
        _ = local.valeu
    for value in (local, actuator.best):  # type: ignore[attr-defined]
        with pytest.raises(AttributeError, match="limit cannot be set: .* cannot be changed"):
            value.limit = 1
        with pytest.raises(AttributeError, match="limit cannot be set"):
            del value.limit
    with pytest.raises(KeyError, match="did you mean value"):
        _ = local["valeu"]
    again = pickle.loads(pickle.dumps(actuator))
    assert again.sufficient.best.frequency[0] == actuator.sufficient.best.frequency[0]  # type: ignore[attr-defined]
    assert type(copy.deepcopy(local)) is list and type(copy.deepcopy(actuator.best)) is dict  # type: ignore[attr-defined]


def test_empty_lists_have_columns_and_are_empty_arrays() -> None:
    empty = gallery.belt().thresholds("dither.amplitude", 0.1, 0.2).local
    assert empty == [] and isinstance(empty, results.Records) and len(empty.value) == len(empty["error"]) == 0
    assert np.shape(empty) == np.shape(_frozen.frozen([])) == (0,) and np.asarray(empty).size == 0
    with pytest.raises(AttributeError, match="no column shape"):
        _ = empty.shape


@pytest.mark.parametrize("call", gallery.CALLS)
def test_every_part_of_a_fact_has_the_path_of_its_variable(call: str) -> None:
    result = gallery.result(call)
    for name, path in result.arrays.paths.items():
        head, dot, rest = re.split(r"([.\[]|$)", path, maxsplit=1)
        found = eval(f"fact{dot}{rest}", {"fact": result._named(head)})
        flat = isinstance(found, list) and not any(isinstance(one, list) for one in found)
        values = _frozen.as_array(found) if flat else np.asarray(np.nan if found is None else found)
        expected = result.arrays[name].values
        assert np.array_equal(values, expected, equal_nan=expected.dtype.kind == "f"), f"{name}: {path}"


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
