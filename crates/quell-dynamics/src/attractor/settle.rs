//! Runs side by side, in blocks of periods, until each has settled.
//!
//! After each block one of these ends a run:
//! 1. **Quiet.** It is at the base response, and that is not unstable; or, where that is stable, its distance falls with the rate of the multipliers
//!    (within `ALIKE`, two blocks in a row), so that the rest of the way is known.
//! 2. **Elsewhere.** Centre, size and shape of the section no longer change, from block to block or from one long window of
//!    blocks to the next, and what they would still change by at the measured rate is below the closeness asked for. Where the block has a stick that is enough: a stick forgets all but its
//!    moment. In slip throughout the rate at which areas shrink must be positive, and fast enough for the rest of the way.
//! 3. **Unsettled**, when its periods are over: it still moves, or it dwells beside a curve that does not attract.
//!
//! A start on an unstable base response would stay there for as long as rounding lets it: it is displaced by
//! `NUDGE` F first.
//!
//! Without dither nothing of this is needed: the exact cycle map decides ([`crate::orbit::cycle`]).
//!
//! Each run depends on itself alone: the outcome has the same bits in any company.
//! Limits: a run counts as quiet on the linear rate although a further attractor could hide in the neighbourhood where the rate is
//! within `ALIKE` of it; the slow change along a curve with sticks that is about to lock is not a change of size.

use super::average::{self, Moments};
use super::quiet::Quiet;
use super::strobe::Scene;
use super::watch::Watch;
use crate::orbit::cycle::{cycle_reached, cycles};
use crate::orbit::{NoOrbit, Orbit, Unsettled, Verdict};
use crate::simulation::{
    DEFAULT_TOLERANCE, FinalState, Run, Stalled, Start, simulate, simulate_many,
};

/// Slow turns of 2π in a block: the bump's averages over fewer still show where a block begins and ends.
const TURNS: f64 = 20.0;

/// Fewest periods of the strobe in a block.
const FEWEST: usize = 64;

/// Distance from the quiet response, relative to F, that counts as being there: a thousandth of the smallest vibration
/// that the figures show, and far above what rounding leaves. Another attractor nearer than this would be missed.
const NEAR: f64 = 1e-6;

/// Relative difference of a measured rate and the multipliers' that counts as alike: twice in a row, in a decay far enough
/// in that its curvature no longer shows. Wider, a run on its way elsewhere could pass; narrower, it only takes longer.
const ALIKE: f64 = 0.05;

/// Displacement of a start on an unstable response, relative to F: far above rounding, far below any response.
const NUDGE: f64 = 1e-4;

/// Size of a section, relative to F, below which it is one state.
const POINT: f64 = 1e-7;

/// The same in what a run has settled on: within this distance a state counts as the base response too.
pub(super) const ONE_STATE: f64 = NEAR;

/// Fewest blocks whose quarters are compared, and twice the number between two comparisons. A size that changes by less
/// than a third of 10⁻³ between two windows of 8 blocks changes by less than 7·10⁻⁷ a period (of 64 periods a block, the
/// fewest): nearer to a threshold than that a run is taken for settled.
const WINDOWS: usize = 32;

/// Longest run τ, 32 000 slow periods: 1.6 times what the 200 000 periods of [`Patience::SWEEP`] last at R = 10. A slower strobe
/// would otherwise run for minutes; shorter, runs close to a threshold would be reported as unsettled.
const LONGEST: f64 = 2e5;

/// How long and how closely.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patience {
    /// Bound on the last retained Taylor terms of a step, relative to F.
    pub tolerance: f64,
    /// What centre, size and shape of the section may still change by, relative to its size.
    pub closeness: f64,
    /// Most periods of a run.
    pub periods: u64,
}

impl Patience {
    /// For one response that is to be measured.
    pub const SWEEP: Self = Self { tolerance: 1e-12, closeness: 1e-3, periods: 200_000 };

    /// For many starts that are to be told apart.
    pub const BASIN: Self = Self { tolerance: 1e-12, closeness: 3e-3, periods: 100_000 };
}

/// Where a run ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Outcome {
    /// On the response that sliding becomes.
    Quiet,
    /// On another attractor.
    Elsewhere,
    /// Unknown.
    Unsettled(Unsettled),
}

/// A run that is over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settled {
    /// Where.
    pub outcome: Outcome,
    /// Its last state, at τ = 0 modulo the period.
    pub state: Start,
    /// Periods of the strobe it took; 0 without dither, where the cycle map decides.
    pub periods: u64,
    /// Its last block.
    pub(super) summary: Summary,
    /// Period τ of the limit cycle on which it ends, without dither.
    pub(super) cycle: Option<f64>,
}

