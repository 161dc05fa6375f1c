//! The common period of the dithers.

use std::f64::consts::TAU;

use quell_model::{Belt, Dither};

use super::no_orbit::NoOrbit;

/// Frequencies are commensurate if their ratio is a fraction with a denominator up to this.
const DENOMINATORS: u32 = 64;

/// The common period of the dithers.
///
/// # Errors
/// [`NoOrbit::NoDither`], [`NoOrbit::Incommensurate`].
pub fn common_period(belt: &Belt) -> Result<f64, NoOrbit> {
    let rates: Vec<f64> = belt.dithers().iter().map(Dither::repetition_ratio).collect();
    let Some(&first) = rates.first() else { return Err(NoOrbit::NoDither) };
    for count in 1..=DENOMINATORS {
        let period = f64::from(count) * TAU / first;
        let whole = |rate: &f64| {
            let cycles = rate * period / TAU;
            (cycles - cycles.round()).abs() <= 1e-12 * cycles.max(1.0)
        };
        if rates.iter().all(whole) {
            return Ok(period);
        }
    }
    Err(NoOrbit::Incommensurate)
}
