//! Numbers, quantities and lists as text.

/// An estimated value with the digits that its standard error leaves: two of the error, and the value down to the same place.
pub fn estimated(value: f64, error: Option<f64>) -> String {
    let Some(error) = error.filter(|error| error.is_finite() && *error > 0.0 && value != 0.0)
    else {
        return more_digits(value);
    };
    let places = libm::floor(libm::log10(value.abs())) - libm::floor(libm::log10(error)) + 2.0;
    let count = (1..=12_u8).rev().find(|count| f64::from(*count) <= places).unwrap_or(1);
    let [value, error] = [(value, usize::from(count)), (error, 2)]
        .map(|(number, count)| quell_model::digits::digits(number, count));
    format!("{value} ± {error}")
}

/// Units with which keys end, as the table of keys has them; a test compares both.
const UNITS_OF_KEYS: [&str; 20] = [
    "n_s_per_m",
    "n_per_m",
    "n_per_a",
    "kg_per_m3",
    "m_per_s",
    "s_per_m",
    "per_m",
    "rpm",
    "deg",
    "kg",
    "hz",
    "pa",
    "n",
    "m",
    "s",
    "w",
    "f",
    "h",
    "v",
    "a",
];

/// Four significant digits, without trailing zeros: numbers of sentences and warnings, which tables and JSON have with more.
pub fn digits(value: f64) -> String {
    quell_model::digits::digits(value, 4)
}

/// Six significant digits, without trailing zeros: numbers that a study gives, and those that are estimated with an error of their own.
pub fn more_digits(value: f64) -> String {
    quell_model::digits::digits(value, 6)
}

/// A unit after a number, with the space before it; nothing without a unit, or of a plain number or a ratio.
pub fn unit_after(unit: Option<&str>) -> String {
    named_unit(unit).map_or_else(String::new, |unit| format!(" {unit}"))
}

/// A unit that is not that of a plain number or of a ratio: "1", "1 (f*)".
pub fn named_unit(unit: Option<&str>) -> Option<&str> {
    unit.filter(|unit| *unit != "1" && !unit.starts_with("1 ("))
}

/// The number of a study at a path in words: "dither amplitude", "belt velocity of contact guide", `amplitude of dither[1]`.
///
/// ```
/// use quell_verbs::words::quantity_at;
///
/// assert_eq!(quantity_at("dither.frequency_hz"), "dither frequency");
/// assert_eq!(
///     quantity_at("contact.pad.friction.static_coefficient"),
///     "static coefficient of friction of contact pad"
/// );
/// ```
pub fn quantity_at(path: &str) -> String {
    let (name, place) = name_and_place(path);
    name + &place
}

/// A value of the number at a path in words: "dither amplitude 0.5", "belt velocity 0.5 m/s of contact guide".
pub fn quantity_is(path: &str, value: &str) -> String {
    let (name, place) = name_and_place(path);
    format!("{name} {value}{place}")
}

/// The name of the number at a path, and what it belongs to.
fn name_and_place(path: &str) -> (String, String) {
    let mut places: Vec<&str> = path.split('.').collect();
    let key = places.pop().unwrap_or_default();
    // Names that the study gives itself.
    if let Some(&("constants" | "parameters")) = places.last() {
        return (key.to_owned(), String::new());
    }
    let key = without_unit(key).replace('_', " ");
    match places.as_slice() {
        [] | ["belt" | "system" | "disc"] => (key, String::new()),
        ["dither"] => (format!("dither {key}"), String::new()),
        ["contact", name] => (key, format!(" of contact {name}")),
        ["contact", name, table] => {
            (key, format!(" of {} of contact {name}", table.replace('_', " ")))
        }
        ["disc", place] => (key, format!(" of the {}", place.replace('_', " "))),
        ["actuator"] if key == "file" => {
            ("measured force of the actuator".to_owned(), String::new())
        }
        ["actuator"] => (key, " of the actuator".to_owned()),
        places => (key, format!(" of {}", places.join(" ").replace('_', " "))),
    }
}

/// A key without the unit that it ends with.
fn without_unit(key: &str) -> &str {
    let mut bare =
        UNITS_OF_KEYS.iter().filter_map(|unit| key.strip_suffix(unit)?.strip_suffix('_'));
    bare.next().unwrap_or(key)
}

/// The ending of a noun after a count.
pub fn plural<N: Copy + PartialEq + From<u8>>(count: N) -> &'static str {
    if count == N::from(1) { "" } else { "s" }
}

/// A count with its noun: "1 mode", "3 modes".
pub fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", plural(count))
}

/// A text with its first letter in upper case.
pub fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A list in words: "a, b and c".
pub fn listed(parts: &[String]) -> String {
    match parts {
        [] => String::new(),
        [only] => only.clone(),
        [most @ .., last] => format!("{} and {last}", most.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use quell_study::study::vocabulary::{Role, keys};

    use super::*;

    /// What is taken for a unit at the end of a key is one by the table of keys, and every unit of the table is known.
    #[test]
    fn units_of_keys_are_those_of_the_table() {
        let is_stripped = |name: &str| without_unit(name) != name;
        for key in keys() {
            let path = key.path();
            let has_unit = match key.role {
                Role::Course(course) => course.si() == Some(true),
                _ => key.quantity().is_some() || key.takes_number(),
            };
            assert!(!is_stripped(key.name) || has_unit, "{path}");
            if let Role::Twin(_, twin) = key.role
                && !twin.unit.is_empty()
            {
                assert!(is_stripped(key.name), "{path} has the unit {}", twin.unit);
            }
        }
        for unit in UNITS_OF_KEYS {
            let ending = format!("_{unit}");
            assert!(
                keys().iter().any(|key| key.name.ends_with(&ending)),
                "no key ends with {unit}"
            );
        }
    }
}
