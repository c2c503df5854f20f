//! The rows of all examples as states of joints, and the row that is most like an instant of a clip: where a transition
//! meets the set.
//!
//! Rows are in the root frame, which moves at the example's rates; velocities are those over the ground. An instant that
//! is placed on a row gives the root there. Metres, seconds, radians.

use glam::{DQuat, DVec3};
use motiondb::body::JOINT_COUNT;
use motiondb::motion::{PHASE_COUNT, PhaseMap};
use rayon::prelude::*;

use crate::cycle::gait_cycle::GaitCycle;
use crate::ground::root_arc::{Rates, RootArc};
use crate::ground::rotations::{align_hemispheres, ground_rotation};
use crate::retarget::human_clip::{HumanBody, HumanPose};
use crate::select::named_cycles::NamedCycle;
use crate::transition::joint_state::{JointState, Placement};

/// Where a transition meets an example.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowMatch {
    /// Index of the example.
    pub(crate) example: usize,
    /// Row of the example.
    pub(crate) row: usize,
    /// The root of the example's body at that instant, in the frame of the clip.
    pub(crate) root: Placement,
    /// Rates of the example.
    pub(crate) rates: Rates,
    /// Distance of the positions of the joints, m.
    pub(crate) pose_m: f64,
    /// Distance of positions and velocities, m.
    pub(crate) distance_m: f64,
}

/// The rows of the examples of a set.
pub(crate) struct ExampleRows {
    rates: Vec<Rates>,
    /// Map from phase to time of each example that steps.
    maps: Vec<Option<PhaseMap>>,
    states: Vec<Vec<JointState>>,
    /// Index of the standing example that the blend space uses; none in a set without one.
    standing: Option<usize>,
    /// First row of the set: the database stores rotations in its hemispheres.
    reference: Option<[DQuat; JOINT_COUNT]>,
}

impl ExampleRows {
    /// The rows of cycles on a body; `standing` is the index of the standing example.
    pub(crate) fn of(cycles: &[NamedCycle], standing: Option<usize>, body: &HumanBody) -> Self {
        Self {
            rates: cycles.iter().map(|named| named.cycle.rates).collect(),
            maps: cycles.iter().map(|named| named.cycle.steps.then_some(named.cycle.phase_map)).collect(),
            states: cycles.par_iter().map(|named| states(&named.cycle, body)).collect(),
            standing,
            reference: cycles.first().and_then(|named| named.cycle.rows.first()).map(|row| row.rotations),
        }
    }

    /// Rotations in the hemispheres in which the database stores them.
    pub(crate) fn stored_rotations(&self, pose: &HumanPose) -> [DQuat; JOINT_COUNT] {
        let mut rotations = pose.rotations;
        if let Some(reference) = &self.reference {
            align_hemispheres(&mut rotations, reference);
        }
        rotations
    }

    /// The row of the standing example whose pose is most like that of an instant.
    pub(crate) fn nearest_standing(&self, state: &JointState) -> Option<RowMatch> {
        let standing = self.standing?;
        let rows = (0..PHASE_COUNT).map(|row| self.matched(state, standing, row));
        rows.min_by(|a, b| a.pose_m.total_cmp(&b.pose_m))
    }

    /// The row of an example that steps which is most like an instant, in pose and velocity, and where the clip shows a
    /// second instant so much later (s; earlier where negative), also there: a body that still speeds up is like a slower
    /// walk only for an instant.
    /// Rows that are farther than `limit_m` at either instant are not looked at.
    pub(crate) fn nearest_stepping(
        &self,
        state: &JointState,
        beside: Option<&(f64, JointState)>,
        limit_m: f64,
    ) -> Option<RowMatch> {
        let examples = (0..self.states.len()).filter(|&example| self.maps[example].is_some());
        let mut nearest: Option<RowMatch> = None;
        for (example, row) in examples.flat_map(|example| (0..PHASE_COUNT).map(move |row| (example, row))) {
            let most_m = nearest.map_or(limit_m, |found| found.distance_m);
            if state.is_farther(&self.states[example][row], most_m) {
                continue;
            }
            let found = self.matched(state, example, row);
            if found.distance_m > most_m {
                continue;
            }
            let of_second = beside.map(|(time_s, second)| {
                self.matched(second, example, self.row_after(example, row, *time_s)).distance_m
            });
            let distance_m = found.distance_m.max(of_second.unwrap_or_default());
            if distance_m <= limit_m && nearest.is_none_or(|nearest| distance_m < nearest.distance_m) {
                nearest = Some(RowMatch { distance_m, ..found });
            }
        }
        nearest
    }

