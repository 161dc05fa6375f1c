//! Close approaches of two eigenvalues between the points of a piece.
//!
//! Where the frequencies of two weakly coupled motions cross, the structure can be unstable in a range of the parameter p that is
//! much narrower than any step. Near the crossing the two eigenvalues are those of a two-by-two matrix, and
//! D² = (λᵢ − λⱼ)² is analytic in p, unlike the eigenvalues, and nearly quadratic: its two roots in the complex plane of p are
//! the exceptional points of the pair. The midpoint of their real parts is the crossing, and their distance from it is the width
//! of the range in which the coupling acts. Interpolation by a parabola (Muller's method, restricted to real p) converges
//! to both within a few steps. Points at that width are then inserted around the crossing, unless no growth can be hidden there:
//! the sum of two eigenvalues is smooth, so that the coupling changes a growth rate by at most |D|/2.

use num_complex::Complex64;
use quell_numerics::interval::RealInterval;
use quell_numerics::order::{ascending, ascending_by};
use quell_numerics::polar::{modulus, square_root};

use super::family::{Family, TrackedPoint, at};

/// Steps of the search for one approach.
const MOST_STEPS: usize = 16;

/// The search ends where the last step is below this share of the width and the width changed by less than [`SAME_WIDTH`].
const CLOSE: f64 = 0.1;

/// Relative change of the width between two steps at the end of the search.
const SAME_WIDTH: f64 = 0.3;

/// |D|² over the square of the largest eigenvalue below which rounding decides it.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Distances of inserted points from an approach, in widths: the first one, and the ratio of the next ones.
const FIRST_DISTANCE: f64 = 0.5;
const RATIO: f64 = 2.0;

/// D² of a pair at one value of the parameter.
#[derive(Clone, Copy, Debug)]
struct PairSample {
    value: f64,
    square: Complex64,
    mean: Complex64,
    /// The larger real part.
    top: f64,
}

impl PairSample {
    fn of(value: f64, [first, second]: [Complex64; 2]) -> Self {
        let difference = first - second;
        Self {
            value,
            square: difference * difference,
            mean: 0.5 * (first + second),
            top: first.re.max(second.re),
        }
    }
}

/// An approach: the value of the parameter, the width of the range in which the coupling acts, and the mean eigenvalue there.
#[derive(Clone, Copy, Debug)]
struct Approach {
    value: f64,
    width: f64,
    mean: Complex64,
    /// Whether growth may be hidden between the points, so that further ones are needed.
    hides: bool,
}

/// A parabola through three samples of D², over x = p − origin.
struct Parabola {
    origin: f64,
    constant: Complex64,
    linear: Complex64,
    square: Complex64,
}

impl Parabola {
    fn through([a, b, c]: [&PairSample; 3]) -> Self {
        let first = (a.square - b.square) / (a.value - b.value);
        let second = (c.square - b.square) / (c.value - b.value);
        let square = (first - second) / (a.value - c.value);
        let linear = first - square * (a.value - b.value);
        Self { origin: b.value, constant: b.square, linear, square }
    }

    /// Where two eigenvalues are closest near the origin, and the width of the approach.
    fn approach(&self, wide: f64) -> Option<(f64, f64)> {
        let Self { origin, constant, linear, square } = *self;
        let root = square_root(linear * linear - square * constant * 4.0);
        let sign = if (linear.conj() * root).re < 0.0 { -1.0 } else { 1.0 };
        let large = -(linear + root * sign) * 0.5;
        let (near, far) = (constant / large, large / square);
        let finite = |z: Complex64| z.re.is_finite() && z.im.is_finite();
        if !finite(near) {
            // Both roots are at the origin.
            return (modulus(constant) == 0.0).then_some((origin, 0.0));
        }
        let together = finite(far) && modulus(far - near) <= wide;
        if together {
            let width = 0.5 * (far.re - near.re).abs().max(2.0 * far.im.abs().max(near.im.abs()));
            return Some((origin + 0.5 * (near.re + far.re), width));
        }
        Some((origin + near.re, near.im.abs()))
    }
}

