//! `orbit`: the base response under dither, a periodic response near a given state, or the one on which a run ends,
//! with its Floquet multipliers; without dither the limit cycles, or steady sliding if no limit cycle exists.

use quell_dynamics::attractor::orbit_reached;
use quell_dynamics::orbit::cycle::{cycle_reached, cycles, sliding_verdict};
use quell_dynamics::orbit::{NoOrbit, from_sliding, near};
pub use quell_dynamics::orbit::{Orbit, OrbitVerdict};
use quell_dynamics::simulation::{
    DEFAULT_TOLERANCE, EventKind, Extremes, Observer, Sample, Sampler, Start, simulate, within,
};
use quell_model::Belt;
use quell_model::units::Quantity;
use serde_json::{Value as Json, json};

use super::protocol::Protocol;
use super::{failed, moves, resolved};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::contact_state::refused_of_belt;
use crate::dataset::Dataset;
use crate::effort::STEPS_OF_A_SEARCH;
use crate::fields::Fields;
use crate::range::SlipMet;
use crate::study::BeltStudy;
use crate::words::in_words;

/// Minimum number of steps in which the dither amplitude is raised from zero to its value.
const STEPS: u32 = 8;

/// Added to the answer where a run from rest replaces the continuation from steady sliding.
const FROM_REST_INSTEAD: &str = "It was reached by a run from rest, because at v₀ = 0 there is no steady sliding to continue from.";

/// Number of sampling steps in a period.
const SAMPLES: usize = 1200;

/// The periodic response to find.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wanted {
    /// The base response, continued from steady sliding; without dither the limit cycle; at v₀ = 0, where steady sliding
    /// does not exist, the response on which a run from rest ends.
    OfSliding {
        /// Number of common dither periods in a period of the response.
        periods: u32,
    },
    /// A response near a state; without dither the cycle whose lowest point is nearest to it.
    Near {
        /// Displacement x and velocity x′ at τ = 0.
        state: (f64, f64),
        /// Number of common dither periods in a period of the response.
        periods: u32,
    },
    /// The response on which a run from this start ends, of any number of periods.
    After(Protocol),
}

impl Default for Wanted {
    fn default() -> Self {
        Self::OfSliding { periods: 1 }
    }
}

/// The periodic response, and the limit cycles of an undithered belt.
#[derive(Clone, Debug, PartialEq)]
pub struct PeriodicResponse {
    /// The periodic response; `None` for an undithered belt without a limit cycle.
    pub orbit: Option<Orbit>,
    /// Every limit cycle of an undithered belt, the largest first.
    pub cycles: Vec<Orbit>,
    /// Verdict on steady sliding of an undithered belt: stable if 2ζ + μ′(v₀)F > 0.
    pub sliding: Option<OrbitVerdict>,
    /// Whether a run from rest was used because v₀ = 0 has no steady sliding to continue from.
    pub from_rest_instead: bool,
    /// The slip reached by the responses over their periods.
    pub slip: SlipMet,
}

impl PeriodicResponse {
    /// The result for a periodic response of a belt.
    fn of(belt: &Belt, orbit: Orbit) -> Self {
        let slip = slip_of(belt, [&orbit]);
        let orbit = Some(orbit);
        Self { orbit, cycles: Vec::new(), sliding: None, from_rest_instead: false, slip }
    }
}

/// The slip reached by responses of a belt over their periods.
fn slip_of<'o>(belt: &Belt, orbits: impl IntoIterator<Item = &'o Orbit>) -> SlipMet {
    let mut slip = SlipMet::default();
    for orbit in orbits {
        slip.add_run(belt, orbit.start, orbit.period);
    }
    slip
}

/// The periodic response of a study.
///
/// # Errors
/// A complaint if the response has no prescribed period; [`Failure::Failed`] with the last state if shooting does not converge.
pub fn run(study: &BeltStudy, wanted: Wanted) -> Result<PeriodicResponse, Failure> {
    refused_of_belt(study, "orbit")?;
    within(STEPS_OF_A_SEARCH, || found(study, wanted))
}

