//! Files of other formats are named, with the way to a format that is read.

use std::fs;
use std::path::{Path, PathBuf};

use motiondb_compiler::{clip_files, foreign_files, import_bytes, import_file};

/// The message for a file's bytes.
fn message(name: &str, bytes: &[u8]) -> String {
    import_bytes(Path::new(name), bytes).unwrap_err().to_string()
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("foreign_formats").join(name);
    fs::create_dir_all(&folder).unwrap();
    folder
}

#[test]
fn renamed_files_of_other_formats_are_recognised() {
    let files: [(&str, &[u8], &str, &str); 7] = [
        ("walk.bvh", b"Kaydara FBX Binary  \0\x1a\0", "an FBX file", "Blender"),
        ("walk.glb", b"; FBX 7.3.0 project file\n", "an FBX file", "Blender"),
        ("walk.bvh", b"PK\x03\x04\x14\0", "a zip archive", "unpack"),
        ("walk.bvh", b"\n<!DOCTYPE html><html>", "a web page", "download"),
        ("walk.gltf", b"<HTML><body>404", "a web page", "download"),
        ("walk.glb", b"version https://git-lfs.github.com/spec/v1\noid sha256:", "a git-LFS pointer", "git lfs pull"),
        ("walk.bvh", b"PXR-USDC\0", "a USD file", "Blender"),
    ];
    for (name, bytes, format, remedy) in files {
        let message = message(name, bytes);
        assert!(message.starts_with(name) && message.contains(format) && message.contains(remedy), "{message}");
    }
}

#[test]
fn names_of_other_formats_are_recognised() {
    for (name, format) in [("walk.FBX", "an FBX file"), ("walk.c3d", "a C3D file"), ("walk.dae", "a Collada file")] {
        let message = message(name, b"anything");
        assert!(message.contains(format), "{message}");
    }
    assert!(message("walk.txt", b"anything").contains("not a motion clip"));
}

#[test]
fn a_folder_of_other_formats_is_listed() {
    let folder = folder("fbx");
    for name in ["b.fbx", "a.FBX", "notes.txt"] {
        fs::write(folder.join(name), "anything").unwrap();
    }
    assert!(clip_files(&folder).unwrap().is_empty());
    let found = foreign_files(&folder).unwrap();
    let names: Vec<_> = found.iter().map(|(path, format)| (path.file_name().unwrap(), format.name)).collect();
    assert_eq!(names, [("a.FBX".as_ref(), "an FBX file"), ("b.fbx".as_ref(), "an FBX file")]);
}

#[test]
fn a_clip_is_no_foreign_format() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/clips");
    for file in clip_files(&folder).unwrap() {
        assert!(import_file(&file).is_ok(), "{}", file.display());
    }
}
