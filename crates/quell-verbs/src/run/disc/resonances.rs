//! `resonances`: where waves of the disc meet, which pairs can be unstable at the order of the theory, where motions grow by the exact
//! equations, and which dither frequencies keep a range of speeds clear.

use std::ops::RangeInclusive;

use quell_disc::growing::{GrowingSpeeds, growing_speeds};
use quell_disc::resonance::{
    Blocked, Clearance, ClearanceError, Nearby, TestedFrequency, Tongue, Verification, Verified,
    WaveError, Waves, clear_frequencies, verified_frequency, within,
};
pub use quell_disc::resonance::{Order, Resonance};
use quell_linear::floquet::NotFollowerDither;
pub use quell_linear::growth::Verdict;
use quell_model::Disc;
use quell_model::disc::Contributions;
use quell_model::parameter::{Bounds, DITHER_FREQUENCY_RATIO};
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;
use serde_json::{Map, Value as Json, json};

use crate::complaint::{Complaint, Complaints, Failure, Fault, Origin};
use crate::dataset::{Array, Dataset};
use crate::disc_units::FRICTION;
use crate::said::{Mention, Said};
use crate::study::DiscStudy;

/// Largest number of harmonics of a dither that are examined: their meetings fill an answer of some hundred thousand lines.
const MOST_HARMONICS: f64 = 5000.0;

/// Options of `resonances`.
#[derive(Clone, Debug, PartialEq)]
pub struct ResonancesRequest {
    /// Range of speeds in which meetings are listed.
    pub speeds: RangeInclusive<f64>,
    /// Order of the expansion.
    pub order: Order,
    /// A range of speeds to be kept clear, and the range of dither frequencies to search.
    pub clear: Option<(RangeInclusive<f64>, RangeInclusive<f64>)>,
}

impl ResonancesRequest {
    /// Checks the ends of the ranges of speeds and dither frequencies.
    ///
    /// # Errors
    /// Every complaint at once.
    pub fn new(
        speeds: RealInterval,
        order: Order,
        clear: Option<RealInterval>,
        frequency: Option<RealInterval>,
    ) -> Result<Self, Complaints> {
        let mut wrong = Vec::new();
        let mut range = |option, bounds: Bounds, range: RealInterval| {
            let RealInterval { lower: from, upper: to } = range;
            let given = || format!("{from}:{to}");
            if !(from.is_finite() && to.is_finite() && from <= to) {
                let allowed = "FROM:TO, two finite numbers, the first at most the second";
                wrong.push(Complaint::option(option, given(), allowed));
            } else if !(bounds.contains(from) && bounds.contains(to)) {
                let allowed = format!("a range with both ends {bounds}");
                wrong.push(Complaint::option(option, given(), allowed));
            }
            from..=to
        };
        let speeds = range("--speeds", Bounds::FINITE, speeds);
        let wanted = clear.map(|ends| range("--clear", Bounds::FINITE, ends));
        let frequencies =
            frequency.map(|ends| range("--frequency", DITHER_FREQUENCY_RATIO.bounds, ends));
        for (option, one, other) in
            [("--clear", clear, frequency.is_none()), ("--frequency", frequency, clear.is_none())]
        {
            if let Some(RealInterval { lower: from, upper: to }) = one
                && other
            {
                let allowed = "--clear and --frequency must be given together";
                let (origin, given) = (Origin::Argument(option), format!("{from}:{to}"));
                wrong.push(Complaint::new(Fault::Conflict, option, origin, given, allowed));
            }
        }
        if !wrong.is_empty() {
            return Err(wrong.into());
        }
        Ok(Self { speeds, order, clear: wanted.zip(frequencies) })
    }
}

impl Default for ResonancesRequest {
    fn default() -> Self {
        Self { speeds: 0.0..=1.0, order: Order::First, clear: None }
    }
}

