//! `fit`: parameters of friction laws with standard errors, their comparison, and tables for a study.

use std::fmt::Write as _;

use quell_design::fit::{FitFinding, LawFit, diagnose};
use quell_input::measurement::{FrictionScale, SteadyFiles};
use quell_model::parameter::Parameter;
use quell_model::units::Quantity;
use serde_json::{Map, Value as Json, json};

use super::Outcome;
use super::estimates::weight_in_words;
use super::read_file::{read, read_in_words};
use super::table::figure;
use crate::complaint::Failure;
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::input::Inputs;
use crate::picture;
use crate::plot::Figure;
use crate::run::fit::FrictionFit;
use crate::words::{estimated, listed, more_digits, plural, quantity_at};

/// Number of slip speeds of the curve.
const CURVE: usize = 201;

/// Most lines that a warning lists.
const LISTED: usize = 12;

impl Outcome for FrictionFit {
    fn inputs(&self) -> Inputs {
        self.data.inputs()
    }

    fn name(&self) -> &'static str {
        "friction-fit"
    }

    fn json(&self) -> Json {
        json(self)
    }

    fn sentence(&self) -> Option<String> {
        Some(sentence(self))
    }

    fn table(&self) -> String {
        table(self)
    }

    fn datasets(&self) -> Vec<(&'static str, Dataset)> {
        vec![("curve", curve(self)), ("points", points(self))]
    }

    fn figure(&self) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::fit(self)))
    }
}

/// Unit of slip velocities.
fn velocity_unit(fit: &FrictionFit) -> &'static str {
    fit.data.velocity_unit().unwrap_or_else(|| Quantity::Velocity.scaled_unit())
}

/// Unit of friction.
fn friction_unit(fit: &FrictionFit) -> &'static str {
    match fit.data.scale() {
        FrictionScale::Coefficient => "1",
        FrictionScale::Force(unit) => unit.unwrap_or_else(|| Quantity::Force.scaled_unit()),
    }
}

/// Unit of a parameter of a law.
fn unit(fit: &FrictionFit, parameter: &Parameter) -> String {
    match parameter.quantity {
        Quantity::Velocity => velocity_unit(fit).to_owned(),
        Quantity::PerVelocity => match (fit.data.velocity_unit(), fit.force_unit()) {
            (Some("m/s"), None) => "s/m".to_owned(),
            (Some("rad/s"), None) => "s/rad".to_owned(),
            (Some("m/s"), Some(force)) => format!("{force}·s/m"),
            (Some(_), Some(force)) => format!("{force}·s/rad"),
            _ => Quantity::PerVelocity.scaled_unit().to_owned(),
        },
        Quantity::Ratio if parameter.key().ends_with("coefficient") => {
            friction_unit(fit).to_owned()
        }
        quantity => quantity.scaled_unit().to_owned(),
    }
}

/// The square of a unit.
fn squared(unit: &str) -> String {
    match unit {
        "1" => "1".to_owned(),
        "Nm" => "N²m²".to_owned(),
        unit => format!("{unit}²"),
    }
}

/// A unit after a number; nothing for pure numbers and for numbers in the unit of a file that does not give it.
fn after_number(unit: &str) -> String {
    let known = quell_model::units::measure::is_unit(unit);
    if known && unit != "1" { format!(" {unit}") } else { String::new() }
}

fn speed(fit: &FrictionFit, value: f64) -> String {
    more_digits(value) + &after_number(velocity_unit(fit))
}

/// A parameter in words: without a normal load levels are forces or torques.
fn parameter_in_words(done: &FrictionFit, key: &str) -> String {
    let words = quantity_at(key);
    match done.friction_is() {
        "coefficient" => words,
        force => words.replace("coefficient", &format!("friction {force}")),
    }
}

/// What a friction that is no coefficient is.
fn without_load(done: &FrictionFit) -> Option<String> {
    let force = done.friction_is();
    (force != "coefficient").then(|| {
        format!(
            "No normal load was measured: friction is a {force}{}.",
            match done.force_unit() {
                Some(unit) => format!(" in {unit}"),
                None => " in the unit of the file".to_owned(),
            }
        )
    })
}

fn sentence(done: &FrictionFit) -> String {
    let best = done.best();
    let values: Vec<String> = best
        .parameters
        .iter()
        .filter(|fitted| fitted.is_free())
        .map(|fitted| {
            let value = estimated(fitted.value, fitted.standard_error.ok());
            let unit = after_number(&unit(done, &fitted.parameter));
            format!("{} {value}{unit}", parameter_in_words(done, fitted.parameter.key()))
        })
        .collect();
    let mut text = format!(
        "The law {} fits {} point{} with a residual standard deviation of {}: {}.",
        best.name(),
        done.points.len(),
        plural(done.points.len()),
        quell_model::digits::digits(best.residual(), 3) + &after_number(friction_unit(done)),
        listed(&values)
    );
    if let (Some(weights), true) = (&done.weights, done.fits.len() > 1) {
        let _ = write!(
            text,
            " Of {} laws it has the least AIC, with an Akaike weight of {}.",
            done.fits.len(),
            weight_in_words(weights[0])
        );
    }
    text
}

