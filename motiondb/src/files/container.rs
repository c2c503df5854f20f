//! The container of a database file: magic number, format version, payload length, and a checksum over header and
//! payload.
//!
//! Layout, little-endian: magic number (8 bytes), version (u32), payload length (u64), CRC-32 of the 20 bytes before it
//! and of the payload (u32), payload. Magic, version, length and checksum are checked before anything is allocated or
//! decoded.

/// Length of the header, bytes.
pub const HEADER_LENGTH: usize = 24;
/// Length of the part of the header that the checksum covers, bytes.
const CHECKED_LENGTH: usize = 20;

/// Reason why bytes are not a container of the expected kind.
///
/// ```
/// use motiondb::files::container::{ContainerError, open, seal};
///
/// const MAGIC: [u8; 8] = *b"MYFORMAT";
/// let bytes = seal(MAGIC, 3, b"payload");
/// assert_eq!(open(MAGIC, 3, &bytes).unwrap().0, b"payload");
/// assert_eq!(open(MAGIC, 4, &bytes), Err(ContainerError::Version { found: 3, supported: 4 }));
/// ```
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ContainerError {
    /// The bytes do not begin with the expected magic number.
    #[error("it does not begin with the expected magic number")]
    Magic,
    /// Another version of the program wrote the file.
    #[error("it has format version {found}; this program reads version {supported}")]
    Version {
        /// Format version of the file.
        found: u32,
        /// Format version that this program reads.
        supported: u32,
    },
    /// The file ends within the header.
    #[error("it has only {present} bytes, fewer than the header's {HEADER_LENGTH}")]
    HeaderCut {
        /// Length of the file, bytes.
        present: usize,
    },
    /// The payload is shorter or longer than the header states.
    #[error("its header states {stated} bytes of payload, but {present} follow")]
    Length {
        /// Length that the header states, bytes.
        stated: u64,
        /// Length of the file after the header, bytes.
        present: u64,
    },
    /// The checksum does not match.
    #[error("its checksum is {found:08x}, but its bytes give {computed:08x}")]
    Checksum {
        /// Checksum that the header states.
        found: u32,
        /// Checksum of the bytes.
        computed: u32,
    },
}

/// The container of a payload, as bytes.
pub fn seal(magic: [u8; 8], version: u32, payload: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(HEADER_LENGTH + payload.len());
    bytes.extend_from_slice(&magic);
    bytes.extend_from_slice(&version.to_le_bytes());
    bytes.extend_from_slice(&(payload.len() as u64).to_le_bytes());
    let checksum = checksum(&bytes, payload);
    bytes.extend_from_slice(&checksum.to_le_bytes());
    bytes.extend_from_slice(payload);
    bytes
}

/// The format version that the header states; `None` where the header is cut.
pub fn stated_version(bytes: &[u8]) -> Option<u32> {
    bytes.first_chunk().map(|header| u32_at(header, 8))
}

/// Checks a container; returns payload and checksum.
///
/// # Errors
/// If magic, version, length or checksum is wrong; the first of them that is.
pub fn open(magic: [u8; 8], version: u32, bytes: &[u8]) -> Result<(&[u8], u32), ContainerError> {
    let (header, payload) = checked_header(magic, version, bytes, bytes.len() as u64)?;
    let (found, computed) = (u32_at(header, CHECKED_LENGTH), checksum(&header[..CHECKED_LENGTH], payload));
    if found != computed {
        return Err(ContainerError::Checksum { found, computed });
    }
    Ok((payload, computed))
}

/// Checks the header of a container of which only the beginning is read; `length` is that of the whole.
///
/// # Errors
/// If magic, version or length is wrong; the first of them that is.
pub fn check_header(magic: [u8; 8], version: u32, beginning: &[u8], length: u64) -> Result<(), ContainerError> {
    checked_header(magic, version, beginning, length).map(|_| ())
}

/// The header, and what is read of the payload.
fn checked_header(
    magic: [u8; 8],
    version: u32,
    beginning: &[u8],
    length: u64,
) -> Result<(&[u8; HEADER_LENGTH], &[u8]), ContainerError> {
    let Some((header, payload)) = beginning.split_first_chunk::<HEADER_LENGTH>() else {
        return Err(if beginning.starts_with(&magic) {
            ContainerError::HeaderCut { present: beginning.len() }
        } else {
            ContainerError::Magic
        });
    };
    if header[..8] != magic {
        return Err(ContainerError::Magic);
    }
    let found = u32_at(header, 8);
    if found != version {
        return Err(ContainerError::Version { found, supported: version });
    }
    let stated = u64::from(u32_at(header, 12)) | u64::from(u32_at(header, 16)) << 32;
    let present = length.saturating_sub(HEADER_LENGTH as u64);
    if stated != present {
        return Err(ContainerError::Length { stated, present });
    }
    Ok((header, payload))
}

fn u32_at(header: &[u8; HEADER_LENGTH], start: usize) -> u32 {
    u32::from_le_bytes([header[start], header[start + 1], header[start + 2], header[start + 3]])
}

fn checksum(header: &[u8], payload: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(header);
    hasher.update(payload);
    hasher.finalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    const MAGIC: [u8; 8] = *b"FBTESTED";

    #[test]
    fn no_altered_or_cut_container_opens() {
        let payload = b"the quick brown fox";
        let sealed = seal(MAGIC, 1, payload);
        assert_eq!(open(MAGIC, 1, &sealed).unwrap().0, payload);
        for position in 0..sealed.len() {
            let mut altered = sealed.clone();
            altered[position] ^= 0x40;
            assert!(open(MAGIC, 1, &altered).is_err(), "byte {position}");
            assert!(open(MAGIC, 1, &sealed[..position]).is_err(), "cut at {position}");
        }
    }
}
