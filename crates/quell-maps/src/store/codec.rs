//! Encoding of chunks: values into the bytes of a chunk of full size, padded with fill values at the far edges, and back.

use std::borrow::Cow;
use std::num::NonZeroU64;

use zarrs::array::{ArrayToBytesCodecTraits, CodecError, CodecOptions, Element, ElementOwned};

use super::layout::Described;

/// Encodes the values at `slots` of a chunk; the other elements are set to `fill`.
pub(super) fn encode<T: Element + Copy>(
    array: &Described,
    slots: &[usize],
    values: impl Iterator<Item = T>,
    fill: T,
) -> Result<Vec<u8>, CodecError> {
    let shape = shape(array)?;
    let volume: u64 = shape.iter().map(|length| length.get()).product();
    let mut whole = vec![fill; usize::try_from(volume).unwrap_or(0)];
    for (&slot, value) in slots.iter().zip(values) {
        whole[slot] = value;
    }
    let bytes = T::into_array_bytes(array.data_type(), whole)
        .map_err(|error| CodecError::Other(error.to_string()))?;
    let encoded = array.codecs().encode(
        bytes,
        &shape,
        array.data_type(),
        array.fill_value(),
        &CodecOptions::default(),
    )?;
    Ok(encoded.into_owned())
}

/// The values at `slots` of an encoded chunk.
pub(super) fn decode<T: ElementOwned + Copy>(
    array: &Described,
    slots: &[usize],
    bytes: Vec<u8>,
) -> Result<Vec<T>, CodecError> {
    let decoded = array.codecs().decode(
        Cow::Owned(bytes),
        &shape(array)?,
        array.data_type(),
        array.fill_value(),
        &CodecOptions::default(),
    )?;
    let whole = T::from_array_bytes(array.data_type(), decoded)
        .map_err(|error| CodecError::Other(error.to_string()))?;
    let missing = || CodecError::Other("a chunk is too short".to_owned());
    slots.iter().map(|&slot| whole.get(slot).copied().ok_or_else(missing)).collect()
}

/// Maximum length of an encoded chunk (bytes): numbers of eight bytes, and a checksum.
pub(super) fn longest(array: &Described) -> u64 {
    let volume: u64 =
        shape(array).map_or(0, |shape| shape.iter().map(|length| length.get()).product());
    volume.saturating_mul(8).saturating_add(4)
}

/// Shape of a chunk of full size.
fn shape(array: &Described) -> Result<Vec<NonZeroU64>, CodecError> {
    array
        .chunk_shape(&vec![0; array.dimensionality()])
        .map_err(|error| CodecError::Other(error.to_string()))
}
