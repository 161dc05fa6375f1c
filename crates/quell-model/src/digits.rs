//! Numbers in sentences.

/// A number with a few significant digits and without trailing zeros, in powers of ten where it is very large or small.
pub fn digits(value: f64, count: usize) -> String {
    let text = format!("{value:.*e}", count.saturating_sub(1));
    text.parse::<f64>()
        .map_or(text, |rounded| format!("{rounded:?}").trim_end_matches(".0").to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (1e-8, "1e-8"),
            (4.3224, "4.3224"),
            (20.0, "20"),
            (0.0, "0"),
            (1_234_567.0, "1234570"),
            (1.234_567_8e300, "1.23457e300"),
            (-f64::MIN_POSITIVE, "-2.22507e-308"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(digits(value, 6), text);
        }
    }
}
