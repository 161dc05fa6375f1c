//! Claims of chapter 2: friction laws, responses under sinusoidal tangential dither, averaging.

use quell_dynamics::response::{
    PEAK_FLOOR, ResponsePlan, SUPPRESSED, Solver, SteadyResponse, respond,
};
use quell_dynamics::simulation::{EventKind, EventRecorder, Sampler, Start, simulate};
use quell_linear::averaging::{
    Averaging, Becomes, CriticalAmplitude, EverywhereStable, FastWave, closed_band,
    critical_amplitudes, everywhere_stable_amplitude,
};
use quell_model::parameter::MINIMUM_COEFFICIENT;
use quell_model::{Belt, Direction, Dither, Friction, LawKind, Waveform};

use super::super::entry::CatalogueEntry;
use super::super::failure::failed;
use super::super::figures::FIGURES;
use super::super::responses::{ResponseColumn, cases, fundamental};
use super::super::source::EntrySource;
use super::record::largest_line;
use super::sheet::{ClaimSheet, digits, list, shares};
use quell::complaint::Failure;

/// Damping ratio of most figures.
pub(super) const LIGHT: f64 = 0.005;

/// A friction law with the parameters of the dissertation.
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
        envelope: None,
    });
    Belt::new(damping_ratio, 1.0, belt_velocity, law(kind)?, dithers.into_iter().collect())
        .map_err(|_| failed("claims", &"the belt is not valid"))
}

/// The study of a figure.
pub(super) fn source(name: &str) -> Result<EntrySource, Failure> {
    FIGURES
        .iter()
        .find(|entry| entry.name == name)
        .map(CatalogueEntry::source)
        .ok_or_else(|| failed("claims", &format!("there is no figure {name}")))
}

/// E of each column, where it is defined.
pub(super) fn residual_vibrations(cases: &[ResponseColumn]) -> Vec<f64> {
    cases.iter().filter_map(|case| case.response.residual_vibration.ok()).collect()
}

/// Whether E is between suppression and no effect.
pub(super) fn partial(residual_vibration: f64) -> bool {
    (SUPPRESSED..1.0).contains(&residual_vibration)
}

/// Critical amplitudes by averaging, with αG or the exact fast motion.
pub(super) fn critical(
    belt: &Belt,
    averaging: Averaging,
) -> Result<Vec<CriticalAmplitude>, Failure> {
    critical_amplitudes(belt, averaging).map_err(|error| failed("claims", &error))
}

/// Fundamental frequency of the undithered stick-slip vibration, from the exact times at which the mass sticks.
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

/// A printed frequency against the largest lines of the records of these belts from rest, see [`super::record`].
pub(super) fn record_line(
    sheet: &mut ClaimSheet,
    words: [&str; 3],
    printed: &str,
    belts: &[Belt],
) -> Result<(), Failure> {
    let found = belts
        .iter()
        .map(|belt| largest_line(belt).map(|line| line.frequency))
        .collect::<Result<Vec<f64>, Failure>>()?;
    sheet
        .truncated(words, printed, &found)
        .note("lines are 2/75 apart; further digits of the line are dropped, not rounded");
    Ok(())
}

