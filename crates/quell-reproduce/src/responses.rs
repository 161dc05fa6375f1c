//! Figures 2.3, 3.7–3.9, 4.3, 4.4: displacement, velocity and spectrum, with and without dither.
//!
//! Rows: x(τ) and x′(τ) from rest, and the spectral amplitudes of the steady record (settling time discarded, mean removed,
//! Hann window). One column for each amplitude of the study's sweep.

use quell_dynamics::response::{BAND_END, ResponsePlan, Spectrum, SteadyResponse, respond};
use quell_dynamics::simulation::{Sample, Sampler, simulate};
use quell_model::{Belt, Direction, LawKind};

use super::axis::values;
use super::caption::{law_name, letter, parameters, waveform_name};
use super::failure::failed;
use super::product::{DataTable, Product};
use super::source::EntrySource;
use super::start::start;
use quell::cite::Task;
use quell::complaint::Failure;
use quell::plot::{
    Figure, Legend, Panel, PlotAxis, PlotPoint, PlotRole, Polyline, ReferenceLine, SharedLegend,
    Sharing, Size,
};
use quell::study::BeltStudy;

/// End of the time axis.
const UNTIL: f64 = 80.0;
/// Samples per dither period.
const SAMPLES_PER_PERIOD: f64 = 40.0;
/// Smallest spectral amplitude shown.
const FLOOR: f64 = 1e-5;

/// One column of the figure.
pub(super) struct ResponseColumn {
    /// Its study.
    pub(super) study: BeltStudy,
    /// D.
    pub(super) amplitude: f64,
    /// The steady response.
    pub(super) response: SteadyResponse,
}

/// The steady responses of the study's amplitudes.
pub(super) fn cases(source: &EntrySource) -> Result<Vec<ResponseColumn>, Failure> {
    let study = source.study()?;
    values(&study, "dither.amplitude")
        .into_iter()
        .map(|amplitude| {
            let study = study.with("dither.amplitude", amplitude)?;
            let start = start(&study)?;
            let plan = ResponsePlan::from(study.solver());
            let response = respond(&study.belt().system(), &start.into(), &plan)
                .map_err(|error| failed(source.name, &error))?;
            Ok(ResponseColumn { study, amplitude, response })
        })
        .collect()
}

pub(super) fn figure(source: &EntrySource) -> Result<Product, Failure> {
    let study = source.study()?;
    let dither = study.belt().dithers()[0].clone();
    let cases = cases(source)?;
    let step = std::f64::consts::TAU / dither.frequency_ratio / SAMPLES_PER_PERIOD;
    let undithered = history(source, &study, &study.belt().undithered(), step)?;
    let mut histories =
        vec![("time".to_owned(), "1/ω0", undithered.iter().map(|s| s.time).collect())];
    histories.extend(columns_of("undithered", &undithered));
    let top = dither.frequency_ratio * 1.25;
    let shown = |response: &SteadyResponse| {
        response.dithered.spectrum.frequencies().take_while(|ω| *ω <= top).count()
    };
    let Some(first) = cases.first().map(|case| &case.response) else {
        return Err(failed(source.name, &"it has no amplitude"));
    };
    let (spectrum, without) = (&first.dithered.spectrum, &first.undithered.spectrum);
    let mut spectra = vec![
        (
            "frequency".to_owned(),
            "ω0",
            spectrum.frequencies().take(shown(first)).collect::<Vec<f64>>(),
        ),
        (
            "undithered_amplitude".to_owned(),
            "length",
            without.amplitudes()[..shown(first)].to_vec(),
        ),
    ];
    let mut rows: [Vec<Panel>; 3] = Default::default();
    for (index, case) in cases.iter().enumerate() {
        let samples = history(source, &case.study, case.study.belt(), step)?;
        let name = letter(index);
        histories.extend(columns_of(&name.to_string(), &samples));
        let amplitudes = &case.response.dithered.spectrum.amplitudes()[..shown(first)];
        spectra.push((format!("{name}_amplitude"), "length", amplitudes.to_vec()));
        let [displacement, velocity] = histories_of(case, name, &samples, &undithered);
        rows[0].push(displacement);
        rows[1].push(velocity);
        rows[2].push(spectrum_panel(case, top));
    }
    let panels = rows.into_iter().flatten().map(|panel| panel.legend(Legend::None));
    let figure = Figure::grid(cases.len(), panels)
        .sharing_y(Sharing::Aligned)
        .legend(SharedLegend::Above)
        .size(Size::Frame(270.0, 165.0));
    let caption = caption(source, &study, &cases[0].response);
    Ok(Product::new(figure, caption, &study)
        .by(&[Task::Simulate, Task::Response])
        .table(DataTable::of_columns("", histories))
        .table(DataTable::of_columns("spectrum", spectra)))
}

/// Frequency of the largest peak in the frequency band in which E is measured.
pub(super) fn fundamental(spectrum: &Spectrum) -> Option<f64> {
    let peaks = spectrum.peaks(1e-3).into_iter().filter(|peak| peak.frequency <= BAND_END);
    peaks.max_by(|a, b| a.amplitude.total_cmp(&b.amplitude)).map(|peak| peak.frequency)
}

