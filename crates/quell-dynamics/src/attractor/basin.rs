//! Which starts end on the same attractor.
//!
//! Runs that end on the response of sliding are one group. Others are told apart by centre, size and shape of their sections:
//! those that agree within `ALIKE` of the size are one attractor. Locked responses of slightly different period on one curve
//! count as one.

use super::measure::{Attractor, measure};
use super::settle::{Outcome, Settled, Summary};
use super::strobe::Scene;
use crate::orbit::Unsettled;
use crate::simulation::Stalled;

/// Difference of centre, size and shape, relative to the size, within which two sections are one attractor's: three times
/// what a run of a basin may still change by, and what the phase of locking makes of it.
const ALIKE: f64 = 0.02;

/// The same relative to F: sections smaller than this are one state.
const POINT: f64 = 1e-5;

/// Where a start ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Label {
    /// On an attractor: its place in the list.
    Attractor(usize),
    /// Unknown.
    Unsettled(Unsettled),
    /// The engine stopped.
    Stalled(Stalled),
}

/// An attractor and how many starts end on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Basin {
    /// The attractor, measured from the first start that ends on it.
    pub attractor: Attractor,
    /// Number of starts.
    pub starts: usize,
}

/// The attractors that a set of starts ends on.
#[derive(Clone, Debug, PartialEq)]
pub struct Basins {
    /// The response of sliding first where any start ends there, then by falling number of starts.
    pub basins: Vec<Basin>,
    /// Where each start ends, in the order of the starts.
    pub labels: Vec<Label>,
}

impl Basins {
    /// Number of starts of which the end is not known.
    pub fn unknown(&self) -> usize {
        self.labels.iter().filter(|label| !matches!(label, Label::Attractor(_))).count()
    }
}

/// One attractor under construction.
struct Group {
    quiet: bool,
    summary: Summary,
    first: Settled,
    starts: usize,
}

/// Gathers settled runs into attractors. Depends on the order of the runs, not on who computed them.
///
/// # Errors
/// [`Stalled`] while an attractor is measured.
pub fn gather(scene: &Scene<'_>, settled: &[Result<Settled, Stalled>]) -> Result<Basins, Stalled> {
    let mut groups: Vec<Group> = Vec::new();
    let mut labels: Vec<Label> = Vec::with_capacity(settled.len());
    let floor = POINT * scene.belt.normal_load();
    for run in settled {
        labels.push(match run {
            Err(stalled) => Label::Stalled(*stalled),
            Ok(Settled { outcome: Outcome::Unsettled(why), .. }) => Label::Unsettled(*why),
            Ok(run) => {
                let place = groups.iter().position(|group| group.holds(run, floor));
                let place = place.unwrap_or(groups.len());
                if place == groups.len() {
                    let quiet = run.outcome == Outcome::Quiet;
                    groups.push(Group { quiet, summary: run.summary, first: *run, starts: 0 });
                }
                groups[place].starts += 1;
                Label::Attractor(place)
            }
        });
    }
    let mut order: Vec<usize> = (0..groups.len()).collect();
    order.sort_by_key(|place| (!groups[*place].quiet, usize::MAX - groups[*place].starts));
    let mut basins = Vec::with_capacity(groups.len());
    for place in &order {
        let group = &groups[*place];
        // What has settled has an attractor.
        if let Some(attractor) = measure(scene, &group.first)? {
            basins.push(Basin { attractor, starts: group.starts });
        }
    }
    for label in &mut labels {
        if let Label::Attractor(place) = label {
            *place = order.iter().position(|other| other == place).unwrap_or(*place);
        }
    }
    Ok(Basins { basins, labels })
}

impl Group {
    fn holds(&self, run: &Settled, floor: f64) -> bool {
        let quiet = run.outcome == Outcome::Quiet;
        if quiet || self.quiet {
            return quiet && self.quiet;
        }
        let size = self.summary.size.max(run.summary.size);
        self.summary.distance(&run.summary, floor) <= ALIKE * size + floor
    }
}
