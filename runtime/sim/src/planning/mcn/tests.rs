//! Claims about a single plan: what limits it, in which order, and the effect of each part of MCN.

use glam::Vec2;
use motiondb::velocity_sets::velocity_hull::{Construction, VelocityHull};

use crate::params::Params;
use crate::planning::mcn::motion_constraints::MotionConstraints;
use crate::planning::mcn::params::{McnParts, StanceForm};
use crate::planning::mcn::stance_half_plane::tests::on_left_foot;
use crate::planning::orca::half_plane::HalfPlaneSource;
use crate::planning::plan::{Plan, Stance, VelocitySet};
use crate::planning::planner::{Planner, PlannerMemory, plan, ranking_horizon_s};
use crate::planning::world_view::WorldView;
use crate::world::neighbours::NeighbourSearch;
use crate::world::obstacles::Obstacles;

/// A scene of agents that face and prefer +x at 1.3 m/s, and everything else that a world view borrows.
#[derive(Clone)]
pub(crate) struct Scene {
    pub(crate) positions_m: Vec<Vec2>,
    pub(crate) velocities_mps: Vec<Vec2>,
    facings_rad: Vec<f32>,
    pub(crate) preferred_mps: Vec<Vec2>,
    stances: Vec<Stance>,
    obstacles: Obstacles,
    construction: Construction,
    turning_mps: Vec<Vec2>,
    pub(crate) params: Params,
    pub(crate) dt_s: f32,
    bodies: bool,
}

/// Velocity of a walk along +x, m/s.
pub(crate) const WALK: Vec2 = Vec2::new(1.3, 0.0);

/// Corners of a kite-shaped velocity set, clockwise.
fn kite(ahead: f32, aside: f32, back: f32) -> Vec<Vec2> {
    vec![Vec2::new(ahead, 0.0), Vec2::new(0.0, -aside), Vec2::new(-back, 0.0), Vec2::new(0.0, aside)]
}

impl Scene {
    pub(crate) fn new(positions_m: &[[f32; 2]]) -> Self {
        let count = positions_m.len();
        Self {
            positions_m: positions_m.iter().copied().map(Vec2::from).collect(),
            velocities_mps: vec![WALK; count],
            facings_rad: vec![0.0; count],
            preferred_mps: vec![WALK; count],
            stances: vec![Stance::default(); count],
            obstacles: Obstacles::default(),
            construction: Construction::default(),
            turning_mps: kite(1.8, 1.0, 0.5),
            params: Params::default(),
            dt_s: 0.1,
            bodies: true,
        }
    }

    /// The first agent's plan by MCN.
    pub(crate) fn plan(&self) -> Plan {
        self.plan_by(Planner::Mcn, &mut PlannerMemory::default())
    }

    fn plan_by(&self, planner: Planner, memory: &mut PlannerMemory) -> Plan {
        let count = self.positions_m.len();
        let radii_m = vec![0.25; count];
        let mut neighbours = NeighbourSearch::default();
        neighbours.rebuild(&self.positions_m, &self.velocities_mps, &radii_m, ranking_horizon_s(planner, &self.params));
        let hull = VelocityHull {
            construction: self.construction,
            turning_mps: self.turning_mps.clone(),
            holding_mps: kite(1.8, 0.8, 0.8),
            // Behind, nothing is faster than 0.1 m/s.
            sharp_turn_edges_mps: vec![
                [Vec2::new(-0.1, 0.2), Vec2::new(0.0, 1.0)],
                [Vec2::new(0.0, -1.0), Vec2::new(-0.1, -0.2)],
                [Vec2::new(-0.1, -0.2), Vec2::new(-0.1, 0.2)],
            ],
        };
        let world = WorldView {
            positions_m: &self.positions_m,
            velocities_mps: &self.velocities_mps,
            facings_rad: &self.facings_rad,
            radii_m: &radii_m,
            wall_radii_m: &radii_m,
            preferred_mps: &self.preferred_mps,
            free_speeds_mps: &vec![WALK.x; count],
            facing_offsets_rad: &vec![0.0; count],
            stances: &self.stances,
            planned_mps: &self.velocities_mps,
            strafing_s: &vec![0.0; count],
            stepping_back_s: &vec![0.0; count],
            neighbours: &neighbours,
            obstacles: &self.obstacles,
            own_walls: None,
            one_way: &[],
            priorities: None,
            constraints: &MotionConstraints::new(&hull),
            own_constraints: None,
            speed_factors: None,
            dt_s: self.dt_s,
            bodies: self.bodies,
        };
        plan(planner, &world, 0, &self.params, memory)
    }
}

