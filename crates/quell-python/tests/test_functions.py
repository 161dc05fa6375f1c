"""Friction laws that are functions."""

from __future__ import annotations

import pickle
import warnings
from typing import Any

import gallery
import numpy as np
import pytest
from conftest import BELT, DITHER

import quell


def decreasing(v: float) -> float:
    """The decreasing law with 0.4, 0.3 and 0.2."""
    return 0.3 + 0.1 * float(np.exp(-v / 0.2))


def test_a_function_is_the_law_that_it_samples() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        made = quell.Belt(**{**BELT, "friction": decreasing}, dither=DITHER)
        law = quell.SampledLaw(decreasing, 1.0)
    built_in = quell.Decreasing(static_coefficient=0.4, minimum_coefficient=0.3, reference_velocity=0.2)
    known = quell.Belt(**{**BELT, "friction": built_in}, dither=DITHER)
    at = np.linspace(0.01, 0.8, 40)
    for study in (made, quell.Belt(**{**BELT, "friction": law}, dither=DITHER)):
        found, wanted = study.friction(at), known.friction(at)
        assert np.allclose(found.coefficient, wanted.coefficient, rtol=0, atol=1e-4)
        assert np.allclose(found.effective_coefficient, wanted.effective_coefficient, rtol=0, atol=1e-4)
        assert study.stability().verdict == known.stability().verdict
        assert pickle.loads(pickle.dumps(study)) == study and quell.Study.from_text(study.text) == study
    # The range is 10 times the speed of belt and dither, 0.05 + 0.4/10.
    assert made.friction.slip_velocity[-1] == pytest.approx(0.9) and made.friction.slip_velocity[0] == 0.0
    assert 0 <= law.error < 1e-3
    reported = made.check().facts["contacts"][0]["friction"]["fit"]["largest_error"]
    assert reported == pytest.approx(law.error, abs=1e-3)


def test_a_static_level_is_apart_from_the_function() -> None:
    law = quell.SampledLaw(lambda v: 0.5 if v == 0 else decreasing(v), 1.0, static_coefficient=0.5)
    belt = quell.Belt(**{**BELT, "friction": law})
    assert belt.friction.static_coefficient == 0.5 and belt.friction([1e-9]).coefficient[0] == pytest.approx(0.4, abs=1e-3)


def test_a_function_in_si_is_of_speeds_in_si() -> None:
    si = gallery.belt_in_si()
    assert si.dither is not None
    made = si.replace(friction=lambda v: decreasing(v / 10))
    speed = 0.5 + 80.0 / (2.0 * 2 * np.pi * 15.9)
    assert made.friction.slip_velocity_m_per_s[-1] == pytest.approx(10 * speed)
    assert made.friction([1.0]).coefficient[0] == pytest.approx(decreasing(0.1), abs=1e-4)
    law = quell.SampledLaw(lambda v: decreasing(v / 10), maximum_velocity_m_per_s=8.0)
    assert si.replace(friction=law).friction([1.0]).coefficient[0] == pytest.approx(decreasing(0.1), abs=1e-4)


def test_a_contact_takes_a_function() -> None:
    contact = quell.Contact("pad", tangent={"x": 1}, normal_load=1, belt_velocity=0.1, friction=decreasing)
    system = quell.System(coordinates=["x"], mass=[1], damping=[0.01], stiffness=[1], contact=contact)
    exact = quell.System(
        coordinates=["x"], mass=[1], damping=[0.01], stiffness=[1],
        contact=quell.Contact("pad", tangent={"x": 1}, normal_load=1, belt_velocity=0.1,
                              friction=quell.Decreasing(static_coefficient=0.4, minimum_coefficient=0.3, reference_velocity=0.2)),
    )  # fmt: skip
    assert system.stability().growth_rate == pytest.approx(exact.stability().growth_rate, abs=1e-3)


def test_a_function_that_the_fit_misses_is_warned_about() -> None:
    def wavy(v: float) -> float:
        return 0.4 + 0.1 * float(np.sin(40 * v))

    with pytest.warns(UserWarning, match=r"off by .* at the slip speed .* more than 0.01 of its largest coefficient 0.5"):
        law = quell.SampledLaw(wavy, 1.0)
    assert law.error > 0.01 * 0.5
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        quell.SampledLaw(wavy, 1.0, largest_error=1.0)


