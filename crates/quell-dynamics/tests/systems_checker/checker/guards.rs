//! Functions of time and state that are positive while the modes last; an event is the zero of one of them.

use super::equations::{Equations, Instant, Mode};

/// What ends the mode of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ending {
    /// The slip velocity, of this sign, vanishes.
    Stop(i8),
    /// The holding force reaches the static bound of this sign.
    Bound(i8),
    /// The load of a slipping contact vanishes.
    Separation,
    /// The gap of an open contact closes.
    Landing,
}

/// What ends the mode of one contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Guard {
    /// The contact.
    pub(super) contact: usize,
    /// What ends its mode.
    pub(super) ending: Ending,
}

impl Guard {
    /// The guards of given modes.
    pub(super) fn all(equations: &Equations<'_>, modes: &[Mode]) -> Vec<Self> {
        let mut guards = Vec::new();
        for (contact, &mode) in modes.iter().enumerate() {
            let mut watch = |ending| guards.push(Self { contact, ending });
            match mode {
                Mode::Slip(sign) => {
                    watch(Ending::Stop(sign));
                    if equations.is_compliant(contact) {
                        watch(Ending::Separation);
                    }
                }
                Mode::Stick => {
                    watch(Ending::Bound(1));
                    watch(Ending::Bound(-1));
                }
                Mode::Open => watch(Ending::Landing),
            }
        }
        guards
    }

    /// The value of the guard.
    pub(super) fn value(self, equations: &Equations<'_>, at: &Instant) -> f64 {
        let c = self.contact;
        match self.ending {
            Ending::Stop(sign) => f64::from(sign) * at.slip[c],
            Ending::Bound(sign) => {
                let bound = equations.contact(c).friction.static_coefficient() * at.load[c];
                bound - f64::from(sign) * at.force[c]
            }
            Ending::Separation => at.load[c],
            Ending::Landing => -at.load[c],
        }
    }
}
