//! Small crowds of a hand-posed walker: pictures of them depend on no clip and no simulation.

use std::f32::consts::TAU;
use std::path::{Path, PathBuf};

use fbcrowd_sim::population::Population;
use fbcrowd_sim::recording::{AgentFrame, Header, RecordedDatabase, Recorder};
use fbcrowd_sim::scenario::{AgentSpec, Scenario, View};
use glam::{Quat, Vec2, Vec3};
use motiondb::body::{Foot, JOINT_COUNT, Joint, Pose, Root, Skeleton};
use motiondb::velocity_sets::velocity_hull::VelocityHull;

/// Walking speed of every walker, m/s.
const SPEED_MPS: f32 = 1.3;
/// Frequency of strides at that speed, Hz.
const STRIDE_HZ: f32 = 0.93;

/// An adult of 1.75 m.
fn skeleton() -> Skeleton {
    let mut offsets_m = [Vec3::ZERO; JOINT_COUNT];
    let mut segment_ends_m = [Vec3::ZERO; JOINT_COUNT];
    let mut segment_radii_m = [0.05; JOINT_COUNT];
    let mut set = |joint: Joint, offset: [f32; 3], end: [f32; 3], radius: f32| {
        for (joint, y) in [(joint, 1.0), (joint.mirrored(), -1.0)] {
            let flip = if joint == joint.mirrored() { 1.0 } else { y };
            offsets_m[joint.index()] = Vec3::new(offset[0], offset[1] * flip, offset[2]);
            segment_ends_m[joint.index()] = Vec3::new(end[0], end[1] * flip, end[2]);
            segment_radii_m[joint.index()] = radius;
        }
    };
    set(Joint::Pelvis, [0.0, 0.0, 0.93], [0.0, 0.0, 0.1], 0.125);
    set(Joint::SpineLower, [-0.01, 0.0, 0.1], [0.0, 0.0, 0.13], 0.115);
    set(Joint::SpineMiddle, [0.0, 0.0, 0.13], [0.0, 0.0, 0.14], 0.12);
    set(Joint::SpineUpper, [0.0, 0.0, 0.14], [0.0, 0.0, 0.18], 0.125);
    set(Joint::Neck, [0.0, 0.0, 0.18], [0.02, 0.0, 0.09], 0.055);
    set(Joint::Head, [0.02, 0.0, 0.09], [0.01, 0.0, 0.2], 0.098);
    set(Joint::LeftClavicle, [0.0, 0.03, 0.13], [0.0, 0.15, 0.0], 0.06);
    set(Joint::LeftUpperArm, [0.0, 0.15, 0.0], [0.0, 0.28, 0.0], 0.05);
    set(Joint::LeftForearm, [0.0, 0.28, 0.0], [0.0, 0.25, 0.0], 0.042);
    set(Joint::LeftHand, [0.0, 0.25, 0.0], [0.0, 0.17, 0.0], 0.042);
    set(Joint::LeftThigh, [0.0, 0.09, -0.02], [0.0, 0.0, -0.42], 0.078);
    set(Joint::LeftShank, [0.0, 0.0, -0.42], [0.0, 0.0, -0.41], 0.055);
    set(Joint::LeftFoot, [0.0, 0.0, -0.41], [0.13, 0.0, -0.06], 0.045);
    set(Joint::LeftToe, [0.13, 0.0, -0.06], [0.07, 0.0, -0.01], 0.04);
    let [heel_m, ball_m, toe_tip_m] =
        [Vec3::new(-0.06, 0.0, -0.08), Vec3::new(0.13, 0.0, -0.08), Vec3::new(0.08, 0.0, -0.02)];
    let foot = Foot { heel_m, ball_m, toe_tip_m, measured_m: [heel_m, ball_m, toe_tip_m] };
    let limits_rad = [[Vec3::splat(-3.0), Vec3::splat(3.0)]; JOINT_COUNT];
    Skeleton { offsets_m, segment_ends_m, segment_radii_m, limits_rad, feet: [foot; 2] }
}

/// A walking pose at a phase: legs and arms swing as sines; the knee of the swing leg is flexed.
fn walking(phase: f32) -> Pose {
    let mut rotations = [Quat::IDENTITY; JOINT_COUNT];
    for side in 0..2 {
        let swing = libm::sinf(TAU * (phase + 0.5 * side as f32));
        let lift = libm::cosf(TAU * (phase + 0.5 * side as f32)).max(0.0);
        let down = Quat::from_rotation_x(if side == 0 { -1.38 } else { 1.38 });
        rotations[Joint::THIGHS[side].index()] = Quat::from_rotation_y(-0.42 * swing - 0.25 * lift);
        rotations[Joint::SHANKS[side].index()] = Quat::from_rotation_y(0.12 + 0.95 * lift);
        rotations[Joint::FEET[side].index()] = Quat::from_rotation_y(-0.05 + 0.25 * swing - 0.35 * lift);
        rotations[Joint::UPPER_ARMS[side].index()] = Quat::from_rotation_y(0.5 * swing) * down;
        let forearm = if side == 0 { Joint::LeftForearm } else { Joint::RightForearm };
        let bend = if side == 0 { -1.0 } else { 1.0 };
        rotations[forearm.index()] = Quat::from_rotation_z(bend * (0.45 - 0.25 * swing));
    }
    let yaw = 0.12 * libm::sinf(TAU * phase);
    rotations[Joint::Pelvis.index()] = Quat::from_rotation_z(-yaw);
    rotations[Joint::SpineMiddle.index()] = Quat::from_rotation_z(2.0 * yaw);
    rotations[Joint::Neck.index()] = Quat::from_rotation_z(-yaw);
    Pose { pelvis_m: Vec3::new(0.0, 0.02 * libm::cosf(TAU * phase), 0.9), rotations }
}

