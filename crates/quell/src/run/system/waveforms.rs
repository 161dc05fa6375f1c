//! `waveforms` of a system: the least first dither of each waveform that quenches by averaging, and its cost.
//!
//! The cost is that of the sliding structure without the slope of friction ([`quell_linear::input_cost`]) at the driven point, exact
//! for every waveform: the stroke of bᵀq, the largest velocity, and the mean power ⟨u bᵀq̇⟩ of a force b u(t).

use quell_linear::averaging::{Becomes, DitheredSystem};
use quell_linear::growth::Verdict;
use quell_linear::input_cost::input_cost;
use quell_linear::linearised::Linearised;
use quell_linear::spectrum::spectrum;
use quell_model::profile::{Profile, Wave};
use quell_model::units::Quantity;
use quell_model::{System, Waveform};
use rayon::prelude::*;
use serde_json::Value as Json;

use super::modes::natural;
use super::stability::FAR;
use super::thresholds::reaches_the_band;
use super::{failed, has_equations};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::contact_state::{averaged_without_states, averages_are_a_start, passivity_of_system};
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::run::waveforms::{
    Candidates, duty_cycle, exact_of_system, in_the_band, label, searched,
};
use crate::study::SystemStudy;
use crate::words::digits;

/// The least dither of one waveform.
#[derive(Clone, Debug)]
pub struct LeastInput {
    /// Amplitude.
    pub amplitude: f64,
    /// The larger amplitude from which sliding is unstable again, if any.
    pub until: Option<f64>,
    /// Root mean square.
    pub root_mean_square: f64,
    /// Peak-to-peak displacement of the driven point, or why it has no value.
    pub stroke: Result<f64, String>,
    /// Largest velocity of the driven point.
    pub velocity: Result<f64, String>,
    /// Mean power into the sliding structure.
    pub power: Result<f64, String>,
    /// Why the average, which does not know the state of the contacts, differs from that with it.
    pub without_state: Vec<String>,
}

/// One waveform of a system's comparison.
#[derive(Clone, Debug)]
pub struct SystemWaveform {
    /// The waveform.
    pub waveform: Waveform,
    /// Share of the period in which it acts: 1 except for bursts.
    pub duty_cycle: f64,
    /// Whether it is that of the study.
    pub own: bool,
    /// Whether it repeats too slowly for averaging, compared with the highest eigenfrequency of the structure: then it is never the
    /// best.
    pub slow: bool,
    /// The least dither by averaging, or why no amplitude is known.
    pub averaged: Result<LeastInput, String>,
    /// The exact least amplitude, near that of averaging, or why it is unknown.
    pub exact: Result<f64, String>,
}

/// The waveforms of a system.
#[derive(Clone, Debug)]
pub struct SystemWaveforms {
    /// Every waveform: sine, triangle, square, the study's own, bursts in ascending duty cycle.
    pub rows: Vec<SystemWaveform>,
    /// Name of the carrier of the bursts.
    pub carrier: &'static str,
}

/// A compared quantity: its name in JSON, in words, and its value.
type Column = (&'static str, &'static str, Quantity, fn(&LeastInput) -> Result<f64, String>);

/// The compared quantities.
pub(crate) const COLUMNS: [Column; 5] = [
    ("amplitude", "amplitude", Quantity::Force, |least| Ok(least.amplitude)),
    ("root_mean_square", "rms force", Quantity::Force, |least| Ok(least.root_mean_square)),
    ("power", "power", Quantity::Power, |least| least.power.clone()),
    ("stroke", "stroke", Quantity::Displacement, |least| least.stroke.clone()),
    ("velocity", "velocity", Quantity::Velocity, |least| least.velocity.clone()),
];

/// Compares waveforms of the first dither of a system.
///
/// # Errors
/// A complaint about a study without dither; [`Failure::Failed`] without steady sliding.
pub fn run(study: &SystemStudy) -> Result<SystemWaveforms, Failure> {
    has_equations(study, "waveforms")?;
    let system = study.system();
    let first = system.inputs.first().and_then(|input| input.profile.waves().first());
    let Some(first) = first else {
        let allowed =
            "given: waveforms are compared at the place and the frequency of the study's dither";
        return Err(
            Complaint::new(Fault::Missing, "dither", Origin::Whole, Json::Null, allowed).into()
        );
    };
    let sliding = Linearised::new(system).map_err(|why| failed("waveforms", why))?;
    let Candidates { waveforms, carrier } = Candidates::beside(&first.waveform);
    let motions =
        spectrum(&sliding, &sliding.friction()).map_err(|why| failed("waveforms", why))?;
    let highest = motions.motions.iter().map(natural).fold(0.0, f64::max);
    let rows = waveforms.into_par_iter().map(|waveform| {
        let acting = |amplitude: f64| {
            acting(system, &Wave { waveform: waveform.clone(), amplitude, ..first.clone() })
        };
        let averaged = least(&sliding, &acting(first.amplitude));
        SystemWaveform {
            own: waveform == first.waveform,
            duty_cycle: duty_cycle(&waveform),
            slow: first.frequency / f64::from(waveform.cycles()) < FAR * highest,
            exact: exact(&averaged, &acting),
            averaged,
            waveform,
        }
    });
    Ok(SystemWaveforms { rows: rows.collect(), carrier })
}

