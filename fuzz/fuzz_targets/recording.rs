//! Any bytes as a recording: as they are, and with right checksums, index and tail, so that header and frames are
//! reached; once more with header and list of agents compressed here, so that their texts are reached.
#![no_main]

use std::fs;

use fbcrowd_fuzz::on_disk;
use fbcrowd_sim::measures::measure;
use fbcrowd_sim::recording::{CHUNK_HEAD_BYTES, PACKED_BYTES, Recording, unpack, write_chunk, zip_text};
use libfuzzer_sys::fuzz_target;

/// Magic and version stand before the first chunk.
const HEAD_BYTE: usize = 12;

fuzz_target!(|bytes: &[u8]| {
    read(bytes);
    read(&repaired(bytes, |payload| payload.to_vec()));
    read(&repaired(bytes, |text| zip_text(text).expect("an input is shorter than 512 MiB")));
    // Compression hides agents from most mutations.
    for packed in bytes.chunks_exact(PACKED_BYTES) {
        let _ = unpack(packed);
    }
});

fn read(bytes: &[u8]) {
    let path = on_disk("fbrec", bytes);
    if let Ok(recording) = Recording::open(&path) {
        let _ = measure(&recording);
    }
    fs::remove_file(path).expect("it was written just now");
}

/// The same header, frames and agents in a whole file; `change` is applied to the payloads of header and agents.
fn repaired(bytes: &[u8], change: impl Fn(&[u8]) -> Vec<u8>) -> Vec<u8> {
    let (start, mut rest) = bytes.split_at(bytes.len().min(HEAD_BYTE));
    let (mut file, mut index) = (start.to_vec(), Vec::new());
    let is_version_1 = start.get(8) == Some(&1);
    while let Some((head, after)) = rest.split_first_chunk::<{ CHUNK_HEAD_BYTES as usize }>() {
        let kind = [head[0], head[1], head[2], head[3]];
        let length = u32::from_le_bytes([head[4], head[5], head[6], head[7]]) as usize;
        let (payload, after) = after.split_at(length.min(after.len()));
        rest = after;
        if kind == *b"INDX" {
            break;
        }
        if kind == *b"FRAM" || kind == *b"AGNT" {
            if !is_version_1 {
                index.extend(kind);
            }
            index.extend((file.len() as u64).to_le_bytes());
        }
        match &kind {
            b"HEAD" | b"AGNT" => append(&mut file, kind, &change(payload)),
            _ => append(&mut file, kind, payload),
        }
    }
    let index_byte = file.len() as u64;
    append(&mut file, *b"INDX", &index);
    append(&mut file, *b"TAIL", &index_byte.to_le_bytes());
    file
}

fn append(file: &mut Vec<u8>, kind: [u8; 4], payload: &[u8]) {
    write_chunk(file, kind, payload).expect("an input is shorter than 4 GiB");
}
