//! `resonances` of a system: how far each dither reaches each contact, over its frequency.
//!
//! The slip amplitude per unit of dither has peaks at the resonances of the sliding structure, where little dither suffices, and
//! dips at antiresonances, where the dither cannot reach the contact.

use quell_linear::harmonic::response;
use quell_linear::linearised::{FrictionSlopes, Linearised};
use quell_linear::spectrum::{SmallMotion, spectrum};
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;
use quell_numerics::polar::modulus;
use quell_numerics::roots::{Closeness, minimise};
use serde_json::Value as Json;

use super::{checked_frequencies, failed, has_equations};
use crate::complaint::{Complaint, Complaints, Failure};
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::run::design::StudyWithDesign;
use crate::run::disc::resonances::Order;
use crate::study::SystemStudy;
use crate::words::{counted, digits};

/// Frequencies of the response, at equal ratios.
const POINTS: usize = 801;

/// A dip below this share of the mean response in its neighbourhood (an octave) is reported as out of reach.
const OUT_OF_REACH: f64 = 1e-3;

/// At an undamped resonance the response exceeds that at a relative distance of [`BESIDE`] by this factor: the inverse of the
/// distance, limited by rounding.
const UNBOUNDED: f64 = 1e3;

/// Relative distance from a resonance.
const BESIDE: f64 = 1e-6;

/// Why a slip amplitude is unknown at an undamped resonance.
pub const UNBOUNDED_RESONANCE: &str = "unbounded (undamped resonance)";

/// A peak or dip of the response of a contact to a dither.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReachExtreme {
    /// Angular frequency.
    pub frequency: f64,
    /// Slip amplitude per unit of dither; `None` at an undamped resonance, where it is unbounded.
    pub slip_per_amplitude: Option<f64>,
    /// Whether it is a peak.
    pub peak: bool,
    /// Whether the dither hardly reaches the contact there.
    pub out_of_reach: bool,
}

/// The response of one contact to one dither.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactReach {
    /// The dither, counted from 0.
    pub dither: usize,
    /// The contact, counted from 0.
    pub contact: usize,
    /// Slip amplitude per unit of dither at each frequency.
    pub slip: Vec<f64>,
    /// Peaks and dips, ascending.
    pub extremes: Vec<ReachExtreme>,
}

/// How far the dithers of a system reach its contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct Reaches {
    /// Angular frequencies, ascending.
    pub frequencies: Vec<f64>,
    /// Every pair of a dither and a contact.
    pub pairs: Vec<ContactReach>,
}

/// Rejects the options of `resonances` that only discs have.
///
/// # Errors
/// A complaint about each option given.
pub fn without_waves(
    speeds: Option<&str>,
    order: Order,
    clear: Option<&str>,
) -> Result<(), Complaints> {
    let order = (order == Order::Second).then_some("second");
    let given = [("--speeds", speeds), ("--order", order), ("--clear", clear)];
    let allowed = "left out: a system has no waves that meet; --frequency gives a range of dither frequencies";
    let wrong: Vec<Complaint> = given
        .into_iter()
        .filter_map(|(option, text)| Some(Complaint::option(option, text?, allowed)))
        .collect();
    if wrong.is_empty() { Ok(()) } else { Err(wrong.into()) }
}

