//! `orbit`: the periodic response that sliding becomes under dither, one near a given state, or the one on which a run ends,
//! with its Floquet multipliers; without dither the limit cycles, or steady sliding where there is none.

use quell_belt::orbit::cycle::{cycle_reached, cycles};
use quell_belt::orbit::reached::orbit_reached;
use quell_belt::orbit::{NoOrbit, from_sliding, near};
pub use quell_belt::orbit::{Orbit, Verdict};
use quell_belt::simulation::{EventKind, Start, within};
use quell_model::units::Quantity;
use serde_json::{Value as Json, json};

use super::thresholds::Protocol;
use super::{STEPS_OF_A_SEARCH, failed, in_words, moves, resolved};
use crate::complaint::{Complaint, Failure, Fault, Origin};
use crate::fields::Fields;
use crate::study::Study;

/// Least number of steps of the dither's amplitude from nothing to its value.
const STEPS: u32 = 8;

/// Most periods of the dither in one period of a response on which a run ends.
const MOST_PERIODS: u32 = 200;

/// Which periodic response is looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wanted {
    /// The one that sliding becomes; without dither the limit cycle.
    OfSliding {
        /// Common periods of the dithers in a period of the response.
        periods: u32,
    },
    /// One near a state. Without dither the cycle whose lowest point is nearest to it.
    Near {
        /// Displacement x and velocity x′ at τ = 0.
        state: (f64, f64),
        /// Common periods of the dithers in a period of the response.
        periods: u32,
    },
    /// The one on which a run from here ends, of whatever number of periods.
    After(Protocol),
}

impl Default for Wanted {
    fn default() -> Self {
        Self::OfSliding { periods: 1 }
    }
}

/// What was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    /// The periodic response; none for an undithered belt without a limit cycle.
    pub orbit: Option<Orbit>,
    /// Every limit cycle of an undithered belt, the largest first.
    pub cycles: Vec<Orbit>,
    /// Verdict on steady sliding of an undithered belt, 2ζ + μ′(v₀)F > 0.
    pub sliding: Option<Verdict>,
}

impl From<Orbit> for Response {
    fn from(orbit: Orbit) -> Self {
        Self { orbit: Some(orbit), cycles: Vec::new(), sliding: None }
    }
}

/// The periodic response of a study.
///
/// # Errors
/// A complaint where there is no period; [`Failure::Failed`] where shooting does not converge, with the place.
pub fn run(study: &Study, wanted: Wanted) -> Result<Response, Failure> {
    within(STEPS_OF_A_SEARCH, || found(study, wanted))
}

fn found(study: &Study, wanted: Wanted) -> Result<Response, Failure> {
    let belt = study.belt();
    if belt.dithers().is_empty() {
        return undithered(study, wanted);
    }
    let found = match wanted {
        Wanted::After(protocol) => {
            let start = protocol.start(study)?;
            orbit_reached(belt, start, MOST_PERIODS)
        }
        Wanted::Near { state: (displacement, velocity), periods } => {
            near(belt, Start { time: 0.0, displacement, velocity }, periods.max(1))
        }
        Wanted::OfSliding { periods: 0 | 1 } => from_sliding(belt, STEPS),
        Wanted::OfSliding { periods } => {
            from_sliding(belt, STEPS).and_then(|orbit| near(belt, orbit.start, periods))
        }
    };
    found.map(Response::from).map_err(refused)
}

/// The limit cycles of an undithered belt.
fn undithered(study: &Study, wanted: Wanted) -> Result<Response, Failure> {
    let belt = study.belt();
    if let Wanted::OfSliding { periods } | Wanted::Near { periods, .. } = wanted
        && periods > 1
    {
        let allowed = "1: without dither there are no periods of it to count";
        return Err(Complaint::option("--periods", periods, allowed).into());
    }
    let why = "on a belt at rest the mass may stay anywhere within the reach of friction: there is nothing periodic";
    moves(study, why)?;
    let cycles = cycles(belt).map_err(refused)?;
    let slope = belt.friction().slope(belt.belt_velocity());
    // e^−(2ζ + μ′F)/2 is the modulus of both multipliers over unit time.
    let radius = (-0.5 * belt.damping_rate(slope, belt.normal_load())).exp();
    let orbit = match wanted {
        Wanted::After(Protocol::Sliding) => None,
        Wanted::After(protocol) => {
            cycle_reached(belt, &cycles, protocol.start(study)?).map_err(refused)?
        }
        Wanted::OfSliding { .. } => cycles.first(),
        Wanted::Near { state: (x, v), .. } => {
            let off = |it: &&Orbit| (it.start.displacement - x).hypot(it.start.velocity - v);
            cycles.iter().min_by(|a, b| off(a).total_cmp(&off(b)))
        }
    };
    Ok(Response { orbit: orbit.cloned(), sliding: Some(Verdict::of(radius)), cycles })
}

