//! Positions of labels: beside their points, over no point and no other label. In the figure's pixels, y down.
//!
//! Greedy, in the order of the points: each label takes the first free position, from directly beside its point to ever
//! farther above and below. A line connects a far label with its point ([`LabelBox::is_far`]).

use glam::Vec2;

/// Half the side of the square around a point that labels leave free, pixels.
const CLEAR_PX: f32 = 9.0;
/// Distance of a label from its point, pixels.
const GAP_PX: f32 = 13.0;
/// Distance of lines of labels, heights of a label.
const LINE_STEP: f32 = 1.05;
/// Number of lines above and below a point that are tried.
const LINES: usize = 16;
/// First line whose labels are far from their point.
const FAR_LINE: f32 = 2.0;

/// Rectangle of a label.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LabelBox {
    /// Upper left corner.
    pub(crate) low_px: Vec2,
    /// Lower right corner.
    pub(crate) high_px: Vec2,
    /// Whether the label is so far from its point that a line must connect them.
    pub(crate) is_far: bool,
}

/// Rectangles for labels, given as (point, size), within `bounds`; all `points` are left free. A label without room is
/// to the right of its point.
pub(crate) fn label_boxes(labels: &[(Vec2, Vec2)], points: &[Vec2], bounds: &LabelBox) -> Vec<LabelBox> {
    let is_clear = |label: &LabelBox| points.iter().all(|point| !label.overlaps(&LabelBox::around(*point)));
    let mut taken: Vec<LabelBox> = Vec::new();
    for (point, size) in labels {
        let is_free = |label: &LabelBox| bounds.contains(label) && is_clear(label) && !overlaps_any(label, &taken);
        let free = steps().map(|step| LabelBox::beside(*point, *size, step)).find(is_free);
        taken.push(free.unwrap_or_else(|| LabelBox::beside(*point, *size, Vec2::X)));
    }
    taken
}

/// Steps from a point to the middle of its label: x −1 left, 0 centred, 1 right; y in lines.
fn steps() -> impl Iterator<Item = Vec2> {
    let off_line = (1..=LINES).flat_map(|line| {
        let down = line as f32;
        [0.0, 1.0, -1.0].into_iter().flat_map(move |across| [Vec2::new(across, -down), Vec2::new(across, down)])
    });
    [Vec2::X, Vec2::NEG_X].into_iter().chain(off_line)
}

fn overlaps_any(label: &LabelBox, others: &[LabelBox]) -> bool {
    others.iter().any(|other| label.overlaps(other))
}

impl LabelBox {
    /// The rectangle of left, top, width and height.
    pub(crate) fn within([left, top, width, height]: [f32; 4]) -> Self {
        let low_px = Vec2::new(left, top);
        Self { low_px, high_px: low_px + Vec2::new(width, height), is_far: false }
    }

    /// The point of the rectangle that is nearest to another point.
    pub(crate) fn nearest_px(&self, point: Vec2) -> Vec2 {
        point.clamp(self.low_px, self.high_px)
    }

    /// The square around a point that labels leave free.
    fn around(point: Vec2) -> Self {
        Self { low_px: point - CLEAR_PX, high_px: point + CLEAR_PX, is_far: false }
    }

    /// The rectangle of a label that is a step from its point.
    fn beside(point: Vec2, size: Vec2, step: Vec2) -> Self {
        let middle = point + step * Vec2::new(GAP_PX + 0.5 * size.x, LINE_STEP * size.y);
        Self { low_px: middle - 0.5 * size, high_px: middle + 0.5 * size, is_far: step.y.abs() >= FAR_LINE }
    }

    fn overlaps(&self, other: &Self) -> bool {
        self.low_px.cmplt(other.high_px).all() && other.low_px.cmplt(self.high_px).all()
    }

    fn contains(&self, other: &Self) -> bool {
        self.low_px.cmple(other.low_px).all() && other.high_px.cmple(self.high_px).all()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_cover_no_point_and_no_label() {
        let points: Vec<Vec2> = (0..20).map(|index| Vec2::new(100.0 + 17.0 * index as f32, 400.0)).collect();
        let labels: Vec<(Vec2, Vec2)> = points.iter().map(|point| (*point, Vec2::new(60.0, 19.0))).collect();
        let bounds = LabelBox::within([0.0, 0.0, 600.0, 800.0]);
        let boxes = label_boxes(&labels, &points, &bounds);
        for (index, label) in boxes.iter().enumerate() {
            assert!(bounds.contains(label) && !overlaps_any(label, &boxes[..index]), "{label:?}");
            assert!(points.iter().all(|point| !label.overlaps(&LabelBox::around(*point))), "{label:?}");
        }
    }

    #[test]
    fn single_label_is_right_of_its_point() {
        let bounds = LabelBox::within([0.0, 0.0, 200.0, 100.0]);
        for (x, low_x) in [(50.0, 50.0 + GAP_PX), (180.0, 180.0 - GAP_PX - 40.0)] {
            let point = Vec2::new(x, 50.0);
            let label = label_boxes(&[(point, Vec2::new(40.0, 20.0))], &[point], &bounds)[0];
            assert_eq!(label.low_px, Vec2::new(low_x, 40.0));
            assert!(!label.is_far);
        }
    }
}
