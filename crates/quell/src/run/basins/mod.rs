//! `basins`: the attractors on which starts from a window of states end, the share of each, and the shares versus a parameter.
//!
//! | file | contents |
//! |---|---|
//! | `starts` | the window and its starts: a grid or a random sample |
//! | `share` | the size of a basin and its uncertainty |
//! | `answer` | the outcome as sentences, JSON and datasets |

mod answer;
mod share;
mod starts;

pub use answer::quiescence;
#[cfg(test)]
mod tests;

use std::sync::atomic::Ordering;

use quell_dynamics::attractor::{
    AttractorSettings, BasinLabel, BasinsOfAttraction as Gathered, Patience, Settled, gather,
    settle_many,
};
use quell_dynamics::orbit::OrbitVerdict;
use quell_dynamics::simulation::{Stalled, within};
use quell_model::units::Scales;

use super::attractor::{settings, unknown};
use super::varied::{Range, Varied};
use super::{failed, moves, stopped};
use crate::complaint::{Complaint, Failure};
use crate::contact_state::refused_of_belt;
use crate::effort::{STEPS_OF_A_SEARCH, STEPS_OF_MANY_SEARCHES};
use crate::parallel::Parallel;
use crate::range::{self, SlipMet};
use crate::study::BeltStudy;
use crate::sweep::Running;

pub use share::Share;
pub use starts::{MOST_STARTS, StartLayout, Starts, Window};

/// Number of starts in a work item: enough to fill the SIMD lanes of a processor several times.
const CHUNK: usize = 128;

/// Options of `basins`.
#[derive(Clone, Debug, PartialEq)]
pub struct BasinsRequest {
    /// Displacements x of the window; derived from the belt if `None`.
    pub displacement: Option<(f64, f64)>,
    /// Velocities x′ of the window; derived from the belt if `None`.
    pub velocity: Option<(f64, f64)>,
    /// Layout of the starts.
    pub layout: StartLayout,
    /// A parameter to vary.
    pub over: Option<Range>,
}

/// The basins at one value of the parameter, or of the study as it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Portrait {
    /// Value of the parameter, if one is varied.
    pub value: Option<f64>,
    /// Period of the section, τ.
    pub period: f64,
    /// Whether the base response is stable, whether or not any start reaches it; or why this is unknown.
    pub local: Result<OrbitVerdict, String>,
    /// Attractors, and the attractor of each start.
    pub gathered: Gathered,
    /// The share of each attractor.
    pub shares: Vec<Share>,
    /// Scales at this value, of a study in SI: mass and stiffness may be varied.
    pub scales: Option<Scales>,
    /// Whether responses of the dither's own period may vibrate in the band of slow vibration (R ≤ 1.9).
    pub in_band: bool,
    /// The share of starts that end without slow motion; `None` if no outcome is known. Its upper bound includes the starts
    /// of unknown outcome.
    pub quiet: Option<Share>,
    /// The share of starts of unknown outcome.
    pub unknown: Share,
}

/// The basins of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Basins {
    /// The starts.
    pub starts: Starts,
    /// The varied parameter.
    pub varied: Option<Varied>,
    /// One portrait for each value; a single one without a parameter.
    pub portraits: Vec<Portrait>,
    /// The slip reached by the starts in their first slow period, and by the attractors.
    pub slip: SlipMet,
}

/// Runs every start until it has settled and groups the starts by attractor.
///
/// # Errors
/// Complaints about the request; [`Failure::Failed`] if no thread can be started or the work is interrupted.
pub fn run(
    study: &BeltStudy,
    question: &BasinsRequest,
    running: Running<'_>,
) -> Result<Basins, Failure> {
    refused_of_belt(study, "basins")?;
    let belt = study.belt();
    let varied = question.over.as_ref().map(|over| Varied::new(study, "--over", over));
    let starts = Starts::new(belt, question.displacement, question.velocity, question.layout);
    let (varied, starts) = match (varied.transpose(), starts) {
        (Ok(varied), Ok(starts)) => (varied, starts),
        (varied, starts) => {
            let mut complaints: Vec<Complaint> = varied.err().into_iter().flatten().collect();
            complaints.extend(starts.err().into_iter().flatten());
            return Err(complaints.into());
        }
    };
    if let Some(varied) = &varied {
        all_of(varied, &starts)?;
    }
    let studies = match &varied {
        None => vec![(None, study.clone())],
        Some(varied) => {
            let at = |value: &f64| Ok((Some(*value), varied.study_at(study, *value)?));
            varied.values.iter().map(at).collect::<Result<Vec<_>, Failure>>()?
        }
    };
    for (_, study) in &studies {
        let why = "on a belt at rest any position inside the stick band is an equilibrium, so there are no \
                   isolated attractors";
        moves(study, why)?;
    }
    let pool = running.pool()?;
    running.progress.begin(studies.len() * starts.states().len(), 0);
    let portraits = pool.install(|| portraits(&studies, &starts, running));
    running.progress.end();
    let portraits = portraits?;
    let slip = slip_met(&studies, &starts, &portraits);
    Ok(Basins { starts, varied, portraits, slip })
}

