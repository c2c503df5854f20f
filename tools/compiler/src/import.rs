//! Import: the clips of one file, from bytes to [`HumanClip`]s.
//!
//! # Steps
//! 1. read ([`crate::read::bvh`], [`crate::read::gltf`]) → `SourceMotion` in source units and axes
//! 2. settings of a manifest (`clip_settings`)
//! 3. roles of joints ([`crate::rig`]) in a few frames, or in the rest pose of a body that crawls → `SourceClip`: all
//!    frames of the joints that have roles; the stated facing (`stated_facing`)
//! 4. metres, z up ([`crate::retarget::units`]); of a body that crawls, up as its rest pose stands
//! 5. no separate first pose (`trim_t_poses`), whole-clip parameters (`source_parameters`), no T-poses and no frozen
//!    ends
//! 6. checks of size, gait, ground and poses (`plausibility`, `level_ground`, `pose_jumps`, `uneven_frames`)
//! 7. parts in which the body is not upright (`posture`) or stands in a bind pose (`spread_arms`), canonical humanoid
//!    (`to_humanoid`), check of its body → `HumanClip`

use std::io::{BufRead, BufReader, Cursor, Seek};
use std::path::Path;

use motiondb::body::Joint;
use motiondb::diagnostic::{Diagnostic, Note, Unfit, Warning};
use motiondb::files::input_file;
use rayon::prelude::*;

use crate::checks::pose_jumps::PoseJump;
use crate::checks::{lengthwise_path, level_ground, plausibility, pose_jumps, spread_arms, uneven_frames};
use crate::error::{ManifestKey, Rejection, RejectionReason};
use crate::extra_joints::extra_search::extra_joints;
use crate::input::clip_files::ClipFormat;
use crate::input::clip_settings::ClipSettings;
use crate::read::bvh;
use crate::read::foreign_format::ForeignFormat;
use crate::read::gltf::GltfFile;
use crate::read::source_clip::SourceClip;
use crate::read::source_motion::{JointPoses, SourceMotion};
use crate::retarget::human_clip::{Choices, HumanClip, HumanPose};
use crate::retarget::source_parameters::{SourceParameters, source_parameters};
use crate::retarget::{posture, stated_facing, to_humanoid, trim_t_poses, units};
use crate::rig::rest_pose::RestPose;
use crate::rig::{self, JointMap, Roles};

/// Number of bytes that are read of a file at once.
const READ_BYTES: usize = 1 << 16;
/// Least number of frames of a clip: two positions make one velocity.
const MIN_FRAMES: usize = 2;
/// Cosine of half the least angle by which a joint rotates (0.05°).
const NO_ROTATION_COSINE: f64 = 1.0 - 1e-7;
/// Least displacement of an ankle against its hip in a leg that swings, divided by the distance between both.
const SWING_MIN: f64 = 0.02;

/// One clip of a file, and what import makes of it.
#[derive(Clone, Debug)]
pub struct ImportedClip {
    /// File name without folders.
    pub file: String,
    /// Clip within the file; empty where the file holds one clip without a name.
    pub clip: String,
    /// The clip on the canonical humanoid, or why it is not human motion.
    pub outcome: Result<HumanClip, RejectionReason>,
}

/// The import of the clips of one file.
pub(crate) type Importer<'a> = dyn Fn(&ClipSettings) -> Result<Vec<ImportedClip>, Rejection> + Sync + 'a;

/// All clips of a `.bvh`, `.glb` or `.gltf` file. A rejected clip does not affect the others.
///
/// # Errors
/// The [`Rejection`] of the file if it cannot be read as motion.
pub fn import_file(path: &Path) -> Result<Vec<ImportedClip>, Rejection> {
    import_with_settings(&ClipSettings::from(path.to_owned()))
}

/// All clips of a file, as [`import_file`], with the settings of a manifest.
///
/// # Errors
/// As [`import_file`].
pub fn import_with_settings(settings: &ClipSettings) -> Result<Vec<ImportedClip>, Rejection> {
    let imported = input_file::open(&settings.path)
        .map_err(|error| RejectionReason::unreadable(&error))
        .and_then(|file| imported_clips(settings, BufReader::with_capacity(READ_BYTES, file)));
    imported.map_err(|reason| rejected_file(&settings.path, reason))
}

