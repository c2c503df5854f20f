//! The sheet of a character: four of it side by side on the grid, all at the crowd's scale. The bind pose from the front
//! with the names of its joints, and from its left side; a stride from the left side and from the front.
//!
//! World, metres: the picture's right is x, the eye looks along y.

use fbcrowd_sim::Population;
use fbcrowd_sim::recording::{AgentFrame, Header};
use fbcrowd_sim::scenario::Scenario;
use glam::{Quat, Vec2, Vec3};
use motiondb::body::{JOINT_COUNT, Joint, Root};
use motiondb::character::{Character, CharacterFit, Dye, JointTransform};
use tiny_skia::Pixmap;

use crate::camera::worn::{Textures, Worn};
use crate::camera::{CameraView, ColourBy, Quality, Shot};
use crate::detail::Level;
use crate::plots::character::joint_names::{LETTERS_PX, NAMES_PX, draw_joints, draw_names, draw_text};
use crate::plots::character::stride::Stride;
use crate::raster::text::{TextAnchor, Typeface};
use crate::visibility::{Lens, Owner, SamplePattern, SceneParts};

/// Width of the picture, pixels.
const WIDTH_PX: u32 = 2400;
/// Least and greatest height of the picture, pixels.
const HEIGHT_PX: [f32; 2] = [700.0, 1600.0];
/// Gap between figures, and at the edges, as a share of the figure's height.
const GAP: f32 = 0.14;
/// Room above and below the figures, as a share of their height.
const ROOM: [f32; 2] = [0.10, 0.22];
/// Distance of the eye, as a multiple of the picture's width: nearly parallel rays, so that sides are comparable.
const EYE: f32 = 2.5;
/// Elevation of the eye, as a share of its distance.
const ELEVATION: f32 = 0.09;
/// Facing of the figures towards the eye, and with the left side towards it, rad.
const FACINGS_RAD: [f32; 2] = [-std::f32::consts::FRAC_PI_2, std::f32::consts::PI];

/// What is written below each figure.
const CAPTIONS: [&str; 4] =
    ["bind pose, from the front", "bind pose, from its left", "stride, from its left", "stride, from the front"];

/// One of the four figures at the origin.
struct Posed {
    transforms: Vec<JointTransform>,
    /// Position of each role, m; none without a joint.
    joints_m: [Option<Vec3>; JOINT_COUNT],
    /// Least and greatest x of its vertices, m.
    across_m: [f32; 2],
    /// Greatest height of its vertices, m.
    top_m: f32,
}

/// The sheet of a character on the body of a stride.
pub fn character_sheet(character: &Character, stride: &Stride) -> Pixmap {
    let fit = CharacterFit::new(character, &stride.database.skeleton);
    let [front, side] = FACINGS_RAD;
    let figures = [
        Posed::new(character, bind_pose(&fit, front)),
        Posed::new(character, bind_pose(&fit, side)),
        Posed::new(character, stride_pose(&fit, stride, side)),
        Posed::new(character, stride_pose(&fit, stride, front)),
    ];
    let layout = Layout::new(&figures);
    let textures = Textures::new(std::slice::from_ref(character)).all;
    let level = Level::new(character.mesh.clone());
    let mut scene = SceneParts { textures, ..SceneParts::default() };
    for (index, (figure, x_m)) in figures.iter().zip(layout.x_m).enumerate() {
        let owner = Owner { agent: index as u32, material: 1 };
        let worn = Worn { fit: &fit, level: &level, first_texture: 0, dye: Dye::default(), owner };
        worn.append(&mut scene, &figure.moved(x_m));
    }
    let header = Header::of(stride.database.clone(), Scenario::of(Vec::new()));
    let (population, quality) =
        (Population::default(), Quality { samples: SamplePattern::Sixteen, ..Quality::default() });
    let view = CameraView::new(&header, &population, quality, ColourBy::Agent);
    let shot = Shot { lens: layout.lens(), time_s: 0.0, eyes_of: None, fog_m: None };
    let face = Typeface::new(LETTERS_PX[0]);
    let mut picture = view.draw_scene(&shot, &scene).to_display();
    for (index, (figure, x_m)) in figures.iter().zip(layout.x_m).enumerate() {
        let joints_px = figure.joints_m.map(|joint_m| shot.lens.to_px(joint_m? + x_m * Vec3::X));
        draw_joints(&mut picture, character, &joints_px);
        if index == 0 {
            draw_names(&mut picture, character, &joints_px, layout.names_px(figure));
        }
        let middle_m = Vec3::new(x_m + 0.5 * (figure.across_m[0] + figure.across_m[1]), 0.0, 0.0);
        let below_px = shot.lens.to_px(middle_m).unwrap_or_default().with_y(picture.height() as f32 - LETTERS_PX[1]);
        draw_text(&mut picture, &face, CAPTIONS[index], below_px, TextAnchor::Centre);
    }
    picture
}

