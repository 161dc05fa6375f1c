//! A periodic motion of a system in the plane of the observed displacement, and its multipliers with the unit circle.

use std::f64::consts::TAU;

use quell_dynamics::motion::ContactPhase;
use quell_model::units::Quantity;

use super::caption::caption;
use super::ruler::Ruler;
use crate::complaint::Failure;
use crate::plot::{
    Figure, LineStyle, Marker, Panel, PlotAxis, PlotPoint, PlotRole, Points, Polyline, Size,
};
use crate::run::orbit::{FoundMotion, PeriodicResponse, sentence};
use crate::study::SystemStudy;

/// Number of points of the unit circle.
const CIRCLE: u32 = 180;

/// Width of the lines where a contact sticks or is open.
const WIDE: f64 = 3.5;

/// The picture of the motion that `orbit` found.
///
/// # Errors
/// [`Failure::Failed`] if no periodic motion was found.
pub fn orbit(study: &SystemStudy, done: &PeriodicResponse) -> Result<Figure, Failure> {
    let why = || Failure::Failed { key: "--plot".to_owned(), why: done.sentence(study).into() };
    let found = done.found.as_ref().ok_or_else(why)?;
    Ok(Figure::grid(2, [plane(study, found), multipliers(found)])
        .size(Size::Frame(280.0, 260.0))
        .title(study.title().unwrap_or_default())
        .caption(format!("{} {}", sentence(study, found), caption(study))))
}

/// The plane of the observed displacement and its rate, with stick and separation.
fn plane(study: &SystemStudy, found: &FoundMotion) -> Panel {
    let samples = &found.samples;
    let x = Ruler::new(study, Quantity::Displacement, samples.observed.iter().copied());
    let v = Ruler::new(study, Quantity::Velocity, samples.rate.iter().copied());
    let states = samples.observed.iter().zip(&samples.rate);
    let points: Vec<PlotPoint> =
        states.map(|(a, b)| PlotPoint::new(x.place(*a), v.place(*b))).collect();
    let across = x.axis("observed displacement", "");
    let up = v.axis("observed velocity", "");
    let role = if found.orbit.is_free { PlotRole::Undithered } else { PlotRole::Dithered };
    let whole = Polyline::new(role, points.iter().copied()).style(LineStyle::Solid);
    let mut panel = Panel::new(across, up).with(whole);
    for (series, (label, phase)) in
        [("some contact sticks", ContactPhase::Stick), ("some contact is open", ContactPhase::Open)]
            .into_iter()
            .enumerate()
    {
        let does = |place: usize| {
            samples.contacts.iter().any(|contact| contact.phases.get(place) == Some(&phase))
        };
        let mut pieces: Vec<Vec<PlotPoint>> = Vec::new();
        for (place, point) in points.iter().enumerate() {
            match pieces.last_mut() {
                Some(piece) if does(place) && place > 0 && does(place - 1) => piece.push(*point),
                _ if does(place) => pieces.push(vec![*point]),
                _ => {}
            }
        }
        if !pieces.is_empty() {
            let marked = Polyline::pieces(PlotRole::Series(series + 1), pieces);
            panel = panel.with(marked.width(WIDE).style(LineStyle::Solid).label(label));
        }
    }
    panel
}

/// The multipliers with the unit circle.
fn multipliers(found: &FoundMotion) -> Panel {
    let circle = (0..=CIRCLE).map(|k| {
        let angle = TAU * f64::from(k) / f64::from(CIRCLE);
        PlotPoint::new(libm::cos(angle), libm::sin(angle))
    });
    let reach = 1.1_f64.max(1.1 * found.orbit.radius());
    let axis = |name: &str| PlotAxis::new(name).symbol("λ").between(-reach, reach);
    let places = found.orbit.multipliers.iter().map(|z| PlotPoint::new(z.re, z.im));
    Panel::new(axis("Re"), axis("Im"))
        .with(Polyline::new(PlotRole::Guide, circle))
        .with(Points::new(PlotRole::Exact, places).marker(Marker::Disc).size(7.0))
        .equal_scales()
}
