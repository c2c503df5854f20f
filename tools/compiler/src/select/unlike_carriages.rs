//! Walks in which the body holds a part otherwise than in the other walks of its style: an arm, the head or the trunk. It
//! would be blended into all of them. Bodies that stand are compared with the walks, too.
//!
//! Frame of the facing: x forward, y left, z up.

use std::ops::Range;

use glam::{DVec3, Vec3};
use motiondb::body::Joint;
use motiondb::diagnostic::{Diagnostic, HeldPart, Warning};
use motiondb::statistics::median;
use rayon::prelude::*;

use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::cycle::gait_cycle::GaitCycle;
use crate::cycle::standing_cycle::standing_cycle;
use crate::cycle::steady_cycle::SteadyMotion;
use crate::ground::root_arc::Rates;
use crate::retarget::human_clip::{HumanBody, HumanJoints};
use crate::rig::carriage::Carriage;

/// Least number of walks that show what is usual.
const WALKS_MIN: usize = 4;
/// Speeds ahead of the walks that are compared, m/s: arms swing otherwise in steps back, and bend in runs.
const WALKS_MPS: Range<f64> = 0.3..2.0;
/// Greatest speed to a side, m/s.
const ASIDE_MAX_MPS: f64 = 0.3;
/// Greatest turn rate, rad/s: the head turns into sharp curves.
const TURN_MAX_RAD_S: f64 = 0.8;
/// Directions that are compared, with their part and the least angle from the usual that is reported, degrees: those of
/// [`Carriage`], and where the head faces.
const PARTS: [(HeldPart, f64); 6] = [
    (HeldPart::LeftArm, 40.0),
    (HeldPart::RightArm, 40.0),
    (HeldPart::LeftArm, 55.0),
    (HeldPart::RightArm, 55.0),
    (HeldPart::Trunk, 20.0),
    (HeldPart::Head, 35.0),
];
/// Period in which a body that stands is measured, s.
const STANDING_S: f64 = 1.0;
/// Least such angle over that of the middle walk: some sets are varied.
const OVER_MIDDLE: f64 = 3.0;

/// Number of [`PARTS`].
const COUNT: usize = PARTS.len();

/// How the walks of a style hold the parts.
struct UsualCarriage {
    /// Median of each direction.
    directions: [Vec3; COUNT],
    /// Angle of the middle walk from it, degrees.
    middle_deg: [f64; COUNT],
}

/// Adds a warning to the windows of a style's clips that walk or stand with an unusual carriage.
pub(crate) fn warn_of_unlike_carriages(analyzed: &mut [AnalyzedClip], body: &HumanBody) {
    let windows = |(clip, found): (usize, &AnalyzedClip)| (0..found.windows.len()).map(move |window| [clip, window]);
    let windows: Vec<[usize; 2]> = analyzed.iter().enumerate().flat_map(windows).collect();
    let held = |&[clip, window]: &[usize; 2]| {
        let found = &analyzed[clip];
        match &found.windows[window].motion {
            SteadyMotion::Steps(cycle) => walks(cycle).then(|| ([clip, window], true, part_directions(cycle, body))),
            SteadyMotion::Stands(frames) => {
                let cycle = standing_cycle(&found.grounded, body, frames.clone(), STANDING_S);
                Some(([clip, window], false, part_directions(&cycle, body)))
            }
        }
    };
    let held: Vec<([usize; 2], bool, [Vec3; COUNT])> = windows.par_iter().filter_map(held).collect();
    let walks: Vec<[Vec3; COUNT]> = held.iter().filter(|(_, walks, _)| *walks).map(|(.., parts)| *parts).collect();
    if walks.len() < WALKS_MIN {
        return;
    }
    let usual = UsualCarriage::of(&walks);
    for ([clip, window], walks, parts) in &held {
        let unlike = usual.unlike(parts);
        // A body that stands may fold both arms, or rest them on its hips.
        let arms = unlike.iter().filter(|(part, _)| [HeldPart::LeftArm, HeldPart::RightArm].contains(part)).count();
        let counts = |part: HeldPart| *walks || part == HeldPart::Trunk || part != HeldPart::Head && arms == 1;
        let warnings = unlike.iter().filter(|(part, _)| counts(*part)).map(|&(part, angle_deg)| {
            Diagnostic::Warning(Warning::CarriageUnlike { part, angle_deg: angle_deg as f32, from_s: None })
        });
        analyzed[*clip].windows[*window].diagnostics.extend(warnings);
    }
}

impl UsualCarriage {
    fn of(walks: &[[Vec3; COUNT]]) -> Self {
        let median_of = |value: &dyn Fn(&[Vec3; COUNT]) -> f32| {
            median(walks.iter().map(|parts| f64::from(value(parts)))).unwrap_or_default()
        };
        let directions = std::array::from_fn(|part| {
            let axis = |axis: usize| median_of(&|parts| parts[part][axis]) as f32;
            Vec3::new(axis(0), axis(1), axis(2))
        });
        let middle_deg = std::array::from_fn(|part| {
            median_of(&|parts: &[Vec3; COUNT]| parts[part].angle_between(directions[part]).to_degrees())
        });
        Self { directions, middle_deg }
    }

