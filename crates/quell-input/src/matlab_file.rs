//! Numeric variables of a MAT-file of level 5 (MATLAB 5 to 7.2, Octave, SciPy) as a table.
//!
//! Each real vector of the greatest length is a column with the name of its variable, and each column of a real matrix of as many rows one
//! with a number: `A_1`, `A_2`. Other variables are listed in words.
//!
//! Source: The `MathWorks`, MAT-File Format (level 5). A file is a header of 128 bytes and a sequence of elements, each a tag (type, number of
//! bytes) with its data, padded to eight bytes; a short element has both in four bytes and up to four bytes of data. A compressed element
//! contains one element; what it expands to is bounded.

use std::fmt::{self, Write as _};
use std::io::Read as _;

use flate2::read::ZlibDecoder;

/// What every file begins with.
const BEGIN: &[u8] = b"MATLAB 5.0 MAT-file";

/// Length of the header.
const HEADER: usize = 128;

/// The most bytes of all expanded elements: eight times the largest file, so that a small one cannot fill the memory.
const MOST_BYTES: usize = 128 << 20;

/// The most columns of a matrix that are read: more are an image or a field, and it is listed instead.
const MOST_COLUMNS: usize = 64;

/// Types of elements.
const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;

/// Classes of arrays of numbers: double to unsigned 64-bit.
const NUMBERS: std::ops::RangeInclusive<u8> = 6..=15;

/// Names of the other classes.
const CLASSES: [&str; 6] = ["variable", "cell array", "struct", "object", "text", "sparse matrix"];

/// Why a MATLAB file cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WrongMatlab {
    /// It ends within an element.
    Truncated {
        /// Place of the element in bytes.
        byte: usize,
    },
    /// An element is not what the format allows.
    Element {
        /// Place of the element in bytes.
        byte: usize,
        /// What it is.
        what: &'static str,
    },
    /// Its elements expand to more than is read.
    TooLarge,
    /// No variable is a vector of numbers; the variables in words.
    NoVector(String),
}

impl fmt::Display for WrongMatlab {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Truncated { byte } => {
                write!(f, "is truncated: it ends within the element at byte {byte}")
            }
            Self::Element { byte, what } => {
                write!(f, "is damaged: the element at byte {byte} {what}")
            }
            Self::TooLarge => write!(f, "expands to more than {} MiB", MOST_BYTES >> 20),
            Self::NoVector(found) if found.is_empty() => f.write_str("has no variables"),
            Self::NoVector(found) => write!(f, "has no vector of numbers; it has {found}"),
        }
    }
}

impl std::error::Error for WrongMatlab {}

/// Whether bytes are a MAT-file of level 5.
pub fn is_one(bytes: &[u8]) -> bool {
    bytes.starts_with(BEGIN) && bytes.len() >= HEADER
}

/// The variables of a file.
#[derive(Debug)]
pub struct MatlabTable {
    /// Names in the first line, then a line for each element, with commas.
    pub text: String,
    /// The variables that are no columns, in words.
    pub others: Vec<String>,
}

/// A column.
struct MatlabColumn {
    name: String,
    values: Vec<f64>,
}

/// The table of a file.
///
/// # Errors
/// The file is damaged, too large, or has no vectors.
pub fn table(bytes: &[u8]) -> Result<MatlabTable, WrongMatlab> {
    let order = if bytes.get(126..128) == Some(b"MI") { ByteOrder::Big } else { ByteOrder::Little };
    let mut reader =
        MatlabReader { order, budget: MOST_BYTES, columns: Vec::new(), others: Vec::new() };
    reader.elements(&bytes[HEADER..], HEADER)?;
    let MatlabReader { columns, mut others, .. } = reader;
    let longest = columns.iter().map(|column| column.values.len()).max().unwrap_or(0);
    if longest < 2 {
        return Err(WrongMatlab::NoVector(others.join(", ")));
    }
    let (columns, shorter): (Vec<_>, Vec<_>) =
        columns.into_iter().partition(|column| column.values.len() == longest);
    others.extend(shorter.iter().map(|column| match column.values.len() {
        1 => format!("the number {}", column.name),
        length => format!("{} of {length} elements", column.name),
    }));
    let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
    let mut text = names.join(",");
    for row in 0..longest {
        for (place, column) in columns.iter().enumerate() {
            let before = if place == 0 { '\n' } else { ',' };
            let _ = write!(text, "{before}{:?}", column.values[row]);
        }
    }
    Ok(MatlabTable { text, others })
}

#[derive(Clone, Copy, Debug)]
enum ByteOrder {
    Little,
    Big,
}

impl ByteOrder {
    /// The bytes of a number, least first.
    fn bytes<const N: usize>(self, bytes: &[u8]) -> [u8; N] {
        let mut own = [0; N];
        own.copy_from_slice(&bytes[..N]);
        if matches!(self, Self::Big) {
            own.reverse();
        }
        own
    }

    fn word(self, bytes: &[u8]) -> u32 {
        u32::from_le_bytes(self.bytes(bytes))
    }
}

