//! The least dither of any structure: every waveform, the best of them, and what belongs to its answer.

use quell_design::actuator::Actuator;
use quell_design::least_dither::{
    CoveredBox, DesignProblem, DesignStart, Designed, InfeasibleDesign, LimitedQuantity,
    OperatingPoint, Plant, ScheduledDither, SystemAtPoint, SystemPlant, covered, design,
};
use quell_dynamics::simulation::{apart, within};
use quell_linear::averaging::DitheredSystem;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

use super::found::{DesignNumber, DesignNumbers, DesignedDither, LeastDitherFound, TriedDither};
use super::sampling::{SampleOf, sampling};
use super::study_with_design::StudyWithDesign;
use super::unknown::{NoConfidentDither, NoCoveredPart, NoDesignSensitivity, NoSchedule};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::contact_state::averaged_without_states;
use crate::effort::STEPS_OF_MANY_SEARCHES;
use crate::parallel::{InParallel, Parallel};
use crate::run::evenly;
use crate::study::Design;

/// How far beyond the range of amplitudes a search looks for exact thresholds whose averages are in it.
const WIDER: f64 = 1.5;

/// Points of the schedule over a box of one coordinate.
const SCHEDULE: usize = 33;

/// The table `[design]` of a study with a dither.
///
/// # Errors
/// A complaint about what is missing.
pub(crate) fn asked(study: &dyn StudyWithDesign, has_dither: bool) -> Result<&Design, Failure> {
    let (key, allowed) = match study.asked() {
        Some(design) if has_dither => return Ok(design),
        Some(_) => {
            ("dither", "given: its direction, frequency and waveform are where the design begins")
        }
        None => (
            "design",
            "a table [design] with minimise, vary, from and to: what is to be small, and over which numbers",
        ),
    };
    Err(Complaint::new(Fault::Missing, key, Origin::Whole, Json::Null, allowed).into())
}

/// The complaint about `vary` without the amplitude of one dither.
pub(crate) fn without_amplitude(asked: &Design, allowed: String) -> Failure {
    let numbers = asked.vary.iter().map(|range| range.path.as_str());
    let periods = asked.periods.iter().map(|(path, _)| path.as_str());
    let given: Vec<&str> = numbers.chain(periods).collect();
    Complaint::new(Fault::Value, "design.vary", Origin::Whole, given, allowed).into()
}

/// The complaint about an end of a range of `[design]`.
pub(crate) fn at_end(complaint: Complaint, key: &str, path: &str) -> Complaint {
    let Complaint { key: own, value, allowed, .. } = &complaint;
    let allowed =
        format!("ranges of valid studies; at an end of {path}, {own} = {value} must be {allowed}");
    Complaint {
        key: format!("design.{key}"),
        origin: Origin::Whole,
        value: path.into(),
        allowed: allowed.into(),
        ..complaint
    }
}

/// The least of the dithers of a study, each with its system; `input` is that of the dither, `observe` the row over the coordinates whose
/// response is reported.
///
/// # Errors
/// A complaint about uncertain numbers that the design gives.
pub(crate) fn least_system_dithers(
    study: &dyn StudyWithDesign,
    asked: &Design,
    numbers: &DesignNumbers,
    systems: &[TriedDither<'_, Box<SystemAtPoint<'_>>>],
    (input, observe): (usize, &[f64]),
    samples: &SampleOf<'_>,
) -> Result<LeastDitherFound, Failure> {
    let tried = systems.iter().map(|tried| TriedDither {
        waveform: tried.waveform.clone(),
        place: tried.place.clone(),
        study: tried.study,
        plant: SystemPlant { at: tried.plant.as_ref(), input, observe, start: asked.start },
    });
    let tried: Vec<TriedDither<'_, SystemPlant<'_>>> = tried.collect();
    let found = least_dither(study, asked, numbers, &tried, Some(samples))?;
    let without_state = without_state(&found, systems[found.best].plant.as_ref());
    Ok(LeastDitherFound { without_state, ..found })
}

