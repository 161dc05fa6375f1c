//! `basins` of a system: the motions on which starts in a plane of two numbers of the state end, and the share of each.

use std::sync::atomic::Ordering;

use quell_dynamics::motion::orbit::{base_motion, sliding_state};
use quell_model::System;
use rayon::prelude::*;

use super::attractor::{EndOfRun, SystemAttractor, end_of_run};
use super::cycle::BASE_STEPS;
use super::has_equations;
use super::protocol::SystemProtocol;
use super::start::{state_names, state_quantity};
use crate::complaint::{Complaint, Complaints, Failure};
use crate::quantity;
use crate::run::basins::{BasinsRequest, MOST_STARTS, Share, StartLayout};
use crate::run::{evenly, stopped};
use crate::study::{SystemStudy, suggest};
use crate::sweep::Running;

/// Periods of the dither within which a run must settle.
pub const MOST_PERIODS_OF_A_START: u32 = 500;

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
    /// Numbers of values on each axis, edges included.
    pub grid: (usize, usize),
}

impl PlaneRequest {
    /// A request with the layout of a belt's starts.
    ///
    /// # Errors
    /// Random starts.
    pub fn of(axes: [PlaneAxis; 2], layout: StartLayout) -> Result<Self, Failure> {
        let grid = match layout {
            layout if layout == StartLayout::default() => GRID,
            StartLayout::Grid { columns, rows } => (columns, rows),
            StartLayout::Sample { count, .. } => {
                let allowed = "left out: starts of a system are on a grid (--grid)";
                return Err(Complaint::option("--sample", count, allowed).into());
            }
        };
        Ok(Self { axes, grid })
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

/// The basins of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct SystemBasins {
    /// Names of the axes.
    pub names: [String; 2],
    /// Values along the first and the second axis.
    pub values: [Vec<f64>; 2],
    /// The start of all other numbers of the state in words.
    pub start: String,
    /// The motions, quiescent ones first, then the largest share first.
    pub basins: Vec<SystemBasin>,
    /// The motion of each start, the first axis fastest; `None` if its outcome is unknown.
    pub ends: Vec<Option<usize>>,
    /// The share of starts that end in step with the dither, or at rest.
    pub quiet: Share,
    /// Number of starts of unknown outcome, and why the first of them is unknown.
    pub unknown: (usize, Option<String>),
    /// Verdict on the base response, or why it is unknown.
    pub local: Result<&'static str, String>,
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
                complaint.suggesting(suggest::word(&axis.name, names.iter().map(String::as_str))),
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
    let (columns, rows) = request.grid;
    if columns < 2 || rows < 2 || columns.checked_mul(rows).is_none_or(|all| all > MOST_STARTS) {
        let allowed = format!(
            "NxM, two whole numbers of at least 2 and at most {MOST_STARTS} starts in total, such as 21x15"
        );
        wrong.push(Complaint::option("--grid", format!("{columns}x{rows}"), allowed));
    }
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
    let system = study.system();
    let start = SystemProtocol::Study.state(study, system)?;
    let (columns, rows) = request.grid;
    let axis = |number: usize, count: usize| {
        let given = request.axes[number].window;
        evenly(given.unwrap_or_else(|| window(system, &start, places[number])), count)
    };
    let values = [axis(0, columns), axis(1, rows)];
    let row = study.observe();
    let begin = |index: usize| {
        let mut state = start.clone();
        state[places[0]] = values[0][index % columns];
        state[places[1]] = values[1][index / columns];
        state
    };
    running.progress.begin(columns * rows, 0);
    let ends = running.pool()?.install(|| {
        (0..columns * rows)
            .into_par_iter()
            .with_max_len(1)
            .map(|index| {
                if running.stop.load(Ordering::Relaxed) {
                    return Err(stopped("basins"));
                }
                let end = end_of_run(system, &row, &begin(index), MOST_PERIODS_OF_A_START);
                running.progress.advance(1);
                Ok(end)
            })
            .collect::<Result<Vec<_>, Failure>>()
    });
    running.progress.end();
    let gathered = gathered(ends?, request.grid);
    let local = if system.is_dithered() {
        let base = base_motion(system, BASE_STEPS);
        base.map(|orbit| orbit.verdict().name()).map_err(|why| why.to_string())
    } else {
        Err("without dither there is no base response".to_owned())
    };
    let names = request.axes.each_ref().map(|axis| axis.name.clone());
    let start = SystemProtocol::Study.words(study);
    let (basins, ends, quiet, unknown) = gathered;
    Ok(SystemBasins { names, values, start, basins, ends, quiet, unknown, local })
}

/// Basins, the motion of each start, the quiescent share, and the starts of unknown outcome.
type GatheredStarts = (Vec<SystemBasin>, Vec<Option<usize>>, Share, (usize, Option<String>));

/// The starts grouped by motion.
fn gathered(
    found: Vec<Result<EndOfRun, String>>,
    (columns, rows): (usize, usize),
) -> GatheredStarts {
    let layout = StartLayout::Grid { columns, rows };
    let mut motions: Vec<(SystemAttractor, u32)> = Vec::new();
    let mut ends: Vec<Option<usize>> = Vec::with_capacity(found.len());
    let mut unknown = (0, None);
    for end in found {
        match end {
            Ok(EndOfRun { attractor, periods }) => {
                let place = motions.iter().position(|(known, _)| attractor.is(known));
                let place = place.unwrap_or_else(|| {
                    motions.push((attractor, 0));
                    motions.len() - 1
                });
                motions[place].1 = motions[place].1.max(periods);
                ends.push(Some(place));
            }
            Err(why) => {
                unknown = (unknown.0 + 1, unknown.1.or(Some(why)));
                ends.push(None);
            }
        }
    }
    let count = |place: usize| ends.iter().filter(|end| **end == Some(place)).count();
    let mut order: Vec<usize> = (0..motions.len()).collect();
    order.sort_by_key(|place| (!motions[*place].0.is_quiet(), usize::MAX - count(*place)));
    let rank = |place: usize| order.iter().position(|other| *other == place);
    let ends: Vec<Option<usize>> = ends.iter().map(|end| end.and_then(rank)).collect();
    let share = |holds: &dyn Fn(usize) -> bool| {
        let inside: Vec<bool> = ends.iter().map(|end| end.is_some_and(holds)).collect();
        Share::of(layout, &inside)
    };
    let basins: Vec<SystemBasin> = order
        .iter()
        .enumerate()
        .map(|(number, place)| SystemBasin {
            attractor: motions[*place].0.clone(),
            share: share(&|end| end == number),
            periods: motions[*place].1,
        })
        .collect();
    let quiet = share(&|end| basins[end].attractor.is_quiet());
    (basins, ends, quiet, unknown)
}

/// The plane of the first displacement and its velocity, for a request without a plane.
///
/// # Errors
/// Random starts and a varied parameter, which basins of systems do not have; first-order equations, which need a plane.
pub fn default_plane(
    study: &SystemStudy,
    request: &BasinsRequest,
) -> Result<PlaneRequest, Failure> {
    if let Some(over) = &request.over {
        let allowed = "left out: basins of a system are those of the study as it is";
        return Err(Complaint::option("--over", over.parameter.as_str(), allowed).into());
    }
    let names = state_names(study.system());
    let size = study.system().structure.size();
    let second = if study.system().structure.mechanical().is_some() { size } else { 1 };
    let (Some(first), Some(second)) = (names.first(), names.get(second)) else {
        let allowed = "a state with two numbers";
        return Err(Complaint::option("--plane", names.len(), allowed).into());
    };
    let axis = |name: &String, window| PlaneAxis { name: name.clone(), window };
    let axes = [axis(first, request.displacement), axis(second, request.velocity)];
    PlaneRequest::of(axes, request.layout)
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
