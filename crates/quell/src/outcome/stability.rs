//! `stability`: averaged stability of steady sliding; eigenvalues or Floquet exponents of a disc.

use quell_disc::instability::GrowthShares;
use quell_linear::growth::of_criterion;
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::Presented;
use super::disc_units::in_units_of_study;
use super::table::{TextTable, figure, figure_of, in_hertz, in_rpm};
use crate::complaint::Failure;
use crate::picture;
use crate::plot::Figure;
use crate::run::disc;
use crate::run::disc::stability::DiscStability;
use crate::run::stability::{
    AveragedStability, BeltStability, DECIBELS, LOOKED_AT, SlopeSide, becomes, kind,
};
use crate::study::{BeltSetup, BeltStudy, DiscSetup, DiscStudy};

impl Presented<BeltSetup> for BeltStability {
    fn json(&self, study: &BeltStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &BeltStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &BeltStudy) -> String {
        table(study, self)
    }

    fn figure(&self, study: &BeltStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::stability(study, self)))
    }
}

impl Presented<DiscSetup> for DiscStability {
    fn json(&self, study: &DiscStudy) -> Json {
        in_units_of_study(study, self.json(study))
    }

    fn sentence(&self, study: &DiscStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &DiscStudy) -> String {
        table_of_disc(study, self)
    }

    fn figure(&self, study: &DiscStudy) -> Option<Result<Figure, Failure>> {
        let last = disc::campbell::usual_end(study);
        let campbell = disc::campbell::run(study, last);
        Some(campbell.map(|found| picture::disc::stability(study, self, &found)))
    }
}

/// Most marginal frictions listed in the table.
const MOST_CHANGES: usize = 6;

fn table_of_disc(study: &DiscStudy, done: &DiscStability) -> String {
    let mut table = TextTable::new(None);
    table.word("verdict", done.growth.verdict().name());
    let hertz = study.reference_hz();
    let rate = |rate: f64| {
        let per_second = hertz.map(|hertz| std::f64::consts::TAU * hertz * rate);
        let si = per_second
            .map(|rate| format!(" ({} 1/s, {} dB/s)", figure(rate), figure(DECIBELS * rate)));
        format!("{} ω_ref{}", figure(rate), si.unwrap_or_default())
    };
    let frequency =
        |frequency: f64| format!("{} ω_ref{}", figure(frequency), in_hertz(study, &[frequency]));
    if hertz.is_some() {
        table.word("speed Ω", &speed_in_words(study));
    }
    table.word("growth rate", &rate(done.growth.rate));
    table.word("  error at most", &format!("{} ω_ref", figure(done.growth.error)));
    table.word("frequency", &frequency(done.growth.frequency));
    table.word("growth rate without dither", &rate(done.undithered.rate));
    for (index, mode) in done.unstable.iter().enumerate() {
        let origin = done.origins.as_ref().ok().and_then(|origins| origins.get(index));
        let kind = origin
            .and_then(GrowthShares::kind)
            .map(|kind| format!(", {} instability", kind.name()));
        let words = format!(
            "{}, growth rate {}{}",
            frequency(mode.frequency),
            rate(mode.rate),
            kind.unwrap_or_default()
        );
        table.word("unstable mode", &words);
    }
    let newtons = study.scales(0).and_then(|scales| scales.si_per_unit(Quantity::LoadFriction));
    match &done.changes {
        Ok(changes) => {
            for change in changes.iter().take(MOST_CHANGES) {
                let force = newtons.map(|unit| format!(" ({} N)", figure(change.friction * unit)));
                let words = format!(
                    "{}{} at frequency {}",
                    figure(change.friction),
                    force.unwrap_or_default(),
                    frequency(change.frequency)
                );
                table.word("marginal at friction f*", &words);
            }
        }
        Err(why) => table.word("marginal frictions", &format!("unknown: {why}")),
    }
    if let Some(found) = &done.critical.deflection {
        for (load, deflection) in found.deflections.iter().flatten().enumerate() {
            let radius = study.scales(load).and_then(|scales| scales.load_radius_m);
            let metres = radius.map(|radius| format!(" ({} m)", figure(radius * deflection)));
            let words = format!("{} r₀{}", figure(*deflection), metres.unwrap_or_default());
            table.word(&format!("deflection at load {load}"), &words);
        }
    }
    if done.out_of_reach {
        table.word(
            "out of reach",
            "a motion that the load cannot reach is marginal at any friction",
        );
    }
    let without = study.without();
    if !without.is_empty() {
        table.word("without", &without.join(", "));
    }
    table.text()
}

