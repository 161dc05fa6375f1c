"""Results of every verb on studies of every kind: what tests of all results go through."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

from conftest import BELT, DITHER, SHORT, STUDIES

import quell
from quell import results

HOFFMANN = """
schema = 1
title = "Mode coupling (Hoffmann et al. 2002)"
[parameters]
c = 0.05
[system]
coordinates = ["x", "y"]
mass = [1.0, 1.0]
damping = ["c", "c"]
stiffness = [[2.0, 1.0], [1.0, 0.6666666666666667]]
[[contact]]
name = "pad"
tangent = { x = 1.0 }
normal = { y = 1.0 }
normal_load = 1.0
normal_stiffness = 1.3333333333333333
belt_velocity = 1.0
[contact.friction]
law = "coulomb"
coefficient = 0.9
"""
"""Mode coupling in a mass with two degrees of freedom."""

DRIVE = """
schema = 1
title = "Two-mass drive, dither at the motor"
[system]
coordinates = ["motor", "carriage"]
mass = [0.5, 1.0]
damping = [[0.03, -0.01], [-0.01, 0.01]]
stiffness = [[5.0, -4.0], [-4.0, 4.0]]
[[contact]]
name = "guide"
tangent = { carriage = 1.0 }
normal_load = 1.0
belt_velocity = 0.05
[contact.friction]
law = "stribeck"
static_coefficient = 0.4
minimum_coefficient = 0.2857
reference_velocity = 0.2
[[dither]]
at = { motor = 1.0 }
waveform = "sine"
amplitude = 5.2
frequency = 10.0
"""
"""A drive with dither at its motor."""

MOTOR = """
[actuator]
kind = "motor"
force_per_ampere = 2.0
rms_current = 5.0
sample_rate = 400.0
"""
"""What gives that dither."""

FRICTION = "contact.pad.friction.coefficient"


@cache
def belt() -> quell.Belt:
    """The belt of the README, with a short record."""
    return quell.Belt(**BELT, dither=DITHER, solver=SHORT, title="a belt")


@cache
def study(name: str) -> Any:
    """A study of the project, or one of the texts above."""
    in_si = DRIVE.replace("[system]", '[system]\nunits = "SI"')
    texts = {"hoffmann": HOFFMANN, "drive": DRIVE, "drive in SI": in_si, "drive with a motor": in_si + MOTOR}
    if name in texts:
        return quell.Study.from_text(texts[name])
    short = {"solver.settle": 60, "solver.record_periods": 8}
    found = quell.Study.from_toml(STUDIES / f"{name}.toml")
    return found.set(short) if isinstance(found, quell.Belt) else found


@cache
def belt_in_si() -> quell.Belt:
    """A belt in SI whose vibration is as that of the README, ω₀ = 10 rad/s."""
    return quell.Belt(
        mass_kg=2.0, stiffness_n_per_m=200.0, damping_n_s_per_m=0.2, normal_force_n=200.0, belt_velocity_m_per_s=0.5,
        friction=quell.Stribeck(static_coefficient=0.4, minimum_coefficient=0.2857, reference_velocity_m_per_s=2.0),
        dither=quell.Dither("tangential", "sine", amplitude_n=80.0, frequency_hz=15.9), band_hz=(0.5, 1.5),
        solver=quell.Solver(settle_s=6.0, record_periods=60),
    )  # fmt: skip


@cache
def design_in_si() -> quell.Study:
    """A question about the least dither, in SI."""
    over = {"belt.belt_velocity_m_per_s": [0.5, 1.0]}
    limits = {"stroke_m": 1.0, "friction_loss": 2.0}
    design = {
        "minimise": "power", "vary": ["dither.amplitude_n"], "from": [1.0], "to": [4000.0], "over": over, "limits": limits,
    }  # fmt: skip
    return belt_in_si().replace(design=design)


@cache
def design_under_uncertainty() -> quell.Study:
    """A question about the dither that is enough for most friction laws, in SI."""
    design = {
        "minimise": "stroke", "vary": ["dither.amplitude_n"], "from": [1.0], "to": [4000.0], "limits": {"stroke_m": 1.0},
        "confidence": 0.9, "samples": 40,
    }  # fmt: skip
    uncertainty = {"belt.mass_kg": {"lognormal": [2.0, 0.05]}}
    return belt_in_si().replace(design=design, uncertainty=uncertainty)


@cache
def probability_in_si() -> quell.Study:
    """A belt of uncertain speed, in SI."""
    return belt_in_si().replace(uncertainty={"belt.belt_velocity_m_per_s": {"lognormal": [0.5, 0.3]}})


@cache
def disc() -> quell.Disc:
    """An annular disc with one load."""
    return quell.Disc(
        inner_radius_ratio=0.5,
        poisson_ratio=0.3,
        radial_modes=1,
        nodal_diameters=2,
        load=quell.Load(radius_ratio=0.75, mass=0.1, damping=0.1, stiffness=0.1, friction=0.05, speed=0.3),
        dither=quell.Dither("normal", "sine", amplitude=0.5, frequency_ratio=2.7),
    )


@cache
def disc_in_si() -> quell.Disc:
    """The same disc of steel."""
    material = {"youngs_modulus_pa": 2.1e11, "density_kg_per_m3": 7800.0, "thickness_m": 0.01, "outer_radius_m": 0.2}
    return quell.Disc(
        inner_radius_ratio=0.5, poisson_ratio=0.3, radial_modes=1, nodal_diameters=2, **material,
        load=quell.Load(radius_ratio=0.75, mass_kg=0.1, damping_n_s_per_m=10.0, stiffness_n_per_m=1e5, friction_n=50.0, speed_hz=300),
        dither=quell.Dither("normal", "sine", amplitude=0.5, frequency_ratio=2.7),
    )  # fmt: skip


@cache
def belt_that_stops() -> quell.Belt:
    """A belt that slows down, with dither that is switched on."""
    return belt().replace(
        belt_velocity=None,
        drive=quell.Profile([0.0, 50.0], velocity=[0.2, 0.05]),
        dither=quell.Dither(
            "tangential", "sine", amplitude=2.0, frequency_ratio=10.0, envelope=quell.Profile([20.0, 25.0], share=[0.0, 1.0])
        ),
    )


def belt_that_slows_down() -> quell.Belt:
    """A belt that slows down under a dither."""
    return belt().replace(belt_velocity=None, drive=quell.Profile([0.0, 300.0], velocity=[0.3, 0.05]))


@cache
def belt_under_noise() -> quell.Belt:
    """A belt under noise in a band."""
    noise = quell.Dither("tangential", "noise", amplitude=3.0, band=(8.0, 12.0), lines=16)
    return belt().replace(dither=noise, solver=quell.Solver(settle=100.0, record_periods=8))


def drive_that_slows_down() -> quell.Study:
    """The drive in SI, whose guide slows down."""
    slower = "[contact.drive]\ntime = [0.0, 100.0]\nvelocity = [0.3, 0.05]\n[contact.friction]"
    text = DRIVE.replace("belt_velocity = 0.05\n", "").replace("[contact.friction]", slower)
    return quell.Study.from_text(text.replace("[system]", '[system]\nunits = "SI"'))


def drive_under_noise() -> quell.Study:
    """The drive in SI under noise in a band."""
    text = DRIVE.replace('"sine"', '"noise"').replace("frequency = 10.0", "band_hz = [1.5, 2.0]\nlines = 16")
    return quell.Study.from_text(text.replace("[system]", '[system]\nunits = "SI"'))


def belt_with_two_responses() -> quell.Belt:
    """A belt with a decreasing law, on which squeal and a quiet response exist together."""
    return quell.Belt(
        damping_ratio=0.005, normal_load=1.0, belt_velocity=1.0,
        friction=quell.Decreasing(static_coefficient=0.4, minimum_coefficient=0.2857, reference_velocity=0.2),
        dither=quell.Dither("tangential", "sine", amplitude=2.5, frequency_ratio=10.0),
    )  # fmt: skip


AMPLITUDE = "dither.amplitude"
VELOCITY = "belt.belt_velocity"
IN_SI = ("dither.amplitude_n", 60.0, 120.0)

CALLS: dict[str, Callable[[], results.Result]] = {
    "check": lambda: belt().check(),
    "check in SI": lambda: belt_in_si().check(),
    "check of a disc": lambda: disc_in_si().check(),
    "check of a system": lambda: study("drive in SI").check(),
    "cite": lambda: belt().cite(),
    "friction": lambda: belt().friction(),
    "friction in SI": lambda: belt_in_si().friction(),
    "friction measured": lambda: belt().friction(at=[0.02, 0.1], measured=True),
    "describing function": lambda: belt().friction(describing=0.3),
    "describing function in SI": lambda: belt_in_si().friction(describing=3.0),
    "design": lambda: quell.Study.from_toml(STUDIES / "design.toml").design(),
    "design in SI": lambda: design_in_si().design(),
    "design under uncertainty": lambda: design_under_uncertainty().design(),
    "design with an actuator": lambda: quell.Study.from_toml(STUDIES / "actuator.toml").design(),
    "design of a disc": lambda: quell.Study.from_toml(STUDIES / "which-dither-frequency.toml").design(),
    "design without an answer": lambda: design_in_si().set({"design.limits.amplitude_n": 100.0}).design(),
    "actuator": lambda: quell.Study.from_toml(STUDIES / "actuator.toml").actuator(),
    "actuator of a system": lambda: study("drive with a motor").actuator(),
    "probability": lambda: quell.Study.from_toml(STUDIES / "probability.toml").probability(samples=200),
    "probability in SI": lambda: probability_in_si().probability(samples=100),
    "fit of laws": lambda: quell.fit_laws(STUDIES / "synthetic-friction.csv"),
    "free decay": lambda: quell.fit_decay(STUDIES / "synthetic-decay.csv"),
    "fit of a record": lambda: quell.Study.from_toml(STUDIES / "measured-belt.toml").fit_record(
        STUDIES / "synthetic-squeal.csv", free=["friction.static_coefficient", "record.shift"], fix="dither.amplitude_n=0"),
    "comparison": lambda: quell.Study.from_toml(STUDIES / "measured-belt.toml").compare(
        STUDIES / "synthetic-squeal.csv", after=STUDIES / "synthetic-quenched.csv"),
    "comparison of one record": lambda: quell.Study.from_toml(STUDIES / "measured-belt.toml").compare(STUDIES / "synthetic-quenched.csv"),
    "waveforms": lambda: belt().waveforms(),
    "waveforms of a system": lambda: study("drive in SI").waveforms(),
    "waveforms in SI": lambda: belt_in_si().waveforms(),
    "stability": lambda: belt().stability(),
    "stability in SI": lambda: belt_in_si().stability(),
    "stability without dither": lambda: study("does-it-squeal").stability(),
    "stability of a disc": lambda: disc().stability(),
    "stability of a disc in SI": lambda: disc_in_si().stability(),
    "friction of a system": lambda: study("drive in SI").friction(),
    "gains of a system": lambda: study("drive in SI").friction(describing=0.3),
    "stability of a system": lambda: study("hoffmann").stability(),
    "stability of a dithered system": lambda: study("drive in SI").stability(),
    "exact stability": lambda: study("drive").stability(exact=True),
    "exact stability in SI": lambda: study("drive in SI").stability(exact=True),
    "tracked stability": lambda: study("hoffmann").stability(FRICTION, 0.6, 0.9),
    "curves of stability": lambda: study("hoffmann").stability(FRICTION, 0.6, 0.9, along="parameters.c", between=(0.02, 0.2)),
    "simulate": lambda: belt().simulate(20.0, sound=True),
    "simulate in SI": lambda: belt_in_si().simulate(2.0),
    "simulate a disc": lambda: disc().simulate(20.0),
    "simulate a disc in SI": lambda: disc_in_si().simulate("5ms"),
    "simulate a system": lambda: study("drive in SI").simulate(20),
    "response": lambda: belt().response(),
    "a manoeuvre": lambda: belt_that_stops().simulate(60.0, events=True, samples=True),
    "a ramp": lambda: belt_that_slows_down().bifurcation(ramp=True),
    "a ramp of a system": lambda: drive_that_slows_down().bifurcation(ramp=True),
    "response of a system under noise": lambda: drive_under_noise().response(seeds=2, settle=50, record=50),
    "response under noise": lambda: belt_under_noise().response(seeds=2),
    "a window": lambda: belt_that_stops().response(window=(10.0, 40.0)),
    "a window of a system": lambda: study("drive in SI").response(window=(1, 2)),
    "response in SI": lambda: belt_in_si().response(),
    "response of a system": lambda: study("drive in SI").response(settle=50, record=50),
    "orbit": lambda: belt().orbit(),
    "orbit in SI": lambda: belt_in_si().orbit(),
    "limit cycle": lambda: study("does-it-squeal").orbit(),
    "reached orbit": lambda: belt().orbit(from_rest=True),
    "orbit of a system": lambda: study("drive").orbit(),
    "limit cycle of a system": lambda: study("hoffmann").orbit(),
    "attractor": lambda: belt().attractor(lyapunov=True, settle=50, record=500),
    "attractor in SI": lambda: belt_in_si().attractor(),
    "attractor of a system": lambda: study("drive").attractor(lyapunov=True, settle=50, record=200),
    "thresholds": lambda: belt().thresholds(AMPLITUDE, 0.3, 0.6, from_rest=True),
    "thresholds from other starts": lambda: belt().thresholds(
        AMPLITUDE, 0.3, 0.6, from_sliding=True, from_squeal=True, start=(0.1, 0.0), ramp=5.0),
    "thresholds in SI": lambda: belt_in_si().thresholds(*IN_SI),
    "thresholds of a system": lambda: study("hoffmann").thresholds(FRICTION, 0.6, 0.9),
    "thresholds of a dithered system": lambda: study("drive").thresholds(AMPLITUDE, 4, 7),
    "curves": lambda: belt().thresholds(AMPLITUDE, 0.45, 0.55, along=VELOCITY, between=(0.045, 0.055)),
    "curves of a system": lambda: study("drive").thresholds(
        AMPLITUDE, 3, 9, along="contact.guide.belt_velocity", between=(0.049, 0.051)),
    "bifurcation": lambda: belt().bifurcation(AMPLITUDE, 0.45, 0.55, points=3, up=True),
    "bifurcation with hysteresis": lambda: belt_with_two_responses().bifurcation(AMPLITUDE, 2.5, 4.5, points=3),
    "bifurcation in SI": lambda: belt_in_si().bifurcation(*IN_SI, points=3),
    "bifurcation of a system": lambda: study("drive").set({AMPLITUDE: 0.0}).bifurcation("contact.guide.belt_velocity", 0.05, 0.25, points=3),
    "basins": lambda: belt().basins(grid=(5, 4)),
    "basins in SI": lambda: belt_in_si().basins(sample=5),
    "basins over a parameter": lambda: belt().basins(sample=4, over=AMPLITUDE, from_=0.3, to=0.6, points=2),
    "basins of a system": lambda: study("drive").set({AMPLITUDE: 0.0}).basins(plane="carriage=0:0.6,velocity.carriage=-0.2:0.2", grid=(3, 2)),
    "modes": lambda: disc().modes(),
    "modes in SI": lambda: disc_in_si().modes(),
    "modes of a system": lambda: study("drive in SI").modes(),
    "receptance": lambda: belt().receptance(),
    "receptance in SI": lambda: study("drive in SI").receptance(contacts="springs", points=20),
    "resonances": lambda: disc().resonances(),
    "resonances with clear speeds": lambda: disc().resonances(clear=(0.2, 0.4), frequency=(2.0, 6.0)),
    "resonances in SI": lambda: disc_in_si().resonances(),
    "resonances of a system": lambda: study("drive in SI").resonances(frequency=(1, 20)),
    "map": lambda: belt().map(list(quell.quantities()["belt"]), {AMPLITUDE: [0.1, 0.5], VELOCITY: [0.05, 0.2]}),
    "map of a disc": lambda: disc().map(list(quell.quantities()["disc"]), {"disc.load.speed": [0.2, 0.4]}),
    "map of a system": lambda: study("drive").map(["growth", "slip-ratio", "critical-amplitude"], {AMPLITUDE: [5.0, 5.5]}),
}  # fmt: skip
"""Calls by name."""


@cache
def result(name: str) -> results.Result:
    """The result of one call; it is computed once."""
    return CALLS[name]()
