//! `design` of a belt.

use std::sync::Arc;

use quell_design::least_dither::{
    BeltPlant, OperatingPoint, Plant, SampledQuiet, SystemAtPoint, SystemPlant,
};
use quell_model::units::Quantity;
use quell_model::{Belt, Waveform};

use super::found::{DesignNumber, DesignNumbers, LeastDitherFound, TriedDither};
use super::least::{asked, least_dither, least_dither_of_systems, without_amplitude};
use super::waveform::with_waveform;
use crate::complaint::{Complaint, Failure, Origin};
use crate::contact_state::refused_of_belt;
use crate::run::varied::Named;
use crate::study::{BeltStudy, DesignRange, ParameterId};

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
        vary.into_iter().partition(|(named, _)| is_own(&named.path));
    let [(amplitude_key, amplitude)] = amplitude.as_slice() else {
        let allowed = format!(
            "a list with {own}, the amplitude of the first dither, once: the least one is sought"
        );
        return Err(without_amplitude(asked, allowed));
    };
    // The amplitude of the study must not make a point invalid.
    let quiet = amplitude_key.set(0.0);
    let set = |numbers: &[(Named, DesignNumber)]| -> Vec<Named> {
        numbers.iter().map(|(named, _)| named.clone()).collect()
    };
    let (over_keys, other_keys) = (set(&over), set(&others));
    let plant = |waveform: &Waveform, sample: &[(ParameterId, f64)]| -> BeltPlant<'_> {
        let (over, others) = (over_keys.clone(), other_keys.clone());
        let (waveform, quiet, sample) = (waveform.clone(), quiet.clone(), sample.to_vec());
        let at = move |at: OperatingPoint<'_>| {
            let point = over.iter().zip(at.point).chain(others.iter().zip(at.others));
            let point = point.map(|(named, value)| named.set(*value));
            let numbers: Vec<_> =
                sample.iter().cloned().chain([quiet.clone()]).chain(point).collect();
            let setup = study.setup_at(&numbers).map_err(|why| why.to_string())?;
            with_waveform(setup.belt(), &waveform).map_err(|why| why.to_string())
        };
        BeltPlant { at: Arc::new(at), start: asked.start }
    };
    let tried = |waveform: &Waveform| -> TriedDither<'_, BeltPlant<'_>> {
        let (waveform, plant) = (waveform.clone(), plant(waveform, &[]));
        TriedDither { waveform, place: None, study, plant }
    };
    let tried: Vec<TriedDither<'_, BeltPlant<'_>>> = asked.waveforms.iter().map(tried).collect();
    let only = |numbers: Vec<(Named, DesignNumber)>| -> Vec<DesignNumber> {
        numbers.into_iter().map(|(_, number)| number).collect()
    };
    let numbers =
        DesignNumbers { amplitude: amplitude.clone(), others: only(others), over: only(over) };
    let samples = |waveform: usize, values: &[(&str, f64)], others: &[f64]| {
        let values = study.model().numbers(values).map_err(|why| why.to_string())?;
        let sample = study.setup_at(&values).map_err(|why| why.to_string())?;
        // The equations of a sample may have other scales: its mass or its stiffness may be uncertain.
        let force =
            |belt: &Belt| belt.scales().map_or(1.0, |scales| scales.per_unit(Quantity::Force));
        let factor = force(belt) / force(sample.belt());
        let plant = plant(&asked.waveforms[waveform], &values);
        Ok(sampled(&plant, factor, others, belt.has_contact_state()))
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

/// The quiet amplitudes of a sample of an uncertain belt, one unit of whose amplitudes is `factor` of those of the sample's equations.
fn sampled<'a>(
    plant: &BeltPlant<'a>,
    factor: f64,
    others: &[f64],
    has_state: bool,
) -> SampledQuiet<'a> {
    let exactly = |exactly: bool| {
        let (plant, others) = (plant.clone(), others.to_vec());
        move |point: &[f64], (from, to): (f64, f64)| {
            let at = OperatingPoint { point, others: &others };
            let range = (factor * from, factor * to);
            let found = if has_state {
                let system = |at: OperatingPoint<'_>, value: f64| plant.system(at, value);
                let of = SystemPlant { at: &system, input: 0, observe: &[], start: plant.start };
                if exactly { of.exact(at, range) } else { of.averaged(at, range) }
            } else if exactly {
                plant.exact(at, range)
            } else {
                plant.averaged(at, range)
            };
            Ok(found?.times(1.0 / factor))
        }
    };
    SampledQuiet { averaged: Box::new(exactly(false)), exact: Box::new(exactly(true)) }
}

/// Numbers of `[design]` with the keys that give them. Both ends of every range must give valid studies.
fn numbers(
    study: &BeltStudy,
    key: &str,
    ranges: &[DesignRange],
) -> Result<Vec<(Named, DesignNumber)>, Failure> {
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
            let refused = study.with(&range.path, value).err().into_iter().flatten();
            wrong.extend(refused.map(|complaint| placed(complaint, &range.path)));
        }
        let ends = (range.from, range.to);
        let idle = named.without_effect(study, "[design]", ends).filter(|_| ends.0 < ends.1);
        wrong.extend(idle.map(|complaint| Complaint {
            key: format!("design.{key}"),
            origin: Origin::Whole,
            ..complaint
        }));
        let number = DesignNumber {
            path: range.path.clone(),
            per_unit: 1.0 / named.of(1.0),
            range: (named.of(range.from), named.of(range.to)),
        };
        found.push((named, number));
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