@pytest.mark.parametrize(
    ("call", "key", "words"),
    [
        (lambda: quell.Belt(**{**BELT, "friction": lambda v: float("nan")}), "friction", "finite and not negative"),
        (lambda: quell.Belt(**{**BELT, "friction": lambda v: -1.0}), "friction", "finite and not negative"),
        (lambda: quell.Belt(**{**BELT, "friction": lambda v: 1 / 0}), "friction", "ZeroDivisionError"),
        (lambda: quell.Belt(**{**BELT, "friction": lambda: 0.3}), "friction", "TypeError"),
        (lambda: quell.SampledLaw(decreasing), "maximum_velocity", "above 0"),
        (lambda: quell.SampledLaw(decreasing, -1.0), "maximum_velocity", "above 0"),
        (lambda: quell.SampledLaw(3, 1.0), "function", "a function"),  # type: ignore[arg-type]
        (lambda: quell.SampledLaw(decreasing, 1.0, maximum_velocity_m_per_s=1.0), "maximum_velocity", "twin in SI"),
        (lambda: quell.Contact(tangent={"x": 1}, normal_load=1, friction=decreasing), "friction", "SampledLaw"),
    ],
)
def test_wrong_functions_are_refused(call: Any, key: str, words: str) -> None:
    with pytest.raises(quell.StudyError, match=words) as refused:
        call()
    assert key in [error["key"] for error in refused.value.errors]


# Waveforms.


def test_a_waveform_may_be_a_function_of_the_phase() -> None:
    dither = quell.Dither("tangential", lambda phase: np.sin(phase), amplitude=0.4, frequency_ratio=10)
    assert dither.waveform == "samples" and dither.waveform_error is not None and dither.waveform_error < 1e-4
    sampled = quell.Belt(**BELT, dither=dither)
    known = quell.Belt(**BELT, dither=quell.Dither("tangential", "sine", amplitude=0.4, frequency_ratio=10))
    at = np.linspace(0.01, 0.3, 20)
    wanted = known.friction(at).effective_coefficient
    assert np.allclose(sampled.friction(at).effective_coefficient, wanted, rtol=0, atol=1e-4)
    assert quell.Study.from_text(sampled.text) == sampled and pickle.loads(pickle.dumps(sampled)) == sampled
    jump = quell.Dither("normal", lambda phase: 1.0 if phase < 1.0 else 0.0, amplitude=0.1, frequency_ratio=10)
    assert jump.waveform_error is not None and jump.waveform_error > 0.1
    with pytest.raises(quell.StudyError, match="function of the phase"):
        quell.Dither("tangential", lambda phase: 1 / 0, amplitude=0.4, frequency_ratio=10)
    with pytest.raises(quell.StudyError, match="finite"):
        quell.Dither("tangential", lambda phase: float("nan"), amplitude=0.4, frequency_ratio=10)


def test_waveforms_have_their_keys() -> None:
    burst = quell.Dither("tangential", "burst", carrier="sine", on=4, off=1, amplitude=0.8, frequency_ratio=20)
    belt = quell.Belt(**BELT, dither=burst)
    assert belt.dithers[0].on == 4 and quell.Study.from_text(belt.text) == belt
    assert belt.set({"dither.off": 3}).dithers[0].off == 3
    without = belt.set({"dither.off": 0}).friction([0.05]).effective_coefficient
    carrier = quell.Belt(**BELT, dither=quell.Dither("tangential", "sine", amplitude=0.8, frequency_ratio=20))
    assert np.array_equal(without, carrier.friction([0.05]).effective_coefficient)
    series = [{"order": 1, "sine": 1.0}, {"order": 3, "sine": 0.2, "cosine": 0.1}]
    fourier = quell.Belt(**BELT, dither=quell.Dither("tangential", "fourier", harmonics=series, amplitude=0.3, frequency_ratio=10))
    assert fourier.stability().verdict in ("stable", "unstable")
    with pytest.raises(quell.StudyError, match="dither.on"):
        quell.Belt(**BELT, dither=quell.Dither("tangential", "sine", on=3, amplitude=0.3, frequency_ratio=10))
