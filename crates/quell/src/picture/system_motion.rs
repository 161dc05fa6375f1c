//! Pictures of the motion of a system: the observed displacement, what every contact does, and the phase plane.

use quell_dynamics::motion::{ContactPhase, MotionSampler};
use quell_dynamics::response::SystemRecord;
use quell_model::units::Quantity;

use super::caption::caption_of_system;
use super::manoeuvre::around_response;
use super::ruler::Ruler;
use super::system::frequency_axis;
use crate::plot::{
    Figure, LineStyle, Panel, PlotAxis, PlotRole, Polyline, ReferenceLine, SharedLegend, Sharing,
};
use crate::run::system::history::EventHistory;
use crate::run::system::response::SettledSystem;
use crate::run::system::simulate::SystemSimulation;
use crate::run::system::start::start_in_words;
use crate::study::SystemStudy;
use crate::words::capital;

/// Width of the bars of stick and separation.
const BAR: f64 = 4.0;

/// Distance of the bars of two contacts, over the range of the curve.
const SPACING: f64 = 0.075;

/// Contacts with bars.
const MOST_BARS: usize = 10;

/// Number of periods of the strongest slow line of the record that are shown.
const PERIODS_SHOWN: f64 = 8.0;

/// Number of decades of the spectrum that are shown below its largest line.
const DECADES: i32 = 5;

/// The axis of time between two times, and its ruler.
pub(super) fn time_axis(study: &SystemStudy, (from, to): (f64, f64)) -> (PlotAxis, Ruler) {
    let ruler = Ruler::of_system(study, Quantity::Time, [from, to]);
    let axis = ruler.axis("time", "t").between(ruler.place(from), ruler.place(to));
    (axis, ruler)
}

/// The observed displacement and its velocity at every sample; no velocity for first-order equations.
pub(super) fn observed(
    study: &SystemStudy,
    samples: &MotionSampler,
) -> (Vec<f64>, Option<Vec<f64>>) {
    let row = study.observe();
    let size = study.system().state_size();
    let of = |offset: usize| -> Vec<f64> {
        let states = samples.states.chunks(size);
        states
            .map(|state| row.iter().zip(&state[offset..]).map(|(weight, x)| weight * x).sum())
            .collect()
    };
    let velocity = study.system().structure.mechanical().map(|structure| of(structure.size()));
    (of(0), velocity)
}

/// The picture of a sampled motion.
pub fn simulate(study: &SystemStudy, done: &SystemSimulation, samples: &MotionSampler) -> Figure {
    let (displacement, velocity) = observed(study, samples);
    let role = if study.system().inputs.is_empty() { PlotRole::Exact } else { PlotRole::Dithered };
    let x = Ruler::of_system(study, Quantity::Displacement, displacement.iter().copied());
    let plain = displacement.clone();
    let displacement: Vec<f64> = displacement.into_iter().map(|value| x.place(value)).collect();
    let (time, clock) = time_axis(study, (done.start.time, done.end.time));
    let times = samples.times.iter().map(|time| clock.place(*time));
    let over_time = times.zip(displacement.iter().copied());
    let across = x.axis("observed displacement", "");
    let ends = displacement.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), x| {
        (f64::min(least, *x), f64::max(most, *x))
    });
    let axis = time.clone();
    let panel = Panel::new(time, across.clone()).with(Polyline::new(role, over_time));
    let panel = panel.with_all(bars(&done.history, &clock, ends));
    if done.manoeuvre.is_some() {
        let (mut panels, below) = around_response(study, samples, &plain, (&axis, &clock));
        panels.push(panel);
        panels.extend(below);
        let found = done.manoeuvre_sentence(study).unwrap_or_default();
        let start = start_in_words(study, &done.request.start);
        return Figure::grid(1, panels)
            .sharing_x(Sharing::All)
            .title(study.title().unwrap_or_default())
            .caption(format!("{} {found}", caption(study, &start)));
    }
    let mut panels = vec![panel];
    if let Some(velocity) = velocity {
        let v = Ruler::of_system(study, Quantity::Velocity, velocity.iter().copied());
        let up = v.axis("observed velocity", "");
        let plane = displacement.into_iter().zip(velocity.into_iter().map(|rate| v.place(rate)));
        panels.push(Panel::new(across, up).with(Polyline::new(role, plane)));
    }
    Figure::grid(1, panels)
        .title(study.title().unwrap_or_default())
        .caption(caption(study, &start_in_words(study, &done.request.start)))
}

/// A bar below the curve for every interval in which a contact sticks or is open, one line for each of the first contacts.
fn bars(history: &EventHistory, clock: &Ruler, (least, most): (f64, f64)) -> Vec<Polyline> {
    let length = if most > least { most - least } else { 1.0 };
    let kinds = [("stick", ContactPhase::Stick, 0), ("open", ContactPhase::Open, 1)];
    let mut lines = Vec::new();
    for (label, phase, series) in kinds {
        let contacts = history.intervals.iter().take(MOST_BARS).enumerate();
        let pieces = contacts.flat_map(|(contact, intervals)| {
            let of_phase = intervals.iter().filter(move |interval| interval.phase == phase);
            let height = least - (contact + 1) as f64 * SPACING * length;
            of_phase.map(move |interval| {
                [(clock.place(interval.from), height), (clock.place(interval.to), height)]
            })
        });
        let pieces: Vec<[(f64, f64); 2]> = pieces.collect();
        if !pieces.is_empty() {
            let bars = Polyline::pieces(PlotRole::Series(series), pieces);
            lines.push(bars.width(BAR).style(LineStyle::Solid).label(label));
        }
    }
    lines
}

