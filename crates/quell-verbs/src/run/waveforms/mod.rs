//! `waveforms`: the least dither of each waveform that quenches, and its cost.
//!
//! Each waveform takes the place of that of the study's first dither, at the same place and frequency. Its exact least amplitude is that
//! of [`quench`], as in `thresholds` and maps.
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

use quell_design::NoAnswer;
use quell_design::least_dither::first_averaged;
use quell_design::quench::{NoQuench, NotQuenched, quench};
use quell_dynamics::response::{BAND_END, wave_reaches_the_band};
use quell_dynamics::simulation::{is_used_up, within};
use quell_linear::averaging::DitheredSystem;
use quell_linear::input_cost::input_cost;
use quell_linear::linearised::Linearised;
use quell_linear::spectrum::spectrum;
use quell_model::profile::Wave;
use quell_model::waveform::Burst;
use quell_model::{System, Waveform};
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

pub use comparison::{COLUMNS, CostColumn};
pub use comparison::{
    ComparedWaveform, LeastDither, NoWaveformValue, RankedBy, WaveformComparison,
};

use super::design::with_wave;
use super::stability::FAR;
use super::system::modes::natural;
use super::system::{failed, has_equations};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::contact_state::averaged_without_states;
use crate::effort::STEPS_OF_AN_ALTERNATIVE;
use crate::parallel::Parallel;
use crate::reasons::reasons;
use crate::study::SystemStudy;

/// Bursts have duty cycles of whole eighths, in lowest terms: the shortest bursts of each duty cycle.
const EIGHTHS: u32 = 8;

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
        let unit = with_wave(system.clone(), 0, |_| wave.clone());
        let range = first_averaged(&unit, 0);
        let quiet_without = range.as_ref().is_ok_and(|range| range.lower == 0.0);
        let averaged = range.map_err(NoLeastDither::from).and_then(least);
        let without_state = averaged.as_ref().ok().and_then(|least| {
            let average = DitheredSystem::new(&unit).ok()?;
            let average = average.average_with(Some((0, least.amplitude))).ok()?;
            averaged_without_states(&unit, &average.contacts).into_iter().next()
        });
        let cost = input_cost(&unit, &sliding, &unit.inputs[0].target, &wave);
        ComparedWaveform {
            own: *waveform == first.waveform,
            duty_cycle: duty_cycle(waveform),
            slow: wave.repetition() < FAR * highest,
            exact: exact(&unit, quiet_without),
            averaged,
            unit: cost,
            without_state,
            waveform: waveform.clone(),
        }
    });
    Ok(WaveformComparison { rows: rows.collect(), carrier })
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

reasons! {
    /// Why no amplitude of a waveform is known that quenches.
    pub enum NoLeastDither {
        /// There is no average.
        NotAveraged(NoAnswer),
        /// The base response could not be followed.
        NoQuench(NoQuench),
        /// It does not become stable.
        NotQuenched(NotQuenched),
        ;
        /// The waveform repeats in the band of the vibration: the base response may be stable, but it is no quench.
        InTheBand => &format!(
            "it repeats at or below {BAND_END} times the frequency of the vibration, so that the motion in step with it is a slow \
             vibration itself"
        ),
        /// The steps of the search are used up.
        TooSensitive =>
            "the base response is so sensitive that the search used up its steps before it became stable",
    }
}

/// The exact least amplitude of the first dither of a system, as in maps and `thresholds`.
///
/// # Errors
/// Why none is known.
fn exact(system: &System, quiet_without: bool) -> Result<LeastDither, NoLeastDither> {
    if wave_reaches_the_band(system) {
        return Err(NoLeastDither::InTheBand);
    }
    if quiet_without {
        return Err(NotQuenched::QuietWithout.into());
    }
    let (found, cut_short) = within(STEPS_OF_AN_ALTERNATIVE, || (quench(system, 0), is_used_up()));
    match found {
        Err(_) if cut_short => Err(NoLeastDither::TooSensitive),
        Err(why) => Err(why.into()),
        Ok(found) => match found.least() {
            Ok(change) => Ok(LeastDither { amplitude: change.amplitude, until: found.lost() }),
            Err(NotQuenched::Ends) if cut_short => Err(NoLeastDither::TooSensitive),
            Err(why) => Err(why.into()),
        },
    }
}

/// The least dither of the first range of amplitudes that are quiet by averaging.
///
/// # Errors
/// That all of them are.
fn least(
    RealInterval { lower: low, upper: high }: RealInterval,
) -> Result<LeastDither, NoLeastDither> {
    if low == 0.0 {
        return Err(NotQuenched::QuietWithout.into());
    }
    Ok(LeastDither { amplitude: low, until: high.is_finite().then_some(high) })
}
