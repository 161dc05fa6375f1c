//! Integrates runs side by side, in blocks of periods, until each has settled.
//!
//! After each block a run ends for one of these reasons:
//! 1. **Base.** The run is at the base response, which is not unstable; or the base response is stable and the distance from it
//!    decreases at the rate of the multipliers (`crate::decay`, in two consecutive blocks), so that its limit is known.
//! 2. **Elsewhere.** Centre, size and shape of the section no longer change, from block to block or from one long window of
//!    blocks to the next, and their remaining change at the measured rate is below the requested closeness. This is sufficient
//!    if the block contains a stick: the motion after a stick depends only on the time of release. If the mass slips throughout,
//!    areas of the phase plane must also shrink, and fast enough for the remaining change.
//! 3. **Unsettled**, when its periods are used up: the section still changes, or the run stays near a curve that does not attract.
//!
//! A start on an unstable base response would stay there until rounding displaces it: it is displaced by
//! `NUDGE` F first.
//!
//! Without dither no run is judged in this way: the exact cycle map decides ([`cycles`]).
//!
//! Runs do not affect each other: the outcome of a run has the same bits alone and together with other runs.
//!
//! Two cases can be misjudged. A run that decays at the linear rate is assigned to the base response
//! although another attractor could exist that close to it. And a quasi-periodic response with sticks that is about to lock
//! changes along its curve without changing size, so that it counts as settled.

use super::average::{self, Moments};
use super::base_response::BaseResponse;
use super::block_observer::BlockObserver;
use super::settings::AttractorSettings;
use super::unsettled::Unsettled;
use crate::decay::decays_at;
use crate::orbit::{CycleMapError, Orbit, OrbitVerdict, cycle_reached, cycles};
use crate::simulation::{
    DEFAULT_TOLERANCE, FinalState, SimulationRun, Stalled, Start, simulate, simulate_many,
};

/// Slow cycles of 2π in a block. With fewer, averages would depend on the phase at which the block starts and ends, and a settled
/// run would seem to change. More cycles only take longer.
const CYCLES_PER_BLOCK: f64 = 20.0;

/// Fewest periods of the section in a block: a quarter of them, 16 states, gives the decay rate. With fewer, the moments of the
/// section would scatter from block to block under slow dither; more periods only take longer.
const FEWEST: usize = 64;

/// Distance from the base response, relative to F, that counts as being on it: a thousandth of the smallest vibration
/// that the figures show, and far above the effect of rounding. Another attractor nearer than this would be missed.
const NEAR: f64 = 1e-6;

/// Displacement of a start on an unstable base response, relative to F: far above rounding, so that the run leaves in time, and
/// far below the size of any other response. An attractor closer than this to the unstable response could be missed.
const NUDGE: f64 = 1e-4;

/// Size of a section, relative to F, below which it is one state: a tenth of [`NEAR`], far above the engine's error. With a
/// larger value a small slow motion would be overlooked; with a smaller one the engine's error would count as a motion that
/// never settles.
const POINT: f64 = 1e-7;

/// Distance of states, relative to F, within which they are one state of the attractor: the distance within which a state
/// counts as the base response, so that both agree. An attractor smaller than this is taken for a single state.
pub(super) const ONE_STATE: f64 = NEAR;

/// Fewest blocks whose quarters are compared, and twice the number between two comparisons. A size that changes by less
/// than a third of 10⁻³ between two windows of 8 blocks changes by less than 7·10⁻⁷ per period (with 64 periods per block, the
/// fewest): closer to a threshold than that, a run is taken for settled although it still changes. More blocks only take longer.
const WINDOWS: usize = 32;

/// Longest run τ, 32 000 slow periods: 1.6 times the length of the 200 000 periods of [`Patience::SWEEP`] at R = 10. With a
/// slower section a run would otherwise take minutes. With a smaller limit, runs close to a threshold would be reported as
/// unsettled.
const LONGEST: f64 = 2e5;

/// Ratio of two consecutive changes below which the changes shrink geometrically, so that the remaining change is a geometric
/// sum. With a value nearer to 1 the error of the ratio would dominate the sum; with a smaller value a slow convergence would be
/// recognised later.
const GEOMETRIC: f64 = 0.9;