/// The search for approaches in a piece.
pub(super) struct Search<'a, F> {
    family: &'a F,
    /// Shortest step.
    shortest: f64,
    /// Values that may still be computed.
    left: usize,
    known: Vec<Approach>,
    /// Approaches that were not examined because [`Search::left`] was used up.
    pub(super) unexamined: usize,
}

impl<'a, F: Family> Search<'a, F> {
    pub(super) fn new(family: &'a F, shortest: f64, most: usize) -> Self {
        Self { family, shortest, left: most, known: Vec::new(), unexamined: 0 }
    }

    /// Further points near every approach in a piece whose eigenvalues are in the order of branches.
    pub(super) fn points(&mut self, piece: &[TrackedPoint]) -> Vec<TrackedPoint> {
        let n = piece.first().map_or(0, |point| point.eigenvalues.len());
        let mut values = Vec::new();
        for first in 0..n {
            for second in 0..first {
                self.of_pair(piece, (first, second), &mut values);
            }
        }
        ascending(&mut values);
        let given = |value: f64| piece.iter().any(|point| point.value == value);
        values.retain(|value| !given(*value));
        values.dedup_by(|a, b| (*a - *b).abs() <= self.shortest);
        values.into_iter().filter_map(|value| at(self.family, value).ok()).collect()
    }

    /// Values near the approaches of one pair of branches.
    fn of_pair(
        &mut self,
        piece: &[TrackedPoint],
        (first, second): (usize, usize),
        values: &mut Vec<f64>,
    ) {
        let sample = |point: &TrackedPoint| {
            PairSample::of(point.value, [point.eigenvalues[first], point.eigenvalues[second]])
        };
        for k in 1..piece.len() {
            let (a, b) = (&piece[k - 1], &piece[k]);
            // The conjugate pair has the same approach.
            if sample(a).mean.im < 0.0 {
                continue;
            }
            let crossing = crossing(a, b, (first, second)).map(|guess| (guess, None));
            let third = piece.get(k + 1).or_else(|| piece.get(k.checked_sub(2)?)).map(sample);
            let curved = third.and_then(|third| predicted(&[sample(a), sample(b), third]));
            let curved = curved.map(|guess| (guess, third));
            for (guess, third) in [crossing, curved].into_iter().flatten() {
                let ends = [a, b].map(sample);
                if self.is_known(guess, &ends) || is_settled([a, b], (first, second)) {
                    continue;
                }
                if self.left < MOST_STEPS {
                    self.unexamined += 1;
                    continue;
                }
                let Some(found) = self.located(ends, third, guess) else { continue };
                self.known.push(found);
                if found.hides {
                    let ends = RealInterval::new(piece[0].value, piece[piece.len() - 1].value);
                    self.around(found, b.value - a.value, ends, values);
                }
            }
        }
    }

    fn is_known(&self, guess: f64, [a, b]: &[PairSample; 2]) -> bool {
        let step = b.value - a.value;
        let motion =
            modulus(a.mean - b.mean) + 0.5 * modulus(a.square).max(modulus(b.square)).sqrt();
        self.known.iter().any(|known| {
            (known.value - guess).abs() <= (0.5 * step).max(known.width)
                && modulus(known.mean - a.mean) <= motion
        })
    }

