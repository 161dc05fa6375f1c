//! The Taylor series of the engine: their order and what depends on it.

/// Order of the Taylor series. At tolerance 10⁻¹⁰ about three steps cover a period of free
/// slip; the kernel is unrolled for it.
pub const ORDER: usize = 16;

/// Coefficients of a Taylor series of the engine's order.
pub(crate) type Series = [f64; ORDER + 1];

/// 1/k for k = 1…ORDER + 1 (entry 0 unused).
pub(crate) const RECIPROCALS: [f64; ORDER + 2] = {
    let mut table = [0.0; ORDER + 2];
    let mut k = 1;
    while k < ORDER + 2 {
        table[k] = 1.0 / k as f64;
        k += 1;
    }
    table
};
