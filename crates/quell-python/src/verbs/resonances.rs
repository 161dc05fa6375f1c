//! `resonances`: speeds at which waves of a disc meet, and dither frequencies that keep a range of speeds clear.

use quell::kind::verbs;
use quell::run::disc::resonances::{Order, ResonancesRequest};
use quell::{Failure, Study, quantity};

use super::refused;
use crate::answer::NativeAnswer;
use crate::arguments::Pair;

/// Runs the verb.
pub(crate) fn run(
    study: &Study,
    order: &str,
    [speeds, clear, frequency]: [Option<Pair>; 3],
) -> Result<NativeAnswer, Failure> {
    let verbs = verbs(study);
    let disc = study.disc().ok();
    let order = match order {
        "first" => Order::First,
        "second" => Order::Second,
        other => return Err(refused("order", other, "\"first\" or \"second\"")),
    };
    let range = |pair: &Option<Pair>, option| -> Result<Option<(f64, f64)>, Failure> {
        let Some((from, to)) = pair else { return Ok(None) };
        let read = |text: &str| quantity::frequency(text, disc.as_ref(), option);
        Ok(Some((read(from)?, read(to)?)))
    };
    // The default range is that of the command line.
    let speeds = range(&speeds, "--speeds")?.unwrap_or((0.0, 1.0));
    let (clear, frequency) = (range(&clear, "--clear")?, range(&frequency, "--frequency")?);
    let request = ResonancesRequest::new(speeds, order, clear, frequency)?;
    Ok(NativeAnswer::new(verbs.resonances(request)?))
}
