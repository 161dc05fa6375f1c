//! Completion records: the proof that a chunk is finished, and what its files must be.
//!
//! A reader of Zarr takes a missing chunk for fill values, silently; and a chunk may be cut short
//! behind our back. So a chunk counts only if its record is there, written after its files, and
//! every file has the length and the checksum (CRC-32C) that the record says.

use serde_json::{Map, Value as Json, json};

/// Length and checksum of one file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Seal {
    bytes: u64,
    checksum: u32,
}

impl Seal {
    /// The sum runs from the last byte to the first: a chunk ends with its own CRC-32C, and
    /// forwards the sum over both is the same number for every chunk.
    pub(super) fn of(bytes: &[u8]) -> Self {
        let backwards: Vec<u8> = bytes.iter().rev().copied().collect();
        Self { bytes: bytes.len() as u64, checksum: crc32c::crc32c(&backwards) }
    }
}

/// The files of a finished chunk, in the order of the plan's arrays.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Record {
    files: Vec<(String, Seal)>,
}

impl Record {
    pub(super) fn add(&mut self, key: &str, seal: Seal) {
        self.files.push((key.to_owned(), seal));
    }

    /// The seal of a file.
    pub(super) fn seal(&self, key: &str) -> Option<Seal> {
        self.files.iter().find(|(known, _)| known == key).map(|(_, seal)| *seal)
    }

    pub(super) fn text(&self) -> String {
        let files: Map<String, Json> = self
            .files
            .iter()
            .map(|(key, seal)| {
                let checksum = format!("{:08x}", seal.checksum);
                (key.clone(), json!({ "bytes": seal.bytes, "crc32c": checksum }))
            })
            .collect();
        format!("{}\n", json!({ "files": files }))
    }

    /// Reads a record; `None` where it is not a whole one.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let json: Json = serde_json::from_str(text).ok()?;
        let mut record = Self::default();
        for (key, seal) in json["files"].as_object()? {
            let checksum = u32::from_str_radix(seal["crc32c"].as_str()?, 16).ok()?;
            record.add(key, Seal { bytes: seal["bytes"].as_u64()?, checksum });
        }
        Some(record)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_reads_back_and_half_of_it_does_not() {
        let mut record = Record::default();
        record.add("efficiency/c/0/1", Seal::of(b"987654321"));
        record.add("efficiency_status/c/0/1", Seal::of(b""));
        // The check value of CRC-32C.
        assert_eq!(record.seal("efficiency/c/0/1").map(|seal| seal.checksum), Some(0xe306_9283));
        let text = record.text();
        assert_eq!(Record::parse(&text), Some(record));
        for length in 0..text.len() - 2 {
            assert_eq!(Record::parse(&text[..length]), None);
        }
    }

    #[test]
    fn chunks_of_one_length_have_seals_of_their_own() {
        // As the codec writes them: the content, then its CRC-32C, least byte first.
        let chunk = |content: &[u8]| [content, &crc32c::crc32c(content).to_le_bytes()].concat();
        assert_ne!(Seal::of(&chunk(b"one chunk")), Seal::of(&chunk(b"two chunk")));
        assert_ne!(Seal::of(&chunk(b"one chunk")), Seal::of(&chunk(b"one chunj")));
    }
}
