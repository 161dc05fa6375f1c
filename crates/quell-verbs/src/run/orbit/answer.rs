//! The answer of `orbit` in sentences, JSON and a dataset.

use quell_dynamics::motion::{ContactPhase, RecordedEvent};
use quell_dynamics::orbit::{NoOrbit, Orbit, OrbitVerdict, without_cycle};
use quell_dynamics::simulation::EventKind;
use quell_model::units::Quantity;
use quell_numerics::interval::RealInterval;
use serde_json::{Value as Json, json};

use super::{FoundBy, FoundMotion, PeriodicResponse};
use crate::complaint::Failure;
use crate::dataset::{Array, Dataset};
use crate::fields::Fields;
use crate::run::actuator::beyond_actuator;
use crate::run::system::in_units;
use crate::run::system::of_runs::beyond_laws;
use crate::study::SystemStudy;
use crate::words::{capital, plural};

/// Groups of contacts that a sentence describes.
const MOST_GROUPS: usize = 3;

/// Rows of the largest monodromy matrix that an answer contains.
const MOST_ROWS: usize = 64;

/// What a contact does, as words with their codes.
const PHASES: [(u8, &str); 3] = [(0, "slip"), (1, "stick"), (2, "open")];

/// A count as text: "once", "twice", "3 times".
fn times(count: usize) -> String {
    match count {
        1 => "once".to_owned(),
        2 => "twice".to_owned(),
        count => format!("{count} times"),
    }
}

/// What a contact does in a period, after the noun, singular or plural.
fn behaviour(orbit: &Orbit, contact: usize, count: usize) -> String {
    let s = if count == 1 { "s" } else { "" };
    let reverses = if count == 1 { "reverses" } else { "reverse" };
    let number = |kind: EventKind| {
        let of = |event: &&RecordedEvent| event.contact == contact && event.kind == kind;
        orbit.events.iter().filter(of).count()
    };
    let (sticks, reversals, opens) =
        (number(EventKind::Stick), number(EventKind::Reversal), number(EventKind::Separation));
    let mut parts = Vec::new();
    if sticks > 0 {
        parts.push(format!("stick{s} {} per period", times(sticks)));
    }
    if reversals > 0 {
        parts.push(format!("{reverses} {} per period", times(reversals)));
    }
    if opens > 0 {
        parts.push(format!("open{s} {} per period", times(opens)));
    }
    if let Some((last, before)) = parts.split_last() {
        let before = before.join(", ");
        return if before.is_empty() { last.clone() } else { format!("{before} and {last}") };
    }
    match orbit.signature.throughout(contact) {
        Some(ContactPhase::Stick) => format!("stick{s} throughout"),
        Some(ContactPhase::Open) if count == 1 => "is open throughout".to_owned(),
        Some(ContactPhase::Open) => "are open throughout".to_owned(),
        _ => format!("slide{s} throughout: its slip velocity does not reach 0"),
    }
}

/// What the contacts do, in a sentence.
fn contacts_in_words(study: &SystemStudy, orbit: &Orbit) -> String {
    let contacts = &study.system().contacts;
    let mut groups: Vec<(String, Vec<usize>)> = Vec::new();
    for index in 0..contacts.len() {
        let key = behaviour(orbit, index, 1);
        match groups.iter_mut().find(|(known, _)| *known == key) {
            Some((_, members)) => members.push(index),
            None => groups.push((key, vec![index])),
        }
    }
    if groups.len() > MOST_GROUPS {
        let events = orbit.events.len();
        return format!(
            "Its {} contacts have {events} event{} per period.",
            contacts.len(),
            plural(events)
        );
    }
    let clause = |(_, members): &(String, Vec<usize>)| {
        let names: Vec<&str> = members.iter().map(|index| contacts[*index].name.as_str()).collect();
        let doing = behaviour(orbit, members[0], members.len());
        match names.as_slice() {
            [only] => format!("contact {only} {doing}"),
            [.., _] if members.len() == contacts.len() && members.len() > 2 => {
                format!("all {} contacts {doing}", names.len())
            }
            [before @ .., last] => format!("contacts {} and {last} {doing}", before.join(", ")),
            [] => String::new(),
        }
    };
    let clauses: Vec<String> = groups.iter().map(clause).collect();
    if clauses.is_empty() { String::new() } else { format!("{}.", capital(&clauses.join("; "))) }
}

