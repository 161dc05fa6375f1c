//! The friction law and the effective friction over the slip velocity.

use quell_model::units::Quantity;

use super::caption::caption;
use super::ruler::{Ruler, words};
use crate::plot::{Figure, Panel, PlotAxis, PlotRole, Polyline, ReferenceLine};
use crate::run::friction::FrictionCurve;
use crate::study::BeltStudy;

/// The picture of friction over the slip velocity.
pub fn friction(study: &BeltStudy, curve: &FrictionCurve) -> Figure {
    let slip = curve.slip_velocities();
    let ruler = Ruler::of(study, Quantity::Velocity, slip.iter().copied());
    let line = |role, values: Vec<f64>| {
        let mut points: Vec<(f64, f64)> =
            slip.iter().zip(values).map(|(&v, value)| (ruler.place(v), value)).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        // The law is discontinuous at zero slip velocity.
        let (left, right): (Vec<_>, Vec<_>) = points.into_iter().partition(|(v, _)| *v <= 0.0);
        Polyline::pieces(role, [left, right])
    };
    let whole = |role, values: Vec<f64>| {
        let mut points: Vec<(f64, f64)> =
            slip.iter().zip(values).map(|(&v, value)| (ruler.place(v), value)).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Polyline::new(role, points)
    };
    let symbol = if study.scales().is_some() { "V_0" } else { "v_0" };
    let belt_velocity = study.belt().belt_velocity();
    let label = format!("${symbol}$ = {}", words(study, Quantity::Velocity, belt_velocity));
    let mut panel = Panel::new(
        ruler.axis("slip velocity", "v_r"),
        PlotAxis::new("friction coefficient").symbol("μ"),
    )
    .with(ReferenceLine::vertical(ruler.place(belt_velocity)).label(label))
    .with(line(PlotRole::Undithered, curve.coefficients()).label("without dither: $μ$"));
    if !study.belt().dithers().is_empty() {
        panel = panel.with(
            whole(PlotRole::Averaged, curve.effective_coefficients())
                .label("effective: $\\bar{μ}$"),
        );
    }
    if let Some(measured) = curve.measured_coefficients() {
        panel = panel.with(line(PlotRole::Exact, measured).label("steady responses: $⟨f/N⟩$"));
    }
    Figure::single(panel)
        .title(study.title().unwrap_or_default())
        .caption(format!("{}.", caption(study)))
}
