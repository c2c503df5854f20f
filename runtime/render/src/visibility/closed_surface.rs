//! Which triangles of a mesh belong to closed surfaces that face outwards: from outside, their backs are never seen.
//!
//! Triangles that share points are one surface. It is closed where each edge is passed as often in one direction as in the
//! other, and faces outwards where it encloses a positive volume.

use glam::Vec3;

/// Whether each triangle belongs to a closed surface. Triangles have points as corners, counter-clockwise seen from their
/// front; `at_m` is the position of a point. Points that can move apart are different points.
pub(crate) fn closed_triangles(triangles: &[[u32; 3]], points: usize, at_m: impl Fn(usize) -> Vec3) -> Vec<bool> {
    let surface_of = surfaces(triangles, points);
    let mut is_closed = vec![true; points];
    let mut volumes_m3 = vec![0.0; points];
    let mut edges = Vec::with_capacity(3 * triangles.len());
    for corners in triangles {
        let [a_m, b_m, c_m] = corners.map(|corner| at_m(corner as usize).as_dvec3());
        volumes_m3[surface_of[corners[0] as usize] as usize] += a_m.dot(b_m.cross(c_m));
        for [from, to] in [[0, 1], [1, 2], [2, 0]].map(|ends: [usize; 2]| ends.map(|end| corners[end])) {
            edges.push(if from < to { ([from, to], 1) } else { ([to, from], -1) });
        }
    }
    edges.sort_unstable();
    for passes in edges.chunk_by(|one, other| one.0 == other.0) {
        let [from, to] = passes[0].0;
        if from != to && passes.iter().map(|pass| pass.1).sum::<i32>() != 0 {
            is_closed[surface_of[from as usize] as usize] = false;
        }
    }
    let is_outward = |surface: usize| is_closed[surface] && volumes_m3[surface] > 0.0;
    triangles.iter().map(|corners| is_outward(surface_of[corners[0] as usize] as usize)).collect()
}

/// The surface of each point: the least point that triangles connect it with.
fn surfaces(triangles: &[[u32; 3]], points: usize) -> Vec<u32> {
    let mut least: Vec<u32> = (0..points as u32).collect();
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| root(&mut least, corner));
        let first = a.min(b).min(c);
        [a, b, c].into_iter().for_each(|other| least[other as usize] = first);
    }
    (0..points as u32).map(|point| root(&mut least, point)).collect()
}

/// The least point that is known of a point's surface; halves the path to it.
fn root(least: &mut [u32], mut point: u32) -> u32 {
    while least[point as usize] != point {
        let next = least[least[point as usize] as usize];
        least[point as usize] = next;
        point = next;
    }
    point
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS_M: [Vec3; 4] = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

    fn closed(triangles: &[[u32; 3]]) -> Vec<bool> {
        closed_triangles(triangles, 8, |point| CORNERS_M[point % 4])
    }

    #[test]
    fn a_tetrahedron_is_closed_unless_a_side_is_missing() {
        assert_eq!(closed(&TETRAHEDRON), [true; 4]);
        assert_eq!(closed(&TETRAHEDRON[1..]), [false; 3]);
    }

    #[test]
    fn surfaces_count_apart() {
        let open = TETRAHEDRON[1..].iter().map(|corners| corners.map(|corner| corner + 4));
        let both: Vec<[u32; 3]> = TETRAHEDRON.into_iter().chain(open).collect();
        assert_eq!(closed(&both), [true, true, true, true, false, false, false]);
    }

    #[test]
    fn surfaces_that_face_inwards_show_both_sides() {
        assert_eq!(closed(&TETRAHEDRON.map(|[a, b, c]| [a, c, b])), [false; 4]);
        let mut turned = TETRAHEDRON;
        turned[2].swap(0, 1);
        assert_eq!(closed(&turned), [false; 4]);
    }

    #[test]
    fn triangles_without_area_do_not_count() {
        let mut folded = TETRAHEDRON.to_vec();
        folded.push([1, 1, 2]);
        assert_eq!(closed(&folded), [true; 5]);
        assert!(closed(&[]).is_empty());
    }
}
