//! Completion records: the proof that a chunk is finished, with the lengths and checksums of its files.
//!
//! Readers of Zarr silently replace a missing chunk by fill values, and files may be truncated by other programs. A chunk
//! therefore counts only if its record exists, which is written after its files, and every file has the length and the checksum
//! (CRC-32C) given in the record.

use serde_json::{Map, Value as Json, json};

/// Length and checksum of one file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Seal {
    bytes: u64,
    checksum: u32,
}

impl Seal {
    /// The checksum is computed from the last byte to the first: a chunk ends with its own CRC-32C, and the forward checksum
    /// of content and checksum together is the same number for every chunk.
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

    /// Reads a record; `None` if it is incomplete or invalid.
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
    fn a_record_reads_back_and_a_truncated_one_is_rejected() {
        let mut record = Record::default();
        record.add("residual_vibration/c/0/1", Seal::of(b"987654321"));
        record.add("residual_vibration_status/c/0/1", Seal::of(b""));
        // The check value of CRC-32C.
        assert_eq!(
            record.seal("residual_vibration/c/0/1").map(|seal| seal.checksum),
            Some(0xe306_9283)
        );
        let text = record.text();
        assert_eq!(Record::parse(&text), Some(record));
        for length in 0..text.len() - 2 {
            assert_eq!(Record::parse(&text[..length]), None);
        }
    }

    #[test]
    fn chunks_of_equal_length_have_different_seals() {
        // As the codec writes them: the content, then its CRC-32C, least significant byte first.
        let chunk = |content: &[u8]| [content, &crc32c::crc32c(content).to_le_bytes()].concat();
        assert_ne!(Seal::of(&chunk(b"one chunk")), Seal::of(&chunk(b"two chunk")));
        assert_ne!(Seal::of(&chunk(b"one chunk")), Seal::of(&chunk(b"one chunj")));
    }
}