/// Dither frequencies that keep a range of speeds clear.
#[derive(Clone, Debug, PartialEq)]
pub struct Clear {
    /// The range of speeds.
    pub speeds: RangeInclusive<f64>,
    /// The frequencies searched.
    pub frequencies: RangeInclusive<f64>,
    /// Clear intervals, and the resonances that block the rest.
    pub clearance: Clearance,
    /// The best frequency by the exact exponents, or the middle of the widest interval if they cannot be computed; and the
    /// resonances in the range of speeds there, with the original tongues to second order.
    pub suggestion: Option<(f64, Vec<Nearby>)>,
    /// The largest growth rate of the exact equations at that frequency over the range of speeds.
    pub verified: Option<Verified>,
    /// The frequencies that were tested by the exact equations.
    pub tested: Vec<TestedFrequency>,
}

/// Speeds in which a motion grows by the exact equations, and which pair of waves explains it.
#[derive(Clone, Debug, PartialEq)]
pub struct GrowingInterval {
    /// The speeds and the largest growth.
    pub speeds: GrowingSpeeds,
    /// What theory says of it.
    pub explained: Explained,
}

/// How theory explains an interval of growth.
#[derive(Clone, Debug, PartialEq)]
pub enum Explained {
    /// A single wave grows at its fastest speed by itself.
    Wave,
    /// The tongue of a pair of waves at this order reaches into it.
    Pair {
        /// The order.
        order: Order,
        /// The meeting.
        meeting: Resonance,
    },
    /// No wave and no pair of waves grows there at first or second order; the meeting whose speed is nearest.
    Not {
        /// The nearest meeting.
        nearest: Option<Resonance>,
    },
}

/// Resonances of a study's disc.
#[derive(Clone, Debug, PartialEq)]
pub struct Resonances {
    /// The request.
    pub question: ResonancesRequest,
    /// Meetings without dither.
    pub undithered: Vec<Resonance>,
    /// Meetings induced by dither.
    pub dithered: Vec<Resonance>,
    /// The speeds in which a motion grows by the exact equations, at the friction of the study; or why they are not known.
    pub growing: Result<Vec<GrowingInterval>, NotFollowerDither>,
    /// The answer about clear frequencies.
    pub clear: Option<Clear>,
}

/// Resonances of a study's disc.
///
/// # Errors
/// A complaint if the theory does not apply (not exactly one load, negative friction, parts left out), if the disc has no dither
/// whose frequency could be chosen, or if a wave grows on its own at any frequency.
pub fn run(study: &DiscStudy, question: ResonancesRequest) -> Result<Resonances, Failure> {
    let refuse = |key: &str, why: Said| {
        Failure::from(Complaint::new(Fault::Conflict, key, Origin::Whole, Json::Null, why))
    };
    if study.parts() != Contributions::ALL {
        let given = study.without();
        let allowed = "empty: resonance theory applies to the whole disc only";
        let complaint = Complaint::new(Fault::Value, "disc.without", Origin::Whole, given, allowed);
        return Err(complaint.into());
    }
    let waves = Waves::new(study.disc()).map_err(|why| {
        let allowed = match why {
            WaveError::Loads(_) => {
                let verbs = Said::from(format!("{why}; ")).mention(Mention::Stability);
                verbs.text(" and ").mention(Mention::MapOfGrowth).text(" take any number of loads")
            }
            WaveError::NotPlain
            | WaveError::Stiffened
            | WaveError::NegativeFriction { .. }
            | WaveError::Frequency { .. } => why.to_string().into(),
        };
        refuse("disc.load", allowed)
    })?;
    let waves = waves.with_order(question.order);
    let own = study.disc().dither().frequency_ratio().map(|ratio| (&question.speeds, ratio));
    let searched = question.clear.iter().map(|(speeds, range)| (speeds, *range.start()));
    for (speeds, ratio) in own.into_iter().chain(searched) {
        let count = waves.harmonics_within(speeds, ratio);
        if count > MOST_HARMONICS {
            let why = format!(
                "{count} harmonics of this dither can resonate in these speeds, more than {MOST_HARMONICS}: a shorter burst, \
                 a higher frequency or a smaller range of speeds has fewer"
            );
            return Err(refuse("dither", why.into()));
        }
    }
    let clear = match &question.clear {
        None => None,
        Some((speeds, frequencies)) => {
            let clearance = clear_frequencies(&waves, speeds.clone(), frequencies.clone())
                .map_err(|why| match why {
                    ClearanceError::NoDither => refuse("dither", why.to_string().into()),
                    ClearanceError::Range => refuse("--clear", why.to_string().into()),
                    ClearanceError::WaveUnstable { .. } => {
                        Failure::Failed { key: "--clear".to_owned(), why: why.to_string().into() }
                    }
                })?;
            let widest =
                clearance.clear.iter().max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
            let Verification { best: verified, tested } =
                verified_frequency(study.disc(), &clearance, speeds.clone());
            let suggestion = widest.map(|[from, to]| {
                let ratio = verified.map_or(0.5 * (from + to), |best| best.frequency_ratio);
                let there = waves
                    .with_dither_frequency(ratio)
                    .map_err(|why| refuse("--frequency", why.to_string().into()))?;
                Ok::<_, Failure>((ratio, within(&there, speeds.clone())))
            });
            let suggestion = suggestion.transpose()?;
            let (speeds, frequencies) = (speeds.clone(), frequencies.clone());
            Some(Clear { speeds, frequencies, clearance, suggestion, verified, tested })
        }
    };
    let speeds = question.speeds.clone();
    Ok(Resonances {
        growing: growing(study.disc(), &waves, &speeds),
        undithered: waves.undithered(speeds.clone()),
        dithered: waves.dithered(speeds),
        question,
        clear,
    })
}

