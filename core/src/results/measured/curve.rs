//! Plane curves as polylines: positions along them, and the nearest of their points.

/// Segments under one bounding circle.
const CHUNK: usize = 24;

/// A curve `(x, z)` over its arc length `s`, rim first.
#[derive(Debug, Clone)]
pub(super) struct Curve {
    s: Vec<f64>,
    points: Vec<[f64; 2]>,
    /// Centre and radius of circles around [`CHUNK`] segments each.
    circles: Vec<([f64; 2], f64)>,
}

/// The point of a curve nearest to another point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Foot {
    /// Arc length of the nearest point.
    pub s: f64,
    /// From the nearest point to the other one.
    pub offset: [f64; 2],
    /// Unit normal of the curve there: the tangent turned to the left, which is upward where `x` grows.
    pub normal: [f64; 2],
    /// How far the other point lies beyond an end of the curve, along its tangent; 0 between the ends.
    pub beyond: f64,
}

impl Curve {
    /// A curve of at least two points; points without distance from the one before are left out.
    pub fn new(stations: impl IntoIterator<Item = [f64; 3]>) -> Option<Self> {
        let (mut s, mut points) = (Vec::new(), Vec::<[f64; 2]>::new());
        for [along, x, z] in stations {
            if points.last().is_none_or(|p| (p[0] - x).hypot(p[1] - z) > 0.0) {
                s.push(along);
                points.push([x, z]);
            }
        }
        if points.len() < 2 {
            return None;
        }
        let circles = (0..points.len() - 1)
            .step_by(CHUNK)
            .map(|i| {
                let part = &points[i..=(i + CHUNK).min(points.len() - 1)];
                let n = part.len() as f64;
                let centre = [0, 1].map(|k| part.iter().map(|p| p[k]).sum::<f64>() / n);
                let radius = part.iter().map(|p| (p[0] - centre[0]).hypot(p[1] - centre[1])).fold(0.0, f64::max);
                (centre, radius)
            })
            .collect();
        Some(Self { s, points, circles })
    }

    /// Position at an arc length, clamped to the curve.
    pub fn position(&self, s: f64) -> [f64; 2] {
        let i = self.s.partition_point(|v| *v <= s).clamp(1, self.s.len() - 1) - 1;
        let u = ((s - self.s[i]) / (self.s[i + 1] - self.s[i])).clamp(0.0, 1.0);
        [0, 1].map(|k| self.points[i][k] + u * (self.points[i + 1][k] - self.points[i][k]))
    }

    /// Unit normal at an arc length.
    pub fn normal(&self, s: f64) -> [f64; 2] {
        let i = self.s.partition_point(|v| *v <= s).clamp(1, self.s.len() - 1) - 1;
        self.segment_normal(i)
    }

    /// The last point.
    pub fn end(&self) -> [f64; 2] {
        self.points[self.points.len() - 1]
    }

    /// All points.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    fn segment_normal(&self, i: usize) -> [f64; 2] {
        let (a, b) = (self.points[i], self.points[i + 1]);
        let (dx, dz) = (b[0] - a[0], b[1] - a[1]);
        let length = dx.hypot(dz);
        [-dz / length, dx / length]
    }

    /// The point nearest to `q`.
    pub fn nearest(&self, q: [f64; 2]) -> Foot {
        let bound = |(centre, radius): &([f64; 2], f64)| (q[0] - centre[0]).hypot(q[1] - centre[1]) - radius;
        let first =
            (0..self.circles.len()).min_by(|a, b| bound(&self.circles[*a]).total_cmp(&bound(&self.circles[*b])));
        let first = first.unwrap_or(0);
        let mut best = (f64::INFINITY, 0, 0.0);
        self.search(first, q, &mut best);
        for chunk in (0..self.circles.len()).filter(|c| *c != first) {
            if bound(&self.circles[chunk]) < best.0.sqrt() {
                self.search(chunk, q, &mut best);
            }
        }
        let (_, i, u) = best;
        let (a, b) = (self.points[i], self.points[i + 1]);
        let foot = [0, 1].map(|k| a[k] + u.clamp(0.0, 1.0) * (b[k] - a[k]));
        let offset = [q[0] - foot[0], q[1] - foot[1]];
        let normal = self.segment_normal(i);
        let at_end = (i == 0 && u < 0.0) || (i + 2 == self.points.len() && u > 1.0);
        let beyond = if at_end { (offset[0] * normal[1] - offset[1] * normal[0]).abs() } else { 0.0 };
        Foot { s: self.s[i] + u.clamp(0.0, 1.0) * (self.s[i + 1] - self.s[i]), offset, normal, beyond }
    }

    /// Improves the best squared distance, segment and place on its line by those of a chunk.
    fn search(&self, chunk: usize, q: [f64; 2], best: &mut (f64, usize, f64)) {
        let end = ((chunk + 1) * CHUNK).min(self.points.len() - 1);
        for i in chunk * CHUNK..end {
            let (a, b) = (self.points[i], self.points[i + 1]);
            let (dx, dz, px, pz) = (b[0] - a[0], b[1] - a[1], q[0] - a[0], q[1] - a[1]);
            let u = (px * dx + pz * dz) / (dx * dx + dz * dz);
            let t = u.clamp(0.0, 1.0);
            let (ex, ez) = (px - t * dx, pz - t * dz);
            let square = ex * ex + ez * ez;
            if square < best.0 {
                *best = (square, i, u);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quarter() -> Curve {
        Curve::new((0..=300).map(|i| {
            let q = f64::to_radians(0.3 * f64::from(i));
            [10.0 * q, 10.0 * (1.0 - q.cos()), 10.0 * q.sin()]
        }))
        .unwrap()
    }

    #[test]
    fn the_nearest_point_of_a_quarter_circle_lies_on_the_radius() {
        let curve = quarter();
        for (angle, radius) in [(5.0, 12.0), (44.0, 9.0), (89.0, 10.5), (31.0, 10.0)] {
            let q = f64::to_radians(angle);
            let foot = curve.nearest([10.0 - radius * q.cos(), radius * q.sin()]);
            assert!((foot.s - 10.0 * q).abs() < 1e-2, "{foot:?}");
            let out = foot.offset[0] * foot.normal[0] + foot.offset[1] * foot.normal[1];
            assert!((out - (radius - 10.0)).abs() < 1e-3 && foot.beyond == 0.0, "{foot:?}");
        }
    }

    #[test]
    fn what_lies_beyond_an_end_says_so() {
        let foot = quarter().nearest([0.5, -2.0]);
        assert!(foot.s == 0.0 && (foot.beyond - 2.0).abs() < 0.01, "{foot:?}");
        assert!(Curve::new([[0.0, 1.0, 1.0], [1.0, 1.0, 1.0]]).is_none());
    }
}
