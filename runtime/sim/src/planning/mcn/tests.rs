//! Claims about a single plan: what limits it, in which order, and what each part of MCN is good for.

use motiondb::velocity_sets::velocity_hull::VelocityHull;

use super::*;
use crate::params::Params;
use crate::planning::mcn::motion_constraints::MotionConstraints;
use crate::planning::mcn::params::Parts;
use crate::planning::plan::Stance;
use crate::planning::planner::{Planner, ahead_s, plan};
use crate::world::neighbours::Neighbours;
use crate::world::obstacles::Obstacles;

/// A scene of agents that face and want +x at 1.3 m/s, and all the rest that a world borrows.
#[derive(Clone)]
struct Scene {
    positions_m: Vec<Vec2>,
    velocities_mps: Vec<Vec2>,
    facings_rad: Vec<f32>,
    preferred_mps: Vec<Vec2>,
    stances: Vec<Stance>,
    obstacles: Obstacles,
    construction: Construction,
    turning_mps: Vec<Vec2>,
    params: Params,
    dt_s: f32,
    bodies: bool,
}

const WALK: Vec2 = Vec2::new(1.3, 0.0);

/// Clockwise.
fn kite(ahead: f32, aside: f32, back: f32) -> Vec<Vec2> {
    vec![Vec2::new(ahead, 0.0), Vec2::new(0.0, -aside), Vec2::new(-back, 0.0), Vec2::new(0.0, aside)]
}

