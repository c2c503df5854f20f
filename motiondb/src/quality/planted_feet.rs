//! Feet of a closed cycle on the ground: their contacts, their slide, and the root motion that they imply.
//!
//! Enters: posed rows and contacts of a cycle, root frame (x forward, y left), metres and seconds. A foot is planted in
//! the rows whose contact is at least ½. Its contact point is the lowest of heel, ball and toe tip, each above its own
//! planted height. Slide is the mean horizontal speed of that point in the world, over the middle 80 % of each contact.
//!
//! A point p of the root frame that is at rest in the world obeys, with root velocity v and turn rate ω,
//!
//! ```text
//! v + ω·perp(p) + dp/dt = 0                                                    (1)
//! ```
//!
//! These are two equations per row for three unknowns: the rows alone determine (v_f, ω_t, ω_s) by least squares.

use glam::{DMat3, DVec2, DVec3};

use crate::body::pose::Joints;
use crate::body::skeleton::{Side, Skeleton};
use crate::motion::motion_db::{MotionDb, PHASE_COUNT};
use crate::motion::parameters::Parameters;
use crate::motion::phase_map::PhaseMap;
use crate::statistics::{mean, percentile};

/// Least contact of a planted foot.
pub const PLANTED_CONTACT: f64 = 0.5;
/// Share of a contact that is cut from each of its ends: there the foot rolls on and off.
pub(crate) const TRIMMED_SHARE: f64 = 0.1;
/// Percentile of a point's heights over a cycle that is its planted height.
const PLANTED_PERCENTILE: f64 = 0.05;
/// Difference of two heights that counts as none, m: some rounding errors of a posed point. Two points are level in the
/// row that gives both their planted heights; rounding must not choose between them.
const SAME_HEIGHT_M: f64 = 1e-6;

/// The feet of one cycle at [`PHASE_COUNT`] uniform phases.
#[derive(Clone, Debug)]
pub struct CycleFeet {
    /// Heel, ball and toe tip where slide is measured, `[left, right]`, row by row, root frame, metres.
    pub points_m: [Vec<[DVec3; 3]>; 2],
    /// Contact with the ground, `[left, right]`, row by row, 0 to 1.
    pub contacts: [Vec<f64>; 2],
    /// Map from phase to time.
    pub phase_map: PhaseMap,
}

/// Slide of the planted feet of a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootSlide {
    /// Mean speed of planted contact points, cm/s.
    pub slide_cm_s: f64,
    /// Share of the cycle in which a foot is planted, mean of both feet.
    pub planted_share: f64,
}

/// The root motion for which planted feet are at rest, as far as possible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpliedRootMotion {
    /// Parameters of the root motion.
    pub parameters: Parameters,
    /// Remaining speed of the planted contact points (root mean square), which no root motion explains, m/s.
    pub rest_mps: f64,
}

/// A planted contact point in one row, with its position in the neighbouring rows, root frame.
#[derive(Clone, Copy, Debug)]
struct PlantedPoint {
    before_m: DVec2,
    at_m: DVec2,
    after_m: DVec2,
    /// Times of the neighbouring rows relative to the row, seconds: the first is negative.
    steps_s: [f64; 2],
}

impl CycleFeet {
    /// The feet of a cycle's posed rows, with the contacts `[left, right]` in each.
    pub fn new(skeleton: &Skeleton, joints: &[Joints], contacts: &[[f32; 2]], phase_map: PhaseMap) -> Self {
        let points_m = [0, 1].map(|side| {
            let points_m = |joints: &Joints| joints.measured_points_m(skeleton, side).map(|point| point.as_dvec3());
            joints.iter().map(points_m).collect()
        });
        let contacts = [0, 1].map(|side| contacts.iter().map(|contact| f64::from(contact[side])).collect());
        Self { points_m, contacts, phase_map }
    }

    /// The feet of a stored example; `joints` are its posed rows.
    pub fn of(db: &MotionDb, example: usize, joints: &[Joints]) -> Self {
        let contacts = &db.rows.contacts[example * PHASE_COUNT..(example + 1) * PHASE_COUNT];
        Self::new(&db.skeleton, joints, contacts, db.examples[example].phase_map)
    }

    /// Whether both feet are planted in every row.
    pub(crate) fn is_always_planted(&self) -> bool {
        self.contacts.iter().flatten().all(|&contact| contact >= PLANTED_CONTACT)
    }