fn found(study: &BeltStudy, wanted: Wanted) -> Result<PeriodicResponse, Failure> {
    let belt = study.belt();
    if belt.dithers().is_empty() {
        return undithered(study, wanted);
    }
    let from_rest_instead =
        matches!(wanted, Wanted::OfSliding { .. }) && belt.belt_velocity() == 0.0;
    let found = match wanted {
        Wanted::OfSliding { periods } if from_rest_instead && periods > 1 => {
            let allowed = "1 at v₀ = 0 unless --near is given: the run from rest determines the number of periods";
            return Err(Complaint::option("--periods", periods, allowed).into());
        }
        Wanted::OfSliding { .. } if from_rest_instead => {
            orbit_reached(belt, Protocol::Rest.start(study)?)
        }
        Wanted::After(protocol) => {
            let start = protocol.start(study)?;
            orbit_reached(belt, start)
        }
        Wanted::Near { state: (displacement, velocity), periods } => {
            near(belt, Start { time: 0.0, displacement, velocity }, periods.max(1))
        }
        Wanted::OfSliding { periods: 0 | 1 } => from_sliding(belt, STEPS),
        Wanted::OfSliding { periods } => {
            from_sliding(belt, STEPS).and_then(|orbit| near(belt, orbit.start, periods))
        }
    };
    let response =
        |orbit| PeriodicResponse { from_rest_instead, ..PeriodicResponse::of(belt, orbit) };
    found.map(response).map_err(refused)
}

/// The limit cycles of an undithered belt.
fn undithered(study: &BeltStudy, wanted: Wanted) -> Result<PeriodicResponse, Failure> {
    let belt = study.belt();
    if let Wanted::OfSliding { periods } | Wanted::Near { periods, .. } = wanted
        && periods > 1
    {
        let allowed = "1: without dither there is no dither period to count";
        return Err(Complaint::option("--periods", periods, allowed).into());
    }
    let why = "on an undithered belt at rest any position inside the stick band is an equilibrium, so no response is periodic";
    moves(study, why)?;
    let cycles = cycles(belt).map_err(refused)?;
    let orbit = match wanted {
        Wanted::After(Protocol::Sliding) => None,
        Wanted::After(protocol) => {
            cycle_reached(belt, &cycles, protocol.start(study)?).map_err(refused)?
        }
        Wanted::OfSliding { .. } => cycles.first(),
        Wanted::Near { state: (x, v), .. } => {
            let off =
                |cycle: &&Orbit| (cycle.start.displacement - x).hypot(cycle.start.velocity - v);
            cycles.iter().min_by(|a, b| off(a).total_cmp(&off(b)))
        }
    };
    let sliding = Some(sliding_verdict(belt));
    let mut slip = slip_of(belt, &cycles);
    slip.add(belt, belt.belt_velocity());
    Ok(PeriodicResponse { orbit: orbit.cloned(), cycles, sliding, from_rest_instead: false, slip })
}

impl Protocol {
    /// The state at τ = 0.
    pub(super) fn start(self, study: &BeltStudy) -> Result<Start, Failure> {
        resolved(study, self.initial(), |why| {
            let key = "--from-squeal";
            let allowed = format!("choose another start: {why}");
            Complaint::new(Fault::Conflict, key, Origin::Argument(key), Json::Null, allowed)
        })
    }
}

/// Integrates one period of an orbit with an observer. If the engine stops, the observer keeps the part before: the orbit
/// itself was already integrated when it was found.
fn trace(study: &BeltStudy, orbit: &Orbit, observer: &mut impl Observer) {
    let free;
    let belt = if orbit.is_free {
        free = study.belt().undithered();
        &free
    } else {
        study.belt()
    };
    let end = orbit.start.time + orbit.period;
    let _ = simulate(belt, orbit.start, end, DEFAULT_TOLERANCE, observer);
}

/// Least and largest displacement and velocity over a period.
pub fn extremes(study: &BeltStudy, orbit: &Orbit) -> Extremes {
    let mut extremes = Extremes::default();
    trace(study, orbit, &mut extremes);
    extremes
}

/// States at equal steps over a period, both ends included.
pub fn samples(study: &BeltStudy, orbit: &Orbit) -> Vec<Sample> {
    let mut sampler = Sampler::new(orbit.start.time, orbit.period / SAMPLES as f64, SAMPLES + 1);
    trace(study, orbit, &mut sampler);
    sampler.samples
}

