//! What is seen of what a body plays: the pose eases into what the root does.
//!
//! Shares and parameters change at limited rates, which begin and end at once; joints that moved with them would do so
//! with a jerk. So the pose is that of a mix, and of an m_sp, that follow the root's with a short lag, over which
//! planted feet are held. The root knows nothing of it: nothing is tracked later for it.
//!
//! A body that goes back the way it came would step with the wrong foot: one that has just landed behind it, walking
//! backward, is about to leave the ground for who walks ahead. Gait the other way is nearly gait in reversed time
//! (Winter, Pluck, Yang 1989), and phases 0 and ½ are mid-stances: so its phase φ becomes 1 − φ, at which its feet are
//! where they were.

use glam::Vec2;
use motiondb::motion::{MotionDb, Parameters};

use crate::synthesis::blending::mix::Mix;
use crate::synthesis::hybrid::mode::Mode;
use crate::synthesis::semi_procedural::deformation::travel;
use crate::synthesis::time_step::TimeStep;

/// The lag, s: a fifth of the time in which the fastest change of speed takes place.
pub(crate) const EASE_TIME_S: f32 = 0.05;

/// Rate of the spring by which a gait turns about, 1/s: the legs swing the other way within a step.
pub(crate) const TURN_ABOUT_RATE_HZ: f32 = 10.0;

/// A mix of examples, and what m_sp is deformed to.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// While a body blends.
    pub mix: Mix,
    /// Otherwise.
    pub walking: Parameters,
    /// Direction of travel, to which m_sp is deformed. It lags behind one that turns about at rest.
    pub way: Vec2,
    /// A second.
    way_rate: Vec2,
}

impl Seen {
    /// A mix that stands.
    pub fn standing(mix: Mix) -> Self {
        Self { mix, walking: Parameters::default(), way: Vec2::X, way_rate: Vec2::ZERO }
    }

    /// Follows what the root does by a step: only what this synthesis shows. Returns whether it goes back the way it
    /// came.
    pub fn follow(&mut self, mode: Mode, mix: &Mix, walking: Parameters, db: &MotionDb, step: &TimeStep) -> bool {
        let fraction = 1.0 - step.seen;
        let going = match mode {
            Mode::Blending => {
                self.mix.ease(mix, fraction);
                self.mix.parameters(db)
            }
            Mode::SemiProcedural => {
                self.walking = part_way(self.walking, walking, fraction);
                self.walking
            }
        };
        // Who rests keeps its way.
        let way = travel(going, self.way);
        let (off, rate) = step.turn_about.pass(self.way - way, self.way_rate);
        (self.way, self.way_rate) = (way + off, rate);
        self.way.dot(way) < 0.0
    }

    /// The same legs go the other way.
    pub fn turn_back(&mut self) {
        (self.way, self.way_rate) = (-self.way, -self.way_rate);
    }

    /// What was seen a moment before the end of the step that began with `before`.
    pub fn lately(&self, before: &Self, step: &TimeStep) -> Self {
        let back = step.look_back_s / step.dt_s;
        let mut lately = *self;
        lately.mix.ease(&before.mix, back);
        lately.walking = part_way(self.walking, before.walking, back);
        lately.way -= step.look_back_s * self.way_rate;
        lately
    }
}

/// The given fraction of the way from one to another.
fn part_way(from: Parameters, to: Parameters, fraction: f32) -> Parameters {
    Parameters::from_vec3(from.to_vec3() + fraction * (to.to_vec3() - from.to_vec3()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_db::test_db;

    /// How often the gait of a body turns back whose velocity changes evenly, m/s ahead and to the left.
    fn turns_back(from_mps: Vec2, to_mps: Vec2) -> usize {
        let (db, step, mix) = (test_db(), TimeStep::new(1.0 / 60.0), Mix::new(&Default::default()));
        let mut seen = Seen::standing(mix);
        let mut turns_back = |share: f32| {
            let Vec2 { x: speed_mps, y: strafe_mps } = from_mps.lerp(to_mps, share.clamp(0.0, 1.0));
            let walking = Parameters { speed_mps, strafe_mps, ..Parameters::default() };
            let turns_back = seen.follow(Mode::SemiProcedural, &mix, walking, &db, &step);
            if turns_back {
                seen.turn_back();
            }
            turns_back
        };
        (-60..120).filter(|&index| turns_back(index as f32 / 40.0)).count()
    }

    #[test]
    fn the_gait_turns_back_once_with_the_body_and_not_where_it_turns_aside_or_stops() {
        let (ahead_mps, left_mps) = (Vec2::new(1.0, 0.0), Vec2::new(0.0, 0.5));
        assert_eq!(turns_back(ahead_mps, -0.5 * ahead_mps), 1);
        assert_eq!(turns_back(left_mps, -left_mps), 1);
        assert_eq!([left_mps, Vec2::ZERO, 0.5 * ahead_mps].map(|to_mps| turns_back(ahead_mps, to_mps)), [0; 3]);
    }
}