/// Equal steps of the range of speeds in which motions that grow are searched, besides the predicted tongues.
const STEPS: u32 = 240;

/// The speeds in which a motion grows by the exact equations, with their explanation.
fn growing(
    disc: &Disc,
    waves: &Waves,
    speeds: &RangeInclusive<f64>,
) -> Result<Vec<GrowingInterval>, NotFollowerDither> {
    let found = growing_speeds(disc, speeds, STEPS)?;
    let orders =
        [Order::First, Order::Second].map(|order| (order, waves.clone().with_order(order)));
    let (start, end) = (*speeds.start(), *speeds.end());
    // A tongue next to the range may reach into it.
    let wide = start - 0.5..=end + 0.5;
    let all = orders.map(|(order, waves)| {
        let meetings = waves.undithered(wide.clone()).into_iter();
        (order, meetings.chain(waves.dithered(wide.clone())).collect::<Vec<_>>())
    });
    let explain = |speeds: &GrowingSpeeds| -> Explained {
        let peak = speeds.peak_speed;
        if waves.waves().iter().any(|wave| waves.growth_rate(wave, peak) > 0.0) {
            return Explained::Wave;
        }
        let apart = |meeting: &&Resonance| (meeting.speed - peak).abs();
        for (order, meetings) in &all {
            let reaches = |meeting: &&Resonance| {
                let edges = meeting.tongue.edges();
                edges.is_some_and(|[low, high]| low <= speeds.to && high >= speeds.from)
            };
            let reaching = meetings.iter().filter(reaches);
            let meeting = reaching.min_by(|a, b| apart(a).total_cmp(&apart(b)));
            if let Some(meeting) = meeting {
                return Explained::Pair { order: *order, meeting: *meeting };
            }
        }
        let nearest = all[0].1.iter().min_by(|a, b| apart(a).total_cmp(&apart(b)));
        Explained::Not { nearest: nearest.copied() }
    };
    Ok(found
        .into_iter()
        .map(|speeds| GrowingInterval { explained: explain(&speeds), speeds })
        .collect())
}