/// What is kept of a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Summary {
    /// Centre, size and shape of the motion, over time.
    pub(super) moments: Moments,
    /// Size of the section: of the slow motion alone.
    pub(super) size: f64,
}

impl Summary {
    /// Of a block that was watched.
    fn of(watch: &Watch<'_>, section: &[(f64, f64)]) -> Self {
        Self { moments: watch.moments(), size: Moments::of(section).size() }
    }

    /// Of a motion that is one state.
    fn of_state(state: Start) -> Self {
        let centre = [state.displacement, state.velocity];
        Self { moments: Moments { centre, spread: [0.0; 3] }, size: 0.0 }
    }

    /// The average of some, weighted by a bump: a creep through them leaves less of itself than in a plain mean.
    fn averaged(all: &[Self]) -> Self {
        let weights = average::weights(all.len());
        let of = |value: &dyn Fn(&Self) -> f64| average::mean(&weights, all.iter().map(value));
        Self {
            moments: Moments {
                centre: [0, 1].map(|k| of(&|it| it.moments.centre[k])),
                spread: [0, 1, 2].map(|k| of(&|it| it.moments.spread[k])),
            },
            size: of(&|it| it.size),
        }
    }

    /// The largest difference of centre, size and shape, a length; motions smaller than `least` count as that large.
    pub(super) fn distance(&self, other: &Self, least: f64) -> f64 {
        self.moments.distance(&other.moments, self.size.max(other.size).max(least))
    }
}

/// Periods of the strobe in a block.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count")]
pub(super) fn block(scene: &Scene<'_>) -> usize {
    ((TURNS * std::f64::consts::TAU / scene.strobe.period).ceil() as usize).max(FEWEST)
}

/// A run under way.
#[expect(clippy::struct_excessive_bools, reason = "each is a fact of its own about the last block")]
struct Course {
    number: usize,
    state: Start,
    periods: u64,
    /// Whether the block before had a stick.
    stuck: bool,
    /// The last blocks, newest last.
    earlier: Vec<Summary>,
    /// Whether the last block decayed as the multipliers say.
    decayed_alike: bool,
    /// Whether areas are watched in the next block.
    watches_area: bool,
    /// Whether it looked settled where areas grow.
    dwelt: bool,
}

/// Most periods of a run: as many as are asked for, but no longer than `LONGEST` where the strobe is slow.
fn most_periods(scene: &Scene<'_>, patience: Patience) -> u64 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
    let longest = (LONGEST / scene.strobe.period).ceil() as u64;
    patience.periods.min(longest.max(FEWEST as u64))
}

/// Runs one start until it has settled.
///
/// # Errors
/// [`Stalled`].
pub fn settle(scene: &Scene<'_>, start: Start, patience: Patience) -> Result<Settled, Stalled> {
    let many = settle_many(scene, &[start], patience);
    many.into_iter().next().unwrap_or(Err(Stalled::NEVER_STARTED))
}

/// Runs every start until it has settled, side by side. The dither has its phase at τ = 0, where every run starts.
pub fn settle_many(
    scene: &Scene<'_>,
    starts: &[Start],
    patience: Patience,
) -> Vec<Result<Settled, Stalled>> {
    if scene.is_autonomous() && scene.belt.belt_velocity() > 0.0 {
        return undithered(scene, starts);
    }
    let mut outcomes = vec![Err(Stalled::NEVER_STARTED); starts.len()];
    let mut under_way: Vec<Course> = starts
        .iter()
        .enumerate()
        .map(|(number, start)| Course::new(number, nudged(scene, *start)))
        .collect();
    let period = scene.strobe.period;
    let block = block(scene);
    let length = block as f64 * period;
    while !under_way.is_empty() {
        let mut watches: Vec<Watch<'_>> = under_way
            .iter()
            .map(|course| {
                let watch = Watch::new(period, block);
                if course.watches_area { watch.with_contraction(scene.belt) } else { watch }
            })
            .collect();
        let runs: Vec<Run<'_>> = under_way
            .iter()
            .zip(&mut watches)
            .map(|(course, watch)| Run {
                belt: scene.belt,
                start: course.state,
                until: length,
                observer: watch,
            })
            .collect();
        let ends = simulate_many(runs, patience.tolerance);
        let mut still = Vec::with_capacity(under_way.len());
        for ((mut course, watch), end) in under_way.into_iter().zip(&watches).zip(ends) {
            let number = course.number;
            match end.map(|end| course.after(scene, patience, watch, &end)) {
                Ok(None) => still.push(course),
                Ok(Some(settled)) => outcomes[number] = Ok(settled),
                Err(stalled) => outcomes[number] = Err(stalled),
            }
        }
        under_way = still;
    }
    outcomes
}

