//! The monodromy matrix of one period by Strang splitting.
//!
//! Columns are processed in panels of [`WIDTH`], which stay in the registers and the first-level cache for the whole period.
//! For rank one, a step is one pass over the panel: the kick is added to row i, and row i is immediately accumulated into Vᵀx
//! of the next step, with one accumulator for even rows and one for odd rows.

use super::flow::ConstantFlow;
use super::kick::kick;
use super::steps::{Phase, StepMotion, Steps};
use crate::dispatch::{Work, with_fused_multiply_add};
use crate::matrix::Matrix;

/// Columns of a panel.
const WIDTH: usize = 8;

type PanelRow = [f64; WIDTH];

/// The map of one period in the coordinates of the flow.
pub(super) fn monodromy(
    flow: &ConstantFlow,
    steps: &Steps,
    phi: &dyn Fn(Phase, &mut Matrix),
) -> Matrix {
    let r = flow.rank;
    let mut sample = Matrix::zeros(r, r);
    let mut kicks = Vec::with_capacity(steps.phases.len() * r * r);
    for &phase in &steps.phases {
        phi(phase, &mut sample);
        if r == 1 && flow.nilpotent {
            let value = sample[(0, 0)];
            let h = steps.step;
            kicks.push(h * (value + h * h / 12.0 * value * flow.vau[(0, 0)] * value));
        } else {
            kicks.extend_from_slice(kick(flow, steps.step, &sample).as_slice());
        }
    }
    match &steps.motion {
        StepMotion::Modal { chunk, rows, u, v, flow: end } => with_fused_multiply_add(Panels {
            size: flow.size,
            rank: r,
            rows: *rows,
            chunk: *chunk,
            u,
            v,
            end,
            kicks: &kicks,
        }),
        StepMotion::Dense { half, whole } => dense(flow, half, whole, &kicks),
    }
}

struct Panels<'a> {
    size: usize,
    rank: usize,
    rows: usize,
    chunk: usize,
    u: &'a [f64],
    v: &'a [f64],
    end: &'a [(f64, f64, bool)],
    kicks: &'a [f64],
}

impl Work for Panels<'_> {
    type Output = Matrix;

    #[inline(always)]
    fn run(self) -> Matrix {
        let n = self.size;
        let mut map = Matrix::zeros(n, n);
        let mut x: Vec<PanelRow> = vec![[0.0; WIDTH]; self.rows];
        let rank = self.rank;
        let mut sums = vec![[0.0; WIDTH]; 2 * rank];
        let mut first = 0;
        while first < n {
            let width = WIDTH.min(n - first);
            x.fill([0.0; WIDTH]);
            for j in 0..width {
                x[first + j][j] = 1.0;
            }
            for kicks in self.kicks.chunks_exact(self.chunk * rank * rank) {
                if rank == 1 {
                    rank_one(&mut x, self.u, self.v, kicks);
                } else {
                    any_rank(&mut x, self.u, self.v, kicks, rank, &mut sums);
                }
                carry(&mut x, self.end);
            }
            for (i, row) in x.iter().enumerate().take(n) {
                map.row_mut(i)[first..first + width].copy_from_slice(&row[..width]);
            }
            first += width;
        }
        map
    }
}

/// Four columns of a row, which fit one vector register. The compiler did not vectorise loops over eight columns.
type ColumnGroup = [f64; 4];

/// a·x + y, element by element.
#[inline(always)]
fn multiply_add(a: f64, x: ColumnGroup, y: ColumnGroup) -> ColumnGroup {
    [a.mul_add(x[0], y[0]), a.mul_add(x[1], y[1]), a.mul_add(x[2], y[2]), a.mul_add(x[3], y[3])]
}

/// The two groups of a row.
#[inline(always)]
fn groups(row: &PanelRow) -> [ColumnGroup; 2] {
    [[row[0], row[1], row[2], row[3]], [row[4], row[5], row[6], row[7]]]
}

/// kick·(even + odd).
#[inline(always)]
fn force(kick: f64, even: ColumnGroup, odd: ColumnGroup) -> ColumnGroup {
    let mut force = [0.0; 4];
    for j in 0..4 {
        force[j] = kick * (even[j] + odd[j]);
    }
    force
}

