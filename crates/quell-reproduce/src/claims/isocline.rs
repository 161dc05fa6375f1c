//! Claims about the contours of E of figures 2.8, 2.9, 3.10, 3.11, 4.9 and 4.10: E = 5 % compared with D = α*R, how E changes with
//! D and R, and how straight the isoclines are.
//!
//! E decreases continuously to 0 at the threshold of averaging, so that 5 % is reached below it, also for
//! R → ∞; the ratio D(5 %)/(α*R) measures by how much.

use quell::parallel::Parallel;
use quell_dynamics::response::{
    ResponseCase, SUPPRESSED, Solver, amplitude_at_residual_vibration, compare_many,
};
use quell_dynamics::simulation::Start;
use quell_linear::averaging::{Averaging, Becomes};
use quell_model::{Direction, LawKind, Waveform};

use super::super::failure::failed;
use super::chapter2::{LIGHT, belt, critical};
use super::sheet::{ClaimSheet, list, shares};
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
        for waveform in waveforms {
            for &velocity in velocities {
                points.extend(ratios.iter().map(|&ratio| (law, waveform.clone(), velocity, ratio)));
            }
        }
    }
    points
}

/// A point of E = 5 %.
#[derive(Clone, Copy)]
struct Crossing {
    /// D(5 %).
    amplitude: f64,
    /// D(5 %)/(α*R).
    ratio: f64,
}

/// D(5 %) of each point. The crossing is searched from 0.7 to 1.15 α*R.
fn crossings(direction: Direction, points: &[IsolinePoint]) -> Result<Vec<Crossing>, Failure> {
    let solver = Solver { settle: SETTLE, ..Solver::default() };
    points
        .in_parallel(|(kind, waveform, velocity, ratio)| {
            let (kind, velocity, ratio) = (*kind, *velocity, *ratio);
            let missing = |what: &str| failed("claims", &format!("{what} at R = {ratio}"));
            // This amplitude is ignored: both methods set it.
            let dither = (direction, waveform.clone(), 0.5, ratio);
            let belt = belt(kind, LIGHT, velocity, Some(dither))?;
            let amplitude = critical(&belt, Averaging::Limit)?
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
            amplitude_at_residual_vibration(
                &belt,
                Start::REST,
                &solver,
                SUPPRESSED,
                range,
                CLOSENESS,
            )
            .map(|found| Crossing { amplitude: found, ratio: found / amplitude })
            .ok_or_else(|| missing("no crossing of 5 %"))
        })
        .collect()
}

fn extent(values: &[Crossing]) -> [f64; 2] {
    values.iter().fold([f64::INFINITY, 0.0], |[least, most], found| {
        [found.ratio.min(least), found.ratio.max(most)]
    })
}

/// "The slope of the 5 % isocline should increase as v₀ increases": ΔD/ΔR between two ratios, of each law and waveform in turn.
fn slopes(
    sheet: &mut ClaimSheet,
    [name, place]: [&str; 2],
    [from, to]: [(f64, &[Crossing]); 2],
    velocities: &[f64],
) {
    let slope =
        |(one, other): (&Crossing, &Crossing)| (other.amplitude - one.amplitude) / (to.0 - from.0);
    let found: Vec<f64> = from.1.iter().zip(to.1).map(slope).collect();
    let rows: Vec<String> = found.chunks(velocities.len()).map(list).collect();
    let grows = |row: &[f64]| row.windows(2).all(|pair| pair[1] > pair[0]);
    let holds = found.len() == to.1.len() && found.chunks(velocities.len()).all(grows);
    sheet
        .statement(
            [name, place, "the slope of the 5 % isoline increases as v₀ increases"],
            format!("slope D/R at v₀ = {}: {}", plain(velocities), rows.join("; ")),
            &found,
            holds,
        )
        .note(format!("between R = {} and {}; Stribeck law first", from.0, to.0));
}

/// Tangential dither: R = 5, 10, 20.
pub(super) fn tangential(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let four = [0.05, 0.1, 0.125, 0.15];
    let three = [0.05, 0.1, 0.15];
    let others = [Waveform::Triangle, Waveform::Square];
    let mut all: [Vec<(f64, Vec<Crossing>)>; 2] = Default::default();
    for ratio in [5.0, 10.0, 20.0] {
        for (all, (name, place, waveforms, velocities)) in all.iter_mut().zip([
            ("2.8", "Figures 2.8, 2.9", &[Waveform::Sine][..], &four[..]),
            ("3.10", "Figures 3.10, 3.11", &others[..], &three[..]),
        ]) {
            let found = crossings(Direction::Tangential, &points(waveforms, velocities, &[ratio]))?;
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
            all.push((ratio, found));
        }
    }
    for (all, (name, place, velocities)) in all
        .iter()
        .zip([("2.8", "Figures 2.8, 2.9", &four[..]), ("3.10", "Figures 3.10, 3.11", &three[..])])
    {
        let ends = [1, 2].map(|k: usize| (all[k].0, all[k].1.as_slice()));
        slopes(sheet, [&format!("{name}-slope-with-velocity"), place], ends, velocities);
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
        let found = crossings(Direction::Normal, &rows)?;
        let found: Vec<f64> = found.iter().map(|found| found.ratio).collect();
        let statement = "E = 5 % coincides with D = α*R: D/(α*R), R_N = 4, 5, 6, 7";
        sheet.number_within(COINCIDES, [name, place, statement], "1.00", &found);
    }
    let velocities = [0.03, 0.04, 0.05];
    let [from, to] = [4.0, 6.0].map(|ratio| {
        crossings(Direction::Normal, &points(&[Waveform::Sine], &velocities, &[ratio]))
            .map(|found| (ratio, found))
    });
    let (from, to) = (from?, to?);
    let words = ["4.9-slope-with-velocity", "Figures 4.9, 4.10"];
    slopes(sheet, words, [(from.0, &from.1), (to.0, &to.1)], &velocities);
    Ok(())
}