/// All clips of a file's bytes, as [`import_file`]. `path` gives the format, the names and the folder of glTF buffers.
///
/// ```
/// use std::path::Path;
///
/// use motiondb_compiler::{RejectionReason, import_bytes};
///
/// let point = "HIERARCHY\nROOT Point\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n}\n\
///              MOTION\nFrames: 2\nFrame Time: 0.04\n0 0 0\n0 0 1\n";
/// let clips = import_bytes(Path::new("point.bvh"), point.as_bytes())?;
/// assert_eq!(clips[0].outcome.as_ref().unwrap_err(), &RejectionReason::NoLegs);
///
/// let rejection = import_bytes(Path::new("point.bvh"), b"HIERARCHY\nROOT\n}\n").unwrap_err();
/// assert_eq!(rejection.to_string(), "point.bvh: line 3: `}` without an open joint; repair the braces");
/// # Ok::<(), motiondb_compiler::Rejection>(())
/// ```
///
/// # Errors
/// As [`import_file`].
pub fn import_bytes(path: &Path, bytes: &[u8]) -> Result<Vec<ImportedClip>, Rejection> {
    imported_clips(&ClipSettings::from(path.to_owned()), Cursor::new(bytes))
        .map_err(|reason| rejected_file(path, reason))
}

fn rejected_file(path: &Path, reason: RejectionReason) -> Rejection {
    Rejection { file: path.display().to_string(), clip: String::new(), reason }
}

fn imported_clips(
    settings: &ClipSettings,
    mut file: impl BufRead + Seek,
) -> Result<Vec<ImportedClip>, RejectionReason> {
    let path = settings.path.as_path();
    let first_bytes = file.fill_buf().map_err(|error| RejectionReason::unreadable(&error))?;
    let of_name = || ForeignFormat::of_name(path).filter(|_| ClipFormat::of(path).is_none());
    if let Some(format) = ForeignFormat::of_bytes(first_bytes).or_else(of_name) {
        return Err(RejectionReason::ForeignFormat { format });
    }
    match ClipFormat::of(path).ok_or(RejectionReason::UnknownFormat)? {
        ClipFormat::Bvh => bvh::open(path, file).map(|motion| vec![bvh_clip(settings, motion)]),
        ClipFormat::Gltf => gltf_clips(settings, &GltfFile::open(path, file, settings.outside)?),
    }
}

fn bvh_clip(settings: &ClipSettings, motion: SourceMotion) -> ImportedClip {
    match &settings.animation {
        Some(animation) => no_animation(settings, animation, "a motion without name"),
        None => imported_clip(motion, settings, false),
    }
}

/// Clips are read and imported one by one: of thousands of animations only the human motion is kept. A malformed clip
/// is an error of the file only where all clips are malformed.
fn gltf_clips(settings: &ClipSettings, file: &GltfFile) -> Result<Vec<ImportedClip>, RejectionReason> {
    let has_several = file.len() > 1;
    if let Some(animation) = &settings.animation {
        let Some(index) = (0..file.len()).find(|&index| file.name(index) == animation) else {
            let names: Vec<&str> = (0..file.len()).map(|index| file.name(index)).collect();
            let names = if names == [""] { "a motion without name".to_owned() } else { names.join(", ") };
            return Ok(vec![no_animation(settings, animation, &names)]);
        };
        return Ok(vec![imported_clip(file.motion(index)?, settings, has_several && settings.name.is_none())]);
    }
    let read = |index| file.motion(index).map(|motion| imported_clip(motion, settings, has_several));
    let mut imports: Vec<_> = (0..file.len()).into_par_iter().map(read).collect();
    if let Some(first) = imports.iter().position(Result::is_err).filter(|_| imports.iter().all(Result::is_err)) {
        return imports.swap_remove(first).map(|import| vec![import]);
    }
    let malformed = |index, reason| ImportedClip {
        file: file_name(&settings.path),
        clip: file.name(index).to_owned(),
        outcome: Err(reason),
    };
    let or_malformed =
        |(index, import): (usize, Result<_, _>)| import.unwrap_or_else(|reason| malformed(index, reason));
    Ok(imports.into_iter().enumerate().map(or_malformed).collect())
}