/// An interval of growth as JSON.
fn interval(growing: &GrowingInterval) -> Json {
    let GrowingSpeeds { from, to, peak_speed, peak_growth } = growing.speeds;
    let (explained, order, pair) = match &growing.explained {
        Explained::Wave => ("wave", Json::Null, Json::Null),
        Explained::Pair { order, meeting } => {
            ("pair", named(*order).into(), meeting.label().into())
        }
        Explained::Not { .. } => ("none", Json::Null, Json::Null),
    };
    let mut object = json!({
        "from": from,
        "to": to,
        "peak_speed": peak_speed,
        "peak_growth": peak_growth,
        "explained_by": explained,
        "order": order,
        "pair": pair,
    });
    if let Explained::Not { nearest } = &growing.explained {
        object["nearest_meeting"] = nearest.map_or(Json::Null, |meeting| meeting.speed.into());
        object["why"] = json!({ "pair": THREE_WAVES });
    }
    object
}

/// What theory says of an interval of growth that it does not explain.
pub const THREE_WAVES: &str = "no wave and no pair of waves grows there at first or second order: three waves or more grow together";

/// The name of an order.
pub fn named(order: Order) -> &'static str {
    match order {
        Order::First => "first",
        Order::Second => "second",
    }
}

/// A meeting as JSON.
fn meeting(resonance: &Resonance) -> Json {
    let [first, second] = &resonance.waves;
    let mut why = Map::new();
    let edges = resonance.tongue.edges();
    if edges.is_none() {
        let reason = match resonance.tongue {
            Tongue::WaveUnstable { .. } => "one wave of the pair grows, or is undamped, on its own",
            _ => "no tongue exists at this friction",
        };
        why.insert("edges".to_owned(), reason.into());
    }
    if resonance.tongue.peak_growth().is_none() {
        let reason = "no tongue exists at this friction";
        why.insert("peak_growth".to_owned(), reason.into());
    }
    if resonance.threshold.is_none() {
        let reason = if resonance.pair_can_be_unstable() {
            "as friction rises, a wave grows on its own before a tongue appears"
        } else {
            "this pair of waves has no tongue at this order at any friction"
        };
        why.insert("threshold".to_owned(), reason.into());
    }
    let mut object = json!({
        "speed": resonance.speed,
        "waves": [first.to_string(), second.to_string()],
        "pair": resonance.label(),
        "conjugate": resonance.sum,
        "harmonic": resonance.harmonic,
        "pair_can_be_unstable": resonance.pair_can_be_unstable(),
        "threshold": resonance.threshold,
        "edges": edges,
        "width": resonance.tongue.width(),
        "peak_growth": resonance.tongue.peak_growth(),
    });
    if !why.is_empty() {
        object["why"] = Json::Object(why);
    }
    object
}

fn blocked(block: &Blocked) -> Json {
    let [first, second] = &block.waves;
    json!({
        "from": block.from,
        "to": block.to,
        "waves": [first.to_string(), second.to_string()],
        "conjugate": block.sum,
        "harmonic": block.harmonic,
    })
}

impl Resonances {
    /// As a dataset: one row per meeting; meetings induced by dither have a nonzero harmonic.
    pub fn dataset(&self, study: &DiscStudy) -> Dataset {
        let all: Vec<&Resonance> = self.undithered.iter().chain(&self.dithered).collect();
        let column = |of: &dyn Fn(&Resonance) -> f64| {
            all.iter().map(|resonance| of(resonance)).collect::<Vec<_>>()
        };
        let edge = |side: usize| {
            column(&move |resonance| resonance.tongue.edges().map_or(f64::NAN, |edges| edges[side]))
        };
        let none = f64::NAN;
        let number = (1..=all.len()).map(|index| index as f64).collect();
        let mut dataset = Dataset::of(&study.into(), "resonances");
        for (index, resonance) in all.iter().enumerate() {
            dataset = dataset.fact(format!("meeting {}: {}", index + 1, resonance.label()));
        }
        dataset
            .axis("meeting", Quantity::Count, number)
            .with(Array::new("speed", "ω_ref", column(&|resonance| resonance.speed)))
            .with(Array::new("harmonic", "1", column(&|resonance| f64::from(resonance.harmonic))))
            .with(Array::new(
                "pair_can_be_unstable",
                "1",
                column(&|resonance| f64::from(u8::from(resonance.pair_can_be_unstable()))),
            ))
            .with(Array::new(
                "threshold",
                FRICTION,
                column(&|resonance| resonance.threshold.unwrap_or(none)),
            ))
            .with(Array::new("lower_edge", "ω_ref", edge(0)))
            .with(Array::new("upper_edge", "ω_ref", edge(1)))
            .with(Array::new(
                "peak_growth",
                "ω_ref",
                column(&|resonance| resonance.tongue.peak_growth().unwrap_or(none)),
            ))
    }

