//! The layers of Quell: which crate may use which, and why. Dependencies point downwards only.

/// A crate of the workspace.
pub(crate) struct CrateLayer {
    /// Its name.
    pub(crate) name: &'static str,
    /// Crates of the workspace that it may depend on, for any purpose.
    pub(crate) may_use: &'static [&'static str],
    /// Why it may use no other.
    pub(crate) reason: &'static str,
}

const NOTHING: &[&str] = &[];
const MATHEMATICS: &[&str] = &["quell-numerics"];
const NOUNS: &[&str] = &["quell-model", "quell-numerics"];
/// Lists with the models that the tests of a crate share.
const NOUNS_AND_ZOO: &[&str] = &["quell-model", "quell-numerics", "quell-zoo"];
const LINEAR_AND_ZOO: &[&str] = &["quell-linear", "quell-model", "quell-numerics", "quell-zoo"];
const PHYSICS_AND_ZOO: &[&str] =
    &["quell-disc", "quell-dynamics", "quell-linear", "quell-model", "quell-numerics", "quell-zoo"];
const PHYSICS_AND_INPUT: &[&str] = &[
    "quell-design",
    "quell-disc",
    "quell-dynamics",
    "quell-input",
    "quell-linear",
    "quell-model",
    "quell-numerics",
];
const ENGINES_AND_STUDIES: &[&str] = &[
    "quell-design",
    "quell-disc",
    "quell-dynamics",
    "quell-input",
    "quell-linear",
    "quell-model",
    "quell-numerics",
    "quell-study",
];
const VERBS: &[&str] = &[
    "quell-design",
    "quell-disc",
    "quell-dynamics",
    "quell-input",
    "quell-linear",
    "quell-model",
    "quell-numerics",
    "quell-study",
    "quell-verbs",
];
const ANSWERS_AND_FIGURES: &[&str] = &[
    "quell-design",
    "quell-disc",
    "quell-dynamics",
    "quell-input",
    "quell-linear",
    "quell-maps",
    "quell-model",
    "quell-numerics",
    "quell-plot",
    "quell-study",
    "quell-verbs",
];
const CLIENT: &[&str] =
    &["quell", "quell-disc", "quell-dynamics", "quell-linear", "quell-model", "quell-numerics"];
const FRONT_DOOR: &[&str] = &["quell", "quell-model", "quell-reproduce"];

const fn layer(
    name: &'static str,
    may_use: &'static [&'static str],
    reason: &'static str,
) -> CrateLayer {
    CrateLayer { name, may_use, reason }
}

/// Every crate, present or planned, from the bottom up. A crate that is not listed fails the check.
#[rustfmt::skip]
pub(crate) const LAYERS: &[CrateLayer] = &[
    layer("quell-numerics", NOTHING,     "mathematics without physics: it serves every structure"),
    layer("quell-model",    MATHEMATICS, "validated values, independent of the engines that use them"),
    layer("quell-zoo",      NOUNS,       "named models for tests, no part of the product: they know no engine that they test"),
    layer("quell-linear",   NOUNS_AND_ZOO, "linear questions about steady sliding: no trajectory is computed here"),
    layer("quell-dynamics", LINEAR_AND_ZOO, "motion, its orbits and attractors: no file, no thread and no particular kind of structure"),
    layer("quell-disc",     LINEAR_AND_ZOO, "what only a disc has; its motion is that of any structure"),
    layer("quell-design",   PHYSICS_AND_ZOO, "questions about many studies at once: it asks the engines, and knows no file and no thread"),
    layer("quell-plot",     NOTHING,     "a figure is data plus a renderer, independent of physics and studies"),
    layer("quell-input",    NOUNS, "text and files before they are a study: no key, no unit system, no engine"),
    layer("quell-study",    PHYSICS_AND_INPUT,     "reads and checks studies; computes nothing"),
    layer("quell-verbs",    ENGINES_AND_STUDIES, "a question in, a typed answer out: no picture and no report"),
    layer("quell-maps",     VERBS,       "values over axes, computed, stored and shared: no picture"),
    layer("quell",          ANSWERS_AND_FIGURES, "the front door presents answers, independent of its clients"),
    layer("quell-reproduce", CLIENT,     "the dissertation is a client of `quell`; only user interfaces use it"),
    layer("quell-cli",      FRONT_DOOR,  "a user interface parses and displays: no physics, no other interface"),
    layer("quell-python",   FRONT_DOOR,  "a user interface parses and displays: no physics, no other interface"),
    layer("quell-explorer", FRONT_DOOR,  "a user interface parses and displays: no physics, no other interface"),
    layer("xtask",          NOTHING,     "development commands must run while the product does not compile"),
];

/// An external dependency that is confined to a few crates.
pub(crate) struct Confined {
    /// Name of the package.
    pub(crate) package: &'static str,
    /// Crates that may depend on it.
    pub(crate) homes: &'static [&'static str],
    /// Whether the tests of every crate may use it too.
    pub(crate) in_tests: bool,
    /// Why other crates may not.
    pub(crate) reason: &'static str,
}

const fn confined(
    package: &'static str,
    homes: &'static [&'static str],
    in_tests: bool,
    reason: &'static str,
) -> Confined {
    Confined { package, homes, in_tests, reason }
}

/// Confined dependencies, with the crates that may use them.
#[rustfmt::skip]
pub(crate) const CONFINED: &[Confined] = &[
    confined("rayon",      &["quell-verbs"],            false, "the engines are single-threaded, so that no result depends on scheduling"),
    confined("toml",       &["quell-input", "xtask"],    true,  "study files are read by one crate; xtask reads manifests; tests compare studies with their schema"),
    confined("zarrs",      &["quell-maps"],              false, "stores are written by one crate, atomically"),
    confined("png",        &["quell-plot"],         true,  "pictures are drawn by one crate; tests decode them"),
    confined("resvg",      &["quell-plot"],         false, "pictures are drawn by one crate"),
    confined("svg2pdf",    &["quell-plot"],         false, "pictures are drawn by one crate"),
    confined("rustix",     &["quell-input", "quell-maps"], false, "untrusted files are opened by two crates: studies and stores"),
    confined("signal-hook", &["quell-cli"],         false, "signals are handled by the program that owns the process"),
    confined("clap",       &["quell-cli"],          false, "arguments are parsed by the command line alone"),
    confined("indicatif",  &["quell-cli"],          false, "progress bars are shown by the command line alone"),
    confined("pyo3",       &["quell-python"],       false, "the core does not depend on its bindings"),
    confined("numpy",      &["quell-python"],       false, "the core does not depend on its bindings"),
    confined("serde",      &["quell-python"],       false, "no type of Quell is serialised; the dependency only sets features"),
    confined("serde_json", &["quell", "quell-cli", "quell-input", "quell-maps", "quell-plot", "quell-python", "quell-reproduce", "quell-study", "quell-verbs", "xtask"], true,  "JSON is read and written by few crates, and xtask reads messages of cargo; tests of any crate may read reference numbers"),
];
