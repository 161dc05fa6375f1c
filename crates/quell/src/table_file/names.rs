//! Names of arrays that other programs take as identifiers.

/// The longest name of a variable or field in MATLAB.
const LONGEST: usize = 63;

/// An identifier: `velocity.x` becomes `velocity_x` and `dither[1].phase` becomes `dither_1_phase`, as in the Python package;
/// other characters become `_`. It begins with a letter.
pub(super) fn identifier(name: &str) -> String {
    let known = name.replace(']', "");
    let mut text: String =
        known.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if !text.starts_with(|c: char| c.is_ascii_alphabetic()) {
        text.insert(0, 'x');
    }
    text.truncate(LONGEST);
    text
}

/// A free identifier: the name itself, or the name with the first of `_value`, `_2`, `_3`, … that is not taken.
pub(super) fn free(name: &str, taken: &[String]) -> String {
    let plain = identifier(name);
    if !taken.contains(&plain) {
        return plain;
    }
    let endings = ["_value".to_owned()].into_iter().chain((2..).map(|number| format!("_{number}")));
    let named = |ending: String| {
        let kept = plain.len().min(LONGEST - ending.len());
        format!("{}{ending}", &plain[..kept])
    };
    endings.map(named).find(|name| !taken.contains(name)).unwrap_or(plain)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_identifiers_and_different() {
        for (name, wanted) in [
            ("velocity.x", "velocity_x"),
            ("dither[1].phase", "dither_1_phase"),
            ("pad x", "pad_x"),
            ("1st", "x1st"),
            ("µ", "x_"),
            ("", "x"),
        ] {
            assert_eq!(identifier(name), wanted);
        }
        let mut taken = Vec::new();
        for _ in 0..4 {
            taken.push(free(&"long".repeat(20), &taken));
        }
        assert!(taken.iter().all(|name| name.len() <= LONGEST), "{taken:?}");
        assert!(taken[1].ends_with("_value") && taken[2].ends_with("_2"), "{taken:?}");
        taken.dedup();
        assert_eq!(taken.len(), 4);
    }
}
