//! Chunks of a grid: the boxes in which a map is computed and stored.
//!
//! Chunks form a regular grid as in Zarr: all have the same shape, and the last along an axis is cut off
//! at the end of the axis. Their shape depends on the study alone, never on the number of
//! threads, so that a map can be resumed on another machine.

/// Minimum number of chunks that a map should have: four for each of 32 threads.
const CHUNKS: f64 = 128.0;

/// Maximum seconds of a chunk: the work that an interruption may lose.
const LONGEST: f64 = 2.0;

/// Minimum seconds of a chunk: below, files cost more than points.
const SHORTEST: f64 = 0.05;

/// Number of points of a chunk that fills the SIMD lanes of the engine; fewer if they would take longer than a
/// chunk should.
const LANES_FULL: f64 = 64.0;

/// Maximum number of points of a chunk.
const MOST: f64 = 65_536.0;

/// The division of a grid into chunks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chunks {
    shape: Vec<usize>,
    chunk: Vec<usize>,
}

impl Chunks {
    /// Chunks of at most `most` points (at least one), of nearly the same length along every axis:
    /// neighbouring points are similar, which benefits readers and SIMD lanes.
    pub fn new(shape: &[usize], most: usize) -> Self {
        let mut chunk = shape.to_vec();
        while chunk.iter().product::<usize>() > most.max(1) {
            let Some(longest) = chunk.iter_mut().rev().max() else {
                break;
            };
            *longest = longest.div_ceil(2);
        }
        Self { shape: shape.to_vec(), chunk }
    }

    /// Number of points of the grid along each axis.
    pub fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// Number of points of a whole chunk along each axis.
    pub fn chunk_shape(&self) -> &[usize] {
        &self.chunk
    }

    /// Number of chunks.
    pub fn len(&self) -> usize {
        self.counts().product()
    }

    /// Whether the number is zero; never true.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Position of chunk `number` among the chunks along each axis.
    pub fn place(&self, number: usize) -> Vec<usize> {
        let mut after = self.len();
        self.counts()
            .map(|count| {
                after /= count;
                number / after % count
            })
            .collect()
    }

    /// The points of chunk `number`: position in a whole chunk and index in the grid, both in
    /// row-major order. Positions beyond the end of an axis are omitted.
    pub fn points(&self, number: usize) -> Vec<(usize, usize)> {
        let mut points = vec![(0, 0)];
        let axes = self.place(number).into_iter().zip(self.shape.iter().zip(&self.chunk));
        for (place, (shape, chunk)) in axes {
            let first = place * chunk;
            let last = (first + chunk).min(*shape);
            let inside = |&(position, index): &(usize, usize)| {
                (first..last).map(move |at| (position * chunk + at - first, index * shape + at))
            };
            points = points.iter().flat_map(inside).collect();
        }
        points
    }

    fn counts(&self) -> impl Iterator<Item = usize> + '_ {
        self.shape.iter().zip(&self.chunk).map(|(shape, chunk)| shape.div_ceil(*chunk))
    }
}

/// Number of points of a chunk, for a map of `points` points that take `seconds` each.
pub(super) fn points_per_chunk(points: usize, seconds: f64) -> usize {
    let chunk = (points as f64 * seconds / CHUNKS).clamp(SHORTEST, LONGEST);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 1 and MOST"
    )]
    let most = (chunk / seconds).max(LANES_FULL.min(LONGEST / seconds)).clamp(1.0, MOST) as usize;
    most
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_lies_in_one_chunk() {
        for (shape, most) in [
            (vec![7], 3),
            (vec![1], 5),
            (vec![5, 8], 6),
            (vec![3, 4, 5], 7),
            (vec![100, 1, 3], 1),
            (vec![4, 4], 1000),
        ] {
            let chunks = Chunks::new(&shape, most);
            let whole: usize = chunks.chunk_shape().iter().product();
            assert!(whole <= most);
            let total: usize = shape.iter().product();
            let mut seen = vec![0; total];
            for number in 0..chunks.len() {
                let points = chunks.points(number);
                assert!(!points.is_empty());
                for (position, index) in points {
                    assert!(position < whole);
                    seen[index] += 1;
                }
            }
            assert!(seen.iter().all(|count| *count == 1), "{shape:?} {most}");
        }
    }

    #[test]
    fn positions_are_those_of_a_whole_chunk() {
        let chunks = Chunks { shape: vec![3, 5], chunk: vec![2, 4] };
        assert_eq!(chunks.len(), 4);
        assert_eq!(chunks.place(3), [1, 1]);
        assert_eq!(chunks.points(1), [(0, 4), (4, 9)]);
        assert_eq!(chunks.points(2), [(0, 10), (1, 11), (2, 12), (3, 13)]);
    }

    #[test]
    fn chunks_are_many_where_points_are_dear_and_few_where_they_are_cheap() {
        // 40 000 points of 10 ms: 200 points take two seconds.
        assert_eq!(points_per_chunk(40_000, 0.01), 200);
        // 1000 points of 10 ms: enough to fill the lanes, although that gives few chunks.
        assert_eq!(points_per_chunk(1000, 0.01), 64);
        // 1000 points of 0.1 s: two seconds.
        assert_eq!(points_per_chunk(1000, 0.1), 20);
        // Points that each take longer than a chunk should.
        assert_eq!(points_per_chunk(10, 100.0), 1);
        // 1000 points of 20 µs: one chunk.
        assert!(points_per_chunk(1000, 2e-5) >= 1000);
    }
}
