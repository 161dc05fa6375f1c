//! `basins` of a system: the motions on which starts in a plane of two numbers of the state end, the share of each, and the shares
//! over a parameter.

use std::sync::atomic::Ordering;

use quell_dynamics::motion::orbit::sliding_state;
use quell_model::System;

use super::attractor::{EndOfRun, SystemAttractor, ends_of_runs, local_verdict};
use super::start::{state_names, state_quantity};
use super::tracked::{TrackRequest, understood};
use super::{failed, has_equations};
use crate::complaint::{Complaint, Complaints, Failure, Origin};
use crate::nearest;
use crate::parallel::Parallel;
use crate::quantity;
use crate::run::basins::{BasinsRequest, MOST_STARTS, Share, StartLayout};
use crate::run::protocol::Protocol;
use crate::run::varied::{MOST_VALUES, Range};
use crate::run::{evenly, stopped};
use crate::study::SystemStudy;
use crate::sweep::Running;

/// A system, the start of its runs, and the places in the plane that replace two of its numbers.
type BasinsTask<'a> = (&'a SystemStudy, &'a [f64], &'a [[f64; 2]]);

/// Starts of one task, at most: several times the lanes of the widest instruction set, so that a lane whose run has ended takes another.
const SIDE_BY_SIDE: usize = 64;

/// Tasks into which the starts of one value are divided, at least.
const LEAST_TASKS: usize = 4;

/// The grid of starts by default.
pub const GRID: (usize, usize) = (21, 15);

/// An axis of the plane of starts.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneAxis {
    /// Name of the number of the state.
    pub name: String,
    /// Its least and largest value; derived from the system if `None`.
    pub window: Option<(f64, f64)>,
}

/// Options of `basins` of a system.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneRequest {
    /// The two axes.
    pub axes: [PlaneAxis; 2],
    /// Layout of the starts; a grid of [`GRID`] if it is that of a belt by default.
    pub layout: StartLayout,
    /// A parameter to vary.
    pub over: Option<Range>,
}

impl PlaneRequest {
    /// A request with the layout of a belt's starts.
    pub fn of(axes: [PlaneAxis; 2], layout: StartLayout, over: Option<Range>) -> Self {
        let layout = if layout == StartLayout::default() {
            StartLayout::Grid { columns: GRID.0, rows: GRID.1 }
        } else {
            layout
        };
        Self { axes, layout, over }
    }
}

/// A motion with the starts that end on it.
#[derive(Clone, Debug, PartialEq)]
pub struct SystemBasin {
    /// The motion.
    pub attractor: SystemAttractor,
    /// The share of the starts.
    pub share: Share,
    /// Most periods of the dither that a start took.
    pub periods: u32,
}

/// The basins at one value of the parameter, or of the study as it is.
#[derive(Clone, Debug, PartialEq)]
pub struct SystemPortrait {
    /// Value of the parameter, if one is varied.
    pub value: Option<f64>,
    /// Whether some dither acts.
    pub is_dithered: bool,
    /// Verdict on the base response, without dither on steady sliding; or why it is unknown.
    pub local: Result<&'static str, String>,
    /// The motions, quiescent ones first, then the largest share first.
    pub basins: Vec<SystemBasin>,
    /// The motion of each start; `None` if its outcome is unknown.
    pub ends: Vec<Option<usize>>,
    /// The share of starts that end in step with the dither, or at rest. Starts of unknown outcome count only towards its upper
    /// bound; `None` if no outcome is known.
    pub quiet: Option<Share>,
    /// The share of starts of unknown outcome.
    pub unknown: Share,
    /// Why the first of them is unknown.
    pub why: Option<String>,
}

/// The basins of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct SystemBasins {
    /// Names of the axes.
    pub names: [String; 2],
    /// Least and largest value of each axis.
    pub windows: [(f64, f64); 2],
    /// Layout of the starts.
    pub layout: StartLayout,
    /// The values of both axes at each start; on a grid the first axis runs fastest.
    pub starts: Vec<[f64; 2]>,
    /// The start of all other numbers of the state in words.
    pub start: String,
    /// The varied parameter.
    pub over: Option<Range>,
    /// One portrait for each value; a single one without a parameter.
    pub portraits: Vec<SystemPortrait>,
}

