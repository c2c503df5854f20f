//! Clips in: from files and folders to [`HumanClip`]s.
//!
//! # Steps
//! read ([`crate::read::bvh`], [`crate::read::gltf`]) → what a manifest corrects (`clip_settings`) → roles
//! (`roles`) and facing (`facing`) → metres, Z up ([`crate::retarget::units`]) → no separate first pose
//! (`first_pose`) → whole-clip parameters (`source_parameters`) → no T-poses (`first_pose`) → a plausible gait
//! (`plausibility`) on level ground (`carried`) → canonical humanoid (`retarget`) → a plausible body.

use std::fs;
use std::path::{Path, PathBuf};

use motiondb::body::Joint;
use motiondb::diagnostic::{Diagnostic, Warning};
use motiondb::files::input_file;
use rayon::prelude::*;

use crate::checks::{level_ground, plausibility};
use crate::error::{ImportError, MIN_FRAMES, Refusal, Setting};
use crate::input::clip_settings::{Settings, Take};
use crate::read::bvh;
use crate::read::gltf::{self, GltfFile};
use crate::read::source_clip::SourceClip;
use crate::retarget::human_clip::{HumanClip, HumanPose};
use crate::retarget::source_parameters::{self, WholeClip};
use crate::retarget::{to_humanoid, trim_t_poses, units};
use crate::rig::facing;
use crate::rig::roles::{Roles, find_roles};

/// Cosine of half the least angle that is a turn (0.05°), and the least swing of a leg, over its length.
const UNTURNED: f64 = 1.0 - 1e-7;
const SWING_MIN: f64 = 0.02;

/// One clip of a file: a human motion, or why it is none.
#[derive(Clone, Debug)]
pub struct Import {
    /// File name without folders.
    pub file: String,
    /// Clip within the file; empty where a file holds one unnamed clip.
    pub clip: String,
    /// The clip on the canonical humanoid.
    pub outcome: Result<HumanClip, Refusal>,
}

/// Imports every clip of a `.bvh`, `.glb` or `.gltf` file. A refused clip hides no other.
///
/// # Errors
/// [`ImportError`] where the file itself cannot be read as motion.
pub fn import(path: &Path) -> Result<Vec<Import>, ImportError> {
    import_take(&Take::from(path.to_owned()))
}

/// As [`import`], with what a manifest says of the file.
///
/// # Errors
/// As [`import`].
pub fn import_take(take: &Take) -> Result<Vec<Import>, ImportError> {
    let path = &take.path;
    let bytes = input_file::read(path).map_err(|source| ImportError::Unreadable { file: path.clone(), source })?;
    import_read(take, &bytes)
}

/// As [`import`], from the bytes of a file; `path` gives the format, the names and the folder of glTF buffers.
///
/// # Errors
/// As [`import`].
pub fn import_bytes(path: &Path, bytes: &[u8]) -> Result<Vec<Import>, ImportError> {
    import_read(&Take::from(path.to_owned()), bytes)
}

fn import_read(take: &Take, bytes: &[u8]) -> Result<Vec<Import>, ImportError> {
    let path = take.path.as_path();
    match Format::of(path).ok_or_else(|| ImportError::UnknownFormat { file: path.to_owned() })? {
        Format::Bvh => import_bvh(take, bvh::read(path, bytes)?),
        Format::Gltf => import_gltf(take, &GltfFile::open(path, bytes)?),
    }
}

fn import_bvh(take: &Take, clip: SourceClip) -> Result<Vec<Import>, ImportError> {
    Ok(vec![match &take.animation {
        Some(animation) => no_animation(take, animation, &[""]),
        None => import_clip(clip, take, false),
    }])
}

/// Clip by clip: of thousands of animations only their people are kept. One that is malformed hides no other, unless
/// all are.
fn import_gltf(take: &Take, file: &GltfFile) -> Result<Vec<Import>, ImportError> {
    let several = file.len() > 1;
    if let Some(animation) = &take.animation {
        let Some(index) = (0..file.len()).find(|&index| file.name(index) == animation) else {
            let names: Vec<&str> = (0..file.len()).map(|index| file.name(index)).collect();
            return Ok(vec![no_animation(take, animation, &names)]);
        };
        return Ok(vec![import_clip(file.clip(index)?, take, several && take.settings.name.is_none())]);
    }
    let read = |index| file.clip(index).map(|clip| import_clip(clip, take, several));
    let mut imports: Vec<_> = (0..file.len()).into_par_iter().map(read).collect();
    if let Some(malformed) = imports.iter().position(Result::is_err).filter(|_| imports.iter().all(Result::is_err)) {
        return imports.swap_remove(malformed).map(|import| vec![import]);
    }
    let refused = |index, error: ImportError| Import {
        file: file_name(&take.path),
        clip: file.name(index).to_owned(),
        outcome: Err(Refusal::Malformed { reason: error.reason() }),
    };
    let or_refused = |(index, import): (usize, Result<_, _>)| import.unwrap_or_else(|error| refused(index, error));
    Ok(imports.into_iter().enumerate().map(or_refused).collect())
}

