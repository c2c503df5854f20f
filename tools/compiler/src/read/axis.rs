//! A signed axis of a source's coordinates, written as in manifests and records: `+X` … `-Z`.

use glam::DVec3;
use serde::Deserialize;

/// One of the six signed axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub struct Axis {
    index: usize,
    is_negative: bool,
}

impl Axis {
    /// The axis nearest to a direction.
    pub fn nearest(direction: DVec3) -> Self {
        let index = direction.abs().max_position();
        Self { index, is_negative: direction[index] < 0.0 }
    }

    /// Unit vector along the axis.
    pub fn direction(self) -> DVec3 {
        let axis = DVec3::AXES[self.index];
        if self.is_negative { -axis } else { axis }
    }

    /// Whether both axes lie on one line.
    pub(crate) fn is_along(self, other: Self) -> bool {
        self.index == other.index
    }

    /// `+X` … `-Z`.
    pub fn name(self) -> String {
        format!("{}{}", if self.is_negative { '-' } else { '+' }, ['X', 'Y', 'Z'][self.index])
    }
}

impl TryFrom<String> for Axis {
    type Error = String;

    fn try_from(name: String) -> Result<Self, String> {
        let axes = (0..3).flat_map(|index| [false, true].map(|is_negative| Self { index, is_negative }));
        let found = axes.into_iter().find(|axis| axis.name() == name);
        found.ok_or_else(|| format!("`{name}` is not an axis; write +X, -X, +Y, -Y, +Z or -Z"))
    }
}