/// Where undithered runs end, by the cycle map.
fn undithered(scene: &Scene<'_>, starts: &[Start]) -> Vec<Result<Settled, Stalled>> {
    // Without dither the engine's stop is the only failure.
    let stall = |why: NoOrbit| match why {
        NoOrbit::Stalled(stalled) => stalled,
        _ => Stalled::NEVER_STARTED,
    };
    let known = cycles(scene.belt).and_then(|cycles| {
        let summaries = cycles.iter().map(|cycle| one_block(scene, cycle.start));
        let summaries = summaries.collect::<Result<Vec<_>, _>>().map_err(NoOrbit::Stalled)?;
        Ok((cycles, summaries))
    });
    let (cycles, summaries) = match known {
        Ok(known) => known,
        Err(why) => return vec![Err(stall(why)); starts.len()],
    };
    let sliding = Start { time: 0.0, displacement: scene.belt.steady_sliding(), velocity: 0.0 };
    let on = |cycle: &Orbit| cycles.iter().position(|other| std::ptr::eq(other, cycle));
    starts
        .iter()
        .map(|start| {
            let start = nudged(scene, *start);
            let (outcome, state, place) = match cycle_reached(scene.belt, &cycles, start) {
                Ok(None) => (Outcome::Quiet, sliding, None),
                Ok(Some(cycle)) if cycle.verdict() == Verdict::Unstable => {
                    (Outcome::Unsettled(Unsettled::Dwelling), start, on(cycle))
                }
                Ok(Some(cycle)) => (Outcome::Elsewhere, cycle.start, on(cycle)),
                Err(NoOrbit::NoLimit) => (Outcome::Unsettled(Unsettled::Moving), start, None),
                Err(why) => return Err(stall(why)),
            };
            let summary = place.map_or_else(|| Summary::of_state(state), |place| summaries[place]);
            let cycle = place.map(|place| cycles[place].period);
            Ok(Settled { outcome, state, periods: 0, summary, cycle })
        })
        .collect()
}

/// The block of a run that begins at a state.
fn one_block(scene: &Scene<'_>, start: Start) -> Result<Summary, Stalled> {
    let (period, count) = (scene.strobe.period, block(scene));
    let mut watch = Watch::new(period, count);
    simulate(scene.belt, start, count as f64 * period, DEFAULT_TOLERANCE, &mut watch)?;
    Ok(Summary::of(&watch, &watch.section()))
}

/// A start that is not on an unstable base response.
fn nudged(scene: &Scene<'_>, start: Start) -> Start {
    let start = Start { time: 0.0, ..start };
    let nudge = NUDGE * scene.belt.normal_load();
    match &scene.quiet {
        Ok(quiet)
            if quiet.verdict == Verdict::Unstable
                && quiet.distance(start.displacement, start.velocity) < nudge =>
        {
            Start { displacement: quiet.displacement + nudge, velocity: quiet.velocity, ..start }
        }
        _ => start,
    }
}

impl Course {
    fn new(number: usize, state: Start) -> Self {
        Self {
            number,
            state,
            periods: 0,
            stuck: false,
            earlier: Vec::new(),
            decayed_alike: false,
            watches_area: false,
            dwelt: false,
        }
    }

    /// What a block says; `None` to go on.
    fn after(
        &mut self,
        scene: &Scene<'_>,
        patience: Patience,
        watch: &Watch<'_>,
        end: &FinalState,
    ) -> Option<Settled> {
        let section = watch.section();
        let now = Summary::of(watch, &section);
        self.state = Start { time: 0.0, displacement: end.displacement, velocity: end.velocity };
        self.periods += section.len() as u64;
        let scale = scene.belt.normal_load();
        if let Ok(quiet) = &scene.quiet
            && quiet.verdict != Verdict::Unstable
            && self.nears(quiet, &section, scale)
        {
            return Some(self.over(Outcome::Quiet, now));
        }
        let sticks = watch.sticks > 0;
        let stuck_before = std::mem::replace(&mut self.stuck, sticks);
        let forgets = sticks && stuck_before;
        let still = self.change(patience, now, scale, forgets);
        self.earlier.push(now);
        if let Some(change) = still {
            if sticks || now.size < POINT * scale {
                return Some(self.over(Outcome::Elsewhere, now));
            }
            match watch.contraction() {
                None => self.watches_area = true,
                Some((rate, error)) => {
                    let length = section.len() as f64 * scene.strobe.period;
                    // What is left of the way shrinks by this share a block.
                    let share = -libm::expm1(-rate * length);
                    if rate > error && change <= share * patience.closeness * now.size {
                        return Some(self.over(Outcome::Elsewhere, now));
                    }
                    self.dwelt = rate < -error;
                }
            }
        } else {
            // A comparison of windows is too far from the next one for areas to be watched after it.
            self.watches_area = self.compares();
        }
        if self.periods >= most_periods(scene, patience) {
            let why = if self.dwelt { Unsettled::Dwelling } else { Unsettled::Moving };
            return Some(self.over(Outcome::Unsettled(why), now));
        }
        None
    }

