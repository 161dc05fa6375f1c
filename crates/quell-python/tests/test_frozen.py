"""Studies, tables, laws and results cannot be changed, and a result is neither true nor false."""

from __future__ import annotations

import copy
import json
import pickle
from typing import Any

import numpy as np
import pytest
from conftest import BELT, DITHER, STUDIES

import quell

SYSTEM = STUDIES / "two-mass-drive.toml"


def values(belt: quell.Belt, disc: quell.Disc) -> dict[str, tuple[Any, str]]:
    """Everything whose attributes can be read, with one of them."""
    system = quell.Study.from_toml(SYSTEM)
    assert isinstance(system, quell.System)
    return {
        "belt": (belt, "belt_velocity"),
        "disc": (disc, "poisson_ratio"),
        "system": (system, "mass"),
        "title": (belt, "title"),
        "native": (belt, "_native"),
        "dither of a belt": (belt.dither, "amplitude"),
        "dither": (quell.Dither("tangential", "sine", amplitude=0.4), "amplitude"),
        "dither of a system": (system.dithers[0], "amplitude"),
        "contact": (system.contacts[0], "normal_load"),
        "law of a contact": (system.contacts[0].friction, "coefficient"),
        "law": (quell.Stribeck(static_coefficient=0.4), "static_coefficient"),
        "named law": (quell.Friction("coulomb", coefficient=0.3), "coefficient"),
        "sampled law": (quell.SampledLaw(lambda v: 0.3 + 0.01 * v, 1.0), "error"),
        "friction": (belt.friction, "static_coefficient"),
        "initial": (belt.initial, "state"),
        "solver": (belt.solver, "settle"),
        "load": (disc.load, "mass"),
        "axis": (quell.Axis("dither.amplitude", 0.1, 1.0, 5), "points"),
        "profile": (quell.Profile([0, 1], velocity=[1, 2]), "velocity"),
        "stability": (belt.stability(), "verdict"),
        "check": (disc.check(), "disc"),
        "facts": (belt.stability(), "facts"),
        "study of a result": (belt.stability(), "study"),
        "new name": (belt.stability(), "opinion"),
        "arrays": (belt.friction().arrays, "attrs"),
        "variable": (belt.friction().arrays["coefficient"], "values"),
        "fit": (quell.fit_laws(STUDIES / "synthetic-friction.csv"), "law"),
    }


def test_nothing_can_be_set_or_deleted(belt: quell.Belt, disc: quell.Disc) -> None:
    for name, (value, attribute) in values(belt, disc).items():
        before = getattr(value, attribute, None)
        with pytest.raises(AttributeError, match=r"replace\("):
            setattr(value, attribute, 0.5)
        with pytest.raises(AttributeError, match=r"replace\("):
            delattr(value, attribute)
        after = getattr(value, attribute, None)
        assert after is before or np.array_equal(after, before) or after == before, name


def test_the_advice_names_the_argument_and_works(belt: quell.Belt) -> None:
    with pytest.raises(AttributeError, match=r"replace\(belt_velocity=…\)"):
        belt.belt_velocity = 0.5  # type: ignore[misc]
    with pytest.raises(AttributeError, match=r"replace\(amplitude=…\) returns another Dither"):
        belt.dithers[0].amplitude = 0.5  # type: ignore[misc]
    louder = belt.replace(dither=belt.dithers[0].replace(amplitude=0.5), friction=belt.friction.replace(static_coefficient=0.45))
    assert louder.dithers[0].amplitude == 0.5 and louder.friction.static_coefficient == 0.45
    assert belt.dithers[0].amplitude == 0.4 and belt.friction.static_coefficient == 0.4


def test_lists_and_dicts_inside_cannot_be_changed(belt: quell.Belt) -> None:
    samples = [0.0, 1.0, 0.0, -1.0]
    dither = quell.Dither("tangential", "samples", values=samples, amplitude=0.1, frequency_ratio=9, hold="linear")
    law = quell.Expression("a + 0*v", constants={"a": 0.3})
    facts = belt.response().facts
    for change in [
        lambda: dither.values.append(3.0),
        lambda: dither.values.__setitem__(0, 3.0),
        lambda: dither.given.update(amplitude=3.0),  # type: ignore[attr-defined]
        lambda: law.constants.__setitem__("a", 3.0),
        lambda: facts.__setitem__("residual_vibration", 0.0),  # type: ignore[attr-defined]
        lambda: facts["peaks"][0].pop("amplitude"),
        lambda: facts["peaks"].clear(),
        lambda: belt.response().peaks.sort(),
        lambda: belt.response().units.clear(),
    ]:
        with pytest.raises(TypeError, match="replace"):
            change()
    with pytest.raises(ValueError, match="read-only"):
        belt.simulate(5).time[0] = 3.0
    # What the caller has is the caller's.
    samples[1] = 7.0
    assert dither.values == [0.0, 1.0, 0.0, -1.0]
    array = np.array([0.1, 0.2])
    axis = quell.Axis("dither.amplitude", values=array)
    array[0] = 5.0
    assert list(axis.values) == [0.1, 0.2]


def test_copies_of_lists_and_dicts_can_be_changed(belt: quell.Belt) -> None:
    found = belt.response()
    facts = found.facts
    assert json.loads(json.dumps(facts)) == facts and isinstance(facts, dict)
    for copied in (found.to_dict(), copy.deepcopy(facts)):
        copied["peaks"][0]["amplitude"] = 5.0
        copied["effect"] = "none"
    assert found.effect == facts["effect"] != "none" and found.peaks[0]["amplitude"] != 5.0
    assert copy.deepcopy(found) is found and copy.copy(belt) is belt
    again = pickle.loads(pickle.dumps(found))
    assert again.facts == facts
    with pytest.raises(TypeError):
        again.facts["effect"] = "none"
    law = pickle.loads(pickle.dumps(quell.Stribeck(static_coefficient=0.4)))
    with pytest.raises(AttributeError):
        law.static_coefficient = 1.0
    written = found.time if "time" in found.arrays else found.arrays["frequency"].values
    copied_array = np.array(written)
    copied_array[0] = 1.0


def test_no_result_is_true_by_accident() -> None:
    belt = quell.Belt(**BELT, dither=DITHER)
    study = belt.set({"solver.settle": 60, "solver.record_periods": 8})
    answers = [study.stability(), study.check(), study.response(), study.simulate(5), study.map("criterion", {"dither.amplitude": [0.1, 0.2]})]
    for answer in answers:
        with pytest.raises(TypeError, match="neither true nor false"):
            bool(answer)
        with pytest.raises(TypeError, match="neither true nor false"):
            print("quiet") if not answer else print("loud")
    with pytest.raises(TypeError, match=r"\.verdict"):
        bool(study.stability())
    with pytest.raises(TypeError, match=r"\.effect"):
        bool(study.response())
