//! What `[uncertainty]` takes under the paths that a study chooses.

/// The kinds of distribution and their two numbers.
pub(crate) const DISTRIBUTIONS: [(&str, &str); 3] = [
    ("normal", "[mean, standard deviation]"),
    ("lognormal", "[median, standard deviation of the natural logarithm]"),
    ("uniform", "[smallest value, largest value]"),
];

/// What `covariance` describes.
pub(crate) const JOINTLY_NORMAL: &str = "numbers that are jointly normal";

/// What `correlation` describes.
pub(crate) const CORRELATED: &str = "the correlation of numbers with distributions of their own";
