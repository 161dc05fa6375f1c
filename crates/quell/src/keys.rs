//! The keys of a study file in words, made from the table of keys: what `quell schema` prints and the book shows.

use std::fmt::Write as _;

use crate::nearest;
use crate::study::vocabulary::{
    DocumentKind, Key, KeyScope, Role, RowUnit, Section, WaveKey, join, keys,
};
use quell_model::parameter::{Bounds, Parameter, SCALES};
use quell_model::units::UnitSystem;

/// Width at which descriptions are broken.
const WIDTH: usize = 128;

/// The table at a path, such as `contact` or `belt.initial`, and those inside it, with their keys; all tables without a path.
///
/// # Errors
/// The nearest path of a table, if no table has this one.
pub fn listing(path: Option<&str>) -> Result<String, Option<String>> {
    let asked = path.map(|path| path.trim().trim_matches(['[', ']']));
    let paths = |section: Section| places(section).into_iter().map(|(path, _)| path);
    let is_asked = |section: Section| {
        let below = |path: String| {
            asked.is_none_or(|asked| path == asked || path.starts_with(&format!("{asked}.")))
        };
        paths(section).any(below)
    };
    let mut sections: Vec<Section> =
        Section::ALL.iter().copied().filter(|section| is_asked(*section)).collect();
    // A table that was asked for comes before those inside it.
    sections.sort_by_key(|section| {
        asked.is_some() && !paths(*section).any(|path| asked == Some(path.as_str()))
    });
    let tables: Vec<String> = sections.into_iter().map(table).collect();
    if tables.is_empty() {
        let all: Vec<String> = Section::ALL.iter().flat_map(|section| paths(*section)).collect();
        // The last word of a path is asked for more often than another path that is as long.
        let asked = asked.unwrap_or_default();
        let last = |path: &&String| path.rsplit('.').next() == Some(asked);
        let named = all.iter().find(last).cloned();
        return Err(named.or_else(|| nearest::word(asked, all.iter().map(String::as_str))));
    }
    Ok(tables.join("\n"))
}

/// The places of a table: its paths, and whether there may be several of it.
fn places(section: Section) -> Vec<(String, bool)> {
    if section == Section::Root {
        return vec![(String::new(), false)];
    }
    let holders = keys().iter().filter(|key| key.role.inner() == Some(section));
    holders
        .flat_map(|key| {
            let several = !matches!(key.role, Role::Table(_));
            places(key.section).into_iter().map(move |(path, _)| (join(&path, key.name), several))
        })
        .collect()
}

/// A table: where it is, what it is, and its keys.
fn table(section: Section) -> String {
    let heading = |(path, several): (String, bool)| match several {
        _ if path.is_empty() => "Outside any table".to_owned(),
        true => format!("[[{path}]]"),
        false => format!("[{path}]"),
    };
    let headings: Vec<String> = places(section).into_iter().map(heading).collect();
    let mut text = format!("{}: {}\n", headings.join(", "), section.about());
    let listed = rows(section).into_iter().map(|row| (row.key.name, row.takes, row.what()));
    let rows: Vec<(&str, &str, String)> = section.chosen_keys().into_iter().chain(listed).collect();
    let width = |of: fn(&(&str, &str, String)) -> usize| rows.iter().map(of).max();
    let names = width(|(name, ..)| name.chars().count()).unwrap_or_default();
    let takes = width(|(_, takes, _)| takes.chars().count()).unwrap_or_default();
    let before = names + takes + 6;
    for (name, kind, what) in &rows {
        let lines = broken(what, WIDTH - before);
        let mut lines = lines.iter();
        let first = lines.next().map_or("", String::as_str);
        let _ = writeln!(text, "  {name:names$}  {kind:takes$}  {first}");
        for line in lines {
            let _ = writeln!(text, "{:before$}{line}", "");
        }
    }
    text
}

/// A key with the others that give the same numbers in another unit.
struct ListedKey {
    key: &'static Key,
    takes: &'static str,
    others: Vec<&'static str>,
}

fn rows(section: Section) -> Vec<ListedKey> {
    let mut rows: Vec<ListedKey> = Vec::new();
    for key in keys().iter().filter(|key| key.section == section) {
        match rows.iter_mut().find(|row| is_in_another_unit(key, row.key)) {
            Some(row) => row.others.push(key.name),
            None => rows.push(ListedKey { key, takes: takes(key.role), others: Vec::new() }),
        }
    }
    rows
}