/// The slip reached by the starts, in one batch, and by the attractors.
fn slip_met(
    studies: &[(Option<f64>, BeltStudy)],
    starts: &Starts,
    portraits: &[Portrait],
) -> SlipMet {
    let mut slip = SlipMet::default();
    for ((_, study), portrait) in studies.iter().zip(portraits) {
        let belt = study.belt();
        let cases: Vec<_> = starts.states().iter().map(|start| (belt, *start)).collect();
        for speed in range::of_starts(&cases) {
            slip.add(belt, speed);
        }
        for basin in &portrait.gathered.basins {
            slip.add_attractor(belt, basin.attractor.state);
        }
    }
    slip
}

/// Limits the number of values times starts, because all outcomes are kept.
fn all_of(varied: &Varied, starts: &Starts) -> Result<(), Failure> {
    let (values, starts) = (varied.values.len(), starts.states().len());
    if values.checked_mul(starts).is_some_and(|all| all <= MOST_STARTS) {
        return Ok(());
    }
    let allowed = format!(
        "such that the number of values times the number of starts ({starts}) is at most {MOST_STARTS}"
    );
    Err(Complaint::option("--points", values, allowed).into())
}

/// The portrait of each study. Chunks of starts go to any free thread; the result of a run is independent of all others.
fn portraits(
    studies: &[(Option<f64>, BeltStudy)],
    starts: &Starts,
    running: Running<'_>,
) -> Result<Vec<Portrait>, Failure> {
    let scenes: Vec<AttractorSettings<'_>> = studies
        .in_parallel(|(_, study)| within(STEPS_OF_A_SEARCH, || settings(study.belt())))
        .collect::<Result<_, Failure>>()?;
    let chunks: Vec<_> = starts.states().chunks(CHUNK).collect();
    let tasks: Vec<(usize, usize)> = (0..scenes.len())
        .flat_map(|value| (0..chunks.len()).map(move |chunk| (value, chunk)))
        .collect();
    let done: Vec<Vec<Result<Settled, Stalled>>> = tasks
        .in_parallel(|&(value, chunk)| {
            if running.stop.load(Ordering::Relaxed) {
                return Err(stopped("basins"));
            }
            let tolerance = studies[value].1.solver().tolerance;
            let patience = Patience { tolerance, ..Patience::BASIN };
            let starts = chunks[chunk];
            let steps = STEPS_OF_A_SEARCH.saturating_mul(starts.len() as u64);
            let settled = within(steps, || settle_many(&scenes[value], starts, patience));
            running.progress.advance(settled.len());
            Ok(settled)
        })
        .collect::<Result<_, Failure>>()?;
    let whole = |value: usize| done[value * chunks.len()..(value + 1) * chunks.len()].concat();
    let numbered: Vec<(usize, &AttractorSettings<'_>)> = scenes.iter().enumerate().collect();
    numbered
        .in_parallel(|&(place, settings)| {
            let gather = || gather(settings, &whole(place));
            let gathered = within(STEPS_OF_MANY_SEARCHES, gather).map_err(failed)?;
            let (value, study) = &studies[place];
            Ok(Portrait::new(*value, study.scales(), settings, starts, gathered))
        })
        .collect()
}

impl Portrait {
    fn new(
        value: Option<f64>,
        scales: Option<Scales>,
        settings: &AttractorSettings<'_>,
        starts: &Starts,
        gathered: Gathered,
    ) -> Self {
        let layout = starts.layout();
        let inside = |holds: &dyn Fn(&BasinLabel) -> bool| -> Vec<bool> {
            gathered.labels.iter().map(holds).collect()
        };
        let shares = (0..gathered.basins.len())
            .map(|place| {
                Share::of(layout, &inside(&|label| *label == BasinLabel::Attractor(place)))
            })
            .collect();
        let open = inside(&|label| !matches!(label, BasinLabel::Attractor(_)));
        let ends_quiet = |label: &BasinLabel| match label {
            BasinLabel::Attractor(place) => gathered.basins[*place].attractor.quiet,
            BasinLabel::Unsettled(_) | BasinLabel::Stalled(_) => false,
        };
        let known = open.contains(&false);
        let quiet = known.then(|| Share::between(layout, &inside(&ends_quiet), &open));
        let unknown_share = Share::of(layout, &open);
        Self {
            value,
            scales,
            period: settings.section.period,
            in_band: settings.reaches_the_band(),
            local: settings.base.as_ref().map(|base| base.verdict).map_err(unknown),
            shares,
            quiet,
            unknown: unknown_share,
            gathered,
        }
    }

    /// Whether at least one start is known not to fall quiet.
    fn leaves(&self) -> bool {
        self.quiet
            .is_some_and(|share| share.starts + self.unknown.starts < self.gathered.labels.len())
    }
}
