//! The answer of `probability` as a sentence and as JSON.

use quell_design::probability::{SobolEstimate, SobolIndices, quantile};
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

use super::{
    NoIndices, ProbabilityStart, SampledGrowth, SampledKind, VerdictTally, VibrationProbability,
};
use crate::fields::Fields;
use crate::run::stability::FAST;
use crate::words::{plural, quantity_at};

/// Digits of numbers in sentences: more are not known from a sample.
fn digits(value: f64) -> String {
    quell_model::digits::digits(value, 3)
}

/// A share in per cent: next to 100 % with the digits in which it differs from that.
fn per_cent(share: f64) -> String {
    if share > 0.99 && share < 1.0 {
        let rest = quell_model::digits::digits(100.0 * (1.0 - share), 2);
        let decimals = rest.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        return format!("{:.decimals$} %", 100.0 * share);
    }
    format!("{} %", digits(100.0 * share))
}

/// Quantiles of the growth rate in the answer.
pub(crate) const QUANTILES: [(&str, f64); 3] = [("0.05", 0.05), ("0.5", 0.5), ("0.95", 0.95)];

impl VibrationProbability {
    /// The sentence of the answer.
    pub fn sentence(&self, study: &impl SampledKind) -> String {
        let of = |tally: &VerdictTally| {
            let RealInterval { lower: low, upper: high } = tally.interval();
            tally.probability().map(|probability| {
                format!(
                    "{} (95 % interval {} to {})",
                    per_cent(probability),
                    per_cent(low),
                    per_cent(high)
                )
            })
        };
        let Some(probability) = of(&self.verdicts) else {
            return format!("No verdict of {} samples is known.", self.samples);
        };
        let limit = self.limit_verdicts.as_ref().and_then(of);
        let limit = limit.map_or(String::new(), |found| {
            format!("; in the limit of high dither frequency it is {found}")
        });
        let judge = match self.limit_verdicts {
            Some(_) => "by finite-R averaging",
            None => self.start.words(),
        };
        let enough = self.thresholds.quantile(0.95).map_or(String::new(), |amplitude| {
            // Not with the few digits of a probability: rounded down, it would be loud.
            format!(
                " An amplitude of {} is quiet in 95 % of the samples.",
                study.force_in_words(amplitude)
            )
        });
        format!(
            "The probability that it vibrates {judge} is {probability}, from {} sample{}{limit}.{enough}",
            self.samples,
            plural(self.samples)
        )
    }

    /// The growth rate, and the number on which it depends most.
    pub fn notes(&self, study: &impl SampledKind) -> Vec<String> {
        let cause = self.main_cause().map(|(paths, total)| {
            format!(
                "The {} causes {} of the variance of the growth rate, alone and together with others.",
                paths.iter().map(|path| quantity_at(path)).collect::<Vec<_>>().join(" with the "),
                // The estimate of a share may exceed 1 by its error.
                per_cent(total.value.clamp(0.0, 1.0))
            )
        });
        let (unit, factor) = study.unit_of_rates();
        let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
        // The growth rate is that of averaging, also where exact motions decide about the vibration.
        let averaged = if self.start == ProbabilityStart::Averaged { "" } else { " by averaging" };
        let growth = self.growth.quantiles().map(|[low, _, high]| {
            format!(
                "The growth rate{averaged} is between {}{unit} and {}{unit} in 90 % of the samples.",
                digits(low * factor),
                digits(high * factor)
            )
        });
        growth.into_iter().chain(cause).collect()
    }

    /// Paths of a group of numbers.
    pub fn names(&self, group: &[usize]) -> Vec<&str> {
        group.iter().map(|place| self.paths[*place].as_str()).collect()
    }

    /// The group of numbers with the largest total index, of several.
    fn main_cause(&self) -> Option<(Vec<&str>, SobolEstimate)> {
        if self.groups.len() < 2 {
            return None;
        }
        let known = self.groups.iter().zip(&self.growth.indices);
        let known = known.filter_map(|(group, found)| Some((group, found.as_ref().ok()?.total)));
        let (group, total) = known.max_by(|a, b| a.1.value.total_cmp(&b.1.value))?;
        Some((self.names(group), total))
    }

    /// As JSON.
    pub fn json(&self, study: &impl SampledKind) -> Json {
        let mut fields = study.fields();
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("start", self.start.name())
            .plain("samples", self.samples)
            .plain("seed", self.seed);
        put_tally(&mut fields, &self.verdicts);
        fields.plain("confidence", 0.95).nested("quantiles", quantiles(study, &self.growth));
        let thresholds = QUANTILES.map(|(_, share)| {
            let mut inner = study.fields();
            inner.measured("share", "1", share);
            inner.known("amplitude", Quantity::Force, self.thresholds.quantile(share));
            inner
        });
        fields.list("thresholds", thresholds);
        fields.nested("indices", self.indices(study, &self.growth));
        if let Some(growth) = &self.limit_growth {
            let mut limit = study.fields();
            if let Some(verdicts) = &self.limit_verdicts {
                put_tally(&mut limit, verdicts);
            }
            limit
                .nested("quantiles", quantiles(study, growth))
                .nested("indices", self.indices(study, growth));
            fields.nested("limit", limit);
        }
        let groups = self.groups.iter().zip(&self.growth.indices).map(|(group, found)| {
            let mut inner = study.fields();
            inner.plain("of", self.names(group));
            put_indices(&mut inner, found);
            inner
        });
        fields.list("groups", groups);
        fields.plain("invalid", self.invalid);
        fields.plain("warnings", self.warnings());
        fields.finish()
    }

