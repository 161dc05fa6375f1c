//! `design` of a system: the least amplitude of one of its dithers that is quiet over a box of operating points, under limits.

use std::borrow::Cow;

use quell_design::least_dither::{OperatingPoint, Plant, SampledQuiet, SystemAtPoint, SystemPlant};
use quell_model::{RefusedNumbers, System, Waveform};
use quell_numerics::interval::RealInterval;

use super::has_equations;
use crate::complaint::{Complaint, Failure};
use crate::run::design::{
    DesignNumber, DesignNumbers, LeastDitherFound, TriedDither, asked, at_end,
    least_system_dithers, system_with_waveform, without_amplitude,
};
use crate::study::{Design, DesignRange, SystemStudy};

/// The least dither of a system.
///
/// # Errors
/// A complaint about a study without `[design]` or without equations, and about a number in it.
pub fn run(study: &SystemStudy) -> Result<LeastDitherFound, Failure> {
    has_equations(study, "design")?;
    let asked = asked(study, !study.system().inputs.is_empty())?;
    let is_amplitude = |range: &&DesignRange| study.dither_of(&range.path).is_some();
    let (amplitude, others): (Vec<_>, Vec<_>) = asked.vary.iter().partition(is_amplitude);
    let [amplitude] = amplitude.as_slice() else {
        let allowed = "a list with the amplitude of one dither as a force, such as dither.amplitude: the least one is sought, and what an actuator takes follows from it";
        return Err(without_amplitude(asked, allowed.to_owned()));
    };
    let input = study.dither_of(&amplitude.path).unwrap_or(0);
    let studies = at_places(study, asked, (input, (amplitude.path.as_str(), amplitude.from)))?;
    let over_paths = asked.over.iter().map(|range| range.path.as_str());
    let other_paths = others.iter().map(|range| range.path.as_str());
    let paths: Vec<&str> = over_paths.chain(other_paths).collect();
    let (paths, amplitude_path) = (&paths, amplitude.path.as_str());
    let system_of = |study: &SystemStudy,
                     waveform: &Waveform,
                     fixed: &[(String, f64)],
                     (at, value): (OperatingPoint<'_>, f64)|
     -> Result<System, RefusedNumbers> {
        let fixed = fixed.iter().map(|(path, value)| (path.as_str(), *value));
        let chosen = paths.iter().copied().zip(at.point.iter().chain(at.others).copied());
        let numbers: Vec<(&str, f64)> =
            fixed.chain(chosen).chain([(amplitude_path, value)]).collect();
        let model = study.model();
        let numbers = model.numbers(&numbers).map_err(RefusedNumbers::by_study)?;
        let system = model.at(&numbers).map_err(RefusedNumbers::by_study)?;
        Ok(system_with_waveform(system, input, waveform))
    };
    let system_of = &system_of;
    let mut systems: Vec<TriedDither<'_, Box<SystemAtPoint<'_>>>> = Vec::new();
    for (place, study) in &studies {
        for waveform in &asked.waveforms {
            let system = move |point: OperatingPoint<'_>, value: f64| {
                system_of(study, waveform, &[], (point, value))
            };
            systems.push(TriedDither {
                waveform: waveform.clone(),
                place: place.clone(),
                study: study.as_ref(),
                plant: Box::new(system) as Box<SystemAtPoint<'_>>,
            });
        }
    }
    // The values of a path are those of the study: the equations are in its units.
    let number = |range: &DesignRange| DesignNumber {
        path: range.path.clone(),
        per_unit: 1.0,
        unit: study.unit_of(&range.path).filter(|unit| *unit != "1").unwrap_or("").to_owned(),
        range: RealInterval::new(range.from, range.to),
    };
    let numbers = DesignNumbers {
        amplitude: number(amplitude),
        others: others.iter().map(|range| number(range)).collect(),
        over: asked.over.iter().map(number).collect(),
    };
    let samples = |tried: usize, values: &[(&str, f64)], others: &[f64]| {
        let study = studies[tried / asked.waveforms.len()].1.as_ref();
        let waveform = asked.waveforms[tried % asked.waveforms.len()].clone();
        let fixed: Vec<(String, f64)> =
            values.iter().map(|(path, value)| ((*path).to_owned(), *value)).collect();
        let own = others.to_vec();
        let system = move |at: OperatingPoint<'_>, value: f64| {
            system_of(study, &waveform, &fixed, (at, value))
        };
        // A sample that is no valid study must not be one whose dither is too small.
        let at = |others: &[f64]| {
            let point: Vec<f64> = asked.over.iter().map(|range| range.from).collect();
            system(OperatingPoint { point: &point, others }, amplitude.from).map(|_| ())
        };
        at(&own)?;
        let exactly = |exactly: bool| {
            let (system, others) = (system.clone(), own.clone());
            move |point: &[f64], range: RealInterval| {
                let of = SystemPlant { at: &system, input, observe: &[], start: asked.start };
                let at = OperatingPoint { point, others: &others };
                if exactly { of.exact(at, range) } else { of.averaged(at, range) }
            }
        };
        Ok(SampledQuiet { averaged: Box::new(exactly(false)), exact: Box::new(exactly(true)) })
    };
    let observe = study.observe();
    least_system_dithers(study, asked, &numbers, &systems, (input, &observe), &samples)
}

/// The study with the dither at a place, and its name; without a name as it is.
type StudyAtPlace<'s> = (Option<String>, Cow<'s, SystemStudy>);

/// The study with the dither at every place that is tried, or as it is.
fn at_places<'s>(
    study: &'s SystemStudy,
    asked: &Design,
    (input, amplitude): (usize, (&str, f64)),
) -> Result<Vec<StudyAtPlace<'s>>, Failure> {
    let mut studies = Vec::new();
    for place in &asked.places {
        let at = study.at_place(input, place, amplitude)?;
        studies.push((Some(place.name.clone()), Cow::Owned(at)));
    }
    if studies.is_empty() {
        studies.push((None, Cow::Borrowed(study)));
    }
    for (place, study) in &studies {
        accepted(study, place.as_deref(), ("vary", &asked.vary))?;
        accepted(study, place.as_deref(), ("over", &asked.over))?;
    }
    Ok(studies)
}

/// Rejects ranges whose ends give no valid study.
fn accepted(
    study: &SystemStudy,
    place: Option<&str>,
    (key, ranges): (&str, &[DesignRange]),
) -> Result<(), Failure> {
    let at = place.map_or(String::new(), |place| format!(" at {place}"));
    let mut wrong: Vec<Complaint> = Vec::new();
    let model = study.model();
    for range in ranges {
        for value in [range.from, range.to] {
            let refused = model.at(&[(model.parameter(&range.path)?, value)]).err();
            let path = format!("{}{at}", range.path);
            wrong.extend(
                refused.into_iter().flatten().map(|complaint| at_end(complaint, key, &path)),
            );
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.into()) }
}
