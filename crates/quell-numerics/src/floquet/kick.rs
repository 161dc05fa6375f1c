//! Kicks: the exact solution of the periodic part alone over one step, x ← x + U E Vᵀ x.
//!
//! For VᵀU = 0 the generator B = UΦVᵀ is nilpotent, e^{hB} = 1 + hB. Its Strang splitting e^{hA/2}e^{hB}e^{hA/2} solves
//! h(A + B) − h³/24 [A,[A,B]] + h³/12 [B,[B,A]] + …. Because [A + B, [A, B]] only changes coordinates, the remaining error of
//! the exponents is h²/24 [B,[B,A]] = −h²/12 B A B = −h²/12 U Φ(VᵀAU)Φ Vᵀ. This is a kick of the same form, so that
//!
//! ```text
//! E = h (Φ + h²/12 Φ (VᵀA₀U) Φ)
//! ```
//!
//! makes the exponents fourth-order accurate (Takahashi and Imada, *J. Phys. Soc. Jpn* 53 (1984) 3765; here A contains d/dt
//! for Φ(t)). With one load VᵀA₀U vanishes and the plain splitting is already of fourth order.
//! Otherwise E = G φ₁(VᵀU G) with G = hΦ, φ₁(z) = (e^z − 1)/z, and the exponents are second-order accurate.

use super::flow::ConstantFlow;
use crate::matrix::Matrix;

/// E of one step from Φ at its midpoint.
pub(super) fn kick(flow: &ConstantFlow, step: f64, phi: &Matrix) -> Matrix {
    let mut e = Matrix::zeros(flow.rank, flow.rank);
    if flow.nilpotent {
        e.add_scaled(step, phi);
        let along = phi.times(&flow.vau).times(phi);
        e.add_scaled(step * step * step / 12.0, &along);
        return e;
    }
    let mut g = Matrix::zeros(flow.rank, flow.rank);
    g.add_scaled(step, phi);
    let turn = flow.vu.times(&g);
    let mut term = g;
    for k in 1..200 {
        e.add_scaled(1.0, &term);
        let mut next = Matrix::zeros(flow.rank, flow.rank);
        next.add_scaled(1.0 / f64::from(k + 1), &term.times(&turn));
        term = next;
        if term.largest() <= 1e-18 * e.largest() {
            break;
        }
    }
    e
}