/// The verdict as the end of a sentence.
fn verdict_in_words(orbit: &Orbit) -> &'static str {
    match orbit.verdict() {
        OrbitVerdict::Stable => "and is stable: small deviations die out",
        OrbitVerdict::Unstable => "and is unstable: small deviations grow",
        OrbitVerdict::Undecided => {
            "and undecided stability: the deciding multiplier has modulus 1 within its error"
        }
    }
}

/// A motion in two sentences.
pub fn sentence(study: &SystemStudy, found: &FoundMotion) -> String {
    let orbit = &found.orbit;
    let period = in_units(study.units(), Quantity::Time, orbit.period);
    let subject = match &found.by {
        FoundBy::Continuation if found.multiple == 1 => "The base response".to_owned(),
        FoundBy::Continuation | FoundBy::Shooting => "The periodic motion".to_owned(),
        FoundBy::Run { start, .. } => format!("The motion that a run {start} reaches"),
        FoundBy::Map => "The limit cycle without dither".to_owned(),
        FoundBy::FreeRun { start } => format!("The limit cycle that a run {start} reaches"),
    };
    let locked = match found.multiple {
        1 => String::new(),
        n => format!(", {n} periods of the dither"),
    };
    let contacts = contacts_in_words(study, orbit);
    let verdict = verdict_in_words(orbit);
    format!("{subject} has period {period}{locked} {verdict}. {contacts}")
}

/// Why the base response was not found where the motion replaces it.
fn instead_in_words(found: &FoundMotion) -> Option<String> {
    let FoundBy::Run { instead: Some(why), .. } = &found.by else { return None };
    let is_known = matches!(why, NoOrbit::Ends { .. } | NoOrbit::NoSliding(_));
    let fact = if is_known { "does not exist" } else { "was not found" };
    Some(format!("The motion replaces the base response, which {fact}: {why}."))
}

/// The events of a contact as words in their order; what it does without events.
fn signature_of(found: &FoundMotion, contact: usize) -> Vec<&'static str> {
    let events = found.orbit.events.iter().filter(|event| event.contact == contact);
    let words: Vec<&'static str> = events.map(|event| event.kind.name()).collect();
    if !words.is_empty() {
        return words;
    }
    match found.samples.contacts.get(contact).and_then(|sampled| sampled.phases.first()) {
        Some(ContactPhase::Stick) => vec!["sticking"],
        Some(ContactPhase::Open) => vec!["open"],
        Some(ContactPhase::Slip(_)) => vec!["slipping"],
        None => Vec::new(),
    }
}

fn put_events(events: &[RecordedEvent]) -> Vec<Json> {
    let event = |event: &RecordedEvent| {
        json!({
            "time": event.time,
            "contact": event.contact,
            "kind": event.kind.name(),
            "slip_sign": event.slip_sign,
            "state": event.state,
        })
    };
    events.iter().map(event).collect()
}

/// The derivative of a period with respect to the state.
fn put_monodromy(fields: &mut Fields, orbit: &Orbit) {
    let size = orbit.state.len();
    match &orbit.monodromy {
        None => {
            fields.unknown("monodromy", "the phase of a limit cycle is free");
        }
        Some(_) if size > MOST_ROWS => {
            let why = format!("a state of {size} numbers, more than {MOST_ROWS}");
            fields.unknown("monodromy", why);
        }
        Some(matrix) => {
            let row = |i: usize| (0..size).map(|j| matrix[(i, j)]).collect::<Vec<f64>>();
            fields.plain("monodromy", (0..size).map(row).collect::<Vec<_>>());
        }
    }
}

