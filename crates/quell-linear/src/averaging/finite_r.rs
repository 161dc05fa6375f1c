//! Averaging at a finite frequency ratio R.

use super::{AveragingOptions, FastResponse, NormalOrder};

impl AveragingOptions {
    /// Finite-R averaging: the oscillator's own response to the dither and, under normal dither, one more term of the fast
    /// motion.
    pub const FINITE_R: Self =
        Self { response: FastResponse::Oscillator, normal_order: NormalOrder::Second };
}
