//! What keeps an averaged verdict from holding as stated: contacts that the fast motion opens, and slip outside the range of a law.

use std::cell::RefCell;

use quell_linear::averaging::DitheredContact;
use quell_model::System;
use quell_numerics::interval::RealInterval;

use super::force;
use crate::study::{SystemStudy, UnitSystem};
use crate::words::{digits, plural};

/// The contacts that the fast motion opens, by name.
pub(crate) fn opening<'a>(system: &'a System, contacts: &[DitheredContact]) -> Vec<&'a str> {
    let contacts = system.contacts.iter().zip(contacts);
    contacts.filter(|(_, found)| found.opens()).map(|(contact, _)| contact.name.as_str()).collect()
}

/// The condition of a verdict that does not hold as stated, after "would be stable": empty where every contact stays closed.
pub(crate) fn condition(opening: &[&str]) -> Option<String> {
    if opening.is_empty() {
        return None;
    }
    let (names, count) = (opening.join(" and "), opening.len());
    let them = if count == 1 { "it" } else { "them" };
    Some(format!(
        "if contact{} {names} stayed closed, but the fast motion opens {them}",
        plural(count)
    ))
}

/// Warnings about contacts that the fast load opens.
pub(crate) fn opened(
    units: UnitSystem,
    system: &System,
    contacts: &[DitheredContact],
) -> Vec<String> {
    let contacts = system.contacts.iter().zip(contacts);
    let opening = contacts.filter(|(_, found)| found.opens());
    opening
        .map(|(contact, found)| {
            format!(
                "contact {} opens: the fast part of its load, {}, exceeds the mean load, {}; averaging does not describe an open contact",
                contact.name,
                force(units, found.load_amplitude),
                force(units, found.normal_load)
            )
        })
        .collect()
}

/// Values of a parameter, by contact, at which a verdict does not hold as stated.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactRanges {
    /// The first and last value at which the contact opens.
    opens: Vec<Option<RealInterval>>,
    /// The same for slip outside the range of its law.
    leaves_law: Vec<Option<RealInterval>>,
}

impl ContactRanges {
    /// Adds what was found at a value.
    pub(super) fn add(
        recorded: &RefCell<Self>,
        value: f64,
        system: &System,
        dithered: Option<&[DitheredContact]>,
    ) {
        let mut ranges = recorded.borrow_mut();
        let count = system.contacts.len();
        ranges.opens.resize(count, None);
        ranges.leaves_law.resize(count, None);
        let widen = |range: &mut Option<RealInterval>| {
            let RealInterval { lower: from, upper: to } =
                range.unwrap_or(RealInterval::new(value, value));
            *range = Some(RealInterval::new(from.min(value), to.max(value)));
        };
        for (index, contact) in system.contacts.iter().enumerate() {
            let found = dithered.map(|contacts| &contacts[index]);
            if found.is_some_and(DitheredContact::opens) {
                widen(&mut ranges.opens[index]);
            }
            let speed = contact.surface_velocity.mean().abs();
            let leaves = match found {
                Some(found) => found.leaves_law(contact),
                None => contact.friction.range().is_some_and(|range| speed > range.upper),
            };
            if leaves {
                widen(&mut ranges.leaves_law[index]);
            }
        }
    }

    /// The contacts that open at some value, by name.
    pub(crate) fn opening<'a>(&self, system: &'a System) -> Vec<&'a str> {
        let contacts = system.contacts.iter().zip(&self.opens);
        contacts.filter_map(|(contact, range)| range.map(|_| contact.name.as_str())).collect()
    }

    /// One warning for each contact; `where_` turns a range of values into words.
    pub(super) fn warnings(
        &self,
        study: &SystemStudy,
        where_: impl Fn(RealInterval) -> String,
    ) -> Vec<String> {
        let contacts = || study.system().contacts.iter();
        let opens = contacts().zip(&self.opens).filter_map(|(contact, range)| {
            let at = where_((*range)?);
            Some(format!(
                "contact {} opens {at}; averaging does not describe an open contact",
                contact.name
            ))
        });
        let leaves = contacts().zip(&self.leaves_law).filter_map(|(contact, range)| {
            let at = where_((*range)?);
            let range = contact.friction.range();
            let limit = range.map_or(String::new(), |range| {
                format!(", {} ({})", digits(range.upper), range.limit)
            });
            let name = &contact.name;
            Some(format!(
                "the slip velocity at contact {name} leaves the range of its friction law{limit} {at}"
            ))
        });
        opens.chain(leaves).collect()
    }
}
