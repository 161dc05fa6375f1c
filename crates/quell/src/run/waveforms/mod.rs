//! `waveforms`: the least dither of each waveform that quenches, and its cost.
//!
//! Each waveform takes the place of that of the study's first dither, at the same direction and frequency ratio. Its exact least
//! amplitude at the study's frequency ratio is the local threshold of the base response; it is sought about the first critical amplitude of
//! averaging at the study's frequency ratio from which sliding at the belt velocity is stable, or, where that would open the contact, at all
//! amplitudes that keep it closed. The cost is that of the structure without friction ([`quell_linear::linear_cost`]), so that it depends on the
//! dither alone.

mod comparison;

use quell_dynamics::motion::orbit::family::SystemAt;
use quell_dynamics::motion::orbit::motion_thresholds;
use quell_dynamics::orbit::OrbitVerdict;
use quell_dynamics::orbit::threshold::{BranchEnding, NoThresholds, local};
use quell_dynamics::response::BAND_END;
use quell_dynamics::simulation::{is_used_up, within};
use quell_linear::averaging::{
    AveragedVerdict, AveragingOptions, Becomes, CriticalAmplitude, criterion, critical_amplitudes,
};
use quell_linear::linear_cost::linear_cost;
use quell_model::units::Quantity;
use quell_model::waveform::Burst;
use quell_model::{Belt, Dither, System, Waveform};
use serde_json::Value as Json;

pub(crate) use comparison::{COLUMNS, CostColumn};
pub use comparison::{ComparedWaveform, LeastDither, RankedBy, WaveformComparison, WaveformCost};

use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::contact_state::{
    averages_are_a_start, passivity, refused_of_belt, rigid_average, small_motions,
};
use crate::dataset::{Array, Dataset};
use crate::effort::STEPS_OF_AN_ALTERNATIVE;
use crate::fields::Fields;
use crate::parallel::Parallel;
use crate::study::BeltStudy;
use crate::words::{digits, in_words};

/// Bursts have duty cycles of whole eighths, in lowest terms: the shortest bursts of each duty cycle.
const EIGHTHS: u32 = 8;

/// The exact threshold is searched between these multiples of the averaged amplitude.
const SEARCHED: (f64, f64) = (0.5, 3.0);

/// Where averaging has no amplitude, the search begins at this share of the load; an amplitude of this many loads is allowed only where
/// nothing opens a contact.
const LEAST_OF_LOAD: f64 = 0.02;
const UNBOUNDED: f64 = 1e3;

/// Closeness to the amplitude that opens a contact, near which a load that almost vanishes takes ever shorter steps.
const CLOSED: f64 = 1e-3;

/// Continuation steps of that search.
const STEPS: u32 = 40;

/// Compares waveforms for a study.
///
/// # Errors
/// A complaint about a study without dither or with a belt at rest.
pub fn run(study: &BeltStudy) -> Result<WaveformComparison, Failure> {
    refused_of_belt(study, "waveforms")?;
    let belt = study.belt();
    let Some(first) = belt.dithers().first() else {
        let allowed = "given: waveforms are compared at the direction and the frequency of the study's dither";
        return Err(
            Complaint::new(Fault::Missing, "dither", Origin::Whole, Json::Null, allowed).into()
        );
    };
    super::moves(study, "sliding on it is to be stable")?;
    let Candidates { waveforms, carrier } = Candidates::beside(&first.waveform);
    let rows = waveforms.in_parallel(|waveform| compared(belt, first, waveform.clone())).collect();
    Ok(WaveformComparison { rows, carrier })
}

/// The waveforms of a comparison.
pub(crate) struct Candidates {
    /// Sine, triangle, square, the study's own, bursts in ascending duty cycle.
    pub(crate) waveforms: Vec<Waveform>,
    /// Name of the carrier of the bursts.
    pub(crate) carrier: &'static str,
}

impl Candidates {
    /// The waveforms with which that of a study is compared.
    pub(crate) fn beside(own: &Waveform) -> Self {
        let carrier = match own {
            Waveform::Burst(burst) => burst.carrier().clone(),
            own if own.is_symmetric() => own.clone(),
            _ => Waveform::Sine,
        };
        let mut waveforms: Vec<Waveform> = Waveform::NAMED.to_vec();
        if !waveforms.contains(own) {
            waveforms.push(own.clone());
        }
        for on in 1..EIGHTHS {
            let divisor = greatest_common_divisor(on, EIGHTHS);
            let burst = Burst::new(carrier.clone(), on / divisor, (EIGHTHS - on) / divisor);
            // The study's own burst is compared already.
            waveforms.extend(burst.ok().map(Burst::into_waveform).filter(|burst| burst != own));
        }
        Self { waveforms, carrier: carrier.name() }
    }
}

