//! `[uncertainty]`: distributions of numbers of the study, and their correlation.
//!
//! A number has a distribution of its own, `"belt.damping_ratio" = { lognormal = [0.05, 0.5] }`; numbers that were estimated together
//! are jointly normal, with `of`, `mean` and `matrix` in `[uncertainty.covariance]`, as `quell fit` prints them; and
//! `[uncertainty.correlation]`, with `of` and `matrix`, correlates numbers with distributions of their own.

use quell_design::probability::{Distribution, JointDistribution};
use quell_input::complaint::{Complaint, Fault, Origin};
use quell_input::document::{Node, Table, Value};
use quell_model::digits::digits;
use quell_model::parameter::Bounds;
use quell_numerics::interval::RealInterval;
use serde_json::Value as Json;

use super::address::NumberAddress;
use super::path;
use super::reader::Reader;
use super::vocabulary::{DISTRIBUTIONS, join};

/// Standard deviations of a normal number at which a study must be valid: values beyond them have a probability of 10⁻⁶ on each
/// side.
const CHECKED: f64 = 4.753_424_308_822_899;

/// Digits of a number in a complaint.
const DIGITS: usize = 6;

/// The tables of numbers with a joint distribution.
const COVARIANCE: &str = "covariance";
const CORRELATION: &str = "correlation";

/// The uncertain numbers of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncertainty {
    numbers: Vec<UncertainNumber>,
    joint: JointDistribution,
}

/// A number with a distribution.
#[derive(Clone, Debug, PartialEq)]
struct UncertainNumber {
    path: String,
    target: NumberAddress,
    origin: Origin,
}

impl Uncertainty {
    /// Paths of the numbers, as they were written.
    pub fn paths(&self) -> impl Iterator<Item = &str> {
        self.numbers.iter().map(|number| number.path.as_str())
    }

    /// Their joint distribution, in the units of their keys.
    pub fn joint(&self) -> &JointDistribution {
        &self.joint
    }

    /// Every number with the values at which the study must be valid: the ends of its distribution, or values that it hardly ever
    /// exceeds.
    pub(super) fn extremes(&self) -> impl Iterator<Item = (&str, Origin, Distribution, [f64; 2])> {
        self.numbers.iter().zip(self.joint.distributions()).map(|(number, distribution)| {
            let RealInterval { lower: low, upper: high } =
                distribution.ends().unwrap_or_else(|| {
                    RealInterval::new(distribution.at(-CHECKED), distribution.at(CHECKED))
                });
            (number.path.as_str(), number.origin, *distribution, [low, high])
        })
    }
}

/// A distribution as a study has it.
pub(super) fn in_words(distribution: Distribution) -> String {
    let (name, first, second) = match distribution {
        Distribution::Normal { mean, deviation } => ("normal", mean, deviation),
        Distribution::Lognormal { median, sigma } => ("lognormal", median, sigma),
        Distribution::Uniform { from, to } => ("uniform", from, to),
    };
    format!("{{ {name} = [{}, {}] }}", digits(first, DIGITS), digits(second, DIGITS))
}

/// What is wrong with an extreme value of a distribution, and what to do; `about` is the complaint about the study with that value.
pub(super) fn beyond(path: &str, value: f64, about: &Complaint) -> String {
    // The value may be wrong together with another number.
    let must = if about.key == path {
        format!("must be {}", about.allowed)
    } else {
        format!("does not fit {}, which must be {}", about.key, about.allowed)
    };
    let value = digits(value, DIGITS);
    format!(
        "a distribution of values that give valid studies: {path} = {value}, which has a probability of at least 10⁻⁶, {must}; a \
         distribution of its own can have positive values alone (lognormal = [median, sigma]) or ends (uniform = [from, to]); in \
         [uncertainty.covariance] leave the number out (`quell fit --fix` keeps it)"
    )
}

