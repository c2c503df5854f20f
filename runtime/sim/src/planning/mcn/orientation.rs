//! The preferred facing, and whether it is held or follows the velocity (`FbCrowd` §4.5).
//!
//! ```text
//! f_d = v_pref/‖v_pref‖   if  v_pref·v_i >= 0  and  t_strafe < t_strafeLim
//!       v_i/‖v_i‖         otherwise
//! ```
//!
//! To face v_pref while walking elsewhere is to side-step, so the first line also asks that the holding set, at that
//! facing, holds v_i: a body that the database cannot move that way turns. Ours is its mirror image, stepping back:
//! v_pref·v_i < 0, a shorter while. Who only shuffles may do either as long as it takes. Both whiles are contiguous,
//! and start anew only after a rest at aligned facing: without it the facing would flicker. Where v_pref or v_i is 0,
//! the facing is kept; but who stands and would walk elsewhere than ahead turns there.

use glam::Vec2;

use crate::planning::mcn::params::McnParams;
use crate::planning::plan::VelocitySet;

/// Slower than this, a velocity has no direction to face, m/s.
const STANDING_MPS: f32 = 0.1;
/// Slower than this, the facing is held however long: in a throng people shuffle, their faces towards where they want
/// to go. One who turned about for every half-step stood there facing elsewhere: then in 8 of 30 four-way crossings
/// (Table 1's, other seeds) somebody stood for 5 s, with this in 2.
const SHUFFLING_MPS: f32 = 0.4;
/// A velocity within this angle of the facing is no side-step: 10°, as small as gait noise in the turn rate makes it
/// look.
const ALIGNED_COS: f32 = 0.984_807_8;
/// A facing within this angle of the wanted one is held, beyond it the body still turns: 30°.
const HELD_COS: f32 = 0.866_025_4;
/// How far outside the holding set a velocity may lie to be walked at held facing, m/s; the set's half-planes then
/// bring it in.
pub(crate) const HOLDING_SLACK_MPS: f32 = 0.1;
/// Rest at aligned facing after which a spent while starts anew, s: a stride.
const REST_S: f32 = 1.0;

/// What walks: everything that the decision depends on.
#[derive(Clone, Copy, Debug)]
pub struct Walk {
    /// Unit vector along the present facing.
    pub forward: Vec2,
    /// v_pref, m/s.
    pub preferred_mps: Vec2,
    /// v_i as the turning set allows it, m/s.
    pub velocity_mps: Vec2,
    /// Contiguous time strafing so far, s.
    pub strafing_s: f32,
    /// Contiguous time stepping back so far, s.
    pub stepping_back_s: f32,
}

/// What is decided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orientation {
    /// f_d, unit vector.
    pub facing: Vec2,
    /// The velocity set in force.
    pub set: VelocitySet,
    /// Contiguous time strafing, s; beyond the limit, the limit and the rest that is still due.
    pub strafing_s: f32,
    /// Contiguous time stepping back, s; beyond the limit likewise.
    pub stepping_back_s: f32,
}

/// §4.5. `holds` tells whether the holding set, at the facing of v_pref, holds v_i.
pub(crate) fn decide(walk: &Walk, holds: impl FnOnce(Vec2) -> bool, dt_s: f32, params: &McnParams) -> Orientation {
    let Some(wanted) = direction(walk.preferred_mps) else { return rest(walk, walk.forward, dt_s, params) };
    let Some(walked) = direction(walk.velocity_mps) else {
        // With v_pref aside or behind, a body would stand so for ever where the database has no tight turn: it turns on
        // the spot.
        let turned_away = wanted.dot(walk.forward) < HELD_COS;
        return rest(walk, if turned_away { wanted } else { walk.forward }, dt_s, params);
    };
    let aligned = wanted.dot(walked) >= ALIGNED_COS;
    if aligned {
        // Who has turned away goes on facing v_i until rested; else the facing would flicker where v_i wavers about
        // aligned.
        let turned_away = walk.strafing_s >= params.strafing_limit_s;
        return rest(walk, if turned_away { walked } else { wanted }, dt_s, params);
    }
    let steps_back = wanted.dot(walked) < 0.0;
    let shuffles = walk.velocity_mps.length() < SHUFFLING_MPS;
    let in_time = if steps_back {
        walk.stepping_back_s < params.stepping_back_limit_s && wanted.dot(walk.forward) >= HELD_COS
    } else {
        walk.strafing_s < params.strafing_limit_s
    };
    if (in_time || shuffles) && holds(wanted) {
        hold(walk, wanted, steps_back, dt_s)
    } else {
        turn(walk, walked, params)
    }
}