/// The speed of the loads, in rpm and, if the radius of the first load is known, in km/h.
fn speed_in_words(study: &DiscStudy) -> String {
    let speed = study.disc().speed();
    let radius = study.scales(0).and_then(|scales| scales.load_radius_m);
    let along = study.reference_hz().zip(radius).map(|(hertz, radius)| {
        format!(
            ", {} km/h at the load",
            figure(3.6 * std::f64::consts::TAU * hertz * radius * speed)
        )
    });
    format!("{} ω_ref{}{}", figure(speed), in_rpm(study, speed), along.unwrap_or_default())
}

fn table(study: &BeltStudy, done: &BeltStability) -> String {
    let own = averaged(study, &done.averaged);
    let Some(limit) = &done.limit else { return own };
    format!(
        "\nFinite-R averaging, with the oscillator's own response to the dither:\n{own}\n\
         In the limit of high dither frequency:\n{}",
        averaged(study, limit)
    )
}

fn averaged(study: &BeltStudy, found: &AveragedStability) -> String {
    let mut table = TextTable::new(study.scales());
    table.word("verdict", found.verdict());
    let value = found.criterion.as_ref().map(|criterion| criterion.value);
    table.known("criterion 2ζ + Fμ̄′", Quantity::Ratio, value.map_err(ToString::to_string));
    if let Ok(criterion) = &found.criterion {
        table.number("  error", Quantity::Ratio, criterion.error);
        table.rate("growth rate", of_criterion(criterion.value));
        table.number("effective friction μ̄", Quantity::Ratio, criterion.effective.coefficient);
        if criterion.effective.side == SlopeSide::Outer {
            table.word("  one-sided", "the slope applies to slightly faster belts");
        }
    }
    match &found.critical_amplitudes {
        Ok(list) => {
            for critical in list {
                let label = format!("{} from α", becomes(critical.becomes));
                table.number(&label, Quantity::Velocity, critical.amplitude_ratio);
                table.number(
                    &format!("  D, by a {}", kind(critical.crossing)),
                    Quantity::Force,
                    critical.amplitude,
                );
                if !critical.contact_stays_closed {
                    table.word("  contact", "would open");
                }
            }
        }
        Err(why) => table.word("critical amplitudes", &format!("unknown: {why}")),
    }
    let label = "stable at every v₀ from α";
    match &found.everywhere_stable {
        Ok(ratio) => {
            table.number(label, Quantity::Velocity, *ratio);
            let rate = study.belt().dithers().first().map_or(0.0, |dither| dither.frequency_ratio);
            table.number("  D", Quantity::Force, ratio * rate);
        }
        Err(why) => table.word(label, &format!("none: {why}")),
    }
    if let Ok(bands) = &found.unstable_bands {
        let bands: Vec<String> = bands
            .iter()
            .map(|band| {
                let lower = figure_of(study, Quantity::Velocity, band.lower);
                match band.upper {
                    Some(upper) => {
                        format!("{lower} to {}", figure_of(study, Quantity::Velocity, upper))
                    }
                    None => format!("above {lower}, no upper end found {LOOKED_AT}"),
                }
            })
            .collect();
        let bands = if bands.is_empty() { "none".to_owned() } else { bands.join(", ") };
        table.word("unstable belt velocities", &bands);
    }
    table.text()
}
