//! The verdict on record of every claim, and why where it does not hold.

/// The verdict that a claim is known to have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    /// Reproduced.
    Reproduced,
    /// Reproduced within the claim's tolerance.
    Within,
    /// Not reproduced, and why.
    NotReproduced(&'static str),
    /// The printed formula is wrong.
    FormulaWrong,
}

impl Expected {
    /// Its kind, with the words of [`super::claim::ClaimVerdict::name`].
    pub fn name(self) -> &'static str {
        match self {
            Self::Reproduced => "reproduced",
            Self::Within => "reproduced within",
            Self::NotReproduced(_) => "not reproduced",
            Self::FormulaWrong => "printed formula wrong",
        }
    }

    /// Why the claim does not hold; empty where it does.
    pub fn why(self) -> &'static str {
        match self {
            Self::NotReproduced(why) => why,
            Self::Reproduced | Self::Within | Self::FormulaWrong => "",
        }
    }
}

/// The verdict on record of this claim.
pub(crate) fn expected(name: &str) -> Option<Expected> {
    LEDGER.iter().find(|(known, _)| *known == name).map(|(_, expected)| *expected)
}

/// Every claim by name, in the order of the table.
pub const LEDGER: &[(&str, Expected)] = &[
    ("2.3-undithered-fundamental", Expected::Within),
    (
        "2.2-minimum-coefficient",
        Expected::NotReproduced("a misprint of 0.2857: the figures were made with that"),
    ),
    ("2.8-share-at-reference", Expected::Reproduced),
    ("2.3-dithered-fundamental", Expected::Within),
    ("2.3-stick-durations", Expected::Reproduced),
    ("2.3-partial", Expected::Reproduced),
    ("2.3-suppressed", Expected::Reproduced),
    ("2.3-forced-frequency", Expected::Reproduced),
    (
        "2.3-forced-amplitude",
        Expected::NotReproduced("the forced part is D/(R² − 1), which grows as R falls"),
    ),
    ("2.6-undithered", Expected::Reproduced),
    ("2.6-linear-up-to", Expected::Reproduced),
    ("2.6-linear", Expected::Reproduced),
    ("2.6-upper-edge", Expected::Reproduced),
    ("2.6-never-destabilised", Expected::Reproduced),
    ("2.7-undithered", Expected::Reproduced),
    ("2.7-narrower", Expected::Reproduced),
    ("2.7-undithered-from-rest", Expected::Reproduced),
    (
        "2.7-undithered-from-afar",
        Expected::NotReproduced(
            "a stick-slip cycle coexists with stable sliding; averaging judges small motions only",
        ),
    ),
    ("2.7-v1-unstable-ratio", Expected::Within),
    ("2.7-v1-unstable", Expected::Within),
    ("2.7-v1-stable-ratio", Expected::Within),
    ("2.7-v1-stable", Expected::Within),
    ("2.7-v1.5-unstable", Expected::Reproduced),
    ("2.7-v1.5-stable", Expected::Reproduced),
    ("3.3-peak-sine", Expected::Reproduced),
    ("3.3-peak-triangle", Expected::Reproduced),
    ("3.3-peak-square", Expected::Reproduced),
    (
        "3.25-odd",
        Expected::NotReproduced("a slip of the pen: G is even, as the derivation needs it"),
    ),
    ("3.38a", Expected::FormulaWrong),
    ("3.38a-corner", Expected::FormulaWrong),
    ("3.53a", Expected::FormulaWrong),
    ("3.36a", Expected::FormulaWrong),
    ("3.45a", Expected::FormulaWrong),
    ("3.45b", Expected::FormulaWrong),
    ("3.47", Expected::FormulaWrong),
    ("B.3", Expected::FormulaWrong),
    ("B.4", Expected::FormulaWrong),
    ("B.5", Expected::FormulaWrong),
    ("3.39a", Expected::Reproduced),
    ("3.57a", Expected::Reproduced),
    ("3.39b", Expected::Reproduced),
    ("3.41a", Expected::Reproduced),
    ("3.44", Expected::FormulaWrong),
    ("3.44-damped", Expected::FormulaWrong),
    ("3.48", Expected::FormulaWrong),
    ("3.52", Expected::Reproduced),
    ("3.5-order", Expected::Reproduced),
    ("3.6-order", Expected::Reproduced),
    ("3.6-far", Expected::Reproduced),
    ("3.41-inner-slope", Expected::Reproduced),
    ("3.61-triangle-unstable-ratio", Expected::Reproduced),
    ("3.61-triangle-unstable", Expected::Reproduced),
    ("3.61-triangle-stable-ratio", Expected::Reproduced),
    ("3.61-triangle-stable", Expected::Reproduced),
    ("3.62-square-unstable", Expected::Reproduced),
    ("3.62-square-stable", Expected::Within),
    ("3.7-partial", Expected::Reproduced),
    ("3.7-suppressed", Expected::Reproduced),
    ("3.8-partial", Expected::Reproduced),
    ("3.8-suppressed", Expected::Reproduced),
    ("3.9-partial", Expected::Reproduced),
    ("3.9-suppressed", Expected::Reproduced),
    ("3.7-fundamental", Expected::Within),
    ("3.7-order", Expected::Reproduced),
    ("2.8-isocline-5", Expected::Within),
    ("3.10-isocline-5", Expected::Within),
    ("2.8-isocline-10", Expected::Within),
    ("3.10-isocline-10", Expected::Within),
    ("2.8-isocline-20", Expected::Within),
    ("3.10-isocline-20", Expected::Within),
    ("4.3-never-suppressed", Expected::Reproduced),
    ("4.3-cancelled", Expected::Within),
    ("4.4-partial", Expected::Reproduced),
    ("4.4-suppressed", Expected::Reproduced),
    ("4.5-slope-change", Expected::Reproduced),
    ("4.5-falling-region", Expected::Reproduced),
    ("4.6-slope-change", Expected::Reproduced),
    ("4.6-falling-region", Expected::Reproduced),
    ("4.7-larger", Expected::Reproduced),
    ("4.11-undithered", Expected::Reproduced),
    ("4.41-unstable-ratio", Expected::Within),
    ("4.41-unstable", Expected::Within),
    ("4.41-stable-ratio", Expected::Reproduced),
    ("4.41-stable", Expected::Within),
    ("4.9-isocline", Expected::Within),
    ("4.10-isocline", Expected::Within),
    ("2.10-columns", Expected::Reproduced),
    ("2.10-from-rest-lower", Expected::Reproduced),
    ("2.10-from-rest-upper", Expected::Reproduced),
    ("2.10-local-lower", Expected::Reproduced),
    ("2.10-local-upper", Expected::Within),
    ("2.10-period-10", Expected::Reproduced),
    ("2.11-columns", Expected::Reproduced),
    ("2.11-from-rest-lower", Expected::Reproduced),
    ("2.11-from-rest-upper", Expected::Reproduced),
    ("2.11-local-lower", Expected::Reproduced),
    ("2.11-local-upper", Expected::Reproduced),
    ("2.11-period-10", Expected::Reproduced),
    ("3.12-columns", Expected::Reproduced),
    ("3.12-from-rest-lower", Expected::Reproduced),
    ("3.12-from-rest-upper", Expected::Reproduced),
    ("3.12-local-lower", Expected::Reproduced),
    ("3.12-local-upper", Expected::Within),
    ("3.12-period-10", Expected::Reproduced),
    ("3.13-columns", Expected::Reproduced),
    ("3.13-from-rest-lower", Expected::Reproduced),
    ("3.13-from-rest-upper", Expected::Reproduced),
    ("3.13-local-lower", Expected::Reproduced),
    ("3.13-local-upper", Expected::Reproduced),
    ("3.13-period-10", Expected::Reproduced),
    (
        "4.11-square-columns",
        Expected::NotReproduced(
            "most likely drawn with a sine: under a square the response is unstable for 0.5538 < D_N < 0.6147 only",
        ),
    ),
    (
        "4.11-square-pattern",
        Expected::NotReproduced(
            "most likely drawn with a sine: under a square the response is unstable for 0.5538 < D_N < 0.6147 only",
        ),
    ),
    (
        "4.11-sine-columns",
        Expected::NotReproduced("at D_N = 0.95 a small vibration is left, which ends at 0.9654"),
    ),
    ("4.11-sine-pattern", Expected::Reproduced),
    ("4-other-starts", Expected::Reproduced),
    ("4.34", Expected::FormulaWrong),
    ("4.36", Expected::FormulaWrong),
    ("4.38", Expected::FormulaWrong),
    ("4.35", Expected::FormulaWrong),
    ("5.1-speed-1", Expected::Reproduced),
    ("5.1-speed-2", Expected::Reproduced),
    ("5.1-speed-3", Expected::Reproduced),
    ("5.1-speed-4", Expected::Reproduced),
    ("5.1-speed-5", Expected::Reproduced),
    ("5.2-speed-1", Expected::Reproduced),
    ("5.2-speed-2", Expected::Reproduced),
    ("5.2-speed-3", Expected::Reproduced),
    ("5.2-speed-4", Expected::Reproduced),
    ("5.2-speed-5", Expected::Reproduced),
    ("5.2-speed-6", Expected::Reproduced),
    ("5.2-speed-7", Expected::Reproduced),
    ("5.2-speed-8", Expected::Reproduced),
    ("5.9-first-three", Expected::Reproduced),
    ("5.9-all-unstable-0.1", Expected::Reproduced),
    ("5.9-all-unstable-0.2", Expected::Within),
    ("5.9-all-unstable-0.3", Expected::Reproduced),
    ("5.3a-mostly-stable", Expected::Reproduced),
    ("5.3b-mostly-stable", Expected::Reproduced),
    ("5.4-more-bands", Expected::Reproduced),
    ("5.7-peak-0.7", Expected::Reproduced),
    ("5.7-peak-0.88", Expected::Reproduced),
    ("5.7-not-suppressed", Expected::Reproduced),
    ("5.30-fundamental", Expected::FormulaWrong),
    ("5.9-fourth-0.1", Expected::Reproduced),
    ("5.9-fourth-0.3", Expected::Reproduced),
    ("5.14-vanish-0.0001", Expected::Reproduced),
    ("5.14-vanish-0.001", Expected::Reproduced),
    (
        "5.12-revived-1",
        Expected::NotReproduced(
            "not a threshold: a tongue of second order, whose growth goes with f⁴, is seen from where a grid and a solver resolve it",
        ),
    ),
    (
        "5.12-revived-4",
        Expected::NotReproduced(
            "not a threshold: a tongue of second order, whose growth goes with f⁴, is seen from where a grid and a solver resolve it",
        ),
    ),
    ("5.12-left-0.0", Expected::Reproduced),
    ("5.12-left-1e-5", Expected::Reproduced),
    ("5.12-left-0.0001", Expected::Reproduced),
    ("5.12-left-0.001", Expected::Reproduced),
    ("5.13-left", Expected::Reproduced),
    (
        "5.13-begins-3",
        Expected::NotReproduced("the two numbers fit with Ω_3 and Ω_4 interchanged in the text"),
    ),
    (
        "5.13-begins-4",
        Expected::NotReproduced("the two numbers fit with Ω_3 and Ω_4 interchanged in the text"),
    ),
];
