//! The generator of the bundled clips: human locomotion made from published gait science, without motion capture.
//!
//! ```
//! let files = clipgen::generate();
//! let idle = files.iter().find(|file| file.name == "idle.bvh").ok_or("no such clip")?;
//! assert!(idle.bytes.starts_with(b"HIERARCHY"));
//! # Ok::<(), &str>(())
//! ```
//!
//! Every byte follows from this source: no input, no clock, no seed but the clips' names, trigonometry through `libm`.
//!
//! Chapters, in reading order: `body` (skeleton and poses), `plan` (what a speed makes of a gait), `motion` (from plan
//! to poses), `files` (BVH, GLB, README). `catalogue` lists the clips; [`mod@reference`] is what the result is compared
//! with.

mod body;
mod catalogue;
#[cfg(test)]
mod claims;
mod files;
mod motion;
mod plan;
pub mod reference;

/// One file of `assets/clips`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClipFile {
    /// File name, with extension and without folders.
    pub name: String,
    /// Content of the file.
    pub bytes: Vec<u8>,
}

/// Every file of `assets/clips`: the clips, then the README that lists them.
pub fn generate() -> Vec<ClipFile> {
    let clips = catalogue::planned_clips();
    let mut clip_files: Vec<ClipFile> = clips.iter().map(clip_file).collect();
    clip_files.push(ClipFile { name: "README.md".to_owned(), bytes: files::readme_bytes(&clips) });
    clip_files
}

fn clip_file(clip: &catalogue::PlannedClip) -> ClipFile {
    let poses = clip.poses();
    let bytes = if clip.is_skinned() { files::glb_bytes(clip.name, &poses) } else { files::bvh_bytes(&poses) };
    ClipFile { name: clip.file_name(), bytes }
}
