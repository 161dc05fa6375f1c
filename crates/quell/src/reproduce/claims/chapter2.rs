//! Claims of chapter 2: friction laws, responses under sinusoidal tangential dither, averaging.

use quell_belt::averaging::{
    AveragingOptions, Becomes, CriticalAmplitude, Response as FastResponse, closed_band,
    critical_amplitudes,
};
use quell_belt::response::{Solver, respond};
use quell_belt::simulation::{EventKind, EventRecorder, Sampler, Start, simulate};
use quell_model::{Belt, Direction, Dither, Friction, LawKind, Waveform};

use super::super::responses::{Case, cases, fundamental};
use super::super::source::failed;
use super::super::{ENTRIES, Source};
use super::sheet::{Sheet, digits, list};
use crate::complaint::Failure;

/// Below this share of the undithered vibration the dissertation calls it suppressed (figure 2.8 takes 5 %).
pub(super) const SUPPRESSED: f64 = 0.05;

/// Damping ratio of most figures.
pub(super) const LIGHT: f64 = 0.005;

/// The dissertation's law of a kind.
pub(super) fn law(kind: LawKind) -> Result<Friction, Failure> {
    kind.build(&[0.4, 0.2857, 0.2]).map_err(|_| failed("claims", &"the law is not valid"))
}

/// A belt with one dither, F = 1.
pub(super) fn belt(
    kind: LawKind,
    damping_ratio: f64,
    belt_velocity: f64,
    dither: Option<(Direction, Waveform, f64, f64)>,
) -> Result<Belt, Failure> {
    let dithers = dither.map(|(direction, waveform, amplitude, frequency_ratio)| Dither {
        direction,
        waveform,
        amplitude,
        frequency_ratio,
        phase: 0.0,
    });
    Belt::new(damping_ratio, 1.0, belt_velocity, law(kind)?, dithers.into_iter().collect())
        .map_err(|_| failed("claims", &"the belt is not valid"))
}

/// The study of a figure.
pub(super) fn source(name: &str) -> Result<Source, Failure> {
    ENTRIES
        .iter()
        .find(|entry| entry.name == name)
        .map(super::super::Entry::source)
        .ok_or_else(|| failed("claims", &format!("there is no figure {name}")))
}

/// E of each case, where it is defined.
pub(super) fn efficiencies(cases: &[Case]) -> Vec<f64> {
    cases.iter().filter_map(|case| case.response.efficiency.ok()).collect()
}

/// Whether E lies between suppression and no effect.
pub(super) fn partial(efficiency: f64) -> bool {
    (SUPPRESSED..1.0).contains(&efficiency)
}

/// Critical amplitudes of averaging, where the exact fast motion may take the place of αG.
pub(super) fn critical(
    belt: &Belt,
    response: FastResponse,
) -> Result<Vec<CriticalAmplitude>, Failure> {
    let options = AveragingOptions { response, ..AveragingOptions::default() };
    critical_amplitudes(belt, options).map_err(|error| failed("claims", &error))
}

/// Fundamental of the undithered stick-slip, from the exact times at which the mass sticks.
fn stick_slip_frequency(belt: &Belt) -> Result<f64, Failure> {
    let mut recorder = EventRecorder::default();
    let tolerance = Solver::default().tolerance;
    simulate(belt, Start::REST, 600.0, tolerance, &mut recorder)
        .map_err(|error| failed("claims", &error))?;
    let sticks: Vec<f64> = recorder
        .events
        .iter()
        .filter(|event| event.kind == EventKind::Stick)
        .map(|event| event.time)
        .collect();
    match sticks.as_slice() {
        [.., before, last] => Ok(std::f64::consts::TAU / (last - before)),
        _ => Err(failed("claims", &"the undithered belt does not stick")),
    }
}

