//! The balance of energy of slow motions over their amplitude, by the describing function of averaged friction.

use quell_linear::averaging::DescribedCycle;
use quell_model::units::Quantity;

use super::caption::caption;
use super::ruler::Ruler;
use crate::plot::{
    Figure, Marker, Panel, PlotAxis, PlotPoint, PlotRole, Points, Polyline, ReferenceLine, Region,
};
use crate::run::describing::{DescribedContact, DescribedContacts};
use crate::study::{SystemStudy, UnitSystem};

/// The gain of every contact over the velocity amplitude, and below it the growth rate of slow motions with the limit cycles, where
/// harmonic balance holds.
pub(crate) fn describing(study: &SystemStudy, done: &DescribedContacts) -> Figure {
    let ruler = Ruler::new(study, Quantity::Velocity, [done.largest]);
    let per_velocity = study.units().unit(Quantity::PerVelocity).unwrap_or_default();
    let vertical = PlotAxis::new("gain").symbol("N_1");
    let vertical = match study.units() {
        UnitSystem::None => vertical,
        UnitSystem::Si | UnitSystem::MmTonneSecond => vertical.unit(per_velocity),
    };
    let mut gains = Panel::new(axis(&ruler, done.largest), vertical);
    gains = gains.with(ReferenceLine::horizontal(0.0));
    let curve = |role, contact: &DescribedContact, values| {
        line(&ruler, role, &contact.curve.amplitudes(), values)
    };
    let single = done.contacts.len() == 1;
    for (index, contact) in done.contacts.iter().enumerate() {
        if single && study.system().is_dithered() {
            let bare = curve(PlotRole::Undithered, contact, contact.curve.undithered_gains());
            gains = gains.with(bare.label("without dither"));
        }
        let role = if single { PlotRole::Averaged } else { PlotRole::Series(index) };
        let label =
            if single { "averaged".to_owned() } else { format!("contact {}", contact.name) };
        gains = gains.with(curve(role, contact, contact.curve.gains()).label(label));
    }
    let mut panels = vec![gains];
    if let Ok(balance) = &done.balance {
        let rate = PlotAxis::new("growth rate");
        let rate = match study.units() {
            UnitSystem::None => rate,
            UnitSystem::Si | UnitSystem::MmTonneSecond => rate.unit("1/s"),
        };
        let contact = &done.contacts[balance.contact];
        let growth = Panel::new(axis(&ruler, done.largest), rate)
            .with(Region::across_y(PlotRole::Unstable, 0.0, f64::INFINITY).label("motions grow"))
            .with(ReferenceLine::horizontal(0.0))
            .with(curve(PlotRole::Averaged, contact, balance.growth.clone()));
        panels
            .push(growth.with_all(marks(&ruler, &balance.cycles.iter().map(|found| &found.cycle))));
    }
    Figure::grid(1, panels).title(study.title().unwrap_or_default()).caption(format!(
        "{} {}",
        caption(study),
        done.sentence(study)
    ))
}

fn axis(ruler: &Ruler, largest: f64) -> PlotAxis {
    ruler.axis("slow velocity amplitude", "a").between(0.0, ruler.place(largest))
}

fn line(ruler: &Ruler, role: PlotRole, amplitudes: &[f64], values: Vec<f64>) -> Polyline {
    let places = amplitudes.iter().map(|amplitude| ruler.place(*amplitude));
    Polyline::new(role, PlotPoint::zip(places, values))
}

/// Marks of the limit cycles on the line of no growth.
fn marks<'a>(
    ruler: &Ruler,
    cycles: &(impl Iterator<Item = &'a DescribedCycle> + Clone),
) -> Vec<Points> {
    let kinds = [(true, "stable cycle", Marker::Disc), (false, "unstable cycle", Marker::Circle)];
    let of = |(stable, label, marker): (bool, &'static str, Marker)| {
        let places: Vec<PlotPoint> = cycles
            .clone()
            .filter(|cycle| cycle.stable == stable)
            .map(|cycle| PlotPoint::new(ruler.place(cycle.amplitude), 0.0))
            .collect();
        let points = || Points::new(PlotRole::Exact, places.clone()).marker(marker).size(7.0);
        (!places.is_empty()).then(|| points().label(label))
    };
    kinds.into_iter().filter_map(of).collect()
}