impl Scene {
    fn new(positions_m: &[[f32; 2]]) -> Self {
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
    fn plan(&self, scratch: &mut Scratch) -> Plan {
        self.plan_by(Planner::Mcn, scratch)
    }

    fn plan_by(&self, planner: Planner, scratch: &mut Scratch) -> Plan {
        let count = self.positions_m.len();
        let radii_m = vec![0.25; count];
        let mut neighbours = Neighbours::default();
        neighbours.rebuild(&self.positions_m, &self.velocities_mps, &radii_m, ahead_s(planner, &self.params));
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
        let world = World {
            positions_m: &self.positions_m,
            velocities_mps: &self.velocities_mps,
            facings_rad: &self.facings_rad,
            radii_m: &radii_m,
            preferred_mps: &self.preferred_mps,
            stances: &self.stances,
            strafing_s: &vec![0.0; count],
            stepping_back_s: &vec![0.0; count],
            neighbours: &neighbours,
            obstacles: &self.obstacles,
            constraints: &MotionConstraints::new(&hull),
            dt_s: self.dt_s,
            bodies: self.bodies,
        };
        plan(planner, &world, 0, &self.params, scratch)
    }
}

#[test]
fn alone_it_keeps_walking_as_it_wants() {
    let plan = Scene::new(&[[0.0, 0.0]]).plan(&mut Scratch::default());
    assert_eq!((plan.velocity_mps, plan.facing_rad, plan.set), (WALK, 0.0, VelocitySet::Turning));
    assert_eq!(plan.time_to_collision_s, f32::INFINITY);
}

#[test]
fn a_disc_without_a_body_speeds_up_alike_in_steps_of_any_length() {
    for dt_s in [1.0 / 120.0, 1.0 / 30.0, 0.1] {
        let mut scene = Scene { dt_s, bodies: false, ..alone(WALK) };
        scene.velocities_mps[0] = Vec2::ZERO;
        scene.params.planner.acceleration_max_mps2 = 1.1;
        let gained_mps2 = scene.plan(&mut Scratch::default()).velocity_mps / dt_s;
        assert!(gained_mps2.distance(Vec2::new(1.1, 0.0)) < 1e-3, "dt {dt_s}: {gained_mps2}");
    }
}

#[test]
fn never_walks_faster_than_the_database_can() {
    let mut scene = Scene::new(&[[0.0, 0.0]]);
    scene.preferred_mps[0] = Vec2::new(4.0, 0.0);
    scene.velocities_mps[0] = Vec2::new(1.8, 0.0);
    assert!(scene.plan(&mut Scratch::default()).velocity_mps.distance(Vec2::new(1.8, 0.0)) < 1e-4);
}

#[test]
fn who_meets_a_wall_askew_and_turns_wide_side_steps_along_it() {
    let mut scene = Scene::new(&[[0.0, 0.0]]);
    scene.turning_mps = vec![Vec2::ZERO, Vec2::new(1.5, 0.4), Vec2::new(1.5, -0.4)];
    scene.obstacles = Obstacles::new(&[[(0.27, -3.0), (0.5, -3.0), (0.5, 3.0), (0.27, 3.0)].map(Vec2::from).to_vec()]);
    scene.velocities_mps[0] = Vec2::ZERO;
    scene.facings_rad[0] = std::f32::consts::FRAC_PI_4;
    scene.preferred_mps[0] = Vec2::from_angle(scene.facings_rad[0]);
    let plan = scene.plan(&mut Scratch::default());
    assert!(plan.velocity_mps.y > 0.15 && plan.velocity_mps.x.abs() < 0.02, "{}", plan.velocity_mps);
    assert_eq!((plan.set, plan.facing_rad), (VelocitySet::Holding, scene.facings_rad[0]));
}

#[test]
fn half_planes_stand_in_order_of_yielding() {
    let mut scene = Scene::new(&[[0.0, 0.0], [3.0, 0.1], [2.0, 1.5]]);
    scene.velocities_mps[1] = -WALK;
    scene.preferred_mps[0] = Vec2::new(-1.0, 0.5);
    scene.obstacles = Obstacles::new(&[vec![Vec2::new(-1.0, -1.0), Vec2::new(2.0, -1.0), Vec2::new(0.5, -0.5)]]);
    scene.stances[0].foot = Some(stance::tests::on_left_foot());
    let mut scratch = Scratch::default();
    scene.plan(&mut scratch);
    let mut kinds: Vec<Source> = scratch.half_planes().iter().map(|half_plane| half_plane.source).collect();
    kinds.retain(|source| !matches!(source, Source::Obstacle(_)));
    kinds.dedup();
    let expected = [Source::Stance, Source::SharpTurn, Source::TurningHull, Source::Agent(1), Source::Agent(2)];
    assert_eq!(kinds, expected);
    assert!(matches!(scratch.half_planes()[0].source, Source::Obstacle(_)));
}

#[test]
fn gives_way_to_who_comes_head_on_and_meets_nobody() {
    let mut scene = Scene::new(&[[0.0, 0.0], [4.0, 0.0]]);
    scene.velocities_mps[1] = -WALK;
    let plan = scene.plan(&mut Scratch::default());
    assert!(plan.velocity_mps.y < 0.0 && plan.velocity_mps.x > 0.5, "{plan:?}");
    assert!((plan.time_to_collision_s - 3.5 / 2.6).abs() < 1e-4);
}

#[test]
fn steps_aside_at_held_facing_when_pushed_gently() {
    let mut scene = Scene::new(&[[0.0, 0.0], [0.4, 1.0]]);
    scene.velocities_mps = vec![Vec2::new(0.2, 0.0), Vec2::new(0.0, -0.4)];
    scene.preferred_mps[0] = Vec2::new(0.3, 0.0);
    let plan = scene.plan(&mut Scratch::default());
    assert!(plan.velocity_mps.y < -0.1 && plan.strafing_s > 0.0, "{plan:?}");
    assert_eq!((plan.set, plan.facing_rad), (VelocitySet::Holding, 0.0), "{plan:?}");
}

#[test]
fn steps_back_from_who_comes_too_near_but_turns_away_by_the_papers_construction() {
    let mut scene = Scene::new(&[[0.0, 0.0], [0.55, 0.0]]);
    scene.velocities_mps = vec![Vec2::ZERO, Vec2::new(-0.6, 0.0)];
    scene.preferred_mps[0] = Vec2::new(0.3, 0.0);
    let plan = scene.plan(&mut Scratch::default());
    assert!(plan.velocity_mps.x < -0.1 && plan.stepping_back_s > 0.0, "{plan:?}");
    assert_eq!((plan.set, plan.facing_rad), (VelocitySet::Holding, 0.0), "{plan:?}");
    scene.construction = Construction::Paper;
    let plan = scene.plan(&mut Scratch::default());
    assert!(plan.set == VelocitySet::Turning && plan.facing_rad.abs() > 1.5, "{plan:?}");
}

/// What a switch turns off: a scene in which the part matters and one in which it does not, walked by the whole MCN and
/// without the part.
fn check_switch(matters: &Scene, does_not: &Scene, off: impl Fn(&mut Parts)) {
    let without = |scene: &Scene| {
        let mut params = scene.params.clone();
        off(&mut params.planner.parts);
        Scene { params, ..scene.clone() }.plan(&mut Scratch::default())
    };
    assert_ne!(without(matters), matters.plan(&mut Scratch::default()));
    assert_eq!(without(does_not), does_not.plan(&mut Scratch::default()));
}

/// Somebody comes, a little to the left.
fn met() -> Scene {
    let mut scene = Scene::new(&[[0.0, 0.0], [3.0, 0.2]]);
    scene.velocities_mps[1] = -WALK;
    scene
}

/// Eight walk close ahead, all the same way.
fn dense() -> Scene {
    let rank = |index: usize| [0.7 + 0.6 * (index / 2) as f32, 0.6 * (index % 2) as f32 - 0.3];
    Scene::new(&[[[0.0, 0.0]].as_slice(), &(0..8).map(rank).collect::<Vec<_>>()].concat())
}

/// Alone, wanting `preferred`.
fn alone(preferred_mps: Vec2) -> Scene {
    let mut scene = Scene::new(&[[0.0, 0.0]]);
    scene.preferred_mps[0] = preferred_mps;
    scene
}

#[test]
fn adaptation_and_keeping_right_may_be_left_out_where_somebody_is_met() {
    check_switch(&met(), &Scene::new(&[[0.0, 0.0], [0.0, 5.0]]), |parts| parts.adaptation = false);
    check_switch(&met(), &Scene::new(&[[0.0, 0.0]]), |parts| parts.keep_right = false);
}

#[test]
fn the_density_filter_may_be_left_out_in_a_crowd() {
    check_switch(&dense(), &met(), |parts| parts.density_filter = false);
}

#[test]
fn the_hull_may_be_left_out_where_a_velocity_leaves_it() {
    let mut aside = alone(Vec2::new(0.9, 0.9));
    aside.velocities_mps[0] = aside.preferred_mps[0];
    check_switch(&aside, &Scene::new(&[[0.0, 0.0]]), |parts| parts.hull = false);
}

#[test]
fn sharp_turns_may_be_left_out_where_v_pref_lies_behind() {
    let mut behind = alone(Vec2::new(-0.3, 0.4));
    behind.velocities_mps[0] = Vec2::new(0.0, 0.3);
    check_switch(&behind, &met(), |parts| parts.sharp_turns = false);
}

#[test]
fn the_stance_foot_may_be_left_out_or_stand_as_the_papers_wall() {
    let mut standing = alone(Vec2::new(0.0, 0.9));
    standing.velocities_mps[0] = standing.preferred_mps[0];
    let both_feet = standing.clone();
    standing.stances[0].foot = Some(stance::tests::on_left_foot());
    for form in [StanceForm::Off, StanceForm::Radial] {
        check_switch(&standing, &both_feet, |parts| parts.stance = form);
    }
}

/// Four close in on the first agent, one of them fast.
fn pressed() -> Scene {
    let mut scene = Scene::new(&[[0.0, 0.0], [0.52, 0.1], [-0.5, 0.2], [0.1, -0.55], [0.0, 1.2]]);
    let closing = [[0.0, 0.0], [-0.8, 0.0], [0.9, 0.0], [0.0, 0.8], [0.0, -1.3]];
    scene.velocities_mps = closing.map(Vec2::from).to_vec();
    scene
}

/// Seen in a mirror along the way.
fn mirrored(scene: &Scene) -> Scene {
    let flipped = |vectors: &[Vec2]| vectors.iter().map(|vector| *vector * Vec2::new(1.0, -1.0)).collect();
    Scene {
        positions_m: flipped(&scene.positions_m),
        velocities_mps: flipped(&scene.velocities_mps),
        preferred_mps: flipped(&scene.preferred_mps),
        ..scene.clone()
    }
}

// All else is blind to sides: keeping right turns v_pref and shares the avoiding out, and only so do those who are
// alike pass each other. (Discs on one spot with one velocity also part along +x; no walker begins so.)
#[test]
fn a_mirrored_scene_gives_the_mirrored_plan_but_for_keeping_right() {
    let off_mps = |scene: &Scene| {
        let [seen, in_mirror] = [scene, &mirrored(scene)].map(|scene| scene.plan(&mut Scratch::default()).velocity_mps);
        (seen * Vec2::new(1.0, -1.0)).distance(in_mirror)
    };
    for mut scene in [met(), dense(), pressed()] {
        scene.params.planner.parts.keep_right = false;
        assert!(off_mps(&scene) < 1e-4, "{}", off_mps(&scene));
    }
    assert!(off_mps(&met()) > 0.05);
}

#[test]
fn the_order_may_be_left_out_where_somebody_must_yield() {
    check_switch(&pressed(), &met(), |parts| parts.order = false);
}

#[test]
fn orientation_and_back_pedalling_may_be_left_out_where_the_facing_is_held() {
    let mut aside = Scene::new(&[[0.0, 0.0], [0.4, 1.0]]);
    aside.velocities_mps = vec![Vec2::new(0.2, 0.0), Vec2::new(0.0, -0.4)];
    aside.preferred_mps[0] = Vec2::new(0.3, 0.0);
    check_switch(&aside, &alone(WALK), |parts| parts.orientation = false);
    let mut back = Scene::new(&[[0.0, 0.0], [0.55, 0.0]]);
    back.velocities_mps = vec![Vec2::ZERO, Vec2::new(-0.6, 0.0)];
    back.preferred_mps[0] = Vec2::new(0.3, 0.0);
    check_switch(&back, &aside, |parts| parts.back_pedalling = false);
}

#[test]
fn without_any_part_it_is_plain_orca() {
    let parts = Parts {
        adaptation: false,
        density_filter: false,
        hull: false,
        sharp_turns: false,
        stance: StanceForm::Off,
        order: false,
        orientation: false,
        back_pedalling: false,
        keep_right: false,
    };
    for mut scene in [met(), dense(), pressed()] {
        scene.velocities_mps[1..].iter_mut().for_each(|velocity_mps| *velocity_mps *= 1.2);
        scene.params.planner.parts = parts.clone();
        scene.params.orca.time_horizon_s = scene.params.planner.time_horizon_s;
        scene.params.orca.speed_max_mps = 1.8;
        let [mcn, orca] =
            [Planner::Mcn, Planner::Orca].map(|planner| scene.plan_by(planner, &mut Scratch::default()).velocity_mps);
        assert!(mcn.distance(orca) < 1e-5, "{mcn} {orca}");
    }
}