/// Reads `[uncertainty]`: `Some(None)` without it, `None` if it is invalid.
#[expect(clippy::option_option, reason = "invalid, absent, given")]
pub(super) fn read(reader: &mut Reader, root: &Table) -> Option<Option<Uncertainty>> {
    let Some(node) = root.get("uncertainty") else { return Some(None) };
    let table = reader.table("uncertainty", node)?.clone();
    let before = reader.complaints_so_far();
    let mut found = Gathering { root, numbers: Vec::new(), distributions: Vec::new() };
    let (mut matrices, mut covariance) = (Vec::new(), None);
    found.entries(reader, "", &table);
    if let Some(node) = table.get(COVARIANCE) {
        covariance = found.covariance(reader, node);
    }
    if let Some(matrix) = covariance {
        matrices.push(matrix);
    }
    if let Some(node) = table.get(CORRELATION) {
        matrices.extend(found.correlation(reader, node));
    }
    if reader.complaints_so_far() > before {
        return None;
    }
    if found.numbers.is_empty() {
        let allowed = "a table with at least one distribution, such as \"belt.damping_ratio\" = { lognormal = [0.05, 0.5] }";
        reader.wrong("uncertainty", node, allowed);
        return None;
    }
    let size = found.numbers.len();
    let mut correlation = vec![vec![0.0; size]; size];
    for (number, row) in correlation.iter_mut().enumerate() {
        row[number] = 1.0;
    }
    for Correlated { places, matrix } in &matrices {
        for (place, row) in places.iter().zip(matrix) {
            for (other, entry) in places.iter().zip(row) {
                correlation[*place][*other] = *entry;
            }
        }
    }
    match JointDistribution::new(found.distributions, &correlation) {
        Ok(joint) => Some(Some(Uncertainty { numbers: found.numbers, joint })),
        Err(why) => {
            reader.wrong(
                "uncertainty",
                node,
                format!("a correlation that parameters can have: {why}"),
            );
            None
        }
    }
}

/// The correlation of some of the numbers.
struct Correlated {
    places: Vec<usize>,
    matrix: Vec<Vec<f64>>,
}

/// The numbers found so far.
struct Gathering<'a> {
    root: &'a Table,
    numbers: Vec<UncertainNumber>,
    distributions: Vec<Distribution>,
}

