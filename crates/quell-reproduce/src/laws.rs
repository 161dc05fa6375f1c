//! Figures 2.2 and 4.2: the Stribeck law (2.7) and the decreasing law (2.8) over the slip velocity.
//!
//! Both are odd. At v_r = 0 friction takes any value between ∓μ_s, drawn as a thin line.

use quell_model::Friction;

use super::caption::{law_name, parameters};
use super::product::{DataTable, Product};
use super::source::EntrySource;
use quell::cite::Task;
use quell::complaint::Failure;
use quell::plot::{
    Figure, Legend, LegendPosition, LineStyle, Panel, PlotAxis, PlotRole, Polyline, ReferenceLine,
};

/// Slip velocities shown, in v_m.
const FROM: f64 = -1.0;
const TO: f64 = 2.0;
const POINTS: u32 = 300;

pub(super) fn figure(source: &EntrySource) -> Result<Product, Failure> {
    let studies = [source.study()?, source.changed(&["friction.law=decreasing"])?];
    let mut table = DataTable::new(
        "",
        &[
            ("slip_velocity_over_reference", "1"),
            ("stribeck_coefficient", "1"),
            ("decreasing_coefficient", "1"),
        ],
    );
    let laws: Vec<&Friction> = studies.iter().map(|study| study.belt().friction()).collect();
    let (static_level, minimum) = (laws[0].static_coefficient(), laws[0].values()[1]);
    for w in grid() {
        let cells = laws.iter().map(|law| signed(law, w));
        table.row(std::iter::once(w).chain(cells).map(Into::into));
    }
    let mut panel = Panel::new(
        PlotAxis::new("slip velocity").symbol("v_r/v_m").between(FROM, TO),
        PlotAxis::new("friction coefficient").symbol("μ").between(-0.6, 0.6),
    )
    .legend(Legend::Inside(LegendPosition::BottomRight))
    .with(ReferenceLine::horizontal(0.0))
    .with(ReferenceLine::horizontal(static_level).label("$μ_s$"))
    .with(ReferenceLine::horizontal(minimum).label("$μ_m$"))
    .with(
        Polyline::new(PlotRole::Guide, [(0.0, -static_level), (0.0, static_level)])
            .style(LineStyle::Solid),
    );
    for (law, style, index) in [(laws[0], LineStyle::Solid, 0), (laws[1], LineStyle::Dashed, 1)] {
        let sides = [
            grid()
                .filter(|w| *w < 0.0)
                .chain([-0.0])
                .map(|w| (w, signed(law, w)))
                .collect::<Vec<_>>(),
            [0.0]
                .into_iter()
                .chain(grid().filter(|w| *w > 0.0))
                .map(|w| (w, signed(law, w)))
                .collect(),
        ];
        let name = format!("{} law", law_name(law.kind()));
        panel =
            panel.with(Polyline::pieces(PlotRole::Series(index), sides).style(style).label(name));
    }
    let number = source.name;
    let caption = format!(
        "Figure {number}. Stribeck law ({eq1}) and decreasing law ({eq2}); at $v_r$ = 0 friction takes any value between \
         −$μ_s$ and $μ_s$. {parameters}. The dissertation gives $μ_m$ = 0.2587 {place}, a misprint of 0.2857.",
        eq1 = if number.starts_with('4') { "4.7" } else { "2.7" },
        eq2 = if number.starts_with('4') { "4.8" } else { "2.8" },
        place = if number.starts_with('4') { "here" } else { "in the text" },
        parameters = parameters(&studies[0]),
    );
    let product = Product::new(Figure::single(panel), caption, &studies[0]).also(&studies);
    Ok(product.by(&[Task::Friction]).table(table))
}

fn grid() -> impl Iterator<Item = f64> {
    (0..=POINTS).map(|k| FROM + (TO - FROM) * f64::from(k) / f64::from(POINTS))
}

/// μ at w = v_r/v_m with the sign of w, also for signed zeros.
fn signed(law: &Friction, w: f64) -> f64 {
    law.coefficient(w.abs() * law.velocity_scale()).copysign(w)
}
