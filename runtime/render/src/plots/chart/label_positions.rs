//! Where the names of a plot's points stand: beside their points, over no point and no other name. All in the sheet's
//! pixels, y down.
//!
//! Greedy, in the order of the points: each name takes the first free of its places, from right beside the point to
//! ever farther above and below. What stands far off is tied to its point by a line, see [`NamePlace::is_far`].

use glam::Vec2;

/// Half the side of the square about a point that names leave free.
const CLEAR_PX: f32 = 9.0;
/// Distance of a name from its point.
const GAP_PX: f32 = 13.0;
/// Distance of lines of names, heights of a name.
const LINE_STEP: f32 = 1.05;
/// So many lines above and below a point are tried.
const LINES: usize = 16;
/// From this line on, a name no longer stands at its point.
const FAR_LINE: f32 = 2.0;

/// A rectangle for a name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NamePlace {
    pub(crate) low_px: Vec2,
    pub(crate) high_px: Vec2,
    /// Too far from its point to be taken for its name.
    pub(crate) is_far: bool,
}

/// Places for names of the given sizes at the given points, within `bounds`; all `points` are left free. A name for
/// which there is no room stands to the right of its point all the same.
pub(crate) fn place_names(names: &[(Vec2, Vec2)], points: &[Vec2], bounds: &NamePlace) -> Vec<NamePlace> {
    let is_clear = |place: &NamePlace| points.iter().all(|point| !place.overlaps(&NamePlace::about(*point)));
    let mut taken: Vec<NamePlace> = Vec::new();
    for (point, size) in names {
        let is_free = |place: &NamePlace| bounds.contains(place) && is_clear(place) && !overlaps_any(place, &taken);
        let free = steps().map(|step| NamePlace::beside(*point, *size, step)).find(is_free);
        taken.push(free.unwrap_or_else(|| NamePlace::beside(*point, *size, Vec2::X)));
    }
    taken
}

/// Steps from a point to the middle of its name: across −1 left, 0 centred, 1 right; down in lines.
fn steps() -> impl Iterator<Item = Vec2> {
    let off_line = (1..=LINES).flat_map(|line| {
        let down = line as f32;
        [0.0, 1.0, -1.0].into_iter().flat_map(move |across| [Vec2::new(across, -down), Vec2::new(across, down)])
    });
    [Vec2::X, Vec2::NEG_X].into_iter().chain(off_line)
}

fn overlaps_any(place: &NamePlace, others: &[NamePlace]) -> bool {
    others.iter().any(|other| place.overlaps(other))
}

impl NamePlace {
    /// What a panel of left, top, width and height leaves for names.
    pub(crate) fn within([left, top, width, height]: [f32; 4]) -> Self {
        let low_px = Vec2::new(left, top);
        Self { low_px, high_px: low_px + Vec2::new(width, height), is_far: false }
    }

    /// The point of the rectangle that is nearest to another point.
    pub(crate) fn nearest_px(&self, point: Vec2) -> Vec2 {
        point.clamp(self.low_px, self.high_px)
    }

    fn about(point: Vec2) -> Self {
        Self { low_px: point - CLEAR_PX, high_px: point + CLEAR_PX, is_far: false }
    }

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
    fn names_of_crowded_points_cover_neither_points_nor_each_other() {
        let points: Vec<Vec2> = (0..20).map(|index| Vec2::new(100.0 + 17.0 * index as f32, 400.0)).collect();
        let names: Vec<(Vec2, Vec2)> = points.iter().map(|point| (*point, Vec2::new(60.0, 19.0))).collect();
        let bounds = NamePlace::within([0.0, 0.0, 600.0, 800.0]);
        let places = place_names(&names, &points, &bounds);
        for (index, place) in places.iter().enumerate() {
            assert!(bounds.contains(place) && !overlaps_any(place, &places[..index]), "{place:?}");
            assert!(points.iter().all(|point| !place.overlaps(&NamePlace::about(*point))), "{place:?}");
        }
    }

    #[test]
    fn a_lone_name_stands_to_the_right_and_at_the_border_to_the_left() {
        let bounds = NamePlace::within([0.0, 0.0, 200.0, 100.0]);
        for (x, low_x) in [(50.0, 50.0 + GAP_PX), (180.0, 180.0 - GAP_PX - 40.0)] {
            let point = Vec2::new(x, 50.0);
            let place = place_names(&[(point, Vec2::new(40.0, 20.0))], &[point], &bounds)[0];
            assert_eq!(place.low_px, Vec2::new(low_x, 40.0));
            assert!(!place.is_far);
        }
    }
}