impl Gathering<'_> {
    /// The entries of a table; a path without quotes is tables inside each other.
    fn entries(&mut self, reader: &mut Reader, prefix: &str, table: &Table) {
        for (name, node) in table.iter() {
            if prefix.is_empty() && [COVARIANCE, CORRELATION].contains(&name) {
                continue;
            }
            let path = join(prefix, name);
            match node.table() {
                Some(inner) if is_table_of_paths(inner) => {
                    self.entries(reader, &path, &inner.clone());
                }
                _ => {
                    let key = format!("uncertainty.\"{path}\"");
                    let unit = self.number(reader, &key, node, &path);
                    let read = distribution(reader, &key, node, unit.unwrap_or_default());
                    if unit.is_some() {
                        self.distributions.extend(read);
                    }
                }
            }
        }
    }

    /// Adds the number that a path names and returns its unit.
    fn number(
        &mut self,
        reader: &mut Reader,
        key: &str,
        node: &Node,
        path: &str,
    ) -> Option<&'static str> {
        let target = match path::resolve(self.root, path) {
            Ok(target) => target,
            Err(lost) => {
                let allowed = "the path of a number in the study, such as \"belt.damping_ratio\"";
                let given = (node.origin, Json::from(path));
                reader.complain(lost.complaint(key, given, (Fault::Value, allowed)));
                return None;
            }
        };
        if let Some(earlier) =
            self.numbers.iter().find(|number| number.target.number == target.number)
        {
            let allowed =
                format!("a number without a distribution; {} already has one", earlier.path);
            reader.complain(Complaint::new(Fault::Conflict, key, node.origin, path, allowed));
            return None;
        }
        let unit = target.measured_in.filter(|unit| *unit != "1").unwrap_or_default();
        self.numbers.push(UncertainNumber { path: path.to_owned(), target, origin: node.origin });
        Some(unit)
    }

    /// `[uncertainty.covariance]`: numbers that are jointly normal.
    fn covariance(&mut self, reader: &mut Reader, node: &Node) -> Option<Correlated> {
        let prefix = "uncertainty.covariance";
        let table = reader.table(prefix, node)?.clone();
        only(reader, prefix, &table, &["of", "mean", "matrix"]);
        let of = paths(reader, prefix, &table, node)?;
        let first = self.numbers.len();
        let known: Vec<Option<&str>> = of
            .iter()
            .map(|(node, path)| self.number(reader, &join(prefix, "of"), node, path))
            .collect();
        let given = needed(reader, prefix, &table, node, "mean")?;
        let mean = row(reader, &join(prefix, "mean"), given)?;
        let matrix = matrix(reader, prefix, &table, node)?;
        if mean.len() != of.len() || matrix.len() != of.len() {
            let allowed =
                format!("as many means and rows of the matrix as paths in of, {}", of.len());
            reader.wrong(prefix, node, allowed);
            return None;
        }
        known.into_iter().collect::<Option<Vec<_>>>()?;
        let mut deviations = Vec::new();
        for (place, row) in matrix.iter().enumerate() {
            let variance = row[place];
            if variance <= 0.0 {
                let allowed = "a matrix with positive variances in its diagonal: a number that is certain is left out of of, mean and matrix";
                reader.wrong(&format!("{prefix}.matrix[{place}][{place}]"), node, allowed);
                return None;
            }
            deviations.push(variance.sqrt());
            self.distributions
                .push(Distribution::Normal { mean: mean[place], deviation: variance.sqrt() });
        }
        let scaled = |(row, of): (&Vec<f64>, &f64)| -> Vec<f64> {
            row.iter().zip(&deviations).map(|(entry, other)| entry / (of * other)).collect()
        };
        let mut correlation: Vec<Vec<f64>> = matrix.iter().zip(&deviations).map(scaled).collect();
        for (place, row) in correlation.iter_mut().enumerate() {
            row[place] = 1.0;
        }
        Some(Correlated { places: (first..first + of.len()).collect(), matrix: correlation })
    }

    /// `[uncertainty.correlation]`: the correlation of numbers with distributions of their own.
    fn correlation(&self, reader: &mut Reader, node: &Node) -> Option<Correlated> {
        let prefix = "uncertainty.correlation";
        let table = reader.table(prefix, node)?.clone();
        only(reader, prefix, &table, &["of", "matrix"]);
        let of = paths(reader, prefix, &table, node)?;
        let matrix = matrix(reader, prefix, &table, node)?;
        if matrix.len() != of.len() {
            let allowed = format!("as many rows of the matrix as paths in of, {}", of.len());
            reader.wrong(prefix, node, allowed);
            return None;
        }
        let mut places: Vec<usize> = Vec::new();
        for (node, path) in &of {
            let place = self.numbers.iter().position(|number| number.path == *path);
            let Some(place) = place.filter(|place| !places.contains(place)) else {
                let allowed = "a path with a distribution in [uncertainty], each once";
                let key = join(prefix, "of");
                let path = path.as_str();
                reader.complain(Complaint::new(Fault::Value, key, node.origin, path, allowed));
                return None;
            };
            places.push(place);
        }
        Some(Correlated { places, matrix })
    }
}

/// Whether a table has paths inside, and not a distribution.
fn is_table_of_paths(table: &Table) -> bool {
    let mut entries = table.iter().peekable();
    entries.peek().is_some() && entries.all(|(_, node)| node.table().is_some())
}