    /// As JSON.
    pub fn json(&self, study: &DiscStudy) -> Json {
        let (start, end) = (self.question.speeds.start(), self.question.speeds.end());
        let mut object = json!({
            "ok": true,
            "speeds": [start, end],
            "order": named(self.question.order),
            "undithered": self.undithered.iter().map(meeting).collect::<Vec<_>>(),
            "dithered": self.dithered.iter().map(meeting).collect::<Vec<_>>(),
            "growing": self.growing.as_ref().ok().map(|found| {
                found.iter().map(interval).collect::<Vec<_>>()
            }),
            "friction": study.disc().loads().first().map(|load| load.friction),
            "units": {
                "speeds": "ω_ref", "speed": "ω_ref", "edges": "ω_ref", "width": "ω_ref", "peak_growth": "ω_ref", "threshold": FRICTION,
                "from": "ω_ref", "to": "ω_ref", "peak_speed": "ω_ref", "nearest_meeting": "ω_ref", "friction": FRICTION,
            },
            "warnings": study.warnings(),
        });
        if let Err(why) = &self.growing {
            object["why"] = json!({ "growing": why.to_string() });
        }
        if let Some(clear) = &self.clear {
            let mut inner = json!({
                "speeds": [clear.speeds.start(), clear.speeds.end()],
                "frequencies": [clear.frequencies.start(), clear.frequencies.end()],
                "clear": clear.clearance.clear,
                "blocked": clear.clearance.blocked.iter().map(blocked).collect::<Vec<_>>(),
                "original_suppressed": clear.clearance.original_suppressed,
                "suggestion": clear.suggestion.as_ref().map(|(ratio, _)| *ratio),
                "verified_growth_rate": clear.verified.map(|verified| verified.growth.rate),
                "verified": clear.verified.map(|verified| json!({
                    "verdict": verified.growth.verdict().name(),
                    "growth_rate": verified.growth.rate,
                    "growth_rate_error": verified.growth.error,
                    "speed": verified.speed,
                })),
                "tested": clear.tested.iter().map(|tested| json!({
                    "frequency": tested.result.frequency_ratio,
                    "verdict": tested.result.growth.verdict().name(),
                    "growth_rate": tested.result.growth.rate,
                    "speed": tested.result.speed,
                })).collect::<Vec<_>>(),
                "units": {
                    "speeds": "ω_ref", "frequencies": "ω_ref", "clear": "ω_ref", "suggestion": "ω_ref",
                    "verified_growth_rate": "ω_ref", "growth_rate": "ω_ref", "growth_rate_error": "ω_ref", "speed": "ω_ref", "frequency": "ω_ref",
                },
            });
            let mut why = Map::new();
            if clear.suggestion.is_none() {
                why.insert("suggestion".to_owned(), "no frequency in the range is clear".into());
            }
            if clear.verified.is_none() {
                let reason = if clear.suggestion.is_none() {
                    "no frequency in the range is clear"
                } else {
                    "the Floquet exponents could not be computed"
                };
                for name in ["verified_growth_rate", "verified"] {
                    why.insert(name.to_owned(), reason.into());
                }
            }
            if !why.is_empty() {
                inner["why"] = Json::Object(why);
            }
            if let Some((_, nearby)) = &clear.suggestion {
                let nearby: Vec<Json> = nearby
                    .iter()
                    .map(|nearby| {
                        let mut object = meeting(&nearby.resonance);
                        object["reaches_in"] = nearby.reaches_in.into();
                        object
                    })
                    .collect();
                inner["there"] = nearby.into();
            }
            object["clear"] = inner;
        }
        object
    }
}