/// Figures 2.2, 2.3: friction laws and the undithered limit cycle.
pub(super) fn friction_laws(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let undithered = belt(LawKind::Stribeck, LIGHT, 0.05, None)?;
    let frequency = stick_slip_frequency(&undithered)?;
    sheet
        .number(
            "2.3-undithered-fundamental",
            "Figures 2.3, 3.7",
            "fundamental frequency of the undithered stick-slip vibration, Stribeck law (ω₀)",
            "0.666",
            &[frequency],
        )
        .note("the exact times of sticking; the next line is the reading of the dissertation");
    record_line(
        sheet,
        [
            "2.3-undithered-record",
            "Figures 2.3, 3.7",
            "the same as the largest line of a record of length 75π without window",
        ],
        "0.666",
        std::slice::from_ref(&undithered),
    )?;
    let misprinted = undithered
        .friction()
        .with(MINIMUM_COEFFICIENT.path, 0.2587)
        .and_then(|law| undithered.with_friction(law))
        .map_err(|_| failed("claims", &"the misprinted law is not valid"))?;
    sheet
        .number(
            "2.2-minimum-coefficient",
            "before Figure 2.2, Figure 4.2",
            "the same fundamental frequency with μ_m = 0.2587",
            "0.666",
            &[stick_slip_frequency(&misprinted)?],
        )
        .note("hence 0.2587 is a misprint of 0.2857");
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
pub(super) fn responses(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let cases = cases(&source("2.3")?)?;
    let found = residual_vibrations(&cases);
    let dithered = fundamental(&cases[0].response.dithered.spectrum);
    sheet
        .number(
            "2.3-dithered-fundamental",
            "Figure 2.3(a)",
            "fundamental frequency at D_T = 0.3 (ω₀)",
            "0.746",
            dithered.as_slice(),
        )
        .note("locked to the dither at 10·5/68; the next line is the reading of the dissertation");
    record_line(
        sheet,
        [
            "2.3-dithered-record",
            "Figure 2.3(a)",
            "the same as the largest line of a record of length 75π without window",
        ],
        "0.746",
        std::slice::from_ref(cases[0].study.belt()),
    )?;
    let SteadyResponse { dithered, undithered, .. } = &cases[0].response;
    let [with, without] = [dithered, undithered].map(|record| record.contacts[0].stick_fraction);
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
        format!("E = {}", shares(&found[..2])),
        &found[..2],
        found[..2].iter().all(|e| partial(*e)),
    );
    let names =
        ["2.3-suppressed", "Figure 2.3(c)", "self-excited vibration suppressed at D_T = 0.5"];
    sheet.statement(
        names,
        format!("E = {}", shares(&found[2..])),
        &found[2..],
        found[2] < SUPPRESSED,
    );
    let peaks = cases[2].response.dithered.spectrum.peaks(PEAK_FLOOR);
    let strongest = peaks.iter().max_by(|a, b| a.amplitude.total_cmp(&b.amplitude));
    sheet.number(
        "2.3-forced-frequency",
        "Figure 2.3(c)",
        "frequency of the remaining vibration at D_T = 0.5 (ω₀)",
        "10",
        &strongest.map(|peak| peak.frequency).into_iter().collect::<Vec<_>>(),
    );
    Ok(())
}

/// "As will be shown in the following section, the amplitude of the steady-state response can be reduced further by decreasing the
/// dither frequency ratio": the following section shows E over D and R.
pub(super) fn forced_response(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let (amplitude, ratios) = (0.35, [14.0, 12.0, 10.0, 9.0, 8.0, 7.0]);
    let respond_at = |ratio: f64| -> Result<f64, Failure> {
        let dither = Some((Direction::Tangential, Waveform::Sine, amplitude, ratio));
        let belt = belt(LawKind::Stribeck, LIGHT, 0.05, dither)?;
        let response =
            respond(&belt.system(), &Start::REST.into(), &ResponsePlan::from(&Solver::default()))
                .map_err(|error| failed("claims", &error))?;
        response.residual_vibration.map_err(|error| failed("claims", &error))
    };
    let found = ratios.map(respond_at).into_iter().collect::<Result<Vec<f64>, Failure>>()?;
    let holds = found.windows(2).all(|pair| pair[1] < pair[0]);
    let forced: Vec<f64> = [10.0, 7.0].map(|r| amplitude / (r * r - 1.0)).to_vec();
    sheet
        .statement(
            [
                "2.3-forced-amplitude",
                "before Figure 2.3, Figure 2.8",
                "at constant D_T the amplitude of the steady-state response, as E, can be reduced further by decreasing the \
                 frequency ratio",
            ],
            format!("E at D_T = {amplitude} and R = 14, 12, 10, 9, 8, 7: {}", shares(&found)),
            &found,
            holds,
        )
        .note(format!(
            "E is meant, \"as will be shown in the following section\"; the forced part D/(R² − 1) alone increases: {} at R = 10 \
             and 7",
            list(&forced)
        ));
    Ok(())
}

/// Upper edge of the unstable belt velocities under a sine.
fn upper(law: &Friction, alpha: f64) -> Option<f64> {
    closed_band(law, LIGHT, 1.0, &Waveform::Sine, alpha).ok().and_then(|band| band.upper)
}

