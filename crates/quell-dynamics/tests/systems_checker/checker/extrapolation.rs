//! One step of the extrapolated midpoint rule (Gragg, Bulirsch, Stoer) of order 8.

/// Numbers of substeps of the midpoint rule; all even, so that the error is a series in the square of the substep.
const SUBSTEPS: [u32; 4] = [2, 4, 6, 8];

/// Steps whose difference from the next lower order exceeds this value are divided.
///
/// With substeps of a tenth of a radian and below the error of order 8 is three orders of magnitude smaller.
const LARGEST_DIFFERENCE: f64 = 1e-11;

/// Buffers of the extrapolated midpoint rule.
#[derive(Clone, Debug)]
pub(super) struct Extrapolation {
    /// f at the start of a step.
    first: Vec<f64>,
    slope: Vec<f64>,
    state: Vec<f64>,
    /// Increments over the step at two consecutive points of the midpoint rule.
    even: Vec<f64>,
    odd: Vec<f64>,
    /// Extrapolated increments of the latest row of the scheme, one column for each order.
    table: Vec<Vec<f64>>,
}

impl Extrapolation {
    /// For states of a given size.
    pub(super) fn new(size: usize) -> Self {
        let zeros = vec![0.0; size];
        Self {
            first: zeros.clone(),
            slope: zeros.clone(),
            state: zeros.clone(),
            even: zeros.clone(),
            odd: zeros.clone(),
            table: vec![zeros; SUBSTEPS.len()],
        }
    }

    /// Advances ẏ = f(t, y) from one time to another in one step, or in two halves where one is not enough.
    pub(super) fn advance(
        &mut self,
        slope: &mut impl FnMut(f64, &[f64], &mut [f64]),
        from: f64,
        to: f64,
        state: &mut [f64],
    ) {
        let difference = self.step(slope, from, to - from, state);
        if difference > LARGEST_DIFFERENCE && to - from > 1e-6 {
            let middle = 0.5 * (from + to);
            self.advance(slope, from, middle, state);
            self.advance(slope, middle, to, state);
            return;
        }
        let increment = &self.table[SUBSTEPS.len() - 1];
        for (value, change) in state.iter_mut().zip(increment) {
            *value += change;
        }
    }

    /// Computes the increment over a step into the last column of the table; returns its difference from the next lower order.
    fn step(
        &mut self,
        slope: &mut impl FnMut(f64, &[f64], &mut [f64]),
        time: f64,
        length: f64,
        state: &[f64],
    ) -> f64 {
        slope(time, state, &mut self.first);
        let mut difference = 0.0_f64;
        for row in 0..SUBSTEPS.len() {
            self.midpoint(slope, time, length, state, row);
            // Aitken and Neville: `table[c]` holds column c of the row before, `carried` that of this row.
            let mut carried = self.even.clone();
            for column in 1..=row {
                let ratio = f64::from(SUBSTEPS[row]) / f64::from(SUBSTEPS[row - column]);
                let divisor = ratio * ratio - 1.0;
                let lower = &mut self.table[column - 1];
                difference = 0.0;
                for (new, old) in carried.iter_mut().zip(lower.iter_mut()) {
                    let change = (*new - *old) / divisor;
                    *old = *new;
                    *new += change;
                    difference = difference.max(change.abs());
                }
            }
            self.table[row] = carried;
        }
        difference
    }

    /// The increment over a step by the midpoint rule, into `even`.
    fn midpoint(
        &mut self,
        slope: &mut impl FnMut(f64, &[f64], &mut [f64]),
        time: f64,
        length: f64,
        state: &[f64],
        row: usize,
    ) {
        let count = SUBSTEPS[row];
        let h = length / f64::from(count);
        self.even.fill(0.0);
        for (odd, first) in self.odd.iter_mut().zip(&self.first) {
            *odd = h * first;
        }
        for i in 1..count {
            for ((value, start), odd) in self.state.iter_mut().zip(state).zip(&self.odd) {
                *value = start + odd;
            }
            slope(time + f64::from(i) * h, &self.state, &mut self.slope);
            for (even, slope) in self.even.iter_mut().zip(&self.slope) {
                *even += 2.0 * h * slope;
            }
            std::mem::swap(&mut self.even, &mut self.odd);
        }
        // After the last exchange the newest increment is in `odd`.
        std::mem::swap(&mut self.even, &mut self.odd);
    }
}
