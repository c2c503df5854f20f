//! A folder of stored results: one file a result, named by its key.
//!
//! A file is a [container](motiondb::files::container) (checksum, length, version) of key and result. It appears
//! complete or not at all, and is not forced onto the disk: a file that a power failure cuts has a wrong checksum. What
//! cannot be read or written is left out without an error.

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::SystemTime;

use motiondb::files::atomic_file::AtomicFile;
use motiondb::files::container;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::retarget::human_clip::Digest;

/// Beginning of each file.
const MAGIC: [u8; 8] = *b"FBCACHE\0";
/// Version of the files' layout.
const VERSION: u32 = 2;
/// End of the name of each file.
const SUFFIX: &str = ".fbcache";
/// Greatest size of one result, bytes: that of an hour of capture at rest.
const RESULT_LIMIT: usize = 1 << 30;

/// A folder of stored results.
#[derive(Debug)]
pub(crate) struct CacheFolder {
    folder: PathBuf,
    /// Greatest size of all files that the present compilation did not use, bytes.
    unused_limit: u64,
    /// Keys of the results that the present compilation used.
    used: Mutex<BTreeSet<Digest>>,
}

impl CacheFolder {
    /// Opens a folder, and creates it where there is none.
    ///
    /// # Errors
    /// If it cannot be created.
    pub(crate) fn open(folder: &Path, unused_limit: u64) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        Ok(Self { folder: folder.to_owned(), unused_limit, used: Mutex::default() })
    }

    /// The result of a key; `None` where the folder holds none that is whole.
    pub(crate) fn get<T: DeserializeOwned>(&self, key: &Digest) -> Option<T> {
        let bytes = fs::read(self.path(key)).ok()?;
        let (payload, _) = container::open(MAGIC, VERSION, &bytes).ok()?;
        let result = payload.strip_prefix(key.as_slice())?;
        let (result, used) = bincode::serde::decode_from_slice(result, encoding()).ok()?;
        if used + key.len() != payload.len() {
            return None;
        }
        self.mark_used(key);
        Some(result)
    }

    /// Stores the result of a key.
    pub(crate) fn put(&self, key: &Digest, result: &impl Serialize) {
        let mut payload = key.to_vec();
        if bincode::serde::encode_into_std_write(result, &mut payload, encoding()).is_err() {
            return;
        }
        let write = || {
            let mut file = AtomicFile::create(&self.path(key))?;
            file.writer().write_all(&container::seal(MAGIC, VERSION, &payload))?;
            file.commit_unsynced()
        };
        if write().is_ok() {
            self.mark_used(key);
        }
    }

    /// Removes the oldest of the files that the present compilation did not use, until the others are small enough.
    pub(crate) fn remove_old(&self) {
        let used = self.used.lock().unwrap_or_else(PoisonError::into_inner);
        let used: BTreeSet<PathBuf> = used.iter().map(|key| self.path(key)).collect();
        let mut unused: Vec<(SystemTime, PathBuf, u64)> = Vec::new();
        for entry in fs::read_dir(&self.folder).into_iter().flatten().flatten() {
            let path = entry.path();
            let Ok(found) = entry.metadata() else { continue };
            if found.is_file() && is_result(&path) && !used.contains(&path) {
                unused.push((found.modified().unwrap_or(SystemTime::UNIX_EPOCH), path, found.len()));
            }
        }
        unused.sort();
        let mut size: u64 = unused.iter().map(|(.., size)| size).sum();
        for (_, path, bytes) in unused {
            if size <= self.unused_limit {
                break;
            }
            // A file that cannot be removed does no harm.
            let _ = fs::remove_file(path);
            size -= bytes;
        }
    }

    fn mark_used(&self, key: &Digest) {
        self.used.lock().unwrap_or_else(PoisonError::into_inner).insert(*key);
    }

    fn path(&self, key: &Digest) -> PathBuf {
        let letters: String = key.iter().map(|byte| format!("{byte:02x}")).collect();
        self.folder.join(letters + SUFFIX)
    }
}

/// Whether a file is one of a cache, by its name.
fn is_result(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str()).and_then(|name| name.strip_suffix(SUFFIX));
    name.is_some_and(|name| name.len() == 2 * size_of::<Digest>() && name.bytes().all(|b| b.is_ascii_hexdigit()))
}

fn encoding() -> impl bincode::config::Config {
    bincode::config::standard().with_fixed_int_encoding().with_limit::<RESULT_LIMIT>()
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEYS: [Digest; 3] = [[7; 32], [8; 32], [9; 32]];

    fn folder(unused_limit: u64) -> (tempfile::TempDir, CacheFolder) {
        let path = tempfile::tempdir().unwrap();
        let cache = CacheFolder::open(&path.path().join("new"), unused_limit).unwrap();
        (path, cache)
    }

    #[test]
    fn only_whole_results_of_their_own_key_are_read() {
        let (_path, cache) = folder(0);
        let result = vec![1.5_f64, -2.0, 3.25];
        assert_eq!(cache.get::<Vec<f64>>(&KEYS[0]), None);
        cache.put(&KEYS[0], &result);
        assert_eq!(cache.get(&KEYS[0]), Some(result.clone()));
        let (whole, file) = (fs::read(cache.path(&KEYS[0])).unwrap(), cache.path(&KEYS[0]));
        for position in 0..whole.len() {
            let mut altered = whole.clone();
            altered[position] ^= 0x10;
            for bytes in [&altered[..], &whole[..position]] {
                fs::write(&file, bytes).unwrap();
                assert_eq!(cache.get::<Vec<f64>>(&KEYS[0]), None, "byte {position}");
            }
        }
        fs::write(cache.path(&KEYS[1]), &whole).unwrap();
        assert_eq!(cache.get::<Vec<f64>>(&KEYS[1]), None);
        cache.put(&KEYS[0], &result);
        assert_eq!(cache.get(&KEYS[0]), Some(result));
    }

    #[test]
    fn the_oldest_unused_results_are_removed() {
        let (path, cache) = folder(0);
        KEYS.iter().for_each(|key| cache.put(key, &vec![0_u8; 100]));
        let own = path.path().join("new/notes.txt");
        fs::write(&own, "mine").unwrap();
        let file_bytes = fs::metadata(cache.path(&KEYS[0])).unwrap().len();
        let at = |seconds| SystemTime::UNIX_EPOCH + std::time::Duration::from_secs(seconds);
        for (key, seconds) in KEYS.iter().zip([300, 100, 200]) {
            fs::File::options().write(true).open(cache.path(key)).unwrap().set_modified(at(seconds)).unwrap();
        }
        let later = CacheFolder::open(&path.path().join("new"), file_bytes).unwrap();
        later.remove_old();
        assert_eq!(KEYS.map(|key| later.path(&key).exists()), [true, false, false]);
        cache.remove_old();
        assert!(own.exists() && cache.path(&KEYS[0]).exists());
    }

    #[test]
    fn a_folder_that_cannot_be_written_is_no_error() {
        let (path, cache) = folder(0);
        fs::remove_dir(path.path().join("new")).unwrap();
        cache.put(&KEYS[0], &1_u8);
        cache.remove_old();
        assert_eq!(cache.get::<u8>(&KEYS[0]), None);
    }
}
