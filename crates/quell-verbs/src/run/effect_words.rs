//! The effect of a dither in words, for every structure.

use quell_dynamics::response::Effect;

/// Levels beyond this are reported as "below" or "more than" it: the rest is integration error and rounding.
pub(super) const MOST_DECIBELS: f64 = 120.0;

/// The parts of a sentence about an effect.
pub(crate) struct EffectWords<'a> {
    /// What vibrates.
    pub(crate) body: &'a str,
    /// Upper end of the band of slow vibration.
    pub(crate) band: &'a str,
    /// Amplitude in that band.
    pub(crate) amplitude: &'a str,
    /// [`residual_in_words`].
    pub(crate) residual: &'a str,
}

impl EffectWords<'_> {
    /// What the dither does.
    pub(crate) fn sentence(&self, effect: Effect) -> String {
        let Self { body, band, amplitude, residual } = self;
        match effect {
            Effect::Quenches => format!("this dither quenches the vibration: {residual}"),
            Effect::Reduces => format!("this dither reduces the vibration: {residual}"),
            Effect::Increases => format!("this dither increases the vibration: {residual}"),
            Effect::Causes => format!(
                "this dither causes vibration of amplitude {amplitude} below {band}: {body} is quiet without it"
            ),
            Effect::Quiet => {
                format!("{body} is quiet with and without this dither: there is nothing to quench")
            }
            Effect::Unknown(why) => format!("the effect of this dither is unknown: {why}"),
        }
    }
}

/// The residual vibration in words, with its level; empty if it is undefined.
pub(crate) fn residual_in_words(residual_vibration: Option<f64>, band: &str) -> String {
    let Some(ratio) = residual_vibration else { return String::new() };
    let level = match level_of(ratio) {
        Some(level) if level < -MOST_DECIBELS => format!(" (below −{MOST_DECIBELS} dB)"),
        Some(level) => format!(" ({level:.1} dB)"),
        None => String::new(),
    };
    format!("the residual vibration below {band} is {}{level}", percent(ratio))
}

/// 20 lg E, in dB; `None` if E is zero.
pub(crate) fn level_of(ratio: f64) -> Option<f64> {
    (ratio > 0.0).then(|| 20.0 * libm::log10(ratio))
}

/// A share as a percentage with three digits.
pub(crate) fn percent(ratio: f64) -> String {
    let value = 100.0 * ratio;
    if value >= 1e5 {
        format!("{value:.2e} %")
    } else if value >= 100.0 {
        format!("{value:.0} %")
    } else if value >= 0.1 {
        format!("{value:.2} %")
    } else {
        format!("{value:.1e} %")
    }
}
