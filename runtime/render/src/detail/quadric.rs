//! Sums of squared errors as quadratic functions of a position (Garland and Heckbert 1997), and of a position and
//! attributes (Hoppe 1999, "New quadric metric for simplifying meshes with appearance attributes"). Metres.

use glam::DVec3;

/// Sum of squares of affine functions of a position.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Quadric {
    /// Factors of xx, xy, xz, yy, yz, zz.
    squares: [f64; 6],
    slope: DVec3,
    constant: f64,
}

impl Quadric {
    /// weight · (gradient · x + offset)².
    pub(super) fn of_form(gradient: DVec3, offset: f64, weight: f64) -> Self {
        let DVec3 { x, y, z } = gradient;
        Self {
            squares: [x * x, x * y, x * z, y * y, y * z, z * z].map(|square| weight * square),
            slope: weight * offset * gradient,
            constant: weight * offset * offset,
        }
    }

    /// The weighted squared distance to the plane through a point.
    pub(super) fn of_plane(normal: DVec3, through_m: DVec3, weight: f64) -> Self {
        Self::of_form(normal, -normal.dot(through_m), weight)
    }

    pub(super) fn add(&mut self, other: &Self) {
        self.squares.iter_mut().zip(other.squares).for_each(|(own, other)| *own += other);
        self.slope += other.slope;
        self.constant += other.constant;
    }

    /// The sum at a position.
    pub(super) fn at(&self, at_m: DVec3) -> f64 {
        let DVec3 { x, y, z } = at_m;
        let [xx, xy, xz, yy, yz, zz] = self.squares;
        let squares = xx * x * x + yy * y * y + zz * z * z + 2.0 * (xy * x * y + xz * x * z + yz * y * z);
        (squares + 2.0 * self.slope.dot(at_m) + self.constant).max(0.0)
    }
}

/// Sum of squared differences between three attributes and their affine extensions over triangles.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct AttributeQuadric {
    extensions: Quadric,
    gradients: [DVec3; 3],
    offsets: DVec3,
    weight: f64,
}

impl AttributeQuadric {
    /// Of one triangle, which has these attributes at its corners; nothing where it has no area.
    pub(super) fn of_triangle(corners_m: [DVec3; 3], attributes: [DVec3; 3], weight: f64) -> Self {
        let (first_m, second_m) = (corners_m[1] - corners_m[0], corners_m[2] - corners_m[0]);
        let [aa, ab, bb] = [first_m.dot(first_m), first_m.dot(second_m), second_m.dot(second_m)];
        let area = aa * bb - ab * ab;
        let mut sum = Self::default();
        if area <= 1e-12 * aa * bb || weight <= 0.0 {
            return sum;
        }
        sum.weight = weight;
        for index in 0..3 {
            let [start, first, second] = attributes.map(|attribute| attribute[index]);
            let (first, second) = (first - start, second - start);
            let gradient = ((bb * first - ab * second) * first_m + (aa * second - ab * first) * second_m) / area;
            let offset = start - gradient.dot(corners_m[0]);
            sum.extensions.add(&Quadric::of_form(gradient, offset, weight));
            sum.gradients[index] = weight * gradient;
            sum.offsets[index] = weight * offset;
        }
        sum
    }

    pub(super) fn add(&mut self, other: &Self) {
        self.extensions.add(&other.extensions);
        self.gradients.iter_mut().zip(other.gradients).for_each(|(own, other)| *own += other);
        self.offsets += other.offsets;
        self.weight += other.weight;
    }

    /// The sum for attributes at a position.
    pub(super) fn at(&self, at_m: DVec3, attributes: DVec3) -> f64 {
        let extended = DVec3::from(self.gradients.map(|gradient| gradient.dot(at_m))) + self.offsets;
        let own = self.weight * attributes.length_squared();
        (self.extensions.at(at_m) - 2.0 * attributes.dot(extended) + own).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_add_up_to_squared_distances() {
        let mut sum = Quadric::of_plane(DVec3::Z, DVec3::new(5.0, 1.0, 2.0), 3.0);
        sum.add(&Quadric::of_plane(DVec3::X, DVec3::new(1.0, 7.0, 7.0), 2.0));
        let at = sum.at(DVec3::new(1.5, -4.0, 4.0));
        assert!((at - (3.0 * 4.0 + 2.0 * 0.25)).abs() < 1e-12, "{at}");
    }

    #[test]
    fn attributes_that_continue_a_triangle_cost_nothing() {
        let corners_m = [DVec3::ZERO, DVec3::new(0.2, 0.0, 0.0), DVec3::new(0.0, 0.1, 0.3)];
        let affine = |at_m: DVec3| DVec3::new(2.0 * at_m.x + 1.0, at_m.y - at_m.x, 0.25);
        let sum = AttributeQuadric::of_triangle(corners_m, corners_m.map(affine), 0.5);
        let beyond_m = corners_m[0] + 3.0 * corners_m[1] - 2.0 * corners_m[2];
        let reached = affine(beyond_m);
        // The triangle's own plane carries the functions: y and z belong together.
        assert!(sum.at(beyond_m, reached) < 1e-12);
        let other = sum.at(beyond_m, reached + DVec3::new(0.0, 0.2, 0.0));
        assert!((other - 0.5 * 0.04).abs() < 1e-12, "{other}");
    }
}
