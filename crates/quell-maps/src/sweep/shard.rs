//! One of several equal parts of a map.
//!
//! Shard k of n consists of the chunks k − 1, k − 1 + n, k − 1 + 2n, …: neighbouring chunks take about
//! the same time, so that every shard gets its share of the slow ones. Chunks depend on the study
//! alone, and so do shards.

use std::fmt;

use super::chunks::Chunks;
use crate::complaint::Complaint;

/// Largest number of shards of a map.
const MOST_SHARDS: usize = 1_000_000;

/// Part `number` of `of` parts, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    number: usize,
    of: usize,
}

impl Shard {
    /// Parses the value `k/n` of the option `option`, such as `3/16`.
    ///
    /// # Errors
    /// A complaint about any other text.
    pub fn parse(text: &str, option: &'static str) -> Result<Self, Box<Complaint>> {
        let parts = text.split_once('/').and_then(|(number, of)| {
            Some((number.trim().parse::<usize>().ok()?, of.trim().parse::<usize>().ok()?))
        });
        match parts {
            Some((number, of)) if (1..=of).contains(&number) && of <= MOST_SHARDS => {
                Ok(Self { number, of })
            }
            _ => {
                let allowed = format!(
                    "k/n with whole numbers, k from 1 to n and n at most {MOST_SHARDS}, such as 3/16"
                );
                Err(Box::new(Complaint::option(option, text, allowed)))
            }
        }
    }

    /// Its number, from 1.
    pub fn number(self) -> usize {
        self.number
    }

    /// Number of shards.
    pub fn of(self) -> usize {
        self.of
    }

    /// Its chunks in order; may be empty if there are more shards than chunks.
    pub fn chunks(self, chunks: &Chunks) -> Vec<usize> {
        (self.number - 1..chunks.len()).step_by(self.of).collect()
    }

    /// The number of the shard that contains chunk `chunk`, for the same number of shards.
    pub fn number_of(self, chunk: usize) -> usize {
        chunk % self.of + 1
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_chunk_is_in_one_shard() {
        let chunks = Chunks::new(&[7, 9], 6);
        for of in [1, 2, 3, chunks.len(), chunks.len() + 5] {
            let mut seen = vec![0; chunks.len()];
            for number in 1..=of {
                let shard = Shard::parse(&format!("{number}/{of}"), "--shard").expect("a shard");
                for chunk in shard.chunks(&chunks) {
                    assert_eq!(shard.number_of(chunk), number);
                    seen[chunk] += 1;
                }
            }
            assert!(seen.iter().all(|count| *count == 1), "{of}: {seen:?}");
        }
    }

    #[test]
    fn what_is_no_shard_is_refused() {
        for text in ["", "3", "0/4", "5/4", "1/0", "-1/4", "1.5/4", "a/b", "1/2/3", "1/1000001"] {
            assert!(Shard::parse(text, "--shard").is_err(), "{text}");
        }
        assert_eq!(
            Shard::parse(" 3/16 ", "--shard").map(|shard| shard.to_string()),
            Ok("3/16".into())
        );
    }
}
