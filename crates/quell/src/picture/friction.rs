//! The friction law and the effective friction over the slip velocity.

use quell_model::units::Quantity;
use quell_numerics::order::ascending_by;

use super::caption::caption;
use super::ruler::Ruler;
use crate::plot::{
    Figure, Layer, LineStyle, Panel, PlotAxis, PlotPoint, PlotRole, Points, Polyline, ReferenceLine,
};
use crate::run::friction::{ContactCurves, FrictionCurve};
use crate::study::SystemStudy;

/// Number of slip velocities up to which every value has a mark.
const FEW: usize = 40;

/// One panel for each contact.
pub(crate) fn figure(study: &SystemStudy, done: &ContactCurves) -> Figure {
    let dithered = study.system().is_dithered();
    let several = done.contacts.len() > 1;
    let panels = done.contacts.iter().map(|contact| {
        let ruler = Ruler::new(study, Quantity::Velocity, contact.curve.slip_velocities());
        let label = format!("surface: {}", ruler.words(contact.velocity));
        let panel = panel(&contact.curve, &ruler, (contact.velocity, label), dithered);
        if several { panel.title(format!("contact {}", contact.name)) } else { panel }
    });
    Figure::grid(1, panels.collect::<Vec<_>>())
        .title(study.title().unwrap_or_default())
        .caption(caption(study))
}

/// Friction of one contact over the slip velocity.
fn panel(
    curve: &FrictionCurve,
    ruler: &Ruler,
    (velocity, label): (f64, String),
    dithered: bool,
) -> Panel {
    let slip = curve.slip_velocities();
    let points = |values: Vec<f64>| {
        let mut points: Vec<PlotPoint> =
            PlotPoint::zip(slip.iter().map(|&v| ruler.place(v)), values).collect();
        ascending_by(&mut points, |a| a.x);
        points
    };
    let line = |role, values: Vec<f64>| {
        // The law is discontinuous at zero slip velocity.
        let (left, right): (Vec<_>, Vec<_>) =
            points(values).into_iter().partition(|point| point.x <= 0.0);
        Polyline::pieces(role, [left, right])
    };
    let whole = |role, values: Vec<f64>| Polyline::new(role, points(values));
    let mut panel = Panel::new(
        ruler.axis("slip velocity", "v_r"),
        PlotAxis::new("friction coefficient").symbol("μ"),
    )
    .with(ReferenceLine::vertical(ruler.place(velocity)).label(label))
    .with(line(PlotRole::Undithered, curve.coefficients()).label("without dither: $μ$"));
    if dithered {
        panel = panel.with(
            whole(PlotRole::Averaged, curve.effective_coefficients())
                .label("effective: $\\bar{μ}$"),
        );
    }
    if let Some((measured, stable)) = curve.measured_coefficients().zip(curve.measured_stability())
    {
        let of = |unstable: bool| -> Vec<f64> {
            let both = measured.iter().zip(&stable);
            both.map(|(value, stable)| if (*stable == 0.0) == unstable { *value } else { f64::NAN })
                .collect()
        };
        panel = panel.with(line(PlotRole::Exact, of(false)).label("steady responses: $⟨f/N⟩$"));
        let unstable = of(true);
        if unstable.iter().any(|value| !value.is_nan()) {
            let dotted = line(PlotRole::Exact, unstable).style(LineStyle::Dotted);
            panel = panel.with(dotted.label("unstable steady responses"));
        }
    }
    if slip.len() <= FEW {
        // So few values make no curve.
        let marks: Vec<Points> = panel
            .layers
            .iter()
            .filter_map(|layer| match layer {
                Layer::Polyline(line) => {
                    Some(Points::new(line.role, line.pieces.concat()).size(5.0))
                }
                _ => None,
            })
            .collect();
        panel = panel.with_all(marks);
    }
    panel
}
