//! Words to avoid in the texts of Quell, with replacements.

/// A word or phrase, in all its forms.
pub(super) struct AvoidedWord {
    /// Forms, in small letters; words of a phrase are separated by single spaces.
    pub(super) forms: &'static [&'static str],
    /// What to write instead.
    pub(super) instead: &'static str,
    /// Files with legitimate uses.
    pub(super) exceptions: &'static [Exception],
}

/// A file with legitimate uses of a word.
pub(super) struct Exception {
    /// Path from the root of the workspace.
    pub(super) file: &'static str,
    /// The exact number of uses.
    pub(super) count: usize,
    /// Why they are legitimate.
    #[expect(dead_code, reason = "an exception without a reason shall not compile")]
    pub(super) reason: &'static str,
}

/// An entry without exceptions.
pub(super) const fn word(forms: &'static [&'static str], instead: &'static str) -> AvoidedWord {
    AvoidedWord { forms, instead, exceptions: &[] }
}

/// The argument `it` of closures, which is counted in Rust code.
pub(super) const CLOSURE_IT: AvoidedWord = word(&["|it|"], "the thing's name, or |x|");

/// Words and phrases in comments, string literals and Markdown.
#[rustfmt::skip]
pub(super) const WORDS: &[AvoidedWord] = &[
    word(&["tell", "tells", "told", "telling"], "report, print, return, state, say; distinguish (tell apart)"),
    word(&["for ever"],                         "indefinitely, always"),
    word(&["whatever"],                         "any, regardless of"),
    word(&["whoever"],                          "any caller, anyone who"),
    word(&["nobody's"],                         "not used, not needed"),
    word(&["there is none"],                    "no … exists, or `None`"),
    word(&["that is none", "are none"],         "not a …, no … exist"),
    word(&["be it"],                            "whether … or …, either"),
    word(&["beside"],                           "next to, in addition to, compared with"),
    word(&["hear", "hears", "heard"],           "receive, is notified of"),
    word(&["mind", "minds"],                    "is affected by, depends on"),
    word(&["stretch", "stretches"],             "interval, range, axis limits"),
    word(&["bond", "bonds"],                    "sticking contact, stiction"),
];

/// Files and folders that are not checked, with the reason.
#[rustfmt::skip]
pub(super) const EXCLUDED: &[(&str, &str)] = &[
    ("docs/book/src/errata.md",      "generated from crates/quell-verbs/src/cite/corrections.rs"),
    ("out/",                         "results of runs, which are not part of the repository"),
    ("xtask/src/english/words.rs",   "the list itself"),
    ("xtask/src/english/planted.rs", "texts planted for the tests of this check"),
];
