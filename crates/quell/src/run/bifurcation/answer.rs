//! Sweeps as sentences, JSON and dataset.

use quell_dynamics::attractor::{Attractor, AttractorKind};
use quell_model::units::Quantity;
use serde_json::Value as Json;

use super::super::attractor::{
    KINDS, VERDICTS, kind_code, number, put, put_section, verdict_code, words,
};
use super::shared::{hysteresis_sentence, jump, put_comparison};
use super::{Bifurcation, SweepDirection, SweepPoint};
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::study::BeltStudy;
use crate::words::{plural, start_in_words};

impl Bifurcation {
    /// One sentence for each direction and one that compares both.
    pub fn sentence(&self, study: &BeltStudy) -> String {
        let value = |value: f64| number(study, self.varied.unit, value);
        let path = &self.varied.path;
        let mut sentences: Vec<String> = Vec::new();
        for branch in &self.branches {
            let way = branch.direction.name();
            let (Some(first), Some(last)) = (branch.points.first(), branch.points.last()) else {
                continue;
            };
            let quiet = |point: &SweepPoint| match point.quiet() {
                Some(true) if point.in_band => "in step with the dither",
                Some(true) => "quiet",
                Some(false) => "vibrating",
                None => "unsettled",
            };
            let (start, end) = (value(first.value), value(last.value));
            let jumps = branch.jumps();
            if jumps.is_empty() && quiet(first) == quiet(last) {
                let state = quiet(first);
                sentences.push(format!(
                    "Sweeping {path} {way}, the response is {state} at both {start} and {end}."
                ));
                continue;
            }
            let mut parts =
                vec![format!("Sweeping {path} {way}, the response is {} at {start}", quiet(first))];
            for jump in jumps {
                let word = match (jump.to_quiet, jump.in_band) {
                    (true, false) => "falls quiet",
                    (true, true) => "falls into step with the dither",
                    (false, _) => "begins to vibrate",
                };
                parts.push(format!(
                    "{word} between {} and {}",
                    value(jump.before),
                    value(jump.after)
                ));
            }
            let parts = parts.join(", ");
            sentences.push(format!("{parts}, and is {} at {end}.", quiet(last)));
        }
        if self.branches.len() == 2 {
            sentences.push(hysteresis_sentence(
                &self.hysteresis,
                &self.both_settle(),
                "responses",
                value,
            ));
        }
        sentences.join(" ")
    }

    /// Whether both directions have settled, at each value.
    fn both_settle(&self) -> Vec<bool> {
        let [up, down] = self.branches.as_slice() else { return Vec::new() };
        let pairs = up.points.iter().zip(down.points.iter().rev());
        pairs.map(|(one, other)| one.response.is_ok() && other.response.is_ok()).collect()
    }

    /// Warnings about points that have not settled.
    pub fn warnings(&self, study: &BeltStudy) -> Vec<String> {
        let mut warnings = self.slip.warnings(study);
        for branch in &self.branches {
            for point in &branch.points {
                if let Err(why) = &point.response {
                    warnings.push(format!(
                        "sweeping {}, the response at {} = {} has not settled after {} period{}: {}",
                        branch.direction.name(),
                        self.varied.path,
                        point.value,
                        point.periods,
                        plural(point.periods),
                        why.about()
                    ));
                }
            }
        }
        warnings
    }