/// The failure that reports why no orbit was found.
pub(super) fn refused(why: NoOrbit) -> Failure {
    let key = match why {
        NoOrbit::NoDither => "dither",
        NoOrbit::Incommensurate => {
            return Failure::Failed { key: "dither".to_owned(), why: why.to_string() };
        }
        NoOrbit::NotConverged { .. }
        | NoOrbit::Degenerate { .. }
        | NoOrbit::Another { .. }
        | NoOrbit::Ends { .. }
        | NoOrbit::LostOnTheWay { .. }
        | NoOrbit::NoPeriod { .. }
        | NoOrbit::AtRest
        | NoOrbit::Unsettled(_)
        | NoOrbit::NoLimit
        | NoOrbit::NoMirror
        | NoOrbit::Invalid { .. } => {
            return Failure::Failed { key: "orbit".to_owned(), why: why.to_string() };
        }
        NoOrbit::Stalled(stalled) => return failed(stalled),
    };
    Complaint::new(Fault::Value, key, Origin::Whole, Json::Null, why.to_string()).into()
}

/// The orbit in one sentence.
pub fn sentence(study: &BeltStudy, orbit: &Orbit) -> String {
    let verdict = match orbit.verdict() {
        OrbitVerdict::Stable => "It is stable: small deviations die out.",
        OrbitVerdict::Unstable => "It is unstable: small deviations grow.",
        OrbitVerdict::Undecided => {
            "Its stability is undecided: the largest multiplier has modulus 1 within its error."
        }
    };
    let contact = match (orbit.count(EventKind::Stick), orbit.count(EventKind::Reversal)) {
        (0, 0) if orbit.is_pure_slip() => "slides throughout, without grazing v_r = 0".to_owned(),
        (0, 0) => "sticks throughout".to_owned(),
        (0, reversals) => format!("reverses {} per period and never sticks", times(reversals)),
        (sticks, 0) => format!("sticks {} per period and never reverses", times(sticks)),
        (sticks, reversals) => {
            format!("sticks {} and reverses {} per period", times(sticks), times(reversals))
        }
    };
    let period = in_words(study, Quantity::Time, orbit.period);
    let what = if orbit.is_free { "The limit cycle without dither" } else { "The response" };
    format!("{what} has period {period}. It {contact}. {verdict}")
}

/// A count as text: "once", "twice", "3 times".
fn times(count: usize) -> String {
    match count {
        1 => "once".to_owned(),
        2 => "twice".to_owned(),
        count => format!("{count} times"),
    }
}

impl PeriodicResponse {
    /// The result in one or two sentences.
    pub fn sentence(&self, study: &BeltStudy) -> String {
        match &self.orbit {
            Some(orbit) if self.from_rest_instead => {
                format!("{} {FROM_REST_INSTEAD}", sentence(study, orbit))
            }
            Some(orbit) => sentence(study, orbit),
            None => self.without_orbit(study),
        }
    }

    fn without_orbit(&self, study: &BeltStudy) -> String {
        let place = in_words(study, Quantity::Displacement, study.belt().steady_sliding());
        let whether = match self.sliding {
            Some(OrbitVerdict::Stable) => "which is stable",
            Some(OrbitVerdict::Unstable) => "which is unstable",
            Some(OrbitVerdict::Undecided) | None => "which is at its stability threshold",
        };
        let cycles = if self.cycles.is_empty() {
            "No limit cycle was found."
        } else {
            "It coexists with the limit cycles."
        };
        format!("Without dither the response is steady sliding at x = {place}, {whether}. {cycles}")
    }

    /// The periodic response over one period.
    ///
    /// # Errors
    /// [`Failure::Failed`] if no periodic response exists.
    pub fn dataset(&self, study: &BeltStudy) -> Result<Dataset, Failure> {
        let why = || Failure::Failed { key: "--save".to_owned(), why: self.sentence(study) };
        let samples = samples(study, self.orbit.as_ref().ok_or_else(why)?);
        let column = |value: fn(&Sample) -> f64| samples.iter().map(value).collect::<Vec<f64>>();
        let dataset = Dataset::new(study, "orbit")
            .fact(self.sentence(study))
            .axis("time", Quantity::Time, column(|sample| sample.time))
            .array("displacement", Quantity::Displacement, column(|sample| sample.displacement))
            .array("velocity", Quantity::Velocity, column(|sample| sample.velocity))
            .array(
                "sticking",
                Quantity::Count,
                column(|sample| f64::from(u8::from(sample.sticking))),
            );
        Ok(dataset)
    }

