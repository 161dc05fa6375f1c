//! A number written as a formula of named numbers, such as `1 - kappa*mu`.

use super::syntax::{self, SyntaxError};
use super::tree::Tree;

/// A number written as a formula of named numbers; the slip velocity v is not among them.
///
/// ```
/// use quell_model::friction::expression::NumberFormula;
///
/// let formula = NumberFormula::parse("1 - kappa*mu", &["mu", "kappa"])?;
/// assert_eq!(formula.value(&[0.5, 0.2]), 0.9);
/// assert_eq!(formula.uses(), [1, 0]);
/// # Ok::<(), quell_model::friction::expression::SyntaxError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct NumberFormula {
    tree: Tree,
}

impl NumberFormula {
    /// Reads a formula of numbers with these names.
    ///
    /// # Errors
    /// What is wrong, with its character.
    pub fn parse(text: &str, names: &[&str]) -> Result<Self, SyntaxError> {
        syntax::parse_number(text, names).map(|tree| Self { tree })
    }

    /// Its value for these values of the names.
    pub fn value(&self, named: &[f64]) -> f64 {
        self.tree.value(named)
    }

    /// Places of the names that occur in it, in the order of the text.
    pub fn uses(&self) -> Vec<usize> {
        let mut found = Vec::new();
        self.tree.constants(&mut found);
        found
    }
}
