//! Shapes on the ground. World, metres.

/// Coordinates x and y, m.
pub type Point = [f64; 2];

/// A shape on the ground.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A point.
    Point(Point),
    /// A disc: centre and radius.
    Circle(Point, f64),
    /// A rectangle along the axes: least corner and greatest corner.
    Rect(Point, Point),
    /// A simple polygon: its corners in order.
    Polygon(Vec<Point>),
}

impl Shape {
    /// A rectangle about a pivot, its least corner before it is turned.
    pub fn turned_rect(pivot_m: Point, size_m: Point, angle_deg: f64) -> Self {
        let [width_m, height_m] = size_m;
        if angle_deg == 0.0 {
            return Self::rect(pivot_m, [pivot_m[0] + width_m, pivot_m[1] + height_m]);
        }
        let (sin, cos) = libm::sincos(angle_deg.to_radians());
        let corner = |x: f64, y: f64| [pivot_m[0] + cos * x - sin * y, pivot_m[1] + sin * x + cos * y].map(round_to_mm);
        Self::Polygon(vec![corner(0.0, 0.0), corner(width_m, 0.0), corner(width_m, height_m), corner(0.0, height_m)])
    }

    /// The rectangle between two opposite corners.
    pub fn rect(a_m: Point, b_m: Point) -> Self {
        Self::Rect([a_m[0].min(b_m[0]), a_m[1].min(b_m[1])], [a_m[0].max(b_m[0]), a_m[1].max(b_m[1])])
    }

    /// Middle of the shape, m: the mean of the corners of a polygon.
    pub fn middle_m(&self) -> Point {
        match self {
            Self::Point(at_m) | Self::Circle(at_m, _) => *at_m,
            Self::Rect(low_m, high_m) => [0.5 * (low_m[0] + high_m[0]), 0.5 * (low_m[1] + high_m[1])],
            Self::Polygon(corners_m) => {
                let count = corners_m.len().max(1) as f64;
                [0, 1].map(|axis| corners_m.iter().map(|corner_m| corner_m[axis]).sum::<f64>() / count)
            }
        }
    }
}

/// A length to the millimetre, for positions that are computed here.
pub(crate) fn round_to_mm(metres: f64) -> f64 {
    (metres * 1000.0).round() / 1000.0
}
