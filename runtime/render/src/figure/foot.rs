//! Shoes: an upper over a flat sole, bent at the ball of the foot. Rest pose, metres.

use glam::Vec3;
use motiondb::body::{Joint, Side};

use crate::figure::build::Build;
use crate::figure::section::Section;
use crate::figure::style::Cloth;
use crate::figure::template::Template;

/// Sections of a shoe from heel (0) over ball (1) to toe tip (2): place, half width, height of the top.
const SHOE: [[f32; 3]; 11] = [
    [-0.090, 0.016, 0.050],
    [-0.060, 0.029, 0.066],
    [0.060, 0.036, 0.086],
    [0.250, 0.037, 0.102],
    [0.420, 0.037, 0.094],
    [0.620, 0.041, 0.074],
    [0.820, 0.045, 0.060],
    [1.000, 0.047, 0.052],
    [1.500, 0.045, 0.046],
    [1.900, 0.033, 0.038],
    [2.080, 0.012, 0.026],
];
/// Height of a sole, m.
const SOLE_M: f32 = 0.016;
/// Part of the foot's height above which the shoe narrows to the ankle.
const POWER: f32 = 2.6;

impl Template {
    pub(crate) fn add_shoe(&mut self, build: &Build, side: Side) {
        let index = side.index();
        let (foot, toe) = (Joint::FEET[index], Joint::TOES[index]);
        let points = &build.skeleton.feet[index];
        let heel = build.joint(foot) + points.heel_m;
        let ball = build.joint(foot) + points.ball_m;
        let tip = build.joint(toe) + points.toe_tip_m;
        let size = build.by_sex(1.0, 0.9) * build.scale;
        // A foot points outward a little.
        let place = |at: f32| if at < 1.0 { heel.lerp(ball, at) } else { ball.lerp(tip, at - 1.0) };
        let section = |[at, width, top]: [f32; 3], low: f32, high: f32, cloth: Cloth| {
            let share = ((at - 0.8) / 0.4).clamp(0.0, 1.0);
            let high = if high > 0.5 { top * size } else { high };
            let middle = place(at) + Vec3::Z * (0.5 * (low + high));
            let half = 0.5 * (high - low);
            Section {
                power: POWER,
                joints: [foot.index(), toe.index()],
                share,
                // Front × side = z × y points along −x; the loft runs along +x.
                ..Section::round(middle, -Vec3::Y * width * size, Vec3::Z * half, foot.index(), cloth)
            }
        };
        let count = build.fineness.points(8);
        let upper = SHOE.map(|row| section(row, 0.4 * SOLE_M, 1.0, Cloth::Shoe));
        self.loft(&upper, count);
        let wider = |[at, width, top]: [f32; 3]| [at * 1.01 - 0.01, width * 1.05, top];
        let sole = SHOE.map(|row| section(wider(row), 0.0, SOLE_M, Cloth::Sole));
        self.loft(&sole, count);
    }
}
