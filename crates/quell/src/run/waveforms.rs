//! `waveforms`: the least dither of each waveform that quenches, and its cost.
//!
//! Each waveform takes the place of that of the study's first dither, at the same direction and frequency ratio. Its least
//! amplitude is the first critical amplitude of averaging in the limit of high frequency from which sliding at the belt velocity is
//! stable. At that amplitude the cost is that of the structure without friction ([`quell_linear::linear_cost`]), so that it depends
//! on the dither alone. The exact least amplitude at the study's frequency ratio is the local threshold of the base response.

use std::fmt::Write as _;

use quell_dynamics::motion::orbit::family::SystemAt;
use quell_dynamics::motion::orbit::motion_thresholds;
use quell_dynamics::orbit::OrbitVerdict;
use quell_dynamics::orbit::threshold::{BranchEnding, NoThresholds, local};
use quell_dynamics::response::BAND_END;
use quell_dynamics::simulation::{is_used_up, within};
use quell_linear::averaging::{
    AveragedVerdict, AveragingOptions, Becomes, criterion, critical_amplitudes,
};
use quell_linear::linear_cost::linear_cost;
use quell_model::units::Quantity;
use quell_model::waveform::Burst;
use quell_model::{Belt, Dither, Parametrisation, System, Waveform};
use rayon::prelude::*;
use serde_json::Value as Json;

use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::contact_state::{
    averages_are_a_start, passivity, refused_of_belt, rigid_average, small_motions,
};
use crate::dataset::{Array, Dataset};
use crate::effort::STEPS_OF_AN_ALTERNATIVE;
use crate::fields::Fields;
use crate::study::BeltStudy;
use crate::words::{digits, in_words};

/// Bursts have duty cycles of whole eighths, in lowest terms: the shortest bursts of each duty cycle.
const EIGHTHS: u32 = 8;

/// The exact threshold is searched between these multiples of the averaged amplitude.
const SEARCHED: (f64, f64) = (0.5, 3.0);

/// Continuation steps of that search.
const STEPS: u32 = 40;

/// The least dither of one waveform that quenches by averaging.
#[derive(Clone, Debug)]
pub struct LeastDither {
    /// α = D/R.
    pub amplitude_ratio: f64,
    /// D.
    pub amplitude: f64,
    /// The larger amplitude from which sliding is unstable again, if any.
    pub until: Option<f64>,
    /// Root mean square of the force.
    pub root_mean_square: f64,
    /// Peak-to-peak displacement of the structure without friction, or why it has no value.
    pub stroke: Result<f64, String>,
    /// Its largest velocity.
    pub velocity: Result<f64, String>,
    /// Mean power that the dither brings into it.
    pub power: Result<f64, String>,
}

/// One waveform of the comparison.
#[derive(Clone, Debug)]
pub struct ComparedWaveform {
    /// The waveform.
    pub waveform: Waveform,
    /// Share of the period in which it acts: 1 except for bursts.
    pub duty_cycle: f64,
    /// Whether it is that of the study.
    pub own: bool,
    /// The least dither by averaging, or why no amplitude quenches.
    pub averaged: Result<LeastDither, String>,
    /// The exact least amplitude at the study's frequency ratio, or why it is unknown.
    pub exact: Result<f64, String>,
    /// Why the average, which does not know the state of the contact, differs from that with it at the least amplitude.
    pub without_state: Option<String>,
}

/// The waveforms of a study.
#[derive(Clone, Debug)]
pub struct WaveformComparison {
    /// Every waveform: sine, triangle, square, the study's own, bursts in ascending duty cycle.
    pub rows: Vec<ComparedWaveform>,
    /// Name of the carrier of the bursts.
    pub carrier: &'static str,
}

/// A quantity in which waveforms are compared.
pub(crate) struct CostColumn {
    /// Name in JSON.
    pub(crate) name: &'static str,
    /// Words for tables and sentences.
    pub(crate) words: &'static str,
    pub(crate) quantity: Quantity,
    pub(crate) of: fn(&LeastDither) -> Result<f64, String>,
}

