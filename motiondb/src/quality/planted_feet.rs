//! What the feet of a closed cycle do on the ground: their contacts, how far they slide, how the root must move for
//! them to stand.
//!
//! A foot is planted where its contact row is at least ½. Its contact point is the lowest of heel, ball and toe tip,
//! each over its own planted height; slide is that point's mean horizontal speed over the middle 80 % of each contact.
//! A point p of the root frame that stands in the world obeys, with root velocity v and turn rate ω,
//!
//! ```text
//! v + ω·perp(p) + dp/dt = 0,
//! ```
//!
//! two equations a row for three unknowns: the rows alone tell (v_f, ω_t, ω_s), by least squares. Root frame: x
//! forward, y left; metres, seconds.

use glam::{DMat3, DVec2, DVec3};

use crate::body::pose::Joints;
use crate::body::skeleton::{Side, Skeleton};
use crate::motion::motion_db::{MotionDb, PHASE_COUNT};
use crate::motion::parameters::Parameters;
use crate::motion::phase_map::PhaseMap;

/// A foot is planted from this contact on.
pub const PLANTED_CONTACT: f64 = 0.5;
/// Cut from each end of a contact, as a share of it: there the foot rolls on and off.
const TRIMMED_SHARE: f64 = 0.1;
/// A point's planted height is this percentile of its heights.
const PLANTED_PERCENTILE: f64 = 0.05;

/// The feet of one cycle at [`PHASE_COUNT`] uniform phases.
#[derive(Clone, Debug)]
pub struct CycleFeet {
    /// `[left, right]`, row by row: heel, ball and toe tip where slide is measured, root frame, metres.
    pub points_m: [Vec<[DVec3; 3]>; 2],
    /// `[left, right]`, row by row: contact, 0 to 1.
    pub contacts: [Vec<f64>; 2],
    /// Phase to time.
    pub phase_map: PhaseMap,
}

/// What the planted feet of a cycle do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootSlide {
    /// Mean speed of planted contact points, cm/s.
    pub slide_cm_s: f64,
    /// Share of the cycle that a foot is planted, mean of both.
    pub planted_share: f64,
}

/// The root's motion for which planted feet stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Implied {
    /// The parameters.
    pub parameters: Parameters,
    /// Root mean square speed of planted contact points that is left, m/s: what no root motion explains.
    pub rest_mps: f64,
}

/// A planted contact point: its neighbouring rows, and what lies between them.
#[derive(Clone, Copy, Debug)]
struct Planted {
    before_m: DVec2,
    at_m: DVec2,
    after_m: DVec2,
    /// Seconds from the row to its neighbours, negative to the one before.
    steps_s: [f64; 2],
}

impl CycleFeet {
    /// Of a cycle's posed rows and the contacts `[left, right]` in each.
    pub fn new(skeleton: &Skeleton, joints: &[Joints], contacts: &[[f32; 2]], phase_map: PhaseMap) -> Self {
        let points_m = [0, 1].map(|side| {
            let points_m = |joints: &Joints| joints.measured_points_m(skeleton, side).map(|point| point.as_dvec3());
            joints.iter().map(points_m).collect()
        });
        let contacts = [0, 1].map(|side| contacts.iter().map(|contact| f64::from(contact[side])).collect());
        Self { points_m, contacts, phase_map }
    }

    /// Of a stored example, `joints` being its posed rows.
    pub fn of(db: &MotionDb, example: usize, joints: &[Joints]) -> Self {
        let contacts = &db.rows.contacts[example * PHASE_COUNT..(example + 1) * PHASE_COUNT];
        Self::new(&db.skeleton, joints, contacts, db.examples[example].phase_map)
    }

    /// Both feet are planted in every row.
    pub fn always_planted(&self) -> bool {
        self.contacts.iter().flatten().all(|&contact| contact >= PLANTED_CONTACT)
    }

    /// First row and length of each contact of one foot; one that passes phase 0 counts once.
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

    /// [right toe-off, right heel strike, left toe-off, left heel strike], seconds from phase 0: where the contact that
    /// holds each foot's mid-stance ends and begins; none where one has no such contact.
    pub fn key_times_s(&self) -> Option<[f32; 4]> {
        let ([right_strike, right_off], [left_strike, left_off]) =
            (self.stance(Side::Right)?, self.stance(Side::Left)?);
        let within_period = |phase: f64| {
            let time_s = self.phase_map.time_s(phase.rem_euclid(1.0) as f32);
            if time_s < self.phase_map.period_s { time_s } else { 0.0 }
        };
        Some([right_off, right_strike, left_off, left_strike].map(within_period))
    }

    /// Phases at which the contact that holds a foot's mid-stance begins and ends, the first not after the landmark and
    /// the second not before it; none where the foot is not planted there, or always.
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

    /// Seconds from phase 0 at a row, which may lie in a neighbouring cycle.
    fn time_s(&self, row: isize) -> f64 {
        f64::from(self.phase_map.time_s(row as f32 / PHASE_COUNT as f32))
    }

