//! A correction of the printed text: the printed form, the correct form, the studies that it concerns, and the proof.

use quell_model::disc::DiscDither;
use quell_model::{Belt, Direction, LawKind};

use super::citation::Task;
use crate::study::DiscStudy;
use crate::study::disc::ModeSource;

/// A correction of the printed text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Correction {
    /// Equations of the dissertation.
    pub equations: &'static str,
    /// The printed form.
    pub printed: &'static str,
    /// The correct form.
    pub right: &'static str,
    /// The computations concerned; empty if the error does not enter any computation.
    pub tasks: &'static [Task],
    /// The studies concerned.
    pub bears: Bears,
    /// The proof that the correction is right.
    pub proof: Proof,
}

/// The studies that a correction concerns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bears {
    /// Belts with this law, and with dither of this waveform along this direction. `None` stands for any; without a direction,
    /// belts without dither are included.
    Belt {
        /// The law.
        law: Option<LawKind>,
        /// The direction of the dither.
        direction: Option<Direction>,
        /// The name of its waveform.
        waveform: Option<&'static str>,
    },
    /// Discs of this kind.
    Disc(DiscKind),
    /// No study: words, brackets, numbers of equations.
    Nothing,
}

/// The discs that a correction concerns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DiscKind {
    /// Every disc.
    Any,
    /// Discs whose modes are computed from the plate.
    ComputedModes,
    /// Discs with dither.
    Dithered,
    /// Discs with tangential dither.
    Tangential,
}

/// How a correction was verified.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Proof {
    /// A test computes the printed and the correct form and compares both with quadrature, exact eigenvalues or an exact orbit.
    Test {
        /// File, from the root of the project.
        file: &'static str,
        /// Name of its function.
        name: &'static str,
    },
    /// Reading the derivation is sufficient, because nothing is computed with it.
    Reading,
}

/// Whether a belt has dither along a direction, and of a waveform if one is given.
pub(super) fn has(belt: &Belt, direction: Direction, waveform: Option<&str>) -> bool {
    belt.dithers_along(direction)
        .any(|dither| waveform.is_none_or(|name| dither.waveform.name() == name))
}

impl Bears {
    /// Whether this belt is concerned.
    pub(super) fn on_belt(self, belt: &Belt) -> bool {
        let Self::Belt { law, direction, waveform } = self else { return false };
        law.is_none_or(|law| belt.friction().kind() == law)
            && direction.is_none_or(|direction| has(belt, direction, waveform))
    }

    /// Whether this disc is concerned.
    pub(super) fn on_disc(self, study: &DiscStudy) -> bool {
        match self {
            Self::Disc(kind) => kind.is(study),
            Self::Belt { .. } | Self::Nothing => false,
        }
    }
}

impl DiscKind {
    /// Whether the disc of a study is of this kind.
    fn is(self, study: &DiscStudy) -> bool {
        match self {
            Self::Any => true,
            Self::ComputedModes => matches!(study.source(), ModeSource::Plate(_)),
            Self::Dithered => study.disc().dither() != DiscDither::None,
            Self::Tangential => matches!(study.disc().dither(), DiscDither::Tangential { .. }),
        }
    }
}
