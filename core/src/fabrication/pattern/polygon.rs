//! Polylines in the plane: area, simplification, offset, crossings.

/// A point, mm.
pub type Point = [f64; 2];

/// Longest mitre, as a multiple of the distance by which an outline is moved; sharper corners are cut off.
const MITRE_LIMIT: f64 = 4.0;

/// Signed area of a closed polygon, mm^2: positive counter-clockwise.
#[must_use]
pub fn area(points: &[Point]) -> f64 {
    let next = points.iter().cycle().skip(1);
    0.5 * points.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>()
}

/// Drops points that are closer than `tolerance` to the line between those that stay (Ramer 1972, Douglas and Peucker
/// 1973). The ends stay.
#[must_use]
pub fn simplified(points: &[Point], tolerance: f64) -> Vec<Point> {
    let mut keep = vec![false; points.len()];
    let mut pieces = vec![(0, points.len().saturating_sub(1))];
    while let Some((from, to)) = pieces.pop() {
        let (Some(&a), Some(&b)) = (points.get(from), points.get(to)) else { continue };
        (keep[from], keep[to]) = (true, true);
        let furthest = (from + 1..to)
            .map(|i| (distance_to_segment(points[i], a, b), i))
            .max_by(|x, y| x.0.total_cmp(&y.0).then(y.1.cmp(&x.1)));
        if let Some((distance, i)) = furthest
            && distance > tolerance
        {
            pieces.extend([(from, i), (i, to)]);
        }
    }
    points.iter().zip(keep).filter(|(_, keep)| *keep).map(|(point, _)| *point).collect()
}

fn distance_to_segment(p: Point, a: Point, b: Point) -> f64 {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let length = dx * dx + dy * dy;
    let t = if length > 0.0 { (((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / length).clamp(0.0, 1.0) } else { 0.0 };
    (p[0] - a[0] - t * dx).hypot(p[1] - a[1] - t * dy)
}

/// Moves a polyline to its right by `distance` (outward for a counter-clockwise polygon), with mitred corners.
///
/// Every segment is moved along its normal and neighbours are extended to where they meet:
///
/// ```text
/// p' = p + d (n1 + n2) / (1 + n1 . n2)
/// ```
///
/// Corners whose mitre would be longer than four times `distance` are cut off square. Zero-length segments are skipped.
#[must_use]
pub fn offset(points: &[Point], distance: f64, closed: bool) -> Vec<Point> {
    let mut clean: Vec<Point> = Vec::with_capacity(points.len());
    for point in points {
        if clean.last() != Some(point) {
            clean.push(*point);
        }
    }
    if closed && clean.len() > 1 && clean.first() == clean.last() {
        clean.pop();
    }
    let n = clean.len();
    if n < 2 || distance == 0.0 {
        return clean;
    }
    let normal = |i: usize| {
        let (a, b) = (clean[i % n], clean[(i + 1) % n]);
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let length = dx.hypot(dy);
        [dy / length, -dx / length]
    };
    let mut moved = Vec::with_capacity(n + 8);
    for (i, p) in clean.iter().enumerate() {
        let before = if closed || i > 0 { normal((i + n - 1) % n) } else { normal(0) };
        let after = if closed || i + 1 < n { normal(i) } else { before };
        let cosine = before[0] * after[0] + before[1] * after[1];
        let turns_out = before[0] * after[1] - before[1] * after[0] > 0.0;
        // The mitre is 1 / cos(half the turn) long: 2 / (1 + cosine) squared.
        if turns_out && 2.0 > MITRE_LIMIT * MITRE_LIMIT * (1.0 + cosine) {
            // Square: half the distance further on along each side.
            for (side, along) in [(before, [-before[1], before[0]]), (after, [after[1], -after[0]])] {
                moved.push(std::array::from_fn(|k| p[k] + distance * (side[k] + along[k])));
            }
            continue;
        }
        let scale = distance / (1.0 + cosine).max(1e-9);
        moved.push(std::array::from_fn(|k| p[k] + scale * (before[k] + after[k])));
    }
    moved
}

/// Two segments of a closed polygon that cross or touch without being neighbours, by their first points; `None` for a
/// simple polygon.
///
/// Segments are swept by their least x, so that only those whose ranges of x overlap are compared.
#[must_use]
pub fn crossing(points: &[Point]) -> Option<(usize, usize)> {
    let n = points.len();
    let segment = |i: usize| (points[i], points[(i + 1) % n]);
    let range = |i: usize| {
        let (a, b) = segment(i);
        (a[0].min(b[0]), a[0].max(b[0]))
    };
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|i, j| range(*i).0.total_cmp(&range(*j).0));
    let mut active: Vec<usize> = Vec::new();
    for &i in &order {
        let (left, _) = range(i);
        active.retain(|j| range(*j).1 >= left);
        for &j in &active {
            let neighbours = (i + 1) % n == j || (j + 1) % n == i;
            if !neighbours && meet(segment(i), segment(j)) {
                return Some((i.min(j), i.max(j)));
            }
        }
        active.push(i);
    }
    None
}

fn meet((a, b): (Point, Point), (c, d): (Point, Point)) -> bool {
    let side = |p: Point, q: Point, r: Point| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    let (s, t, u, v) = (side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b));
    let within = |p: Point, q: Point, r: Point| (0..2).all(|k| r[k] >= p[k].min(q[k]) && r[k] <= p[k].max(q[k]));
    (s * t < 0.0 && u * v < 0.0)
        || (s == 0.0 && within(a, b, c))
        || (t == 0.0 && within(a, b, d))
        || (u == 0.0 && within(c, d, a))
        || (v == 0.0 && within(c, d, b))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [Point; 4] = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]];

    #[test]
    fn a_square_grows_by_its_perimeter_and_keeps_its_corners() {
        let grown = offset(&SQUARE, 0.5, true);
        assert_eq!(grown, [[-0.5, -0.5], [10.5, -0.5], [10.5, 10.5], [-0.5, 10.5]]);
        assert!((area(&grown) - 121.0).abs() < 1e-12 && crossing(&grown).is_none());
        assert_eq!(area(&offset(&SQUARE, -0.5, true)), 81.0);
        let open = offset(&SQUARE[..3], 0.5, false);
        assert_eq!(open, [[0.0, -0.5], [10.5, -0.5], [10.5, 10.0]]);
    }

    #[test]
    fn a_needle_is_cut_off_square_and_a_bow_tie_found() {
        let needle = [[0.0, -0.1], [10.0, 0.0], [0.0, 0.1]];
        let moved = offset(&needle, 1.0, true);
        assert!(moved.iter().all(|p| p[0] < 11.1), "{moved:?}");
        assert!(crossing(&moved).is_none());
        assert_eq!(crossing(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]), Some((0, 2)));
        assert!(crossing(&SQUARE).is_none());
    }

    #[test]
    fn a_circle_is_thinned_to_what_the_tolerance_allows() {
        let circle: Vec<Point> = (0..=1000).map(|i| (f64::from(i) * 0.003).sin_cos()).map(|(y, x)| [x, y]).collect();
        let thin = simplified(&circle, 1e-4);
        assert!(thin.len() < 130 && thin.len() > 50, "{}", thin.len());
        assert_eq!((thin[0], thin[thin.len() - 1]), (circle[0], circle[1000]));
        // A chord of length c is c^2/8 off a unit circle.
        for pair in thin.windows(2) {
            let chord = (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]);
            assert!(chord * chord / 8.0 < 1.01e-4);
        }
    }
}
