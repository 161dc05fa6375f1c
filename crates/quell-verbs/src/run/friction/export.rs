//! Averaged friction as a model of another program: a table over the slip speed, and smooth models fitted to it.
//!
//! The curve is that of `friction` for slip speeds from 0 up, with the mean between any two neighbours in addition, at which
//! the straight lines of a table are worst. The value at 0 is the limit from above where friction at rest has no single value.

use quell_design::substitute::{
    ExponentialDecay, SlipRateTable, SpeedCurve, TranslationalFriction,
};
use quell_numerics::order::ascending;

use super::ContactCurves;
use super::means::{self, ContactAverages};
use crate::complaint::Failure;
use crate::run::system::velocity_in_words;
use crate::study::SystemStudy;

/// Tolerance of the table, relative to the largest coefficient: a tenth of what friction measurements repeat within.
const TOLERANCE: f64 = 1e-3;

/// The share of the largest speed that stands for the limit at 0.
const LIMIT: f64 = 1e-6;

/// Equal steps of the slip speed.
const STEPS: u32 = 200;

/// Speeds closer than this share of the largest are one: corners are resolved to 1.5·10⁻⁵ of their speed.
const NEAR: f64 = 1e-9;

/// Two directions differ if their coefficients differ by more than this share of the largest coefficient, above the errors of
/// averages.
const ONE_SIDED: f64 = 1e-6;

/// Speeds, as shares of the largest, at which both directions are compared.
const COMPARED: [f64; 5] = [0.02, 0.1, 0.25, 0.5, 1.0];

/// Averaged friction as models of other programs, in the units of the study.
#[derive(Clone, Debug)]
pub struct FrictionExport {
    /// Normal load N.
    pub normal_load: f64,
    /// Straight lines between few points.
    pub table: SlipRateTable,
    /// The model of Abaqus with a decay.
    pub decay: ExponentialDecay,
    /// The model of Simscape.
    pub translational: TranslationalFriction,
    /// The coefficient at rest over that of the table there; 1 under dither.
    pub peak: f64,
    /// The largest fast slip velocity, where a dither is averaged.
    pub fast_velocity: Option<f64>,
    /// Warnings about the averages.
    pub warnings: Vec<String>,
}

/// The models of the only contact of a study for slip speeds up to the largest of `done`.
///
/// # Errors
/// [`Failure::Failed`] where a study has several contacts, or the average has no value, is negative, or differs between the two
/// directions of slip.
pub fn run(study: &SystemStudy, done: &ContactCurves) -> Result<FrictionExport, Failure> {
    let contacts = means::contacts(study.system());
    let ([own], [found]) = (&contacts[..], &done.contacts[..]) else {
        return Err(failed(
            "a file for another program has the friction of one contact".to_owned(),
        ));
    };
    let (speeds, coefficients) = averaged(study, own, found.curve.fastest())?;
    let largest = coefficients.iter().fold(0.0f64, |most, value| most.max(*value));
    same_in_both_directions(study, own, (&speeds, &coefficients), largest)?;
    if let Some(at) = coefficients.iter().position(|value| *value < 0.0) {
        let speed = velocity_in_words(study, speeds[at]);
        return Err(failed(format!(
            "the averaged coefficient is {} at the slip speed {speed}: friction that drives has no form in these programs",
            coefficients[at]
        )));
    }
    let curve = SpeedCurve { speeds, coefficients };
    let table = SlipRateTable::of(&curve, TOLERANCE * largest);
    let (decay, translational) =
        (ExponentialDecay::fitted(&curve), TranslationalFriction::fitted(&curve));
    let fast_velocity = found.fast_velocity.clone().ok().filter(|fast| *fast > 0.0);
    let mut warnings = done.warnings.clone();
    let (level, sliding) = (found.law.static_coefficient(), curve.coefficients[0]);
    if fast_velocity.is_none() && level > (1.0 + TOLERANCE) * sliding {
        warnings.push(format!(
            "The static coefficient {level} is above the sliding one at rest, {sliding:.6}. It does not enter the table."
        ));
    }
    let normal_load = found.normal_load;
    let peak = match fast_velocity {
        None if sliding > 0.0 => (level / sliding).max(1.0),
        _ => 1.0,
    };
    Ok(FrictionExport { normal_load, table, decay, translational, peak, fast_velocity, warnings })
}

/// Slip speeds from 0 to `fastest`, and the averaged coefficients.
fn averaged(
    study: &SystemStudy,
    own: &ContactAverages<'_>,
    fastest: f64,
) -> Result<(Vec<f64>, Vec<f64>), Failure> {
    if fastest.is_nan() || fastest <= 0.0 {
        return Err(failed("a table needs slip velocities other than 0".to_owned()));
    }
    // The grid of pictures is fine at corners; equal steps cover the rest.
    let steps = (0..=STEPS).map(|k| fastest * f64::from(k) / f64::from(STEPS));
    let grid = own.grid().into_iter().filter(|speed| *speed > 0.0);
    let mut ends: Vec<f64> = grid.filter(|speed| *speed < fastest).chain(steps).collect();
    ascending(&mut ends);
    ends.dedup_by(|later, earlier| *later - *earlier < NEAR * fastest);
    let mut speeds = vec![ends[0]];
    for pair in ends.windows(2) {
        speeds.extend([pair[0].midpoint(pair[1]), pair[1]]);
    }
    let points = own.points(&speeds);
    let mut coefficients = Vec::with_capacity(speeds.len());
    for (index, point) in points.into_iter().enumerate() {
        let found = match point.effective {
            Err(why) if index == 0 => {
                let near = own.points(&[LIMIT * fastest]);
                near.into_iter().next().map_or(Err(why), |point| point.effective)
            }
            found => found,
        };
        let found = found.map_err(|why| {
            let speed = velocity_in_words(study, point.slip_velocity);
            failed(format!("the average at the slip speed {speed} has no value: {why}"))
        })?;
        // Rounding of an average that vanishes is not friction that drives.
        let is_zero = found.coefficient.abs() <= found.coefficient_error;
        coefficients.push(if is_zero { 0.0 } else { found.coefficient });
    }
    Ok((speeds, coefficients))
}

/// Rejects friction that depends on the direction of slip, which no table over the slip speed has.
fn same_in_both_directions(
    study: &SystemStudy,
    own: &ContactAverages<'_>,
    (speeds, coefficients): (&[f64], &[f64]),
    largest: f64,
) -> Result<(), Failure> {
    let fastest = speeds.last().copied().unwrap_or_default();
    let places = COMPARED.map(|share| {
        speeds.partition_point(|speed| *speed < share * fastest).min(speeds.len() - 1)
    });
    let backward: Vec<f64> = places.iter().map(|place| -speeds[*place]).collect();
    let points = own.points(&backward);
    for (place, point) in places.into_iter().zip(points) {
        let Ok(found) = point.effective else { continue };
        let sum = found.coefficient + coefficients[place];
        if sum.abs() > ONE_SIDED * largest + 2.0 * found.coefficient_error {
            let speed = velocity_in_words(study, speeds[place]);
            return Err(failed(format!(
                "the averaged friction depends on the direction of slip: {} forward and {} backward at the slip speed {speed}; \
                 these programs have one coefficient for both",
                coefficients[place], -found.coefficient
            )));
        }
    }
    Ok(())
}

fn failed(why: String) -> Failure {
    Failure::Failed { key: "--save".to_owned(), why: why.into() }
}