/// A walker at a position, on one foot.
fn walker(position_m: Vec2, facing_rad: f32, phase: f32) -> AgentFrame {
    AgentFrame {
        root: Root { position_m, facing_rad },
        phase,
        contacts: if (phase + 0.25).fract() < 0.5 { [0.0, 1.0] } else { [1.0, 0.0] },
        time_to_landing_s: 0.2,
        pose: walking(phase),
        ..AgentFrame::default()
    }
}

/// Velocity sets of a body that walks, turns slowly, side-steps and steps back.
fn velocity_hull() -> VelocityHull {
    let corners = |points: &[[f32; 2]]| points.iter().copied().map(Vec2::from).collect();
    VelocityHull {
        turning_mps: corners(&[[1.8, 0.0], [0.9, -0.9], [-0.6, -0.4], [-0.6, 0.4], [0.9, 0.9]]),
        holding_mps: corners(&[[1.8, 0.0], [0.0, -0.7], [-0.8, 0.0], [0.0, 0.7]]),
        sharp_turn_edges_mps: vec![
            [[-0.1, 0.2], [-0.6, 0.4]].map(Vec2::from),
            [[-0.6, -0.4], [-0.1, -0.2]].map(Vec2::from),
        ],
        ..VelocityHull::default()
    }
}

/// Agents on a circle; the goal of each is the opposite point.
pub(crate) fn circle(agent_count: usize, radius_m: f32, view: View) -> Header {
    let at = |index: usize| radius_m * Vec2::from_angle(TAU * index as f32 / agent_count as f32);
    let agents = (0..agent_count)
        .map(|index| AgentSpec {
            position_m: at(index),
            facing_rad: (-at(index)).to_angle(),
            goals_m: vec![-at(index)],
            radius_m: 0.3,
            wall_radius_m: 0.2,
            preferred_speed_mps: SPEED_MPS,
            ..AgentSpec::default()
        })
        .collect();
    header(agents, view)
}

/// A scene of agents, with two obstacles beside their paths.
fn header(agents: Vec<AgentSpec>, view: View) -> Header {
    let block =
        |x: f32, y: f32| [[-0.7, -0.4], [0.7, -0.4], [0.7, 0.4], [-0.7, 0.4]].map(|c| Vec2::new(x, y) + Vec2::from(c));
    let scenario = Scenario {
        name: "walkers".to_owned(),
        duration_s: 1.6,
        dt_s: 0.1,
        obstacles_m: vec![
            block(-2.8, 1.3).to_vec(),
            vec![Vec2::new(2.4, -1.5), Vec2::new(3.5, -1.4), Vec2::new(2.7, -0.6)],
        ],
        view,
        ..Scenario::of(agents)
    };
    Header::of(
        RecordedDatabase { checksum: 0, skeleton: skeleton(), velocity_hull: velocity_hull(), style: String::new() },
        scenario,
    )
}

/// All agents of a scene at a time: each walks to its goal on an arc to the right of the straight path.
pub(crate) fn frame(header: &Header, time_s: f32) -> Vec<AgentFrame> {
    let walk = |(index, agent): (usize, &AgentSpec)| {
        let goal = agent.goals_m[0];
        let path_m = goal - agent.position_m;
        let share = (SPEED_MPS * time_s / path_m.length()).min(1.0);
        let bulge = 0.22 * path_m.length() * libm::sinf(TAU * 0.5 * share);
        let slope = 0.22 * 0.5 * TAU * libm::cosf(TAU * 0.5 * share);
        let position_m = agent.position_m + path_m * share - bulge * path_m.normalize().perp();
        let facing_rad = (path_m.normalize() - slope * path_m.normalize().perp()).to_angle();
        let phase = (STRIDE_HZ * time_s + 0.37 * index as f32).fract();
        let preferred_mps = SPEED_MPS * (goal - position_m).normalize_or_zero();
        AgentFrame { id: index.into(), preferred_mps, ..walker(position_m, facing_rad, phase) }
    };
    header.scenario.agents.iter().enumerate().map(walk).collect()
}

/// The scene of the golden pictures: small, with everything that a top view can show.
pub(crate) fn golden_header() -> Header {
    let view = View { width: 320, height: 180, frame_rate_hz: 20.0, trail_s: 1.0, labels: true, ..View::default() };
    circle(7, 1.6, view)
}

/// Writes the scene of the golden pictures as a recording.
pub(crate) fn write_recording(path: &Path) {
    write_steps(path, &golden_header(), 16);
}

/// Writes some steps of a scene as a recording.
pub(crate) fn write_steps(path: &Path, header: &Header, steps: usize) {
    let mut recorder = Recorder::create(path, header).unwrap();
    for step in 0..=steps {
        recorder.push(&frame(header, step as f32 * header.scenario.dt_s)).unwrap();
    }
    recorder.finish(&Population::of(&header.scenario)).unwrap();
}

/// An empty folder for one test; removed at the end.
pub(crate) struct Scratch(PathBuf);

impl Scratch {
    pub(crate) fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("fbcrowd-render-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    pub(crate) fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