/// Figures 2.2, 2.3: laws and the undithered cycle.
pub(super) fn friction_laws(sheet: &mut Sheet) -> Result<(), Failure> {
    let undithered = belt(LawKind::Stribeck, LIGHT, 0.05, None)?;
    let frequency = stick_slip_frequency(&undithered)?;
    sheet
        .number(
            "2.3-undithered-fundamental",
            "Figures 2.3, 3.7",
            "fundamental of the undithered stick-slip, Stribeck law (ω₀)",
            "0.666",
            &[frequency],
        )
        .note("a record of 66 or 94.25 has a spectral line at 0.666");
    let misprinted = undithered
        .with("friction.minimum_coefficient", 0.2587)
        .map_err(|_| failed("claims", &"the misprinted law is not valid"))?;
    sheet
        .number(
            "2.2-minimum-coefficient",
            "before Figure 2.2, Figure 4.2",
            "the same fundamental with μ_m = 0.2587",
            "0.666",
            &[stick_slip_frequency(&misprinted)?],
        )
        .note("so 0.2587 is a misprint of 0.2857");
    let decreasing = law(LawKind::Decreasing)?;
    let share = (decreasing.coefficient(decreasing.velocity_scale()) - 0.2857) / (0.4 - 0.2857);
    sheet.number(
        "2.8-share-at-reference",
        "after (2.8)",
        "(μ − μ_m)/(μ_s − μ_m) at v_m",
        "0.368",
        &[share],
    );
    Ok(())
}

/// Figure 2.3.
pub(super) fn responses(sheet: &mut Sheet) -> Result<(), Failure> {
    let cases = cases(&source("2.3")?)?;
    let found = efficiencies(&cases);
    let dithered = fundamental(&cases[0].response.record.spectrum);
    sheet
        .number(
            "2.3-dithered-fundamental",
            "Figure 2.3(a)",
            "fundamental at D_T = 0.3 (ω₀)",
            "0.746",
            dithered.as_slice(),
        )
        .note("locked to the dither at 10·5/68");
    let stuck = |case: &Case| {
        let samples = &case.response.undithered_record.samples;
        samples.iter().filter(|sample| sample.sticking).count() as f64 / samples.len() as f64
    };
    let (with, without) = (cases[0].response.stick_fraction, stuck(&cases[0]));
    sheet.statement(
        [
            "2.3-stick-durations",
            "Figure 2.3(a)",
            "sticking is a great deal shorter than without dither",
        ],
        format!("stick fraction {} against {}", digits(with, 3), digits(without, 3)),
        &[with, without],
        with < 0.7 * without,
    );
    let names = ["2.3-partial", "Figure 2.3(a), (b)", "partial cancellation at D_T = 0.3, 0.4"];
    sheet.statement(
        names,
        format!("E = {}", list(&found[..2])),
        &found[..2],
        found[..2].iter().all(|e| partial(*e)),
    );
    let names =
        ["2.3-suppressed", "Figure 2.3(c)", "self-excited vibration suppressed at D_T = 0.5"];
    sheet.statement(names, format!("E = {:.4}", found[2]), &found[2..], found[2] < SUPPRESSED);
    let peaks = &cases[2].response.peaks;
    let strongest = peaks.iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
    sheet.number(
        "2.3-forced-frequency",
        "Figure 2.3(c)",
        "frequency of what remains at D_T = 0.5 (ω₀)",
        "10",
        &strongest.map(|peak| peak.frequency).into_iter().collect::<Vec<_>>(),
    );
    Ok(())
}

/// "The amplitude of the steady-state response can be reduced further by decreasing the dither frequency ratio."
pub(super) fn forced_response(sheet: &mut Sheet) -> Result<(), Failure> {
    let amplitude = |ratio: f64| -> Result<f64, Failure> {
        let dither = Some((Direction::Tangential, Waveform::Sine, 0.5, ratio));
        let belt = belt(LawKind::Stribeck, LIGHT, 0.05, dither)?;
        let response = respond(&belt, Start::REST, &Solver::default())
            .map_err(|error| failed("claims", &error))?;
        let near = response.peaks.iter().filter(|peak| (peak.frequency - ratio).abs() < 0.1);
        Ok(near.map(|peak| peak.amplitude).fold(0.0, f64::max))
    };
    let ratios = [10.0, 9.0, 8.0];
    let amplitudes = ratios.map(amplitude).into_iter().collect::<Result<Vec<f64>, Failure>>()?;
    let holds = amplitudes.windows(2).all(|pair| pair[1] < pair[0]);
    let linear: Vec<f64> = ratios.iter().map(|r| 0.5 / (r * r - 1.0)).collect();
    sheet
        .statement(
            [
                "2.3-forced-amplitude",
                "before Figure 2.3",
                "the steady amplitude can be reduced further by decreasing the frequency ratio",
            ],
            format!("amplitude at R = 10, 9, 8: {}", list(&amplitudes)),
            &amplitudes,
            holds,
        )
        .note(format!("the forced part is D/(R² − 1) = {}: it grows", list(&linear)));
    Ok(())
}

