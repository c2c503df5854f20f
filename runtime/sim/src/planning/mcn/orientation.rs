//! The preferred facing, and whether it is held or follows the velocity (`FbCrowd` §4.5).
//!
//! ```text
//! f_d = v_pref/‖v_pref‖   if  v_pref·v_i >= 0  and  t_strafe < t_strafeLim
//!       v_i/‖v_i‖         otherwise
//! ```
//!
//! An agent that faces v_pref while it walks in another direction side-steps, so the first line also requires that the
//! holding set, at that facing, holds v_i: a body that the database cannot move so turns. Stepping back is our mirror
//! image of it: v_pref·v_i < 0, for a shorter time. An agent that only shuffles may do either without limit. Out of time,
//! an agent faces the nearer to v_i the faster it moves: with one limit of speed the facing would jump whenever the speed
//! crosses it. Both times are contiguous and start again only after a rest at aligned facing; without that rule the
//! facing would flicker. Where v_pref or v_i is 0 the facing is kept, but an agent that stands and has v_pref aside or
//! behind turns on the spot.
//!
//! Where v_pref leads back off a wall (`route::steering`), here it means the velocity that is turned to the direction of
//! the route, which the agent faces.
//!
//! World axes, m/s, seconds.

use glam::Vec2;

use crate::planning::mcn::params::McnParams;
use crate::planning::plan::VelocitySet;

/// Speed below which a velocity has no direction to face, m/s.
const STANDING_MPS: f32 = 0.1;
/// Speed up to which an agent shuffles and may hold its facing without limit, m/s (docs/tuning.md).
const SHUFFLING_MPS: f32 = 0.7;
/// Speed from which an agent that may not hold its facing faces v_i wholly, m/s.
const WALKING_MPS: f32 = 1.3;
/// Cosine of the angle to the facing within which a velocity is not a side-step: 10°, as much as gait noise in the turn
/// rate.
const ALIGNED_COS: f32 = 0.984_807_8;
/// Cosine of the angle to v_pref within which a facing is held; beyond it the body still turns: 30°.
const HELD_COS: f32 = 0.866_025_4;
/// Distance outside the holding set up to which a velocity is walked at held facing, m/s; the set's half-planes then
/// bring it in.
pub(crate) const HOLDING_SLACK_MPS: f32 = 0.1;
/// Rest at aligned facing after which a time over its limit starts again, s: a stride.
const REST_S: f32 = 1.0;

/// What the decision depends on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OrientationInput {
    /// Unit vector along the present facing.
    pub(crate) forward: Vec2,
    /// v_pref, turned to the direction of the route, m/s.
    pub(crate) preferred_mps: Vec2,
    /// v_i as found so far, m/s.
    pub(crate) velocity_mps: Vec2,
    /// Contiguous time of strafing so far, s.
    pub(crate) strafing_s: f32,
    /// Contiguous time of stepping back so far, s.
    pub(crate) stepping_back_s: f32,
}

/// The decision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Orientation {
    /// f_d: unit vector along the facing to turn to.
    pub(crate) facing: Vec2,
    /// The active velocity set.
    pub(crate) set: VelocitySet,
    /// Contiguous time of strafing, s; beyond its limit, the limit plus the rest that is due.
    pub(crate) strafing_s: f32,
    /// Contiguous time of stepping back, s; beyond its limit, the limit plus the rest that is due.
    pub(crate) stepping_back_s: f32,
}

/// §4.5. `holds` returns whether the holding set, at a facing, holds v_i. Cases, in order:
///
/// 1. v_pref = 0: keep the facing;
/// 2. v_i = 0: keep the facing, or turn to v_pref on the spot;
/// 3. v_i along v_pref: face v_pref, or v_i until rested;
/// 4. side-step or step back in time: hold the facing of v_pref;
/// 5. otherwise: face v_i; between shuffling and walking, a direction between v_pref and v_i.
pub(crate) fn decide(
    input: &OrientationInput,
    holds: impl FnOnce(Vec2) -> bool,
    dt_s: f32,
    params: &McnParams,
) -> Orientation {
    let Some(preferred) = direction(input.preferred_mps) else {
        return rest(input, input.forward, dt_s, params); // case 1
    };
    let Some(planned) = direction(input.velocity_mps) else {
        // Case 2. With v_pref aside or behind, a body would stand for ever where the database has no tight turn.
        let turned_away = preferred.dot(input.forward) < HELD_COS;
        return rest(input, if turned_away { preferred } else { input.forward }, dt_s, params);
    };
    let aligned = preferred.dot(planned) >= ALIGNED_COS;
    if aligned {
        // Case 3. An agent that has turned away faces v_i until rested; else the facing would flicker where v_i wavers
        // about aligned.
        let turned_away = input.strafing_s >= params.strafing_limit_s;
        return rest(input, if turned_away { planned } else { preferred }, dt_s, params);
    }
    let steps_back = preferred.dot(planned) < 0.0;
    let in_time = if steps_back {
        input.stepping_back_s < params.stepping_back_limit_s && preferred.dot(input.forward) >= HELD_COS
    } else {
        input.strafing_s < params.strafing_limit_s
    };
    let turned = if in_time { 0.0 } else { walking_share(input.velocity_mps.length()) };
    if turned == 1.0 || !holds(preferred) {
        turn(input, planned, params) // case 5
    } else if turned == 0.0 {
        hold(input, preferred, steps_back, dt_s) // case 4
    } else {
        turn(input, preferred.lerp(planned, turned).normalize_or(planned), params) // case 5
    }
}

