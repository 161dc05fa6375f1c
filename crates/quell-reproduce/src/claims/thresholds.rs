//! Claims about the thresholds of figures 2.7, 2.10 and 2.11 by averaging, and how the dissertation probably computed them.

use quell_linear::averaging::{Averaging, FastMotion, FastWave, effective};
use quell_model::{LawKind, Waveform};

use super::super::failure::failed;
use super::chapter2::{LIGHT, belt_at, critical, law};
use super::sheet::{ClaimSheet, digits};
use quell::complaint::Failure;

/// "Unstable for α_T = 0.43", "stable for α_T > 0.98" at v₀ = 1; 10 ≤ D_T ≤ 15 at v₀ = 1.5.
pub(super) fn tangential(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let rows = [
        (1.0, 0, "2.10", Some("0.43"), "4.3"),
        (1.0, 1, "2.10", Some("0.98"), "9.8"),
        (1.5, 0, "2.11", None, "10"),
        (1.5, 1, "2.11", None, "15"),
    ];
    for (velocity, which, figure, ratio, amplitude) in rows {
        let belt = belt_at(LawKind::Decreasing, velocity)?;
        let found = critical(&belt, Averaging::Limit)?.get(which).copied();
        let finite_r = critical(&belt, Averaging::FiniteR)?.get(which).copied();
        let place = format!("Figures 2.7, {figure}");
        let becomes = ["unstable", "stable again"][which];
        let statement = format!("averaging, v₀ = {velocity}: {becomes} from");
        let stem = format!("2.7-v{velocity}-{}", ["unstable", "stable"][which]);
        if let Some(printed) = ratio {
            let value = found.map(|change| change.amplitude_ratio);
            let (name, statement) = (format!("{stem}-ratio"), format!("{statement} α ="));
            sheet.truncated([&name, &place, &statement], printed, value.as_slice());
        }
        let value = found.map(|change| change.amplitude);
        let finite_r = finite_r.map_or_else(String::new, |change| {
            format!("with the exact fast motion {}", digits(change.amplitude, 6))
        });
        let statement = format!("{statement} D_T =");
        sheet.truncated([&stem, &place, &statement], amplitude, value.as_slice()).note(finite_r);
    }
    by_differences(sheet)
}

/// α at which sliding at v₀ = 1 becomes stable again if the slope of μ̄ is a central difference with the step v_m/10. Averaging
/// gives α = v₀ = 1, where μ̄ has a corner; the difference sees the corner one step earlier.
fn by_differences(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let law = law(LawKind::Decreasing)?;
    let step = 0.1 * law.velocity_scale();
    let damping = |alpha: f64| -> Result<f64, Failure> {
        let motion = FastMotion::single(FastWave::Integral(Waveform::Sine), alpha);
        let at = |v: f64| {
            let found = effective(&law, &motion, v).map_err(|error| failed("claims", &error))?;
            Ok::<f64, Failure>(found.coefficient)
        };
        Ok(2.0 * LIGHT + (at(1.0 + step)? - at(1.0 - step)?) / (2.0 * step))
    };
    let (mut unstable, mut stable) = (0.8, 1.0);
    if damping(unstable)? >= 0.0 || damping(stable)? <= 0.0 {
        return Err(failed("claims", &"central differences do not change sign below α = v₀"));
    }
    while stable - unstable > 1e-12 {
        let middle = 0.5 * (unstable + stable);
        *(if damping(middle)? < 0.0 { &mut unstable } else { &mut stable }) = middle;
    }
    for (suffix, words, printed, value) in
        [("ratio", "α =", "0.98", stable), ("amplitude", "D_T =", "9.8", 10.0 * stable)]
    {
        sheet
            .truncated(
                [
                    &format!("2.7-v1-stable-difference-{suffix}"),
                    "Figures 2.7, 2.10",
                    &format!("the same with the slope of μ̄ as a central difference with the step v_m/10: {words}"),
                ],
                printed,
                &[value],
            )
            .note("averaging gives α = v₀ = 1 exactly, where μ̄ has a corner");
    }
    Ok(())
}
