"""For any arguments, constructors and verbs return a result or raise StudyError, and nothing else."""

from __future__ import annotations

from typing import Any

import numpy as np
from conftest import BELT, DITHER
from hypothesis import given
from hypothesis import strategies as st

import quell

ANYTHING = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.integers(min_value=-(10**400), max_value=10**400),
    st.floats(allow_nan=True, allow_infinity=True),
    st.text(max_size=12),
    st.text(alphabet=st.characters(), max_size=6),
    st.binary(max_size=5),
    st.complex_numbers(),
    st.lists(st.floats(), max_size=3),
    st.dictionaries(st.text(max_size=5), st.floats(), max_size=2),
    st.just(object()),
    st.just(np.array([1.0, 2.0])),
    st.just(np.float64("nan")),
    st.just(quell.Dither("normal", "square", amplitude=0.1, frequency_ratio=3)),
    st.just(quell.Stribeck()),
)
SENSIBLE = st.floats(min_value=0.0, max_value=2.0)
NAMES = st.sampled_from(
    ["damping_ratio", "normal_load", "belt_velocity", "initial", "solver", "dither", "friction", "title", "axes",
     "mass_kg", "stiffness_n_per_m", "normal_force_n", "damping_n_s_per_m", "belt_velocity_m_per_s"]
)  # fmt: skip
DISC_NAMES = st.sampled_from(
    ["inner_radius_ratio", "poisson_ratio", "radial_modes", "nodal_diameters", "load", "mode", "dither", "without",
     "reference_frequency", "modal_damping", "thickness_m", "title", "axes", "modes_file"]
)  # fmt: skip
DISC = {
    "inner_radius_ratio": 0.5,
    "poisson_ratio": 0.3,
    "load": quell.Load(radius_ratio=0.75, mass=0.1, damping=0.1, stiffness=0.1, friction=0.05, speed=0.3),
}


def answered(call: Any) -> Any:
    """The result, or the complaints, each complete."""
    try:
        return call()
    except quell.StudyError as refused:
        assert refused.errors
        for error in refused.errors:
            assert isinstance(error["key"], str) and error["message"] and error["line"] is None
        return None


@given(st.dictionaries(NAMES, st.one_of(SENSIBLE, ANYTHING), max_size=4))
def test_belts(given: dict[str, Any]) -> None:
    study = answered(lambda: quell.Belt(**{**BELT, "dither": DITHER, **given}))
    if study is not None:
        assert quell.Study.from_text(study.text) == study
        assert study.check().facts["ok"]


@given(st.dictionaries(DISC_NAMES, st.one_of(SENSIBLE, st.integers(0, 4), ANYTHING), max_size=4))
def test_discs(given: dict[str, Any]) -> None:
    answered(lambda: quell.Disc(**{**DISC, **given}).check())


@given(st.dictionaries(st.text(max_size=12), ANYTHING, max_size=3))
def test_unknown_keys(given: dict[str, Any]) -> None:
    given = {name: value for name, value in given.items() if name not in ("self", "law")}
    answered(lambda: quell.Belt(**BELT, dither=quell.Dither(**given)))
    answered(lambda: quell.Belt(**{**BELT, "friction": quell.Friction("stribeck", **given)}))


@given(st.dictionaries(st.one_of(st.text(max_size=12), st.sampled_from(
    ["belt.belt_velocity", "dither.amplitude", "dither[1].amplitude", "sweep[0].values", "friction.law", "schema"]
)), ANYTHING, max_size=3))  # fmt: skip
def test_changes(changes: dict[str, Any]) -> None:
    answered(lambda: quell.Belt(**BELT, dither=DITHER).set(changes))


@given(st.text(max_size=60))
def test_texts(text: str) -> None:
    try:
        quell.Study.from_text(text)
    except quell.StudyError as refused:
        assert refused.errors


@given(ANYTHING, ANYTHING, ANYTHING)
def test_arguments_of_verbs(one: Any, other: Any, third: Any) -> None:
    belt = quell.Belt(**BELT, dither=DITHER)
    bounded = not (isinstance(one, (int, float)) and abs(one) > 50)
    if bounded:
        answered(lambda: belt.simulate(one, samples=False))
    answered(lambda: belt.friction(one))
    answered(lambda: belt.map(one, {"dither.amplitude": other}))
    answered(lambda: belt.map("growth", {"dither.amplitude": [0.1]}, threads=one))
    if not isinstance(other, (int, float)) or not isinstance(third, (int, float)):
        answered(lambda: belt.thresholds(one, other, third))
    answered(lambda: quell.Disc(**DISC).resonances(speeds=one, order=other, clear=third))
    # The last argument is always rejected, so that no long computation starts for any other arguments.
    answered(lambda: belt.basins(grid=one, displacement=other, seed=-1))
    answered(lambda: belt.bifurcation(third, one, other, points=-1))
    answered(lambda: belt.orbit(near=one, start=other, from_rest=True, periods=0))
    answered(lambda: belt.thresholds("dither.amplitude", "low", 1.0, start=one, ramp=other, along=third, between=one))
    answered(lambda: quell.Study.from_text(one) if not isinstance(one, str) else None)