/// The system with this wave as its first dither.
fn acting(system: &System, wave: &Wave) -> System {
    let mut changed = system.clone();
    let input = &mut changed.inputs[0];
    input.profile = Profile::constant(input.profile.mean()).with(wave.clone());
    changed
}

/// The exact least amplitude of a system, near the averaged one.
fn exact(
    averaged: &Result<LeastInput, String>,
    acting: &(dyn Fn(f64) -> System + Sync),
) -> Result<f64, String> {
    let averaged = averaged.as_ref().map_err(Clone::clone)?.amplitude;
    if reaches_the_band(&acting(averaged)) {
        return Err(in_the_band());
    }
    let range = searched(averaged, |_| true)?;
    let at = |values: &[f64]| -> Result<System, String> { Ok(acting(values[0])) };
    exact_of_system(&at, averaged, range)
}

/// The least first dither of a system by averaging.
fn least(sliding: &Linearised, changed: &System) -> Result<LeastInput, String> {
    let wave = changed.inputs[0].profile.waves().first().ok_or("there is no dither")?;
    let prepared = DitheredSystem::new(changed).map_err(|why| why.to_string())?;
    let without = prepared.average_with(Some((0, 0.0))).map_err(|why| why.to_string())?;
    let growth = without.growth().map_err(|why| why.to_string())?;
    if growth.verdict() == Verdict::Stable {
        return Err("steady sliding is stable without this dither: nothing to quench".to_owned());
    }
    let found = prepared.critical_amplitudes(0).map_err(|why| why.to_string())?;
    let (place, critical) = found
        .iter()
        .enumerate()
        .find(|(_, critical)| critical.becomes == Becomes::Stable)
        .ok_or("no amplitude of this waveform makes steady sliding stable")?;
    if !critical.contacts_stay_closed {
        return Err("a contact would open at the least amplitude".to_owned());
    }
    let acting = Wave { amplitude: critical.amplitude, ..wave.clone() };
    let cost = input_cost(changed, sliding, &changed.inputs[0].target, &acting);
    let cost = cost.map_err(|why| why.to_string());
    Ok(LeastInput {
        amplitude: critical.amplitude,
        until: found[place..]
            .iter()
            .find(|critical| critical.becomes == Becomes::Unstable)
            .map(|critical| critical.amplitude),
        root_mean_square: critical.amplitude * wave.waveform.root_mean_square(),
        stroke: cost.clone().map(|cost| cost.stroke),
        velocity: cost.clone().map(|cost| cost.velocity),
        power: cost.map(|cost| cost.power),
        without_state: prepared
            .average_with(Some((0, critical.amplitude)))
            .map(|average| averaged_without_states(changed, &average.contacts))
            .unwrap_or_default(),
    })
}

impl SystemWaveform {
    /// A short label, such as "burst 3 : 5": periods of the carrier in the burst and in the pause.
    pub fn label(&self) -> String {
        label(&self.waveform)
    }

    /// A quantity of the least dither, or why it has no value.
    pub(crate) fn value(&self, column: &Column) -> Result<f64, String> {
        self.averaged.as_ref().map_err(Clone::clone).and_then(|least| (column.3)(least))
    }
}