    /// Indices by path; those of correlated numbers are of their group alone.
    fn indices(&self, study: &impl SampledKind, growth: &SampledGrowth) -> Fields {
        let mut fields = study.fields();
        for (group, found) in self.groups.iter().zip(&growth.indices) {
            for place in group {
                let mut inner = study.fields();
                let found =
                    if group.len() == 1 { found.clone() } else { Err(NoIndices::Correlated) };
                put_indices(&mut inner, &found);
                fields.nested(&self.paths[*place], inner);
            }
        }
        fields
    }

    /// What limits the answer.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let samples = |count: usize| format!("{count} of {} samples", self.samples);
        if let Some(why) = &self.invalid_why {
            warnings.push(format!(
                "{} are no valid studies and are left out: the probability is that of valid studies. The first: {why}",
                samples(self.invalid)
            ));
        }
        if let Some(why) = &self.verdicts.why {
            warnings.push(format!(
                "the verdict of {} is unknown: the interval of the probability includes them as quiet and as vibrating. The first: {why}",
                samples(self.verdicts.unknown)
            ));
        }
        // A growth rate that leaves a verdict open was named with the verdicts.
        let of_verdicts = self.verdicts.why.as_ref().map(ToString::to_string);
        if let Some(why) = (self.growth.why.as_ref().map(ToString::to_string))
            .filter(|why| of_verdicts.as_ref() != Some(why))
        {
            warnings.push(format!(
                "the growth rate of {} is unknown. The first: {why}",
                samples(self.growth.unknown)
            ));
        }
        if self.hardly_fast > 0 {
            warnings.push(format!(
                "averaging assumes fast dither, and R is below {FAST} in {}: --start local judges by exact responses",
                samples(self.hardly_fast)
            ));
        }
        if self.apart > 0 {
            warnings.push(format!(
                "the limit of high dither frequency has another verdict in {}: --start local judges by exact responses",
                samples(self.apart)
            ));
        }
        if self.beyond_range > 0 {
            warnings.push(format!(
                "slip leaves the range of a friction law in {}",
                samples(self.beyond_range)
            ));
        }
        if self.opens > 0 {
            warnings.push(format!(
                "the fast motion opens a contact in {}, which averaging does not describe",
                samples(self.opens)
            ));
        }
        let imprecise = self
            .growth
            .indices
            .iter()
            .flatten()
            .filter(|found| [found.first, found.total].iter().any(|index| index.error > 0.05));
        let imprecise = imprecise.count();
        if imprecise > 0 {
            warnings.push(format!(
                "the standard error of {imprecise} pair{} of indices exceeds 0.05: take more samples",
                plural(imprecise)
            ));
        }
        warnings
    }
}

impl SampledGrowth {
    /// The quantiles of [`QUANTILES`]; `None` without a known growth rate.
    pub(crate) fn quantiles(&self) -> Option<[f64; 3]> {
        let at = |place: usize| quantile(&self.rates, QUANTILES[place].1);
        Some([at(0)?, at(1)?, at(2)?])
    }
}

/// The quantiles of [`QUANTILES`] of the growth rate.
fn quantiles(study: &impl SampledKind, growth: &SampledGrowth) -> Fields {
    let mut inner = study.fields();
    let found = growth.quantiles();
    for (place, (key, _)) in QUANTILES.iter().enumerate() {
        let why = || {
            growth.why.as_ref().map_or("no growth rate is known".to_owned(), ToString::to_string)
        };
        study.put_rate(&mut inner, key, found.map(|found| found[place]).ok_or_else(why));
    }
    let mut fields = study.fields();
    fields.nested("growth", inner);
    fields
}

fn put_tally(fields: &mut Fields, tally: &VerdictTally) {
    let RealInterval { lower: low, upper: high } = tally.interval();
    match tally.probability() {
        Some(probability) => {
            fields
                .measured("probability", "1", probability)
                .measured("low", "1", low)
                .measured("high", "1", high);
        }
        None => {
            for name in ["probability", "low", "high"] {
                fields.unknown(name, "no verdict is known");
            }
        }
    }
    fields
        .plain("vibrating", tally.vibrating)
        .plain("quiet", tally.quiet)
        .plain("unknown", tally.unknown);
}

fn put_indices(fields: &mut Fields, found: &Result<SobolIndices, NoIndices>) {
    match found {
        Ok(SobolIndices { first, total }) => {
            fields
                .measured("first", "1", first.value)
                .measured("first_error", "1", first.error)
                .measured("total", "1", total.value)
                .measured("total_error", "1", total.error);
        }
        Err(why) => {
            for name in ["first", "first_error", "total", "total_error"] {
                fields.unknown(name, why);
            }
        }
    }
}
