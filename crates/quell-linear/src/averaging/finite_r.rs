//! Averaging at a finite frequency ratio R.

use super::{AveragingOptions, NormalOrder, Response};

impl AveragingOptions {
    /// Finite-R averaging: the oscillator's own response to the dither and, under normal dither, one more term of the fast
    /// motion.
    pub const FINITE_R: Self =
        Self { response: Response::Oscillator, normal_order: NormalOrder::Second };
}
