//! The document of a study: the values of its text, each with its line.
//!
//! Only the TOML syntax is checked here. `--set` changes the document before
//! it is checked.

use std::sync::Arc;

use serde_json::Value as Json;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::complaint::{Complaint, Complaints, Fault, Origin};

/// A value with its origin.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// The value.
    pub value: Value,
    /// Where it was written.
    pub origin: Origin,
}

/// A value of the text.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number, integer or not, possibly NaN or infinite.
    Number(f64),
    /// A string.
    Text(String),
    /// `true` or `false`.
    Flag(bool),
    /// A date or time, which no key of a study takes.
    Date(String),
    /// An array, of tables too.
    List(Vec<Node>),
    /// A table.
    Table(Table),
}

/// A table: keys in the order of the text. Copies share their entries until one of them is changed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    entries: Arc<Vec<(Arc<str>, Node)>>,
}

impl Table {
    /// Reads TOML.
    ///
    /// # Errors
    /// Every syntax error with its line.
    pub fn parse(text: &str) -> Result<Self, Complaints> {
        let lines = Lines::of(text);
        let (table, errors) = DeTable::parse_recoverable(text);
        if errors.is_empty() {
            return Ok(Self::from_toml(table.get_ref(), &lines));
        }
        let mut complaints: Vec<Complaint> = errors
            .iter()
            .map(|error| {
                let start = error.span().map_or(0, |span| span.start);
                let line = lines.at(start);
                let written = text.lines().nth(line - 1).unwrap_or_default().trim();
                let written: String = written.chars().take(80).collect();
                let message = error.message().trim().replace('\n', ", ");
                Complaint::new(Fault::Syntax, "study", Origin::Line(line), written, message)
            })
            .collect();
        complaints.sort_by_key(|complaint| complaint.origin.line());
        // Later errors in a line are mostly consequences of the first.
        complaints.dedup_by_key(|complaint| complaint.origin);
        Err(complaints.into())
    }

    fn from_toml(table: &DeTable<'_>, lines: &Lines) -> Self {
        let mut entries: Vec<(usize, Arc<str>, Node)> = table
            .iter()
            .map(|(key, value)| {
                let start = key.span().start;
                let mut node = Node::from_toml(value, lines);
                node.origin = Origin::Line(lines.at(start));
                (start, key.get_ref().as_ref().into(), node)
            })
            .collect();
        entries.sort_by_key(|(start, _, _)| *start);
        let entries: Vec<(Arc<str>, Node)> =
            entries.into_iter().map(|(_, key, node)| (key, node)).collect();
        Self { entries: entries.into() }
    }

    /// The value of a key.
    pub fn get(&self, key: &str) -> Option<&Node> {
        self.entries.iter().find(|(name, _)| &**name == key).map(|(_, node)| node)
    }

    /// The value of a key, mutable.
    pub fn get_mut(&mut self, key: &str) -> Option<&mut Node> {
        let place = self.entries.iter().position(|(name, _)| &**name == key)?;
        Some(&mut Arc::make_mut(&mut self.entries)[place].1)
    }

    /// Sets a key; an existing key keeps its position.
    pub fn set(&mut self, key: &str, node: Node) {
        match self.get_mut(key) {
            Some(old) => *old = node,
            None => Arc::make_mut(&mut self.entries).push((key.into(), node)),
        }
    }

    /// Removes a key.
    pub fn remove(&mut self, key: &str) {
        if self.has(key) {
            Arc::make_mut(&mut self.entries).retain(|(name, _)| &**name != key);
        }
    }

    /// Keys and values in the order of the text.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Node)> {
        self.entries.iter().map(|(key, node)| (&**key, node))
    }

    /// Keys and mutable values in the order of the text.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = (&str, &mut Node)> {
        Arc::make_mut(&mut self.entries).iter_mut().map(|(key, node)| (&**key, node))
    }

    /// Keys and values as JSON, tables within it included.
    pub fn json(&self) -> Json {
        Json::Object(self.iter().map(|(name, node)| (name.to_owned(), node.json())).collect())
    }

    /// Complains of each text and key with a control character: terminals obey them, and no XML may contain them. Texts may have
    /// tabs and line breaks. `path` is that of the table, empty or with a dot at its end.
    pub fn unprintable(&self, path: &str, complaints: &mut Vec<Complaint>) {
        for (key, node) in self.iter() {
            let path = format!("{path}{key}");
            if key.contains(is_unprintable) || key.contains(['\n', '\r', '\t']) {
                let allowed = "a key without control characters";
                complaints.push(Complaint::new(Fault::Value, &path, node.origin, key, allowed));
            }
            node.unprintable(&path, complaints);
        }
    }

    /// Whether both share their entries, because one is a copy of the other and neither was changed.
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.entries, &other.entries)
    }

    /// Whether a key exists.
    pub fn has(&self, key: &str) -> bool {
        self.get(key).is_some()
    }
}