/// A short label of a waveform, such as "burst 3 : 5": periods of the carrier in the burst and in the pause.
pub(crate) fn label(waveform: &Waveform) -> String {
    match waveform {
        Waveform::Burst(burst) => format!("burst {} : {}", burst.on(), burst.off()),
        other => other.name().to_owned(),
    }
}

/// Share of the period in which a waveform acts: 1 except for bursts.
pub(crate) fn duty_cycle(waveform: &Waveform) -> f64 {
    match waveform {
        Waveform::Burst(burst) => f64::from(burst.on()) / f64::from(burst.cycles()),
        _ => 1.0,
    }
}

fn greatest_common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

fn compared(belt: &Belt, first: &Dither, waveform: Waveform) -> ComparedWaveform {
    let dither = Dither { waveform: waveform.clone(), ..first.clone() };
    let mut dithers = belt.dithers().to_vec();
    dithers[0] = Dither { amplitude: 0.0, ..dither.clone() };
    let with = belt.dithered_by(dithers).map_err(|why| why.to_string());
    let averaged = match &with {
        Ok(belt) => least(belt),
        Err(why) => Err(NoAveragedDither::Unknown(why.clone())),
    };
    let exact = match &with {
        Ok(belt) => exact(belt, &averaged),
        Err(why) => Err(why.clone()),
    };
    let without_state = averaged.as_ref().ok().zip(with.as_ref().ok()).and_then(|(least, belt)| {
        let acting = belt.with_amplitude(0, least.amplitude).ok()?;
        let bristles = || acting.friction().bristles().map(|_| small_motions(""));
        rigid_average(&acting, acting.belt_velocity()).or_else(bristles)
    });
    let cost = linear_cost(&Dither { amplitude: 1.0, ..dither.clone() }, belt.damping_ratio());
    let cost = cost.map_err(|why| why.to_string());
    ComparedWaveform {
        without_state,
        duty_cycle: duty_cycle(&waveform),
        own: waveform == first.waveform,
        slow: false,
        averaged: averaged.map_err(|why| why.to_string()),
        exact,
        unit: WaveformCost {
            root_mean_square: waveform.root_mean_square(),
            stroke: cost.clone().map(|cost| cost.stroke),
            velocity: cost.clone().map(|cost| cost.velocity),
            power: cost.map(|cost| cost.power),
        },
        waveform,
    }
}

/// Why averaging has no least dither.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum NoAveragedDither {
    /// Nothing has to be quenched.
    Quiet,
    /// No amplitude quenches.
    Never,
    /// The least amplitude that would quench opens a contact.
    Opens,
    /// It is unknown.
    Unknown(String),
}

impl std::fmt::Display for NoAveragedDither {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Quiet => {
                "steady sliding is stable without this dither: there is nothing to quench"
            }
            Self::Never => "no amplitude of this waveform makes steady sliding stable",
            Self::Opens => {
                "by averaging it would need more normal dither than load: the contact would open"
            }
            Self::Unknown(why) => why,
        })
    }
}

impl NoAveragedDither {
    /// That there is no answer, for a reason.
    pub(crate) fn unknown(why: impl std::fmt::Display) -> Self {
        Self::Unknown(why.to_string())
    }
}

/// The least dither by averaging on a belt whose first dither is the one that is sought.
fn least(belt: &Belt) -> Result<LeastDither, NoAveragedDither> {
    let options = AveragingOptions::FINITE_R;
    let without = criterion(belt, options).map_err(NoAveragedDither::unknown)?;
    if without.verdict == AveragedVerdict::Stable {
        return Err(NoAveragedDither::Quiet);
    }
    let found = critical_amplitudes(belt, options).map_err(NoAveragedDither::unknown)?;
    let becomes = |critical: &&CriticalAmplitude, wanted| critical.becomes == wanted;
    let place = found.iter().position(|critical| becomes(&critical, Becomes::Stable));
    let critical = place.map(|place| &found[place]).ok_or(NoAveragedDither::Never)?;
    if !critical.contact_stays_closed {
        return Err(NoAveragedDither::Opens);
    }
    let mut larger = found.iter().skip(place.unwrap_or(0));
    Ok(LeastDither {
        amplitude_ratio: critical.amplitude_ratio,
        amplitude: critical.amplitude,
        until: larger
            .find(|critical| becomes(critical, Becomes::Unstable))
            .map(|critical| critical.amplitude),
    })
}

/// Why a waveform that repeats in the band of the vibration has no exact amplitude: the base response may be stable, but it is no quench.
pub(crate) fn in_the_band() -> String {
    format!(
        "it repeats at or below {BAND_END} times the frequency of the vibration, so that the motion in step with it is a slow vibration \
         itself"
    )
}