#[test]
fn a_lone_agent_keeps_its_preferred_velocity() {
    let plan = Scene::new(&[[0.0, 0.0]]).plan();
    assert_eq!((plan.velocity_mps, plan.facing_rad, plan.set), (WALK, 0.0, VelocitySet::Turning));
    assert_eq!(plan.time_to_collision_s, f32::INFINITY);
}

#[test]
fn disc_acceleration_is_independent_of_step_length() {
    for dt_s in [1.0 / 120.0, 1.0 / 30.0, 0.1] {
        let mut scene = Scene { dt_s, bodies: false, ..alone(WALK) };
        scene.velocities_mps[0] = Vec2::ZERO;
        scene.params.planner.acceleration_max_mps2 = 1.1;
        let gained_mps2 = scene.plan().velocity_mps / dt_s;
        assert!(gained_mps2.distance(Vec2::new(1.1, 0.0)) < 1e-3, "dt {dt_s}: {gained_mps2}");
    }
}

#[test]
fn no_plan_is_faster_than_the_database() {
    let mut scene = Scene::new(&[[0.0, 0.0]]);
    scene.preferred_mps[0] = Vec2::new(4.0, 0.0);
    scene.velocities_mps[0] = Vec2::new(1.8, 0.0);
    assert!(scene.plan().velocity_mps.distance(Vec2::new(1.8, 0.0)) < 1e-4);
}

#[test]
fn nobody_runs_to_give_way() {
    let mut scene = Scene::new(&[[0.0, 0.0], [-0.05, 0.01]]);
    scene.turning_mps = kite(5.0, 1.0, 0.5);
    let speed_mps = scene.plan().velocity_mps.length();
    assert!((1.6..1.3 * WALK.x + 1e-4).contains(&speed_mps), "{speed_mps} m/s");
    scene.preferred_mps[0] = Vec2::new(0.2, 0.0);
    assert!(scene.plan().velocity_mps.length() < 1.5 + 1e-4);
}

#[test]
fn overlapping_agents_part_no_faster_in_finer_steps() {
    let mut scene = Scene { preferred_mps: vec![Vec2::ZERO; 2], ..Scene::new(&[[0.0, 0.0], [0.2, 0.1]]) };
    let [coarse, fine, finest] = [0.05, 1.0 / 60.0, 1.0 / 120.0].map(|dt_s| {
        scene.dt_s = dt_s;
        scene.plan().velocity_mps
    });
    assert!(coarse.x < 0.0 && coarse == fine && fine == finest, "{coarse} {fine} {finest}");
}

#[test]
fn an_agent_that_faces_a_wall_obliquely_side_steps() {
    let mut scene = Scene::new(&[[0.0, 0.0]]);
    scene.turning_mps = vec![Vec2::ZERO, Vec2::new(1.5, 0.4), Vec2::new(1.5, -0.4)];
    scene.obstacles = Obstacles::new(&[[(0.27, -3.0), (0.5, -3.0), (0.5, 3.0), (0.27, 3.0)].map(Vec2::from).to_vec()]);
    scene.velocities_mps[0] = Vec2::ZERO;
    scene.facings_rad[0] = std::f32::consts::FRAC_PI_4;
    scene.preferred_mps[0] = Vec2::from_angle(scene.facings_rad[0]);
    let plan = scene.plan();
    assert!(plan.velocity_mps.y > 0.1 && plan.velocity_mps.x.abs() < 0.02, "{}", plan.velocity_mps);
    assert_eq!((plan.set, plan.facing_rad), (VelocitySet::Holding, scene.facings_rad[0]));
}

