//! A database small enough to write down: three cycles of a stiff body.

use std::f32::consts::TAU;

use glam::{Quat, Vec2, Vec3};
use motiondb::blend_space::BlendSpace;
use motiondb::correspondence::Correspondence;
use motiondb::motion_db::{MotionDb, MotionExample, PHASE_COUNT, Rows, SourceRecord};
use motiondb::parameters::Parameters;
use motiondb::phase_map::PhaseMap;
use motiondb::skeleton::{Foot, JOINT_COUNT, Joint, Skeleton};
use motiondb::velocity_hull::{Construction, VelocityHull};

/// Standing, a walk and a walking turn that all swing every joint by a tenth of a radian.
pub(crate) fn small_db() -> MotionDb {
    let parameters = [[0.0, 0.0, 0.0], [1.2, 0.0, 0.0], [0.8, 1.0, 0.0]];
    let names = ["stand", "turn_none", "turn_one"];
    let examples: Vec<MotionExample> = names.iter().zip(parameters).map(|(name, at)| example(name, at)).collect();
    MotionDb {
        skeleton: skeleton(),
        sources: vec![source()],
        rows: rows(examples.len()),
        velocity_hull: VelocityHull {
            construction: Construction::default(),
            turning_mps: vec![Vec2::ZERO, Vec2::new(0.8 * libm::cosf(1.0), 0.8 * libm::sinf(1.0)), Vec2::new(1.2, 0.0)],
            holding_mps: vec![Vec2::ZERO, Vec2::new(1.2, 0.0)],
            sharp_turn_edges_mps: Vec::new(),
        },
        blend_space: BlendSpace {
            dimension: 2,
            axis_ranges: [1.2, 1.0, 0.0],
            simplices: vec![0, 1, 2],
            covered_share: 1.0,
        },
        correspondence: Some(Correspondence {
            semi_procedural: 1,
            blending: 2,
            pairs_s: vec![[0.2, 0.8], [0.4, 0.1], [0.9, 0.6]],
        }),
        examples,
    }
}

fn example(name: &str, [speed_mps, turn_rate_rad_s, strafe_mps]: [f32; 3]) -> MotionExample {
    MotionExample {
        name: name.into(),
        source: 0,
        window_s: [0.0, 1.0],
        mirrored: false,
        parameters: Parameters { speed_mps, turn_rate_rad_s, strafe_mps },
        phase_map: PhaseMap { period_s: 1.0, left_share: 0.5 },
        key_times_s: Some([0.1, 0.2, 0.6, 0.7]),
        planted_slide_cm_s: 0.0,
        planted_share: 0.6,
    }
}

fn source() -> SourceRecord {
    SourceRecord {
        file: "walk.bvh".into(),
        clip: String::new(),
        speed_mps: 1.2,
        turn_rate_rad_s: 0.0,
        strafe_mps: 0.0,
        up_axis: "+Y".into(),
        metres_per_unit: 0.01,
        frame_rate_hz: 30.0,
        warnings: Vec::new(),
    }
}

fn skeleton() -> Skeleton {
    let mut offsets_m = [Vec3::new(0.0, 0.0, 0.1); JOINT_COUNT];
    for side in 0..2 {
        offsets_m[Joint::SHANKS[side].index()] = Vec3::new(0.0, 0.0, -0.42);
        offsets_m[Joint::FEET[side].index()] = Vec3::new(0.0, 0.0, -0.42);
    }
    let foot = Foot { heel_m: Vec3::NEG_Z, ball_m: Vec3::X, toe_tip_m: Vec3::X, measured_m: [Vec3::ZERO; 3] };
    Skeleton {
        offsets_m,
        segment_ends_m: offsets_m,
        segment_radii_m: [0.05; JOINT_COUNT],
        limits_rad: [[Vec3::NEG_ONE, Vec3::ONE]; JOINT_COUNT],
        feet: [foot; 2],
    }
}

fn rows(examples: usize) -> Rows {
    let phases = (0..examples * PHASE_COUNT).map(|row| (row % PHASE_COUNT) as f32 / PHASE_COUNT as f32);
    let swing = |phase: f32| Quat::from_rotation_y(0.1 * libm::sinf(TAU * phase));
    Rows {
        rotations: phases.clone().flat_map(|phase| [swing(phase); JOINT_COUNT]).collect(),
        pelvis_m: phases.clone().map(|_| Vec3::new(0.0, 0.0, 0.9)).collect(),
        contacts: phases.map(|phase| [f32::from(u8::from(phase < 0.6)), 1.0]).collect(),
    }
}
