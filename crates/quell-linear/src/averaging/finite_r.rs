//! Averaging at a finite frequency ratio R, and in the limit R → ∞.

use super::{AveragingOptions, FastResponse, NormalOrder};

impl AveragingOptions {
    /// Finite-R averaging: the oscillator's own response to the dither and, under normal dither, one more term of the fast
    /// motion.
    pub const FINITE_R: Self =
        Self { response: FastResponse::Oscillator, normal_order: NormalOrder::Second };

    /// The limit of high dither frequency R → ∞, the averaging of the dissertation: the fast velocity is αG, and normal dither moves
    /// the mass to first order.
    pub const LIMIT: Self =
        Self { response: FastResponse::Limit, normal_order: NormalOrder::First };
}