    /// The parts that are held otherwise, each with its greatest angle, degrees.
    fn unlike(&self, parts: &[Vec3; COUNT]) -> Vec<(HeldPart, f64)> {
        let mut unlike: Vec<(HeldPart, f64)> = Vec::new();
        for (index, (part, least_deg)) in PARTS.into_iter().enumerate() {
            let angle_deg = f64::from(parts[index].angle_between(self.directions[index]).to_degrees());
            if angle_deg <= least_deg.max(OVER_MIDDLE * self.middle_deg[index]) {
                continue;
            }
            match unlike.iter_mut().find(|(other, _)| *other == part) {
                Some((_, greatest_deg)) => *greatest_deg = greatest_deg.max(angle_deg),
                None => unlike.push((part, angle_deg)),
            }
        }
        unlike
    }
}

fn walks(cycle: &GaitCycle) -> bool {
    let Rates { speed_mps, turn_rate_rad_s, strafe_mps } = cycle.rates;
    let goes_ahead = WALKS_MPS.contains(&speed_mps) && strafe_mps.abs() < ASIDE_MAX_MPS;
    !cycle.is_run() && goes_ahead && turn_rate_rad_s.abs() < TURN_MAX_RAD_S
}

/// Mean directions over a cycle, in the order of [`PARTS`].
fn part_directions(cycle: &GaitCycle, body: &HumanBody) -> [Vec3; COUNT] {
    let Carriage { arms: [left_upper, right_upper, left_fore, right_fore], trunk } = cycle.carriage(body);
    let faces = |joints: HumanJoints| joints.orientations[Joint::Head.index()] * DVec3::X;
    let head = cycle.joints(body).into_iter().map(faces).sum::<DVec3>().as_vec3();
    [left_upper, right_upper, left_fore, right_fore, trunk, head]
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::*;
    use crate::synthetic::{SyntheticWalk, database_of, idle, walk};

    /// Parts in the warnings about six walks and an idle, of which one turns joints.
    fn held(odd: &str, joints: &[Joint], turn: DQuat) -> Vec<HeldPart> {
        let at = |speed_mps: f64| walk(&format!("walk_{speed_mps}"), SyntheticWalk::at(speed_mps, 0.0, 0.0));
        let walks = [0.6, 0.8, 1.0, 1.2, 1.4, 1.6].map(at);
        let mut clips: Vec<_> = walks.into_iter().chain([idle("idle", 3.0)]).collect();
        let odd_clip = clips.iter_mut().find(|clip| clip.name == odd).unwrap();
        for pose in &mut odd_clip.frames {
            joints.iter().for_each(|joint| pose.rotations[joint.index()] = turn * pose.rotations[joint.index()]);
        }
        let db = database_of(clips, 0);
        let part = |source: usize, found: &Diagnostic| match found {
            Diagnostic::Warning(Warning::CarriageUnlike { part, .. }) => {
                assert_eq!(db.sources[source].file, format!("{odd}.bvh"));
                Some(*part)
            }
            _ => None,
        };
        let all = db.sources.iter().enumerate();
        all.flat_map(|(source, record)| record.diagnostics.iter().filter_map(move |found| part(source, found)))
            .collect()
    }

    #[test]
    fn parts_held_otherwise_are_named() {
        let of_walk = |joint: Joint, turn: DQuat| held("walk_1.6", &[joint], turn);
        assert!(of_walk(Joint::Head, DQuat::IDENTITY).is_empty());
        assert_eq!(of_walk(Joint::Head, DQuat::from_rotation_z(1.2)), [HeldPart::Head]);
        assert_eq!(of_walk(Joint::RightUpperArm, DQuat::from_rotation_y(-1.2)), [HeldPart::RightArm]);
        assert_eq!(of_walk(Joint::LeftForearm, DQuat::from_rotation_z(-1.8)), [HeldPart::LeftArm]);
        assert!(of_walk(Joint::SpineLower, DQuat::from_rotation_y(0.6)).contains(&HeldPart::Trunk));
    }

    #[test]
    fn a_body_that_stands_may_hold_both_arms_otherwise() {
        let of_idle = |joints: &[Joint], turn_rad: f64| held("idle", joints, DQuat::from_rotation_y(turn_rad));
        assert_eq!(of_idle(&[Joint::LeftUpperArm], -0.9), [HeldPart::LeftArm]);
        assert!(of_idle(&Joint::UPPER_ARMS, -0.9).is_empty());
        assert!(of_idle(&[Joint::SpineLower], 0.5).contains(&HeldPart::Trunk));
    }
}