#[test]
fn half_planes_are_in_order_of_yielding() {
    let mut scene = Scene::new(&[[0.0, 0.0], [3.0, 0.1], [2.0, 1.5]]);
    scene.velocities_mps[1] = -WALK;
    scene.preferred_mps[0] = Vec2::new(-1.0, 0.5);
    scene.obstacles = Obstacles::new(&[vec![Vec2::new(-1.0, -1.0), Vec2::new(2.0, -1.0), Vec2::new(0.5, -0.5)]]);
    scene.stances[0].foot = Some(on_left_foot());
    let mut memory = PlannerMemory::default();
    scene.plan_by(Planner::Mcn, &mut memory);
    let mut sources: Vec<HalfPlaneSource> =
        memory.half_planes(Planner::Mcn).iter().map(|half_plane| half_plane.source).collect();
    assert!(matches!(sources[0], HalfPlaneSource::Obstacle(_)));
    sources.retain(|source| !matches!(source, HalfPlaneSource::Obstacle(_)));
    sources.dedup();
    let expected = [
        HalfPlaneSource::Stance,
        HalfPlaneSource::SharpTurn,
        HalfPlaneSource::TurningHull,
        HalfPlaneSource::Agent(1),
        HalfPlaneSource::Agent(2),
    ];
    assert_eq!(sources, expected);
}

#[test]
fn an_agent_evades_another_that_comes_head_on() {
    let mut scene = Scene::new(&[[0.0, 0.0], [4.0, 0.0]]);
    scene.velocities_mps[1] = -WALK;
    let plan = scene.plan();
    assert!(plan.velocity_mps.y < 0.0 && plan.velocity_mps.x > 0.5, "{plan:?}");
    assert!((plan.time_to_collision_s - 3.5 / 2.6).abs() < 1e-4);
}

#[test]
fn an_agent_pushed_gently_steps_aside_at_held_facing() {
    let mut scene = Scene::new(&[[0.0, 0.0], [0.4, 1.0]]);
    scene.velocities_mps = vec![Vec2::new(0.2, 0.0), Vec2::new(0.0, -0.4)];
    scene.preferred_mps[0] = Vec2::new(0.3, 0.0);
    let plan = scene.plan();
    assert!(plan.velocity_mps.y < -0.1 && plan.strafing_s > 0.0, "{plan:?}");
    assert_eq!((plan.set, plan.facing_rad), (VelocitySet::Holding, 0.0), "{plan:?}");
}

#[test]
fn paper_construction_turns_instead_of_stepping_back() {
    let mut scene = Scene::new(&[[0.0, 0.0], [0.55, 0.0]]);
    scene.velocities_mps = vec![Vec2::ZERO, Vec2::new(-1.2, 0.0)];
    scene.preferred_mps[0] = Vec2::new(0.3, 0.0);
    let plan = scene.plan();
    assert!(plan.velocity_mps.x < -0.1 && plan.stepping_back_s > 0.0, "{plan:?}");
    assert_eq!((plan.set, plan.facing_rad), (VelocitySet::Holding, 0.0), "{plan:?}");
    scene.construction = Construction::Paper;
    let plan = scene.plan();
    assert!(plan.set == VelocitySet::Turning && plan.facing_rad.abs() > 0.1, "{plan:?}");
}

/// Checks a switch on a scene in which its part matters and one in which it does not.
pub(crate) fn check_switch(matters: &Scene, does_not: &Scene, off: impl Fn(&mut McnParts)) {
    let without = |scene: &Scene| {
        let mut params = scene.params.clone();
        off(&mut params.planner.parts);
        Scene { params, ..scene.clone() }.plan()
    };
    assert_ne!(without(matters), matters.plan());
    assert_eq!(without(does_not), does_not.plan());
}

