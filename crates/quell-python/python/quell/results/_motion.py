"""Results about one motion: trajectories, responses, orbits, attractors."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .._frozen import FrozenDict, Records
from .._result import Result, numbers_of
from ._steady import Verdict

if TYPE_CHECKING:
    import pandas

    from .._tables import Number


class Simulation(Result):
    """A trajectory: its end, its events, its samples."""

    verb = "simulate"
    final: FrozenDict[Any]
    """``time``, observed ``displacement`` and ``velocity``, ``state`` and ``contacts`` at the end: ``name``, ``slip_velocity``,
    ``sticking``, ``open``, ``slip_sign``, ``friction``, ``normal`` of each."""
    events: Records
    """``time``, ``contact``, ``kind`` ("stick", "release", "reversal", "separation", "landing"), ``slip_sign``, observed
    ``displacement`` and ``velocity``, and ``state`` of every event."""
    manoeuvre: FrozenDict[Any]
    """Where drive, load or dither varies in time: ``vibration`` (``from``, ``to``, ``amplitude`` of each interval),
    ``dither_onset``, ``time_to_quench`` and ``overshoot``."""
    event_count: int
    """Number of events, including those that were not kept."""
    sound: FrozenDict[Any]
    """With ``sound``: ``sample_rate``, ``duration_s``, ``transposition``, ``natural_frequency_hz`` (where the lowest one sounds),
    ``strongest_frequency_hz``, ``gain`` and ``clipped`` of the file that ``save("run.wav")`` writes."""
    event_counts: FrozenDict[int]
    """Number of events of each kind."""
    contacts: Records
    """``name``, ``event_counts``, ``stick_fraction``, ``open_fraction``, ``mean_friction``, ``mean_normal``, ``least_normal``,
    ``friction_power`` of every contact over the run."""
    state_names: list[str]
    """Names of the numbers of ``state``."""
    amplitude: float | None
    """Disc: half the peak-to-peak deflection under the first load over the last tenth of the run."""
    growth_observed: float | None
    """Disc: growth rate of the extremes of that deflection while the motion is small, in ω_ref."""
    start: FrozenDict[Any]
    """``time`` and state at the begin, as in ``final``; of a disc also the ``amplitude`` of its small motion."""
    steps: int
    """Number of steps of the integration."""
    near_tangential_releases: int
    """Number of releases that barely crossed the stiction threshold, where forward uniqueness is not guaranteed."""
    tolerance: float
    """Bound on the last retained Taylor terms of a step."""
    leading_growth_rate: float
    """Disc: growth rate of the small motion at the start, in ω_ref."""
    leading_frequency: float
    """Disc: frequency of that motion, in ω_ref."""
    time: npt.NDArray[np.float64]
    """Time of each sample (n,)."""
    displacement: npt.NDArray[np.float64]
    """Observed displacement (n,)."""
    velocity: npt.NDArray[np.float64]
    """Observed velocity (n,)."""
    belt_slip_velocity: npt.NDArray[np.float64]
    """Belt: slip velocity (n,)."""
    belt_friction: npt.NDArray[np.float64]
    """Belt: friction force (n,)."""
    belt_normal: npt.NDArray[np.float64]
    """Belt: normal load (n,)."""
    belt_phase: npt.NDArray[np.uint8]
    """Belt: code of slip, stick or open (n,)."""

    def events_frame(self) -> pandas.DataFrame:
        """The events as a pandas DataFrame, one row for each, in the units of the study.

        Columns are ``time``, ``contact``, ``contact_name``, ``kind``, ``slip_sign``, ``displacement``, ``velocity`` and every number
        of the state.
        """
        from .._export import events_frame

        return events_frame(self)

    def continued(
        self,
        until: Number | None = None,
        *,
        events: bool = True,
        samples: bool = True,
        t_eval: npt.ArrayLike | None = None,
    ) -> Simulation:
        """The run from the end of this one on; together they have the events and samples of one long run.

        Parameters
        ----------
        until, events, samples, t_eval :
            As in :meth:`quell.Study.simulate`; times count from the begin of the first run.
        """
        return self.study.simulate(until, events=events, samples=samples, t_eval=t_eval, start=self.final)


class Window(Result):
    """What a run does between two of its times."""

    verb = "response --window"
    from_: float
    """Beginning of the window."""
    to: float
    """Its end."""
    mean: float
    """Mean displacement."""
    rms: float
    """Root mean square of the displacement about its mean."""
    amplitude: float
    """Half of the peak-to-peak displacement."""
    strongest_amplitude: float | None
    """Amplitude of the largest line of the spectrum."""
    strongest_frequency: float | None
    """Its frequency."""
    contacts: Records
    """What each contact did on average: ``stick_fraction``, ``open_fraction``, ``mean_friction``, ``mean_normal``,
    ``least_normal``, ``friction_power``."""
    time: npt.NDArray[np.float64]
    """Time of each sample (n,)."""
    displacement: npt.NDArray[np.float64]
    """Observed displacement (n,)."""


class NoiseResponse(Result):
    """The response under noise: runs with different seeds."""

    verb = "response"
    runs: int
    """Number of runs; run k has the seed of the study plus k."""
    quiet_below: float
    """Residual vibration below which a run counts as quiet."""
    quiet_runs: int | None
    """Number of quiet runs."""
    quiet_fraction: float | None
    """Their share."""
    quiet_fraction_low: float | None
    """Lower end of its interval."""
    quiet_fraction_high: float | None
    """Upper end of its interval."""
    interval: str
    """The interval: "Wilson, 95 %"."""
    averaged_growth_rate: float | None
    """Largest growth rate of small slow motions, averaged over the Gaussian distribution of the noise."""
    seeds: list[int]
    """Seed of the first noise in each run."""
    residual_vibration: list[float]
    """Residual vibration E (2.27) of each run."""
    residual_vibration_least: float | None
    """Least E."""
    residual_vibration_median: float | None
    """Median of E."""
    residual_vibration_largest: float | None
    """Largest E."""
    amplitude: list[float]
    """Largest spectral amplitude of each run in the band of slow vibration."""
    undithered_amplitude: float
    """The same without dither."""
    contacts: Records
    """``stick_fraction`` (one of each run), ``mean_friction`` and ``mean_friction_undithered`` of every contact."""
    dithers: Records
    """``force_rms``, ``displacement_rms``, ``velocity_rms`` and ``power`` of every dither at its point; peaks have no value."""
    band_end: float
    """Upper end of the band."""
    settle: float
    """Time before the record."""
    record_length: float
    """Length of the record."""
    seed: npt.NDArray[np.float64]
    """Seed of each run (n,)."""
    stick_fraction: npt.NDArray[np.float64]
    """Fraction of the record in stick (n,)."""
    mean_friction: npt.NDArray[np.float64]
    """Mean friction (n,)."""


class Response(Result):
    """The steady response with and without dither."""

    verb = "response"
    effect: str
    """Effect of the dither: "quenches", "reduces", "increases", "causes" (quiet without, vibrating with), "quiet" or
    "unknown"."""
    ends_on: str
    """The motion on which the run ends: "period-1", "locked", "quasi-periodic", "not-periodic", "limit-cycle", "rest",
    "unstable-sliding", "drift" or "unknown"."""
    base_response: bool | None
    """Whether that is the response that continues steady sliding as the dither grows."""
    quiet: bool | None
    """Whether it has no slow vibration of its own."""
    amplitude: float
    """Largest spectral amplitude in the band of slow vibration: a length."""
    undithered_amplitude: float
    """The same without dither."""
    residual_vibration: float | None
    """Residual vibration E = amplitude / undithered amplitude (2.27)."""
    level_db: float | None
    """20 lg E, in dB."""
    settled: bool
    """Whether both halves of the record have the same amplitude."""
    undithered_settled: bool
    """The same without dither."""
    peaks: Records
    """Peaks of the spectrum: ``frequency``, ``amplitude``."""
    band_displacement_level_db: float | None
    """Change of the level of the displacement in the band of the study, in dB."""
    band_velocity_level_db: float | None
    """The same for the velocity."""
    band_displacement_rms: float | None
    """Root mean square of the displacement in the band: a length."""
    band_undithered_displacement_rms: float | None
    """The same without dither."""
    band_velocity_rms: float | None
    """Root mean square of the velocity in the band: a length."""
    band_undithered_velocity_rms: float | None
    """The same without dither."""
    half_peak_to_peak: float
    """Half of the peak-to-peak value of ``observe``."""
    rms: float
    """Root mean square of ``observe`` about its mean."""
    mean: float
    """Mean of ``observe``."""
    undithered_half_peak_to_peak: float
    """``half_peak_to_peak`` without dither."""
    undithered_rms: float
    """``rms`` without dither."""
    undithered_mean: float
    """``mean`` without dither."""
    undithered_ends_on: str
    """``ends_on`` without dither."""
    undithered_base_response: bool | None
    """``base_response`` without dither."""
    undithered_quiet: bool | None
    """``quiet`` without dither."""
    period: float | None
    """Period of that motion, if it is periodic."""
    undithered_period: float | None
    """The same without dither."""
    near_tangential_releases: int
    """Number of releases that barely crossed the stiction threshold."""
    band_end: float
    """Upper end of the band of ``amplitude`` and ``residual_vibration``, an angular frequency."""
    contacts: Records
    """``name``, ``stick_fraction``, ``open_fraction``, ``mean_friction``, ``mean_normal``, ``least_normal``, ``friction_power``,
    ``mean_friction_undithered``, ``steady_sliding_friction`` and ``friction_loss`` of every contact."""
    dithers: Records
    """``power`` that each dither feeds in, and the peak-to-peak ``stroke`` of the point on which it acts."""
    band_from: float | None
    """Lower end of the band of the study."""
    band_to: float | None
    """Upper end of the band of the study."""
    settle: float
    """Time before the record."""
    record_length: float
    """Length of the record."""
    time: npt.NDArray[np.float64]
    """Time of each sample (n,)."""
    displacement: npt.NDArray[np.float64]
    """Observed displacement (n,)."""
    velocity: npt.NDArray[np.float64]
    """Observed velocity (n,)."""
    undithered_displacement: npt.NDArray[np.float64]
    """The displacement without dither (n,)."""
    undithered_velocity: npt.NDArray[np.float64]
    """The velocity without dither (n,)."""
    frequency: npt.NDArray[np.float64]
    """Angular frequency (m,) of the spectrum."""
    spectrum_amplitude: npt.NDArray[np.float64]
    """Amplitude (m,) of the displacement."""
    spectrum_undithered_amplitude: npt.NDArray[np.float64]
    """The same without dither (m,)."""


class Orbit(Result):
    """A periodic response and its Floquet multipliers."""

    verb = "orbit"
    response: str
    """"base", "near", "reached" or "limit-cycle"."""
    free_phase: bool | None
    """Whether it is a limit cycle, whose phase is free; ``None`` for steady sliding."""
    displacement: float | None
    """Observed displacement at t = 0; ``None`` if there is no orbit."""
    velocity: float | None
    """Observed velocity at t = 0; ``None`` if there is no orbit."""
    state_names: list[str]
    """Names of the numbers of ``state``."""
    state: list[float] | None
    """The state at t = 0."""
    period: float | None
    """Period; ``None`` if there is no orbit."""
    periods: int
    """Number of common periods of the dithers in one period of the response."""
    monodromy: list[list[float]] | None
    """Matrix that maps a small change of the state to that after one period; ``None`` of a limit cycle, whose phase is free."""
    radius: float | None
    """Modulus of the decisive multiplier."""
    verdict: Verdict
    """Whether small deviations decay."""
    one_sided: bool
    """Whether the multipliers are those of changes to one side only."""
    residual: float
    """Distance of the state from itself after one period."""
    state_error: float | None
    """Estimated error of the state; ``None`` if a multiplier is too close to 1."""
    multiplier_error: float | None
    """Estimated error of the modulus of the decisive multiplier; ``None`` as for ``state_error``."""
    protocol: str
    """How the stability was judged."""
    lowest: float | None
    """Least observed displacement."""
    highest: float | None
    """Largest observed displacement."""
    lowest_velocity: float | None
    """Least observed velocity."""
    highest_velocity: float | None
    """Largest observed velocity."""
    events: Records
    """``time``, ``contact``, ``kind``, ``slip_sign`` and ``state`` of the events of a period."""
    contacts: Records
    """``name``, ``signature``, ``stick_episodes``, ``reversals``, ``least_slip_velocity``, ``stick_fraction`` and
    ``open_fraction`` of every contact."""
    start: str
    """The start of the run that was followed, in words."""
    periods_to_settle: int
    """Periods of the dither until that run was near the response."""
    cycles: Records | None
    """Without dither: every limit cycle, each with all of these facts; ``None`` where they are not all known."""
    tried: list[str]
    """Without dither: the starts from which a limit cycle was searched."""
    steady_sliding: str
    """Without dither: the verdict on steady sliding."""
    time: npt.NDArray[np.float64]
    """Time of each sample (n,) of a period."""
    belt_slip_velocity: npt.NDArray[np.float64]
    """Belt: slip velocity (n,)."""
    belt_friction: npt.NDArray[np.float64]
    """Belt: friction force (n,)."""
    belt_normal: npt.NDArray[np.float64]
    """Belt: normal load (n,)."""
    belt_phase: npt.NDArray[np.uint8]
    """Belt: code of slip, stick or open (n,)."""

    @property
    def multipliers(self) -> npt.NDArray[np.complex128]:
        """The multipliers, the largest first; empty if there is no orbit (see ``why``)."""
        return numbers_of(self.facts["multipliers"] or [])


class Attractor(Result):
    """The motion on which a run ends, and its Lyapunov exponents."""

    verb = "attractor"
    start: str
    """The start in words."""
    attractor: FrozenDict[Any] | None
    """``kind``, ``quiet``, ``periods``, ``multiplier``, ``lowest``, ``highest``, …; ``None`` if the run did not settle."""
    periods_until_settled: int | None
    """Periods of the dither until the run was near the motion."""
    lyapunov: FrozenDict[Any] | None
    """With ``lyapunov=True``, or ``None`` with the reason in ``why``: ``exponents`` (largest first; ``None`` where a stick erases
    the direction, −∞) with their standard ``errors``, per unit of time; ``time`` of the record and ``settle`` before it;
    ``verdict`` ("regular", "irregular (chaotic)", "unknown"); ``deciding``, the largest exponent apart from the 0 of a shift in
    time, whose place is ``shift_in_time``; ``kaplan_yorke_dimension``; ``of_multiplier``, the same rate by the multipliers of a
    periodic motion, and ``agrees_with_multipliers``."""
    time: npt.NDArray[np.float64]
    """Time of each sample (n,) of the motion."""