fn no_animation(take: &Take, animation: &str, names: &[&str]) -> Import {
    let names = if *names == [""] { "a motion without name".to_owned() } else { names.join(", ") };
    let reason = format!("there is no animation `{animation}`, but {names}");
    let remedy = "name what is there, or remove the key";
    let outcome = Err(Refusal::Setting { setting: Setting::Animation, reason, remedy });
    Import { file: file_name(&take.path), clip: animation.to_owned(), outcome }
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Every `*.bvh`, `*.glb`, `*.gltf` below a folder, sorted by path; not what is hidden by a dot in front, as the
/// `._walk.bvh` beside each `walk.bvh` that a Mac packs.
///
/// # Errors
/// Where a folder cannot be read.
pub fn clip_files(folder: &Path) -> Result<Vec<PathBuf>, ImportError> {
    let unreadable = |source| ImportError::Unreadable { file: folder.to_owned(), source };
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let entry = entry.map_err(unreadable)?;
        if entry.file_name().as_encoded_bytes().starts_with(b".") {
            continue;
        }
        // A link to a folder is not followed: it may lead back here.
        if entry.file_type().map_err(unreadable)?.is_dir() {
            files.extend(clip_files(&entry.path())?);
        } else if Format::of(&entry.path()).is_some() {
            files.push(entry.path());
        }
    }
    files.sort();
    Ok(files)
}

/// The buffers and pictures beside a glTF file, which it names and no output may replace; none of what cannot be read.
pub fn linked_files(path: &Path) -> Vec<PathBuf> {
    let Some(Format::Gltf) = Format::of(path) else { return Vec::new() };
    input_file::read(path)
        .map_or_else(|_| Vec::new(), |bytes| gltf::buffers::files_of(path, &gltf::document::uris(&bytes)))
}

enum Format {
    Bvh,
    Gltf,
}

impl Format {
    fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "bvh" => Some(Self::Bvh),
            "glb" | "gltf" => Some(Self::Gltf),
            _ => None,
        }
    }
}

fn import_clip(clip: SourceClip, take: &Take, several: bool) -> Import {
    let stem = take.path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let label = take.settings.name.clone().unwrap_or(stem);
    let name = if several { format!("{label} {}", clip.clip) } else { label };
    // It heads the lines of tables.
    let name = name.replace(char::is_control, "_");
    Import { file: clip.file.clone(), clip: clip.clip.clone(), outcome: to_human(clip, &take.settings, name) }
}

/// Whether joints move and none turns: a file of positions alone, from which no limb's twist can be told.
fn is_unturned(clip: &SourceClip, roles: &Roles) -> bool {
    let joints: Vec<usize> = roles.joints.iter().flatten().copied().collect();
    let turns =
        |frame: usize, joint: usize| clip.orientation(frame, joint).dot(clip.orientation(0, joint)).abs() < UNTURNED;
    let [hip, foot] = [Joint::LeftThigh, Joint::LeftFoot].map(|joint| roles.required(joint));
    let leg = |frame: usize| clip.position(frame, foot) - clip.position(frame, hip);
    let swings = |frame: usize| leg(frame).distance(leg(0)) > SWING_MIN * leg(0).length();
    let mut frames = 0..clip.frame_count();
    !frames.clone().any(|frame| joints.iter().any(|&joint| turns(frame, joint))) && frames.any(swings)
}

fn to_human(mut clip: SourceClip, settings: &Settings, name: String) -> Result<HumanClip, Refusal> {
    if clip.frame_count() == 0 {
        return Err(Refusal::Motionless);
    }
    settings.correct(&mut clip)?;
    if clip.frame_count() < MIN_FRAMES {
        return Err(Refusal::TooShort);
    }
    let mut roles = find_roles(&clip, &settings.joint_map(&clip)?)?;
    if is_unturned(&clip, &roles) {
        return Err(Refusal::Unturned);
    }
    if let Some(forward) = settings.forward {
        facing::face(&clip, &mut roles, forward)?;
    }
    if roles.names_belied {
        clip.diagnostics.push(Diagnostic::Warning(Warning::SidesExchanged));
    }
    if settings.metres_per_unit.is_none() {
        plausibility::doubt_unit(&mut clip, &roles);
    }
    let contradicted_up = plausibility::contradicted_up(&clip, &roles);
    let (mut clip, units) = units::to_metres_z_up(clip, &roles);
    let whole = measured(&mut clip, &roles, settings);
    let mut doubts = vec![plausibility::implausible_size(&clip, &roles)];
    // What stands along another axis than up has no feet on the ground.
    let unfit = contradicted_up.or_else(|| {
        doubts.push(level_ground::doubt(&clip, &roles, &whole));
        plausibility::inhuman_gait(&clip, &roles, &whole)
    });
    clip.diagnostics.extend(doubts.into_iter().flatten().map(Diagnostic::Warning));
    let mut human = to_humanoid::to_human(&clip, &roles, &units, whole, name);
    human.unfit = unfit;
    human.choices.mirror = settings.mirror;
    human.choices.is_cut = settings.frames.is_some();
    if !human.frames.iter().all(is_finite) {
        return Err(Refusal::Degenerate);
    }
    plausibility::impossible_body(&human.body).map_or(Ok(human), Err)
}

/// Cuts off what is no part of the motion, unless a manifest does; measures it before its T-poses go.
fn measured(clip: &mut SourceClip, roles: &Roles, settings: &Settings) -> WholeClip {
    let is_cut = settings.frames.is_some();
    if !is_cut {
        trim_t_poses::drop_separate_first_pose(clip, roles);
    }
    let whole = source_parameters::measure(clip, roles);
    if !is_cut {
        trim_t_poses::drop_t_poses(clip, roles);
    }
    whole
}

fn is_finite(pose: &HumanPose) -> bool {
    pose.pelvis_m.is_finite() && pose.rotations.iter().all(|turn| turn.is_finite())
}