    /// The approach near `guess`; `None` where the eigenvalues do not approach each other between the ends.
    fn located(
        &mut self,
        ends: [PairSample; 2],
        third: Option<PairSample>,
        guess: f64,
    ) -> Option<Approach> {
        let (low, high) = (ends[0].value, ends[1].value);
        let mut samples: Vec<PairSample> = ends.into_iter().chain(third).collect();
        let (mut target, mut width) = (guess, f64::INFINITY);
        for _ in 0..MOST_STEPS {
            let nearest = samples.iter().map(|sample| (sample.value - target).abs());
            let step = nearest.fold(f64::INFINITY, f64::min);
            if step > self.shortest {
                let sample = self.sample(target, ends)?;
                samples.push(sample);
            }
            ascending_by(&mut samples, |a| (a.value - target).abs());
            samples.truncate(3);
            let [best, second, third] = samples.as_slice() else { return None };
            let parabola = Parabola::through([second, best, third]);
            let top = ends.iter().chain(&samples).map(|one| one.top).fold(f64::MIN, f64::max);
            let size = modulus(best.square).sqrt();
            let (next, next_width) = parabola.approach(high - low)?;
            let moved = (next - target).abs();
            let reach = size + modulus(parabola.square).sqrt() * (moved + next_width);
            let found = |hides| Approach { value: next, width: next_width, mean: best.mean, hides };
            if top + reach < 0.0 {
                return Some(found(false));
            }
            let rounded = size * size <= ROUNDING * (best.mean.norm_sqr() + size * size);
            let same = (next_width - width).abs() <= SAME_WIDTH * next_width;
            if rounded || step <= self.shortest || (moved <= CLOSE * next_width && same) {
                return Some(found(true));
            }
            if !(next >= low - (high - low) && next <= high + (high - low)) {
                return None;
            }
            (target, width) = (next, next_width);
        }
        let width = if width.is_finite() { width } else { 0.0 };
        Some(Approach { value: target, width, mean: samples[0].mean, hides: true })
    }

    /// D² of the two eigenvalues nearest to the mean expected at a value.
    fn sample(&mut self, value: f64, [a, b]: [PairSample; 2]) -> Option<PairSample> {
        self.left = self.left.saturating_sub(1);
        let mut values = at(self.family, value).ok()?.eigenvalues;
        let share = (value - a.value) / (b.value - a.value);
        let mean = a.mean + (b.mean - a.mean) * share;
        ascending_by(&mut values, |x| modulus(x - mean));
        match values.as_slice() {
            [first, second, ..] => Some(PairSample::of(value, [*first, *second])),
            _ => None,
        }
    }

    /// Adds values around an approach, from its width to the step.
    fn around(&mut self, found: Approach, step: f64, ends: RealInterval, values: &mut Vec<f64>) {
        let width = found.width.max(self.shortest);
        let mut distances = vec![0.0];
        let mut distance = FIRST_DISTANCE * width;
        while distance < step {
            distances.extend([distance, -distance]);
            distance *= RATIO;
        }
        let new = distances.into_iter().map(|distance| found.value + distance);
        let new: Vec<f64> =
            new.filter(|value| *value > ends.lower && *value < ends.upper).collect();
        self.left = self.left.saturating_sub(new.len());
        values.extend(new);
    }
}

/// Where the straight lines of two branches between neighbouring points are closest, if that is between the points.
fn crossing(a: &TrackedPoint, b: &TrackedPoint, (i, j): (usize, usize)) -> Option<f64> {
    let before = a.eigenvalues[i] - a.eigenvalues[j];
    let after = b.eigenvalues[i] - b.eigenvalues[j];
    let change = after - before;
    let share = -(before.conj() * change).re / change.norm_sqr();
    (share > 0.0 && share < 1.0).then_some(a.value + share * (b.value - a.value))
}

/// Where the parabola of D² through three neighbouring points has an approach, if that is narrower than a step and near the first
/// two of them.
fn predicted(samples: &[PairSample; 3]) -> Option<f64> {
    let [a, b, third] = samples;
    let step = b.value - a.value;
    let (value, width) = Parabola::through([a, b, third]).approach(step)?;
    let near = value >= a.value && value <= b.value;
    (near && width <= 0.5 * step).then_some(value)
}

/// Whether the verdict between two neighbouring points is unstable regardless of a pair of branches: by the mean of the pair, or by
/// another branch.
fn is_settled(points: [&TrackedPoint; 2], (i, j): (usize, usize)) -> bool {
    let grows = |pick: &dyn Fn(&TrackedPoint) -> f64| {
        points.iter().all(|point| pick(point) > point.growth.error)
    };
    if grows(&|point| 0.5 * (point.eigenvalues[i].re + point.eigenvalues[j].re)) {
        return true;
    }
    let is_of_pair = |branch: usize| {
        let z = points[0].eigenvalues[branch];
        [i, j].iter().any(|&own| {
            let own = points[0].eigenvalues[own];
            modulus(z - own.conj()) <= 1e-9 * modulus(own)
        })
    };
    let others = (0..points[0].eigenvalues.len()).filter(|branch| ![i, j].contains(branch));
    others
        .filter(|branch| !is_of_pair(*branch))
        .any(|branch| grows(&|point| point.eigenvalues[branch].re))
}

