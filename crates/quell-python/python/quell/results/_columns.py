"""Arrays of results over their coordinates, in the units of the study. Written by tests/declare.py from what the verbs give."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .._frozen import Frozen


class ActuatorColumns(Frozen):
    """Of :class:`quell.results.Actuator`."""

    slip_of_belt: npt.NDArray[np.float64]


class AttractorColumns(Frozen):
    """Of :class:`quell.results.Attractor`."""

    time: npt.NDArray[np.float64]


class BasinsColumns(Frozen):
    """Of :class:`quell.results.Basins`."""

    attractor: npt.NDArray[np.float64]
    quiet: npt.NDArray[np.uint8]
    unknown_fraction: npt.NDArray[np.float64]


class BifurcationColumns(Frozen):
    """Of :class:`quell.results.Bifurcation`."""

    belt_stick_fraction: npt.NDArray[np.float64]
    direction: npt.NDArray[np.uint8]
    frequency: npt.NDArray[np.float64]
    kind: npt.NDArray[np.uint8]
    local_verdict: npt.NDArray[np.uint8]
    locking_periods: npt.NDArray[np.float64]
    locking_turns: npt.NDArray[np.float64]
    peak_to_peak: npt.NDArray[np.float64]
    periods: npt.NDArray[np.float64]
    periods_to_settle: npt.NDArray[np.float64]
    quiet: npt.NDArray[np.uint8]
    rotation_error: npt.NDArray[np.float64]
    rotation_number: npt.NDArray[np.float64]
    row: npt.NDArray[np.float64]
    section_displacement: npt.NDArray[np.float64]
    section_velocity: npt.NDArray[np.float64]


class ComparisonColumns(Frozen):
    """Of :class:`quell.results.Comparison`."""

    after_computed_after: npt.NDArray[np.float64]
    after_measured_after: npt.NDArray[np.float64]
    computed: npt.NDArray[np.float64]
    frequency: npt.NDArray[np.float64]
    frequency_after: npt.NDArray[np.float64]
    measured: npt.NDArray[np.float64]


class DecayColumns(Frozen):
    """Of :class:`quell.results.Decay`."""

    fitted: npt.NDArray[np.float64]
    fitted_deviation: npt.NDArray[np.float64]
    measured: npt.NDArray[np.float64]
    point_residual: npt.NDArray[np.float64]
    time: npt.NDArray[np.float64]


class DescribingFunctionColumns(Frozen):
    """Of :class:`quell.results.DescribingFunction`."""

    contact_number: npt.NDArray[np.float64]
    gain: npt.NDArray[np.float64]
    mean_coefficient: npt.NDArray[np.float64]
    row: npt.NDArray[np.float64]
    undithered_gain: npt.NDArray[np.float64]
    velocity_amplitude: npt.NDArray[np.float64]


class DesignColumns(Frozen):
    """Of :class:`quell.results.Design`."""

    amplitude: npt.NDArray[np.float64]
    dither_frequency_hz: npt.NDArray[np.float64]
    dither_frequency_ratio: npt.NDArray[np.float64]
    number: npt.NDArray[np.float64]


class FrictionCurveColumns(Frozen):
    """Of :class:`quell.results.FrictionCurve`."""

    contact_number: npt.NDArray[np.float64]
    row: npt.NDArray[np.float64]


class LawFitColumns(Frozen):
    """Of :class:`quell.results.LawFit`."""

    coefficient: npt.NDArray[np.float64]
    coefficient_high: npt.NDArray[np.float64]
    coefficient_low: npt.NDArray[np.float64]
    line: npt.NDArray[np.float64]
    points_point_coefficient: npt.NDArray[np.float64]
    points_point_deviation: npt.NDArray[np.float64]
    points_point_residual: npt.NDArray[np.float64]
    points_point_velocity: npt.NDArray[np.float64]
    slip_velocity: npt.NDArray[np.float64]


class MapColumns(Frozen):
    """Of :class:`quell.results.Map`."""

    amplitude: npt.NDArray[np.float64]
    amplitude_status: npt.NDArray[np.uint8]
    criterion: npt.NDArray[np.float64]
    criterion_status: npt.NDArray[np.uint8]
    critical_amplitude: npt.NDArray[np.float64]
    critical_amplitude_status: npt.NDArray[np.uint8]
    destabilising_amplitude: npt.NDArray[np.float64]
    destabilising_amplitude_status: npt.NDArray[np.uint8]
    dither_power: npt.NDArray[np.float64]
    dither_power_status: npt.NDArray[np.uint8]
    dither_stroke: npt.NDArray[np.float64]
    dither_stroke_status: npt.NDArray[np.uint8]
    effect: npt.NDArray[np.uint8]
    effect_status: npt.NDArray[np.uint8]
    ends_on: npt.NDArray[np.uint8]
    ends_on_status: npt.NDArray[np.uint8]
    frequency: npt.NDArray[np.float64]
    frequency_status: npt.NDArray[np.uint8]
    growth: npt.NDArray[np.float64]
    growth_error: npt.NDArray[np.float64]
    growth_error_status: npt.NDArray[np.uint8]
    growth_status: npt.NDArray[np.uint8]
    growth_undithered: npt.NDArray[np.float64]
    growth_undithered_error: npt.NDArray[np.float64]
    growth_undithered_error_status: npt.NDArray[np.uint8]
    growth_undithered_status: npt.NDArray[np.uint8]
    growth_verdict: npt.NDArray[np.uint8]
    growth_verdict_status: npt.NDArray[np.uint8]
    limit_criterion: npt.NDArray[np.float64]
    limit_criterion_status: npt.NDArray[np.uint8]
    limit_critical_amplitude: npt.NDArray[np.float64]
    limit_critical_amplitude_status: npt.NDArray[np.uint8]
    limit_critical_amplitude_upper: npt.NDArray[np.float64]
    limit_critical_amplitude_upper_status: npt.NDArray[np.uint8]
    limit_growth: npt.NDArray[np.float64]
    limit_growth_status: npt.NDArray[np.uint8]
    limit_verdict: npt.NDArray[np.uint8]
    limit_verdict_status: npt.NDArray[np.uint8]
    mean_friction: npt.NDArray[np.float64]
    mean_friction_status: npt.NDArray[np.uint8]
    minimum_normal_load: npt.NDArray[np.float64]
    minimum_normal_load_status: npt.NDArray[np.uint8]
    orbit_radius: npt.NDArray[np.float64]
    orbit_radius_status: npt.NDArray[np.uint8]
    orbit_verdict: npt.NDArray[np.uint8]
    orbit_verdict_status: npt.NDArray[np.uint8]
    peak_to_peak: npt.NDArray[np.float64]
    peak_to_peak_status: npt.NDArray[np.uint8]
    quench_amplitude: npt.NDArray[np.float64]
    quench_amplitude_averaged: npt.NDArray[np.float64]
    quench_amplitude_averaged_status: npt.NDArray[np.uint8]
    quench_amplitude_status: npt.NDArray[np.uint8]
    quench_kind: npt.NDArray[np.uint8]
    quench_kind_status: npt.NDArray[np.uint8]
    quench_last: npt.NDArray[np.float64]
    quench_last_status: npt.NDArray[np.uint8]
    quench_lost: npt.NDArray[np.float64]
    quench_lost_status: npt.NDArray[np.uint8]
    residual_vibration: npt.NDArray[np.float64]
    residual_vibration_status: npt.NDArray[np.uint8]
    settled: npt.NDArray[np.uint8]
    settled_status: npt.NDArray[np.uint8]
    slip_ratio: npt.NDArray[np.float64]
    slip_ratio_status: npt.NDArray[np.uint8]
    stick_fraction: npt.NDArray[np.float64]
    stick_fraction_status: npt.NDArray[np.uint8]
    undithered_amplitude: npt.NDArray[np.float64]
    undithered_amplitude_status: npt.NDArray[np.uint8]
    verdict: npt.NDArray[np.uint8]
    verdict_status: npt.NDArray[np.uint8]


class ModesColumns(Frozen):
    """Of :class:`quell.results.Modes`."""

    damping: npt.NDArray[np.float64]
    damping_ratio: npt.NDArray[np.float64]
    diameters: npt.NDArray[np.float64]
    frequency: npt.NDArray[np.float64]
    frequency_hz: npt.NDArray[np.float64]
    frequency_parameter: npt.NDArray[np.float64]
    mode: npt.NDArray[np.float64]
    radial: npt.NDArray[np.float64]
    ratio: npt.NDArray[np.float64]
    shape_at_load: npt.NDArray[np.float64]


class NoiseResponseColumns(Frozen):
    """Of :class:`quell.results.NoiseResponse`."""

    mean_friction: npt.NDArray[np.float64]
    seed: npt.NDArray[np.float64]
    stick_fraction: npt.NDArray[np.float64]


class OrbitColumns(Frozen):
    """Of :class:`quell.results.Orbit`."""

    belt_friction: npt.NDArray[np.float64]
    belt_normal: npt.NDArray[np.float64]
    belt_phase: npt.NDArray[np.uint8]
    belt_slip_velocity: npt.NDArray[np.float64]
    time: npt.NDArray[np.float64]


class RampColumns(Frozen):
    """Of :class:`quell.results.Ramp`."""

    displacement: npt.NDArray[np.float64]
    time: npt.NDArray[np.float64]
    value: npt.NDArray[np.float64]
    velocity: npt.NDArray[np.float64]


class RecordFitColumns(Frozen):
    """Of :class:`quell.results.RecordFit`."""

    fitted: npt.NDArray[np.float64]
    measured: npt.NDArray[np.float64]
    point_residual: npt.NDArray[np.float64]
    time: npt.NDArray[np.float64]


class ResonancesColumns(Frozen):
    """Of :class:`quell.results.Resonances`."""

    frequency: npt.NDArray[np.float64]
    harmonic: npt.NDArray[np.float64]
    lower_edge: npt.NDArray[np.float64]
    meeting: npt.NDArray[np.float64]
    pair_can_be_unstable: npt.NDArray[np.float64]
    peak_growth: npt.NDArray[np.float64]
    speed: npt.NDArray[np.float64]
    threshold: npt.NDArray[np.float64]
    upper_edge: npt.NDArray[np.float64]


class ResponseColumns(Frozen):
    """Of :class:`quell.results.Response`."""

    displacement: npt.NDArray[np.float64]
    frequency: npt.NDArray[np.float64]
    spectrum_amplitude: npt.NDArray[np.float64]
    spectrum_undithered_amplitude: npt.NDArray[np.float64]
    time: npt.NDArray[np.float64]
    undithered_displacement: npt.NDArray[np.float64]
    undithered_velocity: npt.NDArray[np.float64]
    velocity: npt.NDArray[np.float64]


class SimulationColumns(Frozen):
    """Of :class:`quell.results.Simulation`."""

    belt_friction: npt.NDArray[np.float64]
    belt_normal: npt.NDArray[np.float64]
    belt_phase: npt.NDArray[np.uint8]
    belt_slip_velocity: npt.NDArray[np.float64]
    displacement: npt.NDArray[np.float64]
    time: npt.NDArray[np.float64]
    velocity: npt.NDArray[np.float64]


class ThresholdCurvesColumns(Frozen):
    """Of :class:`quell.results.ThresholdCurves`."""

    curve: npt.NDArray[np.float64]
    kind: npt.NDArray[np.uint8]
    multiplier_modulus: npt.NDArray[np.float64]
    point: npt.NDArray[np.float64]


class ThresholdsColumns(Frozen):
    """Of :class:`quell.results.Thresholds`."""

    branch: npt.NDArray[np.float64]
    frequency: npt.NDArray[np.float64]
    growth_rate: npt.NDArray[np.float64]
    point: npt.NDArray[np.float64]
    radius: npt.NDArray[np.float64]


class TrackedStabilityColumns(Frozen):
    """Of :class:`quell.results.TrackedStability`."""

    branch: npt.NDArray[np.float64]
    curve: npt.NDArray[np.float64]
    eigenvalues_frequency: npt.NDArray[np.float64]
    eigenvalues_growth_rate: npt.NDArray[np.float64]
    frequency: npt.NDArray[np.float64]
    growth_rate: npt.NDArray[np.float64]
    kind: npt.NDArray[np.uint8]
    point: npt.NDArray[np.float64]


class WaveformsColumns(Frozen):
    """Of :class:`quell.results.Waveforms`."""

    number: npt.NDArray[np.float64]
    waveform: npt.NDArray[np.uint8]


class WindowColumns(Frozen):
    """Of :class:`quell.results.Window`."""

    displacement: npt.NDArray[np.float64]
    time: npt.NDArray[np.float64]
