//! How alike the poses of m_sp and m_mb are, at every phase of one against every phase of the other, and the
//! correspondence times T chosen there (`FbCrowd` §5, Eq. 10).
//!
//! The distance is the compiler's: joint places and weighted velocities in the root frame, here as a root mean square
//! over the joints, cm. It is measured on the rows that the database stores.

use glam::{Vec2, Vec3};
use motiondb::correspondence::{Correspondence, VELOCITY_WEIGHT_S};
use motiondb::motion_db::{MotionDb, PHASE_COUNT};
use motiondb::pose::Pose;
use motiondb::skeleton::JOINT_COUNT;
use tiny_skia::Pixmap;

use crate::axis::{Axis, number};
use crate::ground::fill_rect;
use crate::mark::Mark;
use crate::palette::{INK, heat};
use crate::plot::{Figure, Panel};

/// Sides of the sheet, pixels.
const SHEET_PX: [u32; 2] = [1400, 1440];
/// Left, top, width, height of the axes on it, pixels.
const PANEL_PX: [f32; 4] = [130.0, 210.0, 1120.0, 1120.0];
/// Left baseline of the legend, pixels.
const LEGEND_PX: Vec2 = Vec2::new(140.0, 134.0);

/// The plot; none of a database without correspondences.
pub fn pose_distances(db: &MotionDb) -> Option<Pixmap> {
    let found = db.correspondence.as_ref()?;
    let distances_m = matrix_m(&features_m(db, found.semi_procedural), &features_m(db, found.blending));
    let greatest_m = distances_m.iter().flatten().copied().fold(f32::MIN_POSITIVE, f32::max);
    let least_m = distances_m.iter().flatten().copied().fold(greatest_m, f32::min);
    let mut figure = Figure::new(SHEET_PX[0], SHEET_PX[1]);
    figure.title("Where m_sp and m_mb are alike: distance of poses, and correspondences", Vec2::new(PANEL_PX[0], 80.0));
    let [least, middle, greatest] =
        [least_m, 0.5 * (least_m + greatest_m), greatest_m].map(|metres| format!("{} cm", number(100.0 * metres, 1)));
    let legend = [
        (Mark::Diamond, heat(0.0), least.as_str()),
        (Mark::Diamond, heat(0.5), middle.as_str()),
        (Mark::Diamond, heat(1.0), greatest.as_str()),
        (Mark::Disc, INK, "chosen pairs"),
    ];
    figure.legend(LEGEND_PX, &legend);
    let axis = |role: &str, example: u32| {
        let label = format!("phase of {role} {}", db.examples[example as usize].name);
        Axis { label, low: 0.0, high: 1.0 }
    };
    let panel = figure.panel(PANEL_PX, [axis("m_sp", found.semi_procedural), axis("m_mb", found.blending)]);
    let share = |metres: f32| (metres - least_m) / (greatest_m - least_m).max(f32::MIN_POSITIVE);
    draw_cells(&mut figure, &panel, |sp, mb| share(distances_m[sp][mb]));
    draw_pairs(&mut figure, &panel, db, found);
    Some(figure.pixmap)
}

/// Joint places and weighted velocities at each stored phase, metres.
fn features_m(db: &MotionDb, example: u32) -> Vec<Vec<Vec3>> {
    let index = example as usize;
    let places = |row: usize| {
        let pelvis_m = db.rows.pelvis_m[index * PHASE_COUNT + row];
        Pose { pelvis_m, rotations: *db.rows.rotations(index, row) }.forward_kinematics(&db.skeleton).positions_m
    };
    let places_m: Vec<_> = (0..PHASE_COUNT).map(places).collect();
    let row = |row: usize| {
        let neighbours = [&places_m[(row + PHASE_COUNT - 1) % PHASE_COUNT], &places_m[(row + 1) % PHASE_COUNT]];
        let rate_hz = db.examples[index].phase_map.rate_hz(row as f32 / PHASE_COUNT as f32);
        let weight = VELOCITY_WEIGHT_S as f32 * rate_hz * PHASE_COUNT as f32 / 2.0;
        let velocities = neighbours[1].iter().zip(neighbours[0]).map(|(after, before)| (*after - *before) * weight);
        places_m[row].iter().copied().chain(velocities).collect()
    };
    (0..PHASE_COUNT).map(row).collect()
}

/// Distances of all pairs of rows, m_sp's first, metres.
fn matrix_m(sp: &[Vec<Vec3>], mb: &[Vec<Vec3>]) -> Vec<Vec<f32>> {
    let distance_m = |a: &[Vec3], b: &[Vec3]| {
        let squared: f32 = a.iter().zip(b).map(|(a, b)| a.distance_squared(*b)).sum();
        (squared / JOINT_COUNT as f32).sqrt()
    };
    sp.iter().map(|sp| mb.iter().map(|mb| distance_m(sp, mb)).collect()).collect()
}

/// A square about each pair of stored phases; the first row's are drawn again where the cycle closes.
fn draw_cells(figure: &mut Figure, panel: &Panel, share: impl Fn(usize, usize) -> f32) {
    let edge = |row: usize, off: f32| ((row as f32 + off) / PHASE_COUNT as f32).clamp(0.0, 1.0);
    for (sp, mb) in (0..=PHASE_COUNT).flat_map(|sp| (0..=PHASE_COUNT).map(move |mb| (sp, mb))) {
        let low = panel.to_px(Vec2::new(edge(sp, -0.5), edge(mb, 0.5))).round();
        let high = panel.to_px(Vec2::new(edge(sp, 0.5), edge(mb, -0.5))).round();
        let colour = heat(share(sp % PHASE_COUNT, mb % PHASE_COUNT));
        fill_rect(&mut figure.pixmap, [low.x, low.y, high.x - low.x, high.y - low.y], colour, 1.0);
    }
}

fn draw_pairs(figure: &mut Figure, panel: &Panel, db: &MotionDb, found: &Correspondence) {
    let phase = |example: u32, time_s: f32| db.examples[example as usize].phase_map.phase(time_s);
    for [sp_s, mb_s] in &found.pairs_s {
        let at = Vec2::new(phase(found.semi_procedural, *sp_s), phase(found.blending, *mb_s));
        figure.mark(panel, at, Mark::Disc, 8.0, INK);
    }
}