#[cfg(test)]
mod tests {
    use quell_numerics::eigen::EigenError;
    use quell_numerics::matrix::Matrix;

    use super::super::{StabilityChange, Tracked, track};
    use super::*;

    /// Unit masses on springs (kᵢ), the first of which is the parameter, with a weak circulatory coupling of the first to each
    /// other: +c in the first row of K and −c in the first column.
    struct Coupled {
        springs: Vec<f64>,
        coupling: f64,
        damping: f64,
    }

    impl Family for Coupled {
        type Error = EigenError;

        fn matrix(&self, value: f64) -> Result<Matrix, EigenError> {
            let n = self.springs.len();
            let stiffness = |i: usize, j: usize| match (i, j) {
                (0, 0) => value,
                _ if i == j => self.springs[i],
                (0, _) => self.coupling,
                (_, 0) => -self.coupling,
                _ => 0.0,
            };
            Ok(Matrix::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
                (true, _) => f64::from(u8::from(j == i + n)),
                (false, true) => -stiffness(i - n, j),
                (false, false) if i == j => -self.damping,
                (false, false) => 0.0,
            }))
        }

        fn overflows(why: EigenError) -> EigenError {
            why
        }
    }

    fn tracked(springs: &[f64], coupling: f64, damping: f64) -> Tracked<EigenError> {
        let family = Coupled { springs: springs.to_vec(), coupling, damping };
        track(&family, RealInterval::new(0.5, 50.0), 129).expect("eigenvalues exist")
    }

    fn instabilities(found: &Tracked<EigenError>) -> Vec<f64> {
        let found = found.thresholds.iter().filter(|found| found.change == StabilityChange::Hopf);
        found.map(|found| found.value).collect()
    }

    /// Two masses are unstable where |k − k₂| < 2 √(c² − k₂ d²) to first order.
    #[test]
    fn a_narrow_range_of_instability_is_found() {
        for coupling in [1e-3, 1e-4, 1e-5] {
            for spring in [3.3, 7.123_456, 20.004, 41.7] {
                let damping = 0.05 * coupling;
                let found = tracked(&[0.0, spring], coupling, damping);
                let values = instabilities(&found);
                let half = 2.0 * (coupling * coupling - spring * damping * damping).sqrt();
                assert_eq!((values.len(), found.unexamined), (2, 0), "{coupling} {values:?}");
                for (value, wanted) in values.iter().zip([spring - half, spring + half]) {
                    assert!((value - wanted).abs() < 0.02 * half, "{coupling}: {values:?}");
                }
            }
        }
    }

    /// The first mass is unstable near the frequency of every other, two of which it passes between neighbouring points.
    #[test]
    fn every_crossing_of_several_motions_is_found() {
        let springs = [0.0, 11.3, 30.0, 11.45, 44.0];
        for coupling in [1e-2, 1e-3, 1e-4] {
            let values = instabilities(&tracked(&springs, coupling, 1e-3 * coupling));
            assert_eq!(values.len(), 8, "{coupling} {values:?}");
            for spring in &springs[1..] {
                let near = values.iter().filter(|value| (*value - spring).abs() < 2.1 * coupling);
                assert_eq!(near.count(), 2, "{coupling} {spring} {values:?}");
            }
        }
    }

    #[test]
    fn motions_without_coupling_or_with_much_damping_hide_nothing() {
        let found = tracked(&[0.0, 3.3, 8.0], 0.0, 1e-6);
        assert!(found.thresholds.is_empty(), "{:?}", found.thresholds);
        let found = tracked(&[0.0, 3.3, 8.0], 1e-4, 0.1);
        assert!(found.thresholds.is_empty() && found.pieces[0].len() < 160);
    }
}
