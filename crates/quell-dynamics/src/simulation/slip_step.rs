//! The interface between the engine and the kernels of slip: a step that is due, and the step as it was taken.

use super::state::RunResult;
use super::taylor::{ORDER, Series};

/// A slip step that is due.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlipDue {
    /// Branch of the law.
    pub(super) sign: f64,
    /// Multiplicity of the zero of v_r at the start.
    pub(super) zeros: usize,
    /// The next moment that the step may not pass.
    pub(super) stop: f64,
}

/// The next action of a run.
pub(super) enum Next {
    /// A slip step.
    Slip(SlipDue),
    /// None: the run is over.
    Over(RunResult),
}

/// A slip step as the kernel took it.
pub(super) struct SlipTaken<'s> {
    /// Length of the step if v_r has no root inside.
    pub(super) length: f64,
    /// First root of v_r inside the step, after division by the known ones at its start.
    pub(super) root: StepRoot,
    /// y and w at the end of the step, y at the root where one was found.
    pub(super) end: (f64, f64),
    /// Coefficients of y.
    pub(super) displacement: LaneColumn<'s>,
    /// Coefficients of w.
    pub(super) slip: LaneColumn<'s>,
}

/// The first root of v_r on a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum StepRoot {
    /// Proven absent.
    None,
    /// At this time after the start of the step.
    At(f64),
    /// Left to the scalar search.
    Unknown,
}

/// Coefficients of one lane, interleaved with those of its neighbours.
#[derive(Clone, Copy)]
pub(super) struct LaneColumn<'s> {
    /// Coefficient by coefficient, the lanes side by side.
    pub(super) rows: &'s [f64],
    /// Number of lanes.
    pub(super) lanes: usize,
    /// The index of the lane.
    pub(super) lane: usize,
}

impl LaneColumn<'_> {
    /// Coefficient k.
    #[inline(always)]
    pub(super) fn coefficient(&self, k: usize) -> f64 {
        self.rows[k * self.lanes + self.lane]
    }

    /// The coefficients of this lane alone.
    #[inline(always)]
    pub(super) fn gathered(&self) -> Series {
        let mut series = [0.0; ORDER + 1];
        for (k, coefficient) in series.iter_mut().enumerate() {
            *coefficient = self.coefficient(k);
        }
        series
    }
}
