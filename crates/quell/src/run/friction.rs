//! `friction`: the friction law and the effective friction under the dither, versus slip velocity.

use quell_dynamics::mean_friction::mean_friction;
use quell_dynamics::orbit::OrbitVerdict;
use quell_dynamics::response::{SteadyFriction, steady_effective_friction};
use quell_linear::averaging::{Averaging, Effective, FastMotion, SlopeSide, effective};
use quell_model::units::Quantity;
use quell_model::{Belt, Direction, Friction};
use quell_numerics::order::ascending;
use serde_json::Value as Json;

use crate::contact_state;
use crate::dataset::Dataset;
use crate::fields::Fields;
use crate::noise::few_lines;
use crate::parallel::Parallel;
use crate::range;
use crate::study::BeltStudy;
use crate::words::in_words;

/// Points of the default grid on each side of v_r = 0.
const POINTS: u32 = 200;

/// Points clustered at the corner of the effective friction, each at half the distance of the one before.
const CORNER: i32 = 16;

/// Relative difference up to which measured and averaged friction agree.
const AGREES: f64 = 0.1;

/// Friction at one slip velocity.
#[derive(Clone, Debug)]
pub struct FrictionPoint {
    /// Slip velocity v_r: a length per τ.
    pub slip_velocity: f64,
    /// μ with the sign of v_r, dimensionless; or why it has no single value.
    pub coefficient: Result<f64, String>,
    /// μ̄, dimensionless, and its slope per unit of v_r, by finite-R averaging; or why they are undefined.
    pub effective: Result<Effective, String>,
}

/// Friction versus slip velocity.
#[derive(Clone, Debug)]
pub struct FrictionCurve {
    /// Points in the requested order.
    pub points: Vec<FrictionPoint>,
    /// μ̄ and its slope in the limit of high dither frequency, R → ∞; `None` without dither, of a system, whose averages all have the
    /// response of the structure, and of a contact with a state of its own.
    pub limit: Option<Vec<Result<Effective, String>>>,
    /// ⟨f/N⟩ of the steady response at each point, or why it has no value; `None` if it was not requested.
    pub measured: Option<Vec<Result<SteadyFriction, String>>>,
}

/// Slip velocities of a picture: beyond the velocities of the law, the belt and the fast motion, up to where slip
/// including dither leaves the law's range.
pub fn grid(belt: &Belt) -> Vec<f64> {
    grid_of(belt.friction(), belt.belt_velocity(), range::fast_velocity(belt))
}

/// The same of a law at a surface velocity under a fast slip velocity.
pub(crate) fn grid_of(law: &Friction, velocity: f64, fast: f64) -> Vec<f64> {
    let reached = 1.5 * velocity.abs().max(fast);
    let scale = law.velocity_scale();
    let own = if law.has_velocity() || reached == 0.0 { 2.0 * scale } else { 0.0 };
    // The average at a slip velocity reaches that velocity plus the fast velocity.
    let within = law.range().map_or(f64::INFINITY, |range| range.upper);
    let within = match within - fast {
        // Rounding must not leave the range again.
        rest if rest > 0.0 && rest + fast > within => rest.next_down(),
        rest if rest > 0.0 => rest,
        _ => within,
    };
    let end = within.min(own.max(reached));
    let mut side: Vec<f64> =
        (1..=POINTS).map(|k| (end * f64::from(k) / f64::from(POINTS)).min(end)).collect();
    // The effective friction has a corner at the largest fast velocity.
    if fast > 0.0 {
        let crowd = (1..=CORNER).map(|k| fast * (1.0 - 0.5f64.powi(k))).chain([fast]);
        side.extend(crowd.filter(|&v| v <= end));
    }
    ascending(&mut side);
    side.dedup();
    let left = side.iter().rev().map(|v| -v);
    left.chain([0.0]).chain(side.iter().copied()).collect()
}

/// The friction coefficient of a law, with the sign of the slip velocity; or why it has no single value.
pub(crate) fn coefficient_at(law: &Friction, v: f64) -> Result<f64, String> {
    if v == 0.0 {
        let level = law.static_coefficient();
        return Err(format!("at rest friction takes any value up to ±{level}"));
    }
    Ok(v.signum() * law.coefficient(v.abs()))
}

