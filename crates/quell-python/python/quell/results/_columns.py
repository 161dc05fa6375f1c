"""Arrays of results, columns of facts that are lists, and twins of facts in SI.

Written by tests/declare.py from what the verbs give. Arrays are in the units of the study; a column such as ``local_value`` has
one entry for each entry of the fact ``local``; ``amplitude_m`` is ``amplitude`` in m, for a study in SI.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt


class AttractorColumns:
    """Of :class:`quell.results.Attractor`."""

    attractor_base_response: Any
    attractor_contact_name: npt.NDArray[np.str_]
    attractor_contact_stick_fraction: npt.NDArray[np.float64]
    attractor_displacement: float
    attractor_displacement_m: float
    attractor_frequency: float
    attractor_frequency_hz: float
    attractor_highest: float
    attractor_highest_m: float
    attractor_locking: float
    attractor_locking_periods: Any
    attractor_locking_turns: Any
    attractor_lowest: float
    attractor_lowest_m: float
    attractor_multiplier: float
    attractor_peak_to_peak: float
    attractor_peak_to_peak_m: float
    attractor_periods: Any
    attractor_quiet: Any
    attractor_rotation_error: float
    attractor_rotation_number: float
    attractor_section_displacement_m_value: npt.NDArray[np.float64]
    attractor_section_displacement_value: npt.NDArray[np.float64]
    attractor_section_velocity_m_per_s: npt.NDArray[np.float64]
    attractor_section_velocity_value: npt.NDArray[np.float64]
    attractor_state_value: npt.NDArray[np.float64]
    attractor_stick_fraction: float
    attractor_velocity: float
    attractor_velocity_m_per_s: float
    lyapunov_agrees_with_multipliers: Any
    lyapunov_contradiction: float
    lyapunov_deciding: float
    lyapunov_errors: npt.NDArray[np.float64]
    lyapunov_exponents: npt.NDArray[np.float64]
    lyapunov_kaplan_yorke_dimension: float
    lyapunov_of_multiplier: float
    lyapunov_settle: float
    lyapunov_shift_in_time: float
    lyapunov_time: float
    time: npt.NDArray[np.float64]


class BasinsColumns:
    """Of :class:`quell.results.Basins`."""

    across_value: npt.NDArray[np.float64]
    attractor: npt.NDArray[np.float64]
    attractor_base_response: npt.NDArray[Any]
    attractor_displacement: npt.NDArray[np.float64]
    attractor_displacement_m: npt.NDArray[np.float64]
    attractor_fraction: npt.NDArray[np.float64]
    attractor_fraction_error: npt.NDArray[np.float64]
    attractor_fraction_high: npt.NDArray[np.float64]
    attractor_fraction_low: npt.NDArray[np.float64]
    attractor_frequency: npt.NDArray[np.float64]
    attractor_frequency_hz: npt.NDArray[np.float64]
    attractor_highest: npt.NDArray[np.float64]
    attractor_highest_m: npt.NDArray[np.float64]
    attractor_kind: npt.NDArray[np.str_]
    attractor_locking: npt.NDArray[np.float64]
    attractor_lowest: npt.NDArray[np.float64]
    attractor_lowest_m: npt.NDArray[np.float64]
    attractor_multiplier: npt.NDArray[np.float64]
    attractor_peak_to_peak: npt.NDArray[np.float64]
    attractor_peak_to_peak_m: npt.NDArray[np.float64]
    attractor_period: npt.NDArray[np.float64]
    attractor_periods: npt.NDArray[np.float64]
    attractor_periods_to_settle: npt.NDArray[Any]
    attractor_quiet: npt.NDArray[Any]
    attractor_rotation_error: npt.NDArray[np.float64]
    attractor_rotation_number: npt.NDArray[np.float64]
    attractor_starts: npt.NDArray[Any]
    attractor_stick_fraction: npt.NDArray[np.float64]
    attractor_velocity: npt.NDArray[np.float64]
    attractor_velocity_m_per_s: npt.NDArray[np.float64]
    attractor_words: npt.NDArray[np.str_]
    displacement: npt.NDArray[np.float64]
    displacement_m: npt.NDArray[np.float64]
    layout_grid_value: npt.NDArray[Any]
    layout_sample: Any
    layout_seed: Any
    plane_value: npt.NDArray[np.str_]
    portrait_local_verdict: npt.NDArray[np.str_]
    portrait_quiet_fraction: npt.NDArray[np.float64]
    portrait_quiet_fraction_high: npt.NDArray[np.float64]
    portrait_quiet_fraction_low: npt.NDArray[np.float64]
    portrait_value: npt.NDArray[np.float64]
    quiet: npt.NDArray[np.uint8]
    unknown_fraction: Any
    unknown_fraction_error: float
    unknown_fraction_high: float
    unknown_fraction_low: float
    unknown_starts_value: Any
    up_value: npt.NDArray[np.float64]
    velocity: npt.NDArray[np.float64]
    velocity_m_per_s: npt.NDArray[np.float64]
    window_across_value: npt.NDArray[np.float64]
    window_displacement_m: list[float | None]
    window_displacement_m_value: npt.NDArray[np.float64]
    window_displacement_value: npt.NDArray[np.float64]
    window_up_value: npt.NDArray[np.float64]
    window_velocity_m_per_s: list[float | None]
    window_velocity_value: npt.NDArray[np.float64]


class BifurcationColumns:
    """Of :class:`quell.results.Bifurcation`."""

    direction: npt.NDArray[np.uint8]
    down_base_response: npt.NDArray[Any]
    down_displacement: npt.NDArray[np.float64]
    down_displacement_m: npt.NDArray[np.float64]
    down_frequency: npt.NDArray[np.float64]
    down_frequency_hz: npt.NDArray[np.float64]
    down_highest: npt.NDArray[np.float64]
    down_highest_m: npt.NDArray[np.float64]
    down_kind: npt.NDArray[np.str_]
    down_local_verdict: npt.NDArray[np.str_]
    down_locking: npt.NDArray[np.float64]
    down_lowest: npt.NDArray[np.float64]
    down_lowest_m: npt.NDArray[np.float64]
    down_multiplier: npt.NDArray[np.float64]
    down_peak_to_peak: npt.NDArray[np.float64]
    down_peak_to_peak_m: npt.NDArray[np.float64]
    down_period: npt.NDArray[np.float64]
    down_periods: npt.NDArray[np.float64]
    down_periods_to_settle: npt.NDArray[Any]
    down_quiet: npt.NDArray[Any]
    down_rotation_error: npt.NDArray[np.float64]
    down_rotation_number: npt.NDArray[np.float64]
    down_settled: npt.NDArray[Any]
    down_stick_fraction: npt.NDArray[np.float64]
    down_value: npt.NDArray[np.float64]
    down_velocity: npt.NDArray[np.float64]
    down_velocity_m_per_s: npt.NDArray[np.float64]
    down_words: npt.NDArray[np.str_]
    frequency: npt.NDArray[np.float64]
    frequency_hz: npt.NDArray[np.float64]
    hysteresis_value: npt.NDArray[np.float64]
    jump_after: npt.NDArray[np.float64]
    jump_becomes: npt.NDArray[np.str_]
    jump_before: npt.NDArray[np.float64]
    jump_direction: npt.NDArray[np.str_]
    kind: npt.NDArray[np.uint8]
    local_verdict: npt.NDArray[np.uint8]
    locking_periods: npt.NDArray[np.float64]
    locking_turns: npt.NDArray[np.float64]
    peak_to_peak: npt.NDArray[np.float64]
    peak_to_peak_m: npt.NDArray[np.float64]
    periods: npt.NDArray[np.float64]
    periods_to_settle: npt.NDArray[np.float64]
    quiet: npt.NDArray[np.uint8]
    rotation_error: npt.NDArray[np.float64]
    rotation_number: npt.NDArray[np.float64]
    row: npt.NDArray[np.float64]
    section_displacement: npt.NDArray[np.float64]
    section_displacement_m: npt.NDArray[np.float64]
    section_velocity: npt.NDArray[np.float64]
    section_velocity_m_per_s: npt.NDArray[np.float64]
    state_of_section: npt.NDArray[np.float64]
    stick_fraction: npt.NDArray[np.float64]
    up_base_response: npt.NDArray[Any]
    up_displacement: npt.NDArray[np.float64]
    up_displacement_m: npt.NDArray[np.float64]
    up_frequency: npt.NDArray[np.float64]
    up_frequency_hz: npt.NDArray[np.float64]
    up_highest: npt.NDArray[np.float64]
    up_highest_m: npt.NDArray[np.float64]
    up_kind: npt.NDArray[np.str_]
    up_local_verdict: npt.NDArray[np.str_]
    up_locking: npt.NDArray[np.float64]
    up_lowest: npt.NDArray[np.float64]
    up_lowest_m: npt.NDArray[np.float64]
    up_multiplier: npt.NDArray[np.float64]
    up_peak_to_peak: npt.NDArray[np.float64]
    up_peak_to_peak_m: npt.NDArray[np.float64]
    up_period: npt.NDArray[np.float64]
    up_periods: npt.NDArray[np.float64]
    up_periods_to_settle: npt.NDArray[Any]
    up_quiet: npt.NDArray[Any]
    up_rotation_error: npt.NDArray[np.float64]
    up_rotation_number: npt.NDArray[np.float64]
    up_settled: npt.NDArray[Any]
    up_stick_fraction: npt.NDArray[np.float64]
    up_value: npt.NDArray[np.float64]
    up_velocity: npt.NDArray[np.float64]
    up_velocity_m_per_s: npt.NDArray[np.float64]
    up_words: npt.NDArray[np.str_]


class CheckColumns:
    """Of :class:`quell.results.Check`."""

    belt_belt_velocity: float
    belt_belt_velocity_m_per_s: float
    belt_damping_ratio: float
    belt_damping_ratio_n_s_per_m: float
    belt_normal_load: float
    belt_normal_load_n: float
    contact_law_belt_velocity: npt.NDArray[np.float64]
    contact_law_belt_velocity_unit: npt.NDArray[np.str_]
    contact_law_law: npt.NDArray[np.str_]
    contact_law_name: npt.NDArray[np.str_]
    contact_law_normal: npt.NDArray[Any]
    contact_law_normal_load: npt.NDArray[np.float64]
    contact_law_normal_load_unit: npt.NDArray[np.str_]
    contact_law_tangent: npt.NDArray[Any]
    contact_law_varies_in_time: npt.NDArray[Any]
    disc_load_angle_deg: npt.NDArray[np.float64]
    disc_load_damping: npt.NDArray[np.float64]
    disc_load_damping_n_s_per_m: npt.NDArray[np.float64]
    disc_load_dither_phase_deg: npt.NDArray[np.float64]
    disc_load_friction: npt.NDArray[np.float64]
    disc_load_friction_n: npt.NDArray[np.float64]
    disc_load_mass: npt.NDArray[np.float64]
    disc_load_mass_kg: npt.NDArray[np.float64]
    disc_load_radius_ratio: npt.NDArray[np.float64]
    disc_load_stiffness: npt.NDArray[np.float64]
    disc_load_stiffness_n_per_m: npt.NDArray[np.float64]
    disc_modes: Any
    disc_speed: float
    disc_speed_hz: float
    disc_speed_rpm: float
    dither_amplitude: Any
    dither_amplitude_n: npt.NDArray[np.float64]
    dither_amplitude_ratio: npt.NDArray[np.float64]
    dither_amplitude_ratio_m_per_s: npt.NDArray[np.float64]
    dither_direction: npt.NDArray[np.str_]
    dither_frequency: npt.NDArray[np.float64]
    dither_frequency_hz: float
    dither_frequency_ratio: Any
    dither_frequency_ratio_hz: npt.NDArray[np.float64]
    dither_has_envelope: npt.NDArray[Any]
    dither_phase: npt.NDArray[np.float64]
    dither_waveform: npt.NDArray[np.str_]
    friction_minimum_coefficient: float
    friction_range_from: float
    friction_range_from_m_per_s: float
    friction_range_to: float
    friction_range_to_m_per_s: float
    friction_reference_velocity: float
    friction_reference_velocity_m_per_s: float
    friction_static_coefficient: float
    observe_value: npt.NDArray[np.float64]


class CitationsColumns:
    """Of :class:`quell.results.Citations`."""

    correction_equations: npt.NDArray[np.str_]
    correction_printed: npt.NDArray[np.str_]
    correction_right: npt.NDArray[np.str_]
    correction_source: npt.NDArray[np.str_]
    source_key: npt.NDArray[np.str_]
    source_reference: npt.NDArray[np.str_]


class ComparisonColumns:
    """Of :class:`quell.results.Comparison`."""

    computed: npt.NDArray[np.float64]
    computed_after: npt.NDArray[np.float64]
    frequency: npt.NDArray[np.float64]
    frequency_after: npt.NDArray[np.float64]
    measured: npt.NDArray[np.float64]
    measured_after: npt.NDArray[np.float64]


class DecayColumns:
    """Of :class:`quell.results.Decay`."""

    fitted: npt.NDArray[np.float64]
    fitted_deviation: npt.NDArray[np.float64]
    measured: npt.NDArray[np.float64]
    point_residual: npt.NDArray[np.float64]
    time: npt.NDArray[np.float64]


class ContactFrictionColumns:
    """Of :class:`quell.results.ContactFriction`."""

    coefficient: npt.NDArray[np.float64]
    contact: npt.NDArray[np.float64]
    contact_fast_velocity: npt.NDArray[np.float64]
    contact_fast_velocity_m_per_s: npt.NDArray[np.float64]
    contact_name: npt.NDArray[np.str_]
    contact_surface_velocity: npt.NDArray[np.float64]
    contact_surface_velocity_m_per_s: npt.NDArray[np.float64]
    effective_coefficient: npt.NDArray[np.float64]
    effective_slope: npt.NDArray[np.float64]
    row: npt.NDArray[np.float64]
    slip_velocity: npt.NDArray[np.float64]


class ContactGainsColumns:
    """Of :class:`quell.results.ContactGains`."""

    gain: npt.NDArray[np.float64]
    limit_cycle_amplitude_m: float | None
    limit_cycle_frequency_hz: float | None
    limit_cycle_velocity_m_per_s: float | None
    mean_coefficient: npt.NDArray[np.float64]
    row: npt.NDArray[np.float64]
    undithered_gain: npt.NDArray[np.float64]
    velocity_amplitude: npt.NDArray[np.float64]


class DescribingFunctionColumns:
    """Of :class:`quell.results.DescribingFunction`."""

    belt_velocity_m_per_s: float
    gain_error_s_per_m: list[float | None]
    gain_error_s_per_m_value: npt.NDArray[np.float64]
    gain_error_value: npt.NDArray[np.float64]
    gain_s_per_m: list[float | None]
    limit_cycle_amplitude_m: float
    limit_cycle_amplitude_m_value: npt.NDArray[np.float64]
    limit_cycle_amplitude_value: npt.NDArray[np.float64]
    limit_cycle_stable: npt.NDArray[Any]
    limit_cycle_velocity_amplitude: npt.NDArray[np.float64]
    limit_cycle_velocity_amplitude_error: npt.NDArray[np.float64]
    limit_cycle_velocity_amplitude_error_m_per_s: npt.NDArray[np.float64]
    limit_cycle_velocity_amplitude_m_per_s: npt.NDArray[np.float64]
    limit_cycle_velocity_m_per_s: float
    small_gain_s_per_m: float
    undithered_gain_s_per_m: list[float | None]
    velocity_amplitude_m_per_s: list[float | None]


class ActuatorColumns:
    """Of :class:`quell.results.Actuator`."""


class DesignColumns:
    """Of :class:`quell.results.Design`."""

    amplitude: npt.NDArray[np.float64]
    averaged_dither_amplitude: float
    averaged_dither_amplitude_n: float
    averaged_dither_frequency_hz: float
    averaged_dither_frequency_ratio: float
    basin_objective: npt.NDArray[np.float64]
    basin_objective_m: npt.NDArray[np.float64]
    basin_objective_w: npt.NDArray[np.float64]
    binding_value: npt.NDArray[np.str_]
    critical_dither_amplitude: float
    critical_dither_amplitude_n: float
    critical_dither_frequency_hz: float
    critical_dither_frequency_ratio: float
    dither_frequency_hz: npt.NDArray[np.float64]
    dither_frequency_ratio: npt.NDArray[np.float64]
    drive_current_peak: float
    drive_current_peak_to_peak: float
    drive_current_rms: float
    drive_displacement_peak: float
    drive_displacement_peak_m: float
    drive_displacement_peak_to_peak: float
    drive_displacement_peak_to_peak_m: float
    drive_displacement_rms: float
    drive_displacement_rms_m: float
    drive_force_peak: float
    drive_force_peak_n: float
    drive_force_peak_to_peak: float
    drive_force_peak_to_peak_n: float
    drive_force_rms: float
    drive_force_rms_n: float
    drive_point_belt_belt_velocity_m_per_s: float
    drive_rated_limit: npt.NDArray[np.str_]
    drive_rated_used: npt.NDArray[np.float64]
    drive_samples_per_period: float
    drive_voltage_peak: float
    drive_voltage_peak_to_peak: float
    drive_voltage_rms: float
    frontier_limit: npt.NDArray[np.str_]
    frontier_objective: npt.NDArray[np.float64]
    frontier_objective_m: npt.NDArray[np.float64]
    frontier_objective_w: npt.NDArray[np.float64]
    frontier_value: npt.NDArray[np.float64]
    frontier_value_m: npt.NDArray[np.float64]
    limit_limit: npt.NDArray[np.str_]
    limit_used: npt.NDArray[np.float64]
    number: npt.NDArray[np.float64]
    objective_m: float
    objective_w: float
    parameters_dither_amplitude: float
    parameters_dither_amplitude_n: float
    parameters_dither_frequency_hz: float
    parameters_dither_frequency_ratio: float
    verified_growth_rate: float
    verified_multiplier: float
    verified_operating_points: Any
    verified_point_belt_belt_velocity: float
    verified_point_belt_belt_velocity_m_per_s: float
    verified_point_disc_load_speed: float
    waveform_feasible: npt.NDArray[Any]
    waveform_objective: npt.NDArray[np.float64]
    waveform_objective_m: npt.NDArray[np.float64]
    waveform_objective_w: npt.NDArray[np.float64]
    waveform_waveform: npt.NDArray[np.str_]
    worst_belt_belt_velocity: float
    worst_belt_belt_velocity_m_per_s: float


class ExactStabilityColumns:
    """Of :class:`quell.results.ExactStability`."""

    exponent_frequency: npt.NDArray[np.float64]
    exponent_frequency_hz: npt.NDArray[np.float64]
    exponent_growth_rate: npt.NDArray[np.float64]
    exponent_growth_rate_error: npt.NDArray[np.float64]
    frequency_hz: float
    period_s: float
    state_value: npt.NDArray[np.float64]


class FrictionCurveColumns:
    """Of :class:`quell.results.FrictionCurve`."""

    effective_coefficient_error_value: npt.NDArray[np.float64]
    effective_slope_error_s_per_m: list[float | None]
    effective_slope_error_s_per_m_value: npt.NDArray[np.float64]
    effective_slope_error_value: npt.NDArray[np.float64]
    effective_slope_one_sided_value: npt.NDArray[Any]
    effective_slope_s_per_m: list[float | None]
    law_minimum_coefficient: float
    law_range_from: float
    law_range_from_m_per_s: float
    law_range_to: float
    law_range_to_m_per_s: float
    law_reference_velocity: float
    law_reference_velocity_m_per_s: float
    law_static_coefficient: float
    measured_base_value: npt.NDArray[Any]
    measured_verdict_value: npt.NDArray[np.str_]
    slip_velocity_m_per_s: list[float | None]


class MapColumns:
    """Of :class:`quell.results.Map`."""

    amplitude: npt.NDArray[np.float64]
    amplitude_status: npt.NDArray[np.uint8]
    criterion: npt.NDArray[np.float64]
    criterion_sharper: npt.NDArray[np.float64]
    criterion_sharper_status: npt.NDArray[np.uint8]
    criterion_status: npt.NDArray[np.uint8]
    critical_amplitude: npt.NDArray[np.float64]
    critical_amplitude_status: npt.NDArray[np.uint8]
    critical_amplitude_upper: npt.NDArray[np.float64]
    critical_amplitude_upper_status: npt.NDArray[np.uint8]
    destabilising_amplitude: npt.NDArray[Any]
    destabilising_amplitude_status: npt.NDArray[np.uint8]
    dither_power: npt.NDArray[np.float64]
    dither_power_status: npt.NDArray[np.uint8]
    dither_stroke: npt.NDArray[np.float64]
    dither_stroke_status: npt.NDArray[np.uint8]
    effect: npt.NDArray[np.uint8]
    effect_status: npt.NDArray[np.uint8]
    efficiency: npt.NDArray[np.float64]
    efficiency_status: npt.NDArray[np.uint8]
    ends_on: npt.NDArray[Any]
    ends_on_status: npt.NDArray[np.uint8]
    frequency: npt.NDArray[np.float64]
    frequency_status: npt.NDArray[np.uint8]
    growth: npt.NDArray[np.float64]
    growth_error: npt.NDArray[np.float64]
    growth_error_status: npt.NDArray[np.uint8]
    growth_sharper: npt.NDArray[np.float64]
    growth_sharper_status: npt.NDArray[np.uint8]
    growth_status: npt.NDArray[np.uint8]
    growth_undithered: npt.NDArray[np.float64]
    growth_undithered_error: npt.NDArray[np.float64]
    growth_undithered_error_status: npt.NDArray[np.uint8]
    growth_undithered_status: npt.NDArray[np.uint8]
    growth_verdict: npt.NDArray[np.uint8]
    growth_verdict_status: npt.NDArray[np.uint8]
    mean_friction: npt.NDArray[np.float64]
    mean_friction_status: npt.NDArray[np.uint8]
    minimum_normal_load: npt.NDArray[np.float64]
    minimum_normal_load_status: npt.NDArray[np.uint8]
    orbit_radius: npt.NDArray[Any]
    orbit_radius_status: npt.NDArray[np.uint8]
    orbit_verdict: npt.NDArray[Any]
    orbit_verdict_status: npt.NDArray[np.uint8]
    peak_to_peak: npt.NDArray[Any]
    peak_to_peak_status: npt.NDArray[np.uint8]
    quench_amplitude: npt.NDArray[Any]
    quench_amplitude_status: npt.NDArray[np.uint8]
    settled: npt.NDArray[np.uint8]
    settled_status: npt.NDArray[np.uint8]
    slip_ratio: npt.NDArray[np.float64]
    slip_ratio_status: npt.NDArray[np.uint8]
    stick_fraction: npt.NDArray[np.float64]
    stick_fraction_status: npt.NDArray[np.uint8]
    undithered_amplitude: npt.NDArray[np.float64]
    undithered_amplitude_status: npt.NDArray[np.uint8]
    verdict: npt.NDArray[np.uint8]
    verdict_sharper: npt.NDArray[np.uint8]
    verdict_sharper_status: npt.NDArray[np.uint8]
    verdict_status: npt.NDArray[np.uint8]


class ModesColumns:
    """Of :class:`quell.results.Modes`."""

    critical_mode_diameters: Any
    critical_mode_radial: Any
    damping: npt.NDArray[np.float64]
    damping_ratio: npt.NDArray[np.float64]
    diameters: npt.NDArray[np.float64]
    frequency: npt.NDArray[np.float64]
    frequency_hz: npt.NDArray[np.float64]
    frequency_parameter: npt.NDArray[np.float64]
    mode: npt.NDArray[np.float64]
    mode_critical_speed: npt.NDArray[np.float64]
    mode_critical_speed_rpm: npt.NDArray[np.float64]
    mode_damping: npt.NDArray[np.float64]
    mode_damping_ratio: npt.NDArray[np.float64]
    mode_diameters: npt.NDArray[Any]
    mode_frequency: npt.NDArray[np.float64]
    mode_frequency_hz: npt.NDArray[np.float64]
    mode_frequency_parameter: npt.NDArray[np.float64]
    mode_radial: npt.NDArray[Any]
    mode_ratio: npt.NDArray[np.float64]
    mode_shape_at_load: npt.NDArray[np.float64]
    radial: npt.NDArray[np.float64]
    ratio: npt.NDArray[np.float64]
    shape_at_load: npt.NDArray[np.float64]


class NoiseResponseColumns:
    """Of :class:`quell.results.NoiseResponse`."""

    cost_displacement_rms: float
    cost_force_peak: float
    cost_force_rms: float
    cost_power: float
    cost_stroke: float
    cost_velocity_rms: float
    mean_friction_value: float
    seed: npt.NDArray[np.float64]


class OrbitColumns:
    """Of :class:`quell.results.Orbit`."""

    contact_name: npt.NDArray[np.str_]
    contact_open_fraction: npt.NDArray[np.float64]
    contact_stick_fraction: npt.NDArray[np.float64]
    cycle_displacement: npt.NDArray[np.float64]
    cycle_free_phase: npt.NDArray[Any]
    cycle_highest: npt.NDArray[np.float64]
    cycle_highest_velocity: npt.NDArray[np.float64]
    cycle_least_slip_velocity: npt.NDArray[np.float64]
    cycle_lowest: npt.NDArray[np.float64]
    cycle_lowest_velocity: npt.NDArray[np.float64]
    cycle_multiplier_error: npt.NDArray[np.float64]
    cycle_ok: npt.NDArray[Any]
    cycle_period: npt.NDArray[np.float64]
    cycle_protocol: npt.NDArray[np.str_]
    cycle_residual: npt.NDArray[np.float64]
    cycle_reversals: npt.NDArray[Any]
    cycle_sentence: npt.NDArray[np.str_]
    cycle_state_error: npt.NDArray[np.float64]
    cycle_stick_episodes: npt.NDArray[Any]
    cycle_stick_fraction: npt.NDArray[np.float64]
    cycle_velocity: npt.NDArray[np.float64]
    cycle_verdict: npt.NDArray[np.str_]
    displacement_m: float
    displacement_m_value: float
    displacement_value: float
    event_contact: npt.NDArray[Any]
    event_kind: npt.NDArray[np.str_]
    event_slip_sign: npt.NDArray[Any]
    event_time: npt.NDArray[np.float64]
    highest_m: float
    highest_velocity_m_per_s: float
    least_slip_velocity_m_per_s: float
    lowest_m: float
    lowest_velocity_m_per_s: float
    monodromy_value: npt.NDArray[np.float64]
    period_s: float
    residual_m: float
    signature_kind: npt.NDArray[np.str_]
    signature_slip_sign: npt.NDArray[Any]
    state_error_m: float
    state_value: npt.NDArray[np.float64]
    sticking: npt.NDArray[np.float64]
    time: npt.NDArray[np.float64]
    time_s: npt.NDArray[np.float64]
    velocity_m_per_s: float
    velocity_m_per_s_value: float
    velocity_value: float


class ProbabilityColumns:
    """Of :class:`quell.results.Probability`."""

    group_first: npt.NDArray[np.float64]
    group_first_error: npt.NDArray[np.float64]
    group_total: npt.NDArray[np.float64]
    group_total_error: npt.NDArray[np.float64]
    quantiles_growth_0_05_per_s: float
    quantiles_growth_0_5_per_s: float
    quantiles_growth_0_95_per_s: float
    quantiles_growth_sharper_0_05_per_s: float
    quantiles_growth_sharper_0_5_per_s: float
    quantiles_growth_sharper_0_95_per_s: float


class RampColumns:
    """Of :class:`quell.results.Ramp`."""

    displacement: npt.NDArray[np.float64]
    manoeuvre_dither_onset: float
    manoeuvre_overshoot: float
    manoeuvre_time_to_quench: float
    manoeuvre_vibration_amplitude: npt.NDArray[np.float64]
    manoeuvre_vibration_from: npt.NDArray[np.float64]
    manoeuvre_vibration_to: npt.NDArray[np.float64]
    switch_becomes: npt.NDArray[np.str_]
    switch_threshold: npt.NDArray[np.float64]
    switch_time: npt.NDArray[np.float64]
    switch_value: npt.NDArray[np.float64]
    threshold_becomes: npt.NDArray[np.str_]
    threshold_kind: npt.NDArray[np.str_]
    threshold_value: npt.NDArray[np.float64]
    time: npt.NDArray[np.float64]
    value: npt.NDArray[np.float64]
    velocity: npt.NDArray[np.float64]


class RecordFitColumns:
    """Of :class:`quell.results.RecordFit`."""

    fitted: npt.NDArray[np.float64]
    measured: npt.NDArray[np.float64]
    point_residual: npt.NDArray[np.float64]
    time: npt.NDArray[np.float64]


class ResonancesColumns:
    """Of :class:`quell.results.Resonances`."""

    can_be_unstable: npt.NDArray[np.float64]
    clear_clear_value: npt.NDArray[np.float64]
    clear_frequencies: npt.NDArray[np.float64]
    clear_original_suppressed: Any
    clear_speeds: npt.NDArray[np.float64]
    clear_suggestion: float
    clear_there_can_be_unstable: npt.NDArray[Any]
    clear_there_conjugate: npt.NDArray[Any]
    clear_there_harmonic: npt.NDArray[Any]
    clear_there_pair: npt.NDArray[np.str_]
    clear_there_peak_growth: npt.NDArray[np.float64]
    clear_there_reaches_in: npt.NDArray[Any]
    clear_there_speed: npt.NDArray[np.float64]
    clear_there_threshold: npt.NDArray[np.float64]
    clear_there_width: npt.NDArray[np.float64]
    clear_verified_growth_rate: float
    clear_verified_growth_rate_error: float
    clear_verified_growth_rate_value: float
    clear_verified_speed: float
    dithered_can_be_unstable: npt.NDArray[Any]
    dithered_conjugate: npt.NDArray[Any]
    dithered_edges: npt.NDArray[np.float64]
    dithered_edges_hz: npt.NDArray[np.float64]
    dithered_harmonic: npt.NDArray[Any]
    dithered_pair: npt.NDArray[np.str_]
    dithered_peak_growth: npt.NDArray[np.float64]
    dithered_speed: npt.NDArray[np.float64]
    dithered_speed_hz: npt.NDArray[np.float64]
    dithered_speed_rpm: npt.NDArray[np.float64]
    dithered_threshold: npt.NDArray[np.float64]
    dithered_width: npt.NDArray[np.float64]
    dithered_width_hz: npt.NDArray[np.float64]
    frequency: npt.NDArray[np.float64]
    from_hz: float
    harmonic: npt.NDArray[np.float64]
    lower_edge: npt.NDArray[np.float64]
    meeting: npt.NDArray[np.float64]
    peak_growth: npt.NDArray[np.float64]
    response_contact: npt.NDArray[np.str_]
    response_dither: npt.NDArray[Any]
    speed: npt.NDArray[np.float64]
    speeds_hz: list[float | None]
    speeds_hz_value: npt.NDArray[np.float64]
    threshold: npt.NDArray[np.float64]
    to_hz: float
    undithered_can_be_unstable: npt.NDArray[Any]
    undithered_conjugate: npt.NDArray[Any]
    undithered_harmonic: npt.NDArray[Any]
    undithered_pair: npt.NDArray[np.str_]
    undithered_peak_growth: npt.NDArray[np.float64]
    undithered_speed: npt.NDArray[np.float64]
    undithered_speed_hz: npt.NDArray[np.float64]
    undithered_speed_rpm: npt.NDArray[np.float64]
    undithered_threshold: npt.NDArray[np.float64]
    undithered_width: npt.NDArray[np.float64]
    undithered_width_hz: npt.NDArray[np.float64]
    upper_edge: npt.NDArray[np.float64]


class ResponseColumns:
    """Of :class:`quell.results.Response`."""

    amplitude_m: float
    band_displacement_rms_m: float
    band_end_hz: float
    band_from_hz: float
    band_to_hz: float
    band_undithered_displacement_rms_m: float
    band_undithered_velocity_rms_m_per_s: float
    band_velocity_rms_m_per_s: float
    contact_friction_loss: npt.NDArray[np.float64]
    contact_friction_power: npt.NDArray[np.float64]
    contact_friction_power_w: npt.NDArray[np.float64]
    contact_least_normal: npt.NDArray[np.float64]
    contact_least_normal_n: npt.NDArray[np.float64]
    contact_mean_friction: npt.NDArray[np.float64]
    contact_mean_friction_n: npt.NDArray[np.float64]
    contact_mean_friction_undithered: npt.NDArray[np.float64]
    contact_mean_friction_undithered_n: npt.NDArray[np.float64]
    contact_mean_normal: npt.NDArray[np.float64]
    contact_mean_normal_n: npt.NDArray[np.float64]
    contact_name: npt.NDArray[np.str_]
    contact_open_fraction: npt.NDArray[np.float64]
    contact_steady_sliding_friction: npt.NDArray[np.float64]
    contact_steady_sliding_friction_n: npt.NDArray[np.float64]
    contact_stick_fraction: npt.NDArray[np.float64]
    displacement: npt.NDArray[np.float64]
    displacement_m: npt.NDArray[np.float64]
    dither_actuator_power: npt.NDArray[np.float64]
    dither_actuator_power_w: npt.NDArray[np.float64]
    dither_actuator_stroke: npt.NDArray[np.float64]
    dither_actuator_stroke_m: npt.NDArray[np.float64]
    dither_power_w: Any
    dither_stroke_m: Any
    frequency: npt.NDArray[np.float64]
    half_peak_to_peak_m: float
    mean_friction_n: float
    mean_friction_undithered_n: float
    mean_m: float
    minimum_normal_load_n: float
    observed: npt.NDArray[np.float64]
    peak_amplitude: npt.NDArray[np.float64]
    peak_amplitude_m: npt.NDArray[np.float64]
    peak_frequency: npt.NDArray[np.float64]
    peak_frequency_hz: npt.NDArray[np.float64]
    period_s: float
    record_length_s: float
    rms_m: float
    settle_s: float
    spectrum_amplitude: npt.NDArray[np.float64]
    spectrum_amplitude_m: npt.NDArray[np.float64]
    spectrum_frequency_hz: npt.NDArray[np.float64]
    spectrum_undithered_amplitude: npt.NDArray[np.float64]
    spectrum_undithered_amplitude_m: npt.NDArray[np.float64]
    steady_sliding_friction_n: float
    sticking: npt.NDArray[np.float64]
    time: npt.NDArray[np.float64]
    time_s: npt.NDArray[np.float64]
    undithered_amplitude_m: float
    undithered_displacement: npt.NDArray[np.float64]
    undithered_displacement_m: npt.NDArray[np.float64]
    undithered_half_peak_to_peak_m: float
    undithered_mean_m: float
    undithered_observed: npt.NDArray[np.float64]
    undithered_period_s: float
    undithered_rms_m: float
    undithered_sticking: npt.NDArray[np.float64]
    undithered_velocity: npt.NDArray[np.float64]
    undithered_velocity_m_per_s: npt.NDArray[np.float64]
    velocity: npt.NDArray[np.float64]
    velocity_m_per_s: npt.NDArray[np.float64]


class SimulationColumns:
    """Of :class:`quell.results.Simulation`."""

    contact_friction_power: npt.NDArray[np.float64]
    contact_friction_power_w: npt.NDArray[np.float64]
    contact_least_normal: npt.NDArray[np.float64]
    contact_least_normal_n: npt.NDArray[np.float64]
    contact_mean_friction: npt.NDArray[np.float64]
    contact_mean_friction_n: npt.NDArray[np.float64]
    contact_mean_normal: npt.NDArray[np.float64]
    contact_mean_normal_n: npt.NDArray[np.float64]
    contact_name: npt.NDArray[np.str_]
    contact_open_fraction: npt.NDArray[np.float64]
    contact_stick_fraction: npt.NDArray[np.float64]
    displacement: npt.NDArray[np.float64]
    displacement_m: npt.NDArray[np.float64]
    event_contact: npt.NDArray[Any]
    event_counts_landing: Any
    event_counts_release: Any
    event_counts_reversal: Any
    event_counts_separation: Any
    event_counts_stick: Any
    event_displacement: npt.NDArray[np.float64]
    event_displacement_m: npt.NDArray[np.float64]
    event_kind: npt.NDArray[np.str_]
    event_slip_sign: npt.NDArray[Any]
    event_time: npt.NDArray[np.float64]
    event_time_s: npt.NDArray[np.float64]
    event_velocity: npt.NDArray[np.float64]
    event_velocity_m_per_s: npt.NDArray[np.float64]
    final_contact_friction: npt.NDArray[np.float64]
    final_contact_friction_n: npt.NDArray[np.float64]
    final_contact_name: npt.NDArray[np.str_]
    final_contact_normal: npt.NDArray[np.float64]
    final_contact_normal_n: npt.NDArray[np.float64]
    final_contact_open: npt.NDArray[Any]
    final_contact_slip_sign: npt.NDArray[Any]
    final_contact_slip_velocity: npt.NDArray[np.float64]
    final_contact_slip_velocity_m_per_s: npt.NDArray[np.float64]
    final_contact_sticking: npt.NDArray[Any]
    final_displacement: float
    final_displacement_m: float
    final_friction: float
    final_normal_load: float
    final_slip_sign: Any
    final_state_value: npt.NDArray[np.float64]
    final_sticking: Any
    final_time: float
    final_time_s: float
    final_velocity: float
    final_velocity_m_per_s: float
    growth_observed_per_s: float | None
    leading_frequency_hz: float
    leading_growth_rate_per_s: float
    manoeuvre_dither_onset: float
    manoeuvre_overshoot: float
    manoeuvre_time_to_quench: float
    manoeuvre_vibration_amplitude: npt.NDArray[np.float64]
    manoeuvre_vibration_from: npt.NDArray[np.float64]
    manoeuvre_vibration_to: npt.NDArray[np.float64]
    slip_velocity: npt.NDArray[np.float64]
    slip_velocity_m_per_s: npt.NDArray[np.float64]
    sound_clipped: Any
    sound_duration_s: float
    sound_gain: float
    sound_natural_frequency_hz: float
    sound_sample_rate: Any
    sound_strongest_frequency_hz: float
    sound_transposition: float
    start_amplitude: float
    start_displacement: float
    start_displacement_m: float
    start_state_value: npt.NDArray[np.float64]
    start_time: float
    start_time_s: float
    start_velocity: float
    start_velocity_m_per_s: float
    sticking: npt.NDArray[np.float64]
    time: npt.NDArray[np.float64]
    time_s: npt.NDArray[np.float64]
    velocity: npt.NDArray[np.float64]
    velocity_m_per_s: npt.NDArray[np.float64]


class StabilityColumns:
    """Of :class:`quell.results.Stability`."""

    change_frequency: npt.NDArray[np.float64]
    change_friction: npt.NDArray[np.float64]
    contact_effective_coefficient: npt.NDArray[np.float64]
    contact_friction: npt.NDArray[np.float64]
    contact_friction_n: npt.NDArray[np.float64]
    contact_load_amplitude: npt.NDArray[np.float64]
    contact_load_amplitude_n: npt.NDArray[np.float64]
    contact_name: npt.NDArray[np.str_]
    contact_normal: npt.NDArray[np.float64]
    contact_normal_n: npt.NDArray[np.float64]
    contact_ratchet_force: npt.NDArray[np.float64]
    contact_ratchet_force_n: npt.NDArray[np.float64]
    contact_slip_amplitude: npt.NDArray[np.float64]
    contact_slip_amplitude_m_per_s: npt.NDArray[np.float64]
    contact_slope_by_velocity: npt.NDArray[np.float64]
    contact_slope_by_velocity_n_s_per_m: npt.NDArray[np.float64]
    critical_amplitude_amplitude: npt.NDArray[np.float64]
    critical_amplitude_amplitude_error: npt.NDArray[np.float64]
    critical_amplitude_amplitude_error_n: npt.NDArray[np.float64]
    critical_amplitude_amplitude_n: npt.NDArray[np.float64]
    critical_amplitude_amplitude_ratio: npt.NDArray[np.float64]
    critical_amplitude_amplitude_ratio_error: npt.NDArray[np.float64]
    critical_amplitude_amplitude_ratio_error_m_per_s: npt.NDArray[np.float64]
    critical_amplitude_amplitude_ratio_m_per_s: npt.NDArray[np.float64]
    critical_amplitude_becomes: npt.NDArray[np.str_]
    critical_amplitude_contact_stays_closed: npt.NDArray[Any]
    critical_amplitude_contacts_stay_closed: npt.NDArray[Any]
    critical_amplitude_kind: npt.NDArray[np.str_]
    critical_amplitude_within_law_ranges: npt.NDArray[Any]
    critical_speed_diameters: npt.NDArray[Any]
    critical_speed_mode: npt.NDArray[Any]
    critical_speed_near: npt.NDArray[Any]
    critical_speed_speed: npt.NDArray[np.float64]
    critical_speed_speed_rpm: npt.NDArray[np.float64]
    everywhere_stable_amplitude_n: float
    everywhere_stable_amplitude_ratio_m_per_s: float
    frequency_hz: float
    growth_rate_db_per_s: float
    growth_rate_per_s: float
    motion_damping_ratio: npt.NDArray[np.float64]
    motion_error: npt.NDArray[np.float64]
    motion_frequency: npt.NDArray[np.float64]
    motion_frequency_hz: npt.NDArray[np.float64]
    motion_growth_rate: npt.NDArray[np.float64]
    sharper_criterion: float
    sharper_critical_amplitude_amplitude: npt.NDArray[np.float64]
    sharper_critical_amplitude_amplitude_n: npt.NDArray[np.float64]
    sharper_critical_amplitude_amplitude_ratio: npt.NDArray[np.float64]
    sharper_critical_amplitude_amplitude_ratio_error: npt.NDArray[np.float64]
    sharper_critical_amplitude_amplitude_ratio_error_m_per_s: npt.NDArray[np.float64]
    sharper_critical_amplitude_amplitude_ratio_m_per_s: npt.NDArray[np.float64]
    sharper_critical_amplitude_becomes: npt.NDArray[np.str_]
    sharper_critical_amplitude_contact_stays_closed: npt.NDArray[Any]
    sharper_critical_amplitude_kind: npt.NDArray[np.str_]
    sharper_effective_coefficient: float
    sharper_error: float
    sharper_everywhere_stable_amplitude: float
    sharper_everywhere_stable_amplitude_n: float
    sharper_everywhere_stable_amplitude_ratio: float
    sharper_everywhere_stable_amplitude_ratio_m_per_s: float
    sharper_growth_rate: float
    sharper_growth_rate_db_per_s: float
    sharper_growth_rate_per_s: float
    sharper_one_sided: Any
    sharper_unstable_belt_velocity_lower: npt.NDArray[np.float64]
    sharper_unstable_belt_velocity_lower_kind: npt.NDArray[np.str_]
    sharper_unstable_belt_velocity_lower_m_per_s: npt.NDArray[np.float64]
    sharper_unstable_belt_velocity_upper: npt.NDArray[np.float64]
    sharper_unstable_belt_velocity_upper_m_per_s: npt.NDArray[np.float64]
    speed_at_load_km_per_h: float
    speed_at_load_m_per_s: float
    speed_hz: float
    speed_rpm: float
    undithered_frequency: float
    undithered_frequency_hz: float
    undithered_growth_rate: float
    undithered_growth_rate_error: float
    unstable_belt_velocity_lower: npt.NDArray[np.float64]
    unstable_belt_velocity_lower_kind: npt.NDArray[np.str_]
    unstable_belt_velocity_lower_m_per_s: npt.NDArray[np.float64]
    unstable_belt_velocity_upper: npt.NDArray[np.float64]
    unstable_belt_velocity_upper_m_per_s: npt.NDArray[np.float64]


class ThresholdCurvesColumns:
    """Of :class:`quell.results.ThresholdCurves`."""

    amplitude_ratio: npt.NDArray[np.float64]
    averaged_sharper: npt.NDArray[Any]
    between_value: npt.NDArray[np.float64]
    curve: npt.NDArray[np.float64]
    curve_contact: npt.NDArray[np.str_]
    curve_kind: npt.NDArray[np.str_]
    displacement: npt.NDArray[np.float64]
    kind: npt.NDArray[np.uint8]
    multiplier_modulus: npt.NDArray[np.float64]
    point: npt.NDArray[np.float64]
    state_carriage: npt.NDArray[np.float64]
    state_motor: npt.NDArray[np.float64]
    state_velocity_carriage: npt.NDArray[np.float64]
    state_velocity_motor: npt.NDArray[np.float64]
    velocity: npt.NDArray[np.float64]


class ThresholdsColumns:
    """Of :class:`quell.results.Thresholds`."""

    branch: npt.NDArray[np.float64]
    frequency: npt.NDArray[np.float64]
    from_n: float
    from_rest_becomes: npt.NDArray[np.str_]
    from_rest_error: npt.NDArray[np.float64]
    from_rest_value: npt.NDArray[np.float64]
    from_sliding_becomes: npt.NDArray[np.str_]
    from_sliding_error: npt.NDArray[np.float64]
    from_sliding_value: npt.NDArray[np.float64]
    from_squeal_becomes: npt.NDArray[np.str_]
    from_squeal_error: npt.NDArray[np.float64]
    from_squeal_value: npt.NDArray[np.float64]
    from_start_becomes: npt.NDArray[np.str_]
    from_start_error: npt.NDArray[np.float64]
    from_start_value: npt.NDArray[np.float64]
    growth_rate: npt.NDArray[np.float64]
    local_becomes: npt.NDArray[np.str_]
    local_contact: npt.NDArray[np.str_]
    local_criticality: npt.NDArray[np.float64]
    local_criticality_reason: npt.NDArray[np.str_]
    local_displacement: npt.NDArray[np.float64]
    local_displacement_m: npt.NDArray[np.float64]
    local_error: npt.NDArray[np.float64]
    local_error_n: npt.NDArray[np.float64]
    local_first_lyapunov_coefficient: npt.NDArray[np.float64]
    local_first_lyapunov_coefficient_error: npt.NDArray[np.float64]
    local_frequency: npt.NDArray[np.float64]
    local_kind: npt.NDArray[np.str_]
    local_opens_towards: npt.NDArray[np.float64]
    local_quadratic_coefficient: npt.NDArray[np.float64]
    local_quadratic_coefficient_error: npt.NDArray[np.float64]
    local_radius_above: npt.NDArray[np.float64]
    local_radius_below: npt.NDArray[np.float64]
    local_value: npt.NDArray[np.float64]
    local_value_n: npt.NDArray[np.float64]
    local_velocity: npt.NDArray[np.float64]
    local_velocity_m_per_s: npt.NDArray[np.float64]
    local_was: npt.NDArray[np.str_]
    point: npt.NDArray[np.float64]
    radius: npt.NDArray[np.float64]
    signature_change_above: npt.NDArray[np.str_]
    signature_change_below: npt.NDArray[np.str_]
    signature_change_value: npt.NDArray[np.float64]
    signature_change_value_n: npt.NDArray[np.float64]
    state_carriage: npt.NDArray[np.float64]
    state_motor: npt.NDArray[np.float64]
    state_velocity_carriage: npt.NDArray[np.float64]
    state_velocity_motor: npt.NDArray[np.float64]
    threshold_becomes: npt.NDArray[np.str_]
    threshold_contact: npt.NDArray[np.str_]
    threshold_criticality: npt.NDArray[np.float64]
    threshold_criticality_reason: npt.NDArray[np.str_]
    threshold_error: npt.NDArray[np.float64]
    threshold_first_lyapunov_coefficient: npt.NDArray[np.float64]
    threshold_first_lyapunov_coefficient_error: npt.NDArray[np.float64]
    threshold_frequency: npt.NDArray[np.float64]
    threshold_kind: npt.NDArray[np.str_]
    threshold_opens_towards: npt.NDArray[np.float64]
    threshold_quadratic_coefficient: npt.NDArray[np.float64]
    threshold_quadratic_coefficient_error: npt.NDArray[np.float64]
    threshold_radius_above: npt.NDArray[np.float64]
    threshold_radius_below: npt.NDArray[np.float64]
    threshold_value: npt.NDArray[np.float64]
    threshold_was: npt.NDArray[np.str_]
    to_n: float


class TrackedStabilityColumns:
    """Of :class:`quell.results.TrackedStability`."""

    between_value: npt.NDArray[np.float64]
    branch: npt.NDArray[np.float64]
    curve: npt.NDArray[np.float64]
    curve_becomes: npt.NDArray[np.str_]
    curve_kind: npt.NDArray[np.str_]
    curve_was: npt.NDArray[np.str_]
    eigenvalues_frequency: npt.NDArray[np.float64]
    eigenvalues_growth_rate: npt.NDArray[np.float64]
    frequency: npt.NDArray[np.float64]
    growth_rate: npt.NDArray[np.float64]
    kind: npt.NDArray[np.uint8]
    local_becomes: npt.NDArray[np.str_]
    local_criticality: npt.NDArray[np.float64]
    local_criticality_reason: npt.NDArray[np.str_]
    local_error: npt.NDArray[np.float64]
    local_first_lyapunov_coefficient: npt.NDArray[np.float64]
    local_first_lyapunov_coefficient_error: npt.NDArray[np.float64]
    local_frequency: npt.NDArray[np.float64]
    local_kind: npt.NDArray[np.str_]
    local_value: npt.NDArray[np.float64]
    local_was: npt.NDArray[np.str_]
    point: npt.NDArray[np.float64]
    threshold_becomes: npt.NDArray[np.str_]
    threshold_criticality: npt.NDArray[np.float64]
    threshold_criticality_reason: npt.NDArray[np.str_]
    threshold_error: npt.NDArray[np.float64]
    threshold_first_lyapunov_coefficient: npt.NDArray[np.float64]
    threshold_first_lyapunov_coefficient_error: npt.NDArray[np.float64]
    threshold_frequency: npt.NDArray[np.float64]
    threshold_kind: npt.NDArray[np.str_]
    threshold_value: npt.NDArray[np.float64]
    threshold_was: npt.NDArray[np.str_]


class WaveformsColumns:
    """Of :class:`quell.results.Waveforms`."""

    amplitude_n: npt.NDArray[np.float64]
    best_amplitude: float
    best_power: float
    best_root_mean_square: float
    best_stroke: float
    best_velocity: float
    exact_amplitude_n: npt.NDArray[np.float64]
    number: npt.NDArray[np.float64]
    power_w: npt.NDArray[np.float64]
    root_mean_square_n: npt.NDArray[np.float64]
    stroke_m: npt.NDArray[np.float64]
    velocity_m_per_s: npt.NDArray[np.float64]
    waveform: npt.NDArray[np.uint8]
    waveform_amplitude: npt.NDArray[np.float64]
    waveform_amplitude_n: npt.NDArray[np.float64]
    waveform_amplitude_ratio: npt.NDArray[np.float64]
    waveform_amplitude_ratio_m_per_s: npt.NDArray[np.float64]
    waveform_duty_cycle: npt.NDArray[np.float64]
    waveform_exact_amplitude: npt.NDArray[np.float64]
    waveform_exact_amplitude_n: npt.NDArray[np.float64]
    waveform_label: npt.NDArray[np.str_]
    waveform_off: npt.NDArray[np.float64]
    waveform_on: npt.NDArray[np.float64]
    waveform_own: npt.NDArray[Any]
    waveform_power: npt.NDArray[np.float64]
    waveform_power_w: npt.NDArray[np.float64]
    waveform_root_mean_square: npt.NDArray[np.float64]
    waveform_root_mean_square_n: npt.NDArray[np.float64]
    waveform_slow: npt.NDArray[Any]
    waveform_stroke: npt.NDArray[np.float64]
    waveform_stroke_m: npt.NDArray[np.float64]
    waveform_until: npt.NDArray[np.float64]
    waveform_until_n: npt.NDArray[np.float64]
    waveform_velocity: npt.NDArray[np.float64]
    waveform_velocity_m_per_s: npt.NDArray[np.float64]
    waveform_waveform: npt.NDArray[np.str_]


class WindowColumns:
    """Of :class:`quell.results.Window`."""

    amplitude_m: float
    contact_friction_power: npt.NDArray[np.float64]
    contact_friction_power_w: npt.NDArray[np.float64]
    contact_least_normal: npt.NDArray[np.float64]
    contact_least_normal_n: npt.NDArray[np.float64]
    contact_mean_friction: npt.NDArray[np.float64]
    contact_mean_friction_n: npt.NDArray[np.float64]
    contact_mean_normal: npt.NDArray[np.float64]
    contact_mean_normal_n: npt.NDArray[np.float64]
    contact_name: npt.NDArray[np.str_]
    contact_open_fraction: npt.NDArray[np.float64]
    contact_stick_fraction: npt.NDArray[np.float64]
    displacement: npt.NDArray[np.float64]
    from_s: float
    mean_m: float
    rms_m: float
    strongest_amplitude_m: float
    strongest_frequency_hz: float
    time: npt.NDArray[np.float64]
    to_s: float
