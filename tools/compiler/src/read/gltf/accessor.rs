//! The numbers that an accessor means: plain or sparse, floats or normalised integers (glTF 2.0, §3.6.2).

use gltf::json::accessor::{ComponentType, GenericComponentType, IndexComponentType, sparse::Sparse};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index, buffer::View};

use crate::read::gltf::document::{Document, Flaw, flaw};

/// Elements of `width` numbers each, one after the other.
pub(crate) struct Numbers {
    pub width: usize,
    pub values: Vec<f32>,
}

/// How many elements an accessor has, unless its bytes do not pay for them.
pub(crate) fn count(document: &Document, index: usize) -> Result<usize, Flaw> {
    let accessor = accessor(document, index)?;
    let count = usize::try_from(accessor.count.0).unwrap_or(usize::MAX);
    let is_paid_for = match accessor.buffer_view {
        Some(_) => plain(document, index, accessor)?.is_some(),
        // Zeros, but for what is sparse.
        None => count <= document.byte_count,
    };
    if count == 0 || !is_paid_for { unpaid(index) } else { Ok(count) }
}

/// All numbers of an accessor; integers as fractions of their range where `as_fractions` or the accessor says so.
pub(crate) fn numbers(document: &Document, index: usize, as_fractions: bool) -> Result<Numbers, Flaw> {
    let count = count(document, index)?;
    let accessor = accessor(document, index)?;
    let (kind, width) = shape(index, accessor)?;
    let fractions = as_fractions || accessor.normalized;
    let mut values = vec![0.0; count * width];
    if let Some(Plain { bytes, stride }) = plain(document, index, accessor)? {
        for (element, values) in values.chunks_exact_mut(width).enumerate() {
            read(&bytes[element * stride..], kind, fractions, values);
        }
    }
    if let Some(sparse) = &accessor.sparse {
        put(document, index, sparse, kind, fractions, width, &mut values)?;
    }
    Ok(Numbers { width, values })
}

fn accessor<'a>(document: &'a Document, index: usize) -> Result<&'a Accessor, Flaw> {
    document.root.accessors.get(index).map_or_else(|| unpaid(index), Ok)
}

fn unpaid<T>(index: usize) -> Result<T, Flaw> {
    let problem = "it asks for what its buffer does not hold";
    flaw(format!("accessor {index}"), problem, "check the file with the glTF validator")
}

/// Type of a number, and numbers of an element.
fn shape(index: usize, accessor: &Accessor) -> Result<(ComponentType, usize), Flaw> {
    match (&accessor.component_type, &accessor.type_) {
        (Checked::Valid(GenericComponentType(kind)), Checked::Valid(shape)) => Ok((*kind, shape.multiplicity())),
        _ => flaw(format!("accessor {index}"), "its type is none of glTF's", "check the file with the glTF validator"),
    }
}

/// Bytes from an accessor's first element on, and from one element to the next.
struct Plain<'a> {
    bytes: &'a [u8],
    stride: usize,
}

/// None where the accessor has no bytes of its own, or fewer than it claims.
fn plain<'a>(document: &'a Document, index: usize, accessor: &Accessor) -> Result<Option<Plain<'a>>, Flaw> {
    let Some(view) = accessor.buffer_view else { return Ok(None) };
    let (kind, width) = shape(index, accessor)?;
    let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
    Ok(elements(document, view, offset, accessor.count.0, kind.size() * width))
}

/// So many elements of so many bytes in a view, if they are there.
fn elements<'a>(
    document: &'a Document,
    view: Index<View>,
    offset: u64,
    count: u64,
    element_bytes: usize,
) -> Option<Plain<'a>> {
    let (bytes, stride) = document.view(view)?;
    let stride = stride.unwrap_or(element_bytes).max(element_bytes);
    let bytes = bytes.get(usize::try_from(offset).ok()?..)?;
    let needed = usize::try_from(count.checked_sub(1)?).ok()?.checked_mul(stride)?.checked_add(element_bytes)?;
    (needed <= bytes.len()).then_some(Plain { bytes, stride })
}

/// One element.
fn read(bytes: &[u8], kind: ComponentType, as_fractions: bool, values: &mut [f32]) {
    for (value, bytes) in values.iter_mut().zip(bytes.chunks_exact(kind.size())) {
        let (number, range) = match (kind, bytes) {
            (ComponentType::I8, &[a]) => (f32::from(a as i8), 127.0),
            (ComponentType::U8, &[a]) => (f32::from(a), 255.0),
            (ComponentType::I16, &[a, b]) => (f32::from(i16::from_le_bytes([a, b])), 32_767.0),
            (ComponentType::U16, &[a, b]) => (f32::from(u16::from_le_bytes([a, b])), 65_535.0),
            (ComponentType::F32, &[a, b, c, d]) => (f32::from_le_bytes([a, b, c, d]), 1.0),
            (_, &[a, b, c, d]) => (u32::from_le_bytes([a, b, c, d]) as f32, u32::MAX as f32),
            _ => (0.0, 1.0),
        };
        let is_fraction = as_fractions && kind != ComponentType::F32;
        *value = if is_fraction { (number / range).max(-1.0) } else { number };
    }
}

/// Puts sparse elements in their places.
fn put(
    document: &Document,
    index: usize,
    sparse: &Sparse,
    kind: ComponentType,
    as_fractions: bool,
    width: usize,
    values: &mut [f32],
) -> Result<(), Flaw> {
    let Checked::Valid(IndexComponentType(index_kind)) = sparse.indices.component_type else { return unpaid(index) };
    let count = sparse.count.0;
    let places = elements(document, sparse.indices.buffer_view, sparse.indices.byte_offset.0, count, index_kind.size());
    let element_bytes = kind.size() * width;
    let put = elements(document, sparse.values.buffer_view, sparse.values.byte_offset.0, count, element_bytes);
    let (Some(places), Some(put)) = (places, put) else { return unpaid(index) };
    for element in 0..count as usize {
        let place = place(&places.bytes[element * places.stride..], index_kind);
        let start = place.saturating_mul(width);
        let Some(values) = values.get_mut(start..start.saturating_add(width)) else { return unpaid(index) };
        read(&put.bytes[element * put.stride..], kind, as_fractions, values);
    }
    Ok(())
}

/// One index, unsigned.
fn place(bytes: &[u8], kind: ComponentType) -> usize {
    let digits = bytes[..kind.size()].iter().rev();
    digits.fold(0, |number, &digit| 256 * number + usize::from(digit))
}
