//! `resonances`: speeds at which waves of a disc meet, or how far the dither of a system reaches its contacts.

use quell::run::disc::resonances::{Order, ResonancesRequest};
use quell::run::system::reach::without_waves;
use quell::verbs::verbs;
use quell::{Failure, RealInterval, Study, quantity};

use super::refused;
use crate::answer::NativeAnswer;
use crate::arguments::Pair;

/// Runs the verb.
pub(crate) fn run(
    study: &Study,
    order: &str,
    ranges: [Option<Pair>; 3],
) -> Result<NativeAnswer, Failure> {
    let order = match order {
        "first" => Order::First,
        "second" => Order::Second,
        other => return Err(refused("order", other, "\"first\" or \"second\"")),
    };
    let disc = study.disc().ok();
    if disc.is_none() {
        return reach(study, order, &ranges);
    }
    let [speeds, clear, frequency] = ranges;
    let range = |pair: &Option<Pair>, option| -> Result<Option<RealInterval>, Failure> {
        let Some((from, to)) = pair else { return Ok(None) };
        let read = |text: &str| quantity::frequency(text, disc.as_ref(), option);
        Ok(Some(RealInterval::new(read(from)?, read(to)?)))
    };
    // The default range is that of the command line.
    let speeds = range(&speeds, "--speeds")?.unwrap_or(RealInterval::new(0.0, 1.0));
    let (clear, frequency) = (range(&clear, "--clear")?, range(&frequency, "--frequency")?);
    let request = ResonancesRequest::new(speeds, order, clear, frequency)?;
    Ok(NativeAnswer::new(verbs(study).resonances(request)?))
}

/// How far the dither of a system reaches its contacts.
fn reach(
    study: &Study,
    order: Order,
    [speeds, clear, frequency]: &[Option<Pair>; 3],
) -> Result<NativeAnswer, Failure> {
    let shown = |pair: &Option<Pair>| pair.as_ref().map(|(from, to)| format!("{from}:{to}"));
    without_waves(shown(speeds).as_deref(), order, shown(clear).as_deref())?;
    let read = |text: &str| quantity::dither_frequency(text, Some(study), "--frequency");
    let range = match frequency {
        Some((from, to)) => Some(RealInterval::new(read(from)?, read(to)?)),
        None => None,
    };
    Ok(NativeAnswer::new(verbs(study).reach(range)?))
}
