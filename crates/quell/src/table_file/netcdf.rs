//! NetCDF in its classic format with 64-bit offsets (CDF-2): what xarray (engine `scipy` or `netcdf4`), MATLAB's `ncread` and
//! `ncdump` read.
//!
//! Axes are dimensions with a variable of the same name; arrays have `units`, and `scaling` where a number is dimensionless.
//! Codes of words are bytes with `flag_values` and `flag_meanings` (CF conventions). Names of further datasets get the name of the
//! dataset in front, as in the Python package. A dataset without rows is left out, because a dimension of length 0 would be
//! the unlimited one; an attribute says so.
//!
//! Source: Unidata, NetCDF classic and 64-bit offset file formats. Numbers are big-endian; names, attributes and data are
//! filled up to multiples of 4 bytes.

use super::content::{program, shape};
use super::names::free;
use crate::dataset::{Array, Dataset, Provenance};

/// Tags of lists.
const DIMENSIONS: u32 = 10;
const VARIABLES: u32 = 11;
const ATTRIBUTES: u32 = 12;

/// Types of data.
const BYTE: u32 = 1;
const CHAR: u32 = 2;
const DOUBLE: u32 = 6;

/// Bytes of a number in a file.
const NUMBER: usize = size_of::<f64>();

/// A file with every dataset.
pub(super) fn file(datasets: &[(&'static str, Dataset)]) -> Vec<u8> {
    let mut contents = NetCdfContents::default();
    for (place, (name, dataset)) in datasets.iter().enumerate() {
        contents.add(name, dataset, place == 0);
    }
    contents.bytes()
}

/// An attribute: text, or codes.
enum NetCdfAttribute {
    Text(String),
    Codes(Vec<u8>),
}

/// A variable and its data.
struct NetCdfVariable<'d> {
    name: String,
    /// Numbers of its dimensions.
    dimensions: Vec<usize>,
    /// Number of its values.
    count: usize,
    array: &'d Array,
}

/// What is written into a file.
#[derive(Default)]
struct NetCdfContents<'d> {
    /// Names of dimensions with their values.
    dimensions: Vec<(String, &'d [f64])>,
    attributes: Vec<(String, NetCdfAttribute)>,
    variables: Vec<NetCdfVariable<'d>>,
}

impl<'d> NetCdfContents<'d> {
    /// Adds a dataset; one that is not the first has its name in front of its arrays.
    fn add(&mut self, name: &str, dataset: &'d Dataset, is_first: bool) {
        self.describe(name, dataset.provenance(), is_first);
        let shape = shape(dataset);
        if shape.contains(&0) {
            self.attribute(&format!("{name}_rows"), "0");
            return;
        }
        let axes = dataset.axes().iter();
        let dimensions: Vec<usize> = axes.map(|axis| self.dimension(name, axis)).collect();
        let prefix = if is_first { String::new() } else { format!("{name}_") };
        for array in dataset.arrays() {
            let name = self.free(&format!("{prefix}{}", array.name));
            let (dimensions, count) = (dimensions.clone(), shape.iter().product());
            self.variables.push(NetCdfVariable { name, dimensions, count, array });
        }
    }

    /// The number of the dimension of an axis; an equal axis of an earlier dataset is shared.
    fn dimension(&mut self, dataset: &str, axis: &'d Array) -> usize {
        let plain = super::names::identifier(&axis.name);
        let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        let is_same = |(name, values): &(String, &[f64])| {
            *name == plain && bits(values) == bits(&axis.values)
        };
        if let Some(known) = self.dimensions.iter().position(is_same) {
            return known;
        }
        let is_taken = self.variables.iter().any(|variable| variable.name == plain);
        let wanted = if is_taken { format!("{dataset}_{}", axis.name) } else { axis.name.clone() };
        let name = self.free(&wanted);
        let number = self.dimensions.len();
        self.dimensions.push((name.clone(), &axis.values));
        let count = axis.values.len();
        self.variables.push(NetCdfVariable { name, dimensions: vec![number], count, array: axis });
        number
    }

    fn free(&self, name: &str) -> String {
        let taken: Vec<String> =
            self.variables.iter().map(|variable| variable.name.clone()).collect();
        free(name, &taken)
    }

    fn attribute(&mut self, name: &str, text: &str) {
        // An empty attribute is none.
        if !text.is_empty() {
            self.attributes.push((name.to_owned(), NetCdfAttribute::Text(text.to_owned())));
        }
    }

    /// The provenance; that of the first dataset is that of the file.
    fn describe(&mut self, name: &str, from: &Provenance, is_first: bool) {
        if is_first {
            self.attribute("program", &program(from.verb));
            self.attribute("title", from.title.as_deref().unwrap_or_default());
            self.attribute("changes", &from.changes.join("\n"));
            self.attribute("study", &from.text);
        }
        self.attribute(&format!("{name}_facts"), &from.facts.join("\n"));
    }

    /// The header and the data.
    fn bytes(&self) -> Vec<u8> {
        let header = self.header(0);
        let mut bytes = self.header(header.len());
        for variable in &self.variables {
            let values = (0..variable.count)
                .map(|at| variable.array.values.get(at).copied().unwrap_or(f64::NAN));
            if variable.array.words.is_empty() {
                bytes.extend(values.flat_map(f64::to_be_bytes));
            } else {
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "codes are bytes"
                )]
                bytes.extend(values.map(|code| code as u8));
                bytes.resize(bytes.len().next_multiple_of(4), 0);
            }
        }
        bytes
    }

    /// The header of a file whose data begin at an offset; its length does not depend on the offset.
    fn header(&self, data: usize) -> Vec<u8> {
        // No records.
        let mut bytes = vec![b'C', b'D', b'F', 2, 0, 0, 0, 0];
        list(&mut bytes, DIMENSIONS, self.dimensions.len());
        for (name, values) in &self.dimensions {
            text(&mut bytes, name);
            bytes.extend(word(values.len()));
        }
        attributes(&mut bytes, &self.attributes);
        list(&mut bytes, VARIABLES, self.variables.len());
        let mut begin = data;
        for variable in &self.variables {
            text(&mut bytes, &variable.name);
            bytes.extend(word(variable.dimensions.len()));
            for number in &variable.dimensions {
                bytes.extend(word(*number));
            }
            attributes(&mut bytes, &described(variable.array));
            let coded = !variable.array.words.is_empty();
            let size = variable.count * if coded { 1 } else { NUMBER };
            let size = size.next_multiple_of(4);
            bytes.extend(if coded { BYTE } else { DOUBLE }.to_be_bytes());
            bytes.extend(word(size));
            bytes.extend((begin as u64).to_be_bytes());
            begin += size;
        }
        bytes
    }
}

