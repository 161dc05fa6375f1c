//! Figure 5.6: meaning of the real part of an exponent, for one degree of freedom.
//!
//! x = e^{ρτ} cos τ with Re ρ = 0.03, 0, −0.03; the dissertation gives no numbers.

use super::super::caption::letter;
use super::super::product::{DataTable, Product};
use super::super::source::EntrySource;
use super::study;
use quell::complaint::Failure;
use quell::plot::{
    Figure, Legend, LineStyle, Panel, PlotAxis, PlotPoint, PlotRole, Polyline, Sharing, Size,
};

/// Re ρ of the three panels.
const RATES: [f64; 3] = [0.03, 0.0, -0.03];
/// End of the time axis.
const END: f64 = 60.0;
/// Points of a curve.
const POINTS: u32 = 900;

/// Figure 5.6.
pub(crate) fn figure(source: &EntrySource) -> Result<Product, Failure> {
    let study = study(source, &[])?;
    let columns = [("panel", "1"), ("growth_rate", "1"), ("time", "1"), ("displacement", "1")];
    let mut table = DataTable::new("", &columns);
    let mut panels = Vec::new();
    for (index, rate) in RATES.into_iter().enumerate() {
        let times: Vec<f64> =
            (0..=POINTS).map(|k| END * f64::from(k) / f64::from(POINTS)).collect();
        let value = |time: f64| libm::exp(rate * time) * libm::cos(time);
        let name = letter(index).to_string();
        for &time in &times {
            table.row([name.as_str().into(), rate.into(), time.into(), value(time).into()]);
        }
        let envelope =
            |sign: f64| times.iter().map(move |t| PlotPoint::new(*t, sign * libm::exp(rate * t)));
        let role = [PlotRole::Unstable, PlotRole::Undecided, PlotRole::Stable][index];
        let sign = ["> 0", "= 0", "< 0"][index];
        let panel = Panel::new(
            PlotAxis::new("time").symbol("τ").between(0.0, END),
            PlotAxis::new("displacement").symbol("x"),
        )
        .with(
            Polyline::pieces(PlotRole::Guide, [envelope(1.0), envelope(-1.0)])
                .style(LineStyle::Dashed),
        )
        .with(Polyline::new(role, times.iter().map(|time| PlotPoint::new(*time, value(*time)))));
        panels.push(panel.title(format!("({name}) Re $ρ$ {sign}")).legend(Legend::None));
    }
    let figure = Figure::grid(3, panels).sharing_x(Sharing::All).size(Size::Frame(250.0, 180.0));
    let caption = source.caption(
        "Responses of one degree of freedom, $x$ = $e^{ρτ}$ cos $τ$ with Re $ρ$ = 0.03, 0, −0.03, and their envelopes.",
        "The dissertation gives no numbers.",
    );
    Ok(Product::about(figure, caption, &study).by(&[]).table(table))
}
