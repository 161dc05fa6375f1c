//! Sequences whose beginning is arbitrary.

use std::cmp::Ordering;

/// Where the lexicographically least rotation of a sequence begins, by the keys of its entries; 0 of an empty one. It takes a time
/// proportional to the length: of two candidates the one that loses after k equal entries excludes the k that follow it, too.
///
/// ```
/// use quell_numerics::cyclic::least_rotation;
///
/// assert_eq!(least_rotation(b"cabcab", |letter| *letter), 1);
/// ```
pub fn least_rotation<T, K: Ord>(sequence: &[T], key: impl Fn(&T) -> K) -> usize {
    let count = sequence.len();
    let (mut first, mut second, mut equal) = (0, 1, 0);
    while first < count && second < count && equal < count {
        let [one, other] = [first, second].map(|from| key(&sequence[(from + equal) % count]));
        match one.cmp(&other) {
            Ordering::Equal => {
                equal += 1;
                continue;
            }
            Ordering::Greater => first += equal + 1,
            Ordering::Less => second += equal + 1,
        }
        if first == second {
            second += 1;
        }
        equal = 0;
    }
    first.min(second)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix;

    #[test]
    fn it_is_the_least_of_all_rotations() {
        let mut random = SplitMix::new(7);
        for length in 0..40_usize {
            for letters in 1..4_u64 {
                let sequence: Vec<u64> = (0..length).map(|_| random.bits() % letters).collect();
                let rotated = |from: usize| [&sequence[from..], &sequence[..from]].concat();
                let least = (0..length).min_by_key(|from| rotated(*from)).unwrap_or(0);
                assert_eq!(least_rotation(&sequence, |letter| *letter), least, "{sequence:?}");
            }
        }
    }
}
