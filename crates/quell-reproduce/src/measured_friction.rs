//! Figures 4.5 and 4.6: effective friction measured on responses under normal dither (4.30), (4.31), in two readings.
//!
//! The text says "over one period of the fundamental frequency when the self-excited oscillations have been canceled and the system
//! is in its steady state", and shows only windows without stick. Its trajectories are not specified.
//!
//! * Steady responses: at each slip velocity the belt moves at it, and f/N is averaged over one period of the dither of the response
//!   that continues steady sliding, stick included. This reading has values at all slip velocities, also below the maximum, where
//!   every period sticks.
//! * Free decays from the study's displacements at its belt velocities: means over windows of one dither period without stick, and
//!   their medians in bins of the slip velocity. Windows across which the slow velocity changes by more than 0.02 are excluded,
//!   because averaging assumes that it is constant. Without the windows that stick, little is left below the maximum.
//!
//! Both are compared with the averaging approximation with both terms of (4.23) and with the law itself.

use quell::parallel::Parallel;
use quell_dynamics::response::{
    WindowMean, measured_effective_friction, steady_effective_friction,
};
use quell_dynamics::simulation::Start;
use quell_linear::averaging::{Averaging, FastMotion, effective};
use quell_model::Belt;
use quell_numerics::order::ascending;

use super::axis::values;
use super::caption::{law_name, letter, parameters, waveform_name};
use super::failure::failed;
use super::product::{DataTable, Product};
use super::source::EntrySource;
use quell::cite::Task;
use quell::complaint::Failure;
use quell::plot::{
    Figure, Panel, PlotAxis, PlotPoint, PlotRole, Points, Polyline, SharedLegend, Sharing, Size,
};

/// Duration of a decay.
const DURATION: f64 = 40.0;
/// Window edges per dither period.
const WINDOWS_PER_PERIOD: usize = 8;
/// Width of a bin of the slip velocity.
const BIN: f64 = 0.004;
/// Tolerance of the period over which a steady response is averaged.
pub(super) const TOLERANCE: f64 = 1e-12;
/// Smallest number of windows in a bin that is shown.
const FEWEST: usize = 5;
/// Largest change of the slow slip velocity across a window that counts.
const DRIFT: f64 = 0.02;
/// Largest slip velocity shown.
const TO: f64 = 0.3;
const POINTS: u32 = 300;

/// One panel: the measurements, and the averaging approximation.
pub(super) struct FrictionPanel {
    /// D_N.
    pub(super) amplitude: f64,
    /// The belt with this dither.
    pub(super) belt: Belt,
    /// (v_r, ⟨f/N⟩, fraction of the period in stick) of steady responses; slip velocities without such a response are left out.
    pub(super) steady: Vec<(f64, f64, f64)>,
    /// Windows of the decays with positive slip and without stick.
    windows: Vec<WindowMean>,
    /// (v_r, median of f/N, number of windows) of each bin.
    bins: Vec<(f64, f64, usize)>,
    /// (v_r, μ̄) of the averaging approximation.
    pub(super) averaged: Vec<PlotPoint>,
}

/// Measures the cases of a figure.
pub(super) fn cases(source: &EntrySource) -> Result<Vec<FrictionPanel>, Failure> {
    let study = source.study()?;
    let ratio = study.belt().dithers()[0].frequency_ratio;
    values(&study, "dither.amplitude")
        .into_iter()
        .map(|amplitude| {
            let starts: Vec<Start> = values(&study, "belt.initial.displacement")
                .into_iter()
                .map(|displacement| Start { time: 0.0, displacement, velocity: 0.0 })
                .collect();
            let mut windows = Vec::new();
            for velocity in values(&study, "belt.belt_velocity") {
                let study = study
                    .with("dither.amplitude", amplitude)?
                    .with("belt.belt_velocity", velocity)?;
                let found = measured_effective_friction(
                    study.belt(),
                    ratio,
                    &starts,
                    DURATION,
                    WINDOWS_PER_PERIOD,
                    study.solver().tolerance,
                );
                windows.extend(found.map_err(|error| failed(source.name, &error))?);
            }
            windows.retain(|window| {
                let slow = window.drift.is_some_and(|drift| drift.abs() < DRIFT);
                window.stick_fraction == 0.0
                    && slow
                    && window.slip_velocity > 0.0
                    && window.slip_velocity < TO
            });
            let belt = study.with("dither.amplitude", amplitude)?.belt().clone();
            let steady = grid().in_parallel(|&v| {
                let found = steady_effective_friction(&belt, v, TOLERANCE).ok()?;
                Some((v, found.coefficient, found.stick_fraction))
            });
            let (steady, averaged) = (steady.flatten().collect(), averaged(source.name, &belt)?);
            Ok(FrictionPanel {
                amplitude,
                belt,
                steady,
                bins: medians(&windows),
                windows,
                averaged,
            })
        })
        .collect()
}

