//! The blend space of a database, ready for queries, with what standing still means in it.
//!
//! Parameters are (v_f, ω_t, ω_s), m/s and rad/s; an example without steps *stands*.

use glam::{Vec2, Vec3};
use motiondb::blend_space::Shares;
use motiondb::locator::Locator;
use motiondb::motion_db::MotionDb;
use motiondb::parameters::Parameters;

use super::blending::Mix;

/// The blend space of one database.
#[derive(Clone, Debug)]
pub struct Space {
    locator: Locator,
    points: Vec<Parameters>,
    stands: Vec<bool>,
    /// Greatest |ω_t| of the examples, rad/s.
    pub turn_rate_max_rad_s: f32,
    /// Greatest speed of the examples, m/s.
    pub speed_max_mps: f32,
    /// The balls of the feet of a standing body in the root frame, `[left, right]`, metres.
    pub standing_balls_m: [Vec3; 2],
}

/// What the database has nearest to a query.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The query itself, where it lies inside the hull.
    pub parameters: Parameters,
    /// Share of standing examples in it.
    pub idle_share: f32,
}

impl Space {
    /// Of one database.
    pub fn new(db: &MotionDb) -> Self {
        let points: Vec<Parameters> = db.examples.iter().map(|example| example.parameters).collect();
        let greatest = |of: fn(&Parameters) -> f32| points.iter().map(of).fold(0.0, f32::max);
        let locator = Locator::new(&db.blend_space, &points);
        let standing = Mix::new(&locator.locate(Parameters::default())).weights(db, 0.0).pose(db, 0.0);
        let joints = standing.forward_kinematics(&db.skeleton);
        Self {
            standing_balls_m: [0, 1].map(|side| joints.sole_points_m(&db.skeleton, side)[1]),
            stands: db.examples.iter().map(|example| example.key_times_s.is_none()).collect(),
            turn_rate_max_rad_s: greatest(|point| point.turn_rate_rad_s.abs()),
            speed_max_mps: greatest(|point| Vec2::new(point.speed_mps, point.strafe_mps).length()),
            locator,
            points,
        }
    }

    /// Shares at a point, or at the nearest one that the database has.
    pub fn locate(&self, parameters: Parameters) -> Shares {
        self.locator.locate(parameters)
    }

    /// Shares of standing still, or of whatever the database has that is slowest.
    pub fn standing(&self) -> Shares {
        self.locate(Parameters::default())
    }

    /// The nearest point that the database has.
    pub fn nearest(&self, parameters: Parameters) -> Nearest {
        let shares = self.locate(parameters);
        let (mut sum, mut idle_share) = (Vec3::ZERO, 0.0);
        for (example, share) in shares.examples.into_iter().zip(shares.shares) {
            sum += share * self.points[example as usize].to_vec3();
            idle_share += if self.stands[example as usize] { share } else { 0.0 };
        }
        Nearest { parameters: Parameters::from_vec3(sum), idle_share }
    }
}
