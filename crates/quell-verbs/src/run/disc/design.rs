//! `design` of a disc: the least amplitude of its dither that is quiet over a box of operating points, speeds above all.

use quell_design::least_dither::{
    DesignObjective, DesignStart, DiscAtPoint, DiscPlant, LimitedQuantity, OperatingPoint, Plant,
};
use quell_disc::marginal::tongue_grid;
use quell_model::disc::{Contributions, DiscDither};
use quell_model::parameter::disc::{DISC_DITHER_AMPLITUDE, DISC_SPEED};
use quell_model::parameter::{DITHER_FREQUENCY_RATIO, Parameter};
use quell_model::{Disc, RefusedNumbers, Waveform};
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::run::design::{
    DesignNumber, DesignNumbers, LeastDitherFound, StudyWithDesign, TriedDither, asked, at_end,
    least_dither, without_amplitude,
};
use crate::study::{Design, DesignRange, DiscStudy};

/// Equal steps of the speeds at which thresholds are drawn.
const DRAWN: u32 = 96;

/// The least dither of a disc.
///
/// # Errors
/// A complaint about a study without `[design]`, about a number in it, a start other than `local`, a quantity that the dither of a disc
/// does not have, parts that are left out, and loads or speeds over time.
pub fn run(study: &DiscStudy) -> Result<LeastDitherFound, Failure> {
    let disc = study.disc();
    let asked = asked(study, !matches!(disc.dither(), DiscDither::None))?;
    answerable(study, asked)?;
    accepted(study, "vary", &asked.vary)?;
    accepted(study, "over", &asked.over)?;
    let is_amplitude = |range: &&DesignRange| range.path == DISC_DITHER_AMPLITUDE.path;
    let (amplitude, others): (Vec<_>, Vec<_>) = asked.vary.iter().partition(is_amplitude);
    let [amplitude] = amplitude.as_slice() else {
        let allowed = "a list with dither.amplitude, once: the least one is sought";
        return Err(without_amplitude(asked, allowed.to_owned()));
    };
    let others: Vec<DiscNumber> =
        others.into_iter().map(|range| DiscNumber::of(study, range)).collect();
    let over: Vec<DiscNumber> =
        asked.over.iter().map(|range| DiscNumber::of(study, range)).collect();
    let at = |waveform: &Waveform, at: OperatingPoint<'_>, value: f64| {
        let point = over.iter().zip(at.point.iter().copied());
        let chosen = others.iter().zip(at.others.iter().copied());
        let numbers: Vec<(&DiscNumber, f64)> = point.chain(chosen).collect();
        disc_at(study, waveform, &numbers, value)
    };
    let at = &at;
    let discs: Vec<(&Waveform, Box<DiscAtPoint<'_>>)> = asked
        .waveforms
        .iter()
        .map(|waveform| {
            let disc = move |point: OperatingPoint<'_>, value: f64| at(waveform, point, value);
            (waveform, Box::new(disc) as Box<DiscAtPoint<'_>>)
        })
        .collect();
    let speed = over.iter().position(|number| number.parameter == Some(DISC_SPEED.path));
    let tried: Vec<TriedDither<'_, DiscPlant<'_>>> = discs
        .iter()
        .map(|(waveform, at)| {
            let plant = DiscPlant { at: at.as_ref(), speed };
            TriedDither { waveform: (*waveform).clone(), place: None, study, plant }
        })
        .collect();
    let only = |numbers: &[DiscNumber]| numbers.iter().map(|known| known.number.clone()).collect();
    let numbers = DesignNumbers {
        amplitude: DiscNumber::of(study, amplitude).number,
        others: only(&others),
        over: only(&over),
    };
    let mut found = least_dither(study, asked, &numbers, &tried, None)?;
    if let (Some(_), [range]) = (speed, found.over.as_slice()) {
        let chosen = found.chosen().unwrap_or_else(|| middles(&found.others));
        let plant = &tried[found.best].plant;
        found.tongues = tongues(plant, range.range, &chosen, found.amplitude.range);
    }
    Ok(found)
}

/// The middle of each range.
fn middles(numbers: &[DesignNumber]) -> Vec<f64> {
    numbers.iter().map(|number| f64::midpoint(number.range.lower, number.range.upper)).collect()
}

/// The exact thresholds in amplitude at speeds of a range, among them those in and next to every predicted tongue.
fn tongues(
    plant: &DiscPlant<'_>,
    RealInterval { lower: from, upper: to }: RealInterval,
    others: &[f64],
    range: RealInterval,
) -> Vec<(f64, Vec<f64>)> {
    let first = OperatingPoint { point: &[from], others };
    // An amplitude at which normal dither would pull the contact apart has no thresholds.
    let Ok(disc) = (plant.at)(first, range.upper) else { return Vec::new() };
    let thresholds = |speed: f64| {
        let at = OperatingPoint { point: &[speed], others };
        let quiet = plant.exact(at, range).ok()?;
        let ends = quiet.intervals().iter().flat_map(|quiet| [quiet.lower, quiet.upper]);
        Some((speed, ends.filter(|end| *end > range.lower && *end < range.upper).collect()))
    };
    tongue_grid(&disc, &(from..=to), DRAWN).into_iter().filter_map(thresholds).collect()
}

/// A number of `[design]`.
struct DiscNumber {
    number: DesignNumber,
    /// The parameter of the disc that it is, where its values are converted to the equations; other numbers are set as in the study.
    parameter: Option<&'static str>,
}

impl DiscNumber {
    /// A speed and a frequency may be given in SI.
    fn of(study: &DiscStudy, range: &DesignRange) -> Self {
        let names = |parameter: &Parameter| {
            let table = parameter.path.trim_end_matches(parameter.key());
            let twin = parameter.si.iter().any(|twin| range.path == format!("{table}{}", twin.key));
            twin || range.path == parameter.path
        };
        let known = [DISC_DITHER_AMPLITUDE, DISC_SPEED, DITHER_FREQUENCY_RATIO];
        let parameter = known.iter().find(|parameter| names(parameter)).map(|known| known.path);
        // The end that is not zero has the factor between them.
        let end = if range.to == 0.0 { range.from } else { range.to };
        let in_equations = || {
            let given = |path: &&str| range.path != **path || !study.file_units().is_none();
            let path = parameter.filter(given)?;
            let numbers = study.model().numbers(&[(range.path.as_str(), end)]).ok()?;
            let setup = study.setup_at(&numbers).ok()?;
            let disc = setup.disc();
            let value = match path {
                path if path == DISC_SPEED.path => disc.speed(),
                path if path == DISC_DITHER_AMPLITUDE.path => disc.dither().mean_and_amplitude().1,
                _ => disc.dither().frequency_ratio()?,
            };
            (value != 0.0).then_some(end / value)
        };
        let per_unit = in_equations().unwrap_or(1.0);
        let path = range.path.clone();
        let ends = RealInterval::new(range.from / per_unit, range.to / per_unit);
        let unit = Some(StudyWithDesign::unit_at(study, &path))
            .filter(|unit| unit != "1")
            .unwrap_or_default();
        Self { number: DesignNumber { path, per_unit, unit, range: ends }, parameter }
    }
}

/// The disc with its numbers, another waveform and amplitude of its dither.
fn disc_at(
    study: &DiscStudy,
    waveform: &Waveform,
    numbers: &[(&DiscNumber, f64)],
    amplitude: f64,
) -> Result<Disc, RefusedNumbers> {
    let as_written = numbers.iter().filter(|(known, _)| known.parameter.is_none());
    let as_written: Vec<(&str, f64)> = as_written
        .map(|(known, value)| (known.number.path.as_str(), value * known.number.per_unit))
        .collect();
    let mut disc = match as_written.as_slice() {
        [] => study.disc().clone(),
        numbers => {
            let numbers = study.model().numbers(numbers).map_err(RefusedNumbers::by_study)?;
            study.setup_at(&numbers).map_err(RefusedNumbers::by_study)?.disc().clone()
        }
    };
    if disc.waveform() != waveform {
        // The amplitude of the study may be too large for another waveform.
        disc = disc.with_amplitude(0.0)?;
        disc = disc.shaped(waveform.clone())?;
    }
    for (known, value) in numbers {
        let changed = match known.parameter {
            Some(path) if path == DISC_SPEED.path => disc.at_speed(*value),
            Some(path) if path == DITHER_FREQUENCY_RATIO.path => disc.with_frequency_ratio(*value),
            _ => continue,
        };
        disc = changed?;
    }
    Ok(disc.with_amplitude(amplitude)?)
}

/// Rejects questions that the dither of a disc does not answer.
fn answerable(study: &DiscStudy, asked: &Design) -> Result<(), Failure> {
    let refuse = |key: &str, given: Json, allowed: &str| -> Failure {
        Complaint::new(Fault::Conflict, key, Origin::Whole, given, allowed).into()
    };
    if study.parts() != Contributions::ALL {
        let allowed = "empty: a dither is designed for the whole disc";
        return Err(refuse("disc.without", study.without().into(), allowed));
    }
    if !study.disc().is_steady() {
        let allowed = "constant: a design is judged at steady speeds, loads and dither";
        return Err(refuse("disc", Json::Null, allowed));
    }
    if asked.start != DesignStart::Local {
        let allowed = "\"local\": the exponents of small motions decide about a disc, whose motion has no other start";
        return Err(refuse("design.start", asked.start.name().into(), allowed));
    }
    if asked.confidence.is_some() {
        let allowed = "absent: random samples are judged of belts and systems; `quell probability` judges a disc at one dither";
        return Err(refuse("design.confidence", Json::Null, allowed));
    }
    let moves = "the dither of a disc varies its friction and moves nothing";
    if !matches!(asked.minimise, DesignObjective::Amplitude | DesignObjective::FrictionLoss) {
        let allowed = format!("\"amplitude\" or \"friction-loss\": {moves}");
        return Err(refuse("design.minimise", asked.minimise.name().into(), &allowed));
    }
    let known = [
        LimitedQuantity::Amplitude,
        LimitedQuantity::FrictionLoss,
        LimitedQuantity::MinimumNormalLoad,
    ];
    if let Some((quantity, limit)) =
        asked.limits.iter().find(|(quantity, _)| !known.contains(quantity))
    {
        let key = format!("design.limits.{}", quantity.name());
        let allowed = format!("amplitude, friction_loss or minimum_normal_load: {moves}");
        return Err(refuse(&key, (*limit).into(), &allowed));
    }
    Ok(())
}

/// Rejects ranges whose ends give no valid study.
fn accepted(study: &DiscStudy, key: &str, ranges: &[DesignRange]) -> Result<(), Failure> {
    let mut wrong: Vec<Complaint> = Vec::new();
    for range in ranges {
        for value in [range.from, range.to] {
            let refused = study.at([(range.path.as_str(), value)]).err();
            wrong.extend(
                refused.into_iter().flatten().map(|complaint| at_end(complaint, key, &range.path)),
            );
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.into()) }
}
