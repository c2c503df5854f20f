//! How often, and how deep, discs and bodies touch walls (`FbCrowd` §7, the obstacle course).
//!
//! The synthesised root is kept outside walls (`coupling::body_to_disc`), so a disc that a wall holds lies exactly at
//! its wall radius from it, up to `TOUCH_M`. A body touches a wall where one of its capsules does; walls are upright, so
//! bones are projected on the ground. Only frames count, not the motion between them. World axes, metres.

use glam::Vec3;
use motiondb::body::{Joint, Joints, Root, Skeleton};

use crate::maths::segment_distance::{Segment, distance_m};
use crate::measures::bone_capsule::bone;
use crate::recording::frame::AgentFrame;
use crate::scenario::Scenario;
use crate::world::obstacles::{NearEdge, Obstacles, ZoneWalls};

/// Distance of a disc that a wall holds, beyond its wall radius, m: the skin that the clamp keeps, and rounding.
const TOUCH_M: f32 = 1.5e-4;
/// Greatest reach of a capsule from its root, m: an arm held out.
const REACH_M: f32 = 1.2;
/// Depth from which a body in a wall shows, m.
const DEEP_M: f32 = 0.01;

/// How walls hold an agent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HeldDisc {
    /// Radius of the disc that walls hold, m.
    pub(crate) radius_m: f32,
    /// Zones that the agent does not enter, by bits.
    pub(crate) closed_zones: u32,
    /// Size of the body, relative to the skeleton.
    pub(crate) stature: f32,
}

/// Counts contacts, frame by frame.
#[derive(Debug)]
pub(crate) struct WallContact {
    skeleton: Skeleton,
    /// The scenario, where it has doors.
    with_doors: Option<Scenario>,
    /// Whether each door is closed in the present frame, by index.
    closed: Vec<bool>,
    /// The walls of the present frame.
    obstacles: Obstacles,
    /// The walls of agents that do not enter some zones.
    zone_walls: ZoneWalls,
    agent_frames: usize,
    touching_discs: usize,
    touching_bodies: usize,
    deep_bodies: usize,
    greatest_depth_m: f32,
}

/// Contacts with walls over a whole recording; all 0 where there are no walls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WallContactShares {
    /// Share of agents and frames in which a disc is held at a wall.
    pub(crate) disc_share: f64,
    /// Share of agents and frames in which a body reaches into a wall.
    pub(crate) body_share: f64,
    /// Share of agents and frames in which a body reaches more than 1 cm into a wall.
    pub(crate) deep_body_share: f64,
    /// Greatest depth of a body in a wall, mm.
    pub(crate) greatest_depth_mm: f64,
}

impl WallContact {
    /// No frames yet.
    pub(crate) fn new(skeleton: &Skeleton, scenario: &Scenario) -> Self {
        Self {
            skeleton: skeleton.clone(),
            with_doors: (!scenario.doors.is_empty()).then(|| scenario.clone()),
            closed: Vec::new(),
            obstacles: scenario.walls(),
            zone_walls: scenario.zone_walls(&[]),
            agent_frames: 0,
            touching_discs: 0,
            touching_bodies: 0,
            deep_bodies: 0,
            greatest_depth_m: 0.0,
        }
    }

    /// Takes the walls of the next frame, given whether each door is closed in it, by index.
    pub(crate) fn set_doors(&mut self, closed: Vec<bool>) {
        if let Some(scenario) = &self.with_doors
            && self.closed != closed
        {
            self.obstacles = scenario.walls_with(&closed);
            self.zone_walls = scenario.zone_walls(&closed);
            self.closed = closed;
        }
    }

    /// Adds one frame: every present agent, its joints in its root's frame, the radius of the disc that walls hold, and
    /// the zones that it does not enter, by bits.
    pub(crate) fn push(&mut self, agents: &[AgentFrame], joints: &[Joints], held: &[HeldDisc]) {
        self.agent_frames += agents.len();
        let mut near = Vec::new();
        for ((agent, joints), &HeldDisc { radius_m, closed_zones, stature }) in agents.iter().zip(joints).zip(held) {
            let walls = self.zone_walls.of(closed_zones).unwrap_or(&self.obstacles);
            walls.near(agent.root.position_m, REACH_M.max(radius_m + TOUCH_M), &mut near);
            let Some(nearest) = near.first() else { continue };
            self.touching_discs += usize::from(nearest.distance_m < radius_m + TOUCH_M);
            let depth_m = depth_m(&self.skeleton.sized(stature), walls, &agent.root, joints, &near);
            self.touching_bodies += usize::from(depth_m > 0.0);
            self.deep_bodies += usize::from(depth_m > DEEP_M);
            self.greatest_depth_m = self.greatest_depth_m.max(depth_m);
        }
    }

    /// The measures after the last frame.
    pub(crate) fn finish(&self) -> WallContactShares {
        let share = |count: usize| count as f64 / self.agent_frames.max(1) as f64;
        WallContactShares {
            disc_share: share(self.touching_discs),
            body_share: share(self.touching_bodies),
            deep_body_share: share(self.deep_bodies),
            greatest_depth_mm: 1e3 * f64::from(self.greatest_depth_m),
        }
    }
}

