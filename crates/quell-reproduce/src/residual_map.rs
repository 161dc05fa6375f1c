//! Figures 2.8, 2.9, 3.10, 3.11, 4.9, 4.10: contours of the residual vibration E in the (R, D) plane.
//!
//! The study defines the first panel. Further panels change the belt velocity and the waveform, and scale the range of D with the
//! averaged boundary D = α*R, so that every panel shows the same fraction of it. Two boundaries are overlaid: that of averaging,
//! and that of finite-R averaging, with the oscillator's own response at each R instead of αG (for a sine D = v₀(R² − 1)/R).

use std::sync::atomic::AtomicBool;

use quell_linear::averaging::{Averaging, Becomes};
use quell_model::{Direction, Waveform};

use super::axis::values;
use super::caption::{law_name, letter, parameters, short, waveform_name};
use super::failure::failed;
use super::product::{Cell, DataTable, Product};
use super::source::EntrySource;
use quell::cite::Task;
use quell::complaint::Failure;
use quell::map::{FinishedMap, boundaries, run};
use quell::picture::{self, MapAxis, MapKind};
use quell::plot::{
    Figure, Legend, LineStyle, Panel, PlotAxis, PlotPoint, PlotRole, Polyline, SharedLegend,
    Sharing, Size,
};
use quell::running::Running;
use quell::status::Status;
use quell::study::BeltStudy;
use quell::sweep::{MapQuantity, Plan};

/// Path of the family of belt velocities.
pub(super) const VELOCITIES: &str = "belt.belt_velocity";

/// Belt velocities of figures 2.8 and 2.9.
const FOUR_VELOCITIES: [&str; 4] = ["0.05", "0.1", "0.125", "0.15"];

/// Belt velocities of figures 3.10 and 3.11.
const THREE_VELOCITIES: [&str; 3] = ["0.05", "0.1", "0.15"];

/// The contour that the dissertation compares with averaging.
const FIVE_PER_CENT: f64 = 5.0;

/// The parameters of a panel that differ from the study.
struct MapPanel {
    belt_velocity: f64,
    waveform: Waveform,
}

/// Figures 2.8 and 2.9: four belt velocities.
pub(super) fn velocities(source: &EntrySource) -> Result<Product, Failure> {
    let waveform = source.study()?.belt().dithers()[0].waveform.clone();
    let cases: Vec<MapPanel> = belt_velocities(source, &FOUR_VELOCITIES)?
        .into_iter()
        .map(|belt_velocity| MapPanel { belt_velocity, waveform: waveform.clone() })
        .collect();
    figure(source, &cases, cases.len().min(2))
}

/// The belt velocities of the panels, in the unit of the study.
fn belt_velocities(source: &EntrySource, printed: &[&str]) -> Result<Vec<f64>, Failure> {
    let of = |value: &String| -> Result<f64, Failure> {
        let study = source.changed(&[&format!("{VELOCITIES}={value}")])?;
        Ok(study.belt().belt_velocity())
    };
    source.family(VELOCITIES, printed).iter().map(of).collect()
}

/// Figures 3.10 and 3.11: three waveforms from top to bottom, three belt velocities.
pub(super) fn waveforms(source: &EntrySource) -> Result<Product, Failure> {
    let velocities = belt_velocities(source, &THREE_VELOCITIES)?;
    let cases: Vec<MapPanel> = source
        .with_waveforms()?
        .iter()
        .flat_map(|(waveform, _)| {
            velocities
                .iter()
                .map(|&belt_velocity| MapPanel { belt_velocity, waveform: waveform.clone() })
        })
        .collect();
    figure(source, &cases, velocities.len().max(1))
}

/// Figures 4.9 and 4.10: one panel.
pub(super) fn single(source: &EntrySource) -> Result<Product, Failure> {
    let belt = source.study()?.belt().clone();
    let (belt_velocity, waveform) = (belt.belt_velocity(), belt.dithers()[0].waveform.clone());
    figure(source, &[MapPanel { belt_velocity, waveform }], 1)
}

