//! What passes between the engine and the kernels of slip: a step that is due, and the step as it was taken.

use super::forcing::Series;
use super::{FinalState, ORDER, Stalled};

/// A slip step that is to be taken.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlipDue {
    /// Branch of the law.
    pub(super) sign: f64,
    /// Multiplicity of the zero of v_r at the start.
    pub(super) zeros: usize,
    /// The next moment that the step may not pass.
    pub(super) stop: f64,
}

/// What a run does next.
pub(super) enum Next {
    /// A slip step.
    Slip(SlipDue),
    /// Nothing: it is over.
    Over(Result<FinalState, Stalled>),
}

/// A slip step as the kernel took it.
pub(super) struct SlipTaken<'s> {
    /// Length of the step if v_r has no root inside.
    pub(super) length: f64,
    /// First root of v_r inside, divided by the known ones at the start.
    pub(super) root: Root,
    /// y and w at the end of the step, y at the root where one was found.
    pub(super) end: (f64, f64),
    /// Coefficients of y.
    pub(super) displacement: Column<'s>,
    /// Coefficients of w.
    pub(super) slip: Column<'s>,
}

/// The first root of v_r on a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Root {
    /// Proven absent.
    None,
    /// After this long.
    At(f64),
    /// Left to the scalar search.
    Unsure,
}

/// Coefficients of one lane among those of its neighbours.
#[derive(Clone, Copy)]
pub(super) struct Column<'s> {
    /// Coefficient by coefficient, the lanes side by side.
    pub(super) rows: &'s [f64],
    /// Number of lanes.
    pub(super) lanes: usize,
    /// Which.
    pub(super) lane: usize,
}

impl Column<'_> {
    /// Coefficient k.
    #[inline(always)]
    pub(super) fn coefficient(&self, k: usize) -> f64 {
        self.rows[k * self.lanes + self.lane]
    }

    /// The coefficients alone.
    #[inline(always)]
    pub(super) fn gathered(&self) -> Series {
        let mut series = [0.0; ORDER + 1];
        for (k, coefficient) in series.iter_mut().enumerate() {
            *coefficient = self.coefficient(k);
        }
        series
    }
}
