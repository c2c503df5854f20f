//! Numbers of an accessor: plain or sparse, floats or normalised integers (glTF 2.0, §3.6.2).

use gltf::json::accessor::{ComponentType, GenericComponentType, IndexComponentType, sparse::Sparse};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index, buffer::View};

use crate::error::RejectionReason;
use crate::read::gltf::document::Document;
use crate::read::gltf::node_channel::VALIDATE;
use crate::read::malformed::malformed;

/// Elements of `width` numbers each, one after the other.
pub(crate) struct AccessorNumbers {
    pub width: usize,
    pub values: Vec<f32>,
}

/// How an element is stored.
#[derive(Clone, Copy)]
struct ElementType {
    component: ComponentType,
    /// Numbers of an element.
    width: usize,
    /// Integers are fractions of their range.
    is_fraction: bool,
}

impl ElementType {
    fn bytes(self) -> usize {
        self.component.size() * self.width
    }
}

/// Count of the numbers of an accessor. Fails where its bytes do not exist.
pub(crate) fn number_count(document: &Document, index: usize) -> Result<usize, RejectionReason> {
    let width = element_type(index, accessor(document, index)?, false)?.width;
    Ok(count(document, index)?.saturating_mul(width))
}

/// Number of elements of an accessor. Fails where its bytes do not exist.
fn count(document: &Document, index: usize) -> Result<usize, RejectionReason> {
    let accessor = accessor(document, index)?;
    let count = usize::try_from(accessor.count.0).unwrap_or(usize::MAX);
    let has_bytes = match accessor.buffer_view {
        Some(_) => own_elements(document, accessor, element_type(index, accessor, false)?).is_some(),
        // All zeros except sparse elements: no more than the file has bytes.
        None => count <= document.byte_count,
    };
    if count == 0 || !has_bytes { missing_bytes(index) } else { Ok(count) }
}

/// All numbers of an accessor. Integers are fractions of their range where `as_fractions` or the accessor states it.
pub(crate) fn numbers(
    document: &Document,
    index: usize,
    as_fractions: bool,
) -> Result<AccessorNumbers, RejectionReason> {
    let count = count(document, index)?;
    let accessor = accessor(document, index)?;
    let element = element_type(index, accessor, as_fractions)?;
    let mut values = vec![0.0; count * element.width];
    if let Some(StoredElements { bytes, stride }) = own_elements(document, accessor, element) {
        for (slot, values) in values.chunks_exact_mut(element.width).enumerate() {
            read_element(&bytes[slot * stride..], element, values);
        }
    }
    if let Some(sparse) = &accessor.sparse {
        put_sparse(document, index, sparse, element, &mut values)?;
    }
    Ok(AccessorNumbers { width: element.width, values })
}

fn accessor(document: &Document, index: usize) -> Result<&Accessor, RejectionReason> {
    document.root.accessors.get(index).map_or_else(|| missing_bytes(index), Ok)
}

fn missing_bytes<T>(index: usize) -> Result<T, RejectionReason> {
    malformed(format!("accessor {index}"), "it needs bytes that its buffer does not hold", VALIDATE)
}

fn element_type(index: usize, accessor: &Accessor, as_fractions: bool) -> Result<ElementType, RejectionReason> {
    match (&accessor.component_type, &accessor.type_) {
        (Checked::Valid(GenericComponentType(component)), Checked::Valid(shape)) => Ok(ElementType {
            component: *component,
            width: shape.multiplicity(),
            is_fraction: (as_fractions || accessor.normalized) && *component != ComponentType::F32,
        }),
        _ => malformed(format!("accessor {index}"), "its type is none of glTF's", VALIDATE),
    }
}

/// Bytes from the first element on, and the distance of two elements in bytes.
struct StoredElements<'a> {
    bytes: &'a [u8],
    stride: usize,
}

/// The elements in the accessor's own view; none where it has no view, or the view is too short.
fn own_elements<'a>(document: &'a Document, accessor: &Accessor, element: ElementType) -> Option<StoredElements<'a>> {
    let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
    elements_of_view(document, accessor.buffer_view?, offset, accessor.count.0, element.bytes())
}

/// `count` elements of `element_bytes` bytes in a view; none where the view is too short.
fn elements_of_view<'a>(
    document: &'a Document,
    view: Index<View>,
    offset: u64,
    count: u64,
    element_bytes: usize,
) -> Option<StoredElements<'a>> {
    let (bytes, stride) = document.view(view)?;
    let stride = stride.unwrap_or(element_bytes).max(element_bytes);
    let bytes = bytes.get(usize::try_from(offset).ok()?..)?;
    let needed = usize::try_from(count.checked_sub(1)?).ok()?.checked_mul(stride)?.checked_add(element_bytes)?;
    (needed <= bytes.len()).then_some(StoredElements { bytes, stride })
}

/// Reads the numbers of one element.
fn read_element(bytes: &[u8], element: ElementType, values: &mut [f32]) {
    for (value, bytes) in values.iter_mut().zip(bytes.chunks_exact(element.component.size())) {
        let (number, range) = match (element.component, bytes) {
            (ComponentType::I8, &[a]) => (f32::from(a as i8), 127.0),
            (ComponentType::U8, &[a]) => (f32::from(a), 255.0),
            (ComponentType::I16, &[a, b]) => (f32::from(i16::from_le_bytes([a, b])), 32_767.0),
            (ComponentType::U16, &[a, b]) => (f32::from(u16::from_le_bytes([a, b])), 65_535.0),
            (ComponentType::F32, &[a, b, c, d]) => (f32::from_le_bytes([a, b, c, d]), 1.0),
            (_, &[a, b, c, d]) => (u32::from_le_bytes([a, b, c, d]) as f32, u32::MAX as f32),
            _ => (0.0, 1.0),
        };
        *value = if element.is_fraction { (number / range).max(-1.0) } else { number };
    }
}

/// Replaces the elements that `sparse` lists.
fn put_sparse(
    document: &Document,
    index: usize,
    sparse: &Sparse,
    element: ElementType,
    values: &mut [f32],
) -> Result<(), RejectionReason> {
    let Checked::Valid(IndexComponentType(index_type)) = sparse.indices.component_type else {
        return missing_bytes(index);
    };
    let count = sparse.count.0;
    let stored = |view, offset, bytes| elements_of_view(document, view, offset, count, bytes);
    let slots = stored(sparse.indices.buffer_view, sparse.indices.byte_offset.0, index_type.size());
    let replacements = stored(sparse.values.buffer_view, sparse.values.byte_offset.0, element.bytes());
    let (Some(slots), Some(replacements)) = (slots, replacements) else { return missing_bytes(index) };
    for number in 0..count as usize {
        let slot = unsigned(&slots.bytes[number * slots.stride..], index_type);
        let start = slot.saturating_mul(element.width);
        let Some(values) = values.get_mut(start..start.saturating_add(element.width)) else {
            return missing_bytes(index);
        };
        read_element(&replacements.bytes[number * replacements.stride..], element, values);
    }
    Ok(())
}

/// A little-endian unsigned integer.
fn unsigned(bytes: &[u8], component: ComponentType) -> usize {
    let digits = bytes[..component.size()].iter().rev();
    digits.fold(0, |number, &digit| 256 * number + usize::from(digit))
}