/// How much an agent walks rather than shuffles, from 0 to 1.
fn walking_share(speed_mps: f32) -> f32 {
    ((speed_mps - SHUFFLING_MPS) / (WALKING_MPS - SHUFFLING_MPS)).clamp(0.0, 1.0)
}

/// Without §4.5: the facing follows v_i; an agent that stands keeps it.
pub(crate) fn along_the_velocity(input: &OrientationInput) -> Orientation {
    Orientation {
        facing: direction(input.velocity_mps).unwrap_or(input.forward),
        set: VelocitySet::Turning,
        strafing_s: 0.0,
        stepping_back_s: 0.0,
    }
}

/// Cases 1 to 3: the agent stands, or faces where it walks, or turns there. Aligned, both times run out.
fn rest(input: &OrientationInput, facing: Vec2, dt_s: f32, params: &McnParams) -> Orientation {
    let aligned = facing.dot(input.forward) >= ALIGNED_COS;
    let after = |spent_s: f32, limit_s: f32| if aligned { rested_s(spent_s, limit_s, dt_s) } else { spent_s };
    Orientation {
        facing,
        set: VelocitySet::Turning,
        strafing_s: after(input.strafing_s, params.strafing_limit_s),
        stepping_back_s: after(input.stepping_back_s, params.stepping_back_limit_s),
    }
}

/// Case 4: the facing stays on v_pref, or still turns there.
fn hold(input: &OrientationInput, preferred: Vec2, steps_back: bool, dt_s: f32) -> Orientation {
    let held = preferred.dot(input.forward) >= HELD_COS;
    Orientation {
        facing: preferred,
        set: if held { VelocitySet::Holding } else { VelocitySet::Turning },
        strafing_s: input.strafing_s + if steps_back { 0.0 } else { dt_s },
        stepping_back_s: input.stepping_back_s + if steps_back { dt_s } else { 0.0 },
    }
}

/// Case 5: the agent turns to a facing, and keeps turning: both times count as spent until a rest.
fn turn(input: &OrientationInput, facing: Vec2, params: &McnParams) -> Orientation {
    Orientation {
        facing,
        set: VelocitySet::Turning,
        strafing_s: input.strafing_s.max(params.strafing_limit_s + REST_S),
        stepping_back_s: input.stepping_back_s.max(params.stepping_back_limit_s + REST_S),
    }
}

/// A time after a step of rest, s: beyond the limit it shrinks to the limit and is then reset; below, it runs back as
/// fast as it grew.
fn rested_s(spent_s: f32, limit_s: f32, dt_s: f32) -> f32 {
    let left_s = (spent_s - dt_s).max(0.0);
    let rest_is_over = spent_s >= limit_s && left_s < limit_s;
    if rest_is_over { 0.0 } else { left_s }
}

