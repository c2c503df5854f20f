//! JSON in a chunk, compressed by zlib: the length of the text in bytes, u32, then the compressed text.
//!
//! Numbers are written with the fewest digits that give the same f32 or f64 again. A reader ignores keys that it does
//! not know, and gives missing keys their defaults. A few compressed bytes can stand for gigabytes, so the text may be at
//! most [`RATIO_MAX`] times as long; text that compresses better is stored as it is.

use std::io::{self, Read, Write};

use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Greatest length of a text, bytes; a million agents with ten waypoints each take 400 MB.
const TEXT_MAX_BYTES: usize = 512 << 20;
/// Greatest length of a payload, bytes: that of a text that is stored as it is, with what zlib adds.
pub(crate) const PAYLOAD_MAX_BYTES: u64 = TEXT_MAX_BYTES as u64 + (1 << 20);
/// Greatest length of a text, relative to its compressed bytes; measured on headers: 2 to 15.
const RATIO_MAX: usize = 64;

/// The payload of a chunk with this value.
///
/// # Errors
/// If the value cannot be JSON, or its text is too long.
pub(crate) fn encode(value: &impl Serialize) -> io::Result<Vec<u8>> {
    zip_text(&serde_json::to_vec(value)?)
}

/// The payload of a chunk with this text.
///
/// # Errors
/// If the text is too long.
pub fn zip_text(text: &[u8]) -> io::Result<Vec<u8>> {
    if text.len() > TEXT_MAX_BYTES {
        return Err(io::Error::other("the header or the list of agents is longer than 512 MiB"));
    }
    let compressed = zipped(text, Compression::default())?;
    if text.len() / RATIO_MAX < compressed.len() { Ok(compressed) } else { zipped(text, Compression::none()) }
}

fn zipped(text: &[u8], compression: Compression) -> io::Result<Vec<u8>> {
    let mut payload = ZlibEncoder::new((text.len() as u32).to_le_bytes().to_vec(), compression);
    payload.write_all(text)?;
    payload.finish()
}

/// The value of a chunk's payload.
///
/// # Errors
/// What is wrong with the payload.
pub(crate) fn decode<T: DeserializeOwned>(payload: &[u8]) -> Result<T, String> {
    serde_json::from_slice(&unzip_text(payload)?).map_err(|error| error.to_string())
}

/// The text of a chunk's payload.
///
/// # Errors
/// What is wrong with the payload.
pub fn unzip_text(payload: &[u8]) -> Result<Vec<u8>, String> {
    let (length, compressed) = payload.split_first_chunk::<4>().ok_or("its length is missing")?;
    let length = u32::from_le_bytes(*length) as usize;
    if length > TEXT_MAX_BYTES || length / RATIO_MAX > compressed.len() {
        return Err(format!("{} bytes cannot hold a text of {length}", compressed.len()));
    }
    let mut text = Vec::new();
    text.try_reserve_exact(length).map_err(|_| format!("there is no memory for a text of {length} bytes"))?;
    // One byte more than stated, to detect a text that is too long.
    let read = ZlibDecoder::new(compressed).take(length as u64 + 1).read_to_end(&mut text);
    if read.is_err() || text.len() != length {
        return Err(format!("it does not hold a text of {length} bytes"));
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn forged_lengths_and_bombs_are_rejected() {
        let payload = encode(&vec![1.5_f32; 100]).unwrap();
        assert_eq!(decode::<Vec<f32>>(&payload).unwrap(), [1.5; 100]);
        let forged = |length: u32| [&length.to_le_bytes(), &payload[4..]].concat();
        for length in [0, 1, payload.len() as u32, u32::MAX] {
            assert!(decode::<Vec<f32>>(&forged(length)).is_err(), "{length}");
        }
        let bomb = zipped(&vec![b' '; 64 << 20], Compression::best()).unwrap();
        assert!(decode::<Vec<f32>>(&bomb).unwrap_err().contains("cannot hold a text"));
        assert!(decode::<Vec<f32>>(&payload[..3]).is_err() && decode::<Vec<f32>>(&payload[..9]).is_err());
    }

    #[test]
    fn text_that_compresses_well_is_stored() {
        let zeros = vec![0_u8; 1 << 20];
        assert_eq!(decode::<Vec<u8>>(&encode(&zeros).unwrap()).unwrap(), zeros);
    }

    proptest! {
        #[test]
        fn every_finite_f32_comes_back_exactly(bits in any::<u32>()) {
            let value = f32::from_bits(bits);
            prop_assume!(value.is_finite());
            let back: f32 = decode(&encode(&value).unwrap()).unwrap();
            prop_assert_eq!(back.to_bits(), bits);
        }
    }
}
