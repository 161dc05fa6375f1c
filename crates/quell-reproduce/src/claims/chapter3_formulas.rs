//! Formulas of chapter 3 and appendix B as printed, compared with their definitions.

use std::f64::consts::{FRAC_PI_2, PI};

use quell_linear::averaging::{
    Effective, FastMotion, FastWave, closed_band, effective, effective_by_quadrature,
};
use quell_model::{LawKind, Waveform};
use quell_numerics::quadrature::{QuadratureOptions, integrate};
use quell_numerics::special::exp;

use super::super::failure::failed;
use super::super::printed_formulas::{self, LawNumbers};
use super::chapter2::{LIGHT, law};
use super::sheet::ClaimSheet;
use quell::complaint::Failure;

const NUMBERS: LawNumbers = LawNumbers::DISSERTATION;

/// μ̄ and its slope by quadrature of the definition.
fn definition(kind: LawKind, waveform: Waveform, v: f64, alpha: f64) -> Result<Effective, Failure> {
    effective_by_quadrature(&law(kind)?, &FastWave::Integral(waveform), alpha, v)
        .map_err(|error| failed("claims", &error))
}

/// Printed formulas compared with their definitions, at v_r = 0.08, α = 0.2 unless stated otherwise.
pub(super) fn formulas(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let (v, alpha) = (0.08, 0.2);
    let (decreasing, triangle) = (LawKind::Decreasing, Waveform::Triangle);
    let inside = definition(decreasing, triangle.clone(), v, alpha)?;
    let point = "v_r = 0.08, α = 0.2";
    let at = |what: &str| format!("{what}, {point}");
    let printed = printed_formulas::effective_338a(NUMBERS, v, alpha);
    sheet
        .formula(
            ["3.38a", "(3.38a), (B.10a)", &at("μ̄, decreasing law, triangle")],
            printed,
            inside.coefficient,
        )
        .note("the factor of the error functions is exp(γ − w), not exp(−γ − w)");
    let corner = PI * alpha / 4.0;
    let outside = law(decreasing)
        .and_then(|law| {
            let motion = FastMotion::single(FastWave::Integral(triangle), alpha);
            effective(&law, &motion, corner).map_err(|error| failed("claims", &error))
        })?
        .coefficient;
    sheet
        .formula(
            ["3.38a-corner", "(3.38a)", "μ̄ at v_r = πα/4, where it must agree with (3.38b)"],
            printed_formulas::effective_338a(NUMBERS, corner, alpha),
            outside,
        )
        .note("as printed μ̄ is not continuous");
    sheet
        .formula(
            ["3.53a", "(3.53a)", &at("slope, decreasing law, triangle")],
            printed_formulas::slope_353a(NUMBERS, v, alpha),
            inside.slope,
        )
        .note(
            "the exponent 1/2 should be −1/2, a factor 1/(2√(γ − w)) is missing, and (3.38a) itself is wrong",
        );
    // With v_r inside the bracket, as printed, the sign of a negative slip enters twice.
    let negative = definition(decreasing, Waveform::Square, -v, alpha)?.coefficient;
    sheet
        .formula(
            ["3.36a", "(3.36a)", "μ̄, decreasing law, square, v_r = −0.08, α = 0.2"],
            -printed_formulas::effective_339a(NUMBERS, -v, alpha),
            negative,
        )
        .note("sign(v_r) is a factor of a bracket that is already odd in v_r; the bracket should contain |v_r|");
    stribeck_formulas(sheet, v, alpha)?;
    integrals(sheet, v, alpha)?;
    correct_formulas(sheet)
}

/// The mean square of the triangle in the formulas for the Stribeck law.
fn stribeck_formulas(sheet: &mut ClaimSheet, v: f64, alpha: f64) -> Result<(), Failure> {
    let (stribeck, triangle) = (LawKind::Stribeck, Waveform::Triangle);
    let slope = definition(stribeck, triangle.clone(), v, alpha)?.slope;
    sheet
        .formula(
            ["3.45a", "(3.45a)", "slope, Stribeck law, triangle, v_r = 0.08, α = 0.2"],
            printed_formulas::slope_345a(NUMBERS, v, alpha),
            slope,
        )
        .note("π²/16 should be π²/10");
    let slope = definition(stribeck, triangle.clone(), 0.18, 0.15)?.slope;
    sheet
        .formula(
            ["3.45b", "(3.45b)", "slope, Stribeck law, triangle, v_r = 0.18, α = 0.15"],
            printed_formulas::slope_345b(NUMBERS, 0.18, 0.15),
            slope,
        )
        .note("π²/16 should be π²/10");
    let upper =
        closed_band(&law(stribeck)?, LIGHT, 1.0, &triangle, 0.15).ok().and_then(|band| band.upper);
    sheet
        .formula(
            ["3.47", "(3.46), (3.47)", "upper edge, Stribeck law, triangle, ζ = 0.005, α = 0.15"],
            printed_formulas::upper_edge_347(NUMBERS, LIGHT, 0.15),
            upper.unwrap_or(f64::NAN),
        )
        .note("π²/48 should be π²/30");
    Ok(())
}