/// Figures 2.6 and 2.7.
pub(super) fn stability_maps(sheet: &mut Sheet) -> Result<(), Failure> {
    let stribeck = law(LawKind::Stribeck)?;
    let decreasing = law(LawKind::Decreasing)?;
    let upper = |law: &Friction, alpha: f64| {
        closed_band(law, LIGHT, 1.0, Waveform::Sine, alpha).and_then(|band| band.upper)
    };
    let stable_above: Vec<f64> = upper(&stribeck, 0.0).into_iter().collect();
    sheet.number(
        "2.6-undithered",
        "Figure 2.6",
        "Stribeck: undithered sliding is stable above v₀",
        "0.2",
        &stable_above,
    );
    let tip = 0.2 * (2.0 / 3.0 * (1.0 - 4.0 * 0.2 * LIGHT / (3.0 * (0.4 - 0.2857)))).sqrt();
    sheet.number(
        "2.6-linear-up-to",
        "Figure 2.6",
        "Stribeck: α* grows linearly with v₀ up to",
        "0.16",
        &[tip],
    );
    let worst = (1..=16)
        .map(|k| {
            let v = tip * f64::from(k) / 17.0;
            let found = critical(&belt_at(LawKind::Stribeck, v)?, FastResponse::Limit)?;
            Ok(found.last().map_or(1.0, |change| (change.amplitude_ratio / v - 1.0).abs()))
        })
        .collect::<Result<Vec<f64>, Failure>>()?
        .into_iter()
        .fold(0.0, f64::max);
    sheet.statement(
        ["2.6-linear", "Figure 2.6", "there α* = v₀, on a straight line"],
        format!("largest deviation {}", digits(worst, 2)),
        &[worst],
        worst < 1e-9,
    );
    let grid = (0..=40).map(|k| tip * f64::from(k) / 41.0);
    let edges: Vec<f64> = grid.filter_map(|alpha| upper(&stribeck, alpha)).collect();
    sheet.statement(
        ["2.6-upper-edge", "Figure 2.6", "Stribeck: the upper edge falls with α, the lower rises"],
        format!("upper edge {} to {}", digits(edges[0], 4), digits(edges[edges.len() - 1], 4)),
        &[edges[0], edges[edges.len() - 1]],
        edges.len() == 41 && edges.windows(2).all(|pair| pair[1] < pair[0]),
    );
    let mut destabilised = 0;
    for k in 1..=50 {
        let found =
            critical(&belt_at(LawKind::Stribeck, 0.006 * f64::from(k))?, FastResponse::Limit)?;
        destabilised += found.iter().filter(|change| change.becomes == Becomes::Unstable).count();
    }
    sheet.statement(
        ["2.6-never-destabilised", "Figure 2.6", "Stribeck: a larger dither never destabilises"],
        format!("{destabilised} of 50 belt velocities up to 0.3 are destabilised"),
        &[destabilised as f64],
        destabilised == 0,
    );
    let stable_above: Vec<f64> = upper(&decreasing, 0.0).into_iter().collect();
    sheet
        .number(
            "2.7-undithered",
            "Figure 2.7",
            "decreasing: undithered sliding is stable above v₀",
            "0.8",
            &stable_above,
        )
        .note("only locally: see 2.7-undithered-from-afar");
    let widths = [1.0, 1.5, 2.0]
        .map(|v| {
            let found = critical(&belt_at(LawKind::Decreasing, v)?, FastResponse::Limit)?;
            Ok(found.windows(2).map(|pair| pair[1].amplitude_ratio - pair[0].amplitude_ratio).sum())
        })
        .into_iter()
        .collect::<Result<Vec<f64>, Failure>>()?;
    sheet.statement(
        [
            "2.7-narrower",
            "Figure 2.7",
            "decreasing: the band becomes narrower as the belt velocity grows",
        ],
        format!("width in α at v₀ = 1, 1.5, 2: {}", list(&widths)),
        &widths,
        widths.windows(2).all(|pair| 0.0 < pair[1] && pair[1] < pair[0]),
    );
    Ok(())
}

