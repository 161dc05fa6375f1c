//! NamedModel models for the tests of Quell, each with its source.
//!
//! * [`law`]: friction laws;
//! * [`dither`]: dither forces;
//! * [`belt`]: belts, and [`BeltExt`] to vary them;
//! * [`disc`]: discs, and [`DiscExt`] to vary them.
//!
//! [`all_belts`] and [`all_discs`] list every model for conformance suites. The constructors panic on invalid values: in a
//! test that is the message.

pub mod belt;
pub mod disc;
pub mod dither;
pub mod law;

pub use belt::{BeltExt, all_belts};
pub use disc::{DiscExt, all_discs};

/// A model with its name and its source.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedModel<M> {
    /// Name in messages, unique within a list.
    pub name: String,
    /// Figure or equation of the dissertation, or "chosen" with the reason.
    pub source: &'static str,
    /// The model.
    pub model: M,
}

impl<M> NamedModel<M> {
    /// A model under a name.
    pub fn new(name: impl Into<String>, source: &'static str, model: M) -> Self {
        Self { name: name.into(), source, model }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_unique<M>(models: &[NamedModel<M>]) {
        for (index, model) in models.iter().enumerate() {
            assert!(!model.source.is_empty(), "{}", model.name);
            assert!(models[..index].iter().all(|other| other.name != model.name), "{}", model.name);
        }
    }

    #[test]
    fn names_are_unique_and_have_sources() {
        assert_unique(&law::all());
        assert_unique(&belt::undithered());
        assert_unique(&all_belts());
        assert_unique(&all_discs());
    }
}