/// Displacement and velocity of a run as columns of a table.
pub(super) fn columns_of(name: &str, samples: &[Sample]) -> [(String, &'static str, Vec<f64>); 2] {
    let column = |value: fn(&Sample) -> f64| samples.iter().map(value).collect();
    [
        (format!("{name}_displacement"), "length", column(|s| s.displacement)),
        (format!("{name}_velocity"), "length (velocity/ω0)", column(|s| s.velocity)),
    ]
}

/// Displacement and velocity of a case, together with those without dither.
fn histories_of(
    case: &ResponseColumn,
    name: char,
    samples: &[Sample],
    undithered: &[Sample],
) -> [Panel; 2] {
    let belt = case.study.belt();
    let symbol = if belt.dithers()[0].direction == Direction::Normal { "D_N" } else { "D_T" };
    let residual_vibration = match &case.response.residual_vibration {
        Ok(ratio) => format!(", $E$ = {ratio:.2}"),
        Err(_) => String::new(),
    };
    let title = format!("({name}) ${symbol}$ = {}{residual_vibration}", case.amplitude);
    let pair = |value: fn(&Sample) -> f64| {
        let curve = |role, samples: &[Sample]| {
            Polyline::new(
                role,
                samples.iter().map(|s| PlotPoint::new(s.time, value(s))).collect::<Vec<_>>(),
            )
        };
        [
            curve(PlotRole::Dithered, samples).width(1.0).label("with dither"),
            curve(PlotRole::Undithered, undithered).label("without dither"),
        ]
    };
    let velocity = PlotAxis::new("velocity").symbol("x′").up_to(1.7 * belt.belt_velocity());
    [
        Panel::new(time_axis(), PlotAxis::new("displacement").symbol("x"))
            .title(title)
            .with_all(pair(|s| s.displacement)),
        Panel::new(time_axis(), velocity)
            .with_all(pair(|s| s.velocity))
            .with(ReferenceLine::horizontal(belt.belt_velocity()).label("$v_0$")),
    ]
}

fn time_axis() -> PlotAxis {
    PlotAxis::new("time").symbol("τ").between(0.0, UNTIL)
}

fn spectrum_panel(case: &ResponseColumn, top: f64) -> Panel {
    let SteadyResponse { dithered, undithered, .. } = &case.response;
    let curve = |role, spectrum: &Spectrum| {
        let amplitudes = spectrum.amplitudes().iter().map(|amplitude| amplitude.max(0.1 * FLOOR));
        let points: Vec<PlotPoint> = PlotPoint::zip(spectrum.frequencies(), amplitudes)
            .take_while(|point| point.x <= top)
            .collect();
        Polyline::new(role, points)
    };
    Panel::new(
        PlotAxis::new("frequency").symbol("ω").between(0.0, top),
        PlotAxis::new("amplitude").symbol("|X(ω)|").log().between(FLOOR, 0.5),
    )
    .with(curve(PlotRole::Undithered, &undithered.spectrum))
    .with(curve(PlotRole::Dithered, &dithered.spectrum).width(1.1))
    .with(ReferenceLine::vertical(case.study.belt().dithers()[0].frequency_ratio))
}

/// Samples of the first [`UNTIL`] of a run.
fn history(
    source: &EntrySource,
    study: &BeltStudy,
    belt: &Belt,
    step: f64,
) -> Result<Vec<Sample>, Failure> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a count of samples"
    )]
    let count = (UNTIL / step).floor() as usize + 1;
    let start = start(study)?;
    let mut sampler = Sampler::new(0.0, step, count);
    simulate(belt, start, UNTIL + step, study.solver().tolerance, &mut sampler)
        .map_err(|error| failed(source.name, &error))?;
    Ok(sampler.samples)
}

fn caption(source: &EntrySource, study: &BeltStudy, response: &SteadyResponse) -> String {
    let belt = study.belt();
    let dither = belt.dithers()[0].clone();
    let (direction, symbol) = match dither.direction {
        Direction::Tangential => ("tangential", "R_T"),
        Direction::Normal => ("normal", "R_N"),
    };
    let fundamental = match (belt.friction().kind(), fundamental(&response.undithered.spectrum)) {
        (LawKind::Stribeck, Some(frequency)) => {
            format!(
                " The fundamental frequency without dither, printed as 0.666 $ω_0$, is {frequency:.3} $ω_0$."
            )
        }
        _ => String::new(),
    };
    let shows = format!(
        "Responses from rest with the {} law and {} {direction} dither (solid) and without dither (dashed): \
         displacement, velocity, and spectral amplitude of the steady displacement. $ζ$ = {}, $v_0$ = {}, ${symbol}$ = {}, {}. \
         $E$ is the largest amplitude below {BAND_END} $ω_0$ divided by that without dither (2.27). Spectra: $τ$ < {} \
         discarded, {} slow periods kept, mean removed, Hann window.",
        law_name(belt.friction().kind()),
        waveform_name(dither.waveform),
        belt.damping_ratio(),
        belt.belt_velocity(),
        dither.frequency_ratio,
        parameters(study),
        study.solver().settle,
        study.solver().record_periods,
    );
    let print = format!("The dissertation does not specify its record.{fundamental}");
    source.caption(&shows, &print)
}
