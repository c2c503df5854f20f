//! The chunks of a glTF or GLB file: its JSON, and the position of its binary chunk. Bytes after them are not read.

use std::io::{Read, Seek, SeekFrom};

use motiondb::files::input_file;

use crate::error::RejectionReason;
use crate::read::gltf::document_json::unparsed;
use crate::read::malformed::malformed;

/// Greatest length of a .gltf file, or of the JSON chunk of a .glb file, bytes.
const TEXT_MAX_BYTES: u64 = 256 << 20;
/// Greatest number of bytes of a document's JSON and of the buffers of its animations.
pub(crate) const BYTES_MAX: usize = 512 << 20;
/// Greatest length of the JSON outside of strings, bytes: a parsed number takes up to 32 times its text. Data URIs are
/// strings.
const STRUCTURE_MAX_BYTES: usize = 32 << 20;
/// Greatest number of objects in the JSON; a parsed one takes up to 1 KB. A thousand long animations have as many.
const OBJECTS_MAX: usize = 1_000_000;
/// Length of the header of a GLB file, bytes.
const HEADER_BYTES: usize = 12;
/// Length of the header of a chunk, bytes.
const CHUNK_HEADER_BYTES: usize = 8;

/// The JSON of a file, and the position of its binary chunk.
pub(crate) struct Chunks {
    pub json: Vec<u8>,
    /// The binary chunk of a GLB file.
    pub binary: Option<BinaryChunk>,
}

/// Position of the binary chunk of a GLB file.
#[derive(Clone, Copy)]
pub(crate) struct BinaryChunk {
    /// First byte in the file.
    pub start: u64,
    /// Length, bytes; the file has so many.
    pub length: u64,
}

/// Reads the chunk table and the JSON of a file.
pub(crate) fn read(file: &mut (impl Read + Seek)) -> Result<Chunks, RejectionReason> {
    let unreadable = |error| RejectionReason::unreadable(&error);
    let length = file.seek(SeekFrom::End(0)).map_err(unreadable)?;
    file.rewind().map_err(unreadable)?;
    let head = read_up_to(file, (HEADER_BYTES + CHUNK_HEADER_BYTES) as u64)?;
    check_is_gltf(&head, length)?;
    let chunks = if head.starts_with(b"glTF") { glb_chunks(file, head, length)? } else { text(file, head, length)? };
    check_structure(&chunks.json)?;
    Ok(chunks)
}

/// Up to `most` bytes from the position of a file on; fewer at its end.
pub(crate) fn read_up_to(file: &mut impl Read, most: u64) -> Result<Vec<u8>, RejectionReason> {
    let mut bytes = Vec::new();
    file.take(most).read_to_end(&mut bytes).map_err(|error| RejectionReason::unreadable(&error))?;
    Ok(bytes)
}

/// Rejects, by the first bytes, files that are not glTF: cut short, packed, or in another encoding.
fn check_is_gltf(head: &[u8], length: u64) -> Result<(), RejectionReason> {
    if head.is_empty() {
        return malformed("byte 0", "the file is empty", "export the clip again");
    }
    if let [b'g', b'l', b'T', b'F', _, _, _, _, stated @ ..] = head
        && let Some(&stated) = stated.first_chunk()
        && u64::from(u32::from_le_bytes(stated)) > length
    {
        let problem = format!("the file is cut short: {length} of {} bytes", u32::from_le_bytes(stated));
        return malformed(format!("byte {length}"), problem, "copy or export it again");
    }
    if head.starts_with(b"PK\x03\x04") {
        return malformed("byte 0", "the file is a zip archive", "unpack it");
    }
    if input_file::is_utf16(head) {
        return malformed("byte 0", "the text is UTF-16, two bytes a letter", "save it as UTF-8");
    }
    if head.starts_with(b"\xef\xbb\xbf") {
        return malformed("byte 0", "the text begins with a byte order mark", "save it as UTF-8 without one");
    }
    if head.starts_with(&[0]) {
        return malformed("byte 0", "a zero byte is no text", "export the clip again");
    }
    Ok(())
}

/// The chunks of a .gltf file: all of it is JSON.
fn text(file: &mut impl Read, head: Vec<u8>, length: u64) -> Result<Chunks, RejectionReason> {
    if length > TEXT_MAX_BYTES {
        let problem = format!("the text is longer than {} MiB", TEXT_MAX_BYTES >> 20);
        return malformed("document", problem, "export it as .glb, or its clips to several files");
    }
    let json = [head, read_up_to(file, TEXT_MAX_BYTES)?].concat();
    Ok(Chunks { json, binary: None })
}