/// The caption of a run from a start.
fn caption(study: &SystemStudy, start: &str) -> String {
    let contacts = &study.system().contacts;
    let names: Vec<String> =
        contacts.iter().take(MOST_BARS).map(|contact| contact.name.clone()).collect();
    let bars = match names.len() {
        0 => String::new(),
        1 => format!(" Bars: contact {}.", names[0]),
        _ => format!(" Bars from top to bottom: contacts {}.", names.join(", ")),
    };
    format!("{} {}.{bars}", caption_of_system(study), capital(start))
}

/// The picture of a steady response: the end of the record and the spectrum, with and without dither.
pub fn response(study: &SystemStudy, done: &SettledSystem) -> Figure {
    let (with, without) = (&done.response.dithered, &done.response.undithered);
    let dithered = done.has_dither();
    let start = start_in_words(study, &Vec::new());
    Figure::grid(
        1,
        [record(study, done, dithered), spectra(study, [with, without], dithered, done)],
    )
    .legend(if dithered { SharedLegend::Above } else { SharedLegend::default() })
    .title(study.title().unwrap_or_default())
    .caption(format!("{} {}.", caption_of_system(study), capital(&start)))
}

/// The records with and without dither, or one of them.
fn both(panel: Panel, dithered: bool, curves: [Vec<(f64, f64)>; 2]) -> Panel {
    let [with, without] = curves;
    if !dithered {
        return panel.with(Polyline::new(PlotRole::Exact, without));
    }
    panel
        .with(Polyline::new(PlotRole::Undithered, without).label("without dither"))
        .with(Polyline::new(PlotRole::Dithered, with).label("with dither"))
}

fn record(study: &SystemStudy, done: &SettledSystem, dithered: bool) -> Panel {
    let (with, without) = (&done.response.dithered, &done.response.undithered);
    let lines = without.spectrum.frequencies().zip(without.spectrum.amplitudes()).skip(1);
    let low = lines.take_while(|(frequency, _)| *frequency <= done.response.band_end);
    let strongest = low.max_by(|a, b| a.1.total_cmp(b.1)).map_or(0.0, |(frequency, _)| frequency);
    let shown = PERIODS_SHOWN * std::f64::consts::TAU / strongest;
    let end = done.plan.settle + done.plan.length;
    let first = (end - shown.min(done.plan.length)).max(done.plan.settle);
    let (time, clock) = time_axis(study, (first, end));
    let values = [with, without].map(|record| record.row.samples.iter().copied());
    let x = Ruler::of_system(study, Quantity::Displacement, values.into_iter().flatten());
    let points = |record: &SystemRecord| -> Vec<(f64, f64)> {
        let samples = record.row.samples.iter().enumerate();
        let times = samples.map(|(number, value)| {
            (f64::mul_add(number as f64, record.step, done.plan.settle), *value)
        });
        let shown = times.filter(|(time, _)| *time >= first);
        shown.map(|(time, value)| (clock.place(time), x.place(value))).collect()
    };
    let panel = Panel::new(time, x.axis("observed displacement", ""));
    both(panel, dithered, [points(with), points(without)])
}

fn spectra(
    study: &SystemStudy,
    records: [&SystemRecord; 2],
    dithered: bool,
    done: &SettledSystem,
) -> Panel {
    let (across, factor) = frequency_axis(study, "ω");
    let largest =
        |record: &SystemRecord| record.spectrum.amplitudes().iter().copied().fold(0.0, f64::max);
    let top = largest(records[0]).max(largest(records[1]));
    let floor = top * 10f64.powi(-DECADES);
    let size = Ruler::of_system(study, Quantity::Displacement, [top]);
    let end = 1.3 * fastest_line(records, floor);
    let points = records.map(|record| -> Vec<(f64, f64)> {
        let lines = record.spectrum.frequencies().zip(record.spectrum.amplitudes());
        let shown = lines.skip(1).take_while(|(frequency, _)| *frequency <= end);
        shown
            .map(|(frequency, amplitude)| {
                (factor * frequency, size.place(amplitude.max(0.1 * floor)))
            })
            .collect()
    });
    let mut up = size.axis("spectral amplitude", "").log();
    if top > 0.0 {
        up = up.between(size.place(floor), size.place(2.0 * top));
    }
    let mut panel = Panel::new(across.between(0.0, factor * end), up);
    if dithered {
        let band = factor * done.response.band_end;
        panel = panel.with(ReferenceLine::vertical(band).label("band of $E$"));
    }
    both(panel, dithered, points)
}

/// The highest frequency of a line above a hundred times the floor.
fn fastest_line(records: [&SystemRecord; 2], floor: f64) -> f64 {
    let highest = |record: &SystemRecord| {
        let lines = record.spectrum.frequencies().zip(record.spectrum.amplitudes()).skip(1);
        let high = lines.filter(|(_, amplitude)| **amplitude > 100.0 * floor);
        high.map(|(frequency, _)| frequency).last()
    };
    let all = records.map(highest).into_iter().flatten().fold(0.0, f64::max);
    let last = records[0].spectrum.frequencies().last().unwrap_or(1.0);
    if all > 0.0 { all } else { last }
}
