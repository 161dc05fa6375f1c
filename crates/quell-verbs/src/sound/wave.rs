//! Sound files: RIFF/WAVE with one channel of 16-bit samples (PCM), and a comment.
//!
//! The header has 44 bytes, and the samples follow it immediately. The comment is in a list `INFO` after the samples (`ICMT`,
//! and the program in `ISFT`), where players that do not read it do not find it in their way.
//!
//! Reference: IBM and Microsoft, *Multimedia Programming Interface and Data Specifications 1.0* (1991).

/// Bytes per sample.
const WIDTH: u16 = 2;

/// The bytes of a file. The caller limits the number of samples, so that the lengths fit into 32 bits.
pub(super) fn bytes(samples: &[i16], rate: u32, comment: &str) -> Vec<u8> {
    let program = concat!("quell ", env!("CARGO_PKG_VERSION"));
    let info = [b"INFO".to_vec(), text(*b"ISFT", program), text(*b"ICMT", comment)].concat();
    let before = [b"WAVE".to_vec(), chunk(*b"fmt ", &format(rate))].concat();
    let after = chunk(*b"LIST", &info);
    let data = samples.len() * usize::from(WIDTH);
    let content = before.len() + 8 + data + after.len();
    let mut file = Vec::with_capacity(8 + content);
    file.extend(head(*b"RIFF", content));
    file.extend(before);
    file.extend(head(*b"data", data));
    file.extend(samples.iter().flat_map(|sample| sample.to_le_bytes()));
    file.extend(after);
    file
}

/// The format: PCM, one channel, the rate in samples and in bytes per second, bytes and bits per sample.
fn format(rate: u32) -> Vec<u8> {
    let (pcm, channels) = (1_u16, 1_u16);
    [
        &pcm.to_le_bytes()[..],
        &channels.to_le_bytes(),
        &rate.to_le_bytes(),
        &(rate * u32::from(WIDTH)).to_le_bytes(),
        &WIDTH.to_le_bytes(),
        &(8 * WIDTH).to_le_bytes(),
    ]
    .concat()
}

/// A text with its final zero.
fn text(name: [u8; 4], text: &str) -> Vec<u8> {
    chunk(name, &[text.as_bytes(), &[0]].concat())
}

/// A chunk: name, length, content; a content of odd length is followed by a zero that its length does not count.
fn chunk(name: [u8; 4], content: &[u8]) -> Vec<u8> {
    let padding = &[0][..content.len() % 2];
    [&head(name, content.len()), content, padding].concat()
}

/// Name and length of a chunk.
fn head(name: [u8; 4], length: usize) -> [u8; 8] {
    let length = u32::try_from(length).unwrap_or(u32::MAX).to_le_bytes();
    std::array::from_fn(|index| if index < 4 { name[index] } else { length[index - 4] })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_is_that_of_the_specification() {
        let file = bytes(&[1, -2, 3], 44_100, "odd");
        let header: [u8; 36] = [
            b'W', b'A', b'V', b'E', b'f', b'm', b't', b' ', 16, 0, 0,
            0, // length of the format
            1, 0, 1, 0, // PCM, one channel
            0x44, 0xac, 0, 0, 0x88, 0x58, 1, 0, // 44100 samples and 88200 bytes per second
            2, 0, 16, 0, // bytes and bits per sample
            b'd', b'a', b't', b'a', 6, 0, 0, 0,
        ];
        assert_eq!(file[..4], *b"RIFF");
        assert_eq!(length(&file[4..]), file.len() - 8);
        assert_eq!(file[8..44], header);
        assert_eq!(file[44..50], [1, 0, 0xfe, 0xff, 3, 0]);
        let list = &file[50..];
        assert_eq!((&list[..4], length(&list[4..])), (&b"LIST"[..], list.len() - 8));
        assert!(list[8..].starts_with(b"INFOISFT") && list.ends_with(b"ICMT\x04\0\0\0odd\0"));
        // Chunks begin at even places.
        assert!(bytes(&[], 44_100, "even").ends_with(b"ICMT\x05\0\0\0even\0\0"));
    }

    fn length(bytes: &[u8]) -> usize {
        let four = bytes[..4].try_into().expect("four bytes");
        u32::from_le_bytes(four).try_into().expect("a length")
    }
}