/// The places of the axes in the state.
fn places(study: &SystemStudy, request: &PlaneRequest) -> Result<[usize; 2], Failure> {
    let names = state_names(study.system());
    let mut wrong = Vec::new();
    let places = request.axes.each_ref().map(|axis| {
        let place = names.iter().position(|name| *name == axis.name);
        if place.is_none() {
            let allowed = "two names of the state, such as x,velocity.x";
            let complaint = Complaint::option("--plane", axis.name.as_str(), allowed);
            wrong.push(
                complaint.suggesting(nearest::word(&axis.name, names.iter().map(String::as_str))),
            );
        }
        if let Some((from, to)) = axis.window
            && !(from.is_finite() && to.is_finite() && from < to)
        {
            let allowed = "FROM:TO, two finite numbers, the first below the second";
            wrong.push(Complaint::option("--plane", format!("{from}:{to}"), allowed));
        }
        place.unwrap_or(0)
    });
    if wrong.is_empty() && places[0] == places[1] {
        let allowed = "two different names of the state";
        wrong.push(Complaint::option("--plane", request.axes[1].name.as_str(), allowed));
    }
    wrong.extend(request.layout.refused("21x15"));
    if wrong.is_empty() { Ok(places) } else { Err(wrong.into()) }
}

/// The window of a number of the state: centred on steady sliding. Its reach is the largest displacement there, or what the
/// largest velocity of a surface covers in a time scale; that of a velocity is this velocity and a half.
fn window(system: &System, start: &[f64], place: usize) -> (f64, f64) {
    let size = system.structure.size();
    let is_velocity = system.structure.mechanical().is_some() && place >= size;
    let speeds = system.contacts.iter().map(|contact| contact.surface_velocity.mean().abs());
    let speed = speeds.fold(0.0, f64::max);
    let state = sliding_state(system).unwrap_or_else(|_| start.to_vec());
    let largest = state.iter().fold(0.0, |m: f64, value| m.max(value.abs()));
    let reach = if is_velocity { 1.5 * speed.max(0.2 * largest) } else { largest.max(speed) };
    let reach = if reach > 0.0 { reach } else { 1.0 };
    (state[place] - reach, state[place] + reach)
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
        &TrackRequest { parameter: parameter.clone(), window: (*from, *to), along: None },
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
    Ok(evenly((*from, *to), *points).into_iter().map(Some).collect())
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

/// Settles every start and groups the starts by motion.
///
/// # Errors
/// Complaints about the request; [`Failure::Failed`] if no thread can be started or the work is interrupted.
pub fn run(
    study: &SystemStudy,
    request: &PlaneRequest,
    running: Running<'_>,
) -> Result<SystemBasins, Failure> {
    has_equations(study, "basins")?;
    let places = places(study, request)?;
    let start = Protocol::Study.state(study, study.system())?;
    let given = [0, 1].map(|number| request.axes[number].window);
    let window_of = |number: usize| {
        given[number].unwrap_or_else(|| window(study.system(), &start, places[number]))
    };
    let windows = [window_of(0), window_of(1)];
    let starts = request.layout.places(windows);
    let values = values(study, request.over.as_ref(), starts.len())?;
    let over = request.over.as_ref();
    let over = over.map(|over| study.model().parameter(&over.parameter)).transpose()?;
    let systems = values.iter().map(|value| {
        let numbers: Vec<_> = over.clone().zip(*value).into_iter().collect();
        let at = study.varied(&numbers).map_err(|why| failed("basins", why))?;
        let start = Protocol::Study.state(&at, at.system())?;
        Ok((at, start))
    });
    let systems = systems.collect::<Result<Vec<_>, Failure>>()?;
    let count = starts.len();
    running.progress.begin(systems.len() * count, 0);
    // Each task takes some starts of one system, whose runs go on side by side. Few starts are shared among the threads.
    let together = count.div_ceil(LEAST_TASKS).clamp(1, SIDE_BY_SIDE);
    let tasks: Vec<BasinsTask<'_>> = systems
        .iter()
        .flat_map(|(at, begun)| {
            starts.chunks(together).map(move |part| (at, begun.as_slice(), part))
        })
        .collect();
    let ends = running.pool()?.install(|| {
        tasks
            .in_parallel(|(at, begun, part)| {
                if running.stop.load(Ordering::Relaxed) {
                    return Err(stopped("basins"));
                }
                let states: Vec<Vec<f64>> = part
                    .iter()
                    .map(|values| {
                        let mut state = begun.to_vec();
                        for (place, value) in places.iter().zip(values) {
                            state[*place] = *value;
                        }
                        state
                    })
                    .collect();
                let ends = ends_of_runs(at.system(), &at.observe(), &states);
                running.progress.advance(part.len());
                Ok(ends)
            })
            .collect::<Result<Vec<_>, Failure>>()
    });
    running.progress.end();
    let mut ends = ends?.into_iter().flatten();
    let portraits = values.into_iter().zip(&systems).map(|(value, (at, _))| {
        let own: Vec<_> = ends.by_ref().take(count).collect();
        SystemPortrait::of(value, at.system(), own, request.layout)
    });
    let portraits = portraits.collect();
    let names = request.axes.each_ref().map(|axis| axis.name.clone());
    let start = Protocol::Study.words(study);
    let (layout, over) = (request.layout, request.over.clone());
    Ok(SystemBasins { names, windows, layout, starts, start, over, portraits })
}

impl SystemPortrait {
    /// The starts grouped by motion.
    fn of(
        value: Option<f64>,
        system: &System,
        found: Vec<Result<EndOfRun, String>>,
        layout: StartLayout,
    ) -> Self {
        let mut motions: Vec<(SystemAttractor, u32)> = Vec::new();
        let mut ends: Vec<Option<usize>> = Vec::with_capacity(found.len());
        let mut first = None;
        for end in found {
            match end {
                Ok(EndOfRun { attractor, periods }) => {
                    let place = motions.iter().position(|(known, _)| attractor.is(known, system));
                    let place = place.unwrap_or_else(|| {
                        motions.push((attractor, 0));
                        motions.len() - 1
                    });
                    motions[place].1 = motions[place].1.max(periods);
                    ends.push(Some(place));
                }
                Err(why) => {
                    first = first.or(Some(why));
                    ends.push(None);
                }
            }
        }
        let count = |place: usize| ends.iter().filter(|end| **end == Some(place)).count();
        let mut order: Vec<usize> = (0..motions.len()).collect();
        order.sort_by_key(|place| (!motions[*place].0.quiet, usize::MAX - count(*place)));
        let rank = |place: usize| order.iter().position(|other| *other == place);
        let ends: Vec<Option<usize>> = ends.iter().map(|end| end.and_then(rank)).collect();
        let inside = |holds: &dyn Fn(usize) -> bool| -> Vec<bool> {
            ends.iter().map(|end| end.is_some_and(holds)).collect()
        };
        let basins: Vec<SystemBasin> = order
            .iter()
            .enumerate()
            .map(|(number, place)| SystemBasin {
                attractor: motions[*place].0.clone(),
                share: Share::of(layout, &inside(&|end| end == number)),
                periods: motions[*place].1,
            })
            .collect();
        let open: Vec<bool> = ends.iter().map(Option::is_none).collect();
        let ends_quiet = inside(&|end| basins[end].attractor.quiet);
        let quiet = open.contains(&false).then(|| Share::between(layout, &ends_quiet, &open));
        let (is_dithered, local) = (system.is_dithered(), local_verdict(system));
        let unknown = Share::of(layout, &open);
        Self { value, is_dithered, local, basins, ends, quiet, unknown, why: first }
    }
}

/// The plane of the first displacement and its velocity, for a request without a plane.
///
/// # Errors
/// First-order equations with a single number, which have no plane.
pub fn default_plane(
    study: &SystemStudy,
    request: &BasinsRequest,
) -> Result<PlaneRequest, Failure> {
    let names = state_names(study.system());
    let size = study.system().structure.size();
    let second = if study.system().structure.mechanical().is_some() { size } else { 1 };
    let (Some(first), Some(second)) = (names.first(), names.get(second)) else {
        let allowed = "a state with two numbers";
        return Err(Complaint::option("--plane", names.len(), allowed).into());
    };
    let axis = |name: &String, window| PlaneAxis { name: name.clone(), window };
    let axes = [axis(first, request.displacement), axis(second, request.velocity)];
    Ok(PlaneRequest::of(axes, request.layout, request.over.clone()))
}

/// Reads a plane: `x,velocity.x`, or with windows `x=-1:1,velocity.x=-2:2`.
///
/// # Errors
/// Complaints about its parts.
pub fn read_plane(study: &SystemStudy, text: &str) -> Result<[PlaneAxis; 2], Complaints> {
    let option = "--plane";
    let names = state_names(study.system());
    let axis = |part: &str| -> Result<PlaneAxis, Box<Complaint>> {
        let Some((name, window)) = part.split_once('=') else {
            return Ok(PlaneAxis { name: part.trim().to_owned(), window: None });
        };
        let name = name.trim().to_owned();
        let place = names.iter().position(|known| *known == name);
        let quantity = place.and_then(|place| state_quantity(study.system(), place));
        let read = |text: &str| quantity::of_system(text, quantity, study.units(), option);
        let Some((from, to)) = window.split_once(':') else {
            let allowed = "NAME=FROM:TO, such as x=-1:1";
            return Err(Box::new(Complaint::option(option, part, allowed)));
        };
        Ok(PlaneAxis { name, window: Some((read(from)?, read(to)?)) })
    };
    let Some((first, second)) = text.split_once(',').filter(|(_, rest)| !rest.contains(',')) else {
        let allowed = "two names of the state, such as x,velocity.x or x=-1:1,velocity.x=-2:2";
        return Err(Complaint::option(option, text, allowed).into());
    };
    match (axis(first), axis(second)) {
        (Ok(first), Ok(second)) => Ok([first, second]),
        (first, second) => {
            let wrong = [first.err(), second.err()].into_iter().flatten();
            Err(wrong.map(|complaint| *complaint).collect::<Vec<_>>().into())
        }
    }
}
