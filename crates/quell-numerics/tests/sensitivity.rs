//! Derivatives of thresholds of maps whose thresholds are known in closed form.

use quell_numerics::continuation::sensitivity::{
    NoSensitivity, ThresholdPoint, ThresholdSensitivity, threshold_sensitivity,
};
use quell_numerics::continuation::threshold::BifurcationKind;
use quell_numerics::continuation::{Image, PeriodMap};
use quell_numerics::matrix::Matrix;

/// x ↦ f(x; a, p, q) with the distance x − q from a border.
struct Map<F>(F);

impl<F: Fn(f64, &[f64]) -> (f64, f64)> PeriodMap for Map<F> {
    type Signature = ();
    type Error = ();

    fn dimension(&self) -> usize {
        1
    }

    fn scale(&self) -> f64 {
        1.0
    }

    fn image(&self, state: &[f64], parameters: &[f64], _: Option<&()>) -> Result<Image<()>, ()> {
        let (image, slope) = (self.0)(state[0], parameters);
        let derivative = Matrix::from_fn(1, 1, |_, _| slope);
        let distance = state[0] - parameters[parameters.len() - 1];
        Ok(Image { state: vec![image], derivative, distance, signature: () })
    }
}

fn of<F: Fn(f64, &[f64]) -> (f64, f64)>(
    map: F,
    kinds: &[BifurcationKind],
    state: f64,
    parameters: &[f64],
) -> Result<ThresholdSensitivity, NoSensitivity> {
    let sizes = vec![1.0; parameters.len()];
    let (state, sizes) = (&[state], &sizes);
    threshold_sensitivity(&Map(map), &ThresholdPoint { kinds, held: &(), state, parameters, sizes })
}

fn rate(found: &ThresholdSensitivity, place: usize, of: usize) -> f64 {
    found.derivatives[place].as_ref().expect("regular")[of]
}

/// The logistic map with an offset, x ↦ r x(1 − x) + p, doubles its period at r = 3, where dr/dp = −3.
#[test]
fn a_flip_of_the_logistic_map() {
    let map = |x: f64, at: &[f64]| (at[0] * x * (1.0 - x) + at[1], at[0] * (1.0 - 2.0 * x));
    // A guess that is not quite on the threshold is corrected.
    let found = of(map, &[BifurcationKind::Flip], 0.66667, &[3.00001, 0.0]).expect("regular");
    assert!((found.determined[0] - 3.0).abs() < 1e-9, "{found:?}");
    assert!((rate(&found, 0, 0) + 3.0).abs() < 1e-8, "{found:?}");
}

/// x ↦ x + a − x² + p x has a fold at a = −p²/4, where φ_x − 1 is singular; a border at x = q is grazed at a = q² − p q.
#[test]
fn a_fold_a_grazing_and_where_they_meet() {
    let map = |x: f64, at: &[f64]| {
        let p = at[at.len() - 2];
        (x + at[0] - x * x + p * x, 1.0 - 2.0 * x + p)
    };
    let fold = of(map, &[BifurcationKind::Fold], 0.2, &[-0.04, 0.4, 0.0]).expect("regular");
    assert!((rate(&fold, 0, 0) + 0.2).abs() < 1e-9, "{fold:?}");
    let graze = of(map, &[BifurcationKind::Grazing], 0.5, &[0.05, 0.4, 0.5]).expect("regular");
    assert!((rate(&graze, 0, 0) + 0.5).abs() < 1e-9, "{graze:?}");
    assert!((rate(&graze, 1, 0) - 0.6).abs() < 1e-9, "{graze:?}");
    // Both at once at p = 2q, a = −q², with a second parameter that moves the slope: a and p are determined, q is not.
    let both = [BifurcationKind::Fold, BifurcationKind::Grazing];
    let tip = |x: f64, at: &[f64]| map(x, &[at[0], at[1], at[2]]);
    let found = of(tip, &both, 0.2, &[-0.04, 0.4, 0.2]).expect("regular");
    assert!((rate(&found, 0, 0) + 0.4).abs() < 1e-9, "{found:?}");
    assert!((rate(&found, 0, 1) - 2.0).abs() < 1e-9, "{found:?}");
}

#[test]
fn what_has_no_derivative_says_why() {
    let map = |x: f64, at: &[f64]| (at[0] * x + at[1], at[0]);
    let stable = of(map, &[BifurcationKind::Flip], 0.0, &[0.5, 0.0]);
    assert_eq!(stable, Err(NoSensitivity::NotCritical));
    let border = of(map, &[BifurcationKind::Border], 0.0, &[0.5, 0.0]);
    assert_eq!(border, Err(NoSensitivity::OtherKind));
    // A linear map has the multiplier 1 at a = 1 wherever it has fixed points at all.
    let singular = of(map, &[BifurcationKind::Fold], 0.0, &[1.0, 0.0]);
    assert!(singular.is_err(), "{singular:?}");
}
