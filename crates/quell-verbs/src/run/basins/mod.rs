//! `basins`: the motions on which starts in a plane of two numbers of the state end, the share of each, and the shares over a parameter.
//!
//! | file | contents |
//! |---|---|
//! | `plane` | the plane, its window, and how it is read |
//! | `starts` | the starts in it: a grid or a random sample |
//! | `share` | the size of a basin and its uncertainty |
//! | `answer` | the outcome as sentences, JSON and datasets |

mod answer;
mod plane;
mod share;
mod starts;

#[cfg(test)]
mod tests;

use std::sync::atomic::Ordering;

use quell_dynamics::attractor::{
    GroupedStarts, JudgedStarts, StartJudge, SystemAttractor, UnknownEnd,
};
use quell_dynamics::response::dither_reaches_the_band;
use quell_dynamics::simulation::within;
use quell_numerics::interval::RealInterval;

use super::protocol::Protocol;
use super::slip::SlipReached;
use super::system::attractor::{NoLocalVerdict, local_verdict};
use super::system::tracked::{TrackRequest, understood};
use super::system::{failed, has_equations};
use super::varied::{MOST_VALUES, Range};
use super::{evenly, stopped};
use crate::complaint::{Complaint, Failure, Origin};
use crate::effort::{STEPS_OF_A_SEARCH, STEPS_OF_MANY_SEARCHES};
use crate::parallel::Parallel;
use crate::running::Running;
use crate::study::SystemStudy;

pub use answer::quiescence;
pub use plane::{PlaneAxis, default_plane, read_plane};
pub use share::Share;
pub use starts::{MOST_STARTS, StartLayout};

/// Starts of one task: enough to fill the lanes of the widest instruction set several times, so that a lane whose run has ended takes
/// another.
const TOGETHER: usize = 64;

/// Tasks into which the starts of one value are divided, at least.
const LEAST_TASKS: usize = 4;

/// The grid of starts by default: of one mass, whose runs take microseconds a period, and of other systems.
const GRIDS: [(usize, usize); 2] = [(41, 31), (21, 15)];

/// Options of `basins`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BasinsRequest {
    /// The two numbers of the state that are varied; the first displacement and its velocity if `None`.
    pub axes: Option<[PlaneAxis; 2]>,
    /// Layout of the starts; a grid if `None`.
    pub layout: Option<StartLayout>,
    /// A parameter to vary.
    pub over: Option<Range>,
}

/// A motion with the starts that end on it.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundBasin {
    /// The motion.
    pub attractor: SystemAttractor,
    /// The share of the starts.
    pub share: Share,
    /// Most periods of the dither that a start took.
    pub periods: u32,
}

/// The basins at one value of the parameter, or of the study as it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Portrait {
    /// Value of the parameter, if one is varied.
    pub value: Option<f64>,
    /// Whether some dither acts.
    pub is_dithered: bool,
    /// Whether a motion with the period of the dither may vibrate in the band of the vibration.
    pub in_band: bool,
    /// Verdict on the base response, without dither on steady sliding; or why it is unknown.
    pub local: Result<&'static str, NoLocalVerdict>,
    /// The motions, quiescent ones first, then the largest share first.
    pub basins: Vec<FoundBasin>,
    /// The motion of each start; `None` if its outcome is unknown.
    pub ends: Vec<Option<usize>>,
    /// The share of starts that end without slow motion. Starts of unknown outcome count only towards its upper bound; `None` if no
    /// outcome is known.
    pub quiet: Option<Share>,
    /// The share of starts of unknown outcome.
    pub unknown: Share,
    /// Why outcomes are unknown, each with its number of starts.
    pub reasons: Vec<(String, usize)>,
    /// The largest slip speed of the starts and of the motions at each contact; 0 where no law has a range.
    pub largest_slip: Vec<f64>,
}

/// The basins of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Basins {
    /// Names of the axes.
    pub names: [String; 2],
    /// Their places in the state.
    pub places: [usize; 2],
    /// Least and largest value of each axis.
    pub windows: [RealInterval; 2],
    /// Layout of the starts.
    pub layout: StartLayout,
    /// The values of both axes at each start; on a grid the first axis runs fastest.
    pub starts: Vec<[f64; 2]>,
    /// The start of all other numbers of the state in words.
    pub start: String,
    /// The varied parameter.
    pub over: Option<Range>,
    /// One portrait for each value; a single one without a parameter.
    pub portraits: Vec<Portrait>,
}

