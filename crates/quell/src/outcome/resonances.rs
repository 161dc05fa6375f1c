//! `resonances`: the meetings of waves of a disc, and the dither frequencies that keep a range of speeds clear.

use std::fmt::Write as _;

use serde_json::Value as Json;

use super::Presented;
use super::table::{figure, in_hertz, in_rpm};
use crate::complaint::Failure;
use crate::dataset::Dataset;
use crate::disc_units::{dataset_in_units, in_units_of_study};
use crate::picture;
use crate::plot::Figure;
use crate::run::disc::resonances::{
    Clear, Explained, GrowingInterval, Order, Resonance, Resonances, THREE_WAVES, Verdict, named,
};
use crate::study::{DiscSetup, DiscStudy};

impl Presented<DiscSetup> for Resonances {
    const NAME: &'static str = "resonances";
    const TITLED: bool = true;

    fn json(&self, study: &DiscStudy) -> Json {
        in_units_of_study(study, self.json(study))
    }

    fn table(&self, study: &DiscStudy) -> String {
        table(study, self)
    }

    fn datasets(&self, study: &DiscStudy) -> Vec<(&'static str, Dataset)> {
        vec![("resonances", dataset_in_units(study, self.dataset(study)))]
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
            let tongue = tongue(resonance, done.question.order);
            let _ = writeln!(text, "  Ω = {speed:<9}{rpm}  {label}{harmonic}: {tongue}");
        }
    }
    text += &growing(study, done);
    if let Some(clear) = &done.clear {
        text += &clearance(study, clear);
    }
    text
}

/// The speeds in which a motion grows by the exact equations.
fn growing(study: &DiscStudy, done: &Resonances) -> String {
    let friction = study.disc().loads().first().map_or(0.0, |load| load.friction);
    let opening = format!("Exactly, at f* = {}", figure(friction));
    let found = match &done.growing {
        Ok(found) => found,
        Err(why) => return format!("{opening}, unknown: {why}\n"),
    };
    if found.is_empty() {
        let (from, to) = (done.question.speeds.start(), done.question.speeds.end());
        return format!(
            "{opening}, no motion grows at Ω = {} to {}.\n",
            figure(*from),
            figure(*to)
        );
    }
    let mut text = format!("{opening}, a motion grows at:\n");
    for GrowingInterval { speeds, explained } in found {
        let why = match explained {
            Explained::Wave => "a wave on its own".to_owned(),
            Explained::Pair { order, meeting } => {
                format!("{} at {} order", meeting.label(), named(*order))
            }
            Explained::Not { nearest: Some(meeting) } => format!(
                "{THREE_WAVES}; the nearest meeting is at {}, {}",
                figure(meeting.speed),
                meeting.label()
            ),
            Explained::Not { nearest: None } => THREE_WAVES.to_owned(),
        };
        let _ = writeln!(
            text,
            "  Ω = {} to {}{}, growth up to {} at {}: {why}",
            figure(speeds.from),
            figure(speeds.to),
            in_rpm(study, speeds.peak_speed),
            figure(speeds.peak_growth),
            figure(speeds.peak_speed),
        );
    }
    text
}

/// The instability of the pair at a meeting, at the order of the theory.
fn tongue(resonance: &Resonance, order: Order) -> String {
    match (resonance.tongue.edges(), resonance.tongue.peak_growth()) {
        (Some([from, to]), Some(growth)) => {
            let (from, to, growth) = (figure(from), figure(to), figure(growth));
            format!("tongue {from} to {to}, growth up to {growth}")
        }
        (None, Some(growth)) => by_itself(growth),
        _ if resonance.pair_can_be_unstable() => match resonance.threshold {
            Some(threshold) => format!("tongue from f* = {} on", figure(threshold)),
            None => format!("no tongue at this friction at {} order", named(order)),
        },
        _ => format!("no tongue at {} order", named(order)),
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

/// How many of the frequencies tested in an interval are clear by the exact equations, and the runs of neighbours that are.
fn tested(clear: &Clear, interval: usize) -> String {
    let of: Vec<_> = clear.tested.iter().filter(|tested| tested.interval == interval).collect();
    if of.is_empty() {
        return String::new();
    }
    let runs: Vec<String> = of
        .chunk_by(|one, other| one.result.is_clear() == other.result.is_clear())
        .filter(|run| run[0].result.is_clear())
        .map(|run| {
            let [first, last] =
                [run[0], run[run.len() - 1]].map(|tested| figure(tested.result.frequency_ratio));
            if run.len() == 1 { first } else { format!("{first} to {last}") }
        })
        .collect();
    let count = of.iter().filter(|tested| tested.result.is_clear()).count();
    let which = if runs.is_empty() { String::new() } else { format!(": {}", runs.join(", ")) };
    format!("; exactly, {count} of {} tested in it are clear{which}", of.len())
}

/// The dither frequencies that keep the speeds clear.
fn clearance(study: &DiscStudy, clear: &Clear) -> String {
    let mut text = String::new();
    let (from, to) = (figure(*clear.speeds.start()), figure(*clear.speeds.end()));
    let _ = writeln!(
        text,
        "Dither frequencies R that keep Ω = {from} to {to} clear of dither-induced tongues at first order:"
    );
    for (index, [from, to]) in clear.clearance.clear.iter().enumerate() {
        let hertz = in_hertz(study, &[*from, *to]);
        let exact = tested(clear, index);
        let _ = writeln!(text, "  {} to {}{hertz}{exact}", figure(*from), figure(*to));
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
