//! Bristles under a prescribed slip: one linear equation ż = γ − a z, a = σ₀|γ|/g(γ), for every stiffness.
//!
//! Fast slip makes it stiff: a is 3·10⁷ where γ = 100 and σ₀ = 10⁵. Radau's method of order 5, whose stages are a linear system here,
//! damps what is faster than its steps. A step is halved until both halves agree with it. Hairer and Wanner (1996), section IV.5.

/// Nodes of a step.
const NODES: [f64; 3] = [(4.0 - ROOT) / 10.0, (4.0 + ROOT) / 10.0, 1.0];

/// √6.
const ROOT: f64 = 2.449_489_742_783_178;

/// Integrals of the basis polynomials from 0 to each node; the last row has the weights of a step.
const INTEGRALS: [[f64; 3]; 3] = [
    [(88.0 - 7.0 * ROOT) / 360.0, (296.0 - 169.0 * ROOT) / 1800.0, (-2.0 + 3.0 * ROOT) / 225.0],
    [(296.0 + 169.0 * ROOT) / 1800.0, (88.0 + 7.0 * ROOT) / 360.0, (-2.0 - 3.0 * ROOT) / 225.0],
    [(16.0 - ROOT) / 36.0, (16.0 + ROOT) / 36.0, 1.0 / 9.0],
];

/// Largest difference of a step and its halves, over the size of what is integrated: it is 32 times the error of the halves.
const TOLERANCE: f64 = 1e-13;

/// Most halvings of a step: at a reversal of γ its rate has a kink, where halving goes on.
const MOST_HALVINGS: u32 = 40;

/// What drives the bristles of a contact.
pub(super) struct Bristled<'a> {
    /// γ at a time.
    pub(super) slip: &'a dyn Fn(f64) -> f64,
    /// N over the mean load at a time.
    pub(super) load: &'a dyn Fn(f64) -> f64,
    /// g at a slip speed.
    pub(super) level: &'a dyn Fn(f64) -> f64,
    /// σ₀, σ₁ and σ₂.
    pub(super) stiffness: f64,
    pub(super) damping: f64,
    pub(super) viscous: f64,
    /// Sizes of z and of T over the load.
    pub(super) sizes: [f64; 2],
}

/// z at the end of a step, and the integral of T over the mean load in it.
#[derive(Clone, Copy, Debug)]
struct BristleStep {
    deflection: f64,
    impulse: f64,
}

impl BristleStep {
    /// This step and the one after it.
    fn and(self, next: Self) -> Self {
        Self { deflection: next.deflection, impulse: self.impulse + next.impulse }
    }
}

impl Bristled<'_> {
    /// z after a period, in so many steps at least, and the mean of T over the load; `None` beyond `most` steps.
    pub(super) fn over(
        &self,
        deflection: f64,
        period: f64,
        steps: u32,
        most: u32,
    ) -> Option<(f64, f64)> {
        let mut done = BristleStep { deflection, impulse: 0.0 };
        let step = period / f64::from(steps);
        let mut left = most;
        for number in 0..steps {
            let begin = f64::from(number) * step;
            done = done.and(self.halved(done.deflection, begin, step, MOST_HALVINGS, &mut left)?);
        }
        Some((done.deflection, done.impulse / period))
    }

    /// A step, or its halves where they differ.
    fn halved(
        &self,
        deflection: f64,
        time: f64,
        step: f64,
        halvings: u32,
        left: &mut u32,
    ) -> Option<BristleStep> {
        *left = left.checked_sub(1)?;
        let (whole, half) = (self.step(deflection, time, step), 0.5 * step);
        let first = self.step(deflection, time, half);
        let both = first.and(self.step(first.deflection, time + half, half));
        let [size, friction] = self.sizes;
        let off = (both.deflection - whole.deflection).abs() / size
            + (both.impulse - whole.impulse).abs() / (friction * step);
        if off <= TOLERANCE || halvings == 0 {
            return Some(both);
        }
        let first = self.halved(deflection, time, half, halvings - 1, left)?;
        let second = self.halved(first.deflection, time + half, half, halvings - 1, left)?;
        Some(first.and(second))
    }

    /// One step.
    fn step(&self, deflection: f64, time: f64, step: f64) -> BristleStep {
        let slips = NODES.map(|node| (self.slip)(node.mul_add(step, time)));
        let rates = slips.map(|slip| self.stiffness * slip.abs() / (self.level)(slip.abs()));
        // (1 + h A diag a) z = z₀ + h A γ at the nodes.
        let mut rows = [[0.0; 4]; 3];
        for (row, integrals) in rows.iter_mut().zip(&INTEGRALS) {
            row[3] = deflection;
            for (j, integral) in integrals.iter().enumerate() {
                row[j] = step * integral * rates[j];
                row[3] += step * integral * slips[j];
            }
        }
        for (i, row) in rows.iter_mut().enumerate() {
            row[i] += 1.0;
        }
        let deflections = solved(rows);
        let mut impulse = 0.0;
        for (j, (deflection, slip)) in deflections.iter().zip(slips).enumerate() {
            let rate = slip - rates[j] * deflection;
            let share = self.stiffness * deflection + self.damping * rate + self.viscous * slip;
            let load = (self.load)(NODES[j].mul_add(step, time));
            impulse += step * INTEGRALS[2][j] * load * share;
        }
        BristleStep { deflection: deflections[2], impulse }
    }
}

/// The solution of three equations with their right-hand sides in the last column, by elimination with pivots.
fn solved(mut rows: [[f64; 4]; 3]) -> [f64; 3] {
    for column in 0..3 {
        let pivot = (column..3)
            .max_by(|a, b| rows[*a][column].abs().total_cmp(&rows[*b][column].abs()))
            .unwrap_or(column);
        rows.swap(column, pivot);
        let from = rows[column];
        for row in &mut rows[column + 1..] {
            let factor = row[column] / from[column];
            for (entry, other) in row.iter_mut().zip(from).skip(column) {
                *entry -= factor * other;
            }
        }
    }
    let mut found = [0.0; 3];
    for row in (0..3).rev() {
        let known: f64 = (row + 1..3).map(|column| rows[row][column] * found[column]).sum();
        found[row] = (rows[row][3] - known) / rows[row][row];
    }
    found
}