/// The parameters as an object; reasons for missing standard errors are recorded under `prefix`.
fn parameters(done: &FrictionFit, fit: &LawFit) -> Fields {
    let mut inner = Fields::new();
    for fitted in &fit.parameters {
        let key = fitted.parameter.key();
        let error = fitted.standard_error;
        let mut object = Map::new();
        object.insert("value".to_owned(), fitted.value.into());
        object.insert("standard_error".to_owned(), error.ok().into());
        object.insert("fixed".to_owned(), (!fitted.is_free()).into());
        inner.measured(key, &unit(done, &fitted.parameter), object);
        if let Err(why) = error {
            inner.why(&format!("{key}.standard_error"), why);
        }
    }
    inner
}

/// What every fit has: parameters, residual, AIC.
fn numbers(fields: &mut Fields, done: &FrictionFit, fit: &LawFit) {
    fields
        .plain("law", fit.name())
        .nested("parameters", parameters(done, fit))
        .measured("residual", friction_unit(done), fit.residual())
        .measured("rss", &squared(friction_unit(done)), fit.rss)
        .plain("p", fit.free);
    match fit.aic() {
        Ok(aic) => fields.measured("aic", "1", aic),
        Err(why) => fields.unknown("aic", why),
    };
}

fn json(done: &FrictionFit) -> Json {
    let best = done.best();
    let mut fields = Fields::new();
    fields.plain("ok", true);
    fields.plain("sentence", sentence(done));
    numbers(&mut fields, done, best);
    let covariance = &best.covariance;
    let order: Vec<&str> = covariance.order.iter().map(Parameter::key).collect();
    fields.plain("covariance", json!({ "order": order, "matrix": covariance.matrix }));
    match covariance.condition {
        Some(condition) => fields.measured("condition", "1", condition),
        None => fields.unknown("condition", "the information matrix is singular"),
    };
    fields.plain("n", best.points);
    fields.plain("confidence", crate::run::fit::CONFIDENCE);
    fields.measured("quantile", "1", done.quantile(best));
    fields.plain("file", done.data.path().display().to_string());
    fields.plain("columns", done.data.columns().to_vec());
    fields.plain("read", read(done.data.dialect()));
    fields.plain("friction_is", done.friction_is());
    if let Some(folder) = done.data.folder() {
        fields.plain("files", files(folder));
    }
    fields.plain("weighted", done.data.is_weighted());
    fields.plain("sign", done.sign.name());
    fields.plain("at_rest", done.at_rest.clone());
    fields.plain("not_determinable", FrictionFit::not_in_steady_sliding(best));
    let compared: Vec<Fields> = done
        .fits
        .iter()
        .enumerate()
        .map(|(place, fit)| {
            let mut entry = Fields::new();
            numbers(&mut entry, done, fit);
            if let (Some(weights), Ok(least), Ok(aic)) = (&done.weights, best.aic(), fit.aic()) {
                let weight = weights[place];
                entry.measured("difference", "1", aic - least).measured("weight", "1", weight);
            } else {
                let why = "a law passes through every point, so that its AIC has no lower bound";
                entry.unknown("difference", why).unknown("weight", why);
            }
            entry
        })
        .collect();
    fields.list("comparison", compared);
    let left_out: Vec<Json> =
        done.left_out.iter().map(|(kind, why)| json!({ "law": kind.name(), "why": why })).collect();
    fields.plain("left_out", left_out);
    let (friction, uncertainty) = done.fragments(best);
    fields.plain("study", json!({ "friction": friction, "uncertainty": uncertainty }));
    fields.plain("warnings", warnings(done));
    fields.finish()
}

/// The files of a folder: those that are points, and those that are not.
fn files(folder: &SteadyFiles) -> Json {
    let taken = folder.taken.iter().map(|file| {
        json!({
            "file": file.path.display().to_string(),
            "readings": file.readings,
            "slip_velocity": file.slip_velocity,
            "friction": file.friction,
            "steady": file.is_steady,
        })
    });
    let left_out = folder.left_out.iter().map(
        |file| json!({ "file": file.path.display().to_string(), "left_out": file.why.to_string() }),
    );
    taken.chain(left_out).collect()
}

