//! `stability`: small motions about steady sliding and averages; eigenvalues or Floquet exponents of a disc.

use std::fmt::Write as _;

use quell_disc::instability::GrowthShares;
use quell_linear::averaging::UnstableBand;
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::Presented;
use super::system::{ListedMotion, motions};
use super::table::{TextTable, figure, figure_in_units, in_hertz, in_rpm};
use crate::complaint::Failure;
use crate::disc_units::in_units_of_study;
use crate::picture;
use crate::plot::Figure;
use crate::run::disc;
use crate::run::disc::stability::DiscStability;
use crate::run::stability::{
    DECIBELS, LOOKED_AT, LimitStability, NoStableAmplitude, OneMassStability, SlidingStability,
    becomes, kind,
};
use crate::study::{DiscSetup, DiscStudy, SystemSetup, SystemStudy};

impl Presented<SystemSetup> for SlidingStability {
    const NAME: &'static str = "stability";
    const TITLED: bool = true;

    fn json(&self, study: &SystemStudy) -> Json {
        self.json(study)
    }

    fn sentence(&self, study: &SystemStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &SystemStudy) -> String {
        table(study, self)
    }

    fn figure(&self, study: &SystemStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::stability(study, self)))
    }
}

impl Presented<DiscSetup> for DiscStability {
    const NAME: &'static str = "stability";

    fn json(&self, study: &DiscStudy) -> Json {
        in_units_of_study(study, self.json(study))
    }

    fn sentence(&self, study: &DiscStudy) -> Option<String> {
        Some(self.sentence(study))
    }

    fn table(&self, study: &DiscStudy) -> String {
        disc_table(study, self)
    }

    fn figure(&self, study: &DiscStudy) -> Option<Result<Figure, Failure>> {
        let last = disc::campbell::usual_end(study);
        let campbell = disc::campbell::run(study, last);
        Some(campbell.map(|found| picture::disc::stability(study, self, &found)))
    }
}

/// Most marginal frictions listed in the table.
const MOST_CHANGES: usize = 6;

fn disc_table(study: &DiscStudy, done: &DiscStability) -> String {
    let mut table = TextTable::default();
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

fn table(study: &SystemStudy, done: &SlidingStability) -> String {
    let upper = done.spectrum.motions.iter().filter(|motion| motion.eigenvalue.im >= 0.0);
    let mut text = motions(study.units(), ListedMotion::Damped, upper);
    let with = |quantity, value| figure_in_units(study.units(), quantity, value);
    for (contact, found) in study.system().contacts.iter().zip(&done.contacts) {
        let _ = write!(
            text,
            "  contact {}: friction {}, normal load {}",
            contact.name,
            with(Quantity::Force, found.friction),
            with(Quantity::Force, found.normal_load)
        );
        if let Some(dithered) = found.dithered {
            let velocity = with(Quantity::Velocity, contact.surface_velocity.mean());
            let slip = with(Quantity::Velocity, dithered.slip_amplitude);
            let _ = write!(text, ", slip amplitude {slip} at the belt velocity {velocity}");
        }
        text.push('\n');
    }
    if let Some(dither) = &done.dither {
        match &dither.critical {
            Err(why) => {
                let _ = writeln!(text, "  critical amplitudes: unknown: {why}");
            }
            Ok(critical) => {
                for found in critical {
                    let _ = writeln!(
                        text,
                        "  {} from the amplitude {} {}on ({}){}",
                        becomes(found.becomes),
                        with(Quantity::Force, found.amplitude),
                        if study.system().inputs.len() > 1 { "of the first dither " } else { "" },
                        kind(found.crossing),
                        if found.contacts_stay_closed { "" } else { ", if contacts stayed closed" }
                    );
                }
            }
        }
    }
    if let Some(one) = &done.one_mass {
        put_one_mass(&mut text, one, &with);
    }
    text
}

/// What is known of one mass alone.
fn put_one_mass(
    text: &mut String,
    one: &OneMassStability,
    with: &impl Fn(Quantity, f64) -> String,
) {
    let _ = writeln!(text, "  criterion 2ζ + Fμ̄′: {}", figure(one.criterion));
    if one.limit.is_some() {
        put_everywhere_stable(text, (one, &one.everywhere_stable), with);
    }
    put_bands(text, &one.unstable_bands, with);
    let Some(limit) = &one.limit else { return };
    let _ = writeln!(text, "\nIn the limit of high dither frequency: {}", limit.verdict());
    put_limit(text, (one, limit), with);
}

fn put_limit(
    text: &mut String,
    (one, limit): (&OneMassStability, &LimitStability),
    with: &impl Fn(Quantity, f64) -> String,
) {
    match &limit.criterion {
        Ok(criterion) => {
            let _ = writeln!(text, "  criterion 2ζ + Fμ̄′: {}", figure(criterion.value));
        }
        Err(why) => {
            let _ = writeln!(text, "  criterion 2ζ + Fμ̄′: unknown: {why}");
        }
    }
    for critical in limit.critical_amplitudes.iter().flatten() {
        let _ = writeln!(
            text,
            "  {} from the amplitude {} on ({}, α = {}){}",
            becomes(critical.becomes),
            with(Quantity::Force, one.amplitude() * critical.amplitude),
            kind(critical.crossing),
            with(Quantity::Velocity, critical.amplitude_ratio),
            if critical.contact_stays_closed { "" } else { ", if the contact stayed closed" }
        );
    }
    put_everywhere_stable(text, (one, &limit.everywhere_stable), with);
    put_bands(text, &limit.unstable_bands, with);
}

/// The amplitude from which every surface velocity is stable.
fn put_everywhere_stable(
    text: &mut String,
    (one, ratio): (&OneMassStability, &Result<f64, NoStableAmplitude>),
    with: &impl Fn(Quantity, f64) -> String,
) {
    let label = "stable at every surface velocity";
    let _ = match ratio {
        Ok(ratio) => {
            let amplitude = with(Quantity::Force, one.amplitude_of_ratio() * ratio);
            let ratio = with(Quantity::Velocity, *ratio);
            writeln!(text, "  {label} from the amplitude {amplitude} on (α = {ratio})")
        }
        Err(why) => writeln!(text, "  {label}: none: {why}"),
    };
}

/// The unstable surface velocities.
fn put_bands<E>(
    text: &mut String,
    bands: &Result<Vec<UnstableBand>, E>,
    with: &impl Fn(Quantity, f64) -> String,
) {
    let Ok(bands) = bands else { return };
    let words = bands.iter().map(|band| {
        let lower = with(Quantity::Velocity, band.lower);
        match band.upper {
            Some(upper) => format!("{lower} to {}", with(Quantity::Velocity, upper)),
            None => format!("above {lower}, no upper end found {LOOKED_AT}"),
        }
    });
    let words: Vec<String> = words.collect();
    let words = if words.is_empty() { "none".to_owned() } else { words.join(", ") };
    let _ = writeln!(text, "  unstable surface velocities: {words}");
}
