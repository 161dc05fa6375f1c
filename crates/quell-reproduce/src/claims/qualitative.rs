//! Statements of chapters 2 to 4 that are made in words: slopes, curvature, ranges, transients.

use std::f64::consts::PI;

use quell::parallel::Parallel;
use quell_dynamics::attractor::AttractorSettings;
use quell_dynamics::response::{ResponsePlan, Solver, respond};
use quell_dynamics::simulation::Start;
use quell_linear::averaging::{Averaging, Becomes, FastMotion, FastWave, closed_band, effective};
use quell_model::waveform::Burst;
use quell_model::{Belt, Direction, LawKind, Waveform};
use quell_numerics::quadrature::{QuadratureOptions, integrate};

use super::super::failure::failed;
use super::chapter2::{LIGHT, belt, critical, law};
use super::sheet::{ClaimSheet, digits, list, shares};
use quell::complaint::Failure;

/// (2.23): the slow motion rests at Z̄ = μ̄(v₀)F. Measured: the mean displacement of the dithered response.
pub(super) fn equilibrium(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let (speed, alpha) = (0.05, 0.06);
    let friction = law(LawKind::Stribeck)?;
    let motion = FastMotion::single(FastWave::Integral(Waveform::Sine), alpha);
    let expected =
        effective(&friction, &motion, speed).map_err(|error| failed("claims", &error))?.coefficient;
    let ratios = [20.0, 40.0, 80.0];
    let means = ratios
        .in_parallel(|&ratio| -> Result<f64, Failure> {
            let dither = (Direction::Tangential, Waveform::Sine, alpha * ratio, ratio);
            let belt = belt(LawKind::Stribeck, LIGHT, speed, Some(dither))?;
            let response = respond(
                &belt.system(),
                &Start::REST.into(),
                &ResponsePlan::from(&Solver::default()),
            )
            .map_err(|error| failed("claims", &error))?;
            Ok(response.dithered.observed.mean() / expected - 1.0)
        })
        .collect::<Result<Vec<f64>, Failure>>()?;
    let falls = means.windows(2).all(|pair| pair[1].abs() < pair[0].abs());
    sheet
        .statement(
            ["2.23", "(2.23)", "the slow motion has its equilibrium at Z̄ = μ̄(v₀)F"],
            format!("mean displacement against μ̄(v₀)F at R = 20, 40, 80: off by {}", list(&means)),
            &means,
            falls && means.last().is_some_and(|off| off.abs() < 0.02),
        )
        .note("Stribeck law, v₀ = 0.05, α = 0.06, where the dither quenches; printed as −μ̄(−v₀)F, and μ̄ is odd");
    Ok(())
}

/// "As the threshold amplitude is approached, the time duration of the transient grows longer": 1/rate of the exact response.
pub(super) fn transients(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let amplitudes = [3.5, 4.0, 4.2, 4.3, 4.32];
    let times = amplitudes
        .in_parallel(|&amplitude| -> Result<f64, Failure> {
            let dither = (Direction::Tangential, Waveform::Sine, amplitude, 10.0);
            let belt = belt(LawKind::Decreasing, LIGHT, 1.0, Some(dither))?;
            let settings = AttractorSettings::new(&belt).map_err(|why| failed("claims", &why))?;
            let base = settings.base.as_ref().map_err(|why| failed("claims", why))?;
            Ok(-settings.section.period / libm::log(base.radius))
        })
        .collect::<Result<Vec<f64>, Failure>>()?;
    sheet
        .statement(
            [
                "2.3-transients",
                "before (2.9), text of figure 2.11",
                "as the boundary is approached, the duration of the transients becomes longer and longer",
            ],
            format!("decay time τ at D_T = 3.5, 4, 4.2, 4.3, 4.32: {}", list(&times)),
            &times,
            times[0] > 0.0 && times.windows(2).all(|pair| pair[1] > pair[0]) && times[4] > 1e4,
        )
        .note("exact multipliers of the response of figure 2.10, which loses its stability at D_T = 4.3224");
    Ok(())
}