/// The law and its average under the study's dither at slip velocities `at`.
pub fn run(study: &BeltStudy, at: &[f64]) -> FrictionCurve {
    let belt = study.belt();
    let law = belt.friction();
    let has_noise = belt.dithers().iter().any(|dither| !dither.waveform.is_periodic());
    let averaged = |v: f64, options: Averaging| {
        FastMotion::of(belt, v, options)
            .and_then(|motion| effective(law, &motion, v))
            .map_err(|why| why.to_string())
    };
    let points = at.in_parallel(|&v| FrictionPoint {
        slip_velocity: v,
        coefficient: coefficient_at(law, v),
        effective: if belt.has_contact_state() && has_noise {
            Err("the mean of a contact with a state of its own is that of its periodic state, and under noise it has none".to_owned())
        } else if belt.has_contact_state() {
            mean_friction(belt, v).map_err(|why| why.to_string())
        } else {
            averaged(v, Averaging::FiniteR)
        },
    });
    let in_the_limit = |v: &f64| averaged(*v, Averaging::Limit);
    let has_limit = !belt.dithers().is_empty() && !belt.has_contact_state();
    let limit = has_limit.then(|| at.in_parallel(in_the_limit).collect());
    FrictionCurve { points: points.collect(), limit, measured: None }
}

/// The same with friction measured on steady responses (4.30), (4.31), in parallel on all cores.
pub fn run_measured(study: &BeltStudy, at: &[f64]) -> FrictionCurve {
    let tolerance = study.solver().tolerance;
    let measured = at.in_parallel(|&v| {
        if v == 0.0 {
            return Err("at zero slip velocity the belt does not move".to_owned());
        }
        if let Some(why) = study.belt().unsimulated() {
            return Err(why.to_owned());
        }
        steady_effective_friction(study.belt(), v, tolerance).map_err(|why| why.to_string())
    });
    FrictionCurve { measured: Some(measured.collect()), ..run(study, at) }
}

impl FrictionCurve {
    /// μ̄ at each point; NaN where it is undefined.
    pub fn effective_coefficients(&self) -> Vec<f64> {
        self.column(|point| point.effective.as_ref().map_or(f64::NAN, |found| found.coefficient))
    }

    /// μ at each point; NaN where it has no single value.
    pub fn coefficients(&self) -> Vec<f64> {
        self.column(|point| *point.coefficient.as_ref().unwrap_or(&f64::NAN))
    }

    /// The slip velocities.
    pub fn slip_velocities(&self) -> Vec<f64> {
        self.column(|point| point.slip_velocity)
    }

    /// μ̄′ at each point; NaN where it is undefined.
    pub fn effective_slopes(&self) -> Vec<f64> {
        self.column(|point| point.effective.as_ref().map_or(f64::NAN, |found| found.slope))
    }

    /// ⟨f/N⟩ of the steady response at each point, NaN where it has no value; `None` if it was not requested.
    pub fn measured_coefficients(&self) -> Option<Vec<f64>> {
        self.measured_column(|found| found.coefficient)
    }

    /// Fraction of the period that the steady response sticks, in the same way.
    pub fn measured_stick_fractions(&self) -> Option<Vec<f64>> {
        self.measured_column(|found| found.stick_fraction)
    }

    /// 1 where the steady response is stable, 0 where it is unstable, NaN where it has no value or its stability is not decided.
    pub fn measured_stability(&self) -> Option<Vec<f64>> {
        self.measured_column(|found| match found.verdict {
            OrbitVerdict::Stable => 1.0,
            OrbitVerdict::Unstable => 0.0,
            OrbitVerdict::Undecided => f64::NAN,
        })
    }

    /// μ̄ or its slope in the limit R → ∞, NaN where it is undefined; `None` where it is not given.
    fn limit_column(&self, value: fn(&Effective) -> f64) -> Option<Vec<f64>> {
        let limit = self.limit.as_ref()?;
        Some(limit.iter().map(|found| found.as_ref().map_or(f64::NAN, value)).collect())
    }

    fn measured_column(&self, value: fn(&SteadyFriction) -> f64) -> Option<Vec<f64>> {
        let measured = self.measured.as_ref()?;
        Some(measured.iter().map(|found| found.as_ref().map_or(f64::NAN, value)).collect())
    }

    fn column(&self, value: impl Fn(&FrictionPoint) -> f64) -> Vec<f64> {
        self.points.iter().map(value).collect()
    }

