//! The nearest valid word to a wrong one: it differs by a few letters (Damerau–Levenshtein), begins alike (Jaro–Winkler), or contains
//! the other.

/// The least likeness of a suggestion.
pub const NEAR: f64 = 0.6;
/// The minimum similarity for a common beginning to count.
const SAME_BEGINNING: f64 = 0.85;
/// The likeness if one word contains the other.
const INSIDE: f64 = 0.7;

/// How alike two words are, from 0 to 1.
pub fn likeness(wrong: &str, right: &str) -> f64 {
    let (wrong, right) = (wrong.to_lowercase(), right.to_lowercase());
    let letters = strsim::normalized_damerau_levenshtein(&wrong, &right);
    let beginning = strsim::jaro_winkler(&wrong, &right);
    let inside =
        wrong.len() >= 4 && right.contains(&wrong) || right.len() >= 4 && wrong.contains(&right);
    let mut score = letters;
    if beginning >= SAME_BEGINNING {
        score = score.max(0.9 * beginning);
    }
    if inside {
        score = score.max(INSIDE);
    }
    score
}

/// The nearest of the valid words, if any is close enough.
///
/// ```
/// use quell_input::nearest::word;
///
/// assert_eq!(word("stribek", ["stribeck", "decreasing"]).as_deref(), Some("stribeck"));
/// assert_eq!(word("sawtooth", ["sine", "triangle", "square"]), None);
/// ```
pub fn word<'a>(wrong: &str, right: impl IntoIterator<Item = &'a str>) -> Option<String> {
    right
        .into_iter()
        .map(|candidate| (likeness(wrong, candidate), candidate))
        .filter(|(score, _)| *score >= NEAR)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate.to_owned())
}
