//! `waveforms`: the least dither of each waveform that quenches, and its cost.
//!
//! Each waveform takes the place of that of the study's first dither, at the same place and frequency. Its exact least amplitude is the
//! threshold of the base response; it is sought about the first critical amplitude of averaging from which steady sliding is stable, or,
//! where that would open a contact, at all amplitudes that keep the contacts closed.
//!
//! The cost is that of the sliding structure without the slope of friction ([`quell_linear::input_cost`]) at the driven point, exact
//! for every waveform: the stroke of bᵀq, the largest velocity, and the mean power ⟨u bᵀq̇⟩ of a force b u(t).
//!
//! | file | contents |
//! |---|---|
//! | `comparison` | the waveforms in comparison, and their costs in a sentence |
//! | `answer` | the comparison as JSON, warnings and a dataset |

mod answer;
mod comparison;

use quell_dynamics::motion::orbit::family::SystemAt;
use quell_dynamics::motion::orbit::motion_thresholds;
use quell_dynamics::orbit::OrbitVerdict;
use quell_dynamics::orbit::threshold::BranchEnding;
use quell_dynamics::response::{BAND_END, wave_reaches_the_band};
use quell_dynamics::simulation::{is_used_up, within};
use quell_linear::averaging::{Becomes, DitheredSystem};
use quell_linear::growth::Verdict;
use quell_linear::input_cost::input_cost;
use quell_linear::linearised::Linearised;
use quell_linear::spectrum::spectrum;
use quell_model::profile::{Profile, Wave};
use quell_model::waveform::Burst;
use quell_model::{System, Waveform};
use serde_json::Value as Json;

pub(crate) use comparison::{COLUMNS, CostColumn};
pub use comparison::{ComparedWaveform, LeastDither, RankedBy, WaveformComparison, WaveformCost};

use super::stability::FAR;
use super::system::modes::natural;
use super::system::{failed, has_equations};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::contact_state::averaged_without_states;
use crate::effort::STEPS_OF_AN_ALTERNATIVE;
use crate::parallel::Parallel;
use crate::study::SystemStudy;
use crate::words::digits;

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

/// Compares waveforms of the first dither of a study.
///
/// # Errors
/// A complaint about a study without dither; [`Failure::Failed`] without steady sliding.
pub fn run(study: &SystemStudy) -> Result<WaveformComparison, Failure> {
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
    let rows = waveforms.in_parallel(|waveform| {
        let wave = Wave { waveform: waveform.clone(), amplitude: 1.0, ..first.clone() };
        let acting = |amplitude: f64| with_wave(system, &Wave { amplitude, ..wave.clone() });
        let unit = acting(1.0);
        let prepared = DitheredSystem::new(&unit).map_err(NoAveragedDither::unknown);
        let averaged = prepared.as_ref().map_err(Clone::clone).and_then(|known| least(known));
        let without_state = prepared.as_ref().ok().zip(averaged.as_ref().ok());
        let without_state = without_state.and_then(|(prepared, least)| {
            let average = prepared.average_with(Some((0, least.amplitude))).ok()?;
            averaged_without_states(&unit, &average.contacts).into_iter().next()
        });
        let cost = input_cost(&unit, &sliding, &unit.inputs[0].target, &wave);
        let cost = cost.map_err(|why| why.to_string());
        ComparedWaveform {
            own: *waveform == first.waveform,
            duty_cycle: duty_cycle(waveform),
            slow: wave.repetition() < FAR * highest,
            exact: prepared
                .as_ref()
                .map_err(ToString::to_string)
                .and_then(|prepared| exact(prepared, &averaged, &acting)),
            averaged: averaged.map_err(|why| why.to_string()),
            unit: WaveformCost {
                root_mean_square: waveform.root_mean_square(),
                stroke: cost.clone().map(|cost| cost.stroke),
                velocity: cost.clone().map(|cost| cost.velocity),
                power: cost.map(|cost| cost.power),
            },
            without_state,
            waveform: waveform.clone(),
        }
    });
    Ok(WaveformComparison { rows: rows.collect(), carrier })
}