/// Factor by which the previous change may exceed the allowed one in a geometric sum: two changes that differ much more are not
/// yet geometric. With a larger value a transient could pass for convergence; a smaller value only takes longer.
const LARGEST_CHANGE_BEFORE: f64 = 10.0;

/// Fraction of the allowed change that suffices after sticks in two consecutive blocks, which erase the history. With a
/// larger value a slow change of the release could pass; a smaller value only takes longer.
const AFTER_STICKS: f64 = 0.1;

/// Fraction of the allowed change within which three fluctuating changes must add up to no change. With a larger value a trend
/// could hide in the fluctuation; with a smaller one a curve that is nearly locked would not settle.
const NET_CHANGE: f64 = 0.5;

/// Divisor of the allowed change for each of three fluctuating changes, and for the change between two windows, so that all three
/// together stay within the allowed one. With a smaller value a trend could pass for a fluctuation; a larger value only takes
/// longer.
const FLUCTUATIONS: f64 = 3.0;

/// How long a run may take, and how closely it must settle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patience {
    /// Bound on the last retained Taylor terms of a step, relative to F.
    pub tolerance: f64,
    /// Remaining change of centre, size and shape of the section that is accepted, relative to its size.
    pub closeness: f64,
    /// Most periods of a run.
    pub periods: u64,
}

impl Patience {
    /// For one response that is to be measured: sizes are known to a thousandth, and 200 000 periods at R = 10 are 20 000 slow
    /// ones. A run that changes more slowly than the closeness counts as settled too early; one that needs more periods is
    /// reported as unsettled.
    pub const SWEEP: Self = Self { tolerance: 1e-12, closeness: 1e-3, periods: 200_000 };

    /// For many starts that are to be assigned to attractors: three times the allowed change and half the periods, because sections
    /// need only agree within the tolerance of a basin. Runs near a basin boundary are reported as unsettled earlier.
    pub const BASIN: Self = Self { tolerance: 1e-12, closeness: 3e-3, periods: 100_000 };
}

/// Where a run has settled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SettleOutcome {
    /// On the base response.
    Base,
    /// On another attractor.
    Elsewhere,
    /// Unknown.
    Unsettled(Unsettled),
}

/// A run that is over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settled {
    /// Where it has settled.
    pub outcome: SettleOutcome,
    /// Its last state, at τ = 0 modulo the period.
    pub state: Start,
    /// Number of periods of the section it took; 0 without dither, where the cycle map decides.
    pub periods: u64,
    /// Its last block.
    pub(super) summary: BlockSummary,
    /// Period τ of the limit cycle to which it converges, without dither.
    pub(super) cycle: Option<f64>,
}

/// What is kept of a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BlockSummary {
    /// Centre, size and shape of the motion, over time.
    pub(super) moments: Moments,
    /// Size of the section: of the slow motion alone.
    pub(super) size: f64,
}

impl BlockSummary {
    /// Of an observed block.
    fn of(observer: &BlockObserver<'_>, section: &[(f64, f64)]) -> Self {
        Self { moments: observer.moments(), size: Moments::of(section).size() }
    }

    /// Of a motion that is a single state.
    fn of_state(state: Start) -> Self {
        let centre = [state.displacement, state.velocity];
        Self { moments: Moments { centre, spread: [0.0; 3] }, size: 0.0 }
    }

    /// The average of several summaries, weighted by a smooth bump function: a slow drift affects it less than a plain mean.
    fn averaged(all: &[Self]) -> Self {
        let weights = average::weights(all.len());
        let of = |value: &dyn Fn(&Self) -> f64| average::mean(&weights, all.iter().map(value));
        Self {
            moments: Moments {
                centre: [0, 1].map(|k| of(&|block| block.moments.centre[k])),
                spread: [0, 1, 2].map(|k| of(&|block| block.moments.spread[k])),
            },
            size: of(&|block| block.size),
        }
    }

    /// The largest difference of centre, size and shape, a length; a motion smaller than `least` is treated as of that size.
    pub(super) fn distance(&self, other: &Self, least: f64) -> f64 {
        self.moments.distance(&other.moments, self.size.max(other.size).max(least))
    }
}

/// Number of periods of the section in a block.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
pub(super) fn block(settings: &AttractorSettings) -> usize {
    ((CYCLES_PER_BLOCK * std::f64::consts::TAU / settings.section.period).ceil() as usize)
        .max(FEWEST)
}