/// An estimated error, or why it is unknown.
fn put_error(fields: &mut Fields, name: &str, error: f64) {
    if error.is_finite() {
        fields.plain(name, error);
    } else {
        fields.unknown(name, "a multiplier is too close to 1 for the error to be bounded");
    }
}

/// Starts that a sentence lists.
const FEW_STARTS: usize = 2;

/// What is unknown where no motion was found.
const FACTS: [&str; 13] = [
    "response",
    "periods",
    "free_phase",
    "state",
    "multipliers",
    "monodromy",
    "radius",
    "residual",
    "one_sided",
    "state_error",
    "multiplier_error",
    "events",
    "contacts",
];

/// The numbers with units among them.
const NUMBERS: [(&str, Quantity); 7] = [
    ("period", Quantity::Time),
    ("displacement", Quantity::Displacement),
    ("velocity", Quantity::Velocity),
    ("lowest", Quantity::Displacement),
    ("highest", Quantity::Displacement),
    ("lowest_velocity", Quantity::Velocity),
    ("highest_velocity", Quantity::Velocity),
];

impl PeriodicResponse {
    /// The answer in a few sentences.
    pub fn sentence(&self, study: &SystemStudy) -> String {
        let Some(found) = &self.found else {
            let tried = match self.tried.len() {
                0..=FEW_STARTS => capital(&without_cycle(&self.tried)),
                count => format!("No limit cycle was found by {count} runs"),
            };
            return match &self.sliding {
                Some(Ok(verdict)) => format!("{tried}. Steady sliding is {verdict}."),
                Some(Err(why)) => format!("{tried}. Steady sliding has no verdict: {why}."),
                None => format!("{tried}."),
            };
        };
        sentence(study, found)
    }

    /// Why there is no base response, or from where many runs began that found no limit cycle.
    pub fn notes(&self) -> Vec<String> {
        let tried = || format!("{}.", capital(&without_cycle(&self.tried)));
        match &self.found {
            Some(found) => instead_in_words(found).into_iter().collect(),
            None if self.tried.len() > FEW_STARTS => vec![tried()],
            None => Vec::new(),
        }
    }

    /// Warnings: those of the study, and one-sided multipliers.
    pub fn warnings(&self, study: &SystemStudy) -> Vec<String> {
        let one_sided = self.found.as_ref().filter(|found| found.orbit.is_one_sided).map(|_| {
            "independent events coincide: the multipliers hold for deviations to one side only"
                .to_owned()
        });
        let motions = || self.found.iter().chain(self.cycles.iter().flatten());
        // Without dither steady sliding is judged as well.
        let slides = |contact: usize| match self.sliding {
            Some(_) => study.system().contacts[contact].surface_velocity.mean().abs(),
            None => 0.0,
        };
        let beyond = beyond_laws(study, |contact| {
            let slips = motions().map(|found| found.samples.largest_slip(contact));
            slips.fold(slides(contact), f64::max)
        });
        let shorter = self.found.as_ref().and_then(|found| {
            let part = found.repeats_after?;
            let periods = found.multiple;
            Some(format!("the motion of {periods} dither periods repeats itself after {part}: its period is shorter than the one given"))
        });
        let demand = beyond_actuator(study);
        let own = study.warnings().iter().cloned();
        own.chain(one_sided).chain(shorter).chain(beyond).chain(demand).collect()
    }

