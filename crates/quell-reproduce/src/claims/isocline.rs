//! Claims about the contour E = 5 % of figures 2.8, 2.9, 3.10, 3.11, 4.9 and 4.10 compared with D = α*R.
//!
//! E decreases continuously to 0 at the threshold of averaging, so that 5 % is reached below it, also for
//! R → ∞; the ratio D(5 %)/(α*R) measures by how much.

use quell_dynamics::response::{Solver, amplitude_at_efficiency};
use quell_dynamics::simulation::Start;
use quell_linear::averaging::{Becomes, FastResponse};
use quell_model::{Direction, LawKind, Waveform};
use rayon::prelude::*;

use super::super::failure::failed;
use super::chapter2::{LIGHT, SUPPRESSED, belt, critical};
use super::sheet::ClaimSheet;
use quell::complaint::Failure;

/// Relative tolerance of D.
const CLOSENESS: f64 = 1e-4;

/// Settling time; near the threshold the decreasing law settles slowly.
const SETTLE: f64 = 1200.0;

/// "Coincides almost exactly" is taken as within a tenth.
const COINCIDES: f64 = 0.1;

/// A point of the contour: law, waveform, v₀ and R.
type IsolinePoint = (LawKind, Waveform, f64, f64);

const LAWS: [LawKind; 2] = [LawKind::Stribeck, LawKind::Decreasing];

/// Every combination of laws, waveforms, belt velocities and frequency ratios.
fn points(waveforms: &[Waveform], velocities: &[f64], ratios: &[f64]) -> Vec<IsolinePoint> {
    let mut points = Vec::new();
    for law in LAWS {
        for &waveform in waveforms {
            for &velocity in velocities {
                points.extend(ratios.iter().map(|&ratio| (law, waveform, velocity, ratio)));
            }
        }
    }
    points
}

/// D(5 %)/(α*R) of each point. The crossing is searched from 0.7 to 1.15 α*R.
fn ratios(direction: Direction, points: &[IsolinePoint]) -> Result<Vec<f64>, Failure> {
    let solver = Solver { settle: SETTLE, ..Solver::default() };
    points
        .par_iter()
        .map(|&(kind, waveform, velocity, ratio)| {
            let missing = |what: &str| failed("claims", &format!("{what} at R = {ratio}"));
            // This amplitude is ignored: both methods set it.
            let dither = (direction, waveform, 0.5, ratio);
            let belt = belt(kind, LIGHT, velocity, Some(dither))?;
            let amplitude = critical(&belt, FastResponse::Limit)?
                .into_iter()
                .find(|found| found.becomes == Becomes::Stable)
                .ok_or_else(|| missing("no averaged threshold"))?
                .amplitude;
            // Normal dither above F would open the contact.
            let most = match direction {
                Direction::Tangential => f64::INFINITY,
                Direction::Normal => 0.999 * belt.normal_load(),
            };
            let range = 0.7 * amplitude..=most.min(1.15 * amplitude);
            amplitude_at_efficiency(&belt, Start::REST, &solver, SUPPRESSED, range, CLOSENESS)
                .map(|found| found / amplitude)
                .ok_or_else(|| missing("no crossing of 5 %"))
        })
        .collect()
}

fn extent(values: &[f64]) -> [f64; 2] {
    values
        .iter()
        .fold([f64::INFINITY, 0.0], |[least, most], &value| [value.min(least), value.max(most)])
}

/// Tangential dither: R = 5, 10, 20.
pub(super) fn tangential(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let four = [0.05, 0.1, 0.125, 0.15];
    let three = [0.05, 0.1, 0.15];
    let others = [Waveform::Triangle, Waveform::Square];
    for ratio in [5.0, 10.0, 20.0] {
        for (name, place, waveforms, velocities) in [
            ("2.8", "Figures 2.8, 2.9", &[Waveform::Sine][..], &four[..]),
            ("3.10", "Figures 3.10, 3.11", &others[..], &three[..]),
        ] {
            let found = ratios(Direction::Tangential, &points(waveforms, velocities, &[ratio]))?;
            let extent = extent(&found);
            let [name, statement] = [
                format!("{name}-isocline-{ratio}"),
                format!("E = 5 % coincides almost exactly with D = α*R: D/(α*R), R = {ratio}"),
            ];
            sheet
                .number_within(COINCIDES, [&name, place, &statement], "1.00", &extent)
                .note(format!(
                    "smallest and largest ratio of {} cases; always below 1, because E decreases continuously to 0 at the \
                     threshold, also for R → ∞",
                    found.len()
                ));
        }
    }
    Ok(())
}

/// Normal dither, sine, v₀ of figures 4.9 and 4.10: R_N = 4…7.
pub(super) fn normal(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    for (law, place, name) in [
        (LawKind::Stribeck, "Figure 4.9", "4.9-isocline"),
        (LawKind::Decreasing, "Figure 4.10", "4.10-isocline"),
    ] {
        let rows = [4.0, 5.0, 6.0, 7.0].map(|ratio| (law, Waveform::Sine, 0.05, ratio));
        let found = ratios(Direction::Normal, &rows)?;
        let statement = "E = 5 % coincides with D = α*R: D/(α*R), R_N = 4, 5, 6, 7";
        sheet.number_within(COINCIDES, [name, place, statement], "1.00", &found);
    }
    Ok(())
}
