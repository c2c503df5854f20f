//! The generator of the bundled clips: human locomotion made from gait science, nobody's motion capture.
//!
//! In reading order: whose body (`body`), what is published of its joints (`published_curves`) and what a speed makes
//! of a gait (`cadence`); no two strides alike (`variation`); where the feet stand (`footsteps`, `steps`), roll
//! (`foot_roll`) and swing (`swing`); the pelvis over them (`pelvis`), the legs between (`legs`), trunk, head and arms
//! (`upper_body`); all assembled (`stepping`) or standing (`idle`); the list of clips (`catalogue`) and their files
//! (`bvh_writer`; `body_mesh`, `glb_buffer` and `glb_writer`; `readme`). What the result is held against:
//! [`mod@reference`].
//!
//! Every byte follows from this source: no input, no clock, no seed but the clips' names, trigonometry through `libm`.

mod body;
mod body_mesh;
mod bvh_writer;
mod cadence;
mod catalogue;
#[cfg(test)]
mod claims;
mod foot_roll;
mod footsteps;
mod glb_buffer;
mod glb_writer;
mod idle;
mod legs;
mod pelvis;
mod published_curves;
mod readme;
pub mod reference;
mod rotation;
mod stepping;
mod steps;
mod swing;
mod upper_body;
mod variation;

/// One file of `assets/clips`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClipFile {
    /// File name, with extension and without folders.
    pub name: String,
    /// Its content.
    pub bytes: Vec<u8>,
}

/// Every file of `assets/clips`: the clips, then the README that lists them.
pub fn generate() -> Vec<ClipFile> {
    let clips = catalogue::clips();
    let mut files: Vec<ClipFile> =
        clips.iter().map(|clip| ClipFile { name: clip.file_name(), bytes: file_bytes(clip) }).collect();
    files.push(ClipFile { name: "README.md".to_owned(), bytes: readme::write(&clips) });
    files
}

fn file_bytes(clip: &catalogue::Clip) -> Vec<u8> {
    if clip.is_skinned() { glb_writer::write(clip.name, &clip.poses()) } else { bvh_writer::write(&clip.poses()) }
}