/// The compared quantities.
pub(crate) const COLUMNS: [CostColumn; 5] = [
    CostColumn {
        name: "amplitude",
        words: "amplitude",
        quantity: Quantity::Force,
        of: |least| Ok(least.amplitude),
    },
    CostColumn {
        name: "root_mean_square",
        words: "rms force",
        quantity: Quantity::Force,
        of: |least| Ok(least.root_mean_square),
    },
    CostColumn {
        name: "power",
        words: "power",
        quantity: Quantity::Power,
        of: |least| least.power.clone(),
    },
    CostColumn {
        name: "stroke",
        words: "stroke",
        quantity: Quantity::Displacement,
        of: |least| least.stroke.clone(),
    },
    CostColumn {
        name: "velocity",
        words: "velocity",
        quantity: Quantity::Velocity,
        of: |least| least.velocity.clone(),
    },
];

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
    let rows = waveforms.into_par_iter().map(|waveform| compared(belt, first, waveform)).collect();
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
    let with = belt.dithered_by(dithers);
    let averaged = with.map_err(|why| why.to_string()).and_then(|belt| {
        let least = least(&belt, &dither)?;
        Ok((belt, least))
    });
    let exact = match &averaged {
        Ok((belt, least)) => exact(belt, least.amplitude),
        Err(why) => Err(why.clone()),
    };
    let without_state = averaged.as_ref().ok().and_then(|(belt, least)| {
        let acting = belt.with(&belt.dither_path(0, "amplitude"), least.amplitude).ok()?;
        let bristles = || acting.friction().bristles().map(|_| small_motions(""));
        rigid_average(&acting, acting.belt_velocity()).or_else(bristles)
    });
    ComparedWaveform {
        without_state,
        duty_cycle: duty_cycle(&waveform),
        own: waveform == first.waveform,
        waveform,
        averaged: averaged.map(|(_, least)| least),
        exact,
    }
}

/// The least dither by averaging on a belt whose first dither is of this kind.
fn least(belt: &Belt, dither: &Dither) -> Result<LeastDither, String> {
    let options = AveragingOptions::default();
    let without = criterion(belt, options).map_err(|why| why.to_string())?;
    if without.verdict == AveragedVerdict::Stable {
        return Err(
            "steady sliding is stable without this dither: there is nothing to quench".to_owned()
        );
    }
    let found = critical_amplitudes(belt, options).map_err(|why| why.to_string())?;
    let (place, critical) = found
        .iter()
        .enumerate()
        .find(|(_, critical)| critical.becomes == Becomes::Stable)
        .ok_or("no amplitude of this waveform makes steady sliding stable")?;
    if !critical.contact_stays_closed {
        return Err("it would need more normal dither than load: the contact would open".to_owned());
    }
    let amplitude = critical.amplitude;
    let acting = Dither { amplitude, ..dither.clone() };
    let cost = linear_cost(&acting, belt.damping_ratio()).map_err(|why| why.to_string());
    Ok(LeastDither {
        amplitude_ratio: critical.amplitude_ratio,
        amplitude,
        until: found[place..]
            .iter()
            .find(|critical| critical.becomes == Becomes::Unstable)
            .map(|critical| critical.amplitude),
        root_mean_square: amplitude * dither.waveform.root_mean_square(),
        stroke: cost.clone().map(|cost| cost.stroke),
        velocity: cost.clone().map(|cost| cost.velocity),
        power: cost.map(|cost| cost.power),
    })
}

/// Why a waveform that repeats in the band of the vibration has no exact amplitude: the base response may be stable, but it is no quench.
pub(crate) fn in_the_band() -> String {
    format!(
        "it repeats at or below {BAND_END} times the frequency of the vibration, so that the motion in step with it is a slow vibration \
         itself"
    )
}

/// The least amplitude from which the base response is stable, near the averaged one.
fn exact(belt: &Belt, averaged: f64) -> Result<f64, String> {
    if belt.dithers().first().is_some_and(|first| first.repetition_ratio() <= BAND_END) {
        return Err(in_the_band());
    }
    let path = belt.dither_path(0, "amplitude");
    let range = searched(averaged, |amplitude| belt.with(&path, amplitude).is_ok())?;
    if belt.has_contact_state() {
        let at = |values: &[f64]| -> Result<System, String> {
            let belt = belt.with(&path, values[0]).map_err(|why| why.to_string())?;
            Ok(belt.system())
        };
        return exact_of_system(&at, averaged, range);
    }
    let (found, cut_short) = within(STEPS_OF_AN_ALTERNATIVE, || {
        (local(belt, &path, range.0, range.1, STEPS), is_used_up())
    });
    let found = found.map_err(|why| match why {
        _ if cut_short => TOO_SENSITIVE.to_owned(),
        NoThresholds::Invalid { .. } => "the contact would open".to_owned(),
        NoThresholds::Start(why) => {
            format!("no base response at the beginning of the search: {why}")
        }
        NoThresholds::Lost { .. } => "the continuation lost the base response".to_owned(),
    })?;
    let changes = found.thresholds.iter().map(|threshold| (threshold.value, threshold.becomes));
    least_stable(changes, (found.ending, cut_short), range.1 / averaged)
}

