//! Slip beyond the range of the friction law: where it occurs in an answer, and the warning about it.
//!
//! Averages reach v₀ plus the largest fast velocity of the dither. For runs the slip is measured: verbs that keep a record
//! use the record; those that report attractors and orbits run each of them again for a few periods, and every start for one.

use quell_linear::averaging::{Averaging, DitheredContact, FastMotion};
use quell_model::{Belt, Contact, System};

/// Warnings about contacts of a system whose slip leaves the range of their law; `dithered` has their fast motion.
pub(crate) fn outside_of_laws(
    system: &System,
    in_words: impl Fn(f64) -> String,
    dithered: Option<&[DitheredContact]>,
) -> Vec<String> {
    let contacts = system.contacts.iter().enumerate();
    contacts
        .filter_map(|(index, contact)| {
            let slip = match dithered {
                Some(found) => found[index].largest_slip(contact),
                None => contact.surface_velocity.mean().abs(),
            };
            at_contact(contact, slip, &in_words)
        })
        .collect()
}

/// The largest fast slip velocity at the belt velocity, at the finite R of the study; in the limit R → ∞ where that has none.
pub(crate) fn fast_velocity(belt: &Belt) -> f64 {
    let motion = FastMotion::of(belt, belt.belt_velocity(), Averaging::FiniteR);
    let fast = motion.and_then(|motion| motion.largest_slip());
    fast.unwrap_or_else(|_| belt.fast_velocity())
}

/// Slip that averages reach at slip speed `slip`: that speed plus the largest fast velocity.
pub fn with_dither(belt: &Belt, slip: f64) -> f64 {
    slip + fast_velocity(belt)
}

/// Slip that averages reach at v₀ with the first dither at this amplitude.
pub fn at_amplitude(belt: &Belt, amplitude: f64) -> f64 {
    let mut dithers = belt.dithers().to_vec();
    if let Some(dither) = dithers.first_mut() {
        dither.amplitude = amplitude;
    }
    // An amplitude that the belt cannot have, such as normal dither that opens the contact, moves the mass as in the limit.
    let fast = match belt.dithered_by(dithers.clone()) {
        Ok(acting) => fast_velocity(&acting),
        Err(_) => dithers.iter().map(|dither| belt.fast_velocity_of(dither)).sum(),
    };
    belt.belt_velocity() + fast
}

/// The warning about slip at a contact of a system beyond the range of its law, or about a surface slower than that range; `in_words` writes a
/// velocity with its unit.
pub(crate) fn at_contact(
    contact: &Contact,
    slip: f64,
    in_words: impl Fn(f64) -> String,
) -> Option<String> {
    let range = contact.friction.range()?;
    let slow = contact.surface_velocity.mean().abs();
    let (verb, slip) = if slip > range.upper {
        ("reaches", slip)
    } else if slow > 0.0 && slow < range.lower {
        ("is", slow)
    } else {
        return None;
    };
    Some(format!(
        "the slip velocity at contact {} {verb} {}, outside the range of the {} law, {} to {} ({}): numbers from there are \
             extrapolated",
        contact.name,
        in_words(slip),
        contact.friction.kind().name(),
        in_words(range.lower),
        in_words(range.upper),
        range.limit
    ))
}
