//! Figures 2.4, 2.5, 3.3, 3.4: effective friction μ̄(v_r) = ⟨μ(v_r − αG)⟩ under tangential dither of increasing amplitude.
//!
//! Inside |v_r| < αG_max the jump of the law is smoothed; outside, the curve is raised (Stribeck law) or decreases more steeply
//! (decreasing law). The curves are closed forms of `quell_linear::averaging`. For the decreasing law and a triangle, (3.38a) as
//! printed is drawn too.

use quell_linear::averaging::{FastMotion, FastWave, effective};
use quell_model::{LawKind, Waveform};
use quell_numerics::order::ascending;

use super::axis::values;
use super::caption::{count_of, letter, parameters, short, waveform_name};
use super::failure::failed;
use super::printed_formulas::{self, LawNumbers};
use super::product::{DataTable, Product};
use super::source::EntrySource;
use quell::cite::Task;
use quell::complaint::Failure;
use quell::plot::{
    Figure, Legend, LegendPosition, LineStyle, Panel, PlotAxis, PlotPoint, PlotRole, Polyline,
    ReferenceLine, SharedLegend, Sharing, Size,
};
use quell::study::BeltStudy;

/// Slip velocities shown, in v_m.
const FROM: f64 = -1.0;
const TO: f64 = 2.0;
const POINTS: u32 = 360;

/// Figures 2.4 and 2.5: a sine.
pub(super) fn figure(source: &EntrySource) -> Result<Product, Failure> {
    let study = source.study()?;
    let mut table = empty_table();
    let waveform = study.belt().dithers()[0].waveform.clone();
    let panel = panel(source, &study, &waveform, &mut table)?
        .legend(Legend::Inside(LegendPosition::BottomRight));
    let shows = format!(
        "Effective {} friction under {} tangential dither of {} amplitudes. {}.",
        super::caption::law_name(study.belt().friction().kind()),
        waveform_name(study.belt().dithers()[0].waveform.clone()),
        count_of(values(&study, "dither.amplitude").len()),
        parameters(&study),
    );
    let caption = source.caption(&shows, "");
    Ok(Product::new(Figure::single(panel), caption, &study).by(&[Task::Friction]).table(table))
}

/// Figures 3.3 and 3.4: three waveforms.
pub(super) fn three(source: &EntrySource) -> Result<Product, Failure> {
    let study = source.study()?;
    let mut table = empty_table();
    let mut panels = Vec::new();
    let studies = source.with_waveforms()?;
    for (index, (waveform, study)) in studies.iter().enumerate() {
        let title = format!("({}) {}", letter(index), waveform_name(waveform.clone()));
        panels.push(panel(source, study, waveform, &mut table)?.title(title));
    }
    let law = study.belt().friction().kind();
    let note = match law {
        LawKind::Decreasing => {
            "Dotted in (b): (3.38a) as printed, which has the factor exp(−γ − |$v_r$|/$v_m$) instead of exp(γ − \
             |$v_r$|/$v_m$) before the error functions and is not continuous with (3.38b) at |$v_r$| = π$α$/4."
        }
        _ => "",
    };
    let shows = format!(
        "Effective {} friction under tangential dither of {} waveforms and {} amplitudes. {}.",
        super::caption::law_name(law),
        count_of(studies.len()),
        count_of(values(&study, "dither.amplitude").len()),
        parameters(&study),
    );
    let caption = source.caption(&shows, note);
    let figure = Figure::grid(panels.len().clamp(1, 3), panels)
        .sharing_x(Sharing::All)
        .sharing_y(Sharing::All)
        .legend(SharedLegend::Below)
        .size(Size::Frame(270.0, 250.0));
    let product =
        Product::new(figure, caption, &study).also(studies.iter().map(|(_, study)| study));
    Ok(product.by(&[Task::Friction]).table(table))
}

fn empty_table() -> DataTable {
    DataTable::new(
        "",
        &[
            ("waveform", "1"),
            ("amplitude_ratio_over_reference", "1"),
            ("slip_velocity_over_reference", "1"),
            ("effective_coefficient", "1"),
            ("effective_slope", "1/velocity"),
            ("printed_coefficient", "1"),
        ],
    )
}

