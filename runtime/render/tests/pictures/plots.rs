//! Plots of any valid database can be drawn, and are the same in every run.

use fbcrowd_render::plots::database::{
    contact_sheet, coverage_slices, gait_events, parameter_space, pose_distances, transition_sheet, velocity_space,
    write_database_plots,
};
use glam::Vec2;
use motiondb::blend_space::BlendSpace;
use motiondb::body::{Root, Skeleton};
use motiondb::motion::{
    Action, ActionEnd, ActionFrame, ActionKind, Correspondence, ExtraMotion, MotionDb, MotionExample, PHASE_COUNT,
    Parameters, PhaseMap, Rows,
};
use motiondb::velocity_sets::velocity_hull::VelocityHull;
use tiny_skia::Pixmap;

use crate::support;

/// A database of hand-posed walks at the given speeds, m/s; the first one stands.
fn database(speeds_mps: &[f32]) -> MotionDb {
    let examples = speeds_mps.iter().enumerate().map(|(index, speed_mps)| MotionExample {
        name: format!("walk_{index}"),
        source: 0,
        window_s: [0.0, 1.0],
        mirrored: false,
        parameters: Parameters { speed_mps: *speed_mps, ..Parameters::default() },
        phase_map: PhaseMap { period_s: 1.1, left_share: 0.5 },
        key_times_s: (index > 0).then_some([0.3, 0.7, 0.85, 0.15]),
        planted_slide_cm_s: 0.0,
        planted_share: 0.6,
    });
    let header = support::golden_header();
    let mut rows = Rows::default();
    for row in 0..speeds_mps.len() * PHASE_COUNT {
        let pose = support::frame(&header, row as f32 / 60.0)[0].pose;
        rows.rotations.extend(pose.rotations);
        rows.pelvis_m.push(pose.pelvis_m);
        rows.contacts.push([1.0, (row % 2) as f32]);
    }
    let simplices: Vec<u32> = (1..speeds_mps.len() as u32).flat_map(|index| [index - 1, index]).collect();
    let dimension = u32::from(speeds_mps.len() > 1);
    let corners = speeds_mps.iter().map(|speed| Vec2::new(*speed, 0.0)).collect();
    MotionDb {
        extra: ExtraMotion::default(),
        style: String::new(),
        further_styles: Vec::new(),
        skeleton: header.skeleton().clone(),
        sources: Vec::new(),
        examples: examples.collect(),
        rows,
        velocity_hull: VelocityHull { turning_mps: corners, ..VelocityHull::default() },
        blend_space: BlendSpace { dimension, axis_ranges: [1.0, 0.0, 0.0], simplices, covered_share: 1.0 },
        correspondence: None,
        actions: Vec::new(),
    }
}

/// Share of the pixels that are not paper.
fn inked_share(pixmap: &Pixmap) -> f64 {
    let paper = pixmap.pixel(0, 0).unwrap();
    pixmap.pixels().iter().filter(|pixel| **pixel != paper).count() as f64 / pixmap.pixels().len() as f64
}

#[test]
fn giants_fit_on_the_contact_sheet() {
    let sheet_of_bodies = |times: f32| {
        let mut db = database(&[0.0, 1.0]);
        let Skeleton { offsets_m, segment_ends_m, feet, .. } = &mut db.skeleton;
        let feet = feet.iter_mut().flat_map(|foot| [&mut foot.heel_m, &mut foot.ball_m, &mut foot.toe_tip_m]);
        let lengths = offsets_m.iter_mut().chain(segment_ends_m).chain(feet).chain(&mut db.rows.pelvis_m);
        lengths.for_each(|length_m| *length_m *= times);
        contact_sheet(&db, 0..2)
    };
    let shares = [1.0, 2.0, 5.0].map(|times| inked_share(&sheet_of_bodies(times)));
    // All bodies have limbs of the same girth.
    assert!(shares.iter().all(|share| (0.6..1.1).contains(&(share / shares[0]))), "{shares:?}");
}