/// The amplitudes near the averaged one in which the exact one is sought.
///
/// # Errors
/// No larger amplitude is allowed.
pub(crate) fn searched(
    averaged: f64,
    is_allowed: impl Fn(f64) -> bool,
) -> Result<(f64, f64), String> {
    // Normal dither cannot exceed the load.
    let most = [SEARCHED.1, 2.0, 1.5, 1.2].map(|factor| factor * averaged);
    let to = most.into_iter().find(|to| is_allowed(*to));
    let to = to.ok_or("the contact would open near the averaged amplitude")?;
    Ok((SEARCHED.0 * averaged, to))
}

/// The least amplitude in a range from which the base response of a system is stable.
///
/// # Errors
/// Why none is known.
pub(crate) fn exact_of_system(
    at: &SystemAt<'_>,
    averaged: f64,
    range: (f64, f64),
) -> Result<f64, String> {
    let (found, cut_short) = within(STEPS_OF_AN_ALTERNATIVE, || {
        (motion_thresholds(at, range, STEPS, None), is_used_up())
    });
    let found = found.map_err(|why| {
        if cut_short {
            TOO_SENSITIVE.to_owned()
        } else {
            format!("no base response at the beginning of the search: {why}")
        }
    })?;
    let changes = found.thresholds.iter().map(|threshold| (threshold.value, threshold.becomes));
    least_stable(changes, (found.ending, cut_short), range.1 / averaged)
}

/// Why no amplitude is known where the steps of the search are used up.
const TOO_SENSITIVE: &str =
    "the base response is so sensitive that the search used up its steps before it became stable";

/// The least value from which a branch is stable, by the values at which its verdict changes; how the branch ended, and whether for
/// want of steps; `to` is the end of the search.
fn least_stable(
    changes: impl Iterator<Item = (f64, Option<OrbitVerdict>)>,
    (ending, cut_short): (BranchEnding, bool),
    to: f64,
) -> Result<f64, String> {
    let stable = Some(OrbitVerdict::Stable);
    let becomes = changes.filter(|(_, becomes)| *becomes == stable);
    let least = becomes.map(|(value, _)| value).fold(f64::INFINITY, f64::min);
    if least.is_finite() {
        return Ok(least);
    }
    Err(match ending {
        BranchEnding::Covered => {
            format!(
                "the base response does not become stable between {} and {} times the averaged amplitude",
                SEARCHED.0,
                digits(to)
            )
        }
        _ if cut_short => TOO_SENSITIVE.to_owned(),
        _ => "the base response ends before it becomes stable".to_owned(),
    })
}

impl ComparedWaveform {
    /// A short label, such as "burst 3 : 5": periods of the carrier in the burst and in the pause.
    pub fn label(&self) -> String {
        label(&self.waveform)
    }

    /// A quantity of the least dither, or why it has no value.
    pub(crate) fn value(&self, column: &CostColumn) -> Result<f64, String> {
        self.averaged.as_ref().map_err(Clone::clone).and_then(|least| (column.of)(least))
    }
}

