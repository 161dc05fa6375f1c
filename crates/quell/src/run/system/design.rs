//! `design` of a system: the least amplitude of one of its dithers that is quiet over a box of operating points, under limits.

use quell_design::least_dither::{OperatingPoint, Plant, SampledQuiet, SystemAtPoint, SystemPlant};
use quell_model::{System, Waveform};

use super::has_equations;
use crate::complaint::{Complaint, Failure, Origin};
use crate::run::design::{
    DesignNumber, DesignNumbers, LeastDitherFound, asked, least_dither_of_systems,
    system_with_waveform, without_amplitude,
};
use crate::study::{DesignRange, SystemStudy};

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
        let allowed = "a list with the amplitude of one dither, such as dither.amplitude: the least one is sought";
        return Err(without_amplitude(asked, allowed.to_owned()));
    };
    let input = study.dither_of(&amplitude.path).unwrap_or(0);
    accepted(study, "vary", &asked.vary)?;
    accepted(study, "over", &asked.over)?;
    let at = |waveform: &Waveform, at: OperatingPoint<'_>, value: f64| -> Result<System, String> {
        let over = asked.over.iter().map(|range| range.path.as_str()).zip(at.point.iter().copied());
        let other = others.iter().map(|range| range.path.as_str()).zip(at.others.iter().copied());
        let numbers: Vec<(&str, f64)> =
            over.chain(other).chain([(amplitude.path.as_str(), value)]).collect();
        let system = study.system_at(&numbers).map_err(|why| why.to_string())?;
        Ok(system_with_waveform(system, input, waveform))
    };
    let systems: Vec<(Waveform, Box<SystemAtPoint<'_>>)> = asked
        .waveforms
        .iter()
        .map(|waveform| {
            let system = move |point: OperatingPoint<'_>, value: f64| at(waveform, point, value);
            (waveform.clone(), Box::new(system) as Box<SystemAtPoint<'_>>)
        })
        .collect();
    // The values of a path are those of the study: the equations are in its units.
    let number = |range: &DesignRange| DesignNumber {
        path: range.path.clone(),
        per_unit: 1.0,
        range: (range.from, range.to),
    };
    let numbers = DesignNumbers {
        amplitude: number(amplitude),
        others: others.iter().map(|range| number(range)).collect(),
        over: asked.over.iter().map(number).collect(),
    };
    let paths: Vec<&str> =
        asked.over.iter().chain(others.iter().copied()).map(|range| range.path.as_str()).collect();
    let samples = |waveform: usize, values: &[(&str, f64)], others: &[f64]| {
        let waveform = asked.waveforms[waveform].clone();
        let fixed: Vec<(String, f64)> =
            values.iter().map(|(path, value)| ((*path).to_owned(), *value)).collect();
        let (paths, own, path) = (paths.clone(), others.to_vec(), amplitude.path.as_str());
        let system = move |at: OperatingPoint<'_>, value: f64| -> Result<System, String> {
            let fixed = fixed.iter().map(|(path, value)| (path.as_str(), *value));
            let chosen = paths.iter().copied().zip(at.point.iter().chain(at.others).copied());
            let numbers: Vec<(&str, f64)> = fixed.chain(chosen).chain([(path, value)]).collect();
            let system = study.system_at(&numbers).map_err(|why| why.to_string())?;
            Ok(system_with_waveform(system, input, &waveform))
        };
        // A sample that is no valid study must not be one whose dither is too small.
        let at = |others: &[f64]| {
            let point: Vec<f64> = asked.over.iter().map(|range| range.from).collect();
            system(OperatingPoint { point: &point, others }, amplitude.from).map(|_| ())
        };
        at(&own)?;
        let exactly = |exactly: bool| {
            let (system, others) = (system.clone(), own.clone());
            move |point: &[f64], range: (f64, f64)| {
                let of = SystemPlant { at: &system, input, observe: &[], start: asked.start };
                let at = OperatingPoint { point, others: &others };
                if exactly { of.exact(at, range) } else { of.averaged(at, range) }
            }
        };
        Ok(SampledQuiet { averaged: Box::new(exactly(false)), exact: Box::new(exactly(true)) })
    };
    let observe = study.observe();
    least_dither_of_systems(study, asked, &numbers, &systems, (input, &observe), &samples)
}

/// Rejects ranges whose ends give no valid study.
fn accepted(study: &SystemStudy, key: &str, ranges: &[DesignRange]) -> Result<(), Failure> {
    let mut wrong: Vec<Complaint> = Vec::new();
    for range in ranges {
        for value in [range.from, range.to] {
            let refused = study.system_at(&[(range.path.as_str(), value)]).err();
            wrong.extend(refused.into_iter().flatten().map(|complaint| Complaint {
                key: format!("design.{key}"),
                origin: Origin::Whole,
                allowed: format!("{}: {}", range.path, complaint.allowed),
                ..complaint
            }));
        }
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong.into()) }
}
