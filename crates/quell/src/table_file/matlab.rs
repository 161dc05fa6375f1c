//! MAT-files of level 5, uncompressed: what MATLAB, Octave and `scipy.io.loadmat` read.
//!
//! Each dataset is a structure with one field for each axis and array, and a field `about`: `units`, `scaling`, the names of
//! the `axes` in the order of the dimensions, the meanings of coded `words`, and the provenance. Arrays over one axis are
//! columns; arrays over several have the dimensions of the axes, in MATLAB's order of storage.
//!
//! Source: The `MathWorks`, MAT-File Format (level 5). A file is a header of 128 bytes and a sequence of elements, each a tag (type,
//! number of bytes) and data filled up to a multiple of 8 bytes. Numbers are little-endian, which the header says.

use super::content::{program, shape};
use super::names::{free, identifier};
use crate::dataset::{Array, Dataset};

/// Types of data.
const INT8: u32 = 1;
const INT32: u32 = 5;
const UINT32: u32 = 6;
const DOUBLE: u32 = 9;
const MATRIX: u32 = 14;
const UTF8: u32 = 16;

/// Classes of arrays.
const CELL_CLASS: u32 = 1;
const STRUCT_CLASS: u32 = 2;
const CHAR_CLASS: u32 = 4;
const DOUBLE_CLASS: u32 = 6;

/// Length of the text in the header.
const TEXT: usize = 116;

/// Bytes for each name of a field: 63 characters and a null.
const FIELD: usize = 64;

/// The field with units and provenance.
const ABOUT: &str = "about";

