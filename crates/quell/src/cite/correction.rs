//! A correction of the print, as a value: what is printed, what is right, whom it concerns, where it is proved.

use quell_model::disc::DiscDither;
use quell_model::{Belt, Direction, LawKind, Waveform};

use super::citation::Task;
use crate::study::DiscStudy;
use crate::study::disc::ModeSource;

/// A place where the print was corrected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Correction {
    /// Equations of the dissertation.
    pub equations: &'static str,
    /// What is printed.
    pub printed: &'static str,
    /// What it should be.
    pub right: &'static str,
    /// The computations concerned; none where it is a slip that enters no computation.
    pub tasks: &'static [Task],
    /// The studies concerned.
    pub bears: Bears,
    /// How one knows.
    pub proof: Proof,
}

/// On which studies a correction bears.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bears {
    /// Belts with this law, dither along this direction, of this waveform; `None` is any, and without a direction
    /// also belts without dither.
    Belt {
        /// The law.
        law: Option<LawKind>,
        /// The direction of the dither.
        direction: Option<Direction>,
        /// Its waveform.
        waveform: Option<Waveform>,
    },
    /// Discs of this kind.
    Disc(DiscKind),
    /// None: words, brackets, numbers of equations.
    Nothing,
}

/// The discs that a correction bears on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DiscKind {
    /// Every disc.
    Any,
    /// Modes are computed from the plate.
    ComputedModes,
    /// There is dither.
    Dithered,
    /// There is tangential dither.
    Tangential,
}

/// How one knows that a correction is right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Proof {
    /// A test computes the printed form and the right one and holds both against quadrature, exact eigenvalues or an
    /// exact orbit.
    Test {
        /// File, from the root of the project.
        file: &'static str,
        /// Name of its function.
        name: &'static str,
    },
    /// Reading the derivation is enough: nothing is computed with it.
    Reading,
}

/// Whether a belt has dither along a direction, and of a waveform if one is given.
pub(super) fn has(belt: &Belt, direction: Direction, waveform: Option<Waveform>) -> bool {
    belt.dithers_along(direction)
        .any(|dither| waveform.is_none_or(|waveform| dither.waveform == waveform))
}

impl Bears {
    /// On this belt?
    pub(super) fn on_belt(self, belt: &Belt) -> bool {
        let Self::Belt { law, direction, waveform } = self else { return false };
        law.is_none_or(|law| belt.friction().kind() == law)
            && direction.is_none_or(|direction| has(belt, direction, waveform))
    }

    /// On this disc?
    pub(super) fn on_disc(self, study: &DiscStudy) -> bool {
        match self {
            Self::Disc(kind) => kind.is(study),
            Self::Belt { .. } | Self::Nothing => false,
        }
    }
}

impl DiscKind {
    /// Is the study of such a disc?
    fn is(self, study: &DiscStudy) -> bool {
        match self {
            Self::Any => true,
            Self::ComputedModes => matches!(study.source(), ModeSource::Plate(_)),
            Self::Dithered => study.disc().dither() != DiscDither::None,
            Self::Tangential => matches!(study.disc().dither(), DiscDither::Tangential { .. }),
        }
    }
}