/// Depth of the deepest capsule in a wall, m.
fn depth_m(skeleton: &Skeleton, walls: &Obstacles, root: &Root, joints: &Joints, near: &[NearEdge]) -> f32 {
    let depths_m = Joint::ALL.iter().map(|joint| {
        let bone = bone(skeleton, joints, joint.index());
        let on_ground = |point_m: Vec3| root.to_world(point_m).truncate().extend(0.0);
        let bone = Segment { from_m: on_ground(bone.from_m), to_m: on_ground(bone.to_m) };
        let radius_m = skeleton.segment_radii_m[joint.index()];
        let to_wall_m = |part: &Segment| {
            let to_edge_m = near.iter().map(|near| {
                let [from_m, to_m] = walls.ends_m(near.edge).map(|end_m| end_m.extend(0.0));
                distance_m(part, &Segment { from_m, to_m })
            });
            to_edge_m.fold(f32::INFINITY, f32::min)
        };
        let ends_m = [bone.from_m, bone.to_m].into_iter();
        let inside = ends_m.filter(|end_m| walls.contains(end_m.truncate()));
        let depths_m = inside.map(|end_m| to_wall_m(&Segment { from_m: end_m, to_m: end_m }));
        radius_m + depths_m.reduce(f32::max).unwrap_or_else(|| -to_wall_m(&bone))
    });
    depths_m.fold(0.0, f32::max)
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::behaviour::Area;
    use crate::scenario::ZoneSpec;
    use crate::test_db::test_db;

    /// Contacts of one standing body beside a wall that begins at x = 0, its root at x = −`clear_m`.
    fn beside(clear_m: f32) -> WallContactShares {
        let (db, mut scenario) = (test_db(), crate::simulation::tests::antipodal(1, 4.0));
        scenario.obstacles_m = vec![[(0.0, -5.0), (1.0, -5.0), (1.0, 5.0), (0.0, 5.0)].map(Vec2::from).to_vec()];
        let root = Root { position_m: Vec2::new(-clear_m, 0.0), facing_rad: 0.0 };
        let frame = AgentFrame { root, pose: db.rows.pose(0, 0), ..AgentFrame::default() };
        let mut contact = WallContact::new(&db.skeleton, &scenario);
        contact.push(
            &[frame],
            &[frame.pose.forward_kinematics(&db.skeleton)],
            &[HeldDisc { radius_m: 0.2, closed_zones: 0, stature: 1.0 }],
        );
        contact.finish()
    }

    /// Reach of the body ahead of its root, m.
    fn ahead_m() -> f32 {
        let db = test_db();
        let joints = db.rows.pose(0, 0).forward_kinematics(&db.skeleton);
        let reach_m = |joint: &Joint| {
            let Segment { from_m, to_m } = bone(&db.skeleton, &joints, joint.index());
            from_m.x.max(to_m.x) + db.skeleton.segment_radii_m[joint.index()]
        };
        Joint::ALL.iter().map(reach_m).fold(0.0, f32::max)
    }

    #[test]
    fn a_closed_zone_is_a_wall_of_those_that_do_not_enter_it() {
        let (db, mut scenario) = (test_db(), crate::simulation::tests::antipodal(2, 4.0));
        let area = Area::rectangle(Vec2::new(-1.0, -1.0), Vec2::ONE);
        scenario.zones =
            vec![ZoneSpec { area, speed_factor: 1.0, is_closed: true, closed_in: vec![], one_way_deg: None }];
        scenario.agents[1].closed_zones = 1;
        let root = Root { position_m: Vec2::new(-1.05, 0.0), facing_rad: 0.0 };
        let frame = AgentFrame { root, pose: db.rows.pose(0, 0), ..AgentFrame::default() };
        let shares = [0, 1].map(|closed_zones| {
            let mut contact = WallContact::new(&db.skeleton, &scenario);
            let joints = frame.pose.forward_kinematics(&db.skeleton);
            contact.push(&[frame], &[joints], &[HeldDisc { radius_m: 0.2, closed_zones, stature: 1.0 }]);
            contact.finish().deep_body_share
        });
        assert_eq!(shares, [0.0, 1.0]);
    }

    #[test]
    fn bodies_touch_by_capsules_discs_by_radius() {
        let radius_m = 0.2;
        let apart =
            WallContactShares { disc_share: 0.0, body_share: 0.0, deep_body_share: 0.0, greatest_depth_mm: 0.0 };
        assert_eq!(beside(2.0), apart);
        assert_eq!((beside(ahead_m() - 0.009).deep_body_share, beside(ahead_m() - 0.011).deep_body_share), (0.0, 1.0));
        assert_eq!((beside(radius_m).disc_share, beside(radius_m + 0.01).disc_share), (1.0, 0.0));
        assert_eq!((beside(ahead_m() - 0.01).body_share, beside(ahead_m() + 0.01).body_share), (1.0, 0.0));
        // A foot half behind the face of the wall, and all of it behind.
        for deep_m in [0.01, 0.1, 0.2] {
            let found_mm = beside(ahead_m() - deep_m).greatest_depth_mm;
            assert!((found_mm - 1e3 * f64::from(deep_m)).abs() < 0.1, "{found_mm} mm at {deep_m} m");
        }
    }
}
