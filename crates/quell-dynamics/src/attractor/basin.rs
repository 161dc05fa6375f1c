//! Basins: which starts lead to the same attractor.
//!
//! Runs that settle on the base response form one group. Others are distinguished by centre, size and shape of their sections:
//! those that agree within `SAME_ATTRACTOR` of the size are one attractor. Locked responses of slightly different period on one
//! curve count as one, and so do runs whose sections differ but which end on one orbit. A curve on which the motion nearly repeats itself after a few periods is filled so slowly that the centres
//! and sizes of two runs on it differ: measured curves are compared once more, as sets of states.

use super::measure::{Attractor, AttractorKind, measure};
use super::settings::AttractorSettings;
use super::settle::{BlockSummary, SettleOutcome, Settled};
use super::unsettled::Unsettled;
use crate::simulation::Stalled;

/// Difference of centre, size and shape, relative to the size, within which two sections belong to one attractor: three times
/// the change that a run of a basin may still make, plus the effect of the phase of locking. With a larger value attractors of
/// nearly the same size would be merged; with a smaller one an attractor would be split.
const SAME_ATTRACTOR: f64 = 0.02;

/// The same difference relative to F, for sections that are nearly a single state: ten times the distance within which a state
/// counts as the base response. Attractors closer to each other than this are merged. With a smaller value the remaining change
/// of a run would split one.
const POINT: f64 = 1e-5;

/// The attractor to which a start leads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BasinLabel {
    /// An attractor: its index in the list.
    Attractor(usize),
    /// Unknown.
    Unsettled(Unsettled),
    /// The engine stopped.
    Stalled(Stalled),
}

/// An attractor and the number of starts that lead to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Basin {
    /// The attractor, measured from the first start that leads to it.
    pub attractor: Attractor,
    /// Number of starts.
    pub starts: usize,
}

/// The attractors of a set of starts.
#[derive(Clone, Debug, PartialEq)]
pub struct BasinsOfAttraction {
    /// The base response first if any start leads to it, then by decreasing number of starts.
    pub basins: Vec<Basin>,
    /// The attractor of each start, in the order of the starts.
    pub labels: Vec<BasinLabel>,
}

impl BasinsOfAttraction {
    /// Number of starts whose attractor is unknown.
    pub fn unknown(&self) -> usize {
        self.labels.iter().filter(|label| !matches!(label, BasinLabel::Attractor(_))).count()
    }
}

/// One attractor under construction.
struct AttractorGroup {
    base: bool,
    summary: BlockSummary,
    first: Settled,
    starts: usize,
}

/// Groups settled runs by attractor. The result depends on the order of the runs, not on how they were computed.
///
/// # Errors
/// [`Stalled`] while an attractor is measured.
pub fn gather(
    settings: &AttractorSettings,
    settled: &[Result<Settled, Stalled>],
) -> Result<BasinsOfAttraction, Stalled> {
    let mut groups: Vec<AttractorGroup> = Vec::new();
    let mut labels: Vec<BasinLabel> = Vec::with_capacity(settled.len());
    let floor = POINT * settings.belt.normal_load();
    for run in settled {
        labels.push(match run {
            Err(stalled) => BasinLabel::Stalled(*stalled),
            Ok(Settled { outcome: SettleOutcome::Unsettled(why), .. }) => {
                BasinLabel::Unsettled(*why)
            }
            Ok(run) => {
                let index = groups.iter().position(|group| group.contains(run, floor));
                let index = index.unwrap_or(groups.len());
                if index == groups.len() {
                    let base = run.outcome == SettleOutcome::Base;
                    groups.push(AttractorGroup {
                        base,
                        summary: run.summary,
                        first: *run,
                        starts: 0,
                    });
                }
                groups[index].starts += 1;
                BasinLabel::Attractor(index)
            }
        });
    }
    // The basin of each group: its own, or that of an earlier group on the same curve.
    let mut basin_of = Vec::with_capacity(groups.len());
    let mut found: Vec<(bool, Basin)> = Vec::new();
    for group in &groups {
        // A settled run has an attractor.
        let Some(attractor) = measure(settings, &group.first)? else {
            basin_of.push(found.len());
            continue;
        };
        let is_same = |known: &Attractor| {
            same_orbit(known, &attractor, floor) || same_curve(known, &attractor)
        };
        let same = found.iter().position(|(_, basin)| is_same(&basin.attractor));
        basin_of.push(same.unwrap_or(found.len()));
        match same {
            Some(same) => found[same].1.starts += group.starts,
            None => found.push((group.base, Basin { attractor, starts: group.starts })),
        }
    }
    let mut order: Vec<usize> = (0..found.len()).collect();
    order.sort_by_key(|index| (!found[*index].0, usize::MAX - found[*index].1.starts));
    for label in &mut labels {
        if let BasinLabel::Attractor(index) = label {
            let basin = basin_of[*index];
            *index = order.iter().position(|other| *other == basin).unwrap_or(basin);
        }
    }
    let basins = order.iter().map(|index| found[*index].1.clone()).collect();
    Ok(BasinsOfAttraction { basins, labels })
}

/// Whether two motions are one orbit: of as many periods, and the first state of one is a state of the other.
fn same_orbit(one: &Attractor, other: &Attractor, floor: f64) -> bool {
    let periods = |attractor: &Attractor| match attractor.kind {
        AttractorKind::Periodic { periods, .. } => Some(periods),
        _ => None,
    };
    let Some(&(x, v)) = one.section.first() else { return false };
    let is_here = |state: &(f64, f64)| libm::hypot(state.0 - x, state.1 - v) <= floor;
    periods(one).is_some() && periods(one) == periods(other) && other.section.iter().any(is_here)
}

/// Whether two quasi-periodic motions fill the same curve: the states of each lie on the section of the other.
fn same_curve(one: &Attractor, other: &Attractor) -> bool {
    let is_curve = |attractor: &Attractor| attractor.kind == AttractorKind::QuasiPeriodic;
    if !is_curve(one) || !is_curve(other) {
        return false;
    }
    let extent = |pick: fn(&(f64, f64)) -> f64| {
        let values = one.section.iter().chain(&other.section).map(pick);
        let ends = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        (ends.1 - ends.0).max(f64::MIN_POSITIVE)
    };
    // Displacements and velocities are compared in parts of their extents.
    let scale = (extent(|state| state.0), extent(|state| state.1));
    let mean_distance = |from: &[(f64, f64)], to: &[(f64, f64)]| {
        let nearest = |state: &(f64, f64)| {
            let distances = to.iter().map(|other| {
                let (x, v) = ((state.0 - other.0) / scale.0, (state.1 - other.1) / scale.1);
                x.mul_add(x, v * v)
            });
            distances.fold(f64::INFINITY, f64::min).sqrt()
        };
        from.iter().map(nearest).sum::<f64>() / from.len() as f64
    };
    mean_distance(&one.section, &other.section).max(mean_distance(&other.section, &one.section))
        <= SAME_ATTRACTOR
}

impl AttractorGroup {
    fn contains(&self, run: &Settled, floor: f64) -> bool {
        let base = run.outcome == SettleOutcome::Base;
        if base || self.base {
            return base && self.base;
        }
        let size = self.summary.size.max(run.summary.size);
        self.summary.distance(&run.summary, floor) <= SAME_ATTRACTOR * size + floor
    }
}
