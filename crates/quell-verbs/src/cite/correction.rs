//! A correction of the printed text: the printed form, the correct form, the studies that it concerns, and the proof.

use quell_model::disc::DiscDither;
use quell_model::{Direction, LawKind};

use super::citation::Task;
use super::cited_study::CitedStudy;
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

impl Bears {
    /// Whether this study is concerned.
    pub(super) fn on(self, study: &CitedStudy) -> bool {
        match self {
            Self::Belt { law, direction, waveform } => {
                study.is_one_mass()
                    && law.is_none_or(|law| study.has_law(law))
                    && direction.is_none_or(|direction| study.has_dither(direction, waveform))
            }
            Self::Disc(kind) => kind.is(study),
            Self::Nothing => false,
        }
    }
}

impl DiscKind {
    /// Whether a study is a disc of this kind.
    pub(super) fn is(self, study: &CitedStudy) -> bool {
        let Some(study) = study.disc() else { return false };
        match self {
            Self::Any => true,
            Self::ComputedModes => matches!(study.source(), ModeSource::Plate(_)),
            Self::Dithered => study.disc().dither() != DiscDither::None,
            Self::Tangential => matches!(study.disc().dither(), DiscDither::Tangential { .. }),
        }
    }
}
