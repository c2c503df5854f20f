//! Discs kept outside walls: a disc is swept along its path in a step, stops where it touches a wall, and slides on
//! along it.
//!
//! The gap between two walls is open to a disc that fits through it, and closed to any other, however long the step:
//!
//! 1. a disc that overlaps walls is first pushed out of them, as far as others let it;
//! 2. it moves to its first contact; what is left of its path loses the part towards the wall, and it moves on;
//! 3. a disc that stays too near to a wall, because it started where it is narrow, moves as a disc that fits there.
//!
//! World, metres.

use glam::Vec2;

use crate::world::obstacles::polygons::Obstacles;
use crate::world::segment::nearest_on_segment;
use crate::world::time_to_collision::disc_with_segment;

/// Distance that a disc keeps from walls beyond its radius, m: more than f32 rounding at 1 km.
const SKIN_M: f32 = 1e-4;
/// Distance within which a disc touches an edge, and path towards it that counts as none, m: rounding of offsets.
const TOUCH_M: f32 = 1e-6;
/// Most contacts in a step: the two walls of a niche, and as many once more.
const CONTACTS_MAX: usize = 4;
/// Distance from an edge within which it is uncertain on which side of it a position lies, m: f32 rounding at 10 km.
const ON_EDGE_M: f32 = 1e-3;

impl Obstacles {
    /// End of a disc's straight path, swept against all walls. A disc that starts inside a polygon may leave that
    /// polygon on any side.
    pub fn clamp_path(&self, from_m: Vec2, to_m: Vec2, radius_m: f32) -> Vec2 {
        let reach_m = radius_m + SKIN_M;
        // Mostly no wall is near.
        if self.grid.within(from_m.min(to_m) - reach_m, from_m.max(to_m) + reach_m).next().is_none() {
            return to_m;
        }
        let sweep = DiscSweep { walls: self, from_m };
        let start_m = sweep.pushed_out(reach_m);
        let target_m = start_m + (to_m - from_m);
        let end_m = sweep.slid(start_m, target_m, sweep.clearance_m(start_m, reach_m));
        // The sum would be rounded.
        let is_direct = start_m == Vec2::ZERO && end_m == target_m;
        let ends_m = [if is_direct { to_m } else { from_m + end_m }, from_m + start_m];
        ends_m.into_iter().find(|&end_m| self.keeps_its_side(from_m, end_m)).unwrap_or(from_m)
    }

    /// Length of a disc's straight path until its first contact with a wall, m.
    pub(crate) fn free_length_m(&self, from_m: Vec2, to_m: Vec2, radius_m: f32) -> f32 {
        let (sweep, along_m) = (DiscSweep { walls: self, from_m }, to_m - from_m);
        let contact = sweep.first_contact(Vec2::ZERO, along_m, radius_m);
        contact.map_or_else(|| along_m.length(), |contact| contact.after_m)
    }

    /// Depth of a disc in the walls, m: 0 where it touches none.
    pub fn depth_m(&self, position_m: Vec2, radius_m: f32) -> f32 {
        let sweep = DiscSweep { walls: self, from_m: position_m };
        let near = self.grid.within(position_m - radius_m, position_m + radius_m);
        let nearest_m = near.map(|edge| sweep.offset_to_m(edge, Vec2::ZERO).length()).fold(f32::INFINITY, f32::min);
        if self.contains(position_m) { radius_m + nearest_m.min(radius_m) } else { (radius_m - nearest_m).max(0.0) }
    }

    /// Whether a path ends on the side of all walls on which it starts: what sweeping gives but for rounding. A start
    /// on an edge counts as on its outer side.
    fn keeps_its_side(&self, from_m: Vec2, to_m: Vec2) -> bool {
        let mut on_edge = self.grid.within(from_m - ON_EDGE_M, from_m + ON_EDGE_M);
        let sweep = DiscSweep { walls: self, from_m };
        let enters = |edge: u32| {
            let is_near = sweep.offset_to_m(edge, Vec2::ZERO).length() <= ON_EDGE_M;
            is_near && !self.surrounds(edge, from_m) && self.surrounds(edge, to_m)
        };
        self.crossed(from_m, to_m).all(|edge| self.surrounds(edge, from_m)) && !on_edge.any(enters)
    }
}