impl SystemWaveforms {
    /// The waveform that is smallest in a column, of those that repeat fast enough for averaging.
    pub(crate) fn best(&self, column: &Column) -> Option<&SystemWaveform> {
        let fast = self.rows.iter().filter(|row| !row.slow);
        let known = fast.filter_map(|row| Some((row, row.value(column).ok()?)));
        known.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(row, _)| row)
    }

    /// The result in one sentence.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let unit =
            study.units().unit(Quantity::Force).map_or(String::new(), |unit| format!(" {unit}"));
        let averaged = if let Some(best) = self.best(&COLUMNS[0]) {
            let value = best.value(&COLUMNS[0]).map_or(String::new(), digits);
            format!(
                "By averaging, of the {} waveforms that repeat fast enough a {} stabilises steady sliding with the least amplitude, \
                 {value}{unit}.",
                self.rows.iter().filter(|row| !row.slow).count(),
                best.label()
            )
        } else if self.rows.iter().any(|row| row.averaged.is_ok()) {
            format!(
                "Every waveform that quenches by averaging repeats at less than {FAR} times the highest eigenfrequency of the sliding \
                 structure, too slowly for averaging to rank them."
            )
        } else {
            let why = self.rows.iter().find_map(|row| row.averaged.as_ref().err());
            format!(
                "By averaging no waveform quenches: {}.",
                why.map_or("none was tried", String::as_str)
            )
        };
        let exact = self.rows.iter().filter_map(|row| Some((row, *row.exact.as_ref().ok()?)));
        let least = exact.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(String::new(), |(row, value)| {
            let (label, value) = (row.label(), digits(value));
            format!(
                " Exactly, at the study's frequency, the least amplitude is that of a {label}, {value}{unit}."
            )
        });
        averaged + &least
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let units = study.units();
        let rows = self.rows.iter().map(|row| {
            let mut inner = Fields::of_system(units);
            inner
                .plain("waveform", row.waveform.name())
                .plain("label", row.label())
                .plain("own", row.own)
                .plain("slow", row.slow)
                .number("duty_cycle", Quantity::Ratio, row.duty_cycle);
            if let Waveform::Burst(burst) = &row.waveform {
                inner.plain("on", burst.on()).plain("off", burst.off());
            }
            for column in &COLUMNS {
                inner.known(column.0, column.2, row.value(column));
            }
            let until = row.averaged.as_ref().map_err(Clone::clone).and_then(|least| {
                least.until.ok_or_else(|| "no larger amplitude makes it unstable again".to_owned())
            });
            inner.known("until", Quantity::Force, until).known(
                "exact_amplitude",
                Quantity::Force,
                row.exact.clone(),
            );
            inner
        });
        let mut best = Fields::of_system(units);
        for column in &COLUMNS {
            match self.best(column) {
                Some(row) => best.plain(column.0, row.label()),
                None => best.unknown(
                    column.0,
                    "no waveform that repeats fast enough for averaging has a value",
                ),
            };
        }
        let mut fields = Fields::of_system(units);
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("carrier", self.carrier)
            .list("waveforms", rows)
            .nested("best", best)
            .plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// The warnings of the study, and one about waveforms whose repetition is not fast.
    pub fn warnings(&self, study: &SystemStudy) -> Vec<String> {
        let mut warnings = study.warnings().to_vec();
        warnings.extend(passivity_of_system(study));
        let mut known = self.rows.iter().filter_map(|row| row.averaged.as_ref().ok());
        let because = known.find_map(|least| least.without_state.first());
        warnings.extend(because.map(|because| averages_are_a_start(because)));
        let slow: Vec<String> =
            self.rows.iter().filter(|row| row.slow).map(SystemWaveform::label).collect();
        if !slow.is_empty() {
            warnings.push(format!(
                "{} repeat{} at less than {FAR} times the highest eigenfrequency of the sliding structure: averaging assumes that a \
                 dither is much faster than every motion, and the least amplitude there is that of a resonance; none of them is called best",
                slow.join(", "),
                if slow.len() == 1 { "s" } else { "" }
            ));
        }
        warnings
    }

    /// As a dataset: one row for each waveform.
    pub fn dataset(&self, study: &SystemStudy) -> Dataset {
        let numbers = (0..self.rows.len()).map(|number| number as f64).collect();
        let names: Vec<(u8, &'static str)> =
            (0_u8..).zip(Waveform::NAMES.iter().copied()).collect();
        let code = |row: &SystemWaveform| {
            names.iter().find(|(_, name)| *name == row.waveform.name()).map_or(0, |(code, _)| *code)
        };
        let codes: Vec<u8> = self.rows.iter().map(code).collect();
        let mut dataset = Dataset::of(&study.into(), "waveforms")
            .with_axis(Array::new("number", "1", numbers))
            .with(Array::of_words("waveform", names.clone(), &codes))
            .with(Array::new(
                "duty_cycle",
                "1",
                self.rows.iter().map(|row| row.duty_cycle).collect(),
            ));
        for column in &COLUMNS {
            let values = self.rows.iter().map(|row| row.value(column).unwrap_or(f64::NAN));
            let unit = study.units().unit(column.2).unwrap_or("1");
            dataset = dataset.with(Array::new(column.0, unit, values.collect()));
        }
        let exact = self.rows.iter().map(|row| *row.exact.as_ref().unwrap_or(&f64::NAN));
        let unit = study.units().unit(Quantity::Force).unwrap_or("1");
        dataset.with(Array::new("exact_amplitude", unit, exact.collect()))
    }
}