#[test]
fn databases_of_any_size_are_drawn() {
    for speeds_mps in [&[0.0][..], &[0.0, 1.0, 1.4]] {
        let db = database(speeds_mps);
        let bodies = |db: &MotionDb| contact_sheet(db, 0..db.examples.len());
        let gaits = |db: &MotionDb| gait_events(db, 0..db.examples.len());
        for plot in [velocity_space, parameter_space, coverage_slices, bodies, gaits] {
            let drawn = plot(&db);
            assert!((0.003..0.5).contains(&inked_share(&drawn)), "{}", inked_share(&drawn));
            assert!(drawn == plot(&db), "drawing again gives another picture");
        }
    }
}

#[test]
fn transitions_are_drawn_with_their_feet() {
    let mut db = database(&[0.0, 1.0]);
    let end = ActionEnd { example: 0, phase: 0.0 };
    let frame = |index: usize| ActionFrame {
        pose: db.rows.pose(0, index),
        contacts: [1.0, f32::from(u8::from(index < 20))],
        root: Root { position_m: Vec2::new(0.02 * index as f32, 0.0), facing_rad: 0.03 * index as f32 },
    };
    let turn = Action {
        name: "turn".into(),
        kind: ActionKind::Turn,
        source: 0,
        window_s: [0.0, 1.0],
        mirrored: false,
        entry: end,
        exit: end,
        frames: (0..60).map(frame).collect(),
    };
    let idle = Action { name: "idle".into(), kind: ActionKind::Idle, ..turn.clone() };
    let mirror = Action { name: "mirror".into(), mirrored: true, ..turn.clone() };
    db.actions = vec![idle, turn, mirror];
    let drawn = transition_sheet(&db, &[1]);
    assert!((0.02..0.5).contains(&inked_share(&drawn)), "{}", inked_share(&drawn));
    assert!(drawn == transition_sheet(&db, &[1]), "drawing again gives another picture");
    let folder = support::Scratch::new("transitions");
    let files = write_database_plots(&db, folder.path()).unwrap();
    assert!(files.iter().any(|file| file.ends_with("transitions.png")), "{files:?}");
    db.actions.clear();
    let files = write_database_plots(&db, folder.path()).unwrap();
    assert!(!files.iter().any(|file| file.ends_with("transitions.png")), "{files:?}");
}

#[test]
fn pose_distances_need_a_correspondence() {
    let mut db = database(&[0.0, 1.0, 1.4]);
    assert!(pose_distances(&db).is_none());
    db.correspondence = Some(Correspondence { semi_procedural: 1, blending: 2, pairs_s: vec![[0.275, 0.825]] });
    let drawn = pose_distances(&db).unwrap();
    // The panel's middle is coloured, and the pair at phases ¼ and ¾ is a disc of ink.
    let pixel = |x, y| drawn.pixel(x, y).unwrap();
    assert_ne!(pixel(690, 770), pixel(0, 0));
    let pair = pixel(410, 490);
    assert!(pair.red() < 60 && pair.green() < 60 && pair.blue() < 60, "{pair:?}");
    let folder = support::Scratch::new("pose_distances");
    assert_eq!(write_database_plots(&db, folder.path()).unwrap().len(), 6);
}

#[test]
fn many_examples_are_split_into_sheets() {
    let speeds_mps: Vec<f32> = (0..37).map(|n| 0.1 * n as f32).collect();
    let folder = support::Scratch::new("sheets");
    let files = write_database_plots(&database(&speeds_mps), folder.path()).unwrap();
    let sheets = |name: &str| files.iter().filter(|file| file.to_string_lossy().contains(name)).count();
    assert_eq!([sheets("contact_sheet"), sheets("gait_events")], [2, 2], "{files:?}");
}

#[test]
fn all_plots_are_written_or_the_fault_is_named() {
    let folder = support::Scratch::new("plots");
    let files = write_database_plots(&database(&[0.0, 1.2]), folder.path()).unwrap();
    assert_eq!(files.len(), 5);
    assert!(files.iter().all(|file| file.is_file()));
    let error = write_database_plots(&database(&[0.0]), &files[0]).unwrap_err();
    assert!(error.to_string().contains("velocity_space.png"), "{error}");
}