/// A file with every dataset.
pub(super) fn file(datasets: &[(&'static str, Dataset)]) -> Vec<u8> {
    let verb = datasets.first().map_or("", |(_, dataset)| dataset.provenance().verb);
    let mut bytes = format!("MATLAB 5.0 MAT-file, created by {}", program(verb)).into_bytes();
    bytes.resize(TEXT, b' ');
    // No data of subsystems, version 1, and the mark of the order of bytes.
    bytes.extend([0; 8]);
    bytes.extend([0x00, 0x01, b'I', b'M']);
    let mut taken = Vec::new();
    for (name, dataset) in datasets {
        let name = free(name, &taken);
        bytes.extend(of_dataset(dataset).named(&name));
        taken.push(name);
    }
    bytes
}

/// An array without its name.
struct MatArray {
    class: u32,
    dimensions: Vec<usize>,
    /// The elements after the name.
    content: Vec<u8>,
}

impl MatArray {
    /// The array as an element of a file.
    fn named(&self, name: &str) -> Vec<u8> {
        let dimensions: Vec<u8> =
            self.dimensions.iter().flat_map(|length| word(*length).to_le_bytes()).collect();
        let mut inner = element(UINT32, &[self.class.to_le_bytes(), [0; 4]].concat());
        inner.extend(element(INT32, &dimensions));
        inner.extend(element(INT8, name.as_bytes()));
        inner.extend(&self.content);
        element(MATRIX, &inner)
    }

    /// Numbers in the order of storage of MATLAB.
    fn numbers(dimensions: Vec<usize>, values: impl Iterator<Item = f64>) -> Self {
        let values: Vec<u8> = values.flat_map(f64::to_le_bytes).collect();
        Self { class: DOUBLE_CLASS, dimensions, content: element(DOUBLE, &values) }
    }

    /// A text in one row; characters beyond 16 bits, which would be two in MATLAB, are replaced.
    fn text(text: &str) -> Self {
        let narrow = |c: char| if c.len_utf16() == 1 { c } else { char::REPLACEMENT_CHARACTER };
        let text: String = text.chars().map(narrow).collect();
        let dimensions = vec![usize::from(!text.is_empty()), text.chars().count()];
        Self { class: CHAR_CLASS, dimensions, content: element(UTF8, text.as_bytes()) }
    }

    /// Arrays in one column.
    fn cell(arrays: &[Self]) -> Self {
        let content = arrays.iter().flat_map(|array| array.named("")).collect();
        Self { class: CELL_CLASS, dimensions: vec![arrays.len(), 1], content }
    }

    /// Texts in one column.
    fn texts<'t>(texts: impl IntoIterator<Item = &'t str>) -> Self {
        let texts: Vec<Self> = texts.into_iter().map(Self::text).collect();
        Self::cell(&texts)
    }

    /// A structure of fields, whose names are identifiers.
    fn structure(fields: &[(String, Self)]) -> Self {
        let mut names = Vec::with_capacity(FIELD * fields.len());
        for (index, (name, _)) in fields.iter().enumerate() {
            names.extend(name.as_bytes());
            names.resize(FIELD * (index + 1), 0);
        }
        let mut content = element(INT32, &word(FIELD).to_le_bytes());
        content.extend(element(INT8, &names));
        content.extend(fields.iter().flat_map(|(_, array)| array.named("")));
        Self { class: STRUCT_CLASS, dimensions: vec![1, 1], content }
    }
}

/// A dataset as a structure.
fn of_dataset(dataset: &Dataset) -> MatArray {
    let shape = shape(dataset);
    let mut taken = vec![ABOUT.to_owned()];
    let mut fields = Vec::new();
    let (mut units, mut scaling, mut words) = (Vec::new(), Vec::new(), Vec::new());
    let axes = dataset.axes().iter().map(|axis| (axis, vec![axis.values.len()]));
    let arrays = dataset.arrays().iter().map(|array| (array, shape.clone()));
    let mut axis_names = Vec::new();
    for (array, shape) in axes.chain(arrays) {
        let name = free(&array.name, &taken);
        taken.push(name.clone());
        if axis_names.len() < dataset.axes().len() {
            axis_names.push(name.clone());
        }
        units.push((name.clone(), MatArray::text(&array.unit)));
        if !array.scaling.is_empty() {
            scaling.push((name.clone(), MatArray::text(&array.scaling)));
        }
        if !array.words.is_empty() {
            words.push((name.clone(), meanings(array)));
        }
        fields.push((name, over(&shape, array)));
    }
    let mut about = vec![
        ("units".to_owned(), MatArray::structure(&units)),
        ("scaling".to_owned(), MatArray::structure(&scaling)),
        ("axes".to_owned(), MatArray::texts(axis_names.iter().map(String::as_str))),
        ("words".to_owned(), MatArray::structure(&words)),
    ];
    about.extend(provenance(dataset));
    fields.push((ABOUT.to_owned(), MatArray::structure(&about)));
    MatArray::structure(&fields)
}

/// An array in MATLAB's order of storage, the first index fastest; missing values are NaN.
fn over(shape: &[usize], array: &Array) -> MatArray {
    let count: usize = shape.iter().product();
    let value = |at: usize| array.values.get(at).copied().unwrap_or(f64::NAN);
    let place = |mut number: usize| {
        // The number counts with the first index fastest, the place with the last.
        let mut place = 0;
        let mut stride = count;
        for length in shape {
            stride /= length;
            place += number % length * stride;
            number /= length;
        }
        place
    };
    let dimensions = match shape {
        [] => vec![1, 1],
        [length] => vec![*length, 1],
        several => several.to_vec(),
    };
    MatArray::numbers(dimensions, (0..count).map(|number| value(place(number))))
}

/// The codes of words and their meanings.
fn meanings(array: &Array) -> MatArray {
    let codes = array.words.iter().map(|(code, _)| f64::from(*code));
    let codes = MatArray::numbers(vec![array.words.len(), 1], codes);
    let meanings = MatArray::texts(array.words.iter().map(|(_, word)| word.as_str()));
    MatArray::structure(&[("codes".to_owned(), codes), ("meanings".to_owned(), meanings)])
}

/// Program, title, changes, facts and text of the study.
fn provenance(dataset: &Dataset) -> impl Iterator<Item = (String, MatArray)> {
    let from = dataset.provenance();
    let text = |text: &str| MatArray::text(text);
    let texts = |texts: &[String]| MatArray::texts(texts.iter().map(String::as_str));
    [
        ("program", text(&program(from.verb))),
        ("title", text(from.title.as_deref().unwrap_or_default())),
        ("facts", texts(&from.facts)),
        ("changes", texts(&from.changes)),
        ("study", text(&from.text)),
    ]
    .into_iter()
    .map(|(name, array)| (identifier(name), array))
}

/// A tag and data, filled up to a multiple of 8 bytes.
fn element(kind: u32, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(8 + data.len().next_multiple_of(8));
    bytes.extend(kind.to_le_bytes());
    bytes.extend(word(data.len()).to_le_bytes());
    bytes.extend(data);
    bytes.resize(8 + data.len().next_multiple_of(8), 0);
    bytes
}

/// A size, which `TableFormat::files` has limited to 31 bits for every array.
fn word(size: usize) -> u32 {
    u32::try_from(size).unwrap_or(u32::MAX)
}
