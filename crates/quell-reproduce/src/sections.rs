//! Figures 2.10, 2.11, 3.12, 3.13, 4.11: displacement, velocity and Poincaré section from rest, one column for each amplitude.
//!
//! The dissertation judges these responses by eye. Here the attractor of the run from rest, the stability of the base response,
//! and the amplitudes at which either of them changes are measured (see `amplitude_columns`).

use std::fmt::Write as _;
use std::sync::Arc;

use quell_dynamics::attractor::Attractor;
use quell_dynamics::simulation::{Sample, Sampler, simulate};
use quell_model::Direction;

use super::amplitude_columns::{AmplitudeColumn, AmplitudeColumns, AmplitudeThreshold};
use super::caption::{law_name, letter, parameters, short, waveform_name};
use super::failure::failed;
use super::product::{Cell, DataTable, Product};
use super::responses::columns_of;
use super::source::{EntrySource, WAVEFORMS};
use super::start::start;
use quell::cite::Task;
use quell::complaint::Failure;
use quell::plot::{
    Figure, Layer, Legend, Marker, Panel, PlotAxis, PlotPoint, PlotRole, Points, Polyline,
    ReferenceLine, SharedLegend, Sharing, Size,
};

/// Length of the time axis in decay times 1/ζ of the free oscillator, and its bounds.
const DECAY_TIMES: f64 = 2.0;
const SHOWN: [f64; 2] = [80.0, 300.0];

/// Samples per dither period.
const SAMPLES_PER_PERIOD: f64 = 12.0;

/// Periods of the transient section from the start of the run, drawn as a grey trail.
const TRANSIENT: usize = 900;

/// Space on each side of the range of the sections, as a fraction of it.
const MARGIN: f64 = 0.05;

/// Largest number of states of a settled section that are drawn.
const SETTLED: usize = 400;

/// One waveform: that of the study.
pub(super) fn figure(source: &EntrySource) -> Result<Product, Failure> {
    of_waveforms(source, &[source.shared.columns(source.name, &source.study()?)?])
}

/// Figure 4.11: square as its caption says, and sine, which its text describes.
pub(super) fn square_and_sine(source: &EntrySource) -> Result<Product, Failure> {
    let blocks = source
        .family(WAVEFORMS, &["square", "sine"])
        .iter()
        .map(|waveform| {
            let study = source.changed(&[&format!("{WAVEFORMS}={waveform}")])?;
            source.shared.columns(source.name, &study)
        })
        .collect::<Result<Vec<Arc<AmplitudeColumns>>, Failure>>()?;
    of_waveforms(source, &blocks)
}