impl Protocol {
    /// The state at τ = 0.
    pub(super) fn start(self, study: &Study) -> Result<Start, Failure> {
        resolved(study, self.initial(), |why| {
            let key = "--from-squeal";
            let allowed = format!("another start is needed: {why}");
            Complaint::new(Fault::Conflict, key, Origin::Argument(key), Json::Null, allowed)
        })
    }
}

/// Why there is no orbit, as it is told.
pub(super) fn refused(why: NoOrbit) -> Failure {
    let key = match why {
        NoOrbit::NoDither => "dither",
        NoOrbit::Incommensurate => "dither.frequency_ratio",
        NoOrbit::NotConverged { .. }
        | NoOrbit::Degenerate { .. }
        | NoOrbit::Another { .. }
        | NoOrbit::Ends { .. }
        | NoOrbit::LostOnTheWay { .. }
        | NoOrbit::NoPeriod { .. }
        | NoOrbit::NoLimit
        | NoOrbit::Invalid { .. } => {
            return Failure::Failed { key: "orbit".to_owned(), why: why.to_string() };
        }
        NoOrbit::Stalled(stalled) => return failed(stalled),
    };
    Complaint::new(Fault::Value, key, Origin::Whole, Json::Null, why.to_string()).into()
}

/// The orbit in one sentence.
pub fn sentence(study: &Study, orbit: &Orbit) -> String {
    let verdict = match orbit.verdict() {
        Verdict::Stable => "stable: small changes of it die out",
        Verdict::Unstable => "unstable: small changes of it grow",
        Verdict::Undecided => {
            "at its threshold: its largest multiplier has modulus 1 within the error"
        }
    };
    let contact = match (orbit.count(EventKind::Stick), orbit.count(EventKind::Reversal)) {
        (0, 0) if orbit.is_pure_slip() => "slides without touching v_r = 0".to_owned(),
        (0, 0) => "sticks throughout".to_owned(),
        (sticks, reversals) => format!("sticks {sticks} and reverses {reversals} times a period"),
    };
    let period = in_words(study, Quantity::Time, orbit.period);
    let what = if orbit.is_free { "The limit cycle without dither," } else { "The response" };
    format!("{what} of period {period} {contact}; it is {verdict}.")
}

impl Response {
    /// What was found in one sentence.
    pub fn sentence(&self, study: &Study) -> String {
        match &self.orbit {
            Some(orbit) => sentence(study, orbit),
            None => self.without_orbit(study),
        }
    }

    fn without_orbit(&self, study: &Study) -> String {
        let place = in_words(study, Quantity::Displacement, study.belt().steady_sliding());
        let whether = match self.sliding {
            Some(Verdict::Stable) => "which is stable",
            Some(Verdict::Unstable) => "which is unstable",
            Some(Verdict::Undecided) | None => "which is at its threshold",
        };
        let cycles = if self.cycles.is_empty() {
            "and no limit cycle was found"
        } else {
            "beside the limit cycles"
        };
        format!(
            "Without dither nothing gives the response a period: it is steady sliding at x = {place}, {whether}, {cycles}."
        )
    }

    /// As JSON.
    pub fn json(&self, study: &Study) -> Json {
        let mut object = match &self.orbit {
            Some(orbit) => json(study, orbit),
            None => self.sliding_json(study),
        };
        if self.sliding.is_some() {
            object["cycles"] = self.cycles.iter().map(|cycle| json(study, cycle)).collect();
        }
        object
    }

    fn sliding_json(&self, study: &Study) -> Json {
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
            .plain("verdict", self.sliding.map_or("undecided", Verdict::name))
            .plain("stick_episodes", 0)
            .plain("reversals", 0)
            .number("stick_fraction", Quantity::Ratio, 0.0)
            .number("residual", Quantity::Displacement, 0.0)
            .plain("signature", Vec::<Json>::new())
            .number("least_slip_velocity", Quantity::Velocity, study.belt().belt_velocity())
            .plain("warnings", Vec::<Json>::new());
        fields.finish()
    }
}

/// The orbit as JSON.
pub fn json(study: &Study, orbit: &Orbit) -> Json {
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
        .number("residual", Quantity::Displacement, orbit.residual);
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