/// A distribution: one kind with two numbers.
fn distribution(
    reader: &mut Reader,
    key: &str,
    node: &Node,
    unit: &'static str,
) -> Option<Distribution> {
    let kinds = DISTRIBUTIONS.map(|(name, numbers)| format!("{{ {name} = {numbers} }}")).join(", ");
    let entries: Vec<(&str, &Node)> =
        node.table().map(|table| table.iter().collect()).unwrap_or_default();
    let [(name, numbers)] = entries[..] else {
        reader.wrong(key, node, format!("one distribution: {kinds}"));
        return None;
    };
    let key = join(key, name);
    let Some((_, meaning)) = DISTRIBUTIONS.iter().find(|(known, _)| *known == name) else {
        let complaint = Complaint::new(Fault::Unknown, key, numbers.origin, numbers.given(), kinds);
        let nearest = quell_input::nearest::word(name, DISTRIBUTIONS.iter().map(|(name, _)| *name));
        reader.complain(complaint.suggesting(nearest));
        return None;
    };
    let Value::List(list) = &numbers.value else {
        reader.wrong(&key, numbers, format!("{meaning}; got {}", numbers.kind()));
        return None;
    };
    let [first, second] = list.as_slice() else {
        reader.wrong(&key, numbers, format!("{meaning}; got {} numbers", list.len()));
        return None;
    };
    let keys = [0, 1].map(|place| format!("{key}[{place}]"));
    let mut number = |place: usize, node: &Node, bounds: Bounds, unit: &'static str| {
        reader.within(&keys[place], node, bounds, unit, false)
    };
    match name {
        "normal" => {
            let (mean, deviation) =
                (number(0, first, Bounds::FINITE, unit), number(1, second, Bounds::POSITIVE, unit));
            Some(Distribution::Normal { mean: mean?, deviation: deviation? })
        }
        "lognormal" => {
            let (median, sigma) =
                (number(0, first, Bounds::POSITIVE, unit), number(1, second, Bounds::POSITIVE, ""));
            Some(Distribution::Lognormal { median: median?, sigma: sigma? })
        }
        _ => {
            let (from, to) =
                (number(0, first, Bounds::FINITE, unit), number(1, second, Bounds::FINITE, unit));
            let (from, to) = (from?, to?);
            if from >= to {
                reader.wrong(&keys[1], second, format!("above the smallest value, {from}"));
                return None;
            }
            Some(Distribution::Uniform { from, to })
        }
    }
}

/// Reports keys other than the known ones.
fn only(reader: &mut Reader, prefix: &str, table: &Table, known: &[&str]) {
    for (name, node) in table.iter().filter(|(name, _)| !known.contains(name)) {
        let complaint = Complaint::new(
            Fault::Unknown,
            join(prefix, name),
            node.origin,
            node.given(),
            known.join(", "),
        );
        reader.complain(
            complaint.suggesting(quell_input::nearest::word(name, known.iter().copied())),
        );
    }
}

/// A key that must be given.
fn needed<'t>(
    reader: &mut Reader,
    prefix: &str,
    table: &'t Table,
    header: &Node,
    name: &str,
) -> Option<&'t Node> {
    let found = table.get(name);
    if found.is_none() {
        let allowed = "an array, with an entry for each path in of";
        let key = join(prefix, name);
        reader.complain(Complaint::new(Fault::Missing, key, header.origin, Json::Null, allowed));
    }
    found
}

/// The paths in `of`.
fn paths(
    reader: &mut Reader,
    prefix: &str,
    table: &Table,
    header: &Node,
) -> Option<Vec<(Node, String)>> {
    let node = needed(reader, prefix, table, header, "of")?;
    let key = join(prefix, "of");
    match &node.value {
        Value::List(list) if !list.is_empty() => {
            list.iter().map(|node| Some((node.clone(), reader.text(&key, node)?))).collect()
        }
        _ => {
            reader.wrong(&key, node, format!("an array of paths; got {}", node.kind()));
            None
        }
    }
}

/// An array of numbers in the units of their keys.
fn row(reader: &mut Reader, key: &str, node: &Node) -> Option<Vec<f64>> {
    let Value::List(list) = &node.value else {
        reader.wrong(key, node, format!("an array of numbers; got {}", node.kind()));
        return None;
    };
    let entries = list.iter().enumerate();
    entries
        .map(|(place, node)| {
            reader.within(&format!("{key}[{place}]"), node, Bounds::FINITE, "", false)
        })
        .collect()
}

/// A square matrix by rows.
fn matrix(
    reader: &mut Reader,
    prefix: &str,
    table: &Table,
    header: &Node,
) -> Option<Vec<Vec<f64>>> {
    let node = needed(reader, prefix, table, header, "matrix")?;
    let key = join(prefix, "matrix");
    let Value::List(list) = &node.value else {
        reader.wrong(&key, node, format!("an array of rows; got {}", node.kind()));
        return None;
    };
    let rows: Vec<Vec<f64>> = list
        .iter()
        .enumerate()
        .map(|(place, node)| row(reader, &format!("{key}[{place}]"), node))
        .collect::<Option<_>>()?;
    if rows.iter().any(|row| row.len() != rows.len()) {
        reader.wrong(&key, node, "a square matrix: rows with as many numbers as there are rows");
        return None;
    }
    Some(rows)
}