/// The values of the varied parameter; a single `None` without one.
fn values(
    study: &SystemStudy,
    over: Option<&Range>,
    starts: usize,
) -> Result<Vec<Option<f64>>, Failure> {
    let Some(Range { parameter, from, to, points }) = over else { return Ok(vec![None]) };
    understood(
        study,
        &TrackRequest {
            parameter: parameter.clone(),
            window: RealInterval::new(*from, *to),
            along: None,
        },
    )
    .map_err(|why| renamed(why, "--parameter", "--over"))?;
    if !(2..=MOST_VALUES).contains(points) {
        let allowed = format!("a whole number from 2 to {MOST_VALUES}");
        return Err(Complaint::option("--points", *points, allowed).into());
    }
    if points.checked_mul(starts).is_none_or(|all| all > MOST_STARTS) {
        let allowed = format!(
            "such that the number of values times the number of starts ({starts}) is at most {MOST_STARTS}"
        );
        return Err(Complaint::option("--points", *points, allowed).into());
    }
    Ok(evenly(RealInterval::new(*from, *to), *points).into_iter().map(Some).collect())
}

/// Complaints about one option as those about another.
fn renamed(why: Failure, from: &str, to: &'static str) -> Failure {
    let Failure::Wrong(complaints) = why else { return why };
    let renamed = |complaint: &Complaint| {
        if complaint.key != from {
            return complaint.clone();
        }
        Complaint { key: to.to_owned(), origin: Origin::Argument(to), ..complaint.clone() }
    };
    Failure::Wrong(complaints.iter().map(renamed).collect::<Vec<Complaint>>().into())
}

/// A value of the parameter: its study, the start of its runs, and the row that is observed.
struct Scene {
    value: Option<f64>,
    study: SystemStudy,
    begun: Vec<f64>,
    observe: Vec<f64>,
}

/// The starts of one task.
struct StartsOfTask {
    ends: JudgedStarts,
    /// The largest slip speed that they reach at each contact.
    slip: Vec<f64>,
}

/// Settles every start and groups the starts by motion.
///
/// # Errors
/// Complaints about the request; [`Failure::Failed`] if no thread can be started or the work is interrupted.
pub fn run(
    study: &SystemStudy,
    request: &BasinsRequest,
    running: Running<'_>,
) -> Result<Basins, Failure> {
    has_equations(study, "basins")?;
    let system = study.system();
    let axes = request.axes.clone().map_or_else(|| default_plane(study, [None; 2]), Ok)?;
    let layout = request.layout.unwrap_or_else(|| {
        let (columns, rows) = GRIDS[usize::from(system.one_mass().is_none())];
        StartLayout::Grid { columns, rows }
    });
    let places = plane::places(study, &axes, layout)?;
    let begun = Protocol::Study.state(study, system)?;
    let window = |axis: usize| {
        axes[axis].window.unwrap_or_else(|| plane::window(system, &begun, places[axis]))
    };
    let windows = [window(0), window(1)];
    let starts = layout.places(windows);
    let values = values(study, request.over.as_ref(), starts.len())?;
    let over = request.over.as_ref();
    let over = over.map(|over| study.model().parameter(&over.parameter)).transpose()?;
    let scenes = values.into_iter().map(|value| {
        let numbers: Vec<_> = over.clone().zip(value).into_iter().collect();
        let at = study.varied(&numbers)?;
        let begun = Protocol::Study.state(&at, at.system())?;
        let observe = at.observe();
        Ok(Scene { value, study: at, begun, observe })
    });
    let scenes = scenes.collect::<Result<Vec<_>, Failure>>()?;
    running.progress.begin(scenes.len() * starts.len(), 0);
    let plan = BasinsPlan { scenes: &scenes, starts: &starts, places, layout };
    let portraits = running.pool()?.install(|| plan.portraits(running));
    running.progress.end();
    let portraits = portraits?;
    let names = axes.map(|axis| axis.name);
    let start = Protocol::Study.words(study);
    let over = request.over.clone();
    Ok(Basins { names, places, windows, layout, starts, start, over, portraits })
}

/// Starts of several values.
struct BasinsPlan<'a> {
    scenes: &'a [Scene],
    starts: &'a [[f64; 2]],
    places: [usize; 2],
    layout: StartLayout,
}

