//! An input: where a profile enters the system.

use crate::profile::Profile;

/// Where an input enters.
#[derive(Clone, Debug, PartialEq)]
pub enum InputTarget {
    /// A force b u(t) on the structure, b a row over the coordinates.
    Force(Vec<f64>),
    /// A load u(t) added to the normal load of a contact, counted from 0.
    NormalLoad {
        /// The contact.
        contact: usize,
        /// Whether the load also acts on the structure along the contact's normal; otherwise guides take it (chapter 4 of
        /// the dissertation).
        reaction: bool,
    },
    /// A factor u(t) on the friction force of a contact, counted from 0: the follower force of chapter 5, whose normal and
    /// tangential dither both act this way (5.22), (5.31).
    Friction {
        /// The contact.
        contact: usize,
    },
}

impl InputTarget {
    /// The contact whose load or friction it changes, counted from 0.
    pub fn contact(&self) -> Option<usize> {
        match self {
            Self::Force(_) => None,
            Self::NormalLoad { contact, .. } | Self::Friction { contact } => Some(*contact),
        }
    }
}

/// A profile and where it enters.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Where it enters.
    pub target: InputTarget,
    /// What enters.
    pub profile: Profile,
}
