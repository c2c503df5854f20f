//! Elbow room: how far a body may reach to each side before it meets a wall or the body beside it. `FbCrowd` does not
//! have it.
//!
//! Discs are narrower than shoulders and arms. Each wall near an agent, and each agent near it, leaves the agent a
//! half-plane of the ground: that before the nearest point of the wall, and its own share of the way to the other
//! agent. Two bodies that keep to their half-planes do not meet. Where there is too little room for all, the later
//! sides count more; walls come last, since the other agent can yield too.
//!
//! The planner finds them; the synthesis moves the upper body (`body_clearance`, `squeeze`) and swinging feet
//! (`foot_room`) back towards them. World axes, relative to the agent's centre, metres.

use glam::Vec2;

/// Most sides that count.
pub(crate) const SIDES_MAX: usize = 8;
/// Distance beyond which a side does not count, m: what an arm reaches that hangs or swings.
const REACH_M: f32 = 0.5;
/// Cosine of the angle to the left or right within which a side limits the shoulders: 60°.
const BESIDE_COS: f32 = 0.5;

/// The sides at which something stands near an agent: the nearest eight, in the order of [`ElbowRoom::ending_at`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ElbowRoom {
    sides: [RoomSide; SIDES_MAX],
    count: usize,
}

/// One side: the agent's half-plane ends at `distance_m` in the direction `towards`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RoomSide {
    /// Unit vector to what stands there.
    pub towards: Vec2,
    /// Distance of the half-plane's border from the agent's centre, m.
    pub distance_m: f32,
}

impl ElbowRoom {
    /// The room whose sides end at points, relative to the agent's centre, world axes, m: the nearest eight, the later of
    /// which count more.
    pub fn ending_at(points_m: impl IntoIterator<Item = Vec2>) -> Self {
        let mut room = Self::default();
        points_m.into_iter().for_each(|point_m| room.end_at(point_m));
        room
    }

    /// The sides.
    pub fn sides(&self) -> &[RoomSide] {
        &self.sides[..self.count]
    }

    /// Adds the side that ends at a point; of more than [`SIDES_MAX`] the farthest is left out.
    fn end_at(&mut self, point_m: Vec2) {
        let (towards, distance_m) = point_m.normalize_and_length();
        if distance_m > REACH_M {
            return;
        }
        if self.count == SIDES_MAX {
            let farther = |a: &usize, b: &usize| self.sides[*a].distance_m.total_cmp(&self.sides[*b].distance_m);
            let Some(farthest) = (0..SIDES_MAX).max_by(farther) else { return };
            if distance_m >= self.sides[farthest].distance_m {
                return;
            }
            self.sides.copy_within(farthest + 1.., farthest);
            self.count -= 1;
        }
        self.sides[self.count] = RoomSide { towards, distance_m };
        self.count += 1;
    }

    /// Distances to the ends of the room on the left and on the right of a body that faces `forward`, m; none where a
    /// side is free.
    pub(crate) fn gap_m(&self, forward: Vec2) -> Option<[f32; 2]> {
        let mut ends_m = [f32::INFINITY; 2];
        for side in self.sides() {
            let leftward = forward.perp_dot(side.towards);
            if leftward.abs() > BESIDE_COS {
                let end_m = &mut ends_m[usize::from(leftward < 0.0)];
                *end_m = end_m.min(side.distance_m / leftward.abs());
            }
        }
        ends_m.iter().all(|end_m| end_m.is_finite()).then_some(ends_m)
    }

    /// The same in a frame at `origin_m` whose x axis is `forward`.
    pub(crate) fn seen_from(mut self, origin_m: Vec2, forward: Vec2) -> Self {
        let back = Vec2::new(forward.x, -forward.y);
        for RoomSide { towards, distance_m } in &mut self.sides[..self.count] {
            *distance_m -= towards.dot(origin_m);
            *towards = back.rotate(*towards);
        }
        self
    }

    /// The same of a body `factor` times as large.
    pub(crate) fn scaled(mut self, factor: f32) -> Self {
        self.sides[..self.count].iter_mut().for_each(|side| side.distance_m *= factor);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A room with a side at each distance along +x, m.
    fn room(distances_m: impl IntoIterator<Item = f32>) -> ElbowRoom {
        ElbowRoom::ending_at(distances_m.into_iter().map(|distance_m| distance_m * Vec2::X))
    }

    #[test]
    fn the_nearest_eight_within_reach_are_sides() {
        let room = room([0.6, 0.5, 0.1, 0.2, 0.3, 0.4, 0.15, 0.25, 0.35, 0.05]);
        let mut distances_m: Vec<f32> = room.sides().iter().map(|side| side.distance_m).collect();
        distances_m.sort_by(f32::total_cmp);
        assert_eq!(distances_m, [0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4]);
    }

    #[test]
    fn sides_keep_their_order() {
        let room = room([0.3, 0.45, 0.2, 0.4, 0.1, 0.35, 0.15, 0.25, 0.05]);
        let distances_m: Vec<f32> = room.sides().iter().map(|side| side.distance_m).collect();
        assert_eq!(distances_m, [0.3, 0.2, 0.4, 0.1, 0.35, 0.15, 0.25, 0.05]);
    }

    #[test]
    fn a_gap_has_two_sides_beside_the_body() {
        let [left, ahead, right_ahead] = [[0.0, 0.3], [0.1, 0.0], [0.2, -0.2]].map(Vec2::from);
        let gap_m = |points_m: &[Vec2]| ElbowRoom::ending_at(points_m.iter().copied()).gap_m(Vec2::X);
        assert_eq!([gap_m(&[left]), gap_m(&[left, ahead])], [None; 2]);
        let [left_m, right_m] = gap_m(&[left, right_ahead]).unwrap();
        assert!(
            left_m == 0.3 && (right_m - 0.4).abs() < 1e-6,
            "the border crosses the line of the shoulders: {right_m}"
        );
        assert_eq!(ElbowRoom::ending_at([left, right_ahead]).gap_m(Vec2::Y), None, "both lie ahead of this body");
    }

    #[test]
    fn borders_stay_where_they_are_in_other_frames() {
        let (room, point_m) = (room([0.3]), Vec2::new(0.2, 0.1));
        let [origin_m, forward] = [Vec2::new(-0.4, 0.7), Vec2::new(0.6, 0.8)];
        let seen_m = Vec2::new(forward.x, -forward.y).rotate(point_m - origin_m);
        let clear_m = |room: &ElbowRoom, point_m: Vec2| {
            let RoomSide { towards, distance_m } = room.sides()[0];
            distance_m - towards.dot(point_m)
        };
        let seen = room.seen_from(origin_m, forward);
        assert!((clear_m(&seen, seen_m) - clear_m(&room, point_m)).abs() < 1e-6);
        assert!((room.scaled(2.0).sides()[0].distance_m - 0.6).abs() < 1e-6);
    }
}