/// The system with this wave as its first dither.
fn with_wave(system: &System, wave: &Wave) -> System {
    let mut changed = system.clone();
    let input = &mut changed.inputs[0];
    input.profile = Profile::constant(input.profile.mean()).with(wave.clone());
    changed
}

/// The exact least amplitude of a system.
fn exact(
    prepared: &DitheredSystem<'_>,
    averaged: &Result<LeastDither, NoAveragedDither>,
    acting: &(dyn Fn(f64) -> System + Sync),
) -> Result<f64, String> {
    if wave_reaches_the_band(&acting(1.0)) {
        return Err(in_the_band());
    }
    let closed = |amplitude: f64| {
        prepared.average_with(Some((0, amplitude))).is_ok_and(|average| {
            average.contacts.iter().all(|contact| contact.normal_load > contact.load_amplitude)
        })
    };
    let loads: f64 = acting(0.0).contacts.iter().map(|contact| contact.normal_load.abs()).sum();
    // About an averaged amplitude a contact may open for a part of the period.
    let is_allowed = |amplitude: f64| averaged.is_ok() || closed(amplitude);
    let range = searched(averaged, loads, is_allowed)?;
    let at = |values: &[f64]| -> Result<System, String> { Ok(acting(values[0])) };
    exact_of_system(&at, range)
}

/// The least first dither of a system by averaging.
fn least(prepared: &DitheredSystem<'_>) -> Result<LeastDither, NoAveragedDither> {
    let without = prepared.average_with(Some((0, 0.0))).map_err(NoAveragedDither::unknown)?;
    let growth = without.growth().map_err(NoAveragedDither::unknown)?;
    if growth.verdict() == Verdict::Stable {
        return Err(NoAveragedDither::Quiet);
    }
    let found = prepared.critical_amplitudes(0).map_err(NoAveragedDither::unknown)?;
    let place = found.iter().position(|critical| critical.becomes == Becomes::Stable);
    let place = place.ok_or(NoAveragedDither::Never)?;
    if !found[place].contacts_stay_closed {
        return Err(NoAveragedDither::Opens);
    }
    let amplitude = found[place].amplitude;
    Ok(LeastDither {
        amplitude,
        until: found[place..]
            .iter()
            .find(|critical| critical.becomes == Becomes::Unstable)
            .map(|critical| critical.amplitude),
    })
}

/// The waveforms of a comparison.
struct Candidates {
    /// Sine, triangle, square, the study's own, bursts in ascending duty cycle.
    waveforms: Vec<Waveform>,
    /// Name of the carrier of the bursts.
    carrier: &'static str,
}

impl Candidates {
    /// The waveforms with which that of a study is compared.
    fn beside(own: &Waveform) -> Self {
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
fn duty_cycle(waveform: &Waveform) -> f64 {
    match waveform {
        Waveform::Burst(burst) => f64::from(burst.on()) / f64::from(burst.cycles()),
        _ => 1.0,
    }
}

fn greatest_common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

/// Why averaging has no least dither.
#[derive(Clone, Debug, PartialEq)]
enum NoAveragedDither {
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
    fn unknown(why: impl std::fmt::Display) -> Self {
        Self::Unknown(why.to_string())
    }
}

/// Why a waveform that repeats in the band of the vibration has no exact amplitude: the base response may be stable, but it is no quench.
fn in_the_band() -> String {
    format!(
        "it repeats at or below {BAND_END} times the frequency of the vibration, so that the motion in step with it is a slow vibration \
         itself"
    )
}

/// The amplitudes among which the exact one is sought.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SearchedAmplitudes {
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
fn searched(
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
fn exact_of_system(at: &SystemAt<'_>, range: SearchedAmplitudes) -> Result<f64, String> {
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