fn of_waveforms(
    source: &EntrySource,
    blocks: &[Arc<AmplitudeColumns>],
) -> Result<Product, Failure> {
    let several = blocks.len() > 1;
    let mut panels = Vec::new();
    let mut histories: Vec<(String, &'static str, Vec<f64>)> = Vec::new();
    let mut sections = DataTable::new("section", SECTION);
    let mut summary = DataTable::new("", SUMMARY);
    let columns = blocks.first().map_or(1, |block| block.cases.len());
    for block in blocks {
        let waveform = waveform_name(block.study.belt().dithers()[0].waveform.clone());
        let mut rows: [Vec<Panel>; 3] = Default::default();
        for (index, case) in block.cases.iter().enumerate() {
            let name = letter(index);
            let samples = history(source, case)?;
            let transient = stroboscopic_section(source, case)?;
            let prefix = if several { format!("{waveform}_{name}") } else { name.to_string() };
            if histories.is_empty() {
                let time = samples.iter().map(|s| s.time).collect();
                histories.push(("time".to_owned(), "1/ω0", time));
            }
            histories.extend(columns_of(&prefix, &samples));
            let settled =
                case.attractor.as_ref().map_or(&[][..], |attractor| attractor.section.as_slice());
            for (part, states) in [("from rest", transient.as_slice()), ("settled", settled)] {
                for &(x, v) in states {
                    sections.row([
                        Cell::from(waveform),
                        Cell::from(name.to_string().as_str()),
                        case.amplitude.into(),
                        Cell::from(part),
                        x.into(),
                        v.into(),
                    ]);
                }
            }
            summary.row(summary_row(waveform, name, case));
            let [x, v, section] =
                drawn(case, &title(block, several, name, case), &samples, &transient);
            rows[0].push(x);
            rows[1].push(v);
            rows[2].push(section);
        }
        panels.extend(rows.into_iter().flatten());
    }
    common_range(&mut panels, columns);
    let figure = Figure::grid(columns, panels.into_iter().map(|panel| panel.legend(Legend::None)))
        .sharing_y(Sharing::Aligned)
        .legend(SharedLegend::Above)
        .size(Size::Frame(150.0, 118.0));
    let study = blocks[0].study.clone();
    Ok(Product::new(figure, caption(source, blocks), &study)
        .by(&[Task::Simulate, Task::Stability])
        .table(summary)
        .table(sections)
        .table(DataTable::of_columns("history", histories)))
}

/// Gives all sections (every third row of panels) one range of x.
fn common_range(panels: &mut [Panel], columns: usize) {
    let is_section = |index: usize| index / columns % 3 == 2;
    let states = panels
        .iter()
        .enumerate()
        .filter(|(index, _)| is_section(*index))
        .flat_map(|(_, panel)| &panel.layers)
        .filter_map(|layer| if let Layer::Points(points) = layer { Some(points) } else { None })
        .flat_map(|points| points.points.iter().map(|point| point.x));
    let range = states.fold(None, |range: Option<(f64, f64)>, x| {
        Some(range.map_or((x, x), |(low, high)| (low.min(x), high.max(x))))
    });
    let Some((low, high)) = range else { return };
    let margin = MARGIN * (high - low);
    for (_, panel) in panels.iter_mut().enumerate().filter(|(index, _)| is_section(*index)) {
        panel.x = panel.x.clone().between(low - margin, high + margin);
    }
}

/// AmplitudeColumns of the table of sections.
const SECTION: &[(&str, &str)] = &[
    ("waveform", "word"),
    ("case", "word"),
    ("amplitude", "length (force/k)"),
    ("part", "word"),
    ("displacement", "length"),
    ("velocity", "length (velocity/ω0)"),
];

const SUMMARY: &[(&str, &str)] = &[
    ("waveform", "word"),
    ("case", "word"),
    ("amplitude", "length (force/k)"),
    ("from_rest", "word"),
    ("quiet_response", "word"),
    ("kind", "word"),
    ("peak_to_peak", "length"),
    ("stick_fraction", "1"),
    ("rotation_number", "1"),
    ("frequency", "ω0"),
];

/// A row of the summary.
fn summary_row(waveform: &str, name: char, case: &AmplitudeColumn) -> Vec<Cell> {
    let attractor = case.attractor.as_ref();
    let of = |value: fn(&Attractor) -> f64| Cell::from(attractor.map(value));
    let kind =
        attractor.map_or_else(|| "not settled".to_owned(), |attractor| attractor.kind.words());
    vec![
        waveform.into(),
        name.to_string().as_str().into(),
        case.amplitude.into(),
        if case.quiet { "settles" } else { "vibrates" }.into(),
        case.local.name().into(),
        kind.as_str().into(),
        of(Attractor::size),
        of(|attractor| attractor.stick_fraction),
        attractor
            .and_then(|attractor| attractor.rotation)
            .map(|rotation| rotation.turns_per_period)
            .into(),
        case.frequency().into(),
    ]
}

fn title(block: &AmplitudeColumns, several: bool, name: char, case: &AmplitudeColumn) -> String {
    let dither = block.study.belt().dithers()[0].clone();
    let symbol = if dither.direction == Direction::Normal { "D_N" } else { "D_T" };
    let waveform =
        if several { format!("{}, ", waveform_name(dither.waveform)) } else { String::new() };
    format!("({name}) {waveform}${symbol}$ = {}", short(case.amplitude))
}

/// The three panels of a column.
fn drawn(
    case: &AmplitudeColumn,
    title: &str,
    samples: &[Sample],
    transient: &[(f64, f64)],
) -> [Panel; 3] {
    let belt_velocity = case.study.belt().belt_velocity();
    let role = if case.quiet { PlotRole::Dithered } else { PlotRole::Unstable };
    let until = samples.last().map_or(1.0, |sample| sample.time);
    let time = || PlotAxis::new("time").symbol("τ").between(0.0, until);
    let curve = |value: fn(&Sample) -> f64| {
        let points = samples.iter().map(|s| PlotPoint::new(s.time, value(s)));
        Polyline::new(role, points.collect::<Vec<_>>()).width(0.6)
    };
    let displacement = Panel::new(time(), PlotAxis::new("displacement").symbol("x"))
        .title(title)
        .with(curve(|s| s.displacement));
    let velocity = Panel::new(time(), PlotAxis::new("velocity").symbol("x′"))
        .with(curve(|s| s.velocity))
        .with(ReferenceLine::horizontal(belt_velocity));
    let settled = case.attractor.as_ref().map_or(&[][..], |attractor| attractor.section.as_slice());
    let step = settled.len().div_ceil(SETTLED).max(1);
    let point = |&(x, v): &(f64, f64)| PlotPoint::new(x, v);
    let states: Vec<PlotPoint> = settled.iter().step_by(step).map(point).collect();
    let (marker, size) = if states.len() == 1 { (Marker::Disc, 6.0) } else { (Marker::Disc, 2.6) };
    let label = if case.quiet { "settles" } else { "vibrates" };
    let section = Panel::new(
        PlotAxis::new("displacement").symbol("x"),
        PlotAxis::new("velocity").symbol("x′"),
    )
    .with(
        Points::new(PlotRole::Guide, transient.iter().map(point))
            .size(2.0)
            .label("section from rest"),
    )
    .with(Points::new(role, states).marker(marker).size(size).label(label));
    [displacement, velocity, section]
}

/// Samples over the time axis.
fn history(source: &EntrySource, case: &AmplitudeColumn) -> Result<Vec<Sample>, Failure> {
    let decay = DECAY_TIMES / case.study.belt().damping_ratio();
    let until = decay.clamp(SHOWN[0], SHOWN[1]);
    let step = case.period / SAMPLES_PER_PERIOD;
    sampled(source, case, step, count(until / step))
}

/// Stroboscopic states of the first periods.
fn stroboscopic_section(
    source: &EntrySource,
    case: &AmplitudeColumn,
) -> Result<Vec<(f64, f64)>, Failure> {
    let samples = sampled(source, case, case.period, TRANSIENT)?;
    Ok(samples.iter().map(|sample| (sample.displacement, sample.velocity)).collect())
}

fn sampled(
    source: &EntrySource,
    case: &AmplitudeColumn,
    step: f64,
    count: usize,
) -> Result<Vec<Sample>, Failure> {
    let start = start(&case.study)?;
    let mut sampler = Sampler::new(0.0, step, count);
    let until = count as f64 * step;
    simulate(case.study.belt(), start, until, case.study.solver().tolerance, &mut sampler)
        .map_err(|error| failed(source.name, &error))?;
    Ok(sampler.samples)
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count of samples")]
fn count(steps: f64) -> usize {
    steps.floor().max(1.0) as usize + 1
}

fn caption(source: &EntrySource, blocks: &[Arc<AmplitudeColumns>]) -> String {
    let study = &blocks[0].study;
    let belt = study.belt();
    let dither = belt.dithers()[0].clone();
    let (direction, d, r) = match dither.direction {
        Direction::Tangential => ("tangential", "D_T", "R_T"),
        Direction::Normal => ("normal", "D_N", "R_N"),
    };
    let mut text = format!(
        "Responses from rest with the {} law and {direction} dither: displacement, velocity, and Poincaré section \
         at ${r}τ$ = 2πn (grey: the first {TRANSIENT} periods; blue: settled to the period of the dither; red: vibrates \
         indefinitely). $ζ$ = {}, $v_0$ = {}, ${r}$ = {}, {}.",
        law_name(belt.friction().kind()),
        belt.damping_ratio(),
        belt.belt_velocity(),
        dither.frequency_ratio,
        parameters(study),
    );
    for block in blocks {
        let waveform = waveform_name(block.study.belt().dithers()[0].waveform.clone());
        let _ = write!(
            text,
            " Measured, {waveform}: from rest the response {}; the base response itself {}.",
            list(&block.from_rest, d, ["vibrates", "settles"]),
            list(&block.local, d, ["is unstable", "is stable"]),
        );
    }
    source.caption(&text, departure(source.name))
}

/// Departure of a figure from the dissertation.
fn departure(name: &str) -> &'static str {
    match name {
        "2.11" => "The printed caption has $v_0$ = 1.0; its text and responses are for 1.5.",
        "4.11" => {
            "The printed caption says square; the pattern described in the text occurs with a sine."
        }
        _ => {
            "Below the local threshold the base response and a stick-slip vibration coexist. The threshold from rest, which \
               is lower than that of averaging, is where rest crosses the boundary between their basins."
        }
    }
}

fn list(changes: &[AmplitudeThreshold], symbol: &str, words: [&str; 2]) -> String {
    let parts: Vec<String> = changes
        .iter()
        .map(|change| {
            format!(
                "{} above ${symbol}$ = {}",
                words[usize::from(change.holds_above)],
                short4(change.amplitude)
            )
        })
        .collect();
    if parts.is_empty() { "does not change".to_owned() } else { parts.join(", ") }
}

/// Four decimals.
fn short4(value: f64) -> String {
    format!("{value:.4}")
}