/// ζ = 0.005, R = 10, a sine.
fn belt_at(kind: LawKind, belt_velocity: f64) -> Result<Belt, Failure> {
    belt(kind, LIGHT, belt_velocity, Some((Direction::Tangential, Waveform::Sine, 1.0, 10.0)))
}

/// Decreasing law above its critical velocity: stable without dither, and not with.
pub(super) fn destabilisation(sheet: &mut Sheet) -> Result<(), Failure> {
    let undithered = belt(LawKind::Decreasing, LIGHT, 1.0, None)?;
    let late = |displacement: f64| -> Result<f64, Failure> {
        let start = Start { displacement, ..Start::REST };
        let mut sampler = Sampler::new(1500.0, 0.05, 500);
        simulate(&undithered, start, 1526.0, 1e-12, &mut sampler)
            .map_err(|error| failed("claims", &error))?;
        let low =
            sampler.samples.iter().fold(f64::INFINITY, |low, sample| low.min(sample.displacement));
        let high = sampler
            .samples
            .iter()
            .fold(f64::NEG_INFINITY, |high, sample| high.max(sample.displacement));
        Ok(high - low)
    };
    let (rest, afar) = (late(0.0)?, late(1.5)?);
    let names = [
        "2.7-undithered-from-rest",
        "Figure 2.7",
        "decreasing, v₀ = 1: the undithered system is stable (from rest)",
    ];
    sheet.statement(
        names,
        format!("peak-to-peak {} at τ = 1500", digits(rest, 2)),
        &[rest],
        rest < 0.05,
    );
    let names = ["2.7-undithered-from-afar", "Figure 2.7", "the same from x = 1.5"];
    sheet
        .statement(
            names,
            format!("peak-to-peak {} at τ = 1500", digits(afar, 3)),
            &[afar],
            afar < 0.05,
        )
        .note(
            "a stick-slip cycle coexists with stable sliding; averaging judges small motions only",
        );
    for (velocity, printed) in
        [(1.0, [("0.43", "4.3"), ("0.98", "9.8")]), (1.5, [("", "10"), ("", "15")])]
    {
        let belt = belt_at(LawKind::Decreasing, velocity)?;
        let (limit, exact) =
            (critical(&belt, FastResponse::Limit)?, critical(&belt, FastResponse::Oscillator)?);
        for (which, (alpha, amplitude)) in printed.into_iter().enumerate() {
            let becomes = ["unstable", "stable again"][which];
            let found: Vec<&CriticalAmplitude> = limit.get(which).into_iter().collect();
            let sharper = exact.get(which).map_or(f64::NAN, |change| change.amplitude);
            let place = if velocity == 1.0 { "Figures 2.7, 2.10" } else { "Figures 2.7, 2.11" };
            let statement = format!("averaging, v₀ = {velocity}: {becomes} from");
            let stem = format!("2.7-v{velocity}-{}", ["unstable", "stable"][which]);
            if !alpha.is_empty() {
                let values: Vec<f64> = found.iter().map(|change| change.amplitude_ratio).collect();
                sheet
                    .number(
                        &format!("{stem}-ratio"),
                        place,
                        &format!("{statement} α ="),
                        alpha,
                        &values,
                    )
                    .note(if which == 1 {
                        "averaging gives α = v₀ exactly; 0.98 is a value of a plotting grid"
                    } else {
                        ""
                    });
            }
            let values: Vec<f64> = found.iter().map(|change| change.amplitude).collect();
            sheet
                .number(&stem, place, &format!("{statement} D_T ="), amplitude, &values)
                .note(format!("with the exact fast motion {}", digits(sharper, 6)));
        }
    }
    Ok(())
}