/// Another agent comes towards the first, a little to the left.
fn encounter() -> Scene {
    let mut scene = Scene::new(&[[0.0, 0.0], [3.0, 0.2]]);
    scene.velocities_mps[1] = -WALK;
    scene
}

/// Eight agents walk close ahead in the same direction.
fn dense() -> Scene {
    let rank = |index: usize| [0.7 + 0.6 * (index / 2) as f32, 0.6 * (index % 2) as f32 - 0.3];
    Scene::new(&[[[0.0, 0.0]].as_slice(), &(0..8).map(rank).collect::<Vec<_>>()].concat())
}

/// A lone agent with a preferred velocity.
pub(crate) fn alone(preferred_mps: Vec2) -> Scene {
    let mut scene = Scene::new(&[[0.0, 0.0]]);
    scene.preferred_mps[0] = preferred_mps;
    scene
}

#[test]
fn adaptation_and_keeping_right_matter_in_an_encounter() {
    check_switch(&encounter(), &Scene::new(&[[0.0, 0.0], [0.0, 5.0]]), |parts| parts.adaptation = false);
    check_switch(&encounter(), &Scene::new(&[[0.0, 0.0]]), |parts| parts.keep_right = false);
}

#[test]
fn an_agent_that_stands_turns_to_its_route_before_it_walks() {
    let mut aside = alone(WALK.perp());
    aside.velocities_mps[0] = Vec2::ZERO;
    check_switch(&aside, &alone(WALK), |parts| parts.turn_first = false);
    let with = aside.plan();
    aside.params.planner.parts.turn_first = false;
    let without = aside.plan();
    assert!(with.velocity_mps.length() < 0.5 * without.velocity_mps.length(), "{with:?} {without:?}");
    assert!(with.facing_rad > without.facing_rad + 0.02, "{with:?} {without:?}");
}

#[test]
fn the_density_filter_matters_in_a_crowd() {
    check_switch(&dense(), &encounter(), |parts| parts.density_filter = false);
}

#[test]
fn the_hull_matters_outside_it() {
    let mut aside = alone(Vec2::new(0.9, 0.9));
    aside.velocities_mps[0] = aside.preferred_mps[0];
    check_switch(&aside, &Scene::new(&[[0.0, 0.0]]), |parts| parts.hull = false);
}

#[test]
fn sharp_turns_matter_where_v_pref_lies_behind() {
    let mut behind = alone(Vec2::new(-0.3, 0.4));
    behind.velocities_mps[0] = Vec2::new(-0.05, 0.3);
    // An agent that turns first is slower than any sharp turn.
    behind.params.planner.parts.turn_first = false;
    check_switch(&behind, &encounter(), |parts| parts.sharp_turns = false);
}

#[test]
fn stance_shape_matters_on_one_foot() {
    let mut standing = alone(Vec2::new(0.0, 0.9));
    standing.velocities_mps[0] = standing.preferred_mps[0];
    let both_feet = standing.clone();
    standing.stances[0].foot = Some(on_left_foot());
    for form in [StanceForm::Off, StanceForm::Radial] {
        check_switch(&standing, &both_feet, |parts| parts.stance = form);
    }
}

/// Four agents close in on the first, one of them fast.
fn closed_in() -> Scene {
    let mut scene = Scene::new(&[[0.0, 0.0], [0.52, 0.1], [-0.5, 0.2], [0.1, -0.55], [0.0, 1.2]]);
    let closing = [[0.0, 0.0], [-0.8, 0.0], [0.9, 0.0], [0.0, 0.8], [0.0, -1.3]];
    scene.velocities_mps = closing.map(Vec2::from).to_vec();
    scene
}