/// (B.3)–(B.5): integrals of appendix B.
fn integrals(sheet: &mut ClaimSheet, v: f64, alpha: f64) -> Result<(), Failure> {
    let vm = NUMBERS.vm;
    let crossing = (PI * (PI / 4.0 - v / alpha)).sqrt();
    let integral = |from: f64, to: f64, sign: f64| {
        integrate(
            |x| exp(sign * (v + alpha * Waveform::Triangle.integral(x)) / vm),
            from,
            to,
            &[FRAC_PI_2, 3.0 * FRAC_PI_2],
            &QuadratureOptions::default(),
        )
        .map(|integral| integral.value)
        .map_err(|error| failed("claims", &error))
    };
    let [first, second] =
        [integral(0.0, crossing, 1.0)?, integral(crossing, 2.0 * PI - crossing, -1.0)?];
    let point = "v_r = 0.08, α = 0.2";
    sheet
        .formula(
            ["B.3", "(B.3)", &format!("integral over 0…Rτ₁, {point}")],
            printed_formulas::integral_b3(NUMBERS, v, alpha),
            first,
        )
        .note("the exponent (v_r − πα/v_m)/v_m should be v_r/v_m − πα/(4v_m)");
    sheet
        .formula(
            ["B.4", "(B.4)", &format!("integral over Rτ₁…Rτ₂, {point}")],
            printed_formulas::integral_b4(NUMBERS, v, alpha),
            second,
        )
        .note("the same error as in (3.38a), which follows from it");
    sheet
        .formula(
            ["B.5", "(B.5)", &format!("integral over Rτ₂…2π, {point}")],
            printed_formulas::integral_b5(NUMBERS, v, alpha),
            first,
        )
        .note("the exponent v_r/v_m − πα/4 should be v_r/v_m − πα/(4v_m)");
    Ok(())
}

/// Formulas that are correct as printed.
fn correct_formulas(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let (b0, b1, vm) = (NUMBERS.minimum, NUMBERS.difference(), NUMBERS.vm);
    let (v, alpha) = (0.08, 0.2);
    let square = definition(LawKind::Decreasing, Waveform::Square, v, alpha)?;
    let decay = exp(-PI * alpha / (2.0 * vm));
    let printed = printed_formulas::effective_339a(NUMBERS, v, alpha);
    sheet.formula(
        ["3.39a", "(3.39a)", "μ̄, decreasing law, square, v_r = 0.08, α = 0.2"],
        printed,
        square.coefficient,
    );
    let printed = 2.0 * b0 / (PI * alpha) + 2.0 * b1 / (PI * alpha) * decay * libm::cosh(v / vm);
    sheet.formula(["3.57a", "(3.57a)", "its slope"], printed, square.slope);
    let outside = definition(LawKind::Decreasing, Waveform::Square, 0.4, alpha)?.coefficient;
    let printed =
        b0 + 2.0 * b1 * vm / (PI * alpha) * exp(-0.4 / vm) * libm::sinh(PI * alpha / (2.0 * vm));
    sheet.formula(
        ["3.39b", "(3.39b)", "μ̄, decreasing law, square, v_r = 0.4, α = 0.2"],
        printed,
        outside,
    );
    let a3 = 0.5 * b1 / vm.powi(3);
    let sine = definition(LawKind::Stribeck, Waveform::Sine, v, alpha)?.slope;
    let printed = 2.0 * NUMBERS.static_level / (PI * (alpha * alpha - v * v).sqrt())
        - 1.5 * b1 / vm
        + 1.5 * a3 * alpha * alpha
        + 3.0 * a3 * v * v;
    sheet.formula(
        ["3.41a", "(3.41a)", "slope, Stribeck law, sine, v_r = 0.08, α = 0.2"],
        printed,
        sine,
    );
    Ok(())
}
