//! A lens as the matrices of an EXR header.
//!
//! OpenEXR multiplies row vectors from the left, so matrices are stored row by row with the translation in the last
//! row. Camera space there: x right, y up, looking along −z, metres. Normalised device: x and y from −1 to 1 over the
//! picture, y up.

use glam::{Mat4, Vec4};

use crate::visibility::Lens;

/// World to camera space.
pub(crate) fn world_to_camera(lens: &Lens) -> [f32; 16] {
    to_camera(lens).to_cols_array()
}

/// World to normalised device.
pub(crate) fn world_to_normalized_device(lens: &Lens, near_m: f32) -> [f32; 16] {
    let half = 0.5 * lens.size() * lens.pixel;
    // Column vectors; the array of columns is the row-by-row matrix for row vectors.
    let projection = if lens.is_perspective {
        Mat4::from_cols(
            Vec4::new(1.0 / half.x, 0.0, 0.0, 0.0),
            Vec4::new(0.0, 1.0 / half.y, 0.0, 0.0),
            Vec4::new(0.0, 0.0, -1.0, -1.0),
            Vec4::new(0.0, 0.0, -2.0 * near_m, 0.0),
        )
    } else {
        Mat4::from_diagonal(Vec4::new(1.0 / half.x, 1.0 / half.y, -1.0, 1.0))
    };
    (projection * to_camera(lens)).to_cols_array()
}

fn to_camera(lens: &Lens) -> Mat4 {
    let [right, up, back] = [lens.right, -lens.down, -lens.forward].map(|axis| axis.extend(-axis.dot(lens.eye_m)));
    Mat4::from_cols(right, up, back, Vec4::W).transpose()
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    /// A row vector times a matrix that is stored row by row, divided by w.
    fn transformed(point_m: Vec3, matrix: [f32; 16]) -> Vec3 {
        let column = |index: usize| {
            let [x, y, z, w] = [0, 1, 2, 3].map(|row| matrix[4 * row + index]);
            point_m.x * x + point_m.y * y + point_m.z * z + w
        };
        Vec3::new(column(0), column(1), column(2)) / column(3)
    }

    #[test]
    fn matrices_project_as_the_lens() {
        let (size_px, eye_m) = ([800, 600], Vec3::new(1.0, -4.0, 1.6));
        let lenses = [
            Lens::perspective(size_px, eye_m, Vec3::new(0.3, 5.0, 1.0), 0.9),
            Lens::orthographic(size_px, eye_m, Vec3::new(0.1, 1.0, -0.4), 6.0),
        ];
        for lens in lenses {
            let point_m = Vec3::new(0.7, 2.0, 0.4);
            let at = transformed(point_m, world_to_normalized_device(&lens, 0.1));
            let px = lens.to_px(point_m).expect("before the eye");
            let expected = [2.0 * px.x / 800.0 - 1.0, 1.0 - 2.0 * px.y / 600.0];
            assert!((at.x - expected[0]).abs() < 1e-5 && (at.y - expected[1]).abs() < 1e-5, "{at} {expected:?}");
            let camera_m = transformed(point_m, world_to_camera(&lens));
            assert!((camera_m.z + lens.to_camera(point_m).z).abs() < 1e-5, "{camera_m}");
        }
    }
}
