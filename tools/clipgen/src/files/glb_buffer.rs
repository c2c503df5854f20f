//! The binary chunk of a GLB as it grows, with the JSON of its views and accessors.
//!
//! Little-endian; every view begins at a multiple of 4 bytes (glTF 2.0, §3.6.2.4); float accessors state their bounds.

/// Component type of glTF 2.0, §3.6.2.2.
const UNSIGNED_BYTE: u32 = 5121;
/// Component type of glTF 2.0, §3.6.2.2.
const UNSIGNED_SHORT: u32 = 5123;
/// Component type of glTF 2.0, §3.6.2.2.
const FLOAT: u32 = 5126;
/// Target of a view of vertices (§5.11.5).
const ARRAY_BUFFER: &str = ",\"target\":34962";
/// Target of a view of indices (§5.11.5).
const ELEMENT_ARRAY_BUFFER: &str = ",\"target\":34963";

/// Bytes, views and accessors so far; each `push` returns the index of its accessor.
#[derive(Clone, Debug, Default)]
pub(crate) struct GlbBuffer {
    /// Bytes of the chunk.
    pub(crate) bytes: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
}

impl GlbBuffer {
    /// Adds vectors of vertices, three floats each.
    pub(crate) fn push_vertices(&mut self, values: &[f32]) -> usize {
        self.push_float_view("VEC3", values, ARRAY_BUFFER)
    }

    /// Adds floats that belong to no vertex; `kind` ("SCALAR", "VEC3", "VEC4", "MAT4") gives their number per element.
    pub(crate) fn push_floats(&mut self, kind: &str, values: &[f32]) -> usize {
        self.push_float_view(kind, values, "")
    }

    fn push_float_view(&mut self, kind: &str, values: &[f32], target: &str) -> usize {
        let width = match kind {
            "SCALAR" => 1,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        let bound = |start: f32, pick: fn(f32, f32) -> f32| {
            let column = |i: usize| values.iter().skip(i).step_by(width).copied().fold(start, pick).to_string();
            (0..width).map(column).collect::<Vec<String>>().join(",")
        };
        let bounds =
            format!(",\"min\":[{}],\"max\":[{}]", bound(f32::INFINITY, f32::min), bound(f32::NEG_INFINITY, f32::max));
        self.push_view(values.iter().flat_map(|value| value.to_le_bytes()), target);
        self.push_accessor(FLOAT, kind, values.len() / width, &bounds)
    }

    /// Adds bytes, four per element: joints, or weights in 255ths.
    pub(crate) fn push_bytes(&mut self, values: impl Iterator<Item = u8>, normalized: bool) -> usize {
        let length = self.push_view(values, ARRAY_BUFFER);
        self.push_accessor(UNSIGNED_BYTE, "VEC4", length / 4, if normalized { ",\"normalized\":true" } else { "" })
    }

    /// Adds indices of triangles.
    pub(crate) fn push_indices(&mut self, values: impl Iterator<Item = u16>) -> usize {
        let length = self.push_view(values.flat_map(u16::to_le_bytes), ELEMENT_ARRAY_BUFFER);
        self.push_accessor(UNSIGNED_SHORT, "SCALAR", length / 2, "")
    }

    /// The members `buffers`, `bufferViews` and `accessors`.
    pub(crate) fn json(&self) -> String {
        format!(
            "\"buffers\":[{{\"byteLength\":{}}}],\"bufferViews\":[{}],\"accessors\":[{}]",
            self.bytes.len(),
            self.views.join(","),
            self.accessors.join(",")
        )
    }

    /// Appends a view; returns its length in bytes.
    fn push_view(&mut self, bytes: impl Iterator<Item = u8>, target: &str) -> usize {
        let offset = self.bytes.len();
        self.bytes.extend(bytes);
        let length = self.bytes.len() - offset;
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(format!("{{\"buffer\":0,\"byteOffset\":{offset},\"byteLength\":{length}{target}}}"));
        length
    }

    /// Appends an accessor of the last view; returns its index.
    fn push_accessor(&mut self, component: u32, kind: &str, count: usize, more: &str) -> usize {
        let view = self.views.len() - 1;
        self.accessors.push(format!(
            "{{\"bufferView\":{view},\"componentType\":{component},\"count\":{count},\"type\":\"{kind}\"{more}}}"
        ));
        view
    }
}
