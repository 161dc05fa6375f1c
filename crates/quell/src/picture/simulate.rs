//! A motion: the observed displacement over time with what every contact does, and the phase plane.

use quell_dynamics::motion::{ContactPhase, MotionSampler};
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;

use super::caption::caption;
use super::manoeuvre::around_response;
use super::ruler::{Ruler, time_between};
use crate::plot::{
    Figure, LineStyle, Panel, PlotPoint, PlotRole, Polyline, ReferenceLine, SharedLegend, Sharing,
};
use crate::run::simulate::Simulation;
use crate::run::simulate::history::EventHistory;
use crate::run::system::start::observed_states;
use crate::study::SystemStudy;
use crate::words::capital;

/// Width of the bars of stick and separation.
const BAR: f64 = 4.0;

/// Distance of the bars of two contacts, over the range of the curve.
const SPACING: f64 = 0.075;

/// Contacts with bars.
const MOST_BARS: usize = 10;

/// The observed motion at every sample.
struct Observed {
    times: Vec<f64>,
    displacement: Vec<f64>,
    /// None for first-order equations.
    velocity: Option<Vec<f64>>,
}

impl Observed {
    fn of(study: &SystemStudy, samples: &MotionSampler) -> Self {
        let (displacement, velocity) = observed_states(study, &samples.states);
        Self { times: samples.times.clone(), displacement, velocity }
    }
}

/// The picture of a sampled motion, with that from the same start without dither where it is known.
pub fn simulate(study: &SystemStudy, done: &Simulation, samples: &MotionSampler) -> Figure {
    let with = Observed::of(study, samples);
    let without = done.undithered.as_ref().and_then(|samples| samples.as_ref().ok());
    let without = without.map(|samples| Observed::of(study, samples));
    let both = || [Some(&with), without.as_ref()].into_iter().flatten();
    let places = both().flat_map(|motion| motion.displacement.iter().copied());
    let x = Ruler::new(study, Quantity::Displacement, places);
    let (time, clock) = time_between(study, RealInterval::new(done.start.time, done.end.time));
    let across = x.axis("observed displacement", "");
    let over_time = |motion: &Observed| -> Vec<PlotPoint> {
        let times = motion.times.iter().map(|time| clock.place(*time));
        let places = motion.displacement.iter().map(|value| x.place(*value));
        PlotPoint::zip(times, places).collect()
    };
    let curves = curves(study, &with, without.as_ref(), &over_time);
    let ends = both().flat_map(|motion| &motion.displacement).map(|value| x.place(*value));
    let ends = ends.fold(RealInterval::new(f64::INFINITY, f64::NEG_INFINITY), |ends, x| {
        RealInterval::new(ends.lower.min(x), ends.upper.max(x))
    });
    let panel = Panel::new(time.clone(), across.clone()).with_all(curves);
    let panel = panel.with_all(bars(&done.history, &clock, ends));
    let start = done.start_in_words(study);
    if done.manoeuvre.is_some() {
        let (mut panels, below) =
            around_response(study, samples, &with.displacement, (&time, &clock));
        panels.push(panel);
        panels.extend(below);
        let found = done.manoeuvre_sentence(study).unwrap_or_default();
        return Figure::grid(1, panels)
            .sharing_x(Sharing::All)
            .title(study.title().unwrap_or_default())
            .caption(format!("{} {found}", whole_caption(study, &start)));
    }
    let mut panels = vec![panel];
    let rates = || both().filter_map(|motion| motion.velocity.as_deref());
    if with.velocity.is_some() {
        let surface = surface(study);
        let shown = rates().flatten().copied().chain(surface);
        let v = Ruler::new(study, Quantity::Velocity, shown);
        let plane = |motion: &Observed| -> Vec<PlotPoint> {
            let rates = motion.velocity.iter().flatten().map(|rate| v.place(*rate));
            PlotPoint::zip(motion.displacement.iter().map(|value| x.place(*value)), rates).collect()
        };
        let curves = self::curves(study, &with, without.as_ref(), &plane);
        let surface = surface.map(|surface| {
            ReferenceLine::horizontal(v.place(surface)).label("velocity of the surface")
        });
        let panel = Panel::new(across, v.axis("observed velocity", ""));
        panels.push(panel.with_all(surface).with_all(curves));
    }
    let figure = Figure::grid(1, panels)
        .title(study.title().unwrap_or_default())
        .caption(whole_caption(study, &start));
    if without.is_some() { figure.legend(SharedLegend::Above) } else { figure }
}

/// The curves with and without dither, the latter below the former.
fn curves(
    study: &SystemStudy,
    with: &Observed,
    without: Option<&Observed>,
    points: &dyn Fn(&Observed) -> Vec<PlotPoint>,
) -> Vec<Polyline> {
    let role = if study.system().inputs.is_empty() { PlotRole::Exact } else { PlotRole::Dithered };
    let with = Polyline::new(role, points(with));
    let Some(without) = without else { return vec![with] };
    let without = Polyline::new(PlotRole::Undithered, points(without));
    vec![without.label("without dither"), with.label("with dither")]
}

/// Velocity of the surface on which the observed displacement slides, where it is the displacement of the only contact.
fn surface(study: &SystemStudy) -> Option<f64> {
    let [contact] = study.system().contacts.as_slice() else { return None };
    let is_observed = contact.tangent.as_ref().is_some_and(|row| *row == study.observe());
    (is_observed && study.system().is_steady()).then(|| contact.surface_velocity.mean())
}

/// A bar below the curve for every interval in which a contact sticks or is open, one line for each of the first contacts.
fn bars(
    history: &EventHistory,
    clock: &Ruler,
    RealInterval { lower: least, upper: most }: RealInterval,
) -> Vec<Polyline> {
    let length = if most > least { most - least } else { 1.0 };
    let kinds = [("stick", ContactPhase::Stick, 0), ("open", ContactPhase::Open, 1)];
    let mut lines = Vec::new();
    for (label, phase, series) in kinds {
        let contacts = history.intervals.iter().take(MOST_BARS).enumerate();
        let pieces = contacts.flat_map(|(contact, intervals)| {
            let of_phase = intervals.iter().filter(move |interval| interval.phase == phase);
            let height = least - (contact + 1) as f64 * SPACING * length;
            of_phase.map(move |interval| {
                [interval.from, interval.to].map(|time| PlotPoint::new(clock.place(time), height))
            })
        });
        let pieces: Vec<[PlotPoint; 2]> = pieces.collect();
        if !pieces.is_empty() {
            let bars = Polyline::pieces(PlotRole::Series(series), pieces);
            lines.push(bars.width(BAR).style(LineStyle::Solid).label(label));
        }
    }
    lines
}

/// The caption of a run from a start.
fn whole_caption(study: &SystemStudy, start: &str) -> String {
    let contacts = &study.system().contacts;
    let names: Vec<String> =
        contacts.iter().take(MOST_BARS).map(|contact| contact.name.clone()).collect();
    let bars = match names.len() {
        0 => String::new(),
        1 => format!(" Bars: contact {}.", names[0]),
        _ => format!(" Bars from top to bottom: contacts {}.", names.join(", ")),
    };
    format!("{} {}.{bars}", caption(study), capital(start))
}