fn no_animation(settings: &ClipSettings, animation: &str, names: &str) -> ImportedClip {
    let outcome = Err(RejectionReason::ManifestContradicted {
        key: ManifestKey::Animation,
        problem: format!("there is no animation `{animation}`, but {names}"),
        remedy: "name an existing one, or remove the key",
    });
    ImportedClip { file: file_name(&settings.path), clip: animation.to_owned(), outcome }
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// One clip; its name has the clip's name appended where `has_several`.
fn imported_clip(motion: SourceMotion, settings: &ClipSettings, has_several: bool) -> ImportedClip {
    let stem = settings.path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let label = settings.name.clone().unwrap_or(stem);
    let name = if has_several { format!("{label} {}", motion.head.clip) } else { label };
    // Names head the lines of tables.
    let name = name.replace(char::is_control, "_");
    ImportedClip {
        file: motion.head.file.clone(),
        clip: motion.head.clip.clone(),
        outcome: to_human(motion, settings, name),
    }
}

/// Steps 2 to 7 for one clip.
fn to_human(mut motion: SourceMotion, settings: &ClipSettings, name: String) -> Result<HumanClip, RejectionReason> {
    if motion.frame_count() == 0 {
        let has_pointers = motion.head.diagnostics.contains(&Diagnostic::Note(Note::PointersNotRead));
        return Err(if has_pointers { RejectionReason::PointersOnly } else { RejectionReason::Motionless });
    }
    settings.apply_to(&mut motion)?;
    if motion.frame_count() < MIN_FRAMES {
        return Err(RejectionReason::TooShort);
    }
    let (mut clip, mut roles, rest) = clip_with_roles(motion, settings)?;
    if lacks_rotations(&clip, &roles) {
        return Err(RejectionReason::NoRotations);
    }
    if let Some(forward) = settings.forward {
        let against_feet = stated_facing::apply(&clip, &mut roles, forward)?;
        clip.diagnostics.extend(against_feet.map(Diagnostic::Warning));
    }
    if roles.are_names_mirrored {
        clip.diagnostics.push(Diagnostic::Warning(Warning::SidesExchanged));
    }
    if settings.metres_per_unit.is_none() {
        plausibility::drop_implausible_unit(&mut clip, &roles);
    }
    let crawls = rest.stands && lengthwise_path::crawls(&clip, &roles, rest.up);
    if crawls {
        clip.up_axis = clip.up_axis.or(Some(rest.up));
    }
    let contradicted_up = plausibility::contradicted_up(&clip, &roles).filter(|_| !crawls);
    let (mut clip, units) = units::to_metres_z_up(clip, &roles);
    let parameters = parameters_of_trimmed(&mut clip, &roles, settings);
    let mut warnings = vec![plausibility::size_warning(&clip, &roles)];
    // A body that does not stand along the up axis has no feet on the ground.
    let lengthwise = || lengthwise_path::lengthwise_path(&clip, &roles).filter(|_| !crawls);
    let unfit = contradicted_up.clone().or_else(lengthwise).or_else(|| {
        warnings.push(level_ground::warning(&clip, &roles, &parameters));
        let gait = plausibility::doubtful_gait(&clip, &roles, &parameters)?;
        if let Diagnostic::NoExample(unfit) = gait {
            return Some(unfit);
        }
        clip.diagnostics.push(gait);
        None
    });
    clip.diagnostics.extend(warnings.into_iter().flatten().map(Diagnostic::Warning));
    let is_frame_time_wrong = matches!(unfit, Some(Unfit::InhumanGait { .. }));
    if is_frame_time_wrong {
        units::drop_doubt_of_cadence(&mut clip, &roles, units.metres_per_unit);
    }
    let jumps = jumps(&mut clip, &roles, is_frame_time_wrong);
    let low_parts = match contradicted_up {
        None => posture::low_parts(&clip, &roles, &parameters),
        Some(_) => Vec::new(),
    };
    let spread_parts = spread_arms::spread_parts(&clip, &roles, &parameters);
    let mut human = to_humanoid::to_human(clip, &roles, &units, parameters, low_parts, name)?;
    (human.spread_parts, human.seems_to_crawl) = (spread_parts, crawls);
    if let Some(head) = &mut human.rig_head {
        (head.rest_up, head.rest_offset) = (rest.up.name(), rest.head_offset);
    }
    human.unfit = unfit;
    human.jumps = jumps.into_iter().map(|jump| jump.frames).collect();
    human.choices = choices(settings);
    if !human.frames.iter().all(is_finite) {
        return Err(RejectionReason::Degenerate);
    }
    match plausibility::impossible_body(&human.body) {
        Some(reason) => Err(settings.contradicted_unit(&reason).unwrap_or(reason)),
        None => Ok(human),
    }
}

/// The jumps of the pose. Warns of them, and of frames that are missing or repeated, unless the frame time is wrong: that
/// leaves no speed by which they are judged.
fn jumps(clip: &mut SourceClip, roles: &Roles, is_frame_time_wrong: bool) -> Vec<PoseJump> {
    let uneven = uneven_frames::warning(clip, roles);
    // Where frames are repeated, every other one jumps.
    let repeats = matches!(uneven, Some(Warning::FramesRepeated { .. }));
    let jumps = if repeats { Vec::new() } else { pose_jumps::pose_jumps(clip, roles) };
    // A leap is reported already.
    let leaps = clip.diagnostics.iter().any(|found| matches!(found, Diagnostic::Warning(Warning::Leap { .. })));
    let jump = pose_jumps::warning(clip, &jumps).filter(|_| !leaps);
    let warnings = jump.into_iter().chain(uneven).filter(|_| !is_frame_time_wrong);
    clip.diagnostics.extend(warnings.map(Diagnostic::Warning));
    jumps
}

/// What the settings of a clip state about its part in the set.
fn choices(settings: &ClipSettings) -> Choices {
    Choices {
        takes_any_posture: settings.takes_any_posture,
        is_up_stated: settings.up.is_some(),
        is_frame_rate_stated: settings.frame_rate_hz.is_some(),
        mirror: settings.mirror,
        transition: settings.transition,
        is_cut: settings.frames.is_some(),
        is_name_stated: settings.name.is_some(),
        ..Choices::default()
    }
}

/// The joints that have roles and the extra joints, in all frames; their roles; and what the rest pose shows. Memory: the
/// poses of all joints never exist at once.
fn clip_with_roles(
    mut motion: SourceMotion,
    settings: &ClipSettings,
) -> Result<(SourceClip, Roles, RestPose), RejectionReason> {
    let known = settings.joint_map(&motion.head)?;
    rig::check_size(&motion.head)?;
    let mut sample = motion.sample(&rig::sampled_frames(motion.frame_count()))?;
    let rest = motion.rest();
    let mut roles = roles_in(&sample, &rest, &known)?;
    let rest = RestPose::of(&motion.head.joints, &rest, &roles);
    let extra = extra_joints(&sample, &roles);
    roles.extra = extra.kept;
    let left_out = Note::JointsLeftOut { moving: extra.left_out as u32, kept: roles.extra.len() as u32 };
    let left_out = (extra.left_out > 0).then_some(Diagnostic::Note(left_out));
    let kept = roles.source_joints();
    roles.renumber(&kept);
    let mut clip = if sample.frame_count() == motion.frame_count() {
        sample.keep_joints(&kept);
        sample
    } else {
        drop(sample);
        motion.into_clip(&kept)?
    };
    clip.diagnostics.extend(left_out);
    Ok((clip, roles, rest))
}

/// The roles of the joints by a few frames. If the body is not upright in these, by the rest pose, if that one stands.
fn roles_in(sample: &SourceClip, rest: &JointPoses, known: &JointMap) -> Result<Roles, RejectionReason> {
    let found = rig::find_roles(sample, known);
    if !matches!(found, Err(RejectionReason::NotUpright { .. })) {
        return found;
    }
    let (positions, orientations) = (rest.positions.clone(), rest.orientations.clone());
    let at_rest = SourceClip { positions, orientations, oriented: rest.orientations.len(), ..sample.clone() };
    let of_rest = rig::find_roles_by_name(&at_rest, known).ok();
    of_rest.filter(|roles| RestPose::of(&sample.joints, rest, roles).stands).map_or(found, Ok)
}

/// Removes poses that are not part of the motion, unless a manifest selects the frames, and returns the whole-clip
/// parameters of the frames with T-poses.
fn parameters_of_trimmed(clip: &mut SourceClip, roles: &Roles, settings: &ClipSettings) -> SourceParameters {
    let is_cut = settings.frames.is_some();
    if !is_cut {
        trim_t_poses::drop_separate_first_pose(clip, roles);
    }
    let parameters = source_parameters(clip, roles);
    if !is_cut {
        trim_t_poses::drop_t_poses(clip, roles);
        trim_t_poses::drop_held_ends(clip, roles);
    }
    parameters
}

/// Whether the clip holds positions alone: a leg swings, but no joint rotates. Such a clip does not show the twist of
/// limbs.
fn lacks_rotations(clip: &SourceClip, roles: &Roles) -> bool {
    let joints: Vec<usize> = roles.joints.iter().flatten().copied().collect();
    let rotates = |frame: usize, joint: usize| {
        clip.orientation(frame, joint).dot(clip.orientation(0, joint)).abs() < NO_ROTATION_COSINE
    };
    let [hip, foot] = [Joint::LeftThigh, Joint::LeftFoot].map(|joint| roles.required(joint));
    let leg = |frame: usize| clip.position(frame, foot) - clip.position(frame, hip);
    let swings = |frame: usize| leg(frame).distance(leg(0)) > SWING_MIN * leg(0).length();
    let mut frames = 0..clip.frame_count();
    !frames.clone().any(|frame| joints.iter().any(|&joint| rotates(frame, joint))) && frames.any(swings)
}

fn is_finite(pose: &HumanPose) -> bool {
    pose.pelvis_m.is_finite() && pose.rotations.iter().all(|turn| turn.is_finite())
}