/// The history of a run that has not settled yet.
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is an independent fact about the last block"
)]
struct RunHistory {
    number: usize,
    state: Start,
    periods: u64,
    /// Whether the previous block had a stick.
    stuck: bool,
    /// The earlier blocks, newest last.
    earlier: Vec<BlockSummary>,
    /// Whether the last block decayed at the rate of the multipliers.
    decayed_at_rate: bool,
    /// Whether areas are observed in the next block.
    observes_area: bool,
    /// Whether it appeared settled although areas grow.
    dwelt: bool,
}

/// Most periods of a run: the requested number, but no longer than `LONGEST` where the section is slow.
fn most_periods(settings: &AttractorSettings, patience: Patience) -> u64 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
    let longest = (LONGEST / settings.section.period).ceil() as u64;
    patience.periods.min(longest.max(FEWEST as u64))
}

/// Integrates from one start until the run has settled.
///
/// # Errors
/// [`Stalled`].
pub fn settle(
    settings: &AttractorSettings,
    start: Start,
    patience: Patience,
) -> Result<Settled, Stalled> {
    let many = settle_many(settings, &[start], patience);
    many.into_iter().next().unwrap_or(Err(Stalled::NEVER_STARTED))
}

/// Integrates from every start until its run has settled, side by side. Every run starts at τ = 0, which fixes the phase of the
/// dither.
pub fn settle_many(
    settings: &AttractorSettings,
    starts: &[Start],
    patience: Patience,
) -> Vec<Result<Settled, Stalled>> {
    if settings.is_autonomous() && settings.belt.belt_velocity() > 0.0 {
        return undithered(settings, starts);
    }
    let mut outcomes = vec![Err(Stalled::NEVER_STARTED); starts.len()];
    let mut unsettled: Vec<RunHistory> = starts
        .iter()
        .enumerate()
        .map(|(number, start)| RunHistory::new(number, nudged(settings, *start)))
        .collect();
    let period = settings.section.period;
    let block = block(settings);
    let length = block as f64 * period;
    while !unsettled.is_empty() {
        let mut observers: Vec<BlockObserver<'_>> = unsettled
            .iter()
            .map(|history| {
                let observer = BlockObserver::new(period, block);
                if history.observes_area {
                    observer.with_contraction(&settings.belt)
                } else {
                    observer
                }
            })
            .collect();
        let runs: Vec<SimulationRun<'_>> = unsettled
            .iter()
            .zip(&mut observers)
            .map(|(history, observer)| SimulationRun {
                belt: &settings.belt,
                start: history.state,
                until: length,
                observer,
            })
            .collect();
        let ends = simulate_many(runs, patience.tolerance);
        let mut remaining = Vec::with_capacity(unsettled.len());
        for ((mut history, observer), end) in unsettled.into_iter().zip(&observers).zip(ends) {
            let number = history.number;
            match end.map(|end| history.after(settings, patience, observer, &end)) {
                Ok(None) => remaining.push(history),
                Ok(Some(settled)) => outcomes[number] = Ok(settled),
                Err(stalled) => outcomes[number] = Err(stalled),
            }
        }
        unsettled = remaining;
    }
    outcomes
}