/// All kicks of a chunk, rank one.
#[inline(always)]
fn rank_one(x: &mut [PanelRow], u: &[f64], v: &[f64], kicks: &[f64]) {
    let rows = x.len();
    let zero = [0.0; 4];
    let (mut even, mut odd) = ([zero; 2], [zero; 2]);
    for (x, v) in x.chunks_exact(2).zip(v[..rows].chunks_exact(2)) {
        let (a, b) = (groups(&x[0]), groups(&x[1]));
        even = [multiply_add(v[0], a[0], even[0]), multiply_add(v[0], a[1], even[1])];
        odd = [multiply_add(v[1], b[0], odd[0]), multiply_add(v[1], b[1], odd[1])];
    }
    for (k, &kick) in kicks.iter().enumerate() {
        let (low, high) = (force(kick, even[0], odd[0]), force(kick, even[1], odd[1]));
        (even, odd) = ([zero; 2], [zero; 2]);
        let u = u[k * rows..(k + 1) * rows].chunks_exact(2);
        // After the last kick there is no next one: its own row is accumulated again and not used.
        let next = if k + 1 < kicks.len() { k + 1 } else { k };
        let v = v[next * rows..(next + 1) * rows].chunks_exact(2);
        for ((x, u), v) in x.chunks_exact_mut(2).zip(u).zip(v) {
            let a = groups(&x[0]);
            let a = [multiply_add(u[0], low, a[0]), multiply_add(u[0], high, a[1])];
            x[0][..4].copy_from_slice(&a[0]);
            x[0][4..].copy_from_slice(&a[1]);
            even = [multiply_add(v[0], a[0], even[0]), multiply_add(v[0], a[1], even[1])];
            let b = groups(&x[1]);
            let b = [multiply_add(u[1], low, b[0]), multiply_add(u[1], high, b[1])];
            x[1][..4].copy_from_slice(&b[0]);
            x[1][4..].copy_from_slice(&b[1]);
            odd = [multiply_add(v[1], b[0], odd[0]), multiply_add(v[1], b[1], odd[1])];
        }
    }
}

/// All kicks of a chunk, any rank.
#[inline(always)]
fn any_rank(
    x: &mut [PanelRow],
    u: &[f64],
    v: &[f64],
    kicks: &[f64],
    rank: usize,
    sums: &mut [PanelRow],
) {
    let rows = x.len();
    let (along, force) = sums.split_at_mut(rank);
    for (k, kick) in kicks.chunks_exact(rank * rank).enumerate() {
        for (c, along) in along.iter_mut().enumerate() {
            let v = &v[(k * rank + c) * rows..(k * rank + c + 1) * rows];
            let (mut even, mut odd) = ([0.0; WIDTH], [0.0; WIDTH]);
            for (x, v) in x.chunks_exact(2).zip(v.chunks_exact(2)) {
                for j in 0..WIDTH {
                    even[j] = v[0].mul_add(x[0][j], even[j]);
                    odd[j] = v[1].mul_add(x[1][j], odd[j]);
                }
            }
            for j in 0..WIDTH {
                along[j] = even[j] + odd[j];
            }
        }
        for (force, kick) in force.iter_mut().zip(kick.chunks_exact(rank)) {
            *force = [0.0; WIDTH];
            for (along, &kick) in along.iter().zip(kick) {
                for j in 0..WIDTH {
                    force[j] = kick.mul_add(along[j], force[j]);
                }
            }
        }
        for (c, force) in force.iter().enumerate() {
            let u = &u[(k * rank + c) * rows..(k * rank + c + 1) * rows];
            for (x, &u) in x.iter_mut().zip(u) {
                for j in 0..WIDTH {
                    x[j] = u.mul_add(force[j], x[j]);
                }
            }
        }
    }
}

/// The constant flow of a chunk.
#[inline(always)]
fn carry(x: &mut [PanelRow], end: &[(f64, f64, bool)]) {
    let mut at = 0;
    for &(re, im, pair) in end {
        if pair {
            let (a, b) = (x[at], x[at + 1]);
            for j in 0..WIDTH {
                x[at][j] = re.mul_add(a[j], -(im * b[j]));
                x[at + 1][j] = re.mul_add(b[j], im * a[j]);
            }
            at += 2;
        } else {
            for value in &mut x[at] {
                *value *= re;
            }
            at += 1;
        }
    }
}

/// All steps with dense matrices.
fn dense(flow: &ConstantFlow, half: &Matrix, whole: &Matrix, kicks: &[f64]) -> Matrix {
    let r = flow.rank;
    let mut x = half.clone();
    let count = kicks.len() / (r * r);
    for (k, kick) in kicks.chunks_exact(r * r).enumerate() {
        let e = Matrix::from_fn(r, r, |i, j| kick[i * r + j]);
        let force = e.times(&flow.v.times(&x));
        x.add_scaled(1.0, &flow.u.times(&force));
        x = if k + 1 < count { whole.times(&x) } else { half.times(&x) };
    }
    x
}
