//! The fused multiply-add that compiled code calls where a processor's instruction is not certain, for Windows with the GNU runtime.
//!
//! `f64::mul_add` outside [`dispatch`](crate::dispatch) is a call of the C function `fma`. That of glibc, musl and macOS is correctly
//! rounded, that of mingw-w64 rounds twice. A program that contains this crate has this one instead: the instruction where the processor has
//! it, and the correctly rounded code of `libm` elsewhere.

/// x·y + z, rounded once.
#[expect(unsafe_code, reason = "the C function `fma` of the platform is replaced by name")]
#[unsafe(no_mangle)]
extern "C" fn fma(x: f64, y: f64, z: f64) -> f64 {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        return simd.vectorize(
            #[inline(always)]
            || x.mul_add(y, z),
        );
    }
    libm::fma(x, y, z)
}
