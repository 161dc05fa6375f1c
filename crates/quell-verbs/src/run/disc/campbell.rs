//! The Campbell diagram: frequency and growth of every motion of the undithered disc against speed, and the largest growth
//! under dither.

use quell_disc::dithered;
use quell_disc::undithered::campbell;
use quell_numerics::floquet::Effort;

use super::overflowed;
use crate::complaint::Failure;
use crate::study::DiscStudy;

/// Number of speeds of the diagram.
const SPEEDS: usize = 401;

/// Smallest upper end of the diagram.
const LEAST_END: f64 = 1.0;

/// Upper end of the diagram of a study, so that its own speed is well inside.
pub fn usual_end(study: &DiscStudy) -> f64 {
    LEAST_END.max(1.25 * study.disc().speed().abs())
}

/// Frequency and growth against speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Campbell {
    /// Speeds Ω in ω_ref, ascending.
    pub speeds: Vec<f64>,
    /// For each speed, (|Im ρ|, Re ρ) in ω_ref of every motion, without conjugates.
    pub motions: Vec<Vec<(f64, f64)>>,
    /// For each speed, the largest growth rate under dither, in ω_ref; `None` without dither.
    pub dithered: Option<Vec<f64>>,
}

/// The diagram over 0 ≤ Ω ≤ `last`. Contributions that the study leaves out are included.
///
/// # Errors
/// [`Failure::Failed`] if a matrix overflows.
pub fn run(study: &DiscStudy, last: f64) -> Result<Campbell, Failure> {
    let failed = |why| overflowed("campbell", why);
    let speeds: Vec<f64> = (0..SPEEDS).map(|k| last * (k as f64 / (SPEEDS - 1) as f64)).collect();
    // A friction law requires sliding.
    let speeds: Vec<f64> =
        speeds.into_iter().filter(|speed| study.disc().at_speed(*speed).is_ok()).collect();
    let columns = campbell(study.disc(), &speeds).map_err(failed)?;
    let motions = columns
        .iter()
        .map(|values| {
            let upper = values.iter().filter(|value| value.im >= 0.0);
            upper.map(|value| (value.im, value.re)).collect()
        })
        .collect();
    let mut dithered = Vec::new();
    for &speed in &speeds {
        let Ok(disc) = study.disc().at_speed(speed) else { continue };
        if let Some(prepared) =
            dithered::prepared(&disc).map_err(|why| overflowed("campbell", why))?
        {
            dithered.push(prepared.growth(1.0, Effort::default()).map_err(failed)?.rate);
        }
    }
    let dithered = (dithered.len() == speeds.len()).then_some(dithered);
    Ok(Campbell { speeds, motions, dithered })
}
