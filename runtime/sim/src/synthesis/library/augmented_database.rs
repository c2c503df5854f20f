//! What bodies can do with a set of clips, in memory: all that the set shows, standing, and, where it cannot make way
//! in a crowd, its walk deformed.
//!
//! Many sets hold a few straight walks. Bodies that only blend them cannot turn, the planner is confined to a line of
//! velocities, and a crowd runs into each other or stands. What such a set lacks, semi-procedural locomotion can do
//! (`deformation`): cycles of m_sp deformed join the examples, and blend space and velocity sets are built
//! anew. They never come into a file.

use std::sync::Arc;

use glam::Vec3;
use motiondb::blend_space::triangulation;
use motiondb::motion::{Correspondence, MotionDb, MotionExample, Parameters};
use motiondb::quality::coverage::{GapKind, coverage};
use motiondb::quality::planted_feet::foot_slide;
use motiondb::validate::contradiction;
use motiondb::velocity_sets::velocity_hull;

use crate::synthesis::library::standing;
use crate::synthesis::semi_procedural::base_walk::SemiProcedural;
use crate::synthesis::semi_procedural::deformation::Deformation;

/// Without these no body makes way.
const MAKING_WAY: [GapKind; 4] = [GapKind::Walking, GapKind::WalkingTurns, GapKind::TurningInPlace, GapKind::SideSteps];

/// Ways of walking by what a set lacks, over the speed of m_sp: ahead, turning in rad/m, aside. Well within what m_sp
/// reaches (`fbcrowd bench reach`), and what people do without haste: bends of 1.4 and 0.5 m, on the spot 90 °/s for a
/// walk of 1.2 m/s.
const WAYS: [(GapKind, Vec3); 11] = [
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
    (GapKind::Backward, Vec3::new(-0.5, 0.0, 0.0)),
];

/// The database itself where bodies can stand and make way with it, or one in which they can.
pub fn complete(db: Arc<MotionDb>) -> Arc<MotionDb> {
    let lacks: Vec<GapKind> = coverage(&db).into_iter().map(|thin| thin.kind).collect();
    let standing = standing::provided(db);
    if !MAKING_WAY.iter().any(|lack| lacks.contains(lack)) {
        return standing;
    }
    with_deformed(&standing, &lacks).map_or(standing, Arc::new)
}

/// How many cycles of which example [`complete`] has deformed, if any.
pub fn deformed<'a>(db: &'a MotionDb, complete: &MotionDb) -> Option<(&'a str, usize)> {
    let steps = |db: &MotionDb| db.examples.iter().filter(|example| example.key_times_s.is_some()).count();
    let count = steps(complete) - steps(db);
    walk(db).filter(|_| count > 0).map(|walk| (db.examples[walk].name.as_str(), count))
}

/// m_sp, or the only example that walks.
fn walk(db: &MotionDb) -> Option<usize> {
    let found = db.correspondence.as_ref().map(|found| found.semi_procedural as usize);
    found.or_else(|| db.examples.iter().position(|example| example.key_times_s.is_some()))
}

/// None where there is no walk that could be deformed.
fn with_deformed(db: &MotionDb, lacks: &[GapKind]) -> Option<MotionDb> {
    let walk = walk(db)?;
    let m_sp = SemiProcedural::new(db, walk)?;
    let mut db = db.clone();
    for (_, way) in WAYS.iter().filter(|(lack, _)| lacks.contains(lack)) {
        push_deformed(&mut db, &m_sp, *way);
    }
    let parameters: Vec<Parameters> = db.examples.iter().map(|example| example.parameters).collect();
    db.blend_space = triangulation::build(&parameters);
    db.velocity_hull = velocity_hull::build(&parameters, db.velocity_hull.construction);
    db.correspondence = db.correspondence.take().or_else(|| Correspondence::of(&db, walk));
    Some(db)
}

/// Adds a cycle, if its feet land and stand as its parameters tell.
fn push_deformed(db: &mut MotionDb, m_sp: &SemiProcedural, way: Vec3) {
    let steps = &db.examples[m_sp.example];
    let parameters = m_sp.reachable(Parameters::from_vec3(steps.parameters.speed_mps * way));
    let deformation = Deformation::new(m_sp, parameters);
    let cycle = deformation.cycle(db);
    let (_, feet) = deformation.measurable(&db.skeleton, &cycle);
    let key_times_s = feet.key_times_s();
    if key_times_s.is_none() || contradiction(&feet, parameters).is_some() {
        return;
    }
    let slide = foot_slide(&feet, parameters.to_vec3().as_dvec3());
    let example = MotionExample {
        name: format!("{} for {}", steps.name, in_words(parameters)),
        parameters,
        phase_map: deformation.phase_map(),
        key_times_s,
        planted_slide_cm_s: slide.slide_cm_s as f32,
        planted_share: slide.planted_share as f32,
        ..steps.clone()
    };
    for (row, posture) in cycle.iter().enumerate() {
        db.rows.push_like((m_sp.example, row), &posture.pose, posture.contacts);
    }
    db.examples.push(example);
}

fn in_words(Parameters { speed_mps, turn_rate_rad_s, strafe_mps }: Parameters) -> String {
    format!("{speed_mps:.2} m/s, {:.0} °/s, {strafe_mps:.2} m/s aside", turn_rate_rad_s.to_degrees())
}
