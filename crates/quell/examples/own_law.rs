//! Is sliding stable under a friction law of one's own?
//!
//! `cargo run --release --package quell --example own_law`

use quell::verbs::verbs;
use quell::{Failure, Study};

/// A formula of the slip velocity v, proven finite and not negative up to the velocities that occur.
const STUDY: &str = r#"
[belt]
damping_ratio = 0.005
normal_load = 1.0
belt_velocity = 0.2
[friction]
law = "expression"
coefficient = "0.3 + 0.1*exp(-abs(v)/c)"
constants = { c = 0.1 }
"#;

/// Answers the question.
///
/// # Errors
/// An invalid study, such as a formula that becomes negative.
pub(crate) fn main() -> Result<(), Failure> {
    let study = verbs(&Study::parse(STUDY, &[])?);
    println!("{}", study.friction(Some(&[0.1, 0.2, 0.4]), false)?.text());
    let found = study.stability()?;
    assert_eq!(found.json()["verdict"], "unstable");
    println!("{}", found.text());
    Ok(())
}