/// "Because the upper edge of the shaded region increases with α_T": figure 2.7.
pub(super) fn upper_edge(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let law = law(LawKind::Decreasing)?;
    let edges: Vec<f64> = (0..=40)
        .map(|k| 0.05 * f64::from(k))
        .filter_map(|alpha| closed_band(&law, LIGHT, 1.0, &Waveform::Sine, alpha).ok()?.upper)
        .collect();
    let rises = edges.len() == 41 && edges.windows(2).all(|pair| pair[1] > pair[0]);
    let ends = [edges.first(), edges.last()].map(|edge| edge.copied().unwrap_or(f64::NAN));
    sheet.statement(
        ["2.7-upper-edge", "Figure 2.7", "decreasing: the upper edge increases with α_T"],
        format!("from {} at α = 0 to {} at α = 2", digits(ends[0], 4), digits(ends[1], 4)),
        &edges,
        rises,
    );
    Ok(())
}

/// "When the undithered system is unstable, it is always possible to find a tangential dither signal that stabilizes the system":
/// chapters 2 and 6, the decreasing law.
pub(super) fn always_quenched(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let speeds: Vec<f64> = (1..=40).map(|k| 0.02 * f64::from(k)).collect();
    let cases: Vec<(f64, &Waveform)> = speeds
        .iter()
        .flat_map(|speed| Waveform::NAMED.iter().map(move |waveform| (*speed, waveform)))
        .collect();
    let found = cases
        .in_parallel(|&(speed, waveform)| -> Result<f64, Failure> {
            let ratio = 20.0;
            let with = |amplitude: f64| {
                let dither = (Direction::Tangential, waveform.clone(), amplitude, ratio);
                belt(LawKind::Decreasing, LIGHT, speed, Some(dither))
            };
            let last = critical(&with(1.0)?, Averaging::Limit)?.pop();
            let Some(last) = last.filter(|change| change.becomes == Becomes::Stable) else {
                return Ok(f64::NAN);
            };
            // Beyond the averaged amplitude the exact response is stable.
            let belt = with(1.05 * last.amplitude)?;
            let settings = AttractorSettings::new(&belt).map_err(|why| failed("claims", &why))?;
            let base = settings.base.as_ref().map_err(|why| failed("claims", why))?;
            Ok(base.radius)
        })
        .collect::<Result<Vec<f64>, Failure>>()?;
    let stable = found.iter().filter(|radius| **radius < 1.0).count();
    sheet
        .statement(
            [
                "6-always-quenched",
                "chapters 2, 6",
                "decreasing: where the undithered system is unstable, a tangential dither that stabilises it always exists",
            ],
            format!("at {stable} of {} belt velocities and waveforms", found.len()),
            &[stable as f64, found.len() as f64],
            stable == found.len(),
        )
        .note("v₀ from 0.02 to 0.8, three waveforms, R = 20: the exact response at 1.05 times the averaged amplitude");
    Ok(())
}

