//! Figures 2.2 and 4.2: the Stribeck law (2.7) and the decreasing law (2.8) over the slip velocity.
//!
//! Both are odd. At v_r = 0 friction takes any value between ∓μ_s, drawn as a thin line.

use quell_model::{Friction, LawKind};
use quell_numerics::order::ascending;

use super::caption::{law_name, parameters};
use super::product::{DataTable, Product};
use super::source::EntrySource;
use quell::cite::Task;
use quell::complaint::Failure;
use quell::plot::{
    Figure, Legend, LegendPosition, LineStyle, Panel, PlotAxis, PlotPoint, PlotRole, Polyline,
    ReferenceLine,
};
use quell::study::BeltStudy;

/// Slip velocities shown, in v_m.
const FROM: f64 = -1.0;
const TO: f64 = 2.0;
const POINTS: u32 = 300;

/// Path of the family of laws.
pub(super) const LAWS: &str = "friction.law";

/// Styles of the laws in turn.
const STYLES: [LineStyle; 4] =
    [LineStyle::Solid, LineStyle::Dashed, LineStyle::DashDotted, LineStyle::Dotted];

pub(super) fn figure(source: &EntrySource) -> Result<Product, Failure> {
    let studies = source
        .family(LAWS, &["stribeck", "decreasing"])
        .iter()
        .map(|law| source.changed(&[&format!("{LAWS}={law}")]))
        .collect::<Result<Vec<BeltStudy>, Failure>>()?;
    let laws: Vec<&Friction> = studies.iter().map(|study| study.belt().friction()).collect();
    let columns: Vec<String> =
        laws.iter().map(|law| format!("{}_coefficient", law.kind().name())).collect();
    let columns: Vec<(&str, &'static str)> = std::iter::once("slip_velocity_over_reference")
        .chain(columns.iter().map(String::as_str))
        .map(|name| (name, "1"))
        .collect();
    let mut table = DataTable::new("", &columns);
    for w in grid() {
        let cells = laws.iter().map(|law| signed(law, w));
        table.row(std::iter::once(w).chain(cells).map(Into::into));
    }
    let up = PlotAxis::new("friction coefficient").symbol("μ");
    let mut panel = Panel::new(
        PlotAxis::new("slip velocity").symbol("v_r/v_m").between(FROM, TO),
        if source.is_own() { up } else { up.between(-0.6, 0.6) },
    )
    .legend(Legend::Inside(LegendPosition::BottomRight))
    .with(ReferenceLine::horizontal(0.0));
    panel = levels(panel, laws.iter().map(|law| law.static_coefficient()), "$μ_s$");
    panel = levels(panel, laws.iter().filter_map(|law| minimum(law)), "$μ_m$");
    for (index, law) in laws.iter().enumerate() {
        let static_level = law.static_coefficient();
        let style = STYLES[index % STYLES.len()];
        panel = panel.with(
            Polyline::new(
                PlotRole::Guide,
                [PlotPoint::new(0.0, -static_level), PlotPoint::new(0.0, static_level)],
            )
            .style(LineStyle::Solid),
        );
        let sides = [
            grid()
                .filter(|w| *w < 0.0)
                .chain([-0.0])
                .map(|w| PlotPoint::new(w, signed(law, w)))
                .collect::<Vec<_>>(),
            [0.0]
                .into_iter()
                .chain(grid().filter(|w| *w > 0.0))
                .map(|w| PlotPoint::new(w, signed(law, w)))
                .collect(),
        ];
        let name = format!("{} law", law_name(law.kind()));
        panel =
            panel.with(Polyline::pieces(PlotRole::Series(index), sides).style(style).label(name));
    }
    let number = source.name;
    let [eq1, eq2, place] = if number.starts_with('4') {
        ["4.7", "4.8", "here"]
    } else {
        ["2.7", "2.8", "in the text"]
    };
    let names: Vec<String> = laws
        .iter()
        .map(|law| match law.kind() {
            LawKind::Stribeck => format!("Stribeck law ({eq1})"),
            LawKind::Decreasing => format!("decreasing law ({eq2})"),
            kind => format!("{} law", law_name(kind)),
        })
        .collect();
    let shows = format!(
        "{}; at $v_r$ = 0 friction takes any value between −$μ_s$ and $μ_s$. {}.",
        names.join(" and "),
        parameters(&studies[0]),
    );
    let misprint = format!("The dissertation gives $μ_m$ = 0.2587 {place}, a misprint of 0.2857.");
    let caption = source.caption(&shows, &misprint);
    let product = Product::new(Figure::single(panel), caption, &studies[0]).also(&studies);
    Ok(product.by(&[Task::Friction]).table(table))
}

/// Lines at the different values of a level of the laws.
fn levels(panel: Panel, levels: impl Iterator<Item = f64>, label: &str) -> Panel {
    let mut levels: Vec<f64> = levels.collect();
    ascending(&mut levels);
    levels.dedup();
    levels
        .into_iter()
        .fold(panel, |panel, level| panel.with(ReferenceLine::horizontal(level).label(label)))
}

/// μ_m of the laws that have it.
fn minimum(law: &Friction) -> Option<f64> {
    match law.kind() {
        LawKind::Stribeck | LawKind::Decreasing => law.values().get(1).copied(),
        _ => None,
    }
}

fn grid() -> impl Iterator<Item = f64> {
    (0..=POINTS).map(|k| FROM + (TO - FROM) * f64::from(k) / f64::from(POINTS))
}

/// μ at w = v_r/v_m with the sign of w, also for signed zeros.
fn signed(law: &Friction, w: f64) -> f64 {
    law.coefficient(w.abs() * law.velocity_scale()).copysign(w)
}
