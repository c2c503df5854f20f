//! Plans in generated worlds and scenes, and solutions of generated linear programs, have no fault.

use fbcrowd_bench::soak::generated::world::GeneratedWorld;
use fbcrowd_bench::soak::generated::{linear_program, turned_scene};
use fbcrowd_sim::params::Params;

use super::clips::bundled;

#[test]
fn no_planner_fails_in_a_generated_world() {
    let (hull, params) = (bundled().velocity_hull, Params::default());
    for seed in 0..4000 {
        let fault = GeneratedWorld::new(seed, 0).fault(&hull, &params);
        assert!(fault.is_none(), "seed {seed}: {fault:?}");
    }
}

#[test]
fn plans_turn_and_move_with_the_scene() {
    let hull = bundled().velocity_hull;
    for seed in 0..10_000 {
        assert_eq!(turned_scene::fault(&hull, seed, 0), None, "seed {seed}");
    }
}

#[test]
fn no_grid_velocity_beats_the_solution() {
    for seed in 0..6000 {
        assert_eq!(linear_program::fault(seed, 0), None, "seed {seed}");
    }
}
