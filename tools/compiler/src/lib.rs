//! Motion clips in, motion database out.
//!
//! The compiler reads BVH and glTF files of one or many performers, finds the body in each skeleton, retargets it to
//! the canonical humanoid, finds steady gaits in its motion and closes them to cycles. The resulting
//! [`MotionDb`](motiondb::motion::MotionDb) is what the runtime blends. It depends on the clips alone: not on folders,
//! the order of files or the number of threads.
//!
//! # Example
//! Compile a folder of clips and print its examples.
//!
//! ```
//! use std::path::Path;
//!
//! use motiondb_compiler::{clip_files, compile_files};
//!
//! let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/clips");
//! let compiled = compile_files(&clip_files(&folder)?, &|_| ())?;
//! for rejection in &compiled.rejected {
//!     println!("rejected: {rejection}");
//! }
//! for example in &compiled.db.examples {
//!     println!("{}: {:.2} m/s", example.name, example.parameters.speed_mps);
//! }
//! assert!(compiled.db.examples.iter().any(|example| example.name == "walk_110"));
//! # Ok::<(), motiondb_compiler::CompileError>(())
//! ```
//!
//! A [`Manifest`] states what the compiler need not find, and options of the set; [`compile_manifest`] follows it.
//! [`import_file`] gives the human clips of one file; [`mod@survey`] reports on clips without a database.
//!
//! # Chapters
//! [`mod@compile`] lists the stages, one line each. In their order: [`input`] → [`read`] → [`rig`] → [`retarget`] with
//! `checks` (together [`mod@import`]) → [`ground`] → [`gait`] → [`cycle`] → [`dedup`], [`select`], `action` → [`database`].
//! [`extra_joints`] are carried along: fingers, toes and twist bones.
//!
//! [`cache`] keeps results of import, analysis and comparison for the next compilation.
//!
//! Apart from them, [`character`] compiles the skinned figures that bodies wear.
//!
//! # Conventions
//! Source clips have their file's unit and axes until `retarget`. From there on: metres, seconds, radians; x and y on
//! the ground, z up, right-handed; angles counter-clockwise seen from above. A body's frame: x forward, y left. Pairs
//! of sides are `[left, right]`. (v_f, ω_t, ω_s) are forward speed, turn rate and speed to the left.

mod action;
pub mod cache;
pub mod character;
mod checks;
pub mod compile;
pub mod cycle;
pub mod database;
pub mod dedup;
pub mod error;
pub mod extra_joints;
mod frame_runs;
pub mod gait;
pub mod ground;
pub mod import;
pub mod input;
pub mod progress;
pub mod read;
pub mod retarget;
pub mod rig;
pub mod select;
mod styles;
pub mod survey;
#[cfg(test)]
mod synthetic;
mod transition;

pub use cache::Cache;
pub use compile::{Compiled, compile, compile_files, compile_manifest, compile_with_cache};
pub use error::{CompileError, ManifestKey, Rejection, RejectionReason};
pub use import::{ImportedClip, import_bytes, import_file, import_with_settings};
pub use input::{ClipSet, ClipSettings, Manifest, Options, clip_files, foreign_files, import_clip_set, linked_files};
pub use progress::{CompileEvent, Observer};
pub use read::Axis;
pub use read::gltf::Outside;
pub use retarget::HumanClip;