fn panel(
    source: &EntrySource,
    study: &BeltStudy,
    waveform: &Waveform,
    table: &mut DataTable,
) -> Result<Panel, Failure> {
    let belt = study.belt();
    let law = belt.friction();
    let vm = law.velocity_scale();
    let static_level = law.static_coefficient();
    let mut panel = Panel::new(
        PlotAxis::new("slip velocity").symbol("v_r/v_m").between(FROM, TO),
        friction_axis(source, law.kind()),
    )
    .with(ReferenceLine::horizontal(0.0));
    let mut printed = Vec::new();
    for (index, amplitude) in values(study, "dither.amplitude").into_iter().enumerate() {
        let alpha = amplitude / belt.dithers()[0].frequency_ratio;
        let corner = alpha * waveform.peak_integral() / vm;
        let motion = FastMotion::single(FastWave::Integral(waveform.clone()), alpha);
        let as_printed = |w: f64| {
            let inside = !source.is_own()
                && law.kind() == LawKind::Decreasing
                && *waveform == Waveform::Triangle
                && w.abs() < corner;
            inside.then(|| {
                printed_formulas::effective_338a(LawNumbers::DISSERTATION, w.abs() * vm, alpha)
                    .copysign(w)
            })
        };
        let mut pieces = vec![Vec::new()];
        for w in grid(corner) {
            if alpha == 0.0 && w == 0.0 {
                // The jump of the law itself.
                let [below, above] =
                    [-static_level, static_level].map(|mu| PlotPoint::new(0.0, mu));
                pieces.last_mut().into_iter().for_each(|piece| piece.push(below));
                pieces.push(vec![above]);
                continue;
            }
            let found =
                effective(law, &motion, w * vm).map_err(|error| failed(source.name, &error))?;
            let point = PlotPoint::new(w, found.coefficient);
            pieces.last_mut().into_iter().for_each(|piece| piece.push(point));
            table.row([
                waveform.name().into(),
                (alpha / vm).into(),
                w.into(),
                found.coefficient.into(),
                Some(found.slope).filter(|slope| slope.is_finite()).into(),
                as_printed(w).into(),
            ]);
        }
        if alpha > 0.0 {
            printed.push(
                grid(corner)
                    .into_iter()
                    .filter_map(|w| Some(PlotPoint::new(w, as_printed(w)?)))
                    .collect::<Vec<_>>(),
            );
        } else {
            let jump = [PlotPoint::new(0.0, -static_level), PlotPoint::new(0.0, static_level)];
            panel = panel.with(Polyline::new(PlotRole::Guide, jump).style(LineStyle::Solid));
        }
        let label = format!("$α$/$v_m$ = {}", short(alpha / vm));
        panel = panel.with(Polyline::pieces(PlotRole::Series(index), pieces).label(label));
    }
    printed.retain(|piece| !piece.is_empty());
    if !printed.is_empty() {
        let line = Polyline::pieces(PlotRole::Printed, printed).style(LineStyle::Dotted).width(1.1);
        panel = panel.with(line.label("as printed (3.38a)"));
    }
    Ok(panel)
}

/// The axis of the dissertation's figures; one that suits other numbers.
fn friction_axis(source: &EntrySource, law: LawKind) -> PlotAxis {
    let axis = PlotAxis::new("effective friction").symbol("\\bar{μ}");
    if source.is_own() {
        return axis;
    }
    axis.between(-0.45, if law == LawKind::Stribeck { 0.75 } else { 0.45 })
}

/// Equal steps, with points clustered on the inner side of the corners ±`corner`, where the slope is infinite.
fn grid(corner: f64) -> Vec<f64> {
    let mut grid: Vec<f64> =
        (0..=POINTS).map(|k| FROM + (TO - FROM) * f64::from(k) / f64::from(POINTS)).collect();
    if corner > 0.0 {
        for k in 1..12 {
            let near = corner * (1.0 - 0.25f64.powi(k));
            grid.extend([near, -near]);
        }
        grid.extend([corner, -corner]);
        grid.retain(|w| (FROM..=TO).contains(w));
    }
    ascending(&mut grid);
    grid.dedup();
    grid
}