/// What the measurements cannot determine, with what to do.
fn warnings(done: &FrictionFit) -> Vec<String> {
    let best = done.best();
    let mut warnings: Vec<String> =
        diagnose(best, &done.points).iter().map(|finding| in_words(done, finding)).collect();
    if let Some(folder) = done.data.folder() {
        warnings.extend(of_folder(folder));
    }
    if !done.at_rest.is_empty() {
        warnings.push(format!(
            "{} at slip velocity 0 left out: friction at rest takes any value up to the static level. A measured static \
             coefficient is given by --fix static_coefficient=VALUE",
            lines_of(done, &done.at_rest)
        ));
    }
    warnings
}

/// Why the residuals of a record over time have a pattern.
const OVER_TIME: &str = "The file is a record over time: friction may depend on its past or on backlash of the drive, and laws with a state, such as \
                         LuGre friction, are not fitted to a record";

fn in_words(done: &FrictionFit, finding: &FitFinding) -> String {
    match finding {
        FitFinding::Uncertain { key, value, error } => format!(
            "{key} = {} is not determined: its standard error {} exceeds it. Fix it with --fix {key}=VALUE, or measure where \
             the curve depends on it",
            more_digits(*value),
            quell_model::digits::digits(*error, 2)
        ),
        FitFinding::WithoutError { key, why } => format!(
            "{key} has no standard error: {why}. Choose a law with fewer parameters, or fix it with --fix {key}=VALUE"
        ),
        FitFinding::Exact => {
            "the law passes through every point, which then say nothing about errors: those given are 0. Give points as measured, \
             with their scatter"
                .to_owned()
        }
        FitFinding::Correlated { keys: [first, second], correlation } => format!(
            "{first} and {second} are determined only in combination (correlation {correlation:.4}): fix one of them, or \
             measure over a wider range of slip velocities"
        ),
        FitFinding::IllConditioned { condition } => format!(
            "the information matrix is nearly singular (condition {condition:.1e}): fix a parameter, or measure over a wider \
             range of slip velocities"
        ),
        FitFinding::NothingSlow { slowest, reference, below } => format!(
            "the static level and the slope at rest are extrapolated: the slowest point slips at {}, the reference velocity is \
             {}. Measure below {}, or give a measured level with --fix static_coefficient=VALUE",
            speed(done, *slowest),
            speed(done, *reference),
            speed(done, *below)
        ),
        FitFinding::NothingFast { key, fastest, reference, above } => format!(
            "{key} is extrapolated: the fastest point slips at {}, the reference velocity is {}. Measure above {}",
            speed(done, *fastest),
            speed(done, *reference),
            speed(done, *above)
        ),
        FitFinding::BeyondRange { count, limit } => format!(
            "{count} point{} beyond {}, up to which the law {} holds: choose another law, or leave these points out",
            if *count == 1 { " slips" } else { "s slip" },
            speed(done, *limit),
            done.best().name()
        ),
        FitFinding::Outliers { places, deviation } => {
            let lines: Vec<usize> = places.iter().map(|place| done.lines[*place]).collect();
            let unit = if done.data.is_weighted() { " standard deviations" } else { "" };
            format!(
                "{} deviate{} by more than four robust standard deviations of {}{unit}: check {}, for a least-squares fit is drawn \
                 towards such points",
                lines_of(done, &lines),
                if lines.len() == 1 { "s" } else { "" },
                quell_model::digits::digits(*deviation, 2),
                if lines.len() == 1 { "it" } else { "them" }
            )
        }
        FitFinding::Pattern { runs, expected } => format!(
            "the residuals have {runs} run{} of equal sign over the slip speed where {expected:.1} are expected: the law does \
             not have the shape of the data, and standard errors, where they are given, are too small. {}",
            if *runs == 1 { "" } else { "s" },
            match (done.compares_all(), done.data.has_times()) {
                (true, true) => format!("Every law has been compared. {OVER_TIME}"),
                (true, false) =>
                    "Every law has been compared: check whether friction in the data depends on more than the slip velocity, such as its past, \
                     temperature, or backlash of the drive"
                        .to_owned(),
                (false, true) => format!("{OVER_TIME}. Compare laws of the slip velocity with --law all"),
                (false, false) => "Compare laws with --law all".to_owned(),
            }
        ),
        FitFinding::Directions { difference } => format!(
            "friction differs between the two directions of slip, by {} on average, but laws are equal in both: fit each \
             direction in a {} of its own",
            quell_model::digits::digits(*difference, 2),
            if done.data.folder().is_some() { "folder" } else { "file" }
        ),
    }
}

