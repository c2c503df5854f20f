//! A part of a scene, as samples store it.

/// A part of a scene: a cone, a triangle, a layer of the ground, or the sky.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct PartId(pub u32);

impl PartId {
    /// Nothing: the sky.
    pub const SKY: Self = Self(u32::MAX);
    /// The ground's lowest layer; further layers follow.
    pub const GROUND: Self = Self(1 << 31);

    /// The layer of a part of the ground; none of other parts.
    pub fn ground_layer(self) -> Option<u32> {
        (self >= Self::GROUND && self != Self::SKY).then(|| self.0 - Self::GROUND.0)
    }

    /// The shape among a number of cones and the triangles after them; none of ground and sky.
    pub(crate) fn shape(self, cones: usize) -> Option<Shape> {
        let index = self.0 as usize;
        let shape = if index < cones { Shape::Cone(index) } else { Shape::Triangle(index.saturating_sub(cones)) };
        (self < Self::GROUND).then_some(shape)
    }
}

/// A part that is neither ground nor sky.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    /// A cone, by index.
    Cone(usize),
    /// A triangle, by index.
    Triangle(usize),
}