/// The scene mirrored in the x axis.
fn mirrored(scene: &Scene) -> Scene {
    let flipped = |vectors: &[Vec2]| vectors.iter().map(|vector| *vector * Vec2::new(1.0, -1.0)).collect();
    Scene {
        positions_m: flipped(&scene.positions_m),
        velocities_mps: flipped(&scene.velocities_mps),
        preferred_mps: flipped(&scene.preferred_mps),
        ..scene.clone()
    }
}

// Keeping right alone distinguishes sides: it turns v_pref and divides the shares, so that identical agents pass each
// other. (Discs at one position with one velocity also part along +x; no agent starts so.)
#[test]
fn without_keeping_right_a_mirrored_scene_mirrors_the_plan() {
    let off_mps = |scene: &Scene| {
        let [original, mirrored] = [scene, &mirrored(scene)].map(|scene| scene.plan().velocity_mps);
        (original * Vec2::new(1.0, -1.0)).distance(mirrored)
    };
    for mut scene in [encounter(), dense(), closed_in()] {
        scene.params.planner.parts.keep_right = false;
        assert!(off_mps(&scene) < 1e-4, "{}", off_mps(&scene));
    }
    assert!(off_mps(&encounter()) > 0.01, "{}", off_mps(&encounter()));
}

#[test]
fn the_order_matters_where_half_planes_yield() {
    check_switch(&closed_in(), &encounter(), |parts| parts.order = false);
}

#[test]
fn orientation_and_back_pedalling_matter_at_held_facing() {
    let mut aside = Scene::new(&[[0.0, 0.0], [0.4, 1.0]]);
    aside.velocities_mps = vec![Vec2::new(0.2, 0.0), Vec2::new(0.0, -0.4)];
    aside.preferred_mps[0] = Vec2::new(0.3, 0.0);
    check_switch(&aside, &alone(WALK), |parts| parts.orientation = false);
    let mut back = Scene::new(&[[0.0, 0.0], [0.55, 0.0]]);
    back.velocities_mps = vec![Vec2::ZERO, Vec2::new(-0.6, 0.0)];
    back.preferred_mps = vec![Vec2::new(0.3, 0.0), -WALK];
    check_switch(&back, &aside, |parts| parts.back_pedalling = false);
}

#[test]
fn without_its_parts_mcn_is_orca() {
    let parts = McnParts {
        adaptation: false,
        density_filter: false,
        hull: false,
        sharp_turns: false,
        stance: StanceForm::Off,
        order: false,
        orientation: false,
        back_pedalling: false,
        keep_right: false,
        queueing: false,
        slowing: false,
        pressing: false,
        turn_first: false,
    };
    for mut scene in [encounter(), dense(), closed_in()] {
        scene.velocities_mps[1..].iter_mut().for_each(|velocity_mps| *velocity_mps *= 1.2);
        scene.params.planner.parts = parts.clone();
        scene.params.orca.time_horizon_s = scene.params.planner.time_horizon_s;
        scene.params.orca.speed_max_mps = 1.3 * WALK.x;
        let [mcn, orca] = [Planner::Mcn, Planner::Orca]
            .map(|planner| scene.plan_by(planner, &mut PlannerMemory::default()).velocity_mps);
        assert!(mcn.distance(orca) < 1e-5, "{mcn} {orca}");
    }
}

#[test]
fn walls_and_agents_leave_elbow_room() {
    let mut scene = Scene::new(&[[0.0, 0.0], [0.6, 0.0], [-0.1, 2.0]]);
    scene.obstacles =
        Obstacles::new(&[[[-3.0, -0.9], [3.0, -0.9], [3.0, -0.4], [-3.0, -0.4]].map(Vec2::from).to_vec()]);
    let room = scene.plan().room;
    let ends_m = room.sides().iter().map(|side| side.distance_m * side.towards);
    let expected_m = [Vec2::new(0.3, 0.0), Vec2::new(0.0, -0.4)];
    assert!(ends_m.clone().count() == 2, "{room:?}");
    assert!(ends_m.zip(expected_m).all(|(end_m, expected_m)| end_m.distance(expected_m) < 1e-5), "{room:?}");
}