/// The limit sets of undithered runs, by the cycle map.
fn undithered(settings: &AttractorSettings, starts: &[Start]) -> Vec<Result<Settled, Stalled>> {
    let stall = |why: CycleMapError| match why {
        CycleMapError::Stalled(stalled) => stalled,
        CycleMapError::NoLimit => Stalled::NEVER_STARTED,
    };
    let known = cycles(&settings.belt).and_then(|cycles| {
        let starts = cycles.iter().map(|cycle| Start::of_state(&cycle.state));
        let summaries = starts.map(|start| one_block(settings, start));
        let summaries = summaries.collect::<Result<Vec<_>, _>>().map_err(CycleMapError::Stalled)?;
        Ok((cycles, summaries))
    });
    let (cycles, summaries) = match known {
        Ok(known) => known,
        Err(why) => return vec![Err(stall(why)); starts.len()],
    };
    let sliding = Start { time: 0.0, displacement: settings.belt.steady_sliding(), velocity: 0.0 };
    let index_of = |cycle: &Orbit| cycles.iter().position(|other| std::ptr::eq(other, cycle));
    starts
        .iter()
        .map(|start| {
            let start = nudged(settings, *start);
            let (outcome, state, index) = match cycle_reached(&settings.belt, &cycles, start) {
                Ok(None) => (SettleOutcome::Base, sliding, None),
                Ok(Some(cycle)) if cycle.verdict() == OrbitVerdict::Unstable => {
                    (SettleOutcome::Unsettled(Unsettled::Dwelling), start, index_of(cycle))
                }
                Ok(Some(cycle)) => {
                    (SettleOutcome::Elsewhere, Start::of_state(&cycle.state), index_of(cycle))
                }
                Err(CycleMapError::NoLimit) => {
                    (SettleOutcome::Unsettled(Unsettled::Moving), start, None)
                }
                Err(why) => return Err(stall(why)),
            };
            let summary =
                index.map_or_else(|| BlockSummary::of_state(state), |index| summaries[index]);
            let cycle = index.map(|index| cycles[index].period);
            Ok(Settled { outcome, state, periods: 0, summary, cycle })
        })
        .collect()
}

/// The summary of the block that begins at a state.
fn one_block(settings: &AttractorSettings, start: Start) -> Result<BlockSummary, Stalled> {
    let (period, count) = (settings.section.period, block(settings));
    let mut observer = BlockObserver::new(period, count);
    simulate(&settings.belt, start, count as f64 * period, DEFAULT_TOLERANCE, &mut observer)?;
    Ok(BlockSummary::of(&observer, &observer.section()))
}

/// The start, displaced if it is on an unstable base response.
fn nudged(settings: &AttractorSettings, start: Start) -> Start {
    let start = Start { time: 0.0, ..start };
    let nudge = NUDGE * settings.belt.normal_load();
    match &settings.base {
        Ok(base)
            if base.verdict == OrbitVerdict::Unstable
                && base.distance(start.displacement, start.velocity) < nudge =>
        {
            Start { displacement: base.displacement + nudge, velocity: base.velocity, ..start }
        }
        _ => start,
    }
}

impl RunHistory {
    fn new(number: usize, state: Start) -> Self {
        Self {
            number,
            state,
            periods: 0,
            stuck: false,
            earlier: Vec::new(),
            decayed_at_rate: false,
            observes_area: false,
            dwelt: false,
        }
    }

    /// Evaluates a block; `None` to continue.
    fn after(
        &mut self,
        settings: &AttractorSettings,
        patience: Patience,
        observer: &BlockObserver<'_>,
        end: &FinalState,
    ) -> Option<Settled> {
        let section = observer.section();
        let now = BlockSummary::of(observer, &section);
        self.state = Start { time: 0.0, displacement: end.displacement, velocity: end.velocity };
        self.periods += section.len() as u64;
        let scale = settings.belt.normal_load();
        if let Ok(base) = &settings.base
            && base.verdict != OrbitVerdict::Unstable
            && self.converges_to(base, &section, scale)
        {
            return Some(self.settled(SettleOutcome::Base, now));
        }
        let sticks = observer.sticks > 0;
        let stuck_before = std::mem::replace(&mut self.stuck, sticks);
        let forgets = sticks && stuck_before;
        let settled = self.change(patience, now, scale, forgets);
        self.earlier.push(now);
        if let Some(change) = settled {
            if sticks || now.size < POINT * scale {
                return Some(self.settled(SettleOutcome::Elsewhere, now));
            }
            match observer.contraction() {
                None => self.observes_area = true,
                Some((rate, error)) => {
                    let length = section.len() as f64 * settings.section.period;
                    // The remaining change shrinks by this fraction per block.
                    let fraction = -libm::expm1(-rate * length);
                    if rate > error && change <= fraction * patience.closeness * now.size {
                        return Some(self.settled(SettleOutcome::Elsewhere, now));
                    }
                    self.dwelt = rate < -error;
                }
            }
        } else {
            // Comparisons of windows are far apart, so areas are already observed in the block after which one is due.
            self.observes_area = self.compares();
        }
        if self.periods >= most_periods(settings, patience) {
            let why = if self.dwelt { Unsettled::Dwelling } else { Unsettled::Moving };
            return Some(self.settled(SettleOutcome::Unsettled(why), now));
        }
        None
    }