/// A contour figure: its claims, direction, law, and the points at which E is compared.
struct ContourFigure {
    /// Number of the figure.
    figure: &'static str,
    direction: Direction,
    law: LawKind,
    /// D at the ratio in the middle of `ratios`, increasing.
    amplitudes: &'static [f64],
    /// R at the amplitude in the middle of `amplitudes`, decreasing.
    ratios: &'static [f64],
    /// "When R > 5" or 3: the ratios of the isoclines.
    isocline_ratios: &'static [f64],
    /// "Small reduction ratios, less than 20 %" or 40 %.
    small: f64,
}

const CONTOURS: [ContourFigure; 4] = [
    ContourFigure {
        figure: "2.8",
        direction: Direction::Tangential,
        law: LawKind::Stribeck,
        amplitudes: &[0.1, 0.2, 0.3, 0.4, 0.5],
        ratios: &[16.0, 14.0, 12.0, 10.0, 8.0, 6.5],
        isocline_ratios: &[6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 20.0],
        small: 0.2,
    },
    ContourFigure {
        figure: "2.9",
        direction: Direction::Tangential,
        law: LawKind::Decreasing,
        amplitudes: &[0.1, 0.2, 0.3, 0.4, 0.5],
        ratios: &[16.0, 14.0, 12.0, 10.0, 8.0, 6.5],
        isocline_ratios: &[6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 20.0],
        small: 0.2,
    },
    ContourFigure {
        figure: "4.9",
        direction: Direction::Normal,
        law: LawKind::Stribeck,
        amplitudes: &[0.2, 0.4, 0.6, 0.8, 0.95],
        ratios: &[10.0, 9.0, 8.0, 7.0, 6.0, 5.0],
        isocline_ratios: &[3.5, 4.0, 5.0, 6.0, 7.0],
        small: 0.4,
    },
    ContourFigure {
        figure: "4.10",
        direction: Direction::Normal,
        law: LawKind::Decreasing,
        amplitudes: &[0.2, 0.4, 0.6, 0.8, 0.95],
        ratios: &[10.0, 9.0, 8.0, 7.0, 6.0, 5.0],
        isocline_ratios: &[3.5, 4.0, 5.0, 6.0, 7.0],
        small: 0.4,
    },
];

/// E at pairs of D and R; v₀ = 0.05, a sine.
fn residuals_at(contours: &ContourFigure, points: &[[f64; 2]]) -> Result<Vec<f64>, Failure> {
    let solver = Solver { settle: SETTLE, ..Solver::default() };
    let cases = points
        .iter()
        .map(|&[amplitude, ratio]| {
            let dither = (contours.direction, Waveform::Sine, amplitude, ratio);
            let belt = belt(contours.law, LIGHT, 0.05, Some(dither))?;
            Ok(ResponseCase { belt, start: Start::REST })
        })
        .collect::<Result<Vec<ResponseCase>, Failure>>()?;
    compare_many(&cases, &solver)
        .into_iter()
        .map(|compared| {
            let compared = compared.map_err(|error| failed("claims", &error))?;
            compared.residual_vibration().map_err(|error| failed("claims", &error))
        })
        .collect()
}

/// "For a constant frequency ratio, E decreases as D is increased; for a constant amplitude, as the frequency ratio is decreased."
pub(super) fn trends(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    for contours in &CONTOURS {
        let (figure, place) = (contours.figure, format!("Figure {}", contours.figure));
        let ratio = contours.ratios[contours.ratios.len() / 2];
        let amplitude = contours.amplitudes[contours.amplitudes.len() / 2];
        let over_amplitudes: Vec<[f64; 2]> =
            contours.amplitudes.iter().map(|&amplitude| [amplitude, ratio]).collect();
        let over_ratios: Vec<[f64; 2]> =
            contours.ratios.iter().map(|&ratio| [amplitude, ratio]).collect();
        for (name, statement, points) in [
            ("amplitude", "at constant R, E decreases as D is increased", over_amplitudes),
            ("ratio", "at constant D, E decreases as R is decreased", over_ratios),
        ] {
            let found = residuals_at(contours, &points)?;
            let at: Vec<String> = points.iter().map(|[d, r]| format!("({d}, {r})")).collect();
            sheet
                .statement(
                    [&format!("{figure}-falls-with-{name}"), &place, statement],
                    format!("E: {}", shares(&found)),
                    &found,
                    found.windows(2).all(|pair| pair[1] < pair[0]),
                )
                .note(format!("at (D, R) = {}; v₀ = 0.05, sine", at.join(", ")));
        }
    }
    Ok(())
}

