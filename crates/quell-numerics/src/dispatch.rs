//! Fused multiply-add where the machine has it, chosen at run time.
//!
//! The baseline build calls a library routine for each `mul_add`. Work handed to
//! [`with_fused_multiply_add`] is compiled a second time with AVX2 and FMA and runs that
//! copy where the processor allows. Bits are the same either way: every operation is
//! correctly rounded in both copies.

/// Work compiled per instruction set. `run` and all it calls in a hot loop must be
/// `#[inline(always)]`, or they stay in the baseline copy.
pub trait Work {
    /// Result of the work.
    type Output;
    /// Does the work.
    fn run(self) -> Self::Output;
}

struct Vectorized<W>(W);

impl<W: Work> pulp::NullaryFnOnce for Vectorized<W> {
    type Output = W::Output;

    #[inline(always)]
    fn call(self) -> W::Output {
        self.0.run()
    }
}

/// Runs `work` with the best instructions for scalar code.
#[inline]
pub fn with_fused_multiply_add<W: Work>(work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        return simd.vectorize(Vectorized(work));
    }
    pulp::NullaryFnOnce::call(Vectorized(work))
}
