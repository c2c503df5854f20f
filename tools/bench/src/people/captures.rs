//! Captures of people as bodies over time, so that the measures of crowds measure people.
//!
//! Every BVH clip of a human body counts that lasts a second or more and does not run; clips in place have no motion of
//! their own over the ground. Bodies keep their own size. Poses are taken at 60 Hz, contacts are those that the
//! compiler finds. World: metres, seconds, z up.

use std::path::Path;

use fbcrowd_sim::measures::people::{BodySample, BodyTrack};
use fbcrowd_sim::recording::AgentFrame;
use glam::{DQuat, Quat, Vec3};
use motiondb::body::{Pose, Root};
use motiondb_compiler::database::body_skeleton;
use motiondb_compiler::gait::{FootStance, PerformerGait};
use motiondb_compiler::ground::grounded_clip;
use motiondb_compiler::retarget::HumanClip;
use rayon::prelude::*;

use crate::error::BenchError;

/// Rate at which poses are taken, Hz.
const RATE_HZ: f64 = 60.0;
/// Least duration of a clip, s.
const DURATION_MIN_S: f64 = 1.0;
/// Greatest mean speed of a clip, m/s: crowds do not run.
const SPEED_MAX_MPS: f32 = 2.0;
/// Folder of clips that are kept because something is wrong with them.
const FLAWED: &str = "quirks";

/// The captures below a folder, in the order of their files.
pub(crate) fn captures(mocap: &Path) -> Result<Vec<BodyTrack>, BenchError> {
    let is_capture = |path: &&std::path::PathBuf| {
        let is_bvh = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("bvh"));
        is_bvh && !path.components().any(|part| part.as_os_str() == FLAWED)
    };
    let files = motiondb_compiler::clip_files(mocap)?;
    let files: Vec<_> = files.iter().filter(is_capture).collect();
    let tracks = |path: &&std::path::PathBuf| {
        let imports = motiondb_compiler::import_file(path).unwrap_or_default();
        let clips = imports.into_iter().filter_map(|import| import.outcome.ok());
        clips.filter(is_of_a_crowd).map(|clip| track(&clip)).collect::<Vec<BodyTrack>>()
    };
    Ok(files.par_iter().map(tracks).collect::<Vec<_>>().into_iter().flatten().collect())
}

fn is_of_a_crowd(clip: &HumanClip) -> bool {
    let duration_s = clip.frames.len() as f64 / clip.frame_rate_hz;
    let runs = clip.source.speed_mps > SPEED_MAX_MPS;
    !runs && clip.in_place_mps.is_none() && clip.low_parts.is_empty() && duration_s >= DURATION_MIN_S
}

/// A clip on its performer's own body, on the ground.
fn track(clip: &HumanClip) -> BodyTrack {
    let skeleton = body_skeleton(&clip.body);
    let grounded = grounded_clip(clip, &clip.body);
    let performer = PerformerGait::of(clip);
    let stances = performer.gait.clearest_stances();
    // The analysis unrolls loops; their middle round is the clip.
    let first_frame = performer.loop_frames.unwrap_or(0) as f64;
    let mut track = BodyTrack::new(1.0 / RATE_HZ, 0.0);
    let last_frame = (grounded.frame_count() - 1) as f64;
    let count = (last_frame / clip.frame_rate_hz * RATE_HZ) as usize + 1;
    for index in 0..count {
        let frame = (index as f64 * clip.frame_rate_hz / RATE_HZ).min(last_frame);
        let pose = grounded.pose_at(frame, &clip.body);
        let facing_rad = pose.forward_kinematics(&clip.body).facing_rad();
        let contact = |side: usize| f32::from(u8::from(stands(&stances[side], first_frame + frame)));
        let mut rotations = pose.rotations;
        rotations[0] = DQuat::from_rotation_z(-facing_rad) * rotations[0];
        let agent = AgentFrame {
            root: Root { position_m: pose.pelvis_m.truncate().as_vec2(), facing_rad: facing_rad as f32 },
            contacts: [contact(0), contact(1)],
            pose: Pose {
                pelvis_m: Vec3::new(0.0, 0.0, pose.pelvis_m.z as f32),
                rotations: rotations.map(|rotation| Quat::from_array(rotation.to_array().map(|value| value as f32))),
            },
            ..AgentFrame::default()
        };
        track.samples.push(BodySample::new(&skeleton, &agent, &agent.pose.forward_kinematics(&skeleton), false));
    }
    track
}

/// Whether a foot with these stances stands at a frame.
fn stands(stances: &[FootStance], frame: f64) -> bool {
    stances.iter().any(|stance| stance.depth_frames(frame) >= 0.0)
}