/// Without §4.5: the facing follows v_i, or is kept where the body stands.
pub(crate) fn along_the_velocity(walk: &Walk) -> Orientation {
    Orientation {
        facing: direction(walk.velocity_mps).unwrap_or(walk.forward),
        set: VelocitySet::Turning,
        strafing_s: 0.0,
        stepping_back_s: 0.0,
    }
}

/// The facing is, or comes to be, where the body walks, or the body stands.
fn rest(walk: &Walk, facing: Vec2, dt_s: f32, params: &McnParams) -> Orientation {
    let aligned = facing.dot(walk.forward) >= ALIGNED_COS;
    let after = |spent_s: f32, limit_s: f32| if aligned { rested_s(spent_s, limit_s, dt_s) } else { spent_s };
    Orientation {
        facing,
        set: VelocitySet::Turning,
        strafing_s: after(walk.strafing_s, params.strafing_limit_s),
        stepping_back_s: after(walk.stepping_back_s, params.stepping_back_limit_s),
    }
}

/// The facing stays on v_pref, or still turns there.
fn hold(walk: &Walk, wanted: Vec2, steps_back: bool, dt_s: f32) -> Orientation {
    let held = wanted.dot(walk.forward) >= HELD_COS;
    Orientation {
        facing: wanted,
        set: if held { VelocitySet::Holding } else { VelocitySet::Turning },
        strafing_s: walk.strafing_s + if steps_back { 0.0 } else { dt_s },
        stepping_back_s: walk.stepping_back_s + if steps_back { dt_s } else { 0.0 },
    }
}

/// The facing follows v_i. Whoever has turned away goes on so: both whiles are spent until a rest.
fn turn(walk: &Walk, walked: Vec2, params: &McnParams) -> Orientation {
    Orientation {
        facing: walked,
        set: VelocitySet::Turning,
        strafing_s: walk.strafing_s.max(params.strafing_limit_s + REST_S),
        stepping_back_s: walk.stepping_back_s.max(params.stepping_back_limit_s + REST_S),
    }
}

/// A spent while after a step of rest: beyond the limit it shrinks to the limit, and is then forgotten; below, it runs
/// back as it came.
fn rested_s(spent_s: f32, limit_s: f32, dt_s: f32) -> f32 {
    let left_s = (spent_s - dt_s).max(0.0);
    let rest_is_over = spent_s >= limit_s && left_s < limit_s;
    if rest_is_over { 0.0 } else { left_s }
}

/// Whether a velocity has no direction to face.
pub(crate) fn stands(velocity_mps: Vec2) -> bool {
    velocity_mps.length() < STANDING_MPS
}