fn figure(source: &EntrySource, cases: &[MapPanel], columns: usize) -> Result<Product, Failure> {
    let first = source.study()?;
    let mut data = DataTable::new(
        "",
        &[
            ("panel", "1"),
            ("waveform", "1"),
            ("belt_velocity", "length (velocity/ω0)"),
            ("frequency_ratio", "1"),
            ("amplitude", "length (force/k)"),
            ("residual_vibration", "1"),
            ("status", "1"),
        ],
    );
    let mut edges = DataTable::new(
        "boundary",
        &[
            ("panel", "1"),
            ("curve", "1"),
            ("frequency_ratio", "1"),
            ("amplitude", "length (force/k)"),
        ],
    );
    let (mut panels, mut studies) = (Vec::new(), Vec::new());
    for (index, case) in cases.iter().enumerate() {
        let study = study_of(source, &first, case)?;
        let done = residual_vibration(source, &study)?;
        let name = letter(index).to_string();
        record(&mut data, &name, case, &done);
        let lines = boundary(&done, &name, &mut edges);
        let title = match (columns, cases.len() > 4) {
            (1, _) => None,
            (_, false) => Some(format!("({name}) $v_0$ = {}", case.belt_velocity)),
            (_, true) => Some(format!(
                "({name}) {}, $v_0$ = {}",
                waveform_name(case.waveform.clone()),
                case.belt_velocity
            )),
        };
        let ends_a_row = index % columns == columns - 1 || index == cases.len() - 1;
        let panel = panel(source, &study, &done, lines, ends_a_row)?;
        panels.push(match title {
            Some(title) => panel.title(title).legend(Legend::None),
            None => panel.legend(Legend::Above),
        });
        studies.push(study);
    }
    let figure = if columns == 1 {
        Figure::grid(1, panels).size(Size::Frame(400.0, 300.0))
    } else {
        // Each panel has its own range of D, which scales with its boundary.
        Figure::grid(columns, panels)
            .sharing_x(Sharing::Aligned)
            .legend(SharedLegend::Below)
            .size(Size::Frame(if columns == 2 { 330.0 } else { 270.0 }, 230.0))
    };
    let product = Product::new(figure, caption(source, &first), &first).also(&studies);
    Ok(product.by(&[Task::Response, Task::Stability]).table(data).table(edges))
}

/// The study of a panel. Its sweep of D extends beyond the averaged boundary by the same factor as in the first panel.
fn study_of(
    source: &EntrySource,
    first: &BeltStudy,
    case: &MapPanel,
) -> Result<BeltStudy, Failure> {
    let dither = first.belt().dithers()[0].clone();
    let furthest = values(first, "dither.amplitude").last().copied().unwrap_or(1.0);
    let reach = case.belt_velocity / first.belt().belt_velocity()
        * (dither.waveform.peak_integral() / case.waveform.peak_integral());
    let to = furthest * reach;
    let points = values(first, "dither.amplitude").len() as f64;
    let mut changes = vec![
        format!("belt.belt_velocity={}", case.belt_velocity),
        format!("dither.waveform={}", case.waveform.name()),
    ];
    if !source.has_own_axis(1) {
        changes.push(format!("sweep[1].from={}", short(to / points)));
        changes.push(format!("sweep[1].to={}", short(to)));
    }
    // The first panel is the unchanged study, so that `quell map` gives the same result.
    if reach == 1.0 && case.waveform == dither.waveform {
        return Ok(first.clone());
    }
    source.changed(&changes.iter().map(String::as_str).collect::<Vec<_>>())
}

/// E over the study's axes.
fn residual_vibration(source: &EntrySource, study: &BeltStudy) -> Result<FinishedMap, Failure> {
    let quantity = MapQuantity::named("residual-vibration", "reproduce")?;
    let plan = Plan::new(study, &[quantity])?;
    let axes: Vec<&str> = plan.grid().axes().iter().map(|axis| axis.path.as_str()).collect();
    if axes != ["dither.frequency_ratio", "dither.amplitude"] {
        return Err(failed(source.name, &"the axes are not R and D"));
    }
    let never = AtomicBool::new(false);
    run(plan, None, Running { threads: None, stop: &never, progress: &() })
}

fn record(table: &mut DataTable, panel: &str, case: &MapPanel, done: &FinishedMap) {
    let grid = done.plan().grid();
    let entry = &done.plan().sheet().entries()[0];
    for point in 0..grid.len() {
        let values = grid.values_at(point);
        table.row([
            panel.into(),
            case.waveform.name().into(),
            case.belt_velocity.into(),
            values[0].into(),
            values[1].into(),
            done.number(entry, point).into(),
            Cell::from(done.status(entry, point).name()),
        ]);
    }
}