/// "The effective friction law exhibits a negative slope in the approximate range αG_max ≤ v_r ≤ v_m": chapter 3, Stribeck law.
pub(super) fn negative_slope(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let law = law(LawKind::Stribeck)?;
    let vm = law.velocity_scale();
    let (mut lower, mut upper) = (Vec::new(), Vec::new());
    for waveform in Waveform::NAMED {
        for share in [0.125, 0.25, 0.375, 0.5] {
            let alpha = share * vm;
            let corner = alpha * waveform.peak_integral();
            let motion = FastMotion::single(FastWave::Integral(waveform.clone()), alpha);
            let falls = |v: f64| -> Result<bool, Failure> {
                let found =
                    effective(&law, &motion, v).map_err(|error| failed("claims", &error))?;
                Ok(found.slope < 0.0)
            };
            let grid: Vec<f64> = (1..=800).map(|k| vm * f64::from(k) / 640.0).collect();
            let mut negative = Vec::new();
            for v in grid {
                if falls(v)? {
                    negative.push(v);
                }
            }
            let (Some(first), Some(last)) = (negative.first(), negative.last()) else { continue };
            lower.push(first / corner);
            upper.push(last / vm);
        }
    }
    let ends = |values: &[f64]| {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        [least, values.iter().copied().fold(0.0, f64::max)]
    };
    let place = "after (3.39), Figure 3.3";
    sheet
        .number_within(
            0.02,
            [
                "3.3-negative-from",
                place,
                "Stribeck: the slope of μ̄ is negative from v_r/(αG_max) =",
            ],
            "1.00",
            &ends(&lower),
        )
        .note("least and largest of three waveforms and α/v_m = 0.125, 0.25, 0.375, 0.5");
    sheet
        .number_within(
            0.15,
            [
                "3.3-negative-to",
                place,
                "Stribeck: the slope of μ̄ is negative up to v_r/v_m =, approximately",
            ],
            "1.00",
            &ends(&upper),
        )
        .note("exactly √(1 − ⟨G²⟩(α/v_m)²): the end falls as the dither grows");
    Ok(())
}

/// ⟨G²⟩ before (3.29)–(3.31), by quadrature of the waveforms.
pub(super) fn mean_squares(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let printed = [0.5, PI * PI / 30.0, PI * PI / 12.0];
    for ((waveform, printed), equation) in
        Waveform::NAMED.iter().zip(printed).zip(["3.29", "3.30", "3.31"])
    {
        let square = |x: f64| waveform.integral(x).powi(2) / (2.0 * PI);
        let breaks = waveform.breaks();
        let found = integrate(square, 0.0, 2.0 * PI, breaks, &QuadratureOptions::default())
            .map_err(|error| failed("claims", &error))?;
        sheet.formula(
            [
                &format!("{equation}-mean-square"),
                &format!("before ({equation})"),
                &format!(
                    "⟨G²⟩ of the {} waveform",
                    super::super::caption::waveform_name(waveform.clone())
                ),
            ],
            printed,
            found.value,
        );
    }
    Ok(())
}

/// Dzirasa (2002), as chapter 3 reports: "when the duration of the on-segment was reduced below that of the off-segment, dither was
/// unable to control the brake squeal, regardless of the frequency of the dither on-segment".
pub(super) fn bursts(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let shapes = [(4, 2), (3, 3), (2, 4)];
    let ratios = [5.0, 7.0, 9.0];
    let cases: Vec<(f64, (u32, u32))> =
        ratios.iter().flat_map(|ratio| shapes.map(|shape| (*ratio, shape))).collect();
    let found = cases
        .in_parallel(|(ratio, (on, off))| -> Result<f64, Failure> {
            let burst = Burst::new(Waveform::Sine, *on, *off)
                .map_err(|why| failed("claims", &why))?
                .into_waveform();
            let dither = Some((Direction::Normal, burst, 0.99, *ratio));
            let belt: Belt = belt(LawKind::Decreasing, LIGHT, 0.05, dither)?;
            let response = respond(
                &belt.system(),
                &Start::REST.into(),
                &ResponsePlan::from(&Solver::default()),
            )
            .map_err(|error| failed("claims", &error))?;
            response.residual_vibration.map_err(|error| failed("claims", &error))
        })
        .collect::<Result<Vec<f64>, Failure>>()?;
    let short: Vec<f64> = found.chunks(3).map(|row| row[2]).collect();
    let ordered = found.chunks(3).all(|row| row[0] < row[1] && row[1] < row[2]);
    sheet
        .statement(
            [
                "3-bursts",
                "chapter 3, introduction (Dzirasa)",
                "bursts that are shorter than their pauses cannot control the squeal, at any frequency",
            ],
            format!("E of bursts 4 : 2, 3 : 3, 2 : 4 at R_N = 5, 7, 9: {}", shares(&found)),
            &found,
            ordered && short.iter().all(|e| *e > 0.5),
        )
        .note("normal dither of almost the whole load, D_N = 0.99, decreasing law, v₀ = 0.05; an experiment with a brake, here a belt");
    Ok(())
}