/// Why the averages of a design, which do not know the states of contacts, differ from those with them at its least dither.
fn without_state(found: &LeastDitherFound, at: &SystemAtPoint<'_>) -> Vec<String> {
    let Ok(feasible) = &found.answer().answer else { return Vec::new() };
    let critical = &feasible.critical;
    let middle = || found.over.iter().map(|over| over.range.middle()).collect();
    let point: Vec<f64> = critical.worst.clone().unwrap_or_else(middle);
    let place = OperatingPoint { point: &point, others: &critical.others };
    let Ok(system) = at(place, critical.amplitude) else { return Vec::new() };
    let average = DitheredSystem::new(&system).and_then(|prepared| prepared.average());
    average.map(|average| averaged_without_states(&system, &average.contacts)).unwrap_or_default()
}

/// The least of the dithers of a study, each with its structure; `samples` are those of its uncertain numbers; a disc has none.
///
/// # Errors
/// A complaint about uncertain numbers that the design gives.
pub(crate) fn least_dither<P: Plant + Sync>(
    study: &dyn StudyWithDesign,
    asked: &Design,
    numbers: &DesignNumbers,
    tried: &[TriedDither<'_, P>],
    samples: Option<&SampleOf<'_>>,
) -> Result<LeastDitherFound, Failure> {
    let sampling = sampling(study, asked, numbers)?;
    let DesignNumbers { amplitude, others, over } = numbers.clone();
    let ranges = |numbers: &[DesignNumber]| -> Vec<RealInterval> {
        numbers.iter().map(|number| number.range).collect()
    };
    let (box_ranges, other_ranges) = (ranges(&over), ranges(&others));
    let actuator = study.actuator();
    let of_actuator = actuator.map(Actuator::limits).into_iter().flatten();
    let of_actuator = of_actuator.map(|limit| (LimitedQuantity::Actuator(limit), 1.0));
    let limits: Vec<_> = asked.limits.iter().copied().chain(of_actuator).collect();
    let problem = |plant| DesignProblem {
        plant,
        objective: asked.minimise,
        amplitude: amplitude.range,
        others: &other_ranges,
        over: &box_ranges,
        limits: &limits,
        actuator,
        start: asked.start,
        tasks: &InParallel,
    };
    let designed = tried.in_parallel(|tried| {
        let (designed, _) = apart(STEPS_OF_MANY_SEARCHES, || fast_first(problem(&tried.plant)));
        let waveform = tried.waveform.clone();
        let is_slow = designed
            .answer
            .as_ref()
            .is_ok_and(|found| numbers.is_slow(&numbers.verified(found), &waveform, tried.study));
        DesignedDither { waveform, place: tried.place.clone(), is_slow, designed }
    });
    let designed: Vec<DesignedDither> = designed.collect();
    // A slow one is only chosen where no other is allowed.
    let value = |tried: &DesignedDither| match &tried.designed.answer {
        Ok(found) => (tried.is_slow, found.critical.objective.clone().unwrap_or(f64::INFINITY)),
        Err(_) => (true, f64::INFINITY),
    };
    let best = (0..designed.len())
        .min_by(|a, b| {
            let (a, b) = (value(&designed[*a]), value(&designed[*b]));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
        })
        .unwrap_or(0);
    let answer = &designed[best].designed.answer;
    let schedule = match (tried.get(best), box_ranges.as_slice(), answer) {
        _ if asked.start != DesignStart::Local => Err(NoSchedule::FromStart),
        (Some(tried), [range], Ok(found)) => {
            Ok(schedule(problem(&tried.plant), *range, &found.critical.others))
        }
        (_, [_], _) => Err(NoSchedule::NothingAllowed),
        _ => Err(NoSchedule::NotOneCoordinate),
    };
    let covered = match (tried.get(best), answer) {
        (Some(tried), Err(none)) => {
            within(STEPS_OF_MANY_SEARCHES, || covered_fast_first(problem(&tried.plant), none))
        }
        _ => Err(NoCoveredPart::Whole),
    };
    let (without_state, tongues) = (Vec::new(), Vec::new());
    let sensitivity = Err(NoDesignSensitivity::NothingAllowed);
    let confident = match (sampling, samples, tried.get(best), answer) {
        (None, ..) => Err(NoConfidentDither::NotAsked),
        (Some(_), None, ..) => Err(NoConfidentDither::OfDisc),
        (Some(sampling), Some(samples), Some(tried), Ok(found)) => {
            let sample = |values: &[(&str, f64)], others: &[f64]| samples(best, values, others);
            sampling.confident(&problem(&tried.plant), &found.critical, &sample)
        }
        _ => Err(NoConfidentDither::NothingAllowed),
    };
    let found = LeastDitherFound {
        amplitude,
        others,
        over,
        tried: designed,
        best,
        periods: asked.periods.clone(),
        covered,
        schedule,
        beyond_laws: Vec::new(),
        without_state,
        tongues,
        sensitivity,
        confident,
        slow: None,
    };
    // The derivatives and the laws are those of the dither at its place.
    let study = tried.get(best).map_or(study, |tried| tried.study);
    let claimed = found.claimed(numbers);
    let beyond_laws = claimed
        .map(|dither| numbers.beyond_laws(&dither, found.waveform(), study))
        .unwrap_or_default();
    let sensitivity = found.sensitivity_of(study);
    let slow = found.slow_response(numbers, study);
    Ok(LeastDitherFound { beyond_laws, sensitivity, slow, ..found })
}

/// A problem whose dither must repeat above the band of the vibration, with the limits of `fast`.
fn fast<'a>(problem: DesignProblem<'a>, limits: &'a [(LimitedQuantity, f64)]) -> DesignProblem<'a> {
    DesignProblem { limits, ..problem }
}

/// The limits of a problem, and that the dither repeats above the band of the vibration; `None` where nothing about its frequency is
/// chosen.
fn limits_of_fast(problem: &DesignProblem<'_>) -> Option<Vec<(LimitedQuantity, f64)>> {
    let more = [(LimitedQuantity::Band, 1.0)];
    (!problem.others.is_empty()).then(|| problem.limits.iter().copied().chain(more).collect())
}

/// The least dither of a problem: of those that repeat above the band of the vibration, or of all where none of them is allowed.
fn fast_first(problem: DesignProblem<'_>) -> Designed {
    if let Some(limits) = limits_of_fast(&problem) {
        let designed = within_range(fast(problem, &limits));
        if designed.answer.is_ok() {
            return designed;
        }
    }
    within_range(problem)
}

/// The part of the box that one dither serves: one that repeats above the band of the vibration, or any where none of them does.
fn covered_fast_first(
    problem: DesignProblem<'_>,
    none: &InfeasibleDesign,
) -> Result<CoveredBox, NoCoveredPart> {
    if let Some(limits) = limits_of_fast(&problem)
        && let Ok(part) = covered(fast(problem, &limits), none)
    {
        return Ok(part);
    }
    Ok(covered(problem, none)?)
}

/// The least dither of a problem. Where none is found although other variables are chosen, the end of the range of amplitudes is taken as a
/// limit that they must keep: averaging may choose a dither whose exact amplitude is a little beyond it.
fn within_range(problem: DesignProblem<'_>) -> Designed {
    let found = design(problem);
    let RealInterval { lower: from, upper: to } = problem.amplitude;
    let is_limited = problem
        .limits
        .iter()
        .any(|(quantity, limit)| *quantity == LimitedQuantity::Amplitude && *limit <= to);
    if found.answer.is_ok() || problem.others.is_empty() || is_limited {
        return found;
    }
    let mut limits = problem.limits.to_vec();
    limits.push((LimitedQuantity::Amplitude, to));
    let amplitude = RealInterval::new(from, WIDER * to);
    let wider = DesignProblem { amplitude, limits: &limits, ..problem };
    let others: Vec<f64> = problem.others.iter().map(|range| range.lower).collect();
    let point: Vec<f64> = problem.over.iter().map(|range| range.lower).collect();
    let at = OperatingPoint { point: &point, others: &others };
    // More normal dither may pull a contact apart.
    if problem.plant.averaged_loss(at, WIDER * to).is_err() {
        return found;
    }
    let again = design(wider);
    if again.answer.is_ok() { again } else { found }
}

/// The exact least dithers along a box of one coordinate.
fn schedule(
    problem: DesignProblem<'_>,
    range: RealInterval,
    others: &[f64],
) -> Vec<ScheduledDither> {
    let at = |point: f64| apart(STEPS_OF_MANY_SEARCHES, || problem.scheduled(&[point], others)).0;
    let points = evenly(range, SCHEDULE);
    points.in_parallel(|point| at(*point)).collect()
}