    /// As JSON.
    pub fn json(&self, study: &SystemStudy) -> Json {
        let mut fields = Fields::in_units(study.units());
        fields
            .plain("ok", true)
            .plain("sentence", self.sentence(study))
            .plain("state_names", study.system().state_names());
        match &self.found {
            Some(found) => put_found(&mut fields, study, found),
            None => self.put_without(&mut fields),
        }
        if self.sliding.is_some() {
            self.put_cycles(&mut fields, study);
        }
        let tried = self.tried.iter().map(|tried| {
            let mut inner = Fields::in_units(study.units());
            inner.plain("start", tried.start.clone()).plain("outcome", tried.outcome.clone());
            inner
        });
        fields.list("tried", tried);
        match &self.sliding {
            Some(Ok(verdict)) => {
                fields.plain("steady_sliding", *verdict);
            }
            Some(Err(why)) => {
                fields.unknown("steady_sliding", why.clone());
            }
            None => {}
        }
        fields.plain("warnings", self.warnings(study));
        fields.finish()
    }

    /// Every limit cycle without dither, each with all of its facts.
    fn put_cycles(&self, fields: &mut Fields, study: &SystemStudy) {
        let Some(cycles) = &self.cycles else {
            let why = "all limit cycles are known of a single mass with a rigid contact alone";
            fields.unknown("cycles", why);
            return;
        };
        let cycles = cycles.iter().map(|cycle| {
            let mut inner = Fields::in_units(study.units());
            inner.plain("sentence", sentence(study, cycle));
            put_found(&mut inner, study, cycle);
            inner
        });
        fields.list("cycles", cycles);
    }

    fn put_without(&self, fields: &mut Fields) {
        let why = without_cycle(&self.tried);
        fields.plain("protocol", "runs without dither");
        for name in FACTS {
            fields.unknown(name, why.clone());
        }
        for (name, quantity) in NUMBERS {
            fields.known(name, quantity, Err(why.clone()));
        }
        match &self.sliding {
            Some(Ok(verdict)) => fields.plain("verdict", *verdict),
            Some(Err(why)) => fields.unknown("verdict", why.clone()),
            None => fields.unknown("verdict", why),
        };
    }

    /// The motion over one period.
    ///
    /// # Errors
    /// [`Failure::Failed`] if no periodic motion exists.
    pub fn dataset(&self, study: &SystemStudy) -> Result<Dataset, Failure> {
        let why = || Failure::Failed { key: "--save".to_owned(), why: self.sentence(study).into() };
        let found = self.found.as_ref().ok_or_else(why)?;
        Ok(dataset(study, found).fact(self.sentence(study)))
    }
}

fn put_found(fields: &mut Fields, study: &SystemStudy, found: &FoundMotion) {
    let orbit = &found.orbit;
    let response = match &found.by {
        FoundBy::Continuation if found.multiple == 1 => "base",
        FoundBy::Continuation | FoundBy::Shooting => "near",
        FoundBy::Run { .. } => "reached",
        FoundBy::Map | FoundBy::FreeRun { .. } => "limit-cycle",
    };
    fields
        .plain("protocol", "local: Floquet multipliers of the periodic motion")
        .plain("response", response)
        .plain("periods", found.multiple)
        .plain("free_phase", orbit.is_free)
        .number("period", Quantity::Time, orbit.period)
        .plain("state", orbit.state.clone());
    let began = "the run of the motion stopped at its beginning";
    let observed = [
        ("displacement", Quantity::Displacement, &found.samples.observed),
        ("velocity", Quantity::Velocity, &found.samples.rate),
    ];
    for (name, quantity, values) in observed {
        fields.known(name, quantity, values.first().copied().ok_or(began.to_owned()));
    }
    if let FoundBy::Run { start, periods, instead } = &found.by {
        fields.plain("start", start.clone()).plain("periods_to_settle", *periods);
        if let Some(why) = instead {
            fields.plain("no_base_response", why.to_string());
        }
    }
    if let FoundBy::FreeRun { start } = &found.by {
        fields.plain("start", start.clone());
    }
    let multipliers: Vec<Vec<f64>> = orbit.multipliers.iter().map(|z| vec![z.re, z.im]).collect();
    fields
        .plain("multipliers", multipliers)
        .plain("radius", orbit.radius())
        .plain("verdict", orbit.verdict().name())
        .plain("residual", orbit.residual)
        .plain("one_sided", orbit.is_one_sided);
    put_monodromy(fields, orbit);
    put_error(fields, "state_error", orbit.state_error);
    put_error(fields, "multiplier_error", orbit.multiplier_error);
    fields.plain("events", put_events(&orbit.events));
    let samples = &found.samples;
    let contacts = study.system().contacts.iter().zip(samples.means()).enumerate();
    let contacts = contacts.map(|(index, (contact, means))| {
        let mut inner = Fields::in_units(study.units());
        let count = |kind: EventKind| {
            let of = |event: &&RecordedEvent| event.contact == index && event.kind == kind;
            orbit.events.iter().filter(of).count()
        };
        let least = samples.least_slip[index];
        let stuck = || "the contact never slips".to_owned();
        inner
            .plain("name", contact.name.clone())
            .plain("signature", signature_of(found, index))
            .plain("stick_episodes", count(EventKind::Stick))
            .plain("reversals", count(EventKind::Reversal))
            .known(
                "least_slip_velocity",
                Quantity::Velocity,
                Some(least).filter(|least| least.is_finite()).ok_or_else(stuck),
            )
            .number("stick_fraction", Quantity::Ratio, means.stick_fraction)
            .number("open_fraction", Quantity::Ratio, means.open_fraction);
        inner
    });
    fields.list("contacts", contacts);
    let [RealInterval { lower: low, upper: high }, RealInterval { lower: slow, upper: fast }] =
        samples.extremes();
    fields
        .number("lowest", Quantity::Displacement, low)
        .number("highest", Quantity::Displacement, high)
        .number("lowest_velocity", Quantity::Velocity, slow)
        .number("highest_velocity", Quantity::Velocity, fast);
}