    fn settled(&self, outcome: SettleOutcome, summary: BlockSummary) -> Settled {
        Settled { outcome, state: self.state, periods: self.periods, summary, cycle: None }
    }

    /// Whether it is at the base response, or decays to it at the known rate.
    fn converges_to(&mut self, base: &BaseResponse, section: &[(f64, f64)], scale: f64) -> bool {
        if base.distance(self.state.displacement, self.state.velocity) < NEAR * scale {
            return true;
        }
        let Some(expected) = base.rate().filter(|_| base.verdict == OrbitVerdict::Stable) else {
            return false;
        };
        let size = |states: &[(f64, f64)]| {
            let squares = states.iter().map(|&(x, v)| {
                let distance = base.distance(x, v);
                distance * distance
            });
            libm::sqrt(squares.sum())
        };
        let quarter = section.len() / 4;
        let between = section.len() - quarter;
        let (first, last) = (size(&section[..quarter]), size(&section[between..]));
        let measured = libm::log(last / first) / between as f64;
        let agrees = decays_at(measured, expected);
        let before = std::mem::replace(&mut self.decayed_at_rate, agrees);
        agrees && before
    }

    /// The largest change of the last blocks, if the motion no longer changes within the closeness. A run that `forgets`
    /// stuck in both of its last blocks: its state does not depend on the history before them.
    fn change(
        &self,
        patience: Patience,
        now: BlockSummary,
        scale: f64,
        forgets: bool,
    ) -> Option<f64> {
        let size = now.size;
        let allowed = patience.closeness * size;
        let last = self.earlier.last()?;
        let least = POINT * scale;
        if size < least {
            // Without slow motion the shape is that of the forced motion and is compared relative to its size.
            let change = now.distance(last, now.moments.size());
            return (change < least).then_some(change);
        }
        let change = now.distance(last, least);
        if forgets && change <= AFTER_STICKS * allowed {
            return Some(change);
        }
        let second = self.earlier.iter().rev().nth(1)?;
        let before = last.distance(second, least);
        let ratio = change / before;
        // It shrinks geometrically: the remaining change is a geometric sum.
        if ratio < GEOMETRIC
            && change <= allowed * (1.0 - ratio)
            && before <= LARGEST_CHANGE_BEFORE * allowed
        {
            return Some(change);
        }
        // It fluctuates without a trend.
        let third = self.earlier.iter().rev().nth(2)?;
        let largest =
            [change, before, second.distance(third, least)].into_iter().fold(0.0, f64::max);
        if largest <= allowed / FLUCTUATIONS && now.distance(third, least) <= NET_CHANGE * allowed {
            return Some(largest);
        }
        self.drift(least).filter(|drift| *drift <= allowed / FLUCTUATIONS)
    }

    /// The difference of the two newest windows, each a quarter of all blocks. A slow motion that is nearly locked to the
    /// dither creeps around its curve for many blocks, and each block covers another part of it: only the average over many
    /// blocks is then constant.
    fn drift(&self, least: f64) -> Option<f64> {
        if !self.compares() {
            return None;
        }
        let blocks = self.earlier.len();
        let window = blocks / 4;
        let (rest, newest) = self.earlier.split_at(blocks - window);
        let (_, before) = rest.split_at(rest.len() - window);
        Some(BlockSummary::averaged(newest).distance(&BlockSummary::averaged(before), least))
    }

    /// Whether windows of the stored blocks are compared after the next block.
    fn compares(&self) -> bool {
        let blocks = self.earlier.len();
        blocks >= WINDOWS && blocks.is_multiple_of(WINDOWS / 2)
    }
}

impl Settled {
    /// Whether it is at rest, held by friction on a belt that does not move.
    pub(super) fn is_at_rest(&self, settings: &AttractorSettings) -> bool {
        let moments = &self.summary.moments;
        let still = ONE_STATE * settings.belt.normal_load();
        settings.is_autonomous() && settings.belt.belt_velocity() == 0.0 && moments.size() <= still
    }

    /// Why it has not settled; `None` if it has.
    pub fn why(&self) -> Option<Unsettled> {
        match self.outcome {
            SettleOutcome::Unsettled(why) => Some(why),
            SettleOutcome::Base | SettleOutcome::Elsewhere => None,
        }
    }
}
