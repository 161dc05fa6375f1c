//! `quell resonances`: where waves of a disc meet, and which dither frequency keeps speeds clear.

use std::fmt::Write as _;

use clap::{Args, ValueEnum};
use quell::picture;
use quell::run::disc::resonances::{
    Clear, Order, Question, Resonance, Resonances, Verdict, run as resonances,
};
use quell::{DiscStudy, Failure, quantity};

use super::numbers::pair;
use crate::answer::Answer;
use crate::arguments::{Complaints, OutputArguments, PlotArguments, StudyArguments, inputs};
use crate::table::{figure, in_hertz, in_rpm};

/// Finds the speeds at which a disc can squeal, and dither frequencies that keep a range of speeds clear
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    study: StudyArguments,
    /// Range of speeds, in ω_ref or with units such as 0rpm:900rpm [default: 0:1]
    #[arg(long, value_name = "FROM:TO", allow_hyphen_values = true)]
    speeds: Option<String>,
    /// Order of the expansion: second counts friction twice (f of the order of the root of m, c, k)
    #[arg(long, value_name = "ORDER", default_value = "first")]
    order: Expansion,
    /// Range of speeds to keep clear; needs --frequency
    #[arg(long, value_name = "FROM:TO", allow_hyphen_values = true, requires = "frequency")]
    clear: Option<String>,
    /// Range of dither frequencies to choose from, ratios R or with units such as 2kHz:20kHz; needs --clear
    #[arg(long, value_name = "FROM:TO", allow_hyphen_values = true, requires = "clear")]
    frequency: Option<String>,
    #[command(flatten)]
    output: OutputArguments,
    #[command(flatten)]
    plot: PlotArguments,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Expansion {
    First,
    Second,
}

/// Answers.
pub(crate) fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let mut complaints = Complaints::default();
    let study = complaints.take(arguments.study.read_disc());
    let inputs = inputs(study.as_ref(), DiscStudy::inputs);
    let output = complaints.take(arguments.output.prepare(&[], &inputs));
    let plot = complaints.take(arguments.plot.prepare(&inputs));
    let question = question(arguments, study.as_ref(), &mut complaints);
    let ((study, question), (output, plot)) =
        complaints.finish(study.zip(question).zip(output.zip(plot)))?;

    let done = resonances(&study, question)?;
    let mut object = done.json(&study);
    output.write(&[done.dataset(&study)], &mut object)?;
    plot.write(|| picture::disc::resonances(&study, &done), &mut object)?;
    Ok(Answer::new(arguments.study.json, &object, || text(&study, &done)))
}

fn question(
    arguments: &Arguments,
    study: Option<&DiscStudy>,
    complaints: &mut Complaints,
) -> Option<Question> {
    let mut range = |option, text: &Option<String>| {
        let read = |text: &str| quantity::frequency(text, study, option);
        complaints.take(text.as_deref().map(|text| pair(option, text, read)).transpose())
    };
    let speeds = range("--speeds", &arguments.speeds).map(|speeds| speeds.unwrap_or((0.0, 1.0)));
    let clear = range("--clear", &arguments.clear);
    let frequency = range("--frequency", &arguments.frequency);
    let order = match arguments.order {
        Expansion::First => Order::First,
        Expansion::Second => Order::Second,
    };
    complaints.take(Question::new(speeds?, order, clear?, frequency?))
}

/// Growth in ω_ref that is rounding alone: rates are differences of numbers of order 1.
const NO_GROWTH: f64 = 1e-12;

/// What a wave does without the other one of its pair.
fn by_itself(growth: f64) -> String {
    if growth.abs() <= NO_GROWTH {
        "a wave of it is undamped by itself".to_owned()
    } else {
        format!("a wave of it grows by itself with {}", figure(growth))
    }
}

fn text(study: &DiscStudy, done: &Resonances) -> String {
    let mut text = String::new();
    if let Some(title) = study.title() {
        let _ = writeln!(text, "{title}");
    }
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
            let _ = writeln!(text, "  Ω = {speed:<9}{rpm}  {label}: {}", tongue(resonance));
        }
    }
    if let Some(clear) = &done.clear {
        text += &clearance(study, clear);
    }
    text
}

/// What becomes of a meeting.
fn tongue(resonance: &Resonance) -> String {
    match (resonance.tongue.edges(), resonance.tongue.peak_growth()) {
        (Some([from, to]), Some(growth)) => {
            let (from, to, growth) = (figure(from), figure(to), figure(growth));
            format!("tongue {from} to {to}, growth up to {growth}")
        }
        (None, Some(growth)) => by_itself(growth),
        _ if resonance.can_be_unstable() => match resonance.threshold {
            Some(threshold) => format!("a tongue from f* = {}", figure(threshold)),
            None => "no tongue".to_owned(),
        },
        _ => "cannot be unstable".to_owned(),
    }
}

/// What the exact equations say of the best dither frequency.
fn verified(clear: &Clear) -> String {
    match &clear.verified {
        Some(it) if it.growth.verdict() == Verdict::Stable => format!(
            "verified: by the exact equations nothing grows there, the largest rate is {}",
            figure(it.growth.rate)
        ),
        Some(it) if it.growth.verdict() == Verdict::Undecided => format!(
            "not decided by the exact equations: the largest rate {} at Ω = {} is zero within its error {}",
            figure(it.growth.rate),
            figure(it.speed),
            figure(it.growth.error)
        ),
        Some(it) => format!(
            "not clear by the exact equations, the least growth of all: up to {} at Ω = {}",
            figure(it.growth.rate),
            figure(it.speed)
        ),
        None => "not verified: exponents cannot be computed with such numbers".to_owned(),
    }
}

/// Which dither frequencies keep the speeds clear.
fn clearance(study: &DiscStudy, clear: &Clear) -> String {
    let mut text = String::new();
    let (from, to) = (figure(*clear.speeds.start()), figure(*clear.speeds.end()));
    let _ = writeln!(
        text,
        "Dither frequencies R that keep {from} to {to} clear of tongues that dither makes:"
    );
    for [from, to] in &clear.clearance.clear {
        let hertz = in_hertz(study, &[*from, *to]);
        let _ = writeln!(text, "  {} to {}{hertz}", figure(*from), figure(*to));
    }
    match &clear.suggestion {
        None => text.push_str("  none\n"),
        Some((ratio, nearby)) => {
            let hertz = in_hertz(study, &[*ratio]);
            let _ = writeln!(text, "  best away from the others: R = {}{hertz}", figure(*ratio));
            let _ = writeln!(text, "  {}", verified(clear));
            for nearby in nearby.iter().filter(|nearby| nearby.reaches_in) {
                let resonance = &nearby.resonance;
                let growth = match (resonance.tongue.edges(), resonance.tongue.peak_growth()) {
                    (_, None) => String::new(),
                    (Some(_), Some(growth)) => format!(", growth up to {}", figure(growth)),
                    (None, Some(growth)) => format!(", {}", by_itself(growth)),
                };
                let place = figure(resonance.speed) + &in_rpm(study, resonance.speed);
                let _ = writeln!(text, "  left there: Ω = {place}, {}{growth}", resonance.label());
            }
        }
    }
    let words = if clear.clearance.original_suppressed {
        "Tangential dither takes the tongues without dither away at first order."
    } else {
        "Normal dither leaves the tongues without dither as they are."
    };
    let _ = writeln!(text, "{words}");
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_is_no_growth() {
        assert!(by_itself(-3.469447e-18).contains("undamped"));
        assert!(by_itself(1e-3).contains("grows by itself with 0.001"));
    }
}