    /// First row and number of rows of each contact of one foot. A contact that includes phase 0 counts once.
    pub fn contacts(&self, side: usize) -> Vec<(usize, usize)> {
        let planted = |row: usize| self.contacts[side][row % PHASE_COUNT] >= PLANTED_CONTACT;
        if (0..PHASE_COUNT).all(planted) {
            return vec![(0, PHASE_COUNT)];
        }
        (0..PHASE_COUNT)
            .filter(|&row| planted(row) && !planted(row + PHASE_COUNT - 1))
            .map(|row| (row, (row..).take_while(|&row| planted(row)).count()))
            .collect()
    }

    /// [right toe-off, right heel strike, left toe-off, left heel strike], seconds from phase 0: end and start of the
    /// contact at each foot's mid-stance. `None` if a foot has no such contact.
    pub fn key_times_s(&self) -> Option<[f32; 4]> {
        let ([right_strike, right_off], [left_strike, left_off]) =
            (self.stance(Side::Right)?, self.stance(Side::Left)?);
        let within_period = |phase: f64| {
            let time_s = self.phase_map.time_s(phase.rem_euclid(1.0) as f32);
            if time_s < self.phase_map.period_s { time_s } else { 0.0 }
        };
        Some([right_off, right_strike, left_off, left_strike].map(within_period))
    }

    /// Phases at which the contact at a foot's mid-stance begins and ends: the first at or before the landmark, the
    /// second at or after it. `None` if the foot is not planted there, or in every row.
    pub fn stance(&self, side: Side) -> Option<[f64; 2]> {
        let landmark = if side == Side::Left { PHASE_COUNT as isize / 2 } else { 0 };
        let contact = |row: isize| self.contacts[side.index()][wrap(row)];
        let end = |step: isize| {
            let rows = (0..PHASE_COUNT as isize).map(|rows| landmark + rows * step);
            let last = rows.take_while(|&row| contact(row) >= PLANTED_CONTACT).last()?;
            let (inside, outside) = (contact(last), contact(last + step));
            let share = (inside - PLANTED_CONTACT) / (inside - outside);
            (outside < PLANTED_CONTACT).then(|| (last as f64 + step as f64 * share) / PHASE_COUNT as f64)
        };
        Some([end(-1)?, end(1)?])
    }

    /// Time of a row, seconds from phase 0; the row may lie in a neighbouring cycle.
    fn time_s(&self, row: isize) -> f64 {
        f64::from(self.phase_map.time_s(row as f32 / PHASE_COUNT as f32))
    }

    /// Contact points in the middle part of every contact.
    fn planted(&self) -> Vec<PlantedPoint> {
        let mut found = Vec::new();
        for side in 0..2 {
            let feet = &self.points_m[side];
            let lowest = lowest_points(feet);
            for (start, length) in self.contacts(side) {
                let trim = (TRIMMED_SHARE * length as f64 + 0.5) as usize;
                let rows = start + trim..start + length - trim;
                found.extend(rows.map(|row| self.planted_at(feet, lowest[row % PHASE_COUNT], row as isize)));
            }
        }
        found
    }

    fn planted_at(&self, feet: &[[DVec3; 3]], point: usize, row: isize) -> PlantedPoint {
        let position_m = |row: isize| feet[wrap(row)][point].truncate();
        let time_s = |step: isize| self.time_s(row + step) - self.time_s(row);
        PlantedPoint {
            before_m: position_m(row - 1),
            at_m: position_m(row),
            after_m: position_m(row + 1),
            steps_s: [time_s(-1), time_s(1)],
        }
    }
}

/// Slide and planted share of both feet for a root `velocity` (v_f, ω_t, ω_s), m/s and rad/s.
pub fn foot_slide(feet: &CycleFeet, velocity: DVec3) -> FootSlide {
    let planted = feet.planted();
    let speeds: f64 = planted.iter().map(|point| point.speed_mps(velocity)).sum();
    let rows: usize = (0..2).flat_map(|side| feet.contacts(side)).map(|(_, length)| length).sum();
    FootSlide {
        slide_cm_s: if planted.is_empty() { 0.0 } else { 100.0 * speeds / planted.len() as f64 },
        planted_share: rows as f64 / (2 * PHASE_COUNT) as f64,
    }
}

/// Root motion that the planted feet imply: the least-squares solution of Eq. 1. `None` if too little is planted.
pub fn implied_root_motion(feet: &CycleFeet) -> Option<ImpliedRootMotion> {
    let planted = feet.planted();
    let (mut normal, mut right) = (DMat3::ZERO, DVec3::ZERO);
    for (row, rate_mps) in planted.iter().flat_map(PlantedPoint::equations) {
        normal += DMat3::from_cols(row * row.x, row * row.y, row * row.z);
        right -= row * rate_mps;
    }
    let velocity = normal.inverse() * right;
    velocity.is_finite().then(|| ImpliedRootMotion {
        parameters: Parameters::from_vec3(velocity.as_vec3()),
        rest_mps: rms_speed_mps(&planted, velocity),
    })
}