/// "The lower boundary of the unstable region is slightly more curved in the normal dither case": figure 4.7.
pub(super) fn lower_edge(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let law = law(LawKind::Stribeck)?;
    let mut curved = Vec::new();
    for direction in [Direction::Tangential, Direction::Normal] {
        let mut edge = Vec::new();
        for k in 1..=20 {
            let v = 0.007 * f64::from(k);
            // α = v₀ of tangential dither; μ(v₀)α_N takes its place.
            let alpha = match direction {
                Direction::Tangential => v,
                Direction::Normal => v / law.coefficient(v),
            };
            edge.push((v, alpha));
        }
        let chord = edge[edge.len() - 1].1 / edge[edge.len() - 1].0;
        let off = edge.iter().map(|(v, alpha)| (alpha / (chord * v) - 1.0).abs());
        curved.push(off.fold(0.0, f64::max));
    }
    // The edges are those of the product.
    for (v, direction) in [(0.05, Direction::Tangential), (0.05, Direction::Normal)] {
        let dither = Some((direction, Waveform::Sine, 0.01, 1.0));
        let found = critical(&belt(LawKind::Stribeck, LIGHT, v, dither)?, Averaging::Limit)?;
        let alpha = found.last().map_or(f64::NAN, |change| change.amplitude_ratio);
        let expected = match direction {
            Direction::Tangential => v,
            Direction::Normal => v / law.coefficient(v),
        };
        if (alpha / expected - 1.0).abs() > 1e-6 {
            return Err(failed("claims", &format!("lower edge {alpha}, not {expected}")));
        }
    }
    sheet
        .statement(
            [
                "4.7-lower-edge",
                "Figures 4.7, 3.5",
                "the lower edge is slightly more curved under normal than under tangential dither",
            ],
            format!(
                "largest distance from a straight line, relative: tangential {}, normal {}",
                digits(curved[0], 2),
                digits(curved[1], 2)
            ),
            &curved,
            curved[1] > curved[0],
        )
        .note("Stribeck law, sine, v₀ up to 0.14: α_T = v₀ is straight, α_N = v₀/μ(v₀) is not");
    Ok(())
}

/// "The location of the friction coefficient slope change in sign … gets closer and closer to the numerical prediction as D_N gets
/// smaller, or as R_N gets larger": before figure 4.5.
pub(super) fn change_of_slope(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    use super::chapter4::tops_of;
    let ratios = [4.0, 5.0, 7.0, 10.0, 14.0];
    for (kind, figure) in [(LawKind::Stribeck, "4.5"), (LawKind::Decreasing, "4.6")] {
        let found = ratios
            .in_parallel(|&ratio| {
                let dither = Some((Direction::Normal, Waveform::Sine, 0.9, ratio));
                tops_of(&belt(kind, LIGHT, 0.05, dither)?)
            })
            .collect::<Result<Vec<[f64; 2]>, Failure>>()?;
        let differences: Vec<f64> = found.iter().map(|[m, a]| (a - m).abs()).collect();
        sheet
            .statement(
                [
                    &format!("{figure}-larger-ratio"),
                    &format!("Figure {figure}"),
                    "the predicted change of slope is closer to the measured one as R_N gets larger",
                ],
                format!("differences of v_r at R_N = 4, 5, 7, 10, 14: {}", list(&differences)),
                &differences,
                differences.windows(2).all(|pair| pair[1] < pair[0]),
            )
            .note("at constant D_N = 0.9; steady responses, stick included");
    }
    Ok(())
}
