//! Warnings about the friction of a contact: slip beyond the range of its law, and averages that do not hold.

use quell_linear::linearised::Linearised;
use quell_linear::spectrum::spectrum;
use quell_model::{Belt, Contact, Direction, System};

use super::curve::ContactFriction;
use super::means::ContactAverages;
use super::unknown::MeasuredFriction;
use crate::contact_state::{FastContact, without_state};
use crate::range;
use crate::run::stability::not_slow;
use crate::run::system::velocity_in_words;
use crate::study::SystemStudy;

/// Relative difference up to which measured and averaged friction agree.
const AGREES: f64 = 0.1;

/// The warning about a dither that is not much faster than every motion.
pub(super) fn slow_dither(study: &SystemStudy) -> Option<String> {
    let system = study.system();
    if !system.is_dithered() {
        return None;
    }
    let linear = Linearised::new(system).ok()?;
    not_slow(study, &spectrum(&linear, &linear.friction()).ok()?)
}

/// The warnings about one contact.
pub(super) fn of_contact(
    study: &SystemStudy,
    contact: &Contact,
    means: &ContactAverages<'_>,
    found: &ContactFriction,
) -> Vec<String> {
    let words = |speed: f64| velocity_in_words(study, speed);
    let fast = *found.fast_velocity.as_ref().unwrap_or(&0.0);
    let largest = found.curve.fastest().max(found.velocity.abs()) + fast;
    let beyond = range::at_contact(contact, largest, words);
    let rest = match &means.limit {
        _ if contact.has_state() => with_a_state(study.system(), contact, found),
        _ if found.curve.measured.is_some() => found.averaging_is_off(words),
        Ok(belt) => found.slow_slip(belt, words),
        Err(_) => None,
    };
    let name = &contact.name;
    let named = |text: String| {
        if study.system().contacts.len() > 1 { format!("contact {name}: {text}") } else { text }
    };
    beyond.into_iter().chain(rest.map(named)).collect()
}

/// The average of the law without the state of a contact is not that of the contact.
fn with_a_state(system: &System, contact: &Contact, found: &ContactFriction) -> Option<String> {
    let index = system.contacts.iter().position(|known| known.name == contact.name)?;
    let speeds = found.curve.points.iter().map(|point| point.slip_velocity.abs());
    let slowest = speeds.filter(|speed| *speed > 0.0).fold(f64::INFINITY, f64::min);
    let speed = if slowest.is_finite() { slowest } else { found.velocity.abs() };
    let slip = *found.fast_velocity.as_ref().unwrap_or(&0.0);
    let why = without_state(system, index, FastContact { slip, speed })?;
    Some(format!("{why}; the values here are means of the contact with its state"))
}

impl ContactFriction {
    /// Averaging under normal dither assumes slip throughout: the fast velocity must not reach the slip velocity. Where it does,
    /// the contact sticks for a part of each period, most of it while the load is large.
    fn slow_slip(&self, belt: &Belt, words: impl Fn(f64) -> String) -> Option<String> {
        let fast: f64 =
            belt.dithers_along(Direction::Normal).map(|dither| belt.fast_velocity_of(dither)).sum();
        let slow = self.curve.points.iter().any(|point| {
            let speed = point.slip_velocity.abs();
            0.0 < speed && speed < fast
        });
        slow.then(|| {
            format!(
                "below |v_r| = {}, the fast velocity under the normal dither, the contact may stick for a part of each period: \
                 averaging assumes that it slips, and can be several times too low; the option measured gives the friction of \
                 steady responses of one mass",
                words(fast)
            )
        })
    }

    /// Where the measured friction differs most from the averaged one, and from which slip velocity on they
    /// agree.
    fn averaging_is_off(&self, words: impl Fn(f64) -> String) -> Option<String> {
        let measured: &[MeasuredFriction] = self.curve.measured.as_deref()?;
        // (|v_r|, measured/averaged)
        let ratios: Vec<(f64, f64)> = self
            .curve
            .points
            .iter()
            .zip(measured)
            .filter_map(|(point, measured)| {
                let averaged = point.effective.as_ref().ok()?.coefficient;
                let ratio = measured.as_ref().ok()?.coefficient / averaged;
                ratio.is_finite().then(|| (point.slip_velocity.abs(), ratio))
            })
            .collect();
        let off = |ratio: f64| (ratio - 1.0).abs() > AGREES;
        let worst = ratios
            .iter()
            .filter(|(_, ratio)| off(*ratio))
            .max_by(|a, b| (a.1 - 1.0).abs().total_cmp(&(b.1 - 1.0).abs()))?;
        let last =
            ratios.iter().filter(|(_, ratio)| off(*ratio)).map(|(v, _)| *v).fold(0.0, f64::max);
        let agrees_above = ratios.iter().any(|(v, _)| *v > last);
        let [at, last] = [worst.0, last].map(words);
        let factor = quell_model::digits::digits(worst.1, 3);
        let off =
            format!("at |v_r| = {at} the measured friction is {factor} times the averaged one");
        if !agrees_above {
            return Some(off);
        }
        let percent = 100.0 * AGREES;
        Some(format!(
            "{off}; of the points given, those above |v_r| = {last} agree within {percent} %"
        ))
    }
}