/// A disc that is swept from a start. All positions are offsets from the start, so that they are exact far from the
/// origin too. The edges of a polygon that holds the start do not count.
#[derive(Clone, Copy)]
struct DiscSweep<'a> {
    walls: &'a Obstacles,
    /// The start, world, m.
    from_m: Vec2,
}

/// A contact of a disc with an edge.
#[derive(Clone, Copy, Debug)]
struct Contact {
    /// Path of the disc until the contact, m.
    after_m: f32,
    /// Unit vector from the wall to the disc's centre.
    normal: Vec2,
}

impl DiscSweep<'_> {
    /// The start without its overlaps, the deepest first, as far as other walls let the disc move.
    fn pushed_out(&self, reach_m: f32) -> Vec2 {
        let mut at_m = Vec2::ZERO;
        for _ in 0..CONTACTS_MAX {
            let Some((depth_m, normal)) = self.deepest_overlap(at_m, reach_m) else { break };
            // It does not slide: between two walls it would slide back from where it walks.
            let contact = self.first_contact(at_m, at_m + depth_m * normal, reach_m);
            at_m += contact.map_or(depth_m, |contact| contact.after_m) * normal;
        }
        at_m
    }

    /// Distance from the walls, m; `reach_m` where none is nearer.
    fn clearance_m(&self, at_m: Vec2, reach_m: f32) -> f32 {
        self.deepest_overlap(at_m, reach_m).map_or(reach_m, |(depth_m, _)| reach_m - depth_m)
    }

    /// Depth and normal of the edge that a disc overlaps most, m.
    fn deepest_overlap(&self, at_m: Vec2, reach_m: f32) -> Option<(f32, Vec2)> {
        let mut deepest: Option<(f32, Vec2)> = None;
        for edge in self.near(at_m, at_m, reach_m) {
            let to_edge_m = self.offset_to_m(edge, at_m);
            let depth_m = reach_m - to_edge_m.length();
            let least_m = deepest.map_or(TOUCH_M, |(depth_m, _)| depth_m);
            if depth_m > least_m && !self.walls.surrounds(edge, self.from_m) {
                deepest = Some((depth_m, self.normal(edge, to_edge_m)));
            }
        }
        deepest
    }

    /// End of a path that slides along the walls it meets.
    fn slid(&self, from_m: Vec2, to_m: Vec2, reach_m: f32) -> Vec2 {
        let (mut at_m, mut target_m, mut before) = (from_m, to_m, Vec2::ZERO);
        for _ in 0..CONTACTS_MAX {
            let Some(direction) = (target_m - at_m).try_normalize() else { return at_m };
            let Some(Contact { after_m, normal }) = self.first_contact(at_m, target_m, reach_m) else {
                return target_m;
            };
            at_m += after_m * direction;
            let left_m = target_m - at_m;
            let along_m = left_m - left_m.dot(normal).min(0.0) * normal;
            // Between two walls that close in there is no direction to slide in.
            if along_m.dot(before) < -TOUCH_M {
                return at_m;
            }
            (target_m, before) = (at_m + along_m, normal);
        }
        at_m
    }

    /// The first edge that a disc meets on a straight path, or nears while it touches it.
    fn first_contact(&self, from_m: Vec2, to_m: Vec2, reach_m: f32) -> Option<Contact> {
        let length_m = (to_m - from_m).length();
        let direction = (to_m - from_m) / length_m;
        let mut first: Option<Contact> = None;
        for edge in self.near(from_m, to_m, reach_m) {
            let to_edge_m = self.offset_to_m(edge, from_m);
            let after_m = if to_edge_m.length() > reach_m + TOUCH_M {
                disc_with_segment(self.ends_m(edge).map(|end_m| end_m - from_m), direction, reach_m)
            } else if -length_m * direction.dot(self.normal(edge, to_edge_m)) > TOUCH_M {
                0.0
            } else {
                f32::INFINITY
            };
            if after_m < first.map_or(length_m, |first| first.after_m) && !self.walls.surrounds(edge, self.from_m) {
                let to_edge_m = self.offset_to_m(edge, from_m + after_m * direction);
                first = Some(Contact { after_m, normal: self.normal(edge, to_edge_m) });
            }
        }
        first
    }

    /// The edges that may come within reach of a path; an edge may come more than once.
    fn near(&self, from_m: Vec2, to_m: Vec2, reach_m: f32) -> impl Iterator<Item = u32> {
        let [least_m, most_m] = [from_m.min(to_m) - reach_m, from_m.max(to_m) + reach_m];
        self.walls.grid.within(self.from_m + least_m, self.from_m + most_m)
    }

    fn ends_m(&self, edge: u32) -> [Vec2; 2] {
        self.walls.ends_m(edge).map(|end_m| end_m - self.from_m)
    }

    /// From a position to the nearest point of an edge, m.
    fn offset_to_m(&self, edge: u32, at_m: Vec2) -> Vec2 {
        let [from_m, to_m] = self.ends_m(edge);
        nearest_on_segment(at_m, from_m, to_m) - at_m
    }

    /// Unit vector from an edge to a position, given the vector from the position to the edge, m; outward where the
    /// position lies on the edge.
    fn normal(&self, edge: u32, to_edge_m: Vec2) -> Vec2 {
        (-to_edge_m).try_normalize().unwrap_or_else(|| -self.walls.corners[edge as usize].direction.perp())
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::maths::random::SplitMix64;
    use crate::world::obstacles::polygons::tests::l_and_block;

    const RADIUS_M: f32 = 0.25;

    fn rectangle(least: [f32; 2], most: [f32; 2]) -> Vec<Vec2> {
        [[least[0], least[1]], [most[0], least[1]], [most[0], most[1]], [least[0], most[1]]].map(Vec2::from).to_vec()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn a_disc_that_overlaps_walls_is_pushed_out(x in -1.0f32..5.0, y in -1.0f32..4.0) {
            let (obstacles, position_m) = (l_and_block(), Vec2::new(x, y));
            let pushed_m = obstacles.clamp_path(position_m, position_m, RADIUS_M);
            let free = obstacles.depth_m(position_m, RADIUS_M + SKIN_M) == 0.0;
            prop_assert!(!free || pushed_m == position_m);
            // In the gap of 0.3 m it stays; inside a polygon nothing holds it.
            let in_the_gap = (2.9..3.5).contains(&x) && (-0.3..1.3).contains(&y);
            let inside = obstacles.contains(position_m);
            prop_assert!(inside || !obstacles.contains(pushed_m), "{position_m} ends inside at {pushed_m}");
            prop_assert!(inside || in_the_gap || obstacles.depth_m(pushed_m, RADIUS_M) == 0.0, "{position_m} {pushed_m}");
        }

        #[test]
        fn a_disc_inside_a_wall_or_its_radius_can_leave(x in -1.0f32..5.0, y in -1.0f32..4.0) {
            let obstacles = l_and_block();
            let mut position_m = Vec2::new(x, y);
            let (mut step, out) = (0, Vec2::new(3.15, if y < 0.5 { -2.0 } else { 5.0 }));
            // Through the gap of 0.3 m where it starts in it; elsewhere straight up or down.
            while obstacles.depth_m(position_m, RADIUS_M) > 0.0 && step < 400 {
                let towards_m = if (3.0..3.3).contains(&x) { out } else { Vec2::new(position_m.x, out.y) };
                let to_m = position_m + 0.03 * (towards_m - position_m).normalize();
                position_m = obstacles.clamp_path(position_m, to_m, RADIUS_M);
                step += 1;
            }
            prop_assert!(step < 400, "{x} {y} is still at {position_m}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]

        #[test]
        fn no_path_crosses_a_wall_however_far_and_thin(
            x in -1.0f32..5.0, y in -1.0f32..4.0, east in -30.0f32..30.0, north in -30.0f32..30.0, thin in 0.001f32..0.3,
        ) {
            let wall = |x: f32| rectangle([x, -9.0], [x + thin, 9.0]);
            let obstacles = Obstacles::new(&[wall(1.0), wall(2.0), wall(2.2)]);
            let from_m = Vec2::new(x, y);
            prop_assume!(!obstacles.contains(from_m));
            let ended_m = obstacles.clamp_path(from_m, from_m + Vec2::new(east, north), RADIUS_M);
            prop_assert!(!obstacles.contains(ended_m));
            let room = |at_m: Vec2| [1.0, 2.0, 2.2].iter().filter(|&&x| at_m.x > x + 0.5 * thin).count();
            let beyond_the_ends = ended_m.y.abs() > 9.0;
            prop_assert!(beyond_the_ends || room(from_m) == room(ended_m), "{from_m} {ended_m}");
        }

        #[test]
        fn a_path_ends_where_small_steps_end(x in -1.0f32..5.0, y in -1.0f32..4.0, angle in -3.2f32..3.2) {
            let (obstacles, from_m) = (l_and_block(), Vec2::new(x, y));
            if obstacles.depth_m(from_m, RADIUS_M + SKIN_M) > 0.0 {
                return Ok(());
            }
            let to_m = from_m + 0.3 * Vec2::from_angle(angle);
            let ended_m = obstacles.clamp_path(from_m, to_m, RADIUS_M);
            let direct = (0..=100).all(|step| {
                obstacles.depth_m(from_m.lerp(to_m, step as f32 * 0.01), RADIUS_M + SKIN_M) == 0.0
            });
            prop_assert!(!direct || ended_m.distance(to_m) < 1e-3, "{from_m} {to_m} {ended_m}");
            prop_assert!(obstacles.depth_m(ended_m, RADIUS_M) == 0.0, "{from_m} {to_m} {ended_m}");
        }
    }

    /// A wall with a door, turned about the door's middle and moved; both posts are polygons.
    struct Door {
        obstacles: Obstacles,
        middle_m: Vec2,
        /// Unit vector through the door.
        through: Vec2,
    }

    impl Door {
        fn new(width_m: f32, random: &mut SplitMix64) -> Self {
            let thick_m = 0.01 + random.within(0.3).abs() as f32;
            let middle_m = Vec2::new(random.within(100.0) as f32, random.within(100.0) as f32);
            let through = Vec2::from_angle(random.within(3.15) as f32);
            let posts_m = [
                rectangle([-thick_m, 0.5 * width_m], [thick_m, 6.0]),
                rectangle([-thick_m, -6.0], [thick_m, -0.5 * width_m]),
            ];
            let posts_m = posts_m
                .map(|post_m| post_m.iter().map(|corner_m| middle_m + through.rotate(*corner_m)).collect::<Vec<_>>());
            Self { obstacles: Obstacles::new(&posts_m), middle_m, through }
        }

        /// Walks a disc at the door in long and short, straight and stray steps; returns whether it gets through.
        fn is_passed(&self, radius_m: f32, stray: f64, random: &mut SplitMix64) -> bool {
            let ahead_m = |position_m: Vec2| (position_m - self.middle_m).dot(self.through);
            let mut position_m =
                self.middle_m - 1.2 * self.through + 0.5 * random.within(1.0) as f32 * self.through.perp();
            for _ in 0..120 {
                let step_m = 0.01 + random.within(0.3).abs() as f32;
                let towards = (self.middle_m + 0.05 * self.through - position_m).normalize_or(self.through);
                let towards = if ahead_m(position_m) > -0.05 { self.through } else { towards };
                let turn = Vec2::from_angle(random.within(stray) as f32);
                let ended_m =
                    self.obstacles.clamp_path(position_m, position_m + step_m * turn.rotate(towards), radius_m);
                assert!(!self.obstacles.contains(ended_m) && self.obstacles.depth_m(ended_m, radius_m) < 1e-4);
                position_m = ended_m;
                if ahead_m(position_m) > 0.7 {
                    return true;
                }
            }
            ahead_m(position_m) > 0.0
        }
    }

    #[test]
    fn a_door_is_open_to_the_discs_that_fit() {
        let mut random = SplitMix64::new(1, 0);
        for _ in 0..10_000 {
            let radius_m = 0.1 + random.within(0.2).abs() as f32;
            let share = random.within(1.0).abs() as f32;
            let narrow = Door::new(2.0 * radius_m * share.max(0.05), &mut random);
            assert!(!narrow.is_passed(radius_m, 1.5, &mut random), "{radius_m} passes a door of {share} of its width");
            let wide = Door::new(2.0 * radius_m + 0.05, &mut random);
            assert!(wide.is_passed(radius_m, 0.3, &mut random), "{radius_m} does not pass");
        }
    }
}