pub(super) fn figure(source: &EntrySource) -> Result<Product, Failure> {
    let study = source.study()?;
    let law = study.belt().friction();
    let mut steady = DataTable::new(
        "",
        &[
            ("amplitude", "length (force/k)"),
            ("slip_velocity", "length (velocity/ω0)"),
            ("measured_coefficient", "1"),
            ("stick_fraction", "1"),
            ("averaged_coefficient", "1"),
            ("law_coefficient", "1"),
        ],
    );
    let mut decays = DataTable::new(
        "decays",
        &[
            ("amplitude", "length (force/k)"),
            ("slip_velocity", "length (velocity/ω0)"),
            ("measured_coefficient", "1"),
            ("windows", "1"),
        ],
    );
    let mut panels = Vec::new();
    for (index, case) in cases(source)?.iter().enumerate() {
        for &(v, measured, stick) in &case.steady {
            let averaged = interpolated(&case.averaged, v);
            steady.row(
                [case.amplitude, v, measured, stick, averaged, law.coefficient(v)].map(Into::into),
            );
        }
        for &(v, median, count) in &case.bins {
            decays.row([case.amplitude, v, median, count as f64].map(Into::into));
        }
        let law_curve = (0..=POINTS)
            .map(|k| TO * f64::from(k) / f64::from(POINTS))
            .map(|v| PlotPoint::new(v, law.coefficient(v)));
        let windows = case.windows.iter().map(|w| PlotPoint::new(w.slip_velocity, w.coefficient));
        let means = case.steady.iter().map(|&(v, mean, _)| PlotPoint::new(v, mean));
        let title = format!("({}) $D_N$ = {}", letter(index), case.amplitude);
        panels.push(
            Panel::new(
                PlotAxis::new("mean slip velocity").symbol("⟨v_r⟩").between(0.0, TO),
                PlotAxis::new("friction")
                    .symbol("⟨f/N⟩, \\bar{μ}, μ")
                    .between(0.0, 1.05 * law.static_coefficient()),
            )
            .title(title)
            .with(
                Points::new(PlotRole::Guide, windows)
                    .size(1.2)
                    .label("free decays, windows without stick"),
            )
            .with(
                Polyline::new(PlotRole::Undithered, law_curve)
                    .label(format!("{} law", law_name(law.kind()))),
            )
            .with(
                Points::new(
                    PlotRole::Dithered,
                    case.bins.iter().map(|&(v, median, _)| PlotPoint::new(v, median)),
                )
                .size(2.4)
                .label("free decays, medians"),
            )
            .with(
                Polyline::new(PlotRole::Averaged, case.averaged.iter().copied()).label("averaging"),
            )
            .with(Polyline::new(PlotRole::Exact, means).label("steady responses")),
        );
    }
    let figure = Figure::grid(2, panels)
        .sharing_x(Sharing::All)
        .sharing_y(Sharing::All)
        .legend(SharedLegend::Below)
        .size(Size::Frame(340.0, 220.0));
    let displacements = values(&study, "belt.initial.displacement");
    let shows = format!(
        "Effective friction with the {} law under {} normal dither: means of $f/N$ and of the slip velocity \
         over one dither period (4.30), (4.31). Black: steady responses at belt velocities equal to the slip velocity, stick \
         included, which need not be stable. Dots: free decays from $x_0$ between {} and {} at {} belt velocities, without windows \
         that stick or across which the slow velocity changes by more than {DRIFT}, and medians in bins of {BIN}. Vermillion: \
         averaging with both terms of (4.23). $ζ$ = {}, $R_N$ = {}, {}.",
        law_name(law.kind()),
        waveform_name(study.belt().dithers()[0].waveform.clone()),
        displacements.first().copied().unwrap_or_default(),
        displacements.last().copied().unwrap_or_default(),
        values(&study, "belt.belt_velocity").len(),
        study.belt().damping_ratio(),
        study.belt().dithers()[0].frequency_ratio,
        parameters(&study),
    );
    let print = "The dissertation does not specify the trajectories of its points.";
    let caption = source.caption(&shows, print);
    let product = Product::new(figure, caption, &study);
    Ok(product.by(&[Task::Simulate, Task::Friction]).table(steady).table(decays))
}

/// The slip velocities of the curves.
fn grid() -> Vec<f64> {
    (1..=POINTS).map(|k| TO * f64::from(k) / f64::from(POINTS)).collect()
}

/// μ̄(v) of (4.28) with φ′ of (4.23).
fn averaged(name: &str, belt: &Belt) -> Result<Vec<PlotPoint>, Failure> {
    grid().into_iter().map(|v| Ok(PlotPoint::new(v, averaged_at(name, belt, v)?))).collect()
}

/// The same at one slip velocity.
pub(super) fn averaged_at(name: &str, belt: &Belt, v: f64) -> Result<f64, Failure> {
    let options = Averaging::LimitToSecondOrder;
    let found = FastMotion::of(belt, v, options)
        .and_then(|motion| effective(belt.friction(), &motion, v))
        .map_err(|error| failed(name, &error))?;
    Ok(found.coefficient)
}

fn medians(windows: &[WindowMean]) -> Vec<(f64, f64, usize)> {
    let mut bins: std::collections::BTreeMap<u64, Vec<f64>> = std::collections::BTreeMap::new();
    for window in windows {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 < v_r < TO")]
        let bin = (window.slip_velocity / BIN).floor() as u64;
        bins.entry(bin).or_default().push(window.coefficient);
    }
    bins.into_iter()
        .filter(|(_, values)| values.len() >= FEWEST)
        .map(|(bin, mut values)| {
            ascending(&mut values);
            let half = values.len() / 2;
            let median = if values.len() % 2 == 1 {
                values[half]
            } else {
                0.5 * (values[half - 1] + values[half])
            };
            ((bin as f64 + 0.5) * BIN, median, values.len())
        })
        .collect()
}

/// Linear interpolation between neighbouring points of a curve with ascending x.
pub(super) fn interpolated(curve: &[PlotPoint], x: f64) -> f64 {
    let after = curve.partition_point(|point| point.x < x).clamp(1, curve.len() - 1);
    let (before, after) = (curve[after - 1], curve[after]);
    before.y + (after.y - before.y) * (x - before.x) / (after.x - before.x)
}