/// Levels of E whose isoclines are compared with straight lines: up to that below which they are called straight, and the level that is
/// called "fairly distorted".
fn levels(contours: &ContourFigure) -> Vec<f64> {
    let mut levels = vec![0.05, 0.1, 0.2, 0.3, 0.4];
    levels.retain(|level| *level <= contours.small);
    levels.push(0.5);
    levels
}

/// "Small reduction ratios exhibit approximately linear relationships between dither amplitude and frequency ratio", and "the
/// isoclines become less straight as the performance worsens; for example, when E = 0.5, the contours are fairly distorted".
pub(super) fn straight(sheet: &mut ClaimSheet) -> Result<(), Failure> {
    let deviations = CONTOURS
        .in_parallel(|contours| {
            levels(contours).into_iter().map(|level| deviation(contours, level)).collect()
        })
        .collect::<Result<Vec<Vec<f64>>, Failure>>()?;
    for (contours, found) in CONTOURS.iter().zip(&deviations) {
        let figure = contours.figure;
        let place = format!("Figure {figure}");
        let levels = levels(contours);
        let small: Vec<f64> = levels
            .iter()
            .zip(found)
            .filter(|(level, _)| **level <= contours.small)
            .map(|(_, deviation)| *deviation)
            .collect();
        let per_cent: Vec<f64> = levels.iter().map(|level| 100.0 * level).collect();
        let words = format!(
            "isoclines of E below {} % are approximately straight for R > {}",
            100.0 * contours.small,
            if contours.direction == Direction::Normal { 3 } else { 5 }
        );
        sheet
            .statement(
                [&format!("{figure}-straight"), &place, &words],
                format!("largest deviation of D from a straight line, relative: {}", list(&small)),
                &small,
                small.iter().all(|deviation| *deviation < 0.05),
            )
            .note(format!(
                "E = {} % at R = {}",
                plain(&per_cent[..small.len()]),
                plain(contours.isocline_ratios)
            ));
        sheet.statement(
            [
                &format!("{figure}-less-straight"),
                &place,
                "the isoclines become less straight as E increases; at E = 0.5 they are fairly distorted",
            ],
            format!("largest deviation at E = {} %: {}", plain(&per_cent), list(found)),
            found,
            found.last() > small.iter().max_by(|a, b| a.total_cmp(b)),
        );
    }
    Ok(())
}

fn plain(values: &[f64]) -> String {
    values.iter().map(f64::to_string).collect::<Vec<_>>().join(", ")
}

/// Largest relative deviation of D on an isocline from the straight line of least squares in R.
fn deviation(contours: &ContourFigure, level: f64) -> Result<f64, Failure> {
    let solver = Solver { settle: SETTLE, ..Solver::default() };
    let mut points = Vec::new();
    for &ratio in contours.isocline_ratios {
        let dither = (contours.direction, Waveform::Sine, 0.5, ratio);
        let belt = belt(contours.law, LIGHT, 0.05, Some(dither))?;
        let threshold = critical(&belt, Averaging::Limit)?
            .into_iter()
            .find(|found| found.becomes == Becomes::Stable)
            .ok_or_else(|| failed("claims", &"no averaged threshold"))?
            .amplitude;
        let most = match contours.direction {
            Direction::Tangential => f64::INFINITY,
            Direction::Normal => 0.999 * belt.normal_load(),
        };
        let range = 0.1 * threshold..=most.min(1.15 * threshold);
        let found =
            amplitude_at_residual_vibration(&belt, Start::REST, &solver, level, range, CLOSENESS);
        points.extend(found.map(|amplitude| (ratio, amplitude)));
    }
    if points.len() < 3 {
        return Err(failed("claims", &format!("E = {level} is reached at too few ratios")));
    }
    let count = points.len() as f64;
    let mean = |value: fn(&(f64, f64)) -> f64| points.iter().map(value).sum::<f64>() / count;
    let [ratio, amplitude] = [mean(|point| point.0), mean(|point| point.1)];
    let covariance: f64 = points.iter().map(|(r, d)| (r - ratio) * (d - amplitude)).sum();
    let slope = covariance / points.iter().map(|(r, _)| (r - ratio).powi(2)).sum::<f64>();
    let off = |(r, d): &(f64, f64)| ((amplitude + slope * (r - ratio)) / d - 1.0).abs();
    Ok(points.iter().map(off).fold(0.0, f64::max))
}