/// Figure 2.6.
pub(super) fn stribeck_map(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let law = law(LawKind::Stribeck)?;
    let words = "Stribeck: undithered sliding is stable above v₀";
    sheet.number("2.6-undithered", "Figure 2.6", words, "0.2", upper(&law, 0.0).as_slice());
    let wave = FastWave::Integral(Waveform::Sine);
    let everywhere = everywhere_stable_amplitude(&law, LIGHT, 1.0, wave, Direction::Tangential);
    let EverywhereStable::From { amplitude_ratio: tip, .. } =
        everywhere.map_err(|error| failed("claims", &error))?
    else {
        return Err(failed("claims", &"figure 2.6 has no tip"));
    };
    let words = "Stribeck: α* grows linearly with v₀ up to";
    sheet.number("2.6-linear-up-to", "Figure 2.6", words, "0.16", &[tip]);
    let mut worst: f64 = 0.0;
    for k in 1..=16 {
        let v = tip * f64::from(k) / 17.0;
        let found = critical(&belt_at(LawKind::Stribeck, v)?, Averaging::Limit)?;
        let star = found.last().map_or(f64::MAX, |change| change.amplitude_ratio);
        worst = worst.max((star / v - 1.0).abs());
    }
    let measured = format!("largest deviation {}", digits(worst, 2));
    let words = ["2.6-linear", "Figure 2.6", "up to there α* = v₀, a straight line"];
    sheet.statement(words, measured, &[worst], worst < 1e-9);
    let grid = (0..=40).map(|k| tip * f64::from(k) / 41.0);
    let edges: Vec<f64> = grid.filter_map(|alpha| upper(&law, alpha)).collect();
    let falls = edges.len() == 41 && edges.windows(2).all(|pair| pair[1] < pair[0]);
    let measured = format!("from {} to {}", digits(edges[0], 4), digits(edges[edges.len() - 1], 4));
    let words =
        ["2.6-upper-edge", "Figure 2.6", "Stribeck: the upper edge decreases as α increases"];
    sheet.statement(words, measured, &edges, falls);
    let mut destabilised = 0;
    for k in 1..=50 {
        let belt = belt_at(LawKind::Stribeck, 0.006 * f64::from(k))?;
        let found = critical(&belt, Averaging::Limit)?;
        destabilised += u8::from(found.iter().any(|change| change.becomes == Becomes::Unstable));
    }
    let measured = format!("dither destabilises at {destabilised} of 50 belt velocities up to 0.3");
    let words =
        ["2.6-never-destabilised", "Figure 2.6", "Stribeck: larger dither never destabilises"];
    sheet.statement(words, measured, &[f64::from(destabilised)], destabilised == 0);
    Ok(())
}

/// Figure 2.7.
pub(super) fn decreasing_map(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let law = law(LawKind::Decreasing)?;
    let words = "decreasing: undithered sliding is stable above v₀";
    sheet
        .number("2.7-undithered", "Figure 2.7", words, "0.8", upper(&law, 0.0).as_slice())
        .note("only locally, see 2.7-undithered-from-afar");
    let mut widths = Vec::new();
    for v in [1.0, 1.5, 2.0] {
        let found = critical(&belt_at(LawKind::Decreasing, v)?, Averaging::Limit)?;
        widths
            .extend(found.windows(2).map(|pair| pair[1].amplitude_ratio - pair[0].amplitude_ratio));
    }
    let narrows =
        widths.len() == 3 && widths.windows(2).all(|pair| 0.0 < pair[1] && pair[1] < pair[0]);
    let measured = format!("width in α at v₀ = 1, 1.5, 2: {}", list(&widths));
    let words = [
        "2.7-narrower",
        "Figure 2.7",
        "decreasing: the band becomes narrower as the belt velocity increases",
    ];
    sheet.statement(words, measured, &widths, narrows);
    Ok(())
}

/// ζ = 0.005, R = 10, a sine.
pub(super) fn belt_at(kind: LawKind, belt_velocity: f64) -> Result<Belt, Failure> {
    belt(kind, LIGHT, belt_velocity, Some((Direction::Tangential, Waveform::Sine, 1.0, 10.0)))
}

/// Decreasing law above its critical velocity: stable without dither, unstable with dither.
pub(super) fn destabilisation(sheet: &mut ClaimSheet) -> Result<(), Failure> {
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
    let names = [
        "2.7-undithered-from-afar",
        "Figure 2.7",
        "the stability is that of small motions, as the text of figure 2.11 says: from x = 1.5 a stick-slip vibration remains",
    ];
    sheet
        .finding(
            names,
            format!("peak-to-peak {} at τ = 1500", digits(afar, 3)),
            &[afar],
            afar > 1.0,
        )
        .note("a stick-slip cycle coexists with stable sliding; no run of the dissertation starts there");
    Ok(())
}