/// The bind pose at the crowd's scale.
fn bind_pose(fit: &CharacterFit, facing_rad: f32) -> Vec<JointTransform> {
    let rotation = Quat::from_rotation_z(facing_rad);
    let transform = JointTransform { rotation, scale: fit.scale, translation_m: Vec3::ZERO };
    vec![transform; fit.character.joints.len()]
}

fn stride_pose(fit: &CharacterFit, stride: &Stride, facing_rad: f32) -> Vec<JointTransform> {
    let skeleton = &stride.database.skeleton;
    let agent =
        AgentFrame { pose: stride.pose, root: Root { position_m: Vec2::ZERO, facing_rad }, ..AgentFrame::default() };
    let mut transforms = Vec::new();
    fit.pose(skeleton, &agent.pose.forward_kinematics(skeleton), agent.root.frame(), &mut transforms);
    fit.pose_extra(|joint| fit.resting(joint), &mut transforms);
    transforms
}

impl Posed {
    fn new(character: &Character, transforms: Vec<JointTransform>) -> Self {
        let (mut across_m, mut top_m) = ([f32::INFINITY, f32::NEG_INFINITY], 0.0_f32);
        for vertex in 0..character.mesh.positions_m.len() {
            let position_m = character.mesh.position_m(vertex, &transforms);
            across_m = [across_m[0].min(position_m.x), across_m[1].max(position_m.x)];
            top_m = top_m.max(position_m.z);
        }
        let joints_m = Joint::ALL.map(|role| {
            let joint = character.joint(role)?;
            Some(transforms[joint].point_m(character.joints[joint].position_m))
        });
        Self { transforms, joints_m, across_m, top_m }
    }

    /// The transforms, moved along x.
    fn moved(&self, x_m: f32) -> Vec<JointTransform> {
        let moved = |transform: &JointTransform| JointTransform {
            translation_m: transform.translation_m + x_m * Vec3::X,
            ..*transform
        };
        self.transforms.iter().map(moved).collect()
    }
}

/// Where the figures stand, and how large the picture is.
struct Layout {
    /// Position of each figure's root, m.
    x_m: [f32; 4],
    width_m: f32,
    top_m: f32,
    /// Length of a pixel, m.
    pixel_m: f32,
}

impl Layout {
    fn new(figures: &[Posed; 4]) -> Self {
        let top_m = figures.iter().map(|figure| figure.top_m).fold(0.1, f32::max);
        let (gap_m, mut end_m, mut x_m) = (GAP * top_m, 0.0, [0.0; 4]);
        for (figure, x_m) in figures.iter().zip(&mut x_m) {
            *x_m = end_m + gap_m - figure.across_m[0];
            end_m = *x_m + figure.across_m[1];
        }
        // Names stand on both sides of the first figure.
        let free_px = WIDTH_PX as f32 - 2.0 * NAMES_PX;
        let pixel_m = (end_m + gap_m) / free_px;
        let pixel_m = pixel_m.max(top_m * (1.0 + ROOM[0] + ROOM[1]) / HEIGHT_PX[1]);
        let names_m = NAMES_PX * pixel_m;
        x_m.iter_mut().enumerate().for_each(|(index, x_m)| *x_m += if index == 0 { names_m } else { 2.0 * names_m });
        Self { x_m, width_m: WIDTH_PX as f32 * pixel_m, top_m, pixel_m }
    }

    fn lens(&self) -> Lens {
        let height_px = (self.top_m * (1.0 + ROOM[0] + ROOM[1]) / self.pixel_m).clamp(HEIGHT_PX[0], HEIGHT_PX[1]);
        let middle_m = Vec3::new(0.5 * self.width_m, 0.0, self.top_m * (0.5 + 0.5 * (ROOM[0] - ROOM[1])));
        let distance_m = EYE * self.width_m;
        let eye_m = middle_m + distance_m * Vec3::new(0.0, -1.0, ELEVATION);
        Lens::perspective([WIDTH_PX, height_px as u32], eye_m, middle_m, self.width_m / eye_m.distance(middle_m))
    }

    /// Columns at which the names of the first figure end on its left, and begin on its right, pixels.
    fn names_px(&self, first: &Posed) -> [f32; 2] {
        let gap_m = 0.5 * GAP * self.top_m;
        let edges_m = [first.across_m[0] - gap_m, first.across_m[1] + gap_m];
        edges_m.map(|edge_m| (self.x_m[0] + edge_m) / self.pixel_m)
    }
}
