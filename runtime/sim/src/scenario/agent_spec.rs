//! One agent of a scenario at its start.

use glam::Vec2;
use serde::{Deserialize, Serialize};

use crate::scenario::characters::character_spec::wears_any;
use crate::scenario::social_group::GroupMember;

/// Default radius of a disc, m: half an adult's bideltoid breadth (0.48 m), the tightest circle about the projected
/// trunk; also the radius in the protocol of Table 1's scenes (`assets/scenarios/table1`).
pub(crate) const RADIUS_M: f32 = 0.25;
/// Default radius of the disc that walls hold, m: people pass a door of 0.5 m in single file, within 0.23 m of its
/// middle (Wuppertal 2018), which a disc of 0.25 m could not.
pub const WALL_RADIUS_M: f32 = 0.2;
/// Default preferred speed, m/s: that of the protocol of Table 1's scenes.
pub(crate) const PREFERRED_SPEED_MPS: f32 = 1.33;

/// One agent at its start: position, goals, disc and preferred speed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AgentSpec {
    /// Start of the agent, world, m.
    pub position_m: Vec2,
    /// Facing at the start, world, rad; towards the first goal unless the scenario sets it.
    pub facing_rad: f32,
    /// Waypoints in order, world, m; the last one is the goal.
    pub goals_m: Vec<Vec2>,
    /// Radius of the bounding disc, which other agents see, m.
    pub radius_m: f32,
    /// Radius of the disc that walls hold, m; at most `radius_m`. A door narrower than twice this is closed.
    pub wall_radius_m: f32,
    /// Speed of v_pref, m/s.
    pub preferred_speed_mps: f32,
    /// What the agent does when it arrives at its goal.
    #[serde(default)]
    pub at_goal: AtGoal,
    /// State of the behaviour in which the agent begins, by index; 0: it follows its waypoints, without behaviour.
    #[serde(default, skip_serializing_if = "follows_path")]
    pub state: u32,
    /// Time for which the agent stands after its birth before it begins, s.
    #[serde(default, skip_serializing_if = "is_0")]
    pub pre_movement_s: f32,
    /// The group with which the agent walks; none: alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub group: Option<GroupMember>,
    /// The zones that the agent does not enter: bit k stands for the k-th zone that is closed to some agents.
    #[serde(default, skip_serializing_if = "enters_all")]
    pub closed_zones: u32,
    /// Right of way: an agent leaves more of the avoiding to one of a lower priority, all of it from a difference of 1.
    #[serde(default, skip_serializing_if = "is_0")]
    pub priority: f32,
    /// Size of the body, relative to the database's skeleton.
    #[serde(default = "of_skeleton", skip_serializing_if = "is_of_skeleton")]
    pub stature: f32,
    /// The characters that the agent may wear: bit k stands for the k-th of the scenario; 0: all.
    #[serde(default, skip_serializing_if = "wears_any")]
    pub characters: u64,
    /// Whether the radius is that of the character that the agent wears, because the scenario states none.
    #[serde(default, skip_serializing_if = "is_stated")]
    pub wears_radius: bool,
    /// Style of the body's motion: k stands for the k-th of the scenario's `styles`, counted from 1; 0: no style.
    #[serde(default, skip_serializing_if = "has_no_style")]
    pub style: u32,
}

/// Whether a style is none; recordings leave it out.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
pub(crate) fn has_no_style(style: &u32) -> bool {
    *style == 0
}

/// Whether a radius is no character's; recordings leave it out.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
pub(crate) fn is_stated(wears_radius: &bool) -> bool {
    !*wears_radius
}

/// The stature of a body of the skeleton's size.
pub(crate) fn of_skeleton() -> f32 {
    1.0
}

/// Whether a body is as large as the skeleton; recordings leave it out.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
pub(crate) fn is_of_skeleton(stature: &f32) -> bool {
    *stature == 1.0
}

/// Whether no zone is closed to an agent; recordings leave it out.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
pub(crate) fn enters_all(closed_zones: &u32) -> bool {
    *closed_zones == 0
}

/// Whether a number is 0; recordings leave it out.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
pub(crate) fn is_0(number: &f32) -> bool {
    *number == 0.0
}

/// Whether a state is that of agents that follow their waypoints; recordings leave it out.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
pub(crate) fn follows_path(state: &u32) -> bool {
    *state == 0
}

/// What an agent does when it arrives at its last goal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AtGoal {
    /// It brakes, and stands at its goal.
    #[default]
    Stay,
    /// It walks through its goal and is removed between two steps of its feet.
    Leave,
    /// It walks up to its goal and is removed at once.
    LeaveAtOnce,
}

impl Default for AgentSpec {
    /// An adult that walks, at the origin, without a goal.
    fn default() -> Self {
        Self {
            position_m: Vec2::ZERO,
            facing_rad: 0.0,
            goals_m: Vec::new(),
            radius_m: RADIUS_M,
            wall_radius_m: WALL_RADIUS_M,
            preferred_speed_mps: PREFERRED_SPEED_MPS,
            at_goal: AtGoal::Stay,
            state: 0,
            pre_movement_s: 0.0,
            closed_zones: 0,
            priority: 0.0,
            stature: 1.0,
            characters: 0,
            wears_radius: false,
            style: 0,
            group: None,
        }
    }
}