impl BasinsPlan<'_> {
    /// The portrait of each value. Parts of the starts go to any free thread; the outcome of a run is independent of all others.
    fn portraits(&self, running: Running<'_>) -> Result<Vec<Portrait>, Failure> {
        let judges: Vec<StartJudge<'_>> = self
            .scenes
            .in_parallel(|scene| {
                let judge = || StartJudge::new(scene.study.system(), &scene.observe);
                within(STEPS_OF_A_SEARCH, judge)
            })
            .collect();
        let together = self.starts.len().div_ceil(LEAST_TASKS).clamp(1, TOGETHER);
        let parts: Vec<&[[f64; 2]]> = self.starts.chunks(together).collect();
        let tasks: Vec<(usize, &[[f64; 2]])> = (0..self.scenes.len())
            .flat_map(|scene| parts.iter().map(move |part| (scene, *part)))
            .collect();
        let ends = tasks.in_parallel(|(scene, part)| {
            if running.stop.load(Ordering::Relaxed) {
                return Err(stopped("basins"));
            }
            let ends = self.part(&self.scenes[*scene], &judges[*scene], part);
            running.progress.advance(part.len());
            Ok(ends)
        });
        let mut ends = ends.collect::<Result<Vec<_>, Failure>>()?.into_iter();
        let each = self.scenes.iter().zip(&judges).map(|(scene, judge)| {
            let ends: Vec<StartsOfTask> = ends.by_ref().take(parts.len()).collect();
            (scene, judge, ends)
        });
        let each: Vec<(&Scene, &StartJudge<'_>, Vec<StartsOfTask>)> = each.collect();
        each.in_parallel(|(scene, judge, ends)| self.portrait(scene, judge, ends)).collect()
    }

    /// Where some starts of one value end, and the slip that they reach.
    fn part(&self, scene: &Scene, judge: &StartJudge<'_>, part: &[[f64; 2]]) -> StartsOfTask {
        let states = part.iter().map(|values| {
            let mut state = scene.begun.clone();
            for (place, value) in self.places.iter().zip(values) {
                state[*place] = *value;
            }
            state
        });
        let states: Vec<Vec<f64>> = states.collect();
        let system = scene.study.system();
        let mut slip = SlipReached::new(system);
        slip.add_all(system, &states);
        let steps = STEPS_OF_A_SEARCH.saturating_mul(states.len() as u64);
        let ends = within(steps, || judge.of(&states));
        StartsOfTask { ends, slip: slip.largest() }
    }

    /// The starts of one value grouped by motion.
    fn portrait(
        &self,
        scene: &Scene,
        judge: &StartJudge<'_>,
        parts: &[StartsOfTask],
    ) -> Result<Portrait, Failure> {
        let mut slip = SlipReached::new(scene.study.system());
        for part in parts {
            slip.include(&part.slip);
        }
        let ends = parts.iter().map(|part| part.ends.clone());
        let grouped = within(STEPS_OF_MANY_SEARCHES, || judge.grouped(ends));
        let grouped = grouped.map_err(|why| failed("basins", why))?;
        for (motion, _) in &grouped.motions {
            slip.include(&motion.largest_slip);
        }
        Ok(portrait(grouped, scene, self.layout, slip.largest()))
    }
}

/// Why outcomes are unknown, each with its number of starts.
fn reasons(ends: &[Result<usize, UnknownEnd>]) -> Vec<(String, usize)> {
    let mut reasons: Vec<(String, usize)> = Vec::new();
    for why in ends.iter().filter_map(|end| Some(end.as_ref().err()?.to_string())) {
        match reasons.iter_mut().find(|(known, _)| *known == why) {
            Some((_, count)) => *count += 1,
            None => reasons.push((why, 1)),
        }
    }
    reasons
}

/// The portrait of one value.
fn portrait(
    grouped: GroupedStarts,
    scene: &Scene,
    layout: StartLayout,
    largest_slip: Vec<f64>,
) -> Portrait {
    let system = scene.study.system();
    let GroupedStarts { motions, ends } = grouped;
    let count = |place: usize| ends.iter().filter(|end| **end == Ok(place)).count();
    let mut order: Vec<usize> = (0..motions.len()).collect();
    order.sort_by_key(|place| (!motions[*place].0.quiet, usize::MAX - count(*place)));
    let rank = |place: usize| order.iter().position(|other| *other == place);
    let reasons = reasons(&ends);
    let places = ends.iter().map(|end| end.as_ref().ok().and_then(|place| rank(*place)));
    let ends: Vec<Option<usize>> = places.collect();
    let inside = |holds: &dyn Fn(usize) -> bool| -> Vec<bool> {
        ends.iter().map(|end| end.is_some_and(holds)).collect()
    };
    let basins: Vec<FoundBasin> = order
        .iter()
        .enumerate()
        .map(|(number, place)| FoundBasin {
            attractor: motions[*place].0.clone(),
            share: Share::of(layout, &inside(&|end| end == number)),
            periods: motions[*place].1,
        })
        .collect();
    let open: Vec<bool> = ends.iter().map(Option::is_none).collect();
    let ends_quiet = inside(&|end| basins[end].attractor.quiet);
    let quiet = open.contains(&false).then(|| Share::between(layout, &ends_quiet, &open));
    let unknown = Share::of(layout, &open);
    Portrait {
        value: scene.value,
        is_dithered: system.is_dithered(),
        in_band: system.is_dithered() && dither_reaches_the_band(system),
        local: local_verdict(system),
        basins,
        ends,
        quiet,
        unknown,
        reasons,
        largest_slip,
    }
}

impl Portrait {
    /// Whether at least one start is known not to fall quiet.
    fn leaves(&self) -> bool {
        self.quiet.is_some_and(|share| share.starts + self.unknown.starts < self.ends.len())
    }
}