    /// As JSON.
    pub fn json(&self, study: &BeltStudy) -> Json {
        let scales = study.scales();
        let mut fields = Fields::new(scales);
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("protocol", "the state is carried over from value to value; upward first, then downward from the final state")
            .plain("parameter", self.varied.path.as_str())
            .plain("unit", self.varied.unit)
            .plain("start", start_in_words(study));
        for branch in &self.branches {
            let points = branch.points.iter().map(|point| {
                let mut inner = Fields::new(point.scales);
                inner.plain("value", point.value);
                match &point.local {
                    Ok(verdict) => inner.plain("local_verdict", verdict.name()),
                    Err(why) => inner.unknown("local_verdict", why.as_str()),
                };
                inner.plain("settled", point.response.is_ok());
                inner.plain("periods_to_settle", point.periods);
                match &point.response {
                    Ok(attractor) => {
                        inner.plain("words", words(point.scales, attractor, point.period));
                        put(&mut inner, attractor, point.period);
                        put_section(&mut inner, attractor);
                    }
                    Err(why) => {
                        inner.unknown("kind", why.about());
                    }
                }
                inner
            });
            fields.list(branch.direction.name(), points);
        }
        let jumps = self.branches.iter().flat_map(|branch| {
            let own = branch.jumps().into_iter();
            own.map(|own| {
                let ends = (own.before, own.after);
                jump(Fields::new(scales), branch.direction, ends, own.to_quiet)
            })
        });
        let hysteresis = (self.branches.len() == 2).then_some(self.hysteresis.as_slice());
        put_comparison(&mut fields, jumps.collect(), hysteresis);
        fields.plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// One row for each state of the section of each point.
    pub fn dataset(&self, study: &BeltStudy) -> Dataset {
        let mut numbers: [Vec<f64>; 12] = Default::default();
        let mut codes: [Vec<u8>; 4] = Default::default();
        for branch in &self.branches {
            for point in &branch.points {
                let attractor = point.response.as_ref().ok();
                let none = [(f64::NAN, f64::NAN)];
                let section = attractor.map_or(&none[..], |attractor| attractor.section.as_slice());
                let rotation = attractor.and_then(|attractor| attractor.rotation);
                let ratio = rotation.and_then(|rotation| rotation.ratio);
                let of = |value: Option<f64>| value.unwrap_or(f64::NAN);
                // Columns use the scales of the unmodified study; this corrects for a varied mass or stiffness.
                let other = |quantity: Quantity| match (point.scales, study.scales()) {
                    (Some(own), Some(all)) => own.per_unit(quantity) / all.per_unit(quantity),
                    _ => 1.0,
                };
                let (velocity, hertz) =
                    (other(Quantity::Velocity), other(Quantity::FrequencyRatio));
                for (x, v) in section {
                    let row = [
                        point.value,
                        *x,
                        *v * velocity,
                        of(attractor.map(Attractor::size)),
                        of(attractor.map(|attractor| attractor.stick_fraction)),
                        of(attractor.and_then(periods)),
                        of(rotation.map(|rotation| rotation.turns_per_period)),
                        of(rotation.map(|rotation| rotation.error)),
                        of(ratio.map(|ratio| ratio.turns as f64)),
                        of(ratio.map(|ratio| f64::from(ratio.periods))),
                        of(attractor.and_then(|attractor| attractor.frequency(point.period)))
                            * hertz,
                        point.periods as f64,
                    ];
                    numbers.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
                    let code = [
                        u8::from(branch.direction == SweepDirection::Down),
                        kind_code(attractor),
                        point.quiet().map_or(2, u8::from),
                        verdict_code(&point.local),
                    ];
                    codes.iter_mut().zip(code).for_each(|(column, code)| column.push(code));
                }
            }
        }
        let rows: Vec<f64> = (0..numbers[0].len()).map(|row| row as f64).collect();
        let [value, x, v, size, stick, periods, turns, error, p, q, frequency, settle] = numbers;
        let [direction, kind, quiet, local] = codes;
        Dataset::new(study, "bifurcation")
            .fact(format!(
                "sweep of {}, the state carried over; {}",
                self.varied.path,
                start_in_words(study)
            ))
            .with_axis(Array::new("row", "1", rows))
            .with(Array::of_words("direction", vec![(0, "up"), (1, "down")], &direction))
            .with(Array::new(self.varied.name(), self.varied.unit, value))
            .with(Array::of_words("kind", KINDS.to_vec(), &kind))
            .with(Array::of_words("quiet", vec![(0, "no"), (1, "yes"), (2, "unknown")], &quiet))
            .with(Array::of_words("local_verdict", VERDICTS.to_vec(), &local))
            .array("section_displacement", Quantity::Displacement, x)
            .array("section_velocity", Quantity::Velocity, v)
            .array("peak_to_peak", Quantity::Displacement, size)
            .array("stick_fraction", Quantity::Ratio, stick)
            .array("periods", Quantity::Count, periods)
            .array("rotation_number", Quantity::Ratio, turns)
            .array("rotation_error", Quantity::Ratio, error)
            .array("locking_turns", Quantity::Count, p)
            .array("locking_periods", Quantity::Count, q)
            .array("frequency", Quantity::FrequencyRatio, frequency)
            .array("periods_to_settle", Quantity::Count, settle)
    }
}

/// Number of periods of a closed orbit.
fn periods(attractor: &Attractor) -> Option<f64> {
    match attractor.kind {
        AttractorKind::Periodic { periods, .. } => Some(f64::from(periods)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use quell_dynamics::attractor::Unsettled;
    use quell_dynamics::orbit::OrbitVerdict;

    use super::super::Branch;
    use super::*;
    use crate::range::SlipMet;
    use crate::run::varied::{Range, Varied};

    const STUDY: &str = "schema = 1\n[belt]\ndamping_ratio = 0.1\nnormal_load = 1\nbelt_velocity = 1\n\
        [friction]\nlaw = \"decreasing\"\nstatic_coefficient = 0.4\nminimum_coefficient = 0.3\nreference_velocity = 0.2\n\
        [[dither]]\ndirection = \"tangential\"\nwaveform = \"sine\"\namplitude = 1\nfrequency_ratio = 10\n";

    /// A point that has not settled is neither quiet nor vibrating: no jump begins or ends there, and hysteresis is not ruled out.
    #[test]
    fn unsettled_points_give_no_jumps() {
        let study = BeltStudy::parse(STUDY, &[]).expect("valid");
        let range = Range { parameter: "dither.amplitude".into(), from: 1.0, to: 2.0, points: 2 };
        let varied = Varied::new(&study, "--parameter", &range).expect("valid");
        let point = |value: f64| SweepPoint {
            value,
            scales: None,
            period: 1.0,
            in_band: false,
            local: Ok(OrbitVerdict::Stable),
            response: Err(Unsettled::Moving),
            periods: 7,
        };
        let branch =
            |direction, values: [f64; 2]| Branch { direction, points: values.map(point).to_vec() };
        let branches =
            vec![branch(SweepDirection::Up, [1.0, 2.0]), branch(SweepDirection::Down, [2.0, 1.0])];
        let found =
            Bifurcation { varied, branches, hysteresis: Vec::new(), slip: SlipMet::default() };
        let sentence = found.sentence(&study);
        assert!(sentence.contains("the response is unsettled at both 1 and 2"), "{sentence}");
        assert!(
            sentence.ends_with("The two directions have not both settled at any value."),
            "{sentence}"
        );
        let json = found.json(&study);
        assert_eq!(json["jumps"].as_array().map(Vec::len), Some(0));
        assert!(json["up"][0]["kind"].is_null() && json["why"]["up[0].kind"].is_string());
        assert_eq!(found.warnings(&study).len(), 4);
        let table = found.dataset(&study).csv();
        assert_eq!(table.matches("unknown").count(), 4, "{table}");
    }
}
