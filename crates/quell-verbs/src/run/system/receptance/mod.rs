//! `receptance`: displacement over force between rows of a system, over frequency, as a modal test measures it.
//!
//! The contacts slide, with friction carried along and averaged over a dither, as in `stability`; or they are springs without friction, as
//! in `modes`; or they are left out, as in a test of the structure alone and in the file of a study with `frequency_response`.

mod answer;

pub use answer::unit;

use num_complex::Complex64;
use quell_input::nearest;
use quell_linear::growth::Verdict;
use quell_linear::linearised::{FrictionSlopes, Linearised};
use quell_linear::receptance::ReceptanceEquations;
use quell_linear::spectrum;
use quell_model::System;
use quell_numerics::interval::RealInterval;
use quell_numerics::order::ascending_by;
use quell_numerics::polar::modulus;

use super::{checked_frequencies, failed, has_equations};
use crate::complaint::{Complaint, Failure};
use crate::parallel::Parallel;
use crate::run::stability::SlidingEquations;
use crate::study::SystemStudy;

/// Name of the verb.
const VERB: &str = "receptance";

/// Frequencies at equal distances, where the request does not say how many: enough for a smooth picture between the resonances, which have
/// their own.
const EVEN: usize = 401;

/// Distances from a resonance in half its widths at which its peak is resolved, on either side. Between neighbours the phase of one resonance
/// turns by at most 15° and its size changes by at most a factor of 1.7: closer than a picture shows and the criterion of Nyquist needs. Chosen
/// here; it changes which frequencies are listed, and no value.
const AROUND: [f64; 11] = [0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 8.0, 13.0];

/// Distances from an undamped resonance, in its frequency: it has no width, and no value at 0. Chosen here likewise.
const AROUND_UNDAMPED: [f64; 4] = [1e-4, 3e-4, 1e-3, 3e-3];

/// The default range ends at this multiple of the highest frequency of a motion, so that its resonance is seen whole. Chosen here likewise.
const BEYOND: f64 = 1.25;

/// Most names of outputs or of inputs.
pub const MOST_NAMES: usize = 200;

/// Most values of all receptances.
const MOST_VALUES: usize = 5_000_000;

/// What the contacts are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ContactsAre {
    /// They slide, with friction carried along.
    #[default]
    Sliding,
    /// Springs and dampers without friction.
    Springs,
    /// Left out.
    Absent,
}

impl ContactsAre {
    /// Each with its name.
    pub const NAMES: [(&'static str, Self); 3] =
        [("sliding", Self::Sliding), ("springs", Self::Springs), ("none", Self::Absent)];

    /// That of a name.
    ///
    /// # Errors
    /// A complaint about another name.
    pub fn from_name(name: &str) -> Result<Self, Failure> {
        let known = Self::NAMES.iter().find(|(known, _)| *known == name);
        let wrong = || {
            let names: Vec<&str> = Self::NAMES.iter().map(|(name, _)| *name).collect();
            Complaint::option("--contacts", name, format!("one of {}", names.join(", "))).into()
        };
        known.map(|(_, contacts)| *contacts).ok_or_else(wrong)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, known)| *known == self).map_or("", |(name, _)| name)
    }
}

/// Options of `receptance`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReceptanceRequest {
    /// Names of rows whose displacements are asked; none for those of the contacts.
    pub outputs: Vec<String>,
    /// Names of rows along which forces act; none for those of the contacts.
    pub inputs: Vec<String>,
    /// What the contacts are.
    pub contacts: ContactsAre,
    /// Range of angular frequencies; `None` for all motions of the structure.
    pub frequency: Option<RealInterval>,
    /// Number of frequencies at equal distances; `None` for some hundred, and more around each resonance.
    pub points: Option<usize>,
    /// Angular frequencies that are asked alone; none for those of the range.
    pub at: Vec<f64>,
}

/// The receptance of one pair of rows.
#[derive(Clone, Debug, PartialEq)]
pub struct PairReceptance {
    /// Place of the output among [`Receptances::outputs`].
    pub output: usize,
    /// Place of the input among [`Receptances::inputs`].
    pub input: usize,
    /// Displacement over force at each frequency; `None` where it is unbounded.
    pub values: Vec<Option<Complex64>>,
}