/// The attributes of an array.
fn described(array: &Array) -> Vec<(String, NetCdfAttribute)> {
    let text = |name: &str, text: &str| (name.to_owned(), NetCdfAttribute::Text(text.to_owned()));
    if !array.words.is_empty() {
        let codes = array.words.iter().map(|(code, _)| *code).collect();
        let words: Vec<String> =
            array.words.iter().map(|(_, word)| word.replace(' ', "_")).collect();
        return vec![
            ("flag_values".to_owned(), NetCdfAttribute::Codes(codes)),
            text("flag_meanings", &words.join(" ")),
        ];
    }
    let units = (!array.unit.is_empty()).then(|| text("units", &array.unit));
    let scaling = (!array.scaling.is_empty()).then(|| text("scaling", &array.scaling));
    units.into_iter().chain(scaling).collect()
}

fn attributes(bytes: &mut Vec<u8>, attributes: &[(String, NetCdfAttribute)]) {
    list(bytes, ATTRIBUTES, attributes.len());
    for (name, attribute) in attributes {
        text(bytes, name);
        let (kind, data) = match attribute {
            NetCdfAttribute::Text(text) => (CHAR, text.as_bytes()),
            NetCdfAttribute::Codes(codes) => (BYTE, codes.as_slice()),
        };
        bytes.extend(kind.to_be_bytes());
        filled(bytes, data);
    }
}

/// The head of a list; an empty list has no tag.
fn list(bytes: &mut Vec<u8>, tag: u32, length: usize) {
    bytes.extend(if length == 0 { 0 } else { tag }.to_be_bytes());
    bytes.extend(word(length));
}

fn text(bytes: &mut Vec<u8>, text: &str) {
    filled(bytes, text.as_bytes());
}

/// A length and bytes, filled up to a multiple of 4.
fn filled(bytes: &mut Vec<u8>, data: &[u8]) {
    bytes.extend(word(data.len()));
    bytes.extend(data);
    bytes.resize(bytes.len().next_multiple_of(4), 0);
}

/// A size, which `TableFormat::files` has limited to 31 bits for every array.
fn word(size: usize) -> [u8; 4] {
    u32::try_from(size).unwrap_or(u32::MAX).to_be_bytes()
}
