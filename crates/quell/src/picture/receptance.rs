//! Magnitude and phase of receptances over frequency.

use super::caption::caption;
use super::system::frequency_axis;
use crate::plot::{Figure, Panel, PlotAxis, PlotPoint, PlotRole, Polyline, Sharing};
use crate::run::system::receptance::{ContactsAre, Receptances, unit};
use crate::study::SystemStudy;

/// Most receptances in a picture: more curves cannot be kept apart.
const MOST_CURVES: usize = 6;

/// The picture of the first receptances.
pub(crate) fn receptances(study: &SystemStudy, done: &Receptances) -> Figure {
    let (frequency, factor) = frequency_axis(study, "ω");
    let magnitude = match unit(study) {
        Some(unit) => PlotAxis::new("receptance").unit(unit),
        None => PlotAxis::new("receptance"),
    };
    let phase = PlotAxis::new("phase").unit("degrees").between(-180.0, 180.0);
    let phase = phase.ticks(vec![-180.0, -90.0, 0.0, 90.0, 180.0]);
    let mut upper = Panel::new(frequency.clone(), magnitude.log());
    let mut lower = Panel::new(frequency, phase);
    for (place, pair) in done.pairs.iter().take(MOST_CURVES).enumerate() {
        let values = done.frequencies.iter().zip(&pair.values);
        let known: Vec<_> = values.filter_map(|(w, value)| Some((factor * w, (*value)?))).collect();
        let sizes =
            known.iter().map(|(w, value)| PlotPoint::new(*w, libm::hypot(value.re, value.im)));
        let sizes: Vec<PlotPoint> = sizes.filter(|point| point.y > 0.0).collect();
        let angle = |value: num_complex::Complex64| libm::atan2(value.im, value.re).to_degrees();
        let angles = known.iter().map(|(w, value)| PlotPoint::new(*w, angle(*value)));
        let role = PlotRole::Series(place);
        upper = upper.with(Polyline::new(role, sizes).label(done.name_of(pair)));
        lower = lower.with(Polyline::pieces(role, unwrapped(angles.collect())));
    }
    Figure::grid(1, vec![upper, lower])
        .sharing_x(Sharing::All)
        .title(study.title().unwrap_or_default())
        .caption(words(study, done))
}

/// A curve of angles, interrupted where it passes from −180 to 180 degrees.
fn unwrapped(points: Vec<PlotPoint>) -> Vec<Vec<PlotPoint>> {
    let mut pieces: Vec<Vec<PlotPoint>> = Vec::new();
    for point in points {
        match pieces.last_mut() {
            Some(piece) if piece.last().is_some_and(|last| (last.y - point.y).abs() < 180.0) => {
                piece.push(point);
            }
            _ => pieces.push(vec![point]),
        }
    }
    pieces
}

fn words(study: &SystemStudy, done: &Receptances) -> String {
    let contacts = match done.contacts {
        ContactsAre::Sliding => "about steady sliding, with friction carried along",
        ContactsAre::Springs => "with contacts as springs without friction",
        ContactsAre::Absent => "of the structure without its contacts",
    };
    let left = match done.pairs.len() {
        many if many > MOST_CURVES => format!(" The first {MOST_CURVES} of {many} pairs."),
        _ => String::new(),
    };
    format!("Displacement over force (output/input), {contacts}.{left} {}", caption(study))
}
