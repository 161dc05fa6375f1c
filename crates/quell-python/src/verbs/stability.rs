//! `stability`: stability of steady sliding by averaging, of a disc or system by eigenvalues or Floquet exponents.

use quell::run::system::tracked::TrackRequest;
use quell::verbs::verbs;
use quell::{Failure, RealInterval, Study, quantity};

use crate::answer::NativeAnswer;
use crate::arguments::{Pair, ends};

/// Runs the verb. `exact`: whether Floquet exponents decide.
pub(crate) fn run(study: &Study, exact: bool) -> Result<NativeAnswer, Failure> {
    let verbs = verbs(study);
    let done = if exact { verbs.exact_stability() } else { verbs.stability() };
    Ok(NativeAnswer::new(done?))
}

/// Runs the verb over a parameter. `along`: a second parameter and its range.
pub(crate) fn run_tracked(
    study: &Study,
    parameter: String,
    range: &Pair,
    along: Option<(String, Pair)>,
) -> Result<NativeAnswer, Failure> {
    let window = ends(study, &parameter, range)?;
    let along = match along {
        Some((path, between)) => {
            let value = |text: &str| quantity::value_of(Some(study), text, &path, "--between");
            let between = RealInterval::new(value(&between.0)?, value(&between.1)?);
            Some((path, between))
        }
        None => None,
    };
    let request = TrackRequest { parameter, window, along };
    Ok(NativeAnswer::new(verbs(study).tracked_stability(&request)?))
}