    /// As JSON.
    pub fn json(&self, study: &BeltStudy) -> Json {
        let mut object = match &self.orbit {
            Some(orbit) => json(study, orbit),
            None => self.sliding_json(study),
        };
        if self.from_rest_instead {
            object["sentence"] = self.sentence(study).into();
        }
        object["warnings"] = self.slip.warnings(study).into();
        if self.sliding.is_some() {
            object["cycles"] = self.cycles.iter().map(|cycle| json(study, cycle)).collect();
        }
        object
    }

    fn sliding_json(&self, study: &BeltStudy) -> Json {
        let sentence = self.without_orbit(study);
        let mut fields = Fields::new(study.scales());
        fields
            .plain("ok", true)
            .plain("sentence", sentence.clone())
            .plain("protocol", "local: 2ζ + μ′(v₀)F of steady sliding")
            .unknown("free_phase", sentence.clone())
            .number("displacement", Quantity::Displacement, study.belt().steady_sliding())
            .number("velocity", Quantity::Velocity, 0.0)
            .known("period", Quantity::Time, Err(sentence.clone()))
            .unknown("multipliers", sentence.clone())
            .unknown("monodromy", sentence)
            .plain("verdict", self.sliding.map_or("undecided", OrbitVerdict::name))
            .plain("stick_episodes", 0)
            .plain("reversals", 0)
            .number("stick_fraction", Quantity::Ratio, 0.0)
            .number("residual", Quantity::Displacement, 0.0)
            .number("state_error", Quantity::Displacement, 0.0)
            .number("multiplier_error", Quantity::Ratio, 0.0)
            .number("lowest", Quantity::Displacement, study.belt().steady_sliding())
            .number("highest", Quantity::Displacement, study.belt().steady_sliding())
            .number("lowest_velocity", Quantity::Velocity, 0.0)
            .number("highest_velocity", Quantity::Velocity, 0.0)
            .plain("signature", Vec::<Json>::new())
            .number("least_slip_velocity", Quantity::Velocity, study.belt().belt_velocity())
            .plain("warnings", Vec::<Json>::new());
        fields.finish()
    }
}

/// An estimated error, or why it is unknown.
fn finite(error: f64) -> Result<f64, String> {
    if error.is_finite() {
        return Ok(error);
    }
    Err("a multiplier is too close to 1 for the error of the state to be bounded".to_owned())
}

/// The orbit as JSON.
pub fn json(study: &BeltStudy, orbit: &Orbit) -> Json {
    let mut fields = Fields::new(study.scales());
    fields
        .plain("ok", true)
        .plain("sentence", sentence(study, orbit))
        .plain("protocol", "local: Floquet multipliers of the periodic response")
        .plain("free_phase", orbit.is_free)
        .number("displacement", Quantity::Displacement, orbit.start.displacement)
        .number("velocity", Quantity::Velocity, orbit.start.velocity)
        .number("period", Quantity::Time, orbit.period)
        .plain("multipliers", orbit.multipliers.map(|(re, im)| vec![re, im]).to_vec())
        .plain("monodromy", orbit.monodromy.map(|row| row.to_vec()).to_vec())
        .plain("verdict", orbit.verdict().name())
        .plain("stick_episodes", orbit.count(EventKind::Stick))
        .plain("reversals", orbit.count(EventKind::Reversal))
        .number("stick_fraction", Quantity::Ratio, orbit.stick_fraction)
        .number("residual", Quantity::Displacement, orbit.residual)
        .known("state_error", Quantity::Displacement, finite(orbit.state_error))
        .known("multiplier_error", Quantity::Ratio, finite(orbit.multiplier_error));
    let Extremes { displacement, velocity } = extremes(study, orbit);
    fields
        .number("lowest", Quantity::Displacement, displacement.0)
        .number("highest", Quantity::Displacement, displacement.1)
        .number("lowest_velocity", Quantity::Velocity, velocity.0)
        .number("highest_velocity", Quantity::Velocity, velocity.1);
    let signature: Vec<Json> = orbit
        .events
        .iter()
        .map(|(kind, sign)| json!({ "kind": kind.name(), "slip_sign": sign }))
        .collect();
    fields.plain("signature", signature);
    let stuck = || "the response sticks throughout".to_owned();
    let least = orbit.least_slip.map(|(value, _)| value).ok_or_else(stuck);
    fields.known("least_slip_velocity", Quantity::Velocity, least);
    fields.plain("warnings", Vec::<Json>::new());
    fields.finish()
}
