//! Velocity sets: the velocities at which a body can move with the examples (`FbCrowd` §4.1, Eqs. 2–5).
//!
//! Enters: (v_f, ω_t, ω_s) of the examples. Leaves: two convex polygons and the sharp-turn edges (Fig. 3b), in the
//! agent's frame (x forward, y left), m/s.
//!
//! Read `velocity_hull`, then `convex_hull` and `wrapping_polygon`.
//!
//! Build the sets of four examples, and test a velocity against the half-planes of one:
//!
//! ```
//! use glam::Vec2;
//! use motiondb::velocity_sets::velocity_hull::{build, half_planes};
//! use motiondb::{Construction, Parameters};
//!
//! let example = |speed_mps, turn_rate_rad_s, strafe_mps| Parameters { speed_mps, turn_rate_rad_s, strafe_mps };
//! let walks = [example(1.4, 0.0, 0.0), example(1.0, 0.8, 0.0), example(1.0, -0.8, 0.0), example(0.0, 0.0, 0.6)];
//! let sets = build(&walks, Construction::TurningAndHolding);
//! assert_eq!(sets.turning_mps.len(), 4); // standing, the walk and both turns
//! assert_eq!(sets.holding_mps.len(), 3); // standing, the walk and the side-step
//!
//! // A velocity is permitted on the left of every half-plane (point, direction).
//! let permits = |velocity: Vec2| {
//!     half_planes(&sets.turning_mps).all(|(point, direction)| direction.perp_dot(velocity - point) >= 0.0)
//! };
//! assert!(permits(Vec2::new(1.0, 0.2)) && !permits(Vec2::new(0.2, 1.0)));
//! ```

pub(crate) mod convex_hull;
pub mod velocity_hull;
pub(crate) mod wrapping_polygon;