/// An element: its type, its data, and the length of both with the padding.
struct MatlabElement<'b> {
    kind: u32,
    data: &'b [u8],
    length: usize,
}

struct MatlabReader {
    order: ByteOrder,
    /// How many bytes may still be expanded.
    budget: usize,
    columns: Vec<MatlabColumn>,
    others: Vec<String>,
}

impl MatlabReader {
    /// The element at the start of some bytes; `at` is their place in the file.
    fn element<'b>(&self, bytes: &'b [u8], at: usize) -> Result<MatlabElement<'b>, WrongMatlab> {
        let truncated = || WrongMatlab::Truncated { byte: at };
        let tag = bytes.get(..8).ok_or_else(truncated)?;
        let first = self.order.word(tag);
        let short = first >> 16;
        if short != 0 {
            let data = tag.get(4..4 + short as usize);
            let data =
                data.ok_or(WrongMatlab::Element { byte: at, what: "is longer than a short one" })?;
            return Ok(MatlabElement { kind: first & 0xffff, data, length: 8 });
        }
        let size = self.order.word(&tag[4..]) as usize;
        let data = bytes.get(8..8_usize.saturating_add(size)).ok_or_else(truncated)?;
        let padded = if first == COMPRESSED { size } else { size.next_multiple_of(8) };
        Ok(MatlabElement { kind: first, data, length: (8 + padded).min(bytes.len()) })
    }

    fn elements(&mut self, mut bytes: &[u8], mut at: usize) -> Result<(), WrongMatlab> {
        while !bytes.is_empty() {
            let element = self.element(bytes, at)?;
            match element.kind {
                MATRIX => self.array(element.data, at)?,
                COMPRESSED => {
                    let expanded = self.expanded(element.data, at)?;
                    let inner = self.element(&expanded, at)?;
                    if inner.kind == MATRIX {
                        self.array(inner.data, at)?;
                    }
                }
                _ => {}
            }
            bytes = &bytes[element.length..];
            at += element.length;
        }
        Ok(())
    }

    fn expanded(&mut self, data: &[u8], at: usize) -> Result<Vec<u8>, WrongMatlab> {
        let mut bytes = Vec::new();
        let most = self.budget as u64 + 1;
        let read = ZlibDecoder::new(data).take(most).read_to_end(&mut bytes);
        read.map_err(|_| WrongMatlab::Element { byte: at, what: "is not compressed as it says" })?;
        self.budget = self.budget.checked_sub(bytes.len()).ok_or(WrongMatlab::TooLarge)?;
        Ok(bytes)
    }

    /// Reads an array: flags, dimensions, name, real part.
    fn array(&mut self, mut bytes: &[u8], at: usize) -> Result<(), WrongMatlab> {
        let wrong = |what| WrongMatlab::Element { byte: at, what };
        let mut parts = Vec::new();
        while parts.len() < 4 && !bytes.is_empty() {
            let part = self.element(bytes, at)?;
            bytes = &bytes[part.length..];
            parts.push(part);
        }
        let [flags, dimensions, name, rest @ ..] = &parts[..] else {
            return Err(wrong("is an array without dimensions and name"));
        };
        if flags.data.len() < 8 {
            return Err(wrong("is an array without flags"));
        }
        let word = self.order.word(flags.data);
        let (class, is_complex) = ((word & 0xff) as u8, word & 0x800 != 0);
        let name: String = String::from_utf8_lossy(name.data)
            .chars()
            .map(|c| if c.is_control() || matches!(c, ',' | '"') { '_' } else { c })
            .collect();
        let sizes: Vec<usize> =
            dimensions.data.chunks_exact(4).map(|size| self.order.word(size) as usize).collect();
        let [rows, columns] = sizes[..] else {
            self.others.push(format!("{name} of {} dimensions", sizes.len()));
            return Ok(());
        };
        let (length, count) = if rows == 1 { (columns, 1) } else { (rows, columns) };
        let is_table = NUMBERS.contains(&class) && !is_complex && count <= MOST_COLUMNS;
        if !is_table || length == 0 || count == 0 {
            let kind = CLASSES.get(usize::from(class)).copied().unwrap_or("matrix");
            let kind = if is_complex { "complex array" } else { kind };
            self.others.push(format!("the {kind} {name} of {rows} × {columns}"));
            return Ok(());
        }
        let [real, ..] = rest else { return Err(wrong("is an array without numbers")) };
        let values = self.numbers(real).ok_or_else(|| wrong("has numbers of an unknown type"))?;
        if Some(values.len()) != length.checked_mul(count) {
            return Err(wrong("has another number of elements than its dimensions say"));
        }
        for (place, values) in values.chunks_exact(length).enumerate() {
            let name = if count == 1 { name.clone() } else { format!("{name}_{}", place + 1) };
            self.columns.push(MatlabColumn { name, values: values.to_vec() });
        }
        Ok(())
    }

    /// The numbers of an element; `None` if its type has none.
    fn numbers(&self, element: &MatlabElement<'_>) -> Option<Vec<f64>> {
        let order = self.order;
        let each = |size: usize, value: &dyn Fn(&[u8]) -> f64| -> Vec<f64> {
            element.data.chunks_exact(size).map(value).collect()
        };
        #[expect(
            clippy::cast_precision_loss,
            reason = "as MATLAB converts whole numbers to doubles"
        )]
        Some(match element.kind {
            1 => each(1, &|b| f64::from(i8::from_le_bytes(order.bytes(b)))),
            2 => each(1, &|b| f64::from(b[0])),
            3 => each(2, &|b| f64::from(i16::from_le_bytes(order.bytes(b)))),
            4 => each(2, &|b| f64::from(u16::from_le_bytes(order.bytes(b)))),
            5 => each(4, &|b| f64::from(i32::from_le_bytes(order.bytes(b)))),
            6 => each(4, &|b| f64::from(order.word(b))),
            7 => each(4, &|b| f64::from(f32::from_le_bytes(order.bytes(b)))),
            9 => each(8, &|b| f64::from_le_bytes(order.bytes(b))),
            12 => each(8, &|b| i64::from_le_bytes(order.bytes(b)) as f64),
            13 => each(8, &|b| u64::from_le_bytes(order.bytes(b)) as f64),
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use flate2::Compression;
    use flate2::write::ZlibEncoder;

    use super::*;

    fn header(big: bool) -> Vec<u8> {
        let mut bytes = BEGIN.to_vec();
        bytes.resize(HEADER - 4, b' ');
        bytes.extend(if big { [1, 0] } else { [0, 1] });
        bytes.extend(if big { b"MI" } else { b"IM" });
        bytes
    }

    fn word(value: u32, big: bool) -> [u8; 4] {
        if big { value.to_be_bytes() } else { value.to_le_bytes() }
    }

    fn element(kind: u32, data: &[u8], big: bool) -> Vec<u8> {
        let mut bytes = word(kind, big).to_vec();
        bytes.extend(word(u32::try_from(data.len()).expect("short"), big));
        bytes.extend(data);
        bytes.resize(bytes.len().next_multiple_of(8), 0);
        bytes
    }

    /// An array of doubles of a class.
    fn array(
        name: &str,
        class: u32,
        [rows, columns]: [u32; 2],
        values: &[f64],
        big: bool,
    ) -> Vec<u8> {
        let each = |value: &f64| if big { value.to_be_bytes() } else { value.to_le_bytes() };
        let parts = [
            element(6, &[word(class, big), word(0, big)].concat(), big),
            element(5, &[word(rows, big), word(columns, big)].concat(), big),
            element(1, name.as_bytes(), big),
            element(9, &values.iter().flat_map(each).collect::<Vec<u8>>(), big),
        ];
        element(MATRIX, &parts.concat(), big)
    }

    fn compressed(array: &[u8]) -> Vec<u8> {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(array).expect("compressed");
        let data = encoder.finish().expect("compressed");
        let mut bytes = word(COMPRESSED, false).to_vec();
        bytes.extend(word(u32::try_from(data.len()).expect("short"), false));
        bytes.extend(data);
        bytes
    }

    #[test]
    fn vectors_of_one_length_are_columns() {
        for big in [false, true] {
            let t = array("t", 6, [1, 3], &[0.0, 0.1, 0.2], big);
            let pairs = array("pairs", 6, [3, 2], &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], big);
            let rate = array("rate", 6, [1, 1], &[10.0], big);
            let text = array("note", 4, [1, 0], &[], big);
            let found = table(&[header(big), t, pairs, rate, text].concat()).expect("a table");
            assert_eq!(found.text, "t,pairs_1,pairs_2\n0.0,1.0,4.0\n0.1,2.0,5.0\n0.2,3.0,6.0");
            assert_eq!(found.others, ["the text note of 1 × 0", "the number rate"]);
        }
        let small = compressed(&array("v", 6, [2, 1], &[1.5, f64::NAN], false));
        assert_eq!(table(&[header(false), small].concat()).expect("a table").text, "v\n1.5\nNaN");
    }

    #[test]
    fn damaged_files_are_refused_by_byte_and_never_panic() {
        let whole = [header(false), array("t", 6, [1, 3], &[0.0, 0.1, 0.2], false)].concat();
        for length in HEADER + 1..whole.len() {
            assert!(table(&whole[..length]).is_err(), "{length} bytes");
        }
        // Any byte may be wrong.
        for place in HEADER..whole.len() {
            for value in [0, 1, 0x7f, 0xff] {
                let mut bytes = whole.clone();
                bytes[place] = value;
                let _ = table(&bytes);
            }
        }
        let none = table(&[header(false), array("s", 2, [1, 1], &[], false)].concat());
        assert_eq!(
            none.expect_err("a struct").to_string(),
            "has no vector of numbers; it has the struct s of 1 × 1"
        );
        assert_eq!(table(&header(false)).expect_err("empty").to_string(), "has no variables");
        // What expands beyond the bound is not held.
        let zeros = vec![0; MOST_BYTES + 1];
        let large = [header(false), compressed(&zeros)].concat();
        assert_eq!(table(&large).expect_err("large"), WrongMatlab::TooLarge);
    }
}
