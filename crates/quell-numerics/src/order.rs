//! Sorting by numbers, compiled once.
//!
//! The sorting algorithms of the standard library are compiled again for each closure that compares, 5 to 20 kB of machine code each
//! time. Here they are compiled once, and each caller passes numbers.

/// Sorts numbers from the least to the largest, by [`f64::total_cmp`]. Numbers that it calls equal have the same bits, so that their order
/// does not matter.
#[inline(never)]
pub fn ascending(numbers: &mut [f64]) {
    numbers.sort_unstable_by(f64::total_cmp);
}

/// Sorts items from the least number to the largest, by [`f64::total_cmp`]; items with equal numbers keep their order.
///
/// ```
/// let mut peaks = [("b", 2.0), ("a", 1.0), ("c", 2.0)];
/// quell_numerics::order::ascending_by(&mut peaks, |peak| peak.1);
/// assert_eq!(peaks.map(|peak| peak.0), ["a", "b", "c"]);
/// ```
pub fn ascending_by<T>(items: &mut [T], number: impl Fn(&T) -> f64) {
    sort_by(items, number, false);
}

/// Sorts items from the largest number to the least, by [`f64::total_cmp`]; items with equal numbers keep their order.
pub fn descending_by<T>(items: &mut [T], number: impl Fn(&T) -> f64) {
    sort_by(items, number, true);
}

fn sort_by<T>(items: &mut [T], number: impl Fn(&T) -> f64, is_descending: bool) {
    let numbers: Vec<f64> = items.iter().map(number).collect();
    for (one, other) in swaps(&numbers, is_descending) {
        items.swap(one, other);
    }
}

/// The exchanges, one after the other, that sort items with these numbers.
#[inline(never)]
fn swaps(numbers: &[f64], is_descending: bool) -> Vec<(usize, usize)> {
    let mut places: Vec<usize> = (0..numbers.len()).collect();
    places.sort_by(|a, b| {
        let order = numbers[*a].total_cmp(&numbers[*b]);
        if is_descending { order.reverse() } else { order }
    });
    let mut swaps = Vec::new();
    // Each cycle of places in turn.
    let mut is_done = vec![false; places.len()];
    for first in 0..places.len() {
        let mut place = first;
        while !is_done[place] {
            is_done[place] = true;
            let next = places[place];
            if next != first {
                swaps.push((place, next));
            }
            place = next;
        }
    }
    swaps
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An item that cannot be cloned.
    #[derive(Debug, PartialEq)]
    struct Item {
        number: f64,
        place: usize,
    }

    #[test]
    fn items_are_in_the_order_of_a_stable_sort() {
        let mut state = 1_u64;
        for length in 0..60 {
            let numbers: Vec<f64> = (0..length)
                .map(|_| {
                    state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                    [0.0, -0.0, 1.0, -2.5, f64::NAN, f64::INFINITY, 7.0][(state >> 33) as usize % 7]
                })
                .collect();
            let items = || -> Vec<Item> {
                let numbered = numbers.iter().enumerate();
                numbered.map(|(place, &number)| Item { number, place }).collect()
            };
            let places = |items: &[Item]| items.iter().map(|item| item.place).collect::<Vec<_>>();
            let (mut found, mut expected) = (items(), items());
            ascending_by(&mut found, |item| item.number);
            expected.sort_by(|a, b| a.number.total_cmp(&b.number));
            assert_eq!(places(&found), places(&expected));
            let (mut found, mut expected) = (items(), items());
            descending_by(&mut found, |item| item.number);
            expected.sort_by(|a, b| b.number.total_cmp(&a.number));
            assert_eq!(places(&found), places(&expected));
            let (mut found, mut expected) = (numbers.clone(), numbers.clone());
            ascending(&mut found);
            expected.sort_by(f64::total_cmp);
            let bits = |numbers: &[f64]| numbers.iter().map(|n| n.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&found), bits(&expected));
        }
    }
}