/// The boundary D = α*R by averaging, and that by finite-R averaging.
fn boundary(done: &FinishedMap, panel: &str, table: &mut DataTable) -> Vec<Polyline> {
    let grid = done.plan().grid();
    let furthest = grid.axes()[1].values.last().copied().unwrap_or(1.0);
    let mut lines = Vec::new();
    for boundary in boundaries(grid) {
        let (name, label, role, style) = match boundary.averaging {
            Averaging::Limit | Averaging::LimitToSecondOrder => {
                ("averaging", "averaging, $D$ = $α^*R$", PlotRole::Averaged, LineStyle::DashDotted)
            }
            Averaging::FiniteR => {
                ("finite_r", "finite-$R$ averaging", PlotRole::Averaged, LineStyle::ShortDashed)
            }
        };
        if boundary.becomes != Becomes::Stable {
            continue;
        }
        for &(ratio, amplitude) in &boundary.points {
            table.row([panel.into(), name.into(), ratio.into(), amplitude.into()]);
        }
        // The line ends at the edge of the panel.
        let points = boundary.points.into_iter().filter(|point| point.1 <= 1.2 * furthest);
        let points = points.map(|(x, y)| PlotPoint::new(x, y));
        lines.push(Polyline::new(role, points.collect::<Vec<_>>()).style(style).label(label));
    }
    lines
}

fn panel(
    source: &EntrySource,
    study: &BeltStudy,
    done: &FinishedMap,
    lines: Vec<Polyline>,
    bar: bool,
) -> Result<Panel, Failure> {
    let grid = done.plan().grid();
    let entry = &done.plan().sheet().entries()[0];
    let symbols = match study.belt().dithers()[0].direction {
        Direction::Tangential => ("R_T", "D_T"),
        Direction::Normal => ("R_N", "D_N"),
    };
    let axes = [("frequency ratio", symbols.0), ("dither amplitude", symbols.1)];
    let states: Vec<Status> = (0..grid.len()).map(|point| done.status(entry, point)).collect();
    let mut unknown: Vec<Status> =
        states.iter().copied().filter(|status| !status.has_number()).collect();
    unknown.sort_unstable();
    unknown.dedup();
    let value = |point: usize| {
        done.number(entry, point)
            .ok_or_else(|| unknown.iter().position(|state| *state == states[point]).unwrap_or(0))
    };
    let map = picture::MappedQuantity {
        axes: axes
            .iter()
            .zip(grid.axes())
            .map(|((name, symbol), axis)| MapAxis {
                axis: PlotAxis::new(*name).symbol(*symbol),
                values: axis.values.clone(),
            })
            .collect(),
        quantity: PlotAxis::new("residual vibration").symbol("E"),
        kind: MapKind::ResidualVibration,
        values: (0..grid.len()).map(value).collect(),
        reasons: unknown.iter().map(|status| status.about().to_owned()).collect(),
        zero: None,
        over: lines.into_iter().map(Into::into).collect(),
    };
    picture::map_panel(&map, bar).map_err(|error| failed(source.name, &error))
}

fn caption(source: &EntrySource, study: &BeltStudy) -> String {
    let belt = study.belt();
    let dither = belt.dithers()[0].clone();
    let direction = match dither.direction {
        Direction::Tangential => "tangential",
        Direction::Normal => "normal",
    };
    let closing = match dither.direction {
        Direction::Tangential => "",
        Direction::Normal => {
            " $D_N$ < $F$ keeps the contact closed; the line in the dissertation is $α_N^*$ with $μ$($v_0$)$α_N$ instead of $α$."
        }
    };
    let compared = if source.is_own() {
        String::new()
    } else {
        format!(", which the dissertation compares with $E$ = {FIVE_PER_CENT} %")
    };
    let shows = format!(
        "Residual vibration $E$, the efficiency metric (2.27), under {direction} dither with the {} law, from rest: contours in per \
         cent. Dash-dotted: averaged boundary $D$ = $α^*R${compared}; dashed: \
         finite-$R$ averaging, with the exact fast motion of the oscillator. $ζ$ = {}, {}. Record: $τ$ < {} discarded, {} slow periods, mean removed, Hann \
         window.",
        law_name(belt.friction().kind()),
        belt.damping_ratio(),
        parameters(study),
        study.solver().settle,
        study.solver().record_periods,
    );
    let print = format!(
        "The dissertation specifies neither its record nor the ranges of its axes.{closing}"
    );
    source.caption(&shows, &print)
}
