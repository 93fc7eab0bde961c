//! Triangles of planar convex polygons that may have vertices within their sides.

/// Triangulates a convex polygon of `n` vertices, some of which may lie within its sides, into `n - 2` triangles, none of
/// them flat; every vertex is used. `turns(i, j, k)` tells whether the vertices `i`, `j`, `k` turn counter-clockwise
/// (strictly), for a polygon given counter-clockwise.
///
/// Ears are cut at true corners; while there are vertices within sides, at corners beside one of them, so that what is left
/// never collapses into a line.
pub fn convex(n: usize, turns: impl Fn(usize, usize, usize) -> bool, mut triangle: impl FnMut([usize; 3])) {
    let mut ring: Vec<usize> = (0..n).collect();
    let is_corner = |ring: &[usize], k: usize| {
        let m = ring.len();
        turns(ring[(k + m - 1) % m], ring[k], ring[(k + 1) % m])
    };
    let mut corners: Vec<bool> = (0..n).map(|k| is_corner(&ring, k)).collect();
    let mut flat = corners.iter().filter(|c| !**c).count();
    let mut at = 0;
    while flat > 0 && ring.len() > 3 {
        let m = ring.len();
        // A corner beside a vertex within a side, walking on from the last one.
        let Some(k) = (0..m)
            .map(|step| (at + step) % m)
            .find(|k| corners[*k] && (!corners[(k + m - 1) % m] || !corners[(k + 1) % m]))
        else {
            break;
        };
        let (before, after) = ((k + m - 1) % m, (k + 1) % m);
        triangle([ring[before], ring[k], ring[after]]);
        // Its neighbours are true corners now.
        for neighbour in [before, after] {
            if !corners[neighbour] {
                corners[neighbour] = true;
                flat -= 1;
            }
        }
        ring.remove(k);
        corners.remove(k);
        at = if k == 0 { 0 } else { k - 1 };
    }
    for k in 1..ring.len().saturating_sub(1) {
        triangle([ring[0], ring[k], ring[k + 1]]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Point = [i32; 2];

    fn cross(a: Point, b: Point, c: Point) -> i32 {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    }

    /// A rectangle with vertices within its sides.
    fn rectangle(counts: [i32; 4]) -> Vec<Point> {
        let corners = [[0, 0], [120, 0], [120, 60], [0, 60]];
        let mut points = Vec::new();
        for side in 0..4 {
            let (a, b) = (corners[side], corners[(side + 1) % 4]);
            let parts = counts[side] + 1;
            points.extend((0..parts).map(|k| [a[0] + (b[0] - a[0]) * k / parts, a[1] + (b[1] - a[1]) * k / parts]));
        }
        points
    }

    #[test]
    fn every_vertex_is_used_no_triangle_is_flat_and_they_fill_the_polygon() {
        let sides = [[0, 0, 0, 0], [3, 0, 0, 0], [1, 0, 2, 0], [2, 1, 5, 3], [0, 4, 0, 4], [0, 0, 0, 1], [5, 5, 5, 5]];
        let triangle = vec![[0, 0], [40, 0], [80, 0], [120, 0], [0, 60]];
        let both = vec![[0, 0], [60, 0], [120, 0], [60, 30], [0, 60], [0, 20]];
        for points in sides.map(rectangle).into_iter().chain([triangle, both]) {
            let n = points.len();
            let (mut area, mut used, mut count) = (0, vec![false; n], 0);
            let turns = |i: usize, j: usize, k: usize| cross(points[i], points[j], points[k]) > 0;
            convex(n, turns, |t| {
                let twice = cross(points[t[0]], points[t[1]], points[t[2]]);
                assert!(twice > 0, "{points:?} {t:?}");
                area += twice;
                count += 1;
                t.iter().for_each(|k| used[*k] = true);
            });
            let whole: i32 = (1..n - 1).map(|k| cross(points[0], points[k], points[k + 1])).sum();
            assert_eq!((area, count), (whole, n - 2), "{points:?}");
            assert!(used.iter().all(|u| *u));
        }
    }
}