fn direction(velocity_mps: Vec2) -> Option<Vec2> {
    (!stands(velocity_mps)).then(|| velocity_mps / velocity_mps.length())
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT_S: f32 = 0.1;

    /// Faces and wants +x.
    fn walk(velocity_mps: Vec2) -> Walk {
        Walk { forward: Vec2::X, preferred_mps: Vec2::X, velocity_mps, strafing_s: 0.0, stepping_back_s: 0.0 }
    }

    fn decided(walk: &Walk, holds: bool) -> Orientation {
        decide(walk, |_| holds, DT_S, &McnParams::default())
    }

    /// Walks on with a velocity until a time is over, facing what is decided; returns the last decision.
    fn walk_on(mut walk: Walk, duration_s: f32) -> (Walk, Orientation) {
        let mut orientation = decided(&walk, true);
        for _ in 0..(duration_s / DT_S) as usize {
            orientation = decided(&walk, true);
            let Orientation { facing, strafing_s, stepping_back_s, .. } = orientation;
            walk = Walk { forward: facing, strafing_s, stepping_back_s, ..walk };
        }
        (walk, orientation)
    }

    #[test]
    fn faces_v_pref_while_side_stepping_and_the_velocity_where_the_body_cannot() {
        let aside = walk(Vec2::new(0.3, 0.4));
        assert_eq!(decided(&aside, true).facing, Vec2::X);
        assert_eq!(decided(&aside, true).set, VelocitySet::Holding);
        assert_eq!(decided(&aside, false).facing, Vec2::new(0.6, 0.8));
        assert_eq!(decided(&aside, false).set, VelocitySet::Turning);
    }

    #[test]
    fn strafing_ends_at_its_limit_and_starts_anew_only_after_a_rest() {
        let aside = Vec2::new(0.3, 0.4);
        let (spent, orientation) = walk_on(walk(aside), McnParams::default().strafing_limit_s + 0.5);
        assert_eq!(orientation.facing, aside.normalize());
        let (restless, _) = walk_on(Walk { velocity_mps: Vec2::X, ..spent }, 0.5);
        assert_eq!(decided(&Walk { velocity_mps: aside, ..restless }, true).set, VelocitySet::Turning);
        let (rested, _) = walk_on(Walk { velocity_mps: Vec2::X, ..spent }, 1.5);
        assert_eq!(decided(&Walk { velocity_mps: aside, ..rested }, true).set, VelocitySet::Holding);
    }

    #[test]
    fn steps_back_for_a_while_and_then_turns() {
        let (_, early) = walk_on(walk(-0.4 * Vec2::X), 1.0);
        assert_eq!((early.facing, early.set), (Vec2::X, VelocitySet::Holding));
        let (_, late) = walk_on(walk(-0.4 * Vec2::X), 2.5);
        assert_eq!((late.facing, late.set), (-Vec2::X, VelocitySet::Turning));
    }

    #[test]
    fn who_shuffles_keeps_its_face_to_where_it_wants_to_go() {
        for velocity_mps in [Vec2::new(0.1, 0.3), Vec2::new(-0.3, 0.0), Vec2::new(-0.1, -0.2)] {
            let (_, late) = walk_on(walk(velocity_mps), 20.0);
            assert_eq!((late.facing, late.set), (Vec2::X, VelocitySet::Holding));
        }
        assert_eq!(decided(&walk(Vec2::new(0.1, 0.3)), false).set, VelocitySet::Turning);
    }

    #[test]
    fn a_velocity_that_wavers_about_aligned_does_not_make_the_facing_flicker() {
        let [inside, outside] = [9.0f32, 11.0].map(|degrees| Vec2::from_angle(degrees.to_radians()));
        let mut walk = walk(outside);
        for step in 0..8 {
            walk.velocity_mps = if step % 2 == 0 { outside } else { inside };
            let Orientation { facing, strafing_s, stepping_back_s, .. } = decided(&walk, false);
            assert!(facing.angle_to(outside).abs() < 3.0f32.to_radians(), "step {step}: {facing}");
            walk = Walk { strafing_s, stepping_back_s, ..walk };
        }
    }

    #[test]
    fn keeps_the_facing_where_nothing_is_wanted_or_walked() {
        let forward = Vec2::new(0.96, 0.28);
        assert_eq!(decided(&Walk { forward, ..walk(Vec2::ZERO) }, true).facing, forward);
        let unwanted = Walk { forward, preferred_mps: Vec2::ZERO, ..walk(Vec2::X) };
        assert_eq!(decided(&unwanted, true).facing, forward);
    }

    #[test]
    fn turns_on_the_spot_when_it_stands_and_v_pref_lies_aside_or_behind() {
        for forward in [Vec2::Y, -Vec2::X] {
            assert_eq!(decided(&Walk { forward, ..walk(Vec2::ZERO) }, true).facing, Vec2::X);
        }
    }
}