    fn over(&self, outcome: Outcome, summary: Summary) -> Settled {
        Settled { outcome, state: self.state, periods: self.periods, summary, cycle: None }
    }

    /// Whether it is at the quiet response, or on a way there that is known.
    fn nears(&mut self, quiet: &Quiet, section: &[(f64, f64)], scale: f64) -> bool {
        if quiet.distance(self.state.displacement, self.state.velocity) < NEAR * scale {
            return true;
        }
        let Some(expected) = quiet.rate().filter(|_| quiet.verdict == Verdict::Stable) else {
            return false;
        };
        let size = |states: &[(f64, f64)]| {
            let squares = states.iter().map(|&(x, v)| {
                let distance = quiet.distance(x, v);
                distance * distance
            });
            libm::sqrt(squares.sum())
        };
        let quarter = section.len() / 4;
        let between = section.len() - quarter;
        let (first, last) = (size(&section[..quarter]), size(&section[between..]));
        let measured = libm::log(last / first) / between as f64;
        let alike = (measured - expected).abs() <= ALIKE * expected.abs();
        let before = std::mem::replace(&mut self.decayed_alike, alike);
        alike && before
    }

    /// The largest change of the last blocks, where the motion no longer changes within the closeness. A run that `forgets`
    /// stuck in both of its last blocks: what it was before has no part in what it is.
    fn change(&self, patience: Patience, now: Summary, scale: f64, forgets: bool) -> Option<f64> {
        let size = now.size;
        let allowed = patience.closeness * size;
        let last = self.earlier.last()?;
        let least = POINT * scale;
        if size < least {
            // Without slow motion the shape is that of the forced motion, and is compared relative to it.
            let change = now.distance(last, now.moments.size());
            return (change < least).then_some(change);
        }
        let change = now.distance(last, least);
        if forgets && change <= 0.1 * allowed {
            return Some(change);
        }
        let second = self.earlier.iter().rev().nth(1)?;
        let before = last.distance(second, least);
        let ratio = change / before;
        // It shrinks evenly: what is left is a geometric sum.
        if ratio < 0.9 && change <= allowed * (1.0 - ratio) && before <= 10.0 * allowed {
            return Some(change);
        }
        // It wavers without a trend.
        let third = self.earlier.iter().rev().nth(2)?;
        let wavers =
            [change, before, second.distance(third, least)].into_iter().fold(0.0, f64::max);
        if wavers <= allowed / 3.0 && now.distance(third, least) <= 0.5 * allowed {
            return Some(wavers);
        }
        self.drift(least).filter(|drift| *drift <= allowed / 3.0)
    }

    /// By how much two windows differ, each a quarter of all blocks, the newest and the one before. A slow motion that is
    /// nearly locked to the dither creeps around its curve for many blocks, and each block sees another part of it: what
    /// does not change then is the average over many of them.
    fn drift(&self, least: f64) -> Option<f64> {
        if !self.compares() {
            return None;
        }
        let blocks = self.earlier.len();
        let window = blocks / 4;
        let (rest, newest) = self.earlier.split_at(blocks - window);
        let (_, before) = rest.split_at(rest.len() - window);
        Some(Summary::averaged(newest).distance(&Summary::averaged(before), least))
    }

    /// Whether windows of the blocks that are kept are compared when the next block is over.
    fn compares(&self) -> bool {
        let blocks = self.earlier.len();
        blocks >= WINDOWS && blocks.is_multiple_of(WINDOWS / 2)
    }
}

impl Settled {
    /// Whether it ends at rest, held by friction on a belt that does not move.
    pub(super) fn is_at_rest(&self, scene: &Scene<'_>) -> bool {
        let moments = &self.summary.moments;
        let still = ONE_STATE * scene.belt.normal_load();
        scene.is_autonomous() && scene.belt.belt_velocity() == 0.0 && moments.size() <= still
    }

    /// Why it has not settled, where it has not.
    pub fn why(&self) -> Option<Unsettled> {
        match self.outcome {
            Outcome::Unsettled(why) => Some(why),
            Outcome::Quiet | Outcome::Elsewhere => None,
        }
    }
}
