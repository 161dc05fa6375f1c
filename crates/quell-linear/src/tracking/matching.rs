//! Matches the eigenvalues of neighbouring values of a parameter.

use num_complex::Complex64;
use quell_numerics::polar::modulus;

use super::family::{Family, TrackedPoint, at};

/// A match is certain if it is closer to its prediction than this share of the distance to the next candidate: below a half, the
/// two cannot be exchanged. A smaller share costs steps, a larger one exchanges branches.
const CERTAIN: f64 = 0.4;

/// Distance over the largest eigenvalue below which two eigenvalues count as one: rounding moves a double eigenvalue by this.
const SAME: f64 = 1e-7;

/// The points of a piece with their eigenvalues in the order of branches, and further points where matching needs them.
pub(super) fn followed<F: Family>(
    family: &F,
    grid: Vec<TrackedPoint>,
    shortest: f64,
    most: usize,
) -> Vec<TrackedPoint> {
    let mut ahead: Vec<TrackedPoint> = grid;
    ahead.reverse();
    let mut done: Vec<TrackedPoint> = Vec::new();
    let mut computed = ahead.len();
    while let Some(mut next) = ahead.pop() {
        let Some(last) = done.last() else {
            sort(&mut next.eigenvalues);
            done.push(next);
            continue;
        };
        let predicted = predicted(&done, next.value);
        let (order, certain) = matched(&predicted, &next.eigenvalues, &last.eigenvalues);
        let short = (next.value - last.value).abs() <= 2.0 * shortest;
        if !certain && !short && computed < most {
            let middle = 0.5 * (last.value + next.value);
            if middle != last.value
                && middle != next.value
                && let Ok(between) = at(family, middle)
            {
                computed += 1;
                ahead.push(next);
                ahead.push(between);
                continue;
            }
        }
        next.eigenvalues = order.into_iter().map(|index| next.eigenvalues[index]).collect();
        done.push(next);
    }
    done
}

/// By frequency, then by growth rate.
fn sort(values: &mut [Complex64]) {
    values.sort_by(|a, b| a.im.total_cmp(&b.im).then(a.re.total_cmp(&b.re)));
}

/// Where the branches are expected: on the line through their last two points.
fn predicted(done: &[TrackedPoint], value: f64) -> Vec<Complex64> {
    match done {
        [.., before, last] if last.value != before.value => {
            let ratio = (value - last.value) / (last.value - before.value);
            // After a very short step its slope is mostly rounding.
            let ratio = if ratio.abs() > 8.0 { 0.0 } else { ratio };
            let pairs = last.eigenvalues.iter().zip(&before.eigenvalues);
            pairs.map(|(last, before)| last + (last - before) * ratio).collect()
        }
        [.., last] => last.eigenvalues.clone(),
        [] => Vec::new(),
    }
}

/// For each branch the index of its eigenvalue, and whether every match is certain.
fn matched(
    predicted: &[Complex64],
    values: &[Complex64],
    last: &[Complex64],
) -> (Vec<usize>, bool) {
    let n = values.len();
    let largest = values.iter().fold(0.0, |m: f64, z| m.max(modulus(*z)));
    let same = SAME * largest;
    let mut order = vec![usize::MAX; n];
    let mut taken = vec![false; n];
    let mut certain = true;
    // Branches with the clearest match choose first.
    let mut by_distance: Vec<(f64, usize)> = predicted
        .iter()
        .enumerate()
        .map(|(branch, expected)| {
            let nearest =
                values.iter().map(|z| modulus(z - expected)).fold(f64::INFINITY, f64::min);
            (nearest, branch)
        })
        .collect();
    by_distance.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    for (_, branch) in by_distance {
        let (mut best, mut second) = ((f64::INFINITY, usize::MAX), (f64::INFINITY, usize::MAX));
        for (index, value) in values.iter().enumerate() {
            let distance = modulus(value - predicted[branch]);
            if !taken[index] && distance < best.0 {
                second = best;
                best = (distance, index);
            } else if distance < second.0 {
                second = (distance, index);
            }
        }
        if best.1 == usize::MAX {
            continue;
        }
        order[branch] = best.1;
        taken[best.1] = true;
        let alike = second.1 != usize::MAX && modulus(values[second.1] - values[best.1]) <= same;
        let were_alike = last
            .iter()
            .enumerate()
            .any(|(other, z)| other != branch && modulus(z - last[branch]) <= same);
        if best.0 > CERTAIN * second.0 && !(alike && were_alike) {
            certain = false;
        }
    }
    (order, certain)
}