/// Files of a folder that are left out, or whose speed is not steady.
fn of_folder(folder: &SteadyFiles) -> Vec<String> {
    let left_out = folder.left_out.iter();
    let mut warnings: Vec<String> =
        left_out.map(|file| format!("{} is left out: {}", file.path.display(), file.why)).collect();
    let unsteady: Vec<String> = folder
        .taken
        .iter()
        .filter(|file| !file.is_steady)
        .map(|file| file.path.display().to_string())
        .collect();
    if !unsteady.is_empty() {
        warnings.push(format!(
            "the slip velocity is not steady in {}: its contact may stick and slip, so that the mean friction is not that at the mean speed",
            listed(&unsteady)
        ));
    }
    warnings
}

/// "line 3", "lines 3, 5 and 8"; of a folder the names of files.
fn lines_of(done: &FrictionFit, lines: &[usize]) -> String {
    let word = if done.data.folder().is_some() { "file" } else { "line" };
    let mut names: Vec<String> = lines.iter().take(LISTED).map(ToString::to_string).collect();
    if lines.len() > LISTED {
        names.push(format!("{} more", lines.len() - LISTED));
    }
    format!("{word}{} {}", if lines.len() == 1 { "" } else { "s" }, listed(&names))
}

fn table(done: &FrictionFit) -> String {
    let best = done.best();
    let mut text = String::new();
    let width = best.parameters.iter().map(|one| one.parameter.key().len()).max().unwrap_or(0);
    for fitted in &best.parameters {
        let known = match fitted.standard_error {
            Ok(error) => format!("± {}", figure(error)),
            Err(why) => format!("({why})"),
        };
        let unit = unit(done, &fitted.parameter);
        let unit = if unit == "1" { String::new() } else { format!("  {unit}") };
        let key = fitted.parameter.key();
        let _ = writeln!(text, "  {key:<width$}  {:>12} {known}{unit}", figure(fitted.value));
    }
    for key in FrictionFit::not_in_steady_sliding(best) {
        let _ = writeln!(
            text,
            "  {key:<width$}  not determinable: steady sliding does not depend on it"
        );
    }
    let _ = writeln!(text, "  {}", done.sign.in_words());
    for said in without_load(done).into_iter().chain(read_in_words(done.data.dialect())) {
        let _ = writeln!(text, "  {said}");
    }
    if done.fits.len() > 1 {
        let _ = writeln!(
            text,
            "\n  {:<22}{:>14}{:>14}{:>10}{:>4}",
            "law", "residual", "AIC", "weight", "p"
        );
        for (place, fit) in done.fits.iter().enumerate() {
            let aic = fit.aic().map_or_else(|_| "unbounded".to_owned(), |aic| format!("{aic:.3}"));
            let weight = done.weights.as_ref().map(|weights| weights[place]);
            let weight =
                weight.map_or_else(|| "unknown".to_owned(), |weight| format!("{weight:.4}"));
            let residual = figure(fit.residual());
            let _ = writeln!(
                text,
                "  {:<22}{residual:>14}{aic:>14}{weight:>10}{:>4}",
                fit.name(),
                fit.free
            );
        }
    }
    for (kind, why) in &done.left_out {
        let _ = writeln!(text, "  {} is left out: {why}", kind.name());
    }
    let (friction, uncertainty) = done.fragments(best);
    let _ = write!(text, "\n{friction}");
    if !uncertainty.is_empty() {
        let _ = write!(text, "\n{uncertainty}");
    }
    text
}

/// The fitted curve with its confidence band.
fn curve(done: &FrictionFit) -> Dataset {
    let best = done.best();
    let curve = done.curve(best, CURVE);
    let (velocity, friction) = (velocity_unit(done), friction_unit(done));
    Dataset::of_file(done.data.path(), "fit")
        .fact(format!("law: {}", best.name()))
        .with_axis(Array::new("slip_velocity", velocity, curve.speeds))
        .with(Array::new("coefficient", friction, curve.coefficients))
        .with(Array::new("coefficient_low", friction, curve.low))
        .with(Array::new("coefficient_high", friction, curve.high))
}

/// The points with their residuals.
fn points(done: &FrictionFit) -> Dataset {
    let best = done.best();
    let (velocity, friction) = (velocity_unit(done), friction_unit(done));
    let of =
        |value: fn(&quell_design::fit::FitPoint) -> f64| done.points.iter().map(value).collect();
    Dataset::of_file(done.data.path(), "fit")
        .fact(format!("law: {}", best.name()))
        .with_axis(Array::new("line", "1", done.lines.iter().map(|line| *line as f64).collect()))
        .with(Array::new("point_velocity", velocity, of(|point| point.slip_velocity)))
        .with(Array::new("point_coefficient", friction, of(|point| point.coefficient)))
        .with(Array::new("point_deviation", friction, of(|point| point.standard_deviation)))
        .with(Array::new("point_residual", friction, best.residuals.clone()))
}