/// The least amplitude from which the base response is stable.
fn exact(belt: &Belt, averaged: &Result<LeastDither, NoAveragedDither>) -> Result<f64, String> {
    if belt.dithers().first().is_some_and(|first| first.repetition_ratio() <= BAND_END) {
        return Err(in_the_band());
    }
    let at = |values: &[f64]| belt.with_amplitude(0, values[0]).ok();
    let range = searched(averaged, belt.normal_load(), |amplitude| at(&[amplitude]).is_some())?;
    if belt.has_contact_state() {
        let system = |values: &[f64]| -> Result<System, String> {
            let belt = belt.with_amplitude(0, values[0]).map_err(|why| why.to_string())?;
            Ok(belt.system())
        };
        return exact_of_system(&system, range);
    }
    let (found, cut_short) =
        within(STEPS_OF_AN_ALTERNATIVE, || (local(&at, range.from, range.to, STEPS), is_used_up()));
    let found = found.map_err(|why| match why {
        _ if cut_short => TOO_SENSITIVE.to_owned(),
        NoThresholds::Invalid { .. } => "the contact would open".to_owned(),
        NoThresholds::Start(why) => {
            format!("no base response at the beginning of the search: {why}")
        }
        NoThresholds::Lost { .. } => "the continuation lost the base response".to_owned(),
    })?;
    let changes = found.thresholds.iter().map(|threshold| (threshold.value, threshold.becomes));
    least_stable(changes, (found.ending, cut_short), range)
}

/// The amplitudes among which the exact one is sought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SearchedAmplitudes {
    from: f64,
    to: f64,
    /// The averaged amplitude about which they are; `None` where they are all that keep the contacts closed.
    averaged: Option<f64>,
}

/// The amplitudes about the averaged one; where that would open a contact, or none quenches, those that keep the contacts closed. `load` is
/// an amplitude that is large for a contact.
///
/// # Errors
/// Why no amplitude is sought.
pub(crate) fn searched(
    averaged: &Result<LeastDither, NoAveragedDither>,
    load: f64,
    is_allowed: impl Fn(f64) -> bool,
) -> Result<SearchedAmplitudes, String> {
    let averaged = match averaged {
        Ok(least) => Some(least.amplitude),
        Err(NoAveragedDither::Opens | NoAveragedDither::Never) => None,
        Err(why) => return Err(why.to_string()),
    };
    let wanted = averaged.map_or(UNBOUNDED * load, |averaged| SEARCHED.1 * averaged);
    let from = averaged.map_or(LEAST_OF_LOAD * load, |averaged| SEARCHED.0 * averaged);
    if is_allowed(wanted) {
        // Without an averaged amplitude nothing bounds the search.
        let none = || NoAveragedDither::Never.to_string();
        averaged.ok_or_else(none)?;
        return Ok(SearchedAmplitudes { from, to: wanted, averaged });
    }
    if !is_allowed(from) {
        return Err(NoAveragedDither::Opens.to_string());
    }
    // Up to the largest that keeps the contacts closed.
    let (mut allowed, mut opens) = (from, wanted);
    while opens - allowed > CLOSED * allowed {
        let middle = f64::midpoint(allowed, opens);
        *(if is_allowed(middle) { &mut allowed } else { &mut opens }) = middle;
    }
    Ok(SearchedAmplitudes { from, to: allowed, averaged })
}

/// The least amplitude in a range from which the base response of a system is stable.
///
/// # Errors
/// Why none is known.
pub(crate) fn exact_of_system(at: &SystemAt<'_>, range: SearchedAmplitudes) -> Result<f64, String> {
    let (found, cut_short) = within(STEPS_OF_AN_ALTERNATIVE, || {
        (motion_thresholds(at, (range.from, range.to), STEPS, None), is_used_up())
    });
    let found = found.map_err(|why| {
        if cut_short {
            TOO_SENSITIVE.to_owned()
        } else {
            format!("no base response at the beginning of the search: {why}")
        }
    })?;
    let changes = found.thresholds.iter().map(|threshold| (threshold.value, threshold.becomes));
    least_stable(changes, (found.ending, cut_short), range)
}

/// Why no amplitude is known where the steps of the search are used up.
const TOO_SENSITIVE: &str =
    "the base response is so sensitive that the search used up its steps before it became stable";

/// The least value from which a branch is stable, by the values at which its verdict changes; how the branch ended, and whether for
/// want of steps.
fn least_stable(
    changes: impl Iterator<Item = (f64, Option<OrbitVerdict>)>,
    (ending, cut_short): (BranchEnding, bool),
    range: SearchedAmplitudes,
) -> Result<f64, String> {
    let stable = Some(OrbitVerdict::Stable);
    let becomes = changes.filter(|(_, becomes)| *becomes == stable);
    let least = becomes.map(|(value, _)| value).fold(f64::INFINITY, f64::min);
    if least.is_finite() {
        return Ok(least);
    }
    Err(match ending {
        BranchEnding::Covered => match range.averaged {
            Some(averaged) => format!(
                "the base response does not become stable between {} and {} times the averaged amplitude",
                digits(range.from / averaged),
                digits(range.to / averaged)
            ),
            None => {
                "the base response does not become stable before the contact would open".to_owned()
            }
        },
        _ if cut_short => TOO_SENSITIVE.to_owned(),
        _ => "the base response ends before it becomes stable".to_owned(),
    })
}

