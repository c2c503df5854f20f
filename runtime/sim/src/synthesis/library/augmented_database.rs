//! The augmented database: a database in memory with all that bodies of a crowd need.
//!
//! Many sets of clips hold a few straight walks. With them bodies cannot turn, the planner has a line of velocities,
//! and a crowd collides or stands. Semi-procedural locomotion supplies what is missing: deformed cycles of m_sp join
//! the examples, and blend space and velocity sets are built again. They are never written to a file.

use std::sync::Arc;

use glam::Vec3;
use motiondb::blend_space::triangulation;
use motiondb::motion::{Correspondence, MotionDb, MotionExample, PHASE_COUNT, Parameters};
use motiondb::quality::coverage::{GapKind, coverage};
use motiondb::quality::planted_feet::foot_slide;
use motiondb::validate::contradiction;
use motiondb::velocity_sets::velocity_hull;

use crate::synthesis::library::standing;
use crate::synthesis::semi_procedural::{BaseWalk, Deformation};

/// Coverage gaps with which bodies of a crowd make no progress, or turn to and fro in a queue: an agent that may not
/// step back at held facing turns to where it is pushed (docs/tuning.md).
const NEEDED: [GapKind; 5] =
    [GapKind::Walking, GapKind::WalkingTurns, GapKind::TurningInPlace, GapKind::SideSteps, GapKind::Backward];

/// Parameters of the cycles that fill each coverage gap, divided by the speed of m_sp: speed, turn rate in rad/m, side
/// speed. Unhurried: bends of 1.4 and 0.5 m radius, turns on the spot by 90 °/s; but side-steps also as quick as the walk,
/// since an agent that is pushed aside more quickly than it side-steps turns (docs/tuning.md). `fbcrowd bench reach` finds
/// all in reach.
const FILLING: [(GapKind, Vec3); 13] = [
    (GapKind::Walking, Vec3::new(1.0, 0.0, 0.0)),
    (GapKind::Walking, Vec3::new(0.5, 0.0, 0.0)),
    (GapKind::WalkingTurns, Vec3::new(1.0, 0.72, 0.0)),
    (GapKind::WalkingTurns, Vec3::new(1.0, -0.72, 0.0)),
    (GapKind::WalkingTurns, Vec3::new(0.6, 1.2, 0.0)),
    (GapKind::WalkingTurns, Vec3::new(0.6, -1.2, 0.0)),
    (GapKind::TurningInPlace, Vec3::new(0.0, 1.3, 0.0)),
    (GapKind::TurningInPlace, Vec3::new(0.0, -1.3, 0.0)),
    (GapKind::SideSteps, Vec3::new(0.0, 0.0, 0.4)),
    (GapKind::SideSteps, Vec3::new(0.0, 0.0, -0.4)),
    (GapKind::SideSteps, Vec3::new(0.0, 0.0, 1.0)),
    (GapKind::SideSteps, Vec3::new(0.0, 0.0, -1.0)),
    (GapKind::Backward, Vec3::new(-0.5, 0.0, 0.0)),
];

/// The database itself where it has all that bodies of a crowd need; otherwise an augmented one.
pub fn augmented(db: Arc<MotionDb>) -> Arc<MotionDb> {
    let gaps: Vec<GapKind> = coverage(&db).into_iter().map(|gap| gap.kind).collect();
    let standing = standing::with_standing(db);
    if !NEEDED.iter().any(|gap| gaps.contains(gap)) {
        return standing;
    }
    with_gaps_filled(&standing, &gaps).map_or(standing, Arc::new)
}

/// Name of the walk that [`augmented`] has deformed, and number of deformed cycles; `None` if there are none.
pub fn deformed_walk<'a>(db: &'a MotionDb, augmented: &MotionDb) -> Option<(&'a str, usize)> {
    let steps = |db: &MotionDb| db.examples.iter().filter(|example| example.key_times_s.is_some()).count();
    let count = steps(augmented) - steps(db);
    walk(db).filter(|_| count > 0).map(|walk| (db.examples[walk].name.as_str(), count))
}

/// Index of m_sp, or of the only example with steps.
pub(crate) fn walk(db: &MotionDb) -> Option<usize> {
    let m_sp = db.correspondence.as_ref().map(|found| found.semi_procedural as usize);
    m_sp.or_else(|| db.examples.iter().position(|example| example.key_times_s.is_some()))
}

/// `None` without a walk that can be deformed.
fn with_gaps_filled(db: &MotionDb, gaps: &[GapKind]) -> Option<MotionDb> {
    let walk = walk(db)?;
    let base_walk = BaseWalk::new(db, walk)?;
    let mut db = db.clone();
    for (_, ratios) in FILLING.iter().filter(|(gap, _)| gaps.contains(gap)) {
        push_deformed(&mut db, &base_walk, *ratios);
    }
    let parameters: Vec<Parameters> = db.examples.iter().map(|example| example.parameters).collect();
    db.blend_space = triangulation::build(&parameters);
    db.velocity_hull = velocity_hull::build(&parameters, db.velocity_hull.construction);
    db.correspondence = db.correspondence.take().or_else(|| Correspondence::of(&db, walk));
    Some(db)
}

/// Adds a deformed cycle if its feet land, and move as its parameters require.
fn push_deformed(db: &mut MotionDb, base_walk: &BaseWalk, ratios: Vec3) {
    let m_sp = &db.examples[base_walk.example];
    let parameters = base_walk.reachable(Parameters::from_vec3(m_sp.parameters.speed_mps * ratios));
    let deformation = Deformation::new(base_walk, parameters);
    let cycle = deformation.cycle(db);
    let (_, feet) = deformation.measurable(&db.skeleton, &cycle);
    let key_times_s = feet.key_times_s();
    if key_times_s.is_none() || contradiction(&feet, parameters).is_some() {
        return;
    }
    let slide = foot_slide(&feet, parameters.to_vec3().as_dvec3());
    let example = MotionExample {
        name: format!("{} for {}", m_sp.name, in_words(parameters)),
        parameters,
        phase_map: deformation.phase_map(),
        key_times_s,
        planted_slide_cm_s: slide.slide_cm_s as f32,
        planted_share: slide.planted_share as f32,
        ..m_sp.clone()
    };
    let mut rotations = Vec::new();
    for (row, posture) in cycle.iter().enumerate() {
        db.rows.push_like((base_walk.example, row), &posture.pose, posture.contacts);
        let phase = row as f32 / PHASE_COUNT as f32;
        db.extra.blend(deformation.extra_rows(db, phase), &mut rotations);
        db.extra.rotations.append(&mut rotations);
    }
    db.examples.push(example);
}

fn in_words(Parameters { speed_mps, turn_rate_rad_s, strafe_mps }: Parameters) -> String {
    format!("{speed_mps:.2} m/s, {:.0} °/s, {strafe_mps:.2} m/s aside", turn_rate_rad_s.to_degrees())
}
