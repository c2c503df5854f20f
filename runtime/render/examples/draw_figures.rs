//! Sheets of 24 built-in figures, 50, 150 and 600 pixels high, from the front, the side and the back, through the renderer
//! of the camera view, a row a file. Every sixth is a child, and all walk.
//!
//!     cargo run -p fbcrowd-render --example draw_figures -- motion.fbdb figures

use std::error::Error;
use std::path::{Path, PathBuf};

use fbcrowd_render::camera::{CameraView, ColourBy, Quality, Shot};
use fbcrowd_render::png_frame;
use fbcrowd_render::visibility::{Lens, SamplePattern};
use fbcrowd_sim::Population;
use fbcrowd_sim::recording::{AgentFrame, ExtraFrame, Header};
use fbcrowd_sim::scenario::{AgentSpec, Scenario};
use glam::{Vec2, Vec3};
use motiondb::body::Root;
use motiondb::files::database_file;
use motiondb::motion::{MotionDb, PHASE_COUNT};
use tiny_skia::{Pixmap, PixmapPaint, Transform};

/// Number of figures.
const FIGURES: usize = 24;
/// Sizes of every sixth figure, relative to the body of the database.
const CHILDREN: [f32; 4] = [0.55, 0.64, 0.72, 0.8];
/// Distance of figures, and height and width of a row's picture, relative to the body.
const APART_M: f32 = 0.95;
const ROW_M: f32 = 2.25;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [database, folder] = &arguments[..] else { return Err("usage: draw_figures DATABASE.fbdb FOLDER".into()) };
    let (db, checksum) = database_file::load(database)?;
    std::fs::create_dir_all(folder)?;
    let header = Header::new(&db, checksum, Scenario::of(vec![AgentSpec::default(); FIGURES]));
    let mut population = Population::of(&header.scenario);
    for (life, stature) in population.agents.iter_mut().skip(5).step_by(6).zip(CHILDREN) {
        life.stature = stature;
    }
    let quality = Quality { samples: SamplePattern::Sixteen, ..Quality::default() };
    let view = CameraView::new(&header, &population, quality, ColourBy::Agent);
    for (height_px, columns, figures) in [(50, 24, 24), (150, 12, 24), (600, 2, 12)] {
        for (name, facing_rad) in [("front", -90.0_f32), ("side", 180.0), ("back", 90.0)] {
            for first in (0..figures).step_by(columns) {
                let ids = first..first + columns;
                let picture = sheet(&view, &db, ids, columns, height_px, facing_rad.to_radians())?;
                let path = Path::new(folder).join(format!("figures_{height_px}_{name}_{first:02}.png"));
                png_frame::write(&path, &picture)?;
            }
        }
    }
    Ok(())
}

/// Rows of figures that face a direction, `height_px` high.
fn sheet(
    view: &CameraView,
    db: &MotionDb,
    ids: std::ops::Range<usize>,
    columns: usize,
    height_px: u32,
    facing_rad: f32,
) -> Result<Pixmap, Box<dyn Error>> {
    let pixel_m = 1.775 / height_px as f32;
    let size_px = [columns as f32 * APART_M, ROW_M].map(|side_m| (side_m / pixel_m) as u32);
    let rows = ids.len() / columns;
    let mut sheet = Pixmap::new(size_px[0], size_px[1] * rows as u32).ok_or("the sheet is too large")?;
    for row in 0..rows {
        let agents: Vec<AgentFrame> =
            (0..columns).map(|column| figure(db, ids.start + row * columns + column, column, facing_rad)).collect();
        let middle_m = Vec3::new(0.5 * (columns as f32 - 1.0) * APART_M, 0.0, 0.92);
        let eye_m = middle_m + 40.0 * Vec3::new(0.0, -1.0, 0.06);
        let width = columns as f32 * APART_M / eye_m.distance(middle_m);
        let lens = Lens::perspective(size_px, eye_m, middle_m, width);
        let shot = Shot { lens, time_s: 0.0, eyes_of: None, fog_m: None };
        let picture = view.draw(&shot, &agents, &ExtraFrame::default()).to_display();
        let top = (row as u32 * size_px[1]) as i32;
        sheet.draw_pixmap(0, top, picture.as_ref(), &PixmapPaint::default(), Transform::identity(), None);
    }
    Ok(sheet)
}

/// A figure in a column that walks, each in another phase of its stride.
fn figure(db: &MotionDb, id: usize, column: usize, facing_rad: f32) -> AgentFrame {
    let walk = db.correspondence.as_ref().map_or(0, |between| between.semi_procedural as usize);
    let position_m = Vec2::new(column as f32 * APART_M, 0.0);
    AgentFrame {
        id: id.into(),
        root: Root { position_m, facing_rad },
        pose: db.rows.pose(walk, id * 11 % PHASE_COUNT),
        ..AgentFrame::default()
    }
}