impl WaveformComparison {
    /// The result of a belt in a few sentences.
    pub fn of_belt_in_words(&self, study: &BeltStudy) -> String {
        let velocity = in_words(study, Quantity::Velocity, study.belt().belt_velocity());
        let force = |value: f64| in_words(study, Quantity::Force, value);
        self.sentence(force, &format!("steady sliding at v₀ = {velocity}"))
    }

    /// Warnings: bursts that repeat near the natural frequency, and waveforms that quench over a limited range of amplitudes.
    pub fn warnings_about_belt(&self, study: &BeltStudy) -> Vec<String> {
        const FAST: f64 = 5.0;
        let mut warnings = Vec::new();
        let Some(first) = study.belt().dithers().first() else { return warnings };
        let slow: Vec<&ComparedWaveform> = self
            .rows
            .iter()
            .filter(|row| first.frequency_ratio / f64::from(row.waveform.cycles()) < FAST)
            .collect();
        if let Some(slowest) =
            slow.iter().max_by_key(|row| row.waveform.cycles()).filter(|_| !slow.is_empty())
        {
            let ratio = digits(first.frequency_ratio / f64::from(slowest.waveform.cycles()));
            warnings.push(format!(
                "{} of the waveforms repeat at less than {FAST} times the natural frequency ({} at {ratio}): averaging assumes a \
                 fast dither, and the exact amplitudes show the difference",
                slow.len(),
                slowest.label()
            ));
        }
        warnings.extend(passivity(study.belt()));
        let because = self.rows.iter().find_map(|row| row.without_state.as_deref());
        warnings.extend(because.map(averages_are_a_start));
        warnings
    }

    /// The comparison of a belt as JSON.
    pub fn json_of_belt(&self, study: &BeltStudy) -> Json {
        let mut fields = Fields::new(study.scales());
        fields.plain("ok", true).plain("sentence", self.of_belt_in_words(study));
        self.put_rows(
            &mut fields,
            || Fields::new(study.scales()),
            |row, inner| {
                let averaged = row.averaged.as_ref().map_err(Clone::clone);
                let ratio = averaged.map(|least| least.amplitude_ratio);
                inner.known("amplitude_ratio", Quantity::Velocity, ratio);
            },
        );
        fields.plain("warnings", self.warnings_about_belt(study));
        fields.finish()
    }

    /// The comparison of a belt as a dataset: one row for each waveform.
    pub fn dataset_of_belt(&self, study: &BeltStudy) -> Dataset {
        let dataset = Dataset::new(study, "waveforms").fact(self.of_belt_in_words(study));
        self.arrays().into_iter().fold(self.named_rows(dataset), |dataset, array| {
            let (name, quantity, values) = array;
            dataset.array(&name, quantity, values)
        })
    }

    /// Names of the waveforms along the axis of a dataset.
    pub(crate) fn named_rows(&self, dataset: Dataset) -> Dataset {
        let numbers = (0..self.rows.len()).map(|number| number as f64).collect();
        let names: Vec<(u8, &'static str)> =
            (0_u8..).zip(Waveform::NAMES.iter().copied()).collect();
        let code = |row: &ComparedWaveform| {
            names.iter().find(|(_, name)| *name == row.waveform.name()).map_or(0, |(code, _)| *code)
        };
        let codes: Vec<u8> = self.rows.iter().map(code).collect();
        let dataset = dataset.with_axis(Array::new("number", "1", numbers));
        dataset.with(Array::of_words("waveform", names, &codes))
    }

    /// The arrays of a dataset: duty cycle, the quantities by averaging, and the exact amplitude.
    pub(crate) fn arrays(&self) -> Vec<(String, Quantity, Vec<f64>)> {
        let each = |of: &dyn Fn(&ComparedWaveform) -> Result<f64, String>| -> Vec<f64> {
            self.rows.iter().map(|row| of(row).unwrap_or(f64::NAN)).collect()
        };
        let duty = ("duty_cycle".to_owned(), Quantity::Ratio, each(&|row| Ok(row.duty_cycle)));
        let averaged = COLUMNS.iter().map(|column| {
            (column.name.to_owned(), column.quantity, each(&|row| row.averaged_value(column)))
        });
        let exact = ("exact_amplitude".to_owned(), Quantity::Force, each(&|row| row.exact.clone()));
        [duty].into_iter().chain(averaged).chain([exact]).collect()
    }
}
