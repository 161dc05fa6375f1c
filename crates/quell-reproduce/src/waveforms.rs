//! Figure 3.2: two cycles of the waveforms g and their zero-mean integrals G.

use std::f64::consts::TAU;

use quell_model::Waveform;

use super::caption::{letter, short, waveform_name};
use super::product::{DataTable, Product};
use super::source::EntrySource;
use quell::cite::Task;
use quell::complaint::Failure;
use quell::plot::{
    Figure, Legend, Panel, PlotAxis, PlotPoint, PlotRole, Polyline, ReferenceLine, Sharing,
};

const CYCLES: u32 = 2;
const POINTS_PER_CYCLE: u32 = 240;

pub(super) fn figure(source: &EntrySource) -> Result<Product, Failure> {
    let study = source.study()?;
    let mut columns = vec![("cycles".to_owned(), "1", cycles().collect::<Vec<f64>>())];
    let mut rows: [Vec<Panel>; 2] = [Vec::new(), Vec::new()];
    let studies = source.with_waveforms()?;
    for (index, (waveform, _)) in studies.iter().enumerate() {
        let name = waveform.name();
        columns.push((
            format!("{name}_g"),
            "1",
            cycles().map(|c| waveform.value(TAU * c)).collect(),
        ));
        columns.push((
            format!("{name}_G"),
            "1",
            cycles().map(|c| waveform.integral(TAU * c)).collect(),
        ));
        let title = format!("({}) {}", letter(index), waveform_name(waveform.clone()));
        rows[0].push(
            axes("waveform", "g", "")
                .title(title)
                .with(Polyline::pieces(PlotRole::Exact, force(waveform)))
                .legend(Legend::None),
        );
        let peak = waveform.peak_integral();
        let label = match waveform {
            Waveform::Sine => "$G_{max}$ = 1".to_owned(),
            Waveform::Triangle => "$G_{max}$ = π/4".to_owned(),
            Waveform::Square => "$G_{max}$ = π/2".to_owned(),
            _ => format!("$G_{{max}}$ = {}", short(peak)),
        };
        rows[1].push(
            axes("integral", "G", "cycles $τ$/2π")
                .with(ReferenceLine::horizontal(peak).label(label))
                .with(Polyline::new(
                    PlotRole::Averaged,
                    cycles().map(|c| PlotPoint::new(c, waveform.integral(TAU * c))),
                ))
                .legend(Legend::None),
        );
    }
    let figure = Figure::grid(studies.len().max(1), rows.into_iter().flatten())
        .sharing_x(Sharing::Aligned)
        .sharing_y(Sharing::Aligned);
    let caption = if source.is_own() {
        source.caption(
            "Two cycles of the dither waveforms $g$ and their zero-mean integrals $G$.",
            "",
        )
    } else {
        source.caption(
            "Two cycles of the dither waveforms $g$ (3.4)–(3.6), odd and of unit amplitude, and their zero-mean integrals $G$, which \
             are even (the text after (3.25) calls them odd).",
            "",
        )
    };
    let product = Product::new(figure, caption, &study)
        .also(studies.iter().map(|(_, study)| study))
        .by(&[Task::Friction]);
    Ok(product.table(DataTable::of_columns("", columns)))
}

fn axes(name: &str, symbol: &str, below: &str) -> Panel {
    Panel::new(
        PlotAxis::new(below).between(0.0, f64::from(CYCLES)).ticks([0.0, 0.5, 1.0, 1.5, 2.0]),
        PlotAxis::new(name)
            .symbol(symbol)
            .between(-2.0, 2.0)
            .ticks([-1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5]),
    )
    .with(ReferenceLine::horizontal(0.0))
}

fn cycles() -> impl Iterator<Item = f64> {
    (0..=CYCLES * POINTS_PER_CYCLE).map(|k| f64::from(k) / f64::from(POINTS_PER_CYCLE))
}

/// g, with vertical segments where it jumps.
fn force(waveform: &Waveform) -> Vec<Vec<PlotPoint>> {
    if *waveform == Waveform::Square {
        let corners = (0..2 * CYCLES).flat_map(|half| {
            let level = if half % 2 == 0 { 1.0 } else { -1.0 };
            [
                PlotPoint::new(0.5 * f64::from(half), level),
                PlotPoint::new(0.5 * f64::from(half + 1), level),
            ]
        });
        return vec![std::iter::once(PlotPoint::new(0.0, 0.0)).chain(corners).collect()];
    }
    vec![cycles().map(|c| PlotPoint::new(c, waveform.value(TAU * c))).collect()]
}