/// The responses of a study over a range of angular frequencies.
///
/// # Errors
/// A complaint about the range; [`Failure::Failed`] without steady sliding or dither.
pub fn run(study: &SystemStudy, range: Option<RealInterval>) -> Result<Reaches, Failure> {
    has_equations(study, "resonances")?;
    let system = study.system();
    if system.inputs.is_empty() {
        return Err(failed("resonances", "the study has no dither whose reach could be computed"));
    }
    let linear = Linearised::new(system).map_err(|why| failed("resonances", why))?;
    let waves = system.waves();
    let own = waves.map(|wave| wave.frequency).fold(0.0, f64::max);
    let RealInterval { lower: from, upper: to } =
        checked_frequencies(range.unwrap_or(RealInterval::new(0.1 * own, 10.0 * own)), false)?;
    // The quotient of the ends may overflow, their roots do not.
    let half = libm::log(libm::sqrt(to) / libm::sqrt(from));
    let share = |k: usize| k as f64 / (POINTS - 1) as f64;
    let at = |k: usize| from * libm::exp(half * share(k)) * libm::exp(half * share(k));
    let frequencies: Vec<f64> = (0..POINTS).map(|k| at(k).clamp(from, to)).collect();
    let undamped = undamped(&linear);
    let heaviest = linear.matrices().map_or(1.0, |matrices| matrices.mass.largest());
    let mut pairs = Vec::new();
    for (dither, input) in system.inputs.iter().enumerate() {
        let slips = |frequency: f64| -> Option<Vec<f64>> {
            let found = response(system, &linear, &input.target, frequency)?;
            Some(found.contacts.iter().map(|contact| modulus(contact.slip)).collect())
        };
        let table: Vec<Option<Vec<f64>>> = frequencies.iter().map(|w| slips(*w)).collect();
        let known = |frequency: f64, row: &Option<Vec<f64>>| {
            (frequency * frequency * heaviest).is_finite()
                && row.iter().flatten().all(|slip| !slip.is_nan())
        };
        let rows = frequencies.iter().zip(&table);
        let within: Vec<f64> =
            rows.filter(|(w, row)| known(**w, row)).map(|(frequency, _)| *frequency).collect();
        if within.len() < frequencies.len() {
            return Err(beyond_range(RealInterval::new(from, to), &within));
        }
        for contact in 0..system.contacts.len() {
            let at =
                |frequency: f64| slips(frequency).map_or(f64::INFINITY, |found| found[contact]);
            let slip: Vec<f64> = table
                .iter()
                .map(|row| row.as_ref().map_or(f64::INFINITY, |row| row[contact]))
                .collect();
            let extremes = extremes(&frequencies, &slip, &undamped, at);
            pairs.push(ContactReach { dither, contact, slip, extremes });
        }
    }
    Ok(Reaches { frequencies, pairs })
}

/// The complaint about a range of frequencies at some of which the equations of the structure overflow.
/// `within` has those at which they do not.
fn beyond_range(RealInterval { lower: from, upper: to }: RealInterval, within: &[f64]) -> Failure {
    let allowed = match (within.first(), within.last()) {
        (Some(first), Some(last)) => format!(
            "a range between the angular frequencies {} and {}: beyond them the equations of the structure overflow",
            digits(*first),
            digits(*last)
        ),
        _ => "a range in which the equations of the structure do not overflow".to_owned(),
    };
    Complaint::option("--frequency", format!("{from}:{to}"), allowed).into()
}

/// Angular frequencies of the motions without damping, with the friction that a harmonic response carries along.
fn undamped(linear: &Linearised) -> Vec<f64> {
    let frozen: Vec<FrictionSlopes> = linear
        .friction()
        .into_iter()
        .map(|friction| FrictionSlopes { by_velocity: 0.0, ..friction.at_once() })
        .collect();
    let Ok(found) = spectrum(linear, &frozen) else { return Vec::new() };
    let undamped = found
        .motions
        .iter()
        .filter(|motion| motion.eigenvalue.im > 0.0 && motion.eigenvalue.re.abs() <= motion.error);
    undamped.map(SmallMotion::frequency).collect()
}

/// Peaks and dips of a response, located between the sampled frequencies; `undamped` has the frequencies at which a peak may be
/// unbounded.
fn extremes(
    frequencies: &[f64],
    slip: &[f64],
    undamped: &[f64],
    at: impl Fn(f64) -> f64,
) -> Vec<ReachExtreme> {
    let mut found = Vec::new();
    for k in 1..slip.len().saturating_sub(1) {
        let (before, here, after) = (slip[k - 1], slip[k], slip[k + 1]);
        let peak = here > before && here >= after;
        let dip = here < before && here <= after;
        if !peak && !dip {
            continue;
        }
        let sign = if peak { -1.0 } else { 1.0 };
        let ends = (frequencies[k - 1], frequencies[k + 1]);
        let Ok(best) = minimise(|w| sign * at(w), ends.0, ends.1, Closeness::default()) else {
            continue;
        };
        let value = sign * best.value;
        let unbounded = |pole: &&f64| {
            let inside = **pole >= ends.0 && **pole <= ends.1;
            inside && at(**pole) >= UNBOUNDED * at(**pole * (1.0 + BESIDE))
        };
        if let Some(&frequency) = undamped.iter().find(unbounded).filter(|_| peak) {
            let (slip_per_amplitude, out_of_reach) = (None, false);
            found.push(ReachExtreme { frequency, slip_per_amplitude, peak, out_of_reach });
            continue;
        }
        let octave = frequencies.iter().zip(slip).filter(|(w, s)| {
            s.is_finite() && **w > 0.5 * best.location && **w < 2.0 * best.location
        });
        let (sum, count) = octave.fold((0.0, 0.0), |(sum, count), (_, s)| (sum + s, count + 1.0));
        let out_of_reach = dip && value <= OUT_OF_REACH * sum / f64::max(count, 1.0);
        found.push(ReachExtreme {
            frequency: best.location,
            slip_per_amplitude: Some(value),
            peak,
            out_of_reach,
        });
    }
    found
}