    /// The row of an example some time after another one, s.
    fn row_after(&self, example: usize, row: usize, time_s: f64) -> usize {
        let Some(map) = self.maps[example] else { return row };
        let phase = map.phase(map.time_s(row as f32 / PHASE_COUNT as f32) + time_s as f32);
        libm::roundf(phase * PHASE_COUNT as f32) as usize % PHASE_COUNT
    }

    fn matched(&self, state: &JointState, example: usize, row: usize) -> RowMatch {
        let (root, [pose_m, distance_m]) = self.states[example][row].placed_on(state);
        RowMatch { example, row, root, rates: self.rates[example], pose_m, distance_m }
    }
}

/// The state of each row of a cycle: positions in the root frame, velocities over the ground.
fn states(cycle: &GaitCycle, body: &HumanBody) -> Vec<JointState> {
    let arc = RootArc { rates: cycle.rates, ..RootArc::default() };
    let rows: Vec<[DVec3; JOINT_COUNT]> =
        cycle.rows.iter().map(|row| row.forward_kinematics(body).positions_m).collect();
    let time_s = |row: isize| f64::from(cycle.phase_map.time_s(row as f32 / PHASE_COUNT as f32));
    let seen_from = |row: isize, now: isize| {
        let (position_m, facing_rad) = arc.at(time_s(row) - time_s(now));
        let rotation = ground_rotation(facing_rad);
        rows[row.rem_euclid(PHASE_COUNT as isize) as usize]
            .map(|point_m| (rotation * point_m.truncate() + position_m).extend(point_m.z))
    };
    let state = |row: isize| {
        let span_s = time_s(row + 1) - time_s(row - 1);
        JointState::between(&seen_from(row - 1, row), seen_from(row, row), &seen_from(row + 1, row), span_s)
    };
    (0..PHASE_COUNT as isize).map(state).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::retarget::human_clip::Choices;
    use crate::synthetic::{SyntheticWalk, cycle_of, walk};

    #[test]
    fn an_instant_of_a_walk_is_found_in_its_own_cycle() {
        let walks = [SyntheticWalk::at(0.6, 0.8, 0.0), SyntheticWalk::at(1.2, 0.0, 0.0)].map(|plan| walk("walk", plan));
        let named = |clip| NamedCycle {
            name: "walk".into(),
            source: 0,
            window_s: [0.0, 1.0],
            mirrored: false,
            choices: Choices::default(),
            flaws: 0.0,
            cycle: cycle_of(clip),
        };
        let cycles = walks.each_ref().map(named);
        let rows = ExampleRows::of(&cycles, None, &walks[0].body);
        for (example, clip) in walks.iter().enumerate() {
            let positions_m = |frame: usize| clip.frames[frame].forward_kinematics(&clip.body).positions_m;
            // Phase 0 is at 0.37 of the period of 66 frames.
            for frame in [60, 91, 120] {
                let state = JointState::between(
                    &positions_m(frame - 1),
                    positions_m(frame),
                    &positions_m(frame + 1),
                    1.0 / 30.0,
                );
                let found = rows.nearest_stepping(&state, None, 0.1).unwrap();
                let phase = (frame as f64 / 66.0 - 0.37).rem_euclid(1.0);
                assert_eq!(found.example, example);
                assert!(found.distance_m < 0.02, "{found:?}");
                assert!((found.row as f64 / 64.0 - phase).abs() < 0.04, "{found:?}, not {phase}");
            }
        }
    }
}
