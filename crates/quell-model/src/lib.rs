//! Nouns of Quell.