impl PairReceptance {
    /// Place and magnitude of the largest value.
    pub fn largest(&self) -> Option<(usize, f64)> {
        let known = self.values.iter().enumerate();
        let sizes = known.filter_map(|(place, value)| Some((place, modulus((*value)?))));
        sizes.max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// Receptances over frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct Receptances {
    /// What the contacts are.
    pub contacts: ContactsAre,
    /// Names of the rows whose displacements are given.
    pub outputs: Vec<String>,
    /// Names of the rows along which forces act.
    pub inputs: Vec<String>,
    /// Angular frequencies, ascending.
    pub frequencies: Vec<f64>,
    /// Every pair, inputs fastest.
    pub pairs: Vec<PairReceptance>,
    /// Whether small motions decay, so that the response to a force exists.
    pub verdict: Verdict,
    /// Warnings about the answer.
    pub warnings: Vec<String>,
}

/// The receptances of a study.
///
/// # Errors
/// Complaints about names, range and number of points; [`Failure::Failed`] without steady sliding, or where a matrix overflows.
pub fn run(study: &SystemStudy, request: &ReceptanceRequest) -> Result<Receptances, Failure> {
    has_equations(study, VERB)?;
    let outputs = rows(study, "--outputs", &request.outputs)?;
    let inputs = rows(study, "--inputs", &request.inputs)?;
    let range = request.frequency.map(|range| checked_frequencies(range, true)).transpose()?;
    check_listed(request)?;
    let SlidingEquations { linear, friction, verdict, warnings: own } =
        equations(study, request.contacts)?;
    let row = |named: &[(String, Vec<f64>)]| named.iter().map(|(_, row)| row.clone()).collect();
    let into: Vec<Vec<f64>> = row(&inputs);
    let equations = ReceptanceEquations::new(&linear, &friction, row(&outputs), &into)
        .map_err(|why| failed(VERB, why))?
        .ok_or_else(|| failed(VERB, "the mass is singular"))?;
    let frequencies = if request.at.is_empty() {
        frequencies(&equations, range, request.points)?
    } else {
        request.at.clone()
    };
    let (rows, columns) = (outputs.len(), inputs.len());
    if rows * columns * frequencies.len() > MOST_VALUES {
        let allowed = format!(
            "names of fewer rows, or fewer --points: {rows} outputs, {columns} inputs and {} frequencies are more than {MOST_VALUES} values",
            frequencies.len()
        );
        let listed = outputs.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(",");
        return Err(Complaint::option("--outputs", listed, allowed).into());
    }
    let found: Vec<Option<Vec<Vec<Complex64>>>> =
        frequencies.in_parallel(|frequency| equations.at(*frequency)).collect();
    let pairs = (0..rows * columns).map(|index| {
        let (output, input) = (index / columns, index % columns);
        let value = |at: &Option<Vec<Vec<Complex64>>>| Some(at.as_ref()?[output][input]);
        PairReceptance { output, input, values: found.iter().map(value).collect() }
    });
    let name = |named: Vec<(String, Vec<f64>)>| named.into_iter().map(|(name, _)| name).collect();
    let mut warnings = study.warnings().to_vec();
    warnings.extend(own);
    if verdict == Verdict::Unstable {
        let what = match request.contacts {
            ContactsAre::Sliding => "steady sliding",
            ContactsAre::Springs | ContactsAre::Absent => "the structure",
        };
        warnings.push(format!(
            "{what} is unstable: its small motions grow, and no measurement shows these responses"
        ));
    }
    Ok(Receptances {
        contacts: request.contacts,
        outputs: name(outputs),
        inputs: name(inputs),
        pairs: pairs.collect(),
        frequencies,
        verdict,
        warnings,
    })
}

/// The linear equations with the friction of every contact.
fn equations(study: &SystemStudy, contacts: ContactsAre) -> Result<SlidingEquations, Failure> {
    let system = study.system();
    let of = |system: &System| {
        let linear = Linearised::frictionless(system).map_err(|why| failed(VERB, why))?;
        let none = FrictionSlopes { force: 0.0, by_velocity: 0.0, by_load: 0.0, bristles: None };
        let friction = vec![none; system.contacts.len()];
        let growth = spectrum::growth(&linear, &friction).map_err(|why| failed(VERB, why))?;
        let verdict = growth.verdict();
        Ok(SlidingEquations { linear, friction, verdict, warnings: Vec::new() })
    };
    match contacts {
        ContactsAre::Sliding => SlidingEquations::new(study, VERB),
        ContactsAre::Springs => of(system),
        ContactsAre::Absent => {
            let structure = system.structure.clone();
            of(&System { structure, contacts: Vec::new(), inputs: Vec::new() })
        }
    }
}

/// The rows of some names, or those of the contacts.
fn rows(
    study: &SystemStudy,
    option: &'static str,
    names: &[String],
) -> Result<Vec<(String, Vec<f64>)>, Failure> {
    let known = study.row_names();
    let own: Vec<String>;
    let names = if names.is_empty() {
        own = study.contact_row_names().collect();
        &own
    } else {
        names
    };
    let listed = || {
        let more = if known.len() > 12 { ", …" } else { "" };
        known.iter().take(12).cloned().collect::<Vec<_>>().join(", ") + more
    };
    if names.is_empty() {
        let allowed = format!("given, as no contact has a row: {}", listed());
        return Err(Complaint::option(option, "", allowed).into());
    }
    if names.len() > MOST_NAMES {
        let allowed = format!("at most {MOST_NAMES} names; these are {}", names.len());
        let first = names[0].trim();
        return Err(Complaint::option(option, format!("{first},…"), allowed).into());
    }
    let mut found: Vec<(String, Vec<f64>)> = Vec::new();
    for name in names {
        let name = name.trim();
        if found.iter().any(|(other, _)| other == name) {
            let allowed = "names that differ from each other";
            return Err(Complaint::option(option, names.join(","), allowed).into());
        }
        let Some(row) = study.row_named(name) else {
            let nearest = nearest::word(name, known.iter().map(String::as_str));
            return Err(Complaint::option(option, name, listed()).suggesting(nearest).into());
        };
        found.push((name.to_owned(), row));
    }
    Ok(found)
}

/// Rejects listed frequencies that do not ascend, and a range next to them.
fn check_listed(request: &ReceptanceRequest) -> Result<(), Failure> {
    let listed = &request.at;
    let ascends = listed.windows(2).all(|pair| pair[0] < pair[1]);
    let is_right = ascends && listed.iter().all(|at| *at >= 0.0 && at.is_finite());
    if !is_right {
        let allowed = "frequencies from 0 on, each above the one before";
        let shown: Vec<String> = listed.iter().map(f64::to_string).collect();
        return Err(Complaint::option("--at", shown.join(","), allowed).into());
    }
    let allowed = "left out: --at gives the frequencies";
    let range = request.frequency.map(|RealInterval { lower, upper }| format!("{lower}:{upper}"));
    let others = [("--frequency", range), ("--points", request.points.map(|n| n.to_string()))];
    let given = others.into_iter().find_map(|(option, text)| Some((option, text?)));
    match given.filter(|_| !listed.is_empty()) {
        Some((option, text)) => Err(Complaint::option(option, text, allowed).into()),
        None => Ok(()),
    }
}

/// The frequencies at which receptances are computed.
fn frequencies(
    equations: &ReceptanceEquations,
    range: Option<RealInterval>,
    points: Option<usize>,
) -> Result<Vec<f64>, Failure> {
    let upper = || equations.poles().iter().filter(|pole| pole.im > 0.0);
    let own = || {
        let highest = upper().map(|pole| pole.im).fold(0.0, f64::max);
        let fastest = equations.poles().iter().map(|pole| modulus(*pole)).fold(0.0, f64::max);
        let to = if highest > 0.0 { highest } else { fastest };
        RealInterval::new(0.0, if to > 0.0 { BEYOND * to } else { 1.0 })
    };
    let RealInterval { lower: from, upper: to } = range.unwrap_or_else(own);
    let count = points.unwrap_or(EVEN);
    if !(2..=MOST_VALUES).contains(&count) {
        let allowed = format!("a whole number from 2 to {MOST_VALUES}");
        return Err(Complaint::option("--points", count, allowed).into());
    }
    let at = |k: usize| (to - from).mul_add(k as f64 / (count - 1) as f64, from).min(to);
    let mut found: Vec<f64> = (0..count).map(at).collect();
    if points.is_some() {
        return Ok(found);
    }
    // Without rigid motions it begins with the static value.
    if range.is_none() && equations.at(0.0).is_none() {
        found.remove(0);
    }
    for pole in upper() {
        let width = pole.re.abs();
        let undamped = width <= equations.rounding();
        let (distances, unit) =
            if undamped { (&AROUND_UNDAMPED[..], pole.im) } else { (&AROUND[..], width) };
        let both = distances.iter().flat_map(|distance| [-distance, *distance]);
        found.extend(both.map(|distance| distance.mul_add(unit, pole.im)));
    }
    found.retain(|frequency| (from..=to).contains(frequency));
    ascending_by(&mut found, |frequency| *frequency);
    found.dedup();
    Ok(found)
}
