//! Basins: which starts lead to the same attractor.
//!
//! Runs that settle on the base response form one group. Others are distinguished by centre, size and shape of their sections:
//! those that agree within `SAME_ATTRACTOR` of the size are one attractor. Locked responses of slightly different period on one
//! curve count as one.

use super::measure::{Attractor, measure};
use super::settings::AttractorSettings;
use super::settle::{BlockSummary, SettleOutcome, Settled};
use crate::orbit::Unsettled;
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
    settings: &AttractorSettings<'_>,
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
    let mut order: Vec<usize> = (0..groups.len()).collect();
    order.sort_by_key(|index| (!groups[*index].base, usize::MAX - groups[*index].starts));
    let mut basins = Vec::with_capacity(groups.len());
    for index in &order {
        let group = &groups[*index];
        // A settled run has an attractor.
        if let Some(attractor) = measure(settings, &group.first)? {
            basins.push(Basin { attractor, starts: group.starts });
        }
    }
    for label in &mut labels {
        if let BasinLabel::Attractor(index) = label {
            *index = order.iter().position(|other| other == index).unwrap_or(*index);
        }
    }
    Ok(BasinsOfAttraction { basins, labels })
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