/// Velocity (v_f, ω_s) of the root, m/s, for which planted feet are at rest as far as possible while the root turns at a
/// rate (rad/s): the least-squares solution of Eq. 1 for it. `None` if nothing is planted.
pub fn implied_velocity_mps(feet: &CycleFeet, turn_rate_rad_s: f64) -> Option<DVec2> {
    let turn = DVec3::new(0.0, turn_rate_rad_s, 0.0);
    let planted = feet.planted();
    let slides_mps = planted.iter().map(|point| DVec2::from(point.equations().map(|(row, rate)| row.dot(turn) + rate)));
    mean(slides_mps).map(|slide_mps| -slide_mps)
}

impl ImpliedRootMotion {
    /// Speed of the planted feet for another root `velocity` in excess of the remaining speed (root mean square), m/s:
    /// around a least-squares solution, squares of residuals add.
    pub fn misfit_mps(&self, feet: &CycleFeet, velocity: DVec3) -> f64 {
        let all_mps = rms_speed_mps(&feet.planted(), velocity);
        libm::sqrt((all_mps * all_mps - self.rest_mps * self.rest_mps).max(0.0))
    }
}

/// Speed of planted contact points in the world (root mean square), m/s.
fn rms_speed_mps(planted: &[PlantedPoint], velocity: DVec3) -> f64 {
    let equations = planted.iter().flat_map(PlantedPoint::equations);
    let speeds_mps = equations.map(|(row, rate_mps)| row.dot(velocity) + rate_mps);
    libm::sqrt(speeds_mps.map(|speed_mps| speed_mps * speed_mps).sum::<f64>() / planted.len() as f64)
}

impl PlantedPoint {
    /// Horizontal speed in the world, m/s, by central differences along the root's arc.
    fn speed_mps(&self, velocity: DVec3) -> f64 {
        let [before_s, after_s] = self.steps_s;
        let moved_m =
            moved_with_root_m(self.after_m, velocity, after_s) - moved_with_root_m(self.before_m, velocity, before_s);
        moved_m.length() / (after_s - before_s)
    }

    /// Eq. 1, forward and left: coefficients of (v_f, ω_t, ω_s), and dp/dt, m/s.
    fn equations(&self) -> [(DVec3, f64); 2] {
        let [before_s, after_s] = self.steps_s;
        let rate_mps = (self.after_m - self.before_m) / (after_s - before_s);
        [(DVec3::new(1.0, -self.at_m.y, 0.0), rate_mps.x), (DVec3::new(0.0, self.at_m.x, 1.0), rate_mps.y)]
    }
}

/// Position of a point of the root frame after the root has moved for a time, in the root frame at the start, metres.
fn moved_with_root_m(point_m: DVec2, velocity: DVec3, time_s: f64) -> DVec2 {
    let half_rad = 0.5 * velocity.y * time_s;
    let (sin, cos) = libm::sincos(half_rad);
    let half_turn = DVec2::new(cos, sin);
    let chord = if half_rad == 0.0 { 1.0 } else { sin / half_rad };
    half_turn.rotate(half_turn.rotate(point_m) + DVec2::new(velocity.x, velocity.z) * (time_s * chord))
}

/// Index of the point of a foot that is lowest above its planted height, in each row.
pub(crate) fn lowest_points(feet: &[[DVec3; 3]]) -> Vec<usize> {
    let planted_m = [0, 1, 2]
        .map(|point: usize| percentile(feet.iter().map(|foot| foot[point].z), PLANTED_PERCENTILE).unwrap_or_default());
    let height_m = |foot: &[DVec3; 3], point: usize| foot[point].z - planted_m[point];
    let is_lower = |foot: &[DVec3; 3], b: usize, a: usize| height_m(foot, b) < height_m(foot, a) - SAME_HEIGHT_M;
    let lowest = |foot: &[DVec3; 3]| (1..3).fold(0, |a, b| if is_lower(foot, b, a) { b } else { a });
    feet.iter().map(lowest).collect()
}

/// Index in [0, `PHASE_COUNT`) of a row that may lie in a neighbouring cycle.
fn wrap(row: isize) -> usize {
    row.rem_euclid(PHASE_COUNT as isize) as usize
}