    fn errors(&self, value: fn(&Effective) -> f64) -> Vec<f64> {
        self.column(|point| point.effective.as_ref().map_or(f64::NAN, value))
    }

    /// As JSON.
    pub fn json(&self, study: &BeltStudy) -> Json {
        let mut fields = Fields::new(study.scales());
        let empty = || Fields::new(study.scales());
        let belt = study.belt();
        let mut law = super::law::fields(belt.friction(), belt.normal_load(), &empty);
        if let Some(file) = study.measured().and_then(|measured| measured.file.as_ref()) {
            law.plain("file", file.clone());
        }
        fields.plain("ok", true).nested("law", law);
        self.put(&mut fields);
        fields.plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// The columns, and why values are missing.
    pub(crate) fn put(&self, fields: &mut Fields) {
        fields
            .numbers("slip_velocity", Quantity::Velocity, &self.slip_velocities())
            .numbers("coefficient", Quantity::Ratio, &self.coefficients())
            .numbers("effective_coefficient", Quantity::Ratio, &self.effective_coefficients())
            .numbers(
                "effective_coefficient_error",
                Quantity::Ratio,
                &self.errors(|found| found.coefficient_error),
            )
            .per_velocity("effective_slope", &self.effective_slopes())
            .per_velocity("effective_slope_error", &self.errors(|found| found.slope_error));
        let one_sided = self.points.iter().map(|point| {
            point.effective.as_ref().is_ok_and(|found| found.side == SlopeSide::Outer)
        });
        fields.plain("effective_slope_one_sided", one_sided.collect::<Vec<bool>>());
        self.limit_json(fields);
        self.measured_json(fields);
        for (index, point) in self.points.iter().enumerate() {
            if let Err(why) = &point.coefficient {
                fields.why(&format!("coefficient[{index}]"), why);
            }
            if let Err(why) = &point.effective {
                fields.why(&format!("effective_coefficient[{index}]"), why);
                fields.why(&format!("effective_slope[{index}]"), why);
            }
        }
    }

    /// The columns of the limit R → ∞, if they are given.
    fn limit_json(&self, fields: &mut Fields) {
        let Some(limit) = &self.limit else { return };
        let column = |value: fn(&Effective) -> f64| self.limit_column(value).unwrap_or_default();
        let (name, slope) = ("limit_effective_coefficient", "limit_effective_slope");
        fields
            .numbers(name, Quantity::Ratio, &column(|found| found.coefficient))
            .per_velocity(slope, &column(|found| found.slope));
        for (index, found) in limit.iter().enumerate() {
            if let Err(why) = found {
                fields.why(&format!("{name}[{index}]"), why);
                fields.why(&format!("{slope}[{index}]"), why);
            }
        }
    }

    /// The columns of the measured friction, if it was requested.
    fn measured_json(&self, fields: &mut Fields) {
        let (Some(measured), Some(coefficients), Some(stuck)) =
            (&self.measured, self.measured_coefficients(), self.measured_stick_fractions())
        else {
            return;
        };
        let verdict = |found: &Result<SteadyFriction, String>| {
            found.as_ref().map_or(Json::Null, |found| found.verdict.name().into())
        };
        let base = |found: &Result<SteadyFriction, String>| {
            found.as_ref().map_or(Json::Null, |found| found.base.into())
        };
        fields
            .numbers("measured_coefficient", Quantity::Ratio, &coefficients)
            .numbers("measured_stick_fraction", Quantity::Ratio, &stuck)
            .plain("measured_verdict", measured.iter().map(verdict).collect::<Vec<Json>>())
            .plain("measured_base", measured.iter().map(base).collect::<Vec<Json>>());
        for (index, found) in measured.iter().enumerate() {
            if let Err(why) = found {
                for name in ["coefficient", "stick_fraction", "verdict", "base"] {
                    fields.why(&format!("measured_{name}[{index}]"), why);
                }
            }
        }
    }

    /// Warnings where the slip velocities, or that of the belt, leave the range of the law when the fast motion is added, and
    /// where averaging under normal dither is not valid.
    pub fn warnings(&self, study: &BeltStudy) -> Vec<String> {
        let speeds = self.points.iter().map(|point| point.slip_velocity.abs());
        let fastest = speeds.fold(study.belt().belt_velocity(), f64::max);
        let mut warnings = range::averaged_at(study, fastest);
        let belt = study.belt();
        warnings.extend(contact_state::passivity(study));
        warnings.extend(few_lines(belt));
        if belt.has_contact_state() {
            let slowest = self.points.iter().map(|point| point.slip_velocity.abs());
            let slowest = slowest.filter(|speed| *speed > 0.0).fold(f64::INFINITY, f64::min);
            let speed = if slowest.is_finite() { slowest } else { belt.belt_velocity() };
            warnings.extend(contact_state::rigid_average(belt, speed).map(|why| {
                format!("{why}; the values here are means of the contact with its state")
            }));
            return warnings;
        }
        warnings.extend(match &self.measured {
            None => self.slow_slip(study),
            Some(measured) => self.averaging_is_off(study, measured),
        });
        warnings
    }

    /// Averaging under normal dither assumes slip throughout: the fast velocity must not reach the slip velocity. Where it does,
    /// the contact sticks for a part of each period, most of it while the load is large.
    fn slow_slip(&self, study: &BeltStudy) -> Option<String> {
        let belt = study.belt();
        let fast: f64 =
            belt.dithers_along(Direction::Normal).map(|dither| belt.fast_velocity_of(dither)).sum();
        let slow = |point: &FrictionPoint| {
            let speed = point.slip_velocity.abs();
            0.0 < speed && speed < fast
        };
        self.points.iter().any(slow).then(|| {
            let fast = in_words(study, Quantity::Velocity, fast);
            format!(
                "below |v_r| = {fast}, the fast velocity under the normal dither, the contact may stick for a part of each period: \
                 averaging assumes that it slips, and can be several times too low; the option measured gives the friction of \
                 steady responses"
            )
        })
    }

    /// Where the measured friction differs most from the averaged one, and from which slip velocity on they
    /// agree.
    fn averaging_is_off(
        &self,
        study: &BeltStudy,
        measured: &[Result<SteadyFriction, String>],
    ) -> Option<String> {
        // (|v_r|, measured/averaged)
        let ratios: Vec<(f64, f64)> = self
            .points
            .iter()
            .zip(measured)
            .filter_map(|(point, measured)| {
                let averaged = point.effective.as_ref().ok()?.coefficient;
                let ratio = measured.as_ref().ok()?.coefficient / averaged;
                ratio.is_finite().then(|| (point.slip_velocity.abs(), ratio))
            })
            .collect();
        let off = |ratio: f64| (ratio - 1.0).abs() > AGREES;
        let worst = ratios
            .iter()
            .filter(|(_, ratio)| off(*ratio))
            .max_by(|a, b| (a.1 - 1.0).abs().total_cmp(&(b.1 - 1.0).abs()))?;
        let last =
            ratios.iter().filter(|(_, ratio)| off(*ratio)).map(|(v, _)| *v).fold(0.0, f64::max);
        let agrees_above = ratios.iter().any(|(v, _)| *v > last);
        let [at, last] = [worst.0, last].map(|v| in_words(study, Quantity::Velocity, v));
        let factor = quell_model::digits::digits(worst.1, 3);
        let off =
            format!("at |v_r| = {at} the measured friction is {factor} times the averaged one");
        if !agrees_above {
            return Some(off);
        }
        let percent = 100.0 * AGREES;
        Some(format!(
            "{off}; of the points given, those above |v_r| = {last} agree within {percent} %"
        ))
    }

    /// As a dataset.
    pub fn dataset(&self, study: &BeltStudy) -> Dataset {
        let mut dataset = Dataset::new(study, "friction")
            .axis("slip_velocity", Quantity::Velocity, self.slip_velocities())
            .array("coefficient", Quantity::Ratio, self.coefficients())
            .array("effective_coefficient", Quantity::Ratio, self.effective_coefficients())
            .per_velocity("effective_slope", self.effective_slopes());
        if let Some(slopes) = self.limit_column(|found| found.slope) {
            dataset = dataset.per_velocity("limit_effective_slope", slopes);
        }
        for (name, values) in [
            ("limit_effective_coefficient", self.limit_column(|found| found.coefficient)),
            ("measured_coefficient", self.measured_coefficients()),
            ("measured_stick_fraction", self.measured_stick_fractions()),
            ("measured_stable", self.measured_stability()),
        ] {
            if let Some(values) = values {
                dataset = dataset.array(name, Quantity::Ratio, values);
            }
        }
        dataset
    }
}