/// Whether a character is for control, or no character of XML.
fn is_unprintable(c: char) -> bool {
    (c.is_control() && !['\n', '\r', '\t'].contains(&c)) || ['\u{fffe}', '\u{ffff}'].contains(&c)
}

impl Node {
    fn unprintable(&self, path: &str, complaints: &mut Vec<Complaint>) {
        match &self.value {
            Value::Text(text) if text.contains(is_unprintable) => {
                let shown: String = text.chars().take(80).collect();
                let allowed = "text without control characters";
                complaints.push(Complaint::new(Fault::Value, path, self.origin, shown, allowed));
            }
            Value::Table(table) => table.unprintable(&format!("{path}."), complaints),
            Value::List(list) => {
                for (index, node) in list.iter().enumerate() {
                    node.unprintable(&format!("{path}[{index}]"), complaints);
                }
            }
            Value::Text(_) | Value::Number(_) | Value::Flag(_) | Value::Date(_) => {}
        }
    }

    fn from_toml(value: &Spanned<DeValue<'_>>, lines: &Lines) -> Self {
        let origin = Origin::Line(lines.at(value.span().start));
        let value = match value.get_ref() {
            DeValue::String(text) => Value::Text(text.clone().into_owned()),
            DeValue::Integer(integer) => {
                Value::Number(integer_value(integer.as_str(), integer.radix()))
            }
            // A TOML float is a Rust float once the parser has removed the underscores; one
            // too large for f64 becomes infinite and is rejected by the bounds.
            DeValue::Float(float) => Value::Number(float.as_str().parse().unwrap_or(f64::NAN)),
            DeValue::Boolean(flag) => Value::Flag(*flag),
            DeValue::Datetime(date) => Value::Date(date.to_string()),
            DeValue::Array(list) => {
                Value::List(list.iter().map(|entry| Self::from_toml(entry, lines)).collect())
            }
            DeValue::Table(table) => Value::Table(Table::from_toml(table, lines)),
        };
        Self { value, origin }
    }

    /// From the right-hand side of `--set key=value`: a TOML value where it is one, otherwise
    /// the bare text.
    pub fn from_argument(text: &str, option: &'static str) -> Self {
        let parsed = DeValue::parse(text.trim()).map(|value| {
            let lines = Lines::of(text);
            Self::from_toml(&value, &lines).value
        });
        let value = match parsed {
            Ok(value @ (Value::Number(_) | Value::Flag(_) | Value::List(_) | Value::Text(_))) => {
                value
            }
            _ => Value::Text(text.trim().to_owned()),
        };
        let origin = Origin::Argument(option);
        // `[5kN, 6kN]` is no TOML: each element is an argument of its own.
        if let Value::Text(text) = &value
            && let Some(inner) = text.strip_prefix('[').and_then(|text| text.strip_suffix(']'))
        {
            let elements = inner.split(',').map(|text| Self::from_argument(text, option));
            return Self { value: Value::List(elements.collect()), origin };
        }
        Self { value, origin }
    }

    /// The value as shown in an error.
    pub fn given(&self) -> Json {
        match &self.value {
            Value::Number(number) => given_number(*number),
            Value::Text(text) | Value::Date(text) => text.clone().into(),
            Value::Flag(flag) => (*flag).into(),
            Value::List(list) => list.iter().map(Self::given).collect::<Vec<_>>().into(),
            Value::Table(_) => "a table".into(),
        }
    }

    /// The whole value as JSON.
    fn json(&self) -> Json {
        match &self.value {
            Value::List(list) => list.iter().map(Self::json).collect::<Vec<_>>().into(),
            Value::Table(table) => table.json(),
            _ => self.given(),
        }
    }

    /// Adds every value below this node with its path; numbers have enough digits to read back
    /// as the same number.
    pub fn leaves(&self, path: &str, leaves: &mut Vec<(String, String)>) {
        match &self.value {
            Value::Number(number) => leaves.push((path.to_owned(), format!("{number:?}"))),
            Value::Table(table) => {
                for (name, node) in table.iter() {
                    node.leaves(&format!("{path}.{name}"), leaves);
                }
            }
            Value::List(list) => {
                for (index, node) in list.iter().enumerate() {
                    node.leaves(&format!("{path}[{index}]"), leaves);
                }
            }
            _ => leaves.push((path.to_owned(), self.given().to_string())),
        }
    }

