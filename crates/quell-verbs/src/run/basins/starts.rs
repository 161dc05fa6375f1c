//! The layout of the starts in a window of two numbers of the state.

use quell_numerics::interval::RealInterval;
use serde_json::{Value as Json, json};

use super::super::evenly;
use crate::complaint::Complaint;

/// Largest number of starts of one portrait.
pub const MOST_STARTS: usize = 10_000_000;

/// Layout of the starts in the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StartLayout {
    /// A grid from edge to edge, the first number running fastest.
    Grid {
        /// Number of values of the first number.
        columns: usize,
        /// Number of values of the second.
        rows: usize,
    },
    /// States drawn uniformly and independently.
    Sample {
        /// Number of states.
        count: usize,
        /// Seed of the sample: the same seed gives the same states.
        seed: u64,
    },
}

impl StartLayout {
    /// A complaint about numbers of starts that are not allowed, with an example of a grid.
    pub(in crate::run) fn refused(self, example: &str) -> Option<Complaint> {
        match self {
            Self::Grid { columns, rows } => {
                let count = columns.checked_mul(rows);
                let wrong =
                    columns < 2 || rows < 2 || count.is_none_or(|count| count > MOST_STARTS);
                let allowed = format!(
                    "NxM, two whole numbers of at least 2 and at most {MOST_STARTS} starts in total, such as {example}"
                );
                wrong.then(|| Complaint::option("--grid", format!("{columns}x{rows}"), allowed))
            }
            Self::Sample { count, .. } => {
                let allowed = format!("a whole number from 1 to {MOST_STARTS}");
                let wrong = !(1..=MOST_STARTS).contains(&count);
                wrong.then(|| Complaint::option("--sample", count, allowed))
            }
        }
    }

    /// The starts in a window of two numbers; on a grid the first number runs fastest.
    pub(in crate::run) fn places(self, [across, upwards]: [RealInterval; 2]) -> Vec<[f64; 2]> {
        match self {
            Self::Grid { columns, rows } => {
                let across = evenly(across, columns);
                let upwards = evenly(upwards, rows);
                upwards.iter().flat_map(|v| across.iter().map(|x| [*x, *v])).collect()
            }
            Self::Sample { count, seed } => {
                let mut state = seed;
                let mut between =
                    |range: RealInterval| range.lower + range.width() * uniform(&mut state);
                (0..count).map(|_| [between(across), between(upwards)]).collect()
            }
        }
    }

    /// The values of both axes of a grid.
    pub fn axes(self, [across, upwards]: [RealInterval; 2]) -> Option<[Vec<f64>; 2]> {
        match self {
            Self::Grid { columns, rows } => Some([evenly(across, columns), evenly(upwards, rows)]),
            Self::Sample { .. } => None,
        }
    }

    /// As words, such as "A grid of 21 × 15 starts".
    pub(in crate::run) fn words(self) -> String {
        match self {
            Self::Grid { columns, rows } => format!("A grid of {columns} × {rows} starts"),
            Self::Sample { count, seed } => format!("{count} random starts (seed {seed})"),
        }
    }

    /// The meaning of the shares and their bounds.
    pub(in crate::run) fn meaning(self) -> &'static str {
        match self {
            Self::Grid { .. } => {
                "each start represents its cell of the window; the bounds add or subtract half of each cell next to a basin boundary, \
                 and miss parts of a basin smaller than a cell; starts of unknown outcome count only towards the upper bound of the quiet \
                 fraction"
            }
            Self::Sample { .. } => {
                "the starts are a uniform random sample of the window, and the bounds are Wilson's 95 % interval; starts of unknown \
                 outcome count only towards the upper bound of the quiet fraction"
            }
        }
    }

    /// As JSON.
    pub(in crate::run) fn json(self) -> Json {
        match self {
            Self::Grid { columns, rows } => json!({ "grid": [columns, rows] }),
            Self::Sample { count, seed } => json!({ "sample": count, "seed": seed }),
        }
    }
}

/// A number in [0, 1) by SplitMix64 (Steele, Lea, Flood, 2014). Its few lines live here, so that no release of another
/// package can change its bits and a seed always gives the same starts.
fn uniform(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut mixed = *state;
    mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    mixed ^= mixed >> 31;
    (mixed >> 11) as f64 / (1_u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_generator_is_the_published_one() {
        // First two outputs of SplitMix64 from 1234567: 6457827717110365317, 3203168211198807973.
        let mut state = 1_234_567;
        for wanted in [6_457_827_717_110_365_317_u64, 3_203_168_211_198_807_973] {
            assert_eq!(uniform(&mut state), (wanted >> 11) as f64 / (1_u64 << 53) as f64);
        }
    }

    #[test]
    fn a_grid_reaches_its_edges() {
        assert_eq!(evenly(RealInterval::new(-1.0, 1.5), 11)[10], 1.5);
        let places = StartLayout::Grid { columns: 3, rows: 2 }
            .places([RealInterval::new(0.0, 1.0), RealInterval::new(2.0, 3.0)]);
        let row = |v: f64| [[0.0, v], [0.5, v], [1.0, v]];
        assert_eq!(places, [row(2.0), row(3.0)].concat());
    }
}