/// Whether a velocity is too slow to have a direction to face.
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

    /// An agent that faces and prefers +x.
    fn input(velocity_mps: Vec2) -> OrientationInput {
        OrientationInput {
            forward: Vec2::X,
            preferred_mps: Vec2::X,
            velocity_mps,
            strafing_s: 0.0,
            stepping_back_s: 0.0,
        }
    }

    fn decided(input: &OrientationInput, holds: bool) -> Orientation {
        decide(input, |_| holds, DT_S, &McnParams::default())
    }

    /// Keeps a velocity for a duration, facing as decided; returns the last input and decision.
    fn walk_on(mut input: OrientationInput, duration_s: f32) -> (OrientationInput, Orientation) {
        let mut orientation = decided(&input, true);
        for _ in 0..(duration_s / DT_S) as usize {
            orientation = decided(&input, true);
            let Orientation { facing, strafing_s, stepping_back_s, .. } = orientation;
            input = OrientationInput { forward: facing, strafing_s, stepping_back_s, ..input };
        }
        (input, orientation)
    }

    #[test]
    fn side_step_holds_facing_if_possible() {
        let aside = input(Vec2::new(0.3, 0.4));
        assert_eq!(decided(&aside, true).facing, Vec2::X);
        assert_eq!(decided(&aside, true).set, VelocitySet::Holding);
        assert_eq!(decided(&aside, false).facing, Vec2::new(0.6, 0.8));
        assert_eq!(decided(&aside, false).set, VelocitySet::Turning);
    }

    #[test]
    fn strafing_has_a_limit_and_needs_rest() {
        let aside = Vec2::new(0.84, 1.12);
        let (spent, orientation) = walk_on(input(aside), McnParams::default().strafing_limit_s + 0.5);
        assert!(orientation.facing.distance(aside.normalize()) < 1e-6);
        let (restless, _) = walk_on(OrientationInput { velocity_mps: Vec2::X, ..spent }, 0.5);
        assert_eq!(decided(&OrientationInput { velocity_mps: aside, ..restless }, true).set, VelocitySet::Turning);
        let (rested, _) = walk_on(OrientationInput { velocity_mps: Vec2::X, ..spent }, 1.5);
        assert_eq!(decided(&OrientationInput { velocity_mps: aside, ..rested }, true).set, VelocitySet::Holding);
    }

    #[test]
    fn agent_steps_back_then_turns() {
        let (_, early) = walk_on(input(-1.4 * Vec2::X), 1.0);
        assert_eq!((early.facing, early.set), (Vec2::X, VelocitySet::Holding));
        let (_, late) = walk_on(input(-1.4 * Vec2::X), 2.5);
        assert_eq!((late.facing, late.set), (-Vec2::X, VelocitySet::Turning));
    }

    #[test]
    fn facing_out_of_time_nears_the_velocity_with_the_speed() {
        let facing_rad = |speed_mps: f32| {
            let (_, late) = walk_on(input(speed_mps * Vec2::new(0.6, 0.8)), 5.0);
            late.facing.to_angle()
        };
        let facings_rad = [0.6, 0.8, 0.9, 1.0, 1.1, 1.2, 1.4].map(facing_rad);
        assert_eq!(facings_rad[0], 0.0);
        assert!((facings_rad[6] - Vec2::new(0.6, 0.8).to_angle()).abs() < 1e-6);
        // No step of .1 or .2 m/s turns it by more than 20°.
        assert!(facings_rad.windows(2).all(|pair| pair[1] > pair[0] && pair[1] - pair[0] < 0.35), "{facings_rad:?}");
    }

    #[test]
    fn an_agent_that_shuffles_keeps_facing_v_pref() {
        for velocity_mps in [Vec2::new(0.1, 0.3), Vec2::new(-0.3, 0.0), Vec2::new(-0.1, -0.2)] {
            let (_, late) = walk_on(input(velocity_mps), 20.0);
            assert_eq!((late.facing, late.set), (Vec2::X, VelocitySet::Holding));
        }
        assert_eq!(decided(&input(Vec2::new(0.1, 0.3)), false).set, VelocitySet::Turning);
    }

    #[test]
    fn the_facing_does_not_flicker_about_aligned() {
        let [inside, outside] = [9.0f32, 11.0].map(|degrees| Vec2::from_angle(degrees.to_radians()));
        let mut input = input(outside);
        for step in 0..8 {
            input.velocity_mps = if step % 2 == 0 { outside } else { inside };
            let Orientation { facing, strafing_s, stepping_back_s, .. } = decided(&input, false);
            assert!(facing.angle_to(outside).abs() < 3.0f32.to_radians(), "step {step}: {facing}");
            input = OrientationInput { strafing_s, stepping_back_s, ..input };
        }
    }

    #[test]
    fn the_facing_is_kept_without_preference_or_velocity() {
        let forward = Vec2::new(0.96, 0.28);
        assert_eq!(decided(&OrientationInput { forward, ..input(Vec2::ZERO) }, true).facing, forward);
        let aimless = OrientationInput { forward, preferred_mps: Vec2::ZERO, ..input(Vec2::X) };
        assert_eq!(decided(&aimless, true).facing, forward);
    }

    #[test]
    fn standing_agent_turns_to_v_pref() {
        for forward in [Vec2::Y, -Vec2::X] {
            assert_eq!(decided(&OrientationInput { forward, ..input(Vec2::ZERO) }, true).facing, Vec2::X);
        }
    }
}
