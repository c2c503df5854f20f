//! Files of other formats, recognised by their first bytes or by their names, so that an error can name the way to a
//! format that is read.

use std::ffi::OsStr;
use std::path::Path;

/// What converts most formats of motion.
const BY_BLENDER: &str = "Blender imports it and exports glTF (*.glb)";

/// A format that is recognised and not read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ForeignFormat {
    /// What the file is.
    pub name: &'static str,
    /// How to make a clip of it.
    pub remedy: &'static str,
}

/// First bytes of each format, and the format.
const SIGNATURES: [(&[u8], ForeignFormat); 12] = [
    (b"Kaydara FBX Binary", FBX),
    (b"; FBX", FBX),
    (b"PK\x03\x04", ForeignFormat { name: "a zip archive", remedy: "unpack it, and name the clips in it" }),
    (b"\x1f\x8b", ForeignFormat { name: "a gzip archive", remedy: "unpack it, and name the clips in it" }),
    (b"7z\xbc\xaf\x27\x1c", ForeignFormat { name: "a 7z archive", remedy: "unpack it, and name the clips in it" }),
    (b"Rar!", ForeignFormat { name: "a rar archive", remedy: "unpack it, and name the clips in it" }),
    (
        b"version https://git-lfs.github.com",
        ForeignFormat {
            name: "a git-LFS pointer, not the clip itself",
            remedy: "run `git lfs pull` in its repository",
        },
    ),
    (b"<!doctype html", WEB_PAGE),
    (b"<html", WEB_PAGE),
    (b"BLENDER", ForeignFormat { name: "a Blender project", remedy: "export glTF (*.glb) from Blender" }),
    (b"#usda", USD),
    (b"PXR-USDC", USD),
];
const FBX: ForeignFormat = ForeignFormat { name: "an FBX file", remedy: BY_BLENDER };
const USD: ForeignFormat = ForeignFormat { name: "a USD file", remedy: BY_BLENDER };
const WEB_PAGE: ForeignFormat =
    ForeignFormat { name: "a web page", remedy: "download the clip itself, not the page that shows it" };
/// Extensions of each format, and the format.
const EXTENSIONS: [(&str, ForeignFormat); 8] = [
    ("fbx", FBX),
    ("usd", USD),
    ("usda", USD),
    ("usdc", USD),
    ("blend", ForeignFormat { name: "a Blender project", remedy: "export glTF (*.glb) from Blender" }),
    (
        "dae",
        ForeignFormat { name: "a Collada file", remedy: "convert it to glTF (*.glb) with a tool that reads Collada" },
    ),
    (
        "c3d",
        ForeignFormat { name: "a C3D file of markers", remedy: "solve a skeleton in a capture tool, and export BVH" },
    ),
    ("zip", ForeignFormat { name: "a zip archive", remedy: "unpack it, and name the clips in it" }),
];

impl ForeignFormat {
    /// The format that the first bytes of a file show.
    pub fn of_bytes(bytes: &[u8]) -> Option<Self> {
        let is_space = |byte: &u8| byte.is_ascii_whitespace();
        let text = &bytes[bytes.iter().take_while(|byte| is_space(byte)).count()..];
        let begins =
            |signature: &[u8]| text.get(..signature.len()).is_some_and(|head| head.eq_ignore_ascii_case(signature));
        SIGNATURES.into_iter().find(|(signature, _)| begins(signature)).map(|(_, format)| format)
    }

    /// The format that the extension of a path names, in any case of letters.
    pub fn of_name(path: &Path) -> Option<Self> {
        let extension = path.extension().and_then(OsStr::to_str)?;
        EXTENSIONS.into_iter().find(|(name, _)| extension.eq_ignore_ascii_case(name)).map(|(_, format)| format)
    }
}