/// The chunks of a GLB file that begins with `head`. `gltf` reads the headers, from a copy that ends where the binary
/// chunk begins and states lengths to match.
fn glb_chunks(file: &mut (impl Read + Seek), head: Vec<u8>, length: u64) -> Result<Chunks, RejectionReason> {
    let json_length = head.get(HEADER_BYTES..).and_then(<[u8]>::first_chunk).map_or(0, |&at| u32::from_le_bytes(at));
    let json_start = (HEADER_BYTES + CHUNK_HEADER_BYTES) as u64;
    if u64::from(json_length) > length.saturating_sub(json_start) {
        let problem = format!("the JSON chunk states {json_length} bytes, but the file has {length}");
        return malformed("document", problem, "copy or export it again");
    }
    if u64::from(json_length) > TEXT_MAX_BYTES {
        let problem = format!("the JSON chunk is longer than {} MiB", TEXT_MAX_BYTES >> 20);
        return malformed("document", problem, "export its clips to several files");
    }
    let mut copy = head;
    copy.extend(read_up_to(file, u64::from(json_length))?);
    let mut binary_head = read_up_to(file, CHUNK_HEADER_BYTES as u64)?;
    let binary_length = binary_head.first_chunk().map(|&at| u32::from_le_bytes(at));
    if let Some(stated) = binary_head.first_chunk_mut::<4>() {
        *stated = [0; 4];
    }
    copy.extend(binary_head);
    let copied = u32::try_from(copy.len()).unwrap_or(u32::MAX);
    if let Some(stated) = copy.get_mut(8..).and_then(<[u8]>::first_chunk_mut) {
        *stated = copied.to_le_bytes();
    }
    let glb = gltf::Glb::from_slice(&copy).or_else(|error| unparsed(&error))?;
    let start = json_start + u64::from(json_length) + CHUNK_HEADER_BYTES as u64;
    let binary = glb.bin.and(binary_length).map(|length| BinaryChunk { start, length: u64::from(length) });
    if let Some(chunk) = binary.filter(|chunk| chunk.length > length.saturating_sub(chunk.start)) {
        let problem = format!("the binary chunk states {} bytes, but the file has {length}", chunk.length);
        return malformed("document", problem, "copy or export it again");
    }
    Ok(Chunks { json: glb.json.into_owned(), binary })
}

/// Checks that the parsed document will not take many times the memory of its text.
fn check_structure(json: &[u8]) -> Result<(), RejectionReason> {
    let (mut structure, mut objects) = (0, 0);
    let (mut is_string, mut is_escaped) = (false, false);
    for &byte in json {
        if is_string {
            is_string = byte != b'"' || is_escaped;
            is_escaped = byte == b'\\' && !is_escaped;
            continue;
        }
        structure += usize::from(!byte.is_ascii_whitespace());
        objects += usize::from(byte == b'{');
        is_string = byte == b'"';
    }
    if structure > STRUCTURE_MAX_BYTES || objects > OBJECTS_MAX {
        let problem = format!("it holds {objects} objects in {structure} bytes of JSON besides texts and blanks");
        return malformed("document", problem, "export its clips to several files");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::io::{self, Cursor};

    use super::*;

    /// A file of this length: its head, then zeros, each of which is counted when it is read.
    struct LongFile {
        head: Vec<u8>,
        length: u64,
        position: u64,
        read: u64,
    }

    impl Read for LongFile {
        fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
            let count = (bytes.len() as u64).min(self.length - self.position) as usize;
            for byte in &mut bytes[..count] {
                *byte = self.head.get(self.position as usize).copied().unwrap_or(0);
                self.position += 1;
            }
            self.read += count as u64;
            Ok(count)
        }
    }

    impl Seek for LongFile {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            self.position = match to {
                SeekFrom::Start(byte) => byte,
                SeekFrom::End(offset) => self.length.saturating_add_signed(offset),
                SeekFrom::Current(offset) => self.position.saturating_add_signed(offset),
            };
            Ok(self.position)
        }
    }

    fn glb(stated: u32, json: &[u8], binary: u32) -> Vec<u8> {
        let length = (json.len() as u32).to_le_bytes();
        [b"glTF\x02\0\0\0", &stated.to_le_bytes()[..], &length, b"JSON", json, &binary.to_le_bytes(), b"BIN\0"].concat()
    }

    #[test]
    fn padding_and_binary_chunk_are_not_read() {
        let head = glb(3 << 30, b"{}  ", 2 << 30);
        let mut file = LongFile { head: head.clone(), length: 4 << 30, position: 0, read: 0 };
        let chunks = read(&mut file).unwrap();
        assert_eq!(chunks.json, b"{}  ");
        let binary = chunks.binary.unwrap();
        assert_eq!((binary.start, binary.length), (head.len() as u64, 2 << 30));
        assert!(file.read < 1_000, "{}", file.read);
    }

    #[test]
    fn lengths_beyond_the_file_are_rejected() {
        let check = |bytes: Vec<u8>, problem: &str| {
            let found = read(&mut Cursor::new(bytes)).err().unwrap().to_string();
            assert!(found.contains(problem), "{found}");
        };
        check(glb(32, b"{}  ", 1), "the binary chunk states 1 bytes, but the file has 32");
        let mut cut = glb(32, b"{}  ", 0);
        cut[12] = 200;
        check(cut, "the JSON chunk states 200 bytes, but the file has 32");
        check(vec![0; 100], "zero byte");
    }

    #[test]
    fn a_document_has_a_million_objects_at_most() {
        let document = |objects: usize| format!("{{\"nodes\":[{}{{}}]}}", "{},".repeat(objects - 2)).into_bytes();
        assert!(read(&mut Cursor::new(document(OBJECTS_MAX))).is_ok());
        assert!(read(&mut Cursor::new(document(OBJECTS_MAX + 1))).is_err());
        let uri = format!("{{\"uri\":\"\\\"{{{}\"}}", "{".repeat(40 << 20)).into_bytes();
        assert!(read(&mut Cursor::new(uri)).is_ok());
    }
}