    /// The entries of a list; a single value is a list of one.
    pub fn entries(&self) -> &[Self] {
        match &self.value {
            Value::List(list) => list,
            _ => std::slice::from_ref(self),
        }
    }

    /// The table, if it is one.
    pub fn table(&self) -> Option<&Table> {
        match &self.value {
            Value::Table(table) => Some(table),
            _ => None,
        }
    }

    /// The table, mutable, if it is one.
    pub fn table_mut(&mut self) -> Option<&mut Table> {
        match &mut self.value {
            Value::Table(table) => Some(table),
            _ => None,
        }
    }

    /// What kind of value it is, with its article.
    pub fn kind(&self) -> &'static str {
        match &self.value {
            Value::Number(_) => "a number",
            Value::Text(_) => "a string",
            Value::Flag(_) => "true or false",
            Value::Date(_) => "a date",
            Value::List(_) => "an array",
            Value::Table(_) => "a table",
        }
    }
}

/// A number in JSON; NaN and infinities, which JSON does not have, as strings.
pub fn given_number(number: f64) -> Json {
    if !number.is_finite() {
        return number.to_string().into();
    }
    // 2^53: integers up to here are written without a decimal point, as people write them.
    if number.fract() == 0.0 && number.abs() < 9_007_199_254_740_992.0 {
        #[expect(clippy::cast_possible_truncation, reason = "whole and below 2^53")]
        return (number as i64).into();
    }
    number.into()
}

fn integer_value(digits: &str, radix: u32) -> f64 {
    if radix == 10 {
        return digits.parse().unwrap_or(f64::NAN);
    }
    #[expect(clippy::cast_precision_loss, reason = "a study's numbers are f64")]
    i128::from_str_radix(digits, radix).map_or(f64::NAN, |integer| integer as f64)
}

/// Starts of lines, to convert byte offsets to line numbers.
struct Lines {
    starts: Vec<usize>,
}

impl Lines {
    fn of(text: &str) -> Self {
        let breaks = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        Self { starts: std::iter::once(0).chain(breaks.map(|(index, _)| index + 1)).collect() }
    }

    fn at(&self, offset: usize) -> usize {
        self.starts.partition_point(|&start| start <= offset).max(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_keep_their_lines_and_order() {
        let table = Table::parse("b = 1_000\na = 0x10\n\n[t]\nc = 'x'\n[[l]]\nd = nan\n[[l]]\n")
            .expect("TOML");
        let keys: Vec<_> = table.iter().map(|(key, node)| (key, node.origin)).collect();
        assert_eq!(keys[0], ("b", Origin::Line(1)));
        assert_eq!(keys[1], ("a", Origin::Line(2)));
        assert_eq!(keys[2], ("t", Origin::Line(4)));
        assert_eq!(table.get("b").map(|node| &node.value), Some(&Value::Number(1000.0)));
        assert_eq!(table.get("a").map(|node| &node.value), Some(&Value::Number(16.0)));
        let inner = table.get("t").and_then(Node::table).expect("table");
        assert_eq!(inner.get("c").map(|node| node.origin), Some(Origin::Line(5)));
        let Some(Value::List(list)) = table.get("l").map(|node| &node.value) else {
            panic!("a list of tables");
        };
        assert_eq!(
            list.iter().map(|node| node.origin).collect::<Vec<_>>(),
            [6, 8].map(Origin::Line)
        );
    }

    #[test]
    fn every_syntax_error_is_reported() {
        let complaints = Table::parse("a = \nb = 1\nc = [1,\nd d = 2\n").expect_err("broken");
        assert!(complaints.len() >= 2, "{complaints:?}");
        assert_eq!(complaints[0].origin, Origin::Line(1));
    }

    #[test]
    fn arguments_are_toml_values_or_bare_words() {
        let value = |text| Node::from_argument(text, "--set").value;
        assert_eq!(value("0.4"), Value::Number(0.4));
        assert_eq!(value("4"), Value::Number(4.0));
        assert_eq!(value("square"), Value::Text("square".into()));
        assert_eq!(value("\"square\""), Value::Text("square".into()));
        assert!(matches!(value("nan"), Value::Number(number) if number.is_nan()));
        assert_eq!(value(""), Value::Text(String::new()));
        let Value::List(list) = value("[5kN, 6e3]") else { panic!("a list") };
        let values: Vec<Value> = list.into_iter().map(|node| node.value).collect();
        assert_eq!(values, [Value::Text("5kN".into()), Value::Number(6e3)]);
    }
}
