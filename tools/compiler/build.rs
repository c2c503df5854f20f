//! Digest of what results of the compiler follow from, its sources and the version of rustc, for the keys of its cache: a
//! program that may compute otherwise finds no result of this one. Environment variable `COMPILER_SOURCES` of the build.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// Sources beside this package: its own, those of the library that it uses, and the versions of all other libraries.
const SOURCES: [&str; 3] = ["src", "../../motiondb/src", "../../Cargo.lock"];

fn main() {
    let mut files = Vec::new();
    for source in SOURCES.map(Path::new) {
        println!("cargo:rerun-if-changed={}", source.display());
        collect(source, &mut files);
    }
    files.sort();
    let mut digest = Fnv::default();
    digest.add(&rustc_version());
    for file in &files {
        digest.add(file.to_string_lossy().as_bytes());
        digest.add(&fs::read(file).unwrap_or_default());
    }
    println!("cargo:rustc-env=COMPILER_SOURCES={}-{:016x}", env!("CARGO_PKG_VERSION"), digest.0);
}

/// What `rustc --version` prints: release, commit and date. The machine does not count, so that a cache can be copied.
fn rustc_version() -> Vec<u8> {
    println!("cargo:rerun-if-env-changed=RUSTC");
    let rustc = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let printed = Command::new(&rustc).arg("--version").output();
    printed.unwrap_or_else(|error| panic!("{} --version: {error}", rustc.display())).stdout
}

/// The files below a path; none where there is nothing, as in a published package.
fn collect(path: &Path, files: &mut Vec<PathBuf>) {
    if path.is_dir() {
        let entries = fs::read_dir(path).into_iter().flatten().flatten();
        entries.for_each(|entry| collect(&entry.path(), files));
    } else if path.is_file() {
        files.push(path.to_owned());
    }
}

/// The hash of Fowler, Noll and Vo, 64 bits (FNV-1a).
struct Fnv(u64);

impl Default for Fnv {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fnv {
    /// Adds bytes and their number.
    fn add(&mut self, bytes: &[u8]) {
        for byte in bytes.len().to_le_bytes().iter().chain(bytes) {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}
