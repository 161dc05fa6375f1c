//! `resonances`: the meetings of waves of a disc, and the dither frequencies that keep a range of speeds clear.

use std::fmt::Write as _;

use serde_json::Value as Json;

use super::Presented;
use super::table::{figure, in_hertz, in_rpm};
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::picture;
use crate::plot::Figure;
use crate::run::disc::resonances::{Clear, Resonance, Resonances, Verdict};
use crate::study::{DiscSetup, DiscStudy};

impl Presented<DiscSetup> for Resonances {
    const TITLED: bool = true;

    fn json(&self, study: &DiscStudy) -> Json {
        self.json(study)
    }

    fn table(&self, study: &DiscStudy) -> String {
        table(study, self)
    }

    fn datasets(&self, study: &DiscStudy) -> Vec<(&'static str, Dataset)> {
        vec![("resonances", self.dataset(study))]
    }

    fn figure(&self, study: &DiscStudy) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::disc::resonances(study, self)))
    }
}

/// Growth in ω_ref below which a rate is rounding error: rates are differences of numbers of order 1.
const NO_GROWTH: f64 = 1e-12;

/// The growth of a wave on its own, without the other one of its pair.
fn by_itself(growth: f64) -> String {
    if growth.abs() <= NO_GROWTH {
        "one wave is undamped on its own".to_owned()
    } else {
        format!("one wave grows on its own at the rate {}", figure(growth))
    }
}

fn table(study: &DiscStudy, done: &Resonances) -> String {
    let mut text = String::new();
    for (name, list) in
        [("without dither", &done.undithered), ("induced by dither", &done.dithered)]
    {
        let _ = writeln!(text, "Meetings of waves {name}:");
        if list.is_empty() {
            text.push_str("  none\n");
        }
        for resonance in list {
            let (speed, label) = (figure(resonance.speed), resonance.label());
            let rpm = in_rpm(study, resonance.speed);
            let harmonic = match resonance.harmonic.unsigned_abs() {
                0 | 1 => String::new(),
                order => format!(" at harmonic {order}"),
            };
            let tongue = tongue(resonance);
            let _ = writeln!(text, "  Ω = {speed:<9}{rpm}  {label}{harmonic}: {tongue}");
        }
    }
    if let Some(clear) = &done.clear {
        text += &clearance(study, clear);
    }
    text
}

/// The instability at a meeting.
fn tongue(resonance: &Resonance) -> String {
    match (resonance.tongue.edges(), resonance.tongue.peak_growth()) {
        (Some([from, to]), Some(growth)) => {
            let (from, to, growth) = (figure(from), figure(to), figure(growth));
            format!("tongue {from} to {to}, growth up to {growth}")
        }
        (None, Some(growth)) => by_itself(growth),
        _ if resonance.can_be_unstable() => match resonance.threshold {
            Some(threshold) => format!("tongue from f* = {} on", figure(threshold)),
            None => "no tongue".to_owned(),
        },
        _ => "cannot be unstable".to_owned(),
    }
}

/// The result of the exact equations at the suggested dither frequency.
fn verified(clear: &Clear) -> String {
    match &clear.verified {
        Some(found) if found.growth.verdict() == Verdict::Stable => format!(
            "verified: in the exact equations nothing grows there; the largest growth rate is {}",
            figure(found.growth.rate)
        ),
        Some(found) if found.growth.verdict() == Verdict::Undecided => format!(
            "undecided: in the exact equations the largest growth rate, {} at Ω = {}, is zero within its error {}",
            figure(found.growth.rate),
            figure(found.speed),
            figure(found.growth.error)
        ),
        Some(found) => format!(
            "not clear: in the exact equations the growth rate, although the smallest of all, reaches {} at Ω = {}",
            figure(found.growth.rate),
            figure(found.speed)
        ),
        None => "not verified: the Floquet exponents could not be computed".to_owned(),
    }
}

/// The dither frequencies that keep the speeds clear.
fn clearance(study: &DiscStudy, clear: &Clear) -> String {
    let mut text = String::new();
    let (from, to) = (figure(*clear.speeds.start()), figure(*clear.speeds.end()));
    let _ = writeln!(
        text,
        "Dither frequencies R that keep Ω = {from} to {to} clear of dither-induced tongues:"
    );
    for [from, to] in &clear.clearance.clear {
        let hertz = in_hertz(study, &[*from, *to]);
        let _ = writeln!(text, "  {} to {}{hertz}", figure(*from), figure(*to));
    }
    match &clear.suggestion {
        None => text.push_str("  none\n"),
        Some((ratio, nearby)) => {
            let hertz = in_hertz(study, &[*ratio]);
            let _ = writeln!(text, "  suggested: R = {}{hertz}", figure(*ratio));
            let _ = writeln!(text, "  {}", verified(clear));
            for nearby in nearby.iter().filter(|nearby| nearby.reaches_in) {
                let resonance = &nearby.resonance;
                let growth = match (resonance.tongue.edges(), resonance.tongue.peak_growth()) {
                    (_, None) => String::new(),
                    (Some(_), Some(growth)) => format!(", growth up to {}", figure(growth)),
                    (None, Some(growth)) => format!(", {}", by_itself(growth)),
                };
                let place = figure(resonance.speed) + &in_rpm(study, resonance.speed);
                let _ =
                    writeln!(text, "  remaining there: Ω = {place}, {}{growth}", resonance.label());
            }
        }
    }
    let words = if clear.clearance.original_suppressed {
        "Tangential dither removes the tongues without dither at first order."
    } else {
        "Normal dither leaves the tongues without dither unchanged."
    };
    let _ = writeln!(text, "{words}");
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_is_not_growth() {
        assert!(by_itself(-3.469447e-18).contains("undamped"));
        assert!(by_itself(1e-3).contains("grows on its own at the rate 0.001"));
    }
}