/// Whether a key gives the numbers of another one with their unit in its name, or bare where those are ratios.
fn is_in_another_unit(key: &Key, other: &Key) -> bool {
    let longer = || key.name.strip_prefix(other.name).is_some_and(|rest| rest.starts_with('_'));
    match (key.role, other.role) {
        (Role::Twin(one, _), Role::Number(other)) => one.path == other.path,
        (
            Role::Matrix(RowUnit { si: true, .. })
            | Role::Row(RowUnit { si: true, .. })
            | Role::Band { hertz: true }
            | Role::Speeds { si: true },
            _,
        ) => longer(),
        (Role::Course(course), _) => course.si() == Some(true) && longer(),
        _ => false,
    }
}

/// The kind of value, in a word.
fn takes(role: Role) -> &'static str {
    match role {
        Role::Number(_)
        | Role::Twin(..)
        | Role::Size(..)
        | Role::FrictionForce(..)
        | Role::AxisNumber
        | Role::Constant
        | Role::Schema => "number",
        Role::Terms
        | Role::AxisPoints
        | Role::Wave(WaveKey::On | WaveKey::Off | WaveKey::Lines | WaveKey::Seed) => "integer",
        Role::Choice(_) | Role::Wave(WaveKey::Hold | WaveKey::Carrier) => "word",
        Role::Choices(_) => "words",
        Role::Text | Role::Wave(WaveKey::File) => "text",
        Role::Flag => "true, false",
        Role::Reference => "number, word",
        Role::Coefficient => "number, formula, list",
        Role::Names => "names",
        Role::Paths => "paths",
        Role::Matrix(_) => "matrix",
        Role::Row(_) => "row",
        Role::Ranges | Role::Table(_) => "table",
        Role::Tables(_) | Role::List(_) => "tables",
        Role::Speeds { .. }
        | Role::Band { .. }
        | Role::AxisValues
        | Role::Wave(_)
        | Role::Course(_) => "list",
    }
}

impl ListedKey {
    /// What the key is: its symbol, description, unit, range, words and other keys.
    fn what(&self) -> String {
        let key = self.key;
        let mut text = match key.symbol() {
            Some(symbol) => format!("{symbol}: {}", key.about),
            None => key.about.to_owned(),
        };
        if let Role::Number(parameter) = key.role {
            if let Some(unit) = scaled_unit(key, parameter) {
                let _ = write!(text, "; without units in {unit}");
            }
            if parameter.bounds != Bounds::FINITE {
                let range = parameter.bounds.to_string();
                let range = range.trim_start_matches("a finite number ");
                let _ = write!(text, "; {}", range.trim_start_matches("a number "));
            }
        }
        if let Role::Choice(choice) | Role::Choices(choice) = key.role {
            let _ = write!(text, ": {}", choice.names().join(", "));
        }
        if !self.others.is_empty() {
            let _ = write!(text, "; or {}", self.others.join(", "));
        }
        if key.scope != key.section.scope() {
            let _ = write!(text, " ({})", kinds(key.scope));
        }
        text
    }
}

/// The unit of a number in a study without units, where its equations have one: those of a system do not.
fn scaled_unit(key: &Key, parameter: Parameter) -> Option<&'static str> {
    let has_one = !SCALES.contains(&parameter);
    let unit = key.unit_in_words(key.first_kind(), UnitSystem::None);
    Some(unit).filter(|unit| has_one && !unit.starts_with('1'))
}

/// The studies of a scope in words.
fn kinds(scope: KeyScope) -> String {
    let all = DocumentKind::ALL;
    let names = all.into_iter().filter(|kind| scope.includes(*kind));
    let names: Vec<&str> = names.map(|kind| kind.section().path()).collect();
    names.join(" or ")
}

/// A text in lines of at most a width.
fn broken(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_is_listed_once_in_its_table() {
        let text = listing(None).expect("all tables");
        for section in Section::ALL.iter().copied() {
            let listed: usize = rows(section).iter().map(|row| 1 + row.others.len()).sum();
            assert_eq!(listed, keys().iter().filter(|key| key.section == section).count());
            assert!(table(section).lines().count() > 1, "{section:?} lists nothing");
        }
        for heading in
            ["[belt]", "[[contact]]", "[friction], [contact.friction]", "[[system.mode]]"]
        {
            assert!(text.contains(heading), "{heading}");
        }
        assert!(text.lines().all(|line| line.chars().count() <= WIDTH));
    }

    #[test]
    fn a_table_is_found_by_its_path() {
        let text = listing(Some("belt")).expect("a table");
        assert!(text.contains("[belt.initial]") && !text.contains("[[disc.load]]"), "{text}");
        assert!(listing(Some("[[contact]]")).expect("a table").contains("tangential_stiffness"));
        assert_eq!(listing(Some("contct")), Err(Some("contact".to_owned())));
    }
}