impl WaveformComparison {
    /// The waveform that is smallest in a column.
    pub(crate) fn best(&self, column: &CostColumn) -> Option<&ComparedWaveform> {
        let known = self.rows.iter().filter_map(|row| Some((row, row.value(column).ok()?)));
        known.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(row, _)| row)
    }

    /// The row of the carrier without pauses.
    fn carrier_row(&self) -> Option<&ComparedWaveform> {
        self.rows.iter().find(|row| row.waveform.name() == self.carrier)
    }

    /// The result in a few sentences.
    pub fn sentence(&self, study: &BeltStudy) -> String {
        let [amplitude, _, power, ..] = &COLUMNS;
        let Some(best) = self.best(amplitude) else {
            let why = self.rows.iter().find_map(|row| row.averaged.as_ref().err());
            return format!(
                "By averaging no waveform quenches: {}.",
                why.map_or("none is known", String::as_str)
            );
        };
        let velocity = in_words(study, Quantity::Velocity, study.belt().belt_velocity());
        let value = best.value(amplitude).map(|value| in_words(study, Quantity::Force, value));
        let mut text = format!(
            "By averaging, of {} waveforms {} stabilises steady sliding at v₀ = {velocity} with the least amplitude, {}.",
            self.rows.len(),
            named(best),
            value.unwrap_or_default()
        );
        let exact = self.rows.iter().filter_map(|row| Some((row, *row.exact.as_ref().ok()?)));
        if let Some((row, value)) = exact.min_by(|a, b| a.1.total_cmp(&b.1)) {
            let value = in_words(study, Quantity::Force, value);
            let _ = write!(
                text,
                " Exactly, at the study's frequency, the least amplitude is that of {}, {value}.",
                named(row)
            );
        }
        let cheapest = self.best(power);
        let carrier = self.carrier_row().and_then(|row| row.value(power).ok());
        if let (Some(cheapest), Some(whole)) = (cheapest, carrier.filter(|whole| *whole > 0.0))
            && let Ok(least) = cheapest.value(power)
        {
            let share = digits_of_percent(least / whole);
            let carrier = self.carrier;
            let _ = if cheapest.waveform.name() == carrier {
                write!(text, " No waveform takes less power than the continuous {carrier}.")
            } else {
                let named = named(cheapest);
                write!(
                    text,
                    " The least power is that of {named}: {share} % of that of the continuous {carrier}."
                )
            };
        }
        text
    }

    /// Warnings: bursts that repeat near the natural frequency, and waveforms that quench over a limited range of amplitudes.
    pub fn warnings(&self, study: &BeltStudy) -> Vec<String> {
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

    /// As JSON.
    pub fn json(&self, study: &BeltStudy) -> Json {
        let scales = study.scales();
        let rows = self.rows.iter().map(|row| {
            let mut inner = Fields::new(scales);
            inner
                .plain("waveform", row.waveform.name())
                .plain("label", row.label())
                .plain("own", row.own)
                .number("duty_cycle", Quantity::Ratio, row.duty_cycle);
            if let Waveform::Burst(burst) = &row.waveform {
                inner.plain("on", burst.on()).plain("off", burst.off());
            }
            let averaged = row.averaged.as_ref().map_err(Clone::clone);
            inner.known(
                "amplitude_ratio",
                Quantity::Velocity,
                averaged.clone().map(|least| least.amplitude_ratio),
            );
            for column in &COLUMNS {
                inner.known(column.name, column.quantity, row.value(column));
            }
            let until = averaged.and_then(|least| {
                least.until.ok_or_else(|| "no larger amplitude makes it unstable again".to_owned())
            });
            inner.known("until", Quantity::Force, until).known(
                "exact_amplitude",
                Quantity::Force,
                row.exact.clone(),
            );
            inner
        });
        let mut best = Fields::new(scales);
        for column in &COLUMNS {
            match self.best(column) {
                Some(row) => best.plain(column.name, row.label()),
                None => best.unknown(column.name, "no waveform has a value"),
            };
        }
        let mut fields = Fields::new(scales);
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("carrier", self.carrier)
            .list("waveforms", rows)
            .nested("best", best)
            .plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// As a dataset: one row for each waveform.
    pub fn dataset(&self, study: &BeltStudy) -> Dataset {
        let numbers = (0..self.rows.len()).map(|number| number as f64).collect();
        let names: Vec<(u8, &'static str)> =
            (0_u8..).zip(Waveform::NAMES.iter().copied()).collect();
        let code = |row: &ComparedWaveform| {
            names.iter().find(|(_, name)| *name == row.waveform.name()).map_or(0, |(code, _)| *code)
        };
        let codes: Vec<u8> = self.rows.iter().map(code).collect();
        let each = |of: &dyn Fn(&ComparedWaveform) -> Result<f64, String>| -> Vec<f64> {
            self.rows.iter().map(|row| of(row).unwrap_or(f64::NAN)).collect()
        };
        let mut dataset = Dataset::new(study, "waveforms")
            .fact(self.sentence(study))
            .with_axis(Array::new("number", "1", numbers))
            .with(Array::of_words("waveform", names.clone(), &codes))
            .array("duty_cycle", Quantity::Ratio, each(&|row| Ok(row.duty_cycle)));
        for column in &COLUMNS {
            dataset = dataset.array(column.name, column.quantity, each(&|row| row.value(column)));
        }
        dataset.array("exact_amplitude", Quantity::Force, each(&|row| row.exact.clone()))
    }
}

/// "a sine", "a burst 3 : 5".
fn named(row: &ComparedWaveform) -> String {
    format!("a {}", row.label())
}

/// A share as a percentage with three digits.
fn digits_of_percent(share: f64) -> String {
    quell_model::digits::digits(100.0 * share, 3)
}
