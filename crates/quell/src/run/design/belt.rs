//! `design` of a belt.

use quell_design::least_dither::{
    BeltPlant, OperatingPoint, Plant, SampledQuiet, SystemAtPoint, SystemPlant,
};
use quell_model::Waveform;

use super::found::{DesignNumber, DesignNumbers, LeastDitherFound, TriedDither};
use super::least::{asked, least_dither, least_dither_of_systems, without_amplitude};
use super::waveform::with_waveform;
use crate::complaint::{Complaint, Failure, Origin};
use crate::contact_state::refused_of_belt;
use crate::run::varied::Named;
use crate::study::{BeltStudy, DesignRange};

/// The least dither of a belt.
///
/// # Errors
/// A complaint about a study without `[design]` or a number in it; runs from afar of a contact with a state.
pub fn run(study: &BeltStudy) -> Result<LeastDitherFound, Failure> {
    refused_of_belt(study, "design")?;
    let belt = study.belt();
    let asked = asked(study, !belt.dithers().is_empty())?;
    let (vary, over) = (numbers(study, "vary", &asked.vary)?, numbers(study, "over", &asked.over)?);
    let own = belt.dither_path(0, "amplitude");
    let is_own = |path: &str| path == own || path == "dither.amplitude";
    let (amplitude, others): (Vec<_>, Vec<_>) =
        vary.into_iter().partition(|(path, _)| is_own(path));
    let [(_, amplitude)] = amplitude.as_slice() else {
        let allowed = format!(
            "a list with {own}, the amplitude of the first dither, once: the least one is sought"
        );
        return Err(without_amplitude(asked, allowed));
    };
    let paths = |numbers: &[(String, DesignNumber)]| -> Vec<String> {
        numbers.iter().map(|(path, _)| path.clone()).collect()
    };
    let (over_paths, other_paths) = (paths(&over), paths(&others));
    let plant = |waveform: &Waveform| -> Result<BeltPlant, Failure> {
        let belt = with_waveform(belt, waveform).map_err(|why| failed(why.to_string()))?;
        let (over, others) = (over_paths.clone(), other_paths.clone());
        Ok(BeltPlant { belt, over, others, start: asked.start })
    };
    let tried = |waveform: &Waveform| -> Result<TriedDither<'_, BeltPlant>, Failure> {
        let (waveform, plant) = (waveform.clone(), plant(waveform)?);
        Ok(TriedDither { waveform, place: None, study, plant })
    };
    let tried: Vec<TriedDither<'_, BeltPlant>> =
        asked.waveforms.iter().map(tried).collect::<Result<_, Failure>>()?;
    let only = |numbers: Vec<(String, DesignNumber)>| -> Vec<DesignNumber> {
        numbers.into_iter().map(|(_, number)| number).collect()
    };
    let numbers =
        DesignNumbers { amplitude: amplitude.clone(), others: only(others), over: only(over) };
    let samples = |waveform: usize, values: &[(&str, f64)], others: &[f64]| {
        sampled(study, &tried[waveform].plant, &numbers, values, others)
    };
    if !belt.has_contact_state() {
        return least_dither(study, asked, &numbers, &tried, Ok(&samples));
    }
    let systems: Vec<TriedDither<'_, Box<SystemAtPoint<'_>>>> = tried
        .iter()
        .map(|TriedDither { waveform, plant, .. }| {
            let at = move |point: OperatingPoint<'_>, value: f64| plant.system(point, value);
            let (waveform, plant) = (waveform.clone(), Box::new(at) as Box<SystemAtPoint<'_>>);
            TriedDither { waveform, place: None, study, plant }
        })
        .collect();
    least_dither_of_systems(study, asked, &numbers, &systems, (0, &[1.0]), &samples)
}

/// The quiet amplitudes of a sample of an uncertain belt, whose equations may have other scales: its mass or its stiffness may be
/// uncertain.
fn sampled(
    study: &BeltStudy,
    plant: &BeltPlant,
    numbers: &DesignNumbers,
    values: &[(&str, f64)],
    others: &[f64],
) -> Result<SampledQuiet<'static>, String> {
    let sample = study.at(values.iter().copied()).map_err(|why| why.to_string())?;
    let first = plant.belt.dithers().first().ok_or("the study has no dither")?;
    let belt = with_waveform(sample.belt(), &first.waveform).map_err(|why| why.to_string())?;
    // Numbers of the sample's equations that one of the study's is.
    let factor = |number: &DesignNumber| -> Result<f64, String> {
        let named = Named::new(&sample, "[design]", &number.path).map_err(|why| why.to_string())?;
        Ok(named.of(number.per_unit))
    };
    let factors = |numbers: &[DesignNumber]| -> Result<Vec<f64>, String> {
        numbers.iter().map(factor).collect()
    };
    let times = |values: &[f64], factors: &[f64]| -> Vec<f64> {
        values.iter().zip(factors).map(|(value, factor)| value * factor).collect()
    };
    let amplitude = factor(&numbers.amplitude)?;
    let over = factors(&numbers.over)?;
    let others = times(others, &factors(&numbers.others)?);
    let plant = BeltPlant { belt, ..plant.clone() };
    let exactly = |exactly: bool| {
        let (plant, over, others) = (plant.clone(), over.clone(), others.clone());
        move |point: &[f64], (from, to): (f64, f64)| {
            let point = times(point, &over);
            let at = OperatingPoint { point: &point, others: &others };
            let range = (amplitude * from, amplitude * to);
            let found = match (exactly, plant.belt.has_contact_state()) {
                (true, false) => plant.exact(at, range),
                (false, false) => plant.averaged(at, range),
                (exactly, true) => {
                    let system = |at: OperatingPoint<'_>, value: f64| plant.system(at, value);
                    let of =
                        SystemPlant { at: &system, input: 0, observe: &[], start: plant.start };
                    if exactly { of.exact(at, range) } else { of.averaged(at, range) }
                }
            };
            Ok(found?.times(1.0 / amplitude))
        }
    };
    Ok(SampledQuiet { averaged: Box::new(exactly(false)), exact: Box::new(exactly(true)) })
}

/// Numbers of `[design]` with their paths in the equations. Both ends of every range must give valid studies.
fn numbers(
    study: &BeltStudy,
    key: &str,
    ranges: &[DesignRange],
) -> Result<Vec<(String, DesignNumber)>, Failure> {
    let mut found = Vec::new();
    let mut wrong: Vec<Complaint> = Vec::new();
    let placed = |complaint: Complaint, path: &str| at_end(complaint, key, path);
    for range in ranges {
        let named = match Named::new(study, "[design]", &range.path) {
            Ok(named) => named,
            Err(complaint) => {
                wrong.push(placed(*complaint, &range.path));
                continue;
            }
        };
        for value in [range.from, range.to] {
            let refused = named.unable(study, ("[design]", value));
            wrong.extend(refused.map(|complaint| placed(complaint, &range.path)));
        }
        let number = DesignNumber {
            path: range.path.clone(),
            per_unit: 1.0 / named.of(1.0),
            range: (named.of(range.from), named.of(range.to)),
        };
        found.push((named.path.clone(), number));
    }
    if wrong.is_empty() { Ok(found) } else { Err(wrong.into()) }
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
        allowed,
        ..complaint
    }
}

fn failed(why: String) -> Failure {
    Failure::Failed { key: "design".to_owned(), why }
}