impl Reaches {
    /// The answer in one sentence.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let count =
            self.pairs.iter().flat_map(|pair| &pair.extremes).filter(|at| at.out_of_reach).count();
        let peaks = self.pairs.iter().flat_map(|pair| &pair.extremes).filter(|at| at.peak).count();
        let scale = study.frequency_scale();
        let [first, last] = [self.frequencies.first(), self.frequencies.last()]
            .map(|end| digits(scale.of(end.copied().unwrap_or(0.0))));
        let antiresonances = match count {
            0 => String::new(),
            _ => format!(
                ", and {} where it does not reach a contact",
                counted(count, "antiresonance")
            ),
        };
        let peaks = match peaks {
            0 => "no resonance".to_owned(),
            _ => counted(peaks, "resonance"),
        };
        format!("The dither has {peaks} from {first} to {last}{}{antiresonances}.", scale.unit)
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let units = study.units();
        let mut fields = Fields::in_units(units);
        let first = self.frequencies.first().copied().unwrap_or(0.0);
        let last = self.frequencies.last().copied().unwrap_or(0.0);
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .number("from", Quantity::FrequencyRatio, first)
            .number("to", Quantity::FrequencyRatio, last);
        let pairs = self.pairs.iter().map(|pair| {
            let mut inner = Fields::in_units(units);
            let contact = &study.system().contacts[pair.contact];
            let velocity = contact.surface_velocity.mean().abs();
            inner.plain("dither", pair.dither).plain("contact", contact.name.clone());
            let extremes = pair.extremes.iter().map(|at| {
                let mut item = Fields::in_units(units);
                item.plain("kind", if at.peak { "peak" } else { "dip" })
                    .number("frequency", Quantity::FrequencyRatio, at.frequency)
                    .plain("out_of_reach", at.out_of_reach);
                let slip = at.slip_per_amplitude.ok_or_else(|| UNBOUNDED_RESONANCE.to_owned());
                item.known_plain("slip_per_amplitude", slip.clone());
                let reversal = slip.and_then(|slip| match velocity / slip {
                    reversal if reversal.is_finite() => Ok(reversal),
                    _ => Err("the dither does not reach the contact".to_owned()),
                });
                item.known("reversal_amplitude", Quantity::Force, reversal);
                item
            });
            inner.list("extremes", extremes.collect::<Vec<_>>());
            inner
        });
        fields.list("responses", pairs.collect::<Vec<_>>());
        fields.plain("warnings", study.warnings());
        fields.finish()
    }

    /// Slip amplitude per unit of dither over the frequency, one array for each pair.
    pub fn dataset(&self, study: &SystemStudy) -> Dataset {
        let units = study.units();
        let unit = units.unit(Quantity::FrequencyRatio).unwrap_or("1");
        let slip = match (units.unit(Quantity::Velocity), units.unit(Quantity::Force)) {
            (Some(velocity), Some(force)) => format!("{velocity}/{force}"),
            _ => "1".to_owned(),
        };
        let mut dataset = Dataset::of(&study.into(), "resonances").with_axis(Array::new(
            "frequency",
            unit,
            self.frequencies.clone(),
        ));
        for pair in &self.pairs {
            let contact = &study.system().contacts[pair.contact].name;
            let name = format!("slip_of_{contact}_per_dither_{}", pair.dither);
            dataset = dataset.with(Array::new(name, slip.as_str(), pair.slip.clone()));
        }
        dataset
    }
}