    /// The contact points of the middle of every contact.
    fn planted(&self) -> Vec<Planted> {
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

    fn planted_at(&self, feet: &[[DVec3; 3]], point: usize, row: isize) -> Planted {
        let place_m = |row: isize| feet[wrap(row)][point].truncate();
        let time_s = |step: isize| self.time_s(row + step) - self.time_s(row);
        Planted {
            before_m: place_m(row - 1),
            at_m: place_m(row),
            after_m: place_m(row + 1),
            steps_s: [time_s(-1), time_s(1)],
        }
    }
}

/// Slide and planted share of both feet while the root moves by `velocity` (v_f, ω_t, ω_s) in m/s and rad/s.
pub fn foot_slide(feet: &CycleFeet, velocity: DVec3) -> FootSlide {
    let planted = feet.planted();
    let speeds: f64 = planted.iter().map(|point| point.speed_mps(velocity)).sum();
    let rows: usize = (0..2).flat_map(|side| feet.contacts(side)).map(|(_, length)| length).sum();
    FootSlide {
        slide_cm_s: if planted.is_empty() { 0.0 } else { 100.0 * speeds / planted.len() as f64 },
        planted_share: rows as f64 / (2 * PHASE_COUNT) as f64,
    }
}

/// The root motion that the planted feet tell; none where too little is planted to tell it.
pub fn implied(feet: &CycleFeet) -> Option<Implied> {
    let planted = feet.planted();
    let (mut normal, mut right) = (DMat3::ZERO, DVec3::ZERO);
    for (row, rate_mps) in planted.iter().flat_map(Planted::equations) {
        normal += DMat3::from_cols(row * row.x, row * row.y, row * row.z);
        right -= row * rate_mps;
    }
    let velocity = normal.inverse() * right;
    let implied =
        Implied { parameters: Parameters::from_vec3(velocity.as_vec3()), rest_mps: rms_speed_mps(&planted, velocity) };
    velocity.is_finite().then_some(implied)
}

impl Implied {
    /// How fast the feet that stand by the implied root motion move by another, root mean square, m/s. Squares of
    /// residuals add up about a least-squares solution.
    pub fn misfit_mps(&self, feet: &CycleFeet, velocity: DVec3) -> f64 {
        let all_mps = rms_speed_mps(&feet.planted(), velocity);
        libm::sqrt((all_mps * all_mps - self.rest_mps * self.rest_mps).max(0.0))
    }
}

/// Root mean square speed of planted contact points in the world.
fn rms_speed_mps(planted: &[Planted], velocity: DVec3) -> f64 {
    let speeds_mps = planted.iter().flat_map(Planted::equations).map(|(row, rate_mps)| row.dot(velocity) + rate_mps);
    libm::sqrt(speeds_mps.map(|speed_mps| speed_mps * speed_mps).sum::<f64>() / planted.len() as f64)
}

impl Planted {
    /// Horizontal speed in the world, by central differences along the root's arc.
    fn speed_mps(&self, velocity: DVec3) -> f64 {
        let [before_s, after_s] = self.steps_s;
        let moved_m = carried_m(self.after_m, velocity, after_s) - carried_m(self.before_m, velocity, before_s);
        moved_m.length() / (after_s - before_s)
    }

    /// Forward and left: coefficients of (v_f, ω_t, ω_s), and the point's own rate in the root frame.
    fn equations(&self) -> [(DVec3, f64); 2] {
        let [before_s, after_s] = self.steps_s;
        let rate_mps = (self.after_m - self.before_m) / (after_s - before_s);
        [(DVec3::new(1.0, -self.at_m.y, 0.0), rate_mps.x), (DVec3::new(0.0, self.at_m.x, 1.0), rate_mps.y)]
    }
}

/// Where the root's motion takes a point of its frame in a time, seen from where the root was.
fn carried_m(point_m: DVec2, velocity: DVec3, time_s: f64) -> DVec2 {
    let half_rad = 0.5 * velocity.y * time_s;
    let (sin, cos) = libm::sincos(half_rad);
    let half_turn = DVec2::new(cos, sin);
    let chord = if half_rad == 0.0 { 1.0 } else { sin / half_rad };
    half_turn.rotate(half_turn.rotate(point_m) + DVec2::new(velocity.x, velocity.z) * (time_s * chord))
}

/// Index of each row's point that is lowest over its planted height.
fn lowest_points(feet: &[[DVec3; 3]]) -> Vec<usize> {
    let planted_m = [0, 1, 2].map(|point: usize| {
        let mut heights_m: Vec<f64> = feet.iter().map(|foot| foot[point].z).collect();
        heights_m.sort_by(f64::total_cmp);
        heights_m[(PLANTED_PERCENTILE * heights_m.len() as f64) as usize]
    });
    let height_m = |foot: &[DVec3; 3], point: usize| foot[point].z - planted_m[point];
    let lowest = |foot: &[DVec3; 3]| (1..3).fold(0, |a, b| if height_m(foot, b) < height_m(foot, a) { b } else { a });
    feet.iter().map(lowest).collect()
}

/// Index of a row that may lie in a neighbouring cycle.
fn wrap(row: isize) -> usize {
    row.rem_euclid(PHASE_COUNT as isize) as usize
}