/// The samples of a motion: every number of the state, and slip velocity, friction, load and phase of every contact.
fn dataset(study: &SystemStudy, found: &FoundMotion) -> Dataset {
    let samples = &found.samples;
    let system = study.system();
    let unit = |quantity: Option<Quantity>| -> &'static str {
        quantity.and_then(|quantity| study.units().unit(quantity)).unwrap_or("1")
    };
    let time = Array::new("time", unit(Some(Quantity::Time)), samples.times.clone());
    let mut dataset = Dataset::of(&study.into(), "orbit").with_axis(time);
    let names = system.state_names();
    let observed = [
        ("displacement", Quantity::Displacement, &samples.observed),
        ("velocity", Quantity::Velocity, &samples.rate),
    ];
    for (name, quantity, values) in observed {
        if !names.iter().any(|known| known == name) {
            dataset = dataset.with(Array::new(name, unit(Some(quantity)), values.clone()));
        }
    }
    let size = found.orbit.state.len();
    for (place, name) in names.into_iter().enumerate() {
        let values = samples.states.iter().skip(place).step_by(size).copied().collect();
        let name = if name == "time" { "displacement.time".to_owned() } else { name };
        dataset = dataset.with(Array::new(name, unit(system.state_quantity(place)), values));
    }
    let (velocity, force) = (unit(Some(Quantity::Velocity)), unit(Some(Quantity::Force)));
    for (contact, sampled) in system.contacts.iter().zip(&samples.contacts) {
        let name = |what: &str| format!("{}.{what}", contact.name);
        let phases: Vec<u8> = sampled.phases.iter().map(|phase| phase_code(*phase)).collect();
        dataset = dataset
            .with(Array::new(name("slip_velocity"), velocity, sampled.slip_velocity.clone()))
            .with(Array::new(name("friction"), force, sampled.friction.clone()))
            .with(Array::new(name("normal"), force, sampled.normal_load.clone()))
            .with(Array::of_words(name("phase"), PHASES.to_vec(), &phases));
    }
    dataset
}

fn phase_code(phase: ContactPhase) -> u8 {
    match phase {
        ContactPhase::Slip(_) => 0,
        ContactPhase::Stick => 1,
        ContactPhase::Open => 2,
    }
}
