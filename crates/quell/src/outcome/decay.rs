//! `fit --decay`: what a free decay shows of the structure, the comparison of the laws, and tables for a study.

use std::fmt::Write as _;

use quell_design::decay::{DECAY_PARAMETERS, DecayFit};
use serde_json::{Value as Json, json};

use super::Outcome;
use super::estimates::{
    criteria, explained_in_words, in_words, numbers, parameters, rows, weight_in_words,
};
use super::read_file::{read, read_in_words};
use super::table::figure;
use crate::complaint::Failure;
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::input::Inputs;
use crate::picture;
use crate::plot::Figure;
use crate::run::decay::FreeDecay;
use crate::words::{digits, listed};

impl Outcome for FreeDecay {
    fn inputs(&self) -> Inputs {
        self.record.inputs()
    }

    fn name(&self) -> &'static str {
        "free-decay"
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
        let unit = self.record.unit.unwrap_or("1");
        let best = self.best();
        let dataset = Dataset::of_file(self.record.path(), "fit --decay")
            .fact(format!("law: {}", best.law.name()))
            .with_axis(Array::new(
                "time",
                self.record.time_unit.unwrap_or("1"),
                self.record.times.clone(),
            ))
            .with(Array::new("measured", unit, self.record.values.clone()))
            .with(Array::new("fitted", unit, best.values.clone()))
            .with(Array::new("fitted_deviation", unit, fitted_deviations(best)))
            .with(Array::new("point_residual", unit, self.residuals()));
        vec![("record", dataset)]
    }

    fn figure(&self) -> Option<Result<Figure, Failure>> {
        Some(Ok(picture::decay(self)))
    }
}

/// Standard deviations of the fitted values: unknown where the law does not explain the record.
fn fitted_deviations(best: &DecayFit) -> Vec<f64> {
    let is_known = best.estimates.explain();
    best.deviations.iter().map(|known| if is_known { *known } else { f64::NAN }).collect()
}

fn sentence(done: &FreeDecay) -> String {
    let best = done.best();
    let named = done.named(best);
    let shown: Vec<String> = (0..3)
        .filter(|place| FreeDecay::has(best, *place))
        .map(|place| in_words(&named, place))
        .collect();
    let (law, count, quantity) =
        (best.law.name(), done.record.times.len(), done.record.quantity.name());
    let (residual, shown) = (digits(named.estimates.residual()), listed(&shown));
    let mut text = match explained_in_words(&named) {
        Some(share) if !named.estimates.explain() => format!(
            "The law {law} does not explain the record: the explained share of the variance of {count} samples of the {quantity} is \
             {share}, with a residual standard deviation of {residual}. The values of the least sum of squares have no standard \
             errors: {shown}."
        ),
        Some(share) => format!(
            "The law {law} fits {count} samples of the {quantity} with a residual standard deviation of {residual}, which explains \
             {share} of their variance: {shown}."
        ),
        None => format!(
            "The law {law} fits {count} samples of the {quantity} with a residual standard deviation of {residual}: {shown}."
        ),
    };
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

fn json(done: &FreeDecay) -> Json {
    let best = done.best();
    let unit = done.record.unit.unwrap_or("1");
    let named = done.named(best);
    let mut fields = Fields::new();
    fields.plain("ok", true).plain("sentence", sentence(done)).plain("law", best.law.name());
    fields.nested("parameters", parameters(&named, |place| FreeDecay::has(best, place)));
    numbers(&mut fields, &named, unit);
    fields.plain("converged", best.converged);
    fields.plain("file", done.record.path().display().to_string());
    fields.plain("columns", done.record.columns.to_vec());
    fields.plain("read", read(&done.record.read));
    fields.plain("recorded_quantity", done.record.quantity.name());
    let compared = done.fits.iter().enumerate().map(|(place, fit)| {
        let named = done.named(fit);
        let mut entry = Fields::new();
        entry.plain("law", fit.law.name());
        entry.nested("parameters", parameters(&named, |place| FreeDecay::has(fit, place)));
        criteria(&mut entry, &named, unit);
        let criteria = (best.estimates.aic(), fit.estimates.aic());
        if let (Some(weights), (Ok(least), Ok(aic))) = (&done.weights, criteria) {
            entry.measured("difference", "1", aic - least);
            entry.measured("weight", "1", weights[place]);
        } else {
            let why = "a law passes through every sample, so that its AIC has no lower bound";
            entry.unknown("difference", why).unknown("weight", why);
        }
        entry
    });
    fields.list("comparison", compared.collect::<Vec<_>>());
    fields.plain("not_determinable", done.not_determinable());
    let (belt, uncertainty) = done.fragments();
    fields.plain("tables", json!({ "belt": belt, "uncertainty": uncertainty }));
    fields.plain("warnings", done.warnings());
    fields.finish()
}

fn table(done: &FreeDecay) -> String {
    let best = done.best();
    let named = done.named(best);
    debug_assert_eq!(named.parameters.len(), DECAY_PARAMETERS);
    let mut text = rows(&named, |place| FreeDecay::has(best, place));
    for what in done.not_determinable() {
        let _ = writeln!(text, "  not determinable: {what}");
    }
    if let Some(said) = read_in_words(&done.record.read) {
        let _ = writeln!(text, "  {said}");
    }
    if done.fits.len() > 1 {
        let _ = writeln!(
            text,
            "\n  {:<18}{:>14}{:>14}{:>10}{:>4}",
            "law", "residual", "AIC", "weight", "p"
        );
        for (place, fit) in done.fits.iter().enumerate() {
            let aic = fit.estimates.aic();
            let aic = aic.map_or_else(|_| "unbounded".to_owned(), |aic| format!("{aic:.3}"));
            let weight = done.weights.as_ref().map(|weights| weights[place]);
            let weight =
                weight.map_or_else(|| "unknown".to_owned(), |weight| format!("{weight:.4}"));
            let residual = figure(fit.estimates.residual());
            let _ = writeln!(
                text,
                "  {:<18}{residual:>14}{aic:>14}{weight:>10}{:>4}",
                fit.law.name(),
                fit.estimates.free
            );
        }
    }
    let (belt, uncertainty) = done.fragments();
    let _ = write!(text, "\n{belt}");
    if !uncertainty.is_empty() {
        let _ = write!(text, "\n{uncertainty}");
    }
    text
}
