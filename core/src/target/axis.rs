//! Where the axis of a surface of revolution may lie.
//!
//! Two sources of candidates, each weak where the other is strong:
//!
//! - *Moments*: the centroid of a full revolution lies on its axis, and the axis is an eigenvector of the tensor of second
//!   moments of area about it. Triangles count by area, so uneven meshes do no harm, and noise averages out. A part of a
//!   turn has its moments elsewhere, and three equal moments leave the direction open.
//! - *Normals*: all normals of a surface of revolution meet its axis. The linear complex `n . c' + (p x n) . c` that fits
//!   the normals `n` at points `p` best (H. Pottmann, T. Randrup, "Rotational and helical surface approximation for
//!   reverse engineering", Computing 60, 1998) has the direction `c` and passes through `c x c' / c^2`. Parts of a turn
//!   are no obstacle; noise is, and on spheres every axis through the centre fits.

use nalgebra::{Matrix2, Matrix3, SymmetricEigen, Vector2, Vector3};

use super::error::TargetError;
use super::triangle_mesh::Welder;
use crate::progress::{Cancelled, stops_at};

/// The axis about which a mesh is taken to be a surface of revolution.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Axis {
    /// Found from the mesh, which must go all the way round; the wider end, the rim, is the lower one.
    #[default]
    Auto,
    /// Parallel to x; position found from the mesh, the wider end is the lower one.
    X,
    /// Parallel to y; position found from the mesh, the wider end is the lower one.
    Y,
    /// Parallel to z; position found from the mesh, the wider end is the lower one.
    Z,
    /// Parallel to this vector, which points from the rim to the apex; position found from the mesh.
    Vector([f64; 3]),
}

impl Axis {
    /// The unit vector along a given axis, `None` for [`Axis::Auto`].
    pub(super) fn direction(self) -> Result<Option<Vector3<f64>>, TargetError> {
        let vector = match self {
            Self::Auto => return Ok(None),
            Self::X => [1.0, 0.0, 0.0],
            Self::Y => [0.0, 1.0, 0.0],
            Self::Z => [0.0, 0.0, 1.0],
            Self::Vector(vector) => vector,
        };
        // Scaled first: squares of very small or large components vanish or overflow.
        let largest = vector.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
        let scaled = Vector3::from(vector) / largest;
        match scaled.try_normalize(0.5) {
            Some(unit) if unit.iter().all(|c| c.is_finite()) => Ok(Some(unit)),
            _ => Err(TargetError::NoDirection { axis: vector }),
        }
    }
}

/// A line with two unit vectors across it: `u`, `v` and `direction` are right-handed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Frame {
    pub point: Vector3<f64>,
    pub direction: Vector3<f64>,
    pub u: Vector3<f64>,
    pub v: Vector3<f64>,
}

impl Frame {
    /// `direction` must not be zero.
    pub fn new(point: Vector3<f64>, direction: Vector3<f64>) -> Self {
        let direction = direction.normalize();
        let u = direction.cross(&Vector3::ith(direction.iamin(), 1.0)).normalize();
        Self { point, direction, u, v: direction.cross(&u) }
    }

    /// Coordinates across the axis and along it.
    pub fn local(&self, p: &Vector3<f64>) -> [f64; 3] {
        let d = p - self.point;
        [d.dot(&self.u), d.dot(&self.v), d.dot(&self.direction)]
    }
}

/// A mesh with equal vertices joined, moved to its centroid and scaled to a mean square extent of 1.
#[derive(Clone)]
pub(super) struct Surface<'a> {
    pub vertices: Vec<Vector3<f64>>,
    pub triangles: Vec<[u32; 3]>,
    /// What to add, after multiplying by `size`, to get back to the mesh's own coordinates.
    pub centre: Vector3<f64>,
    pub size: f64,
    pub cancelled: Cancelled<'a>,
}

impl<'a> Surface<'a> {
    /// Takes a mesh that passed the checks; triangles without area are left out.
    pub fn new(vertices: &[[f64; 3]], triangles: &[[u32; 3]], cancelled: Cancelled<'a>) -> Result<Self, TargetError> {
        let mut welder = Welder::default();
        let mut indices = vec![u32::MAX; vertices.len()];
        let mut joined = Vec::with_capacity(triangles.len());
        for (i, triangle) in triangles.iter().enumerate() {
            if stops_at(i, cancelled) {
                return Err(TargetError::Cancelled);
            }
            let mut corners = [0; 3];
            for (corner, &i) in corners.iter_mut().zip(triangle) {
                let (Some(index), Some(&position)) = (indices.get_mut(i as usize), vertices.get(i as usize)) else {
                    continue;
                };
                if *index == u32::MAX {
                    *index = welder.index(position)?;
                }
                *corner = *index;
            }
            let [a, b, c] = corners;
            if a != b && b != c && c != a {
                joined.push(corners);
            }
        }
        let mut surface = Self {
            vertices: welder.vertices.into_iter().map(Vector3::from).collect(),
            triangles: joined,
            centre: Vector3::zeros(),
            size: 1.0,
            cancelled,
        };
        let empty = TargetError::EmptyMesh { vertices: vertices.len(), triangles: 0 };
        // Once to come near the origin and to a size of one, once more for the digits lost on the way.
        for _ in 0..2 {
            let (area, centroid, moments) = surface.moments()?;
            let size = (moments.trace() / area).sqrt();
            if !(area > 0.0 && size.is_finite() && size > 0.0) {
                return Err(empty);
            }
            surface.vertices.iter_mut().for_each(|p| *p = (*p - centroid) / size);
            surface.centre += centroid * surface.size;
            surface.size *= size;
        }
        Ok(surface)
    }

    /// Whether work goes on.
    ///
    /// # Errors
    ///
    /// [`TargetError::Cancelled`].
    pub fn go_on(&self) -> Result<(), TargetError> {
        if (self.cancelled)() { Err(TargetError::Cancelled) } else { Ok(()) }
    }

    /// The corners of every triangle, unless work is cancelled meanwhile.
    fn for_each_triangle(&self, mut work: impl FnMut([Vector3<f64>; 3])) -> Result<(), TargetError> {
        for (i, triangle) in self.triangles.iter().enumerate() {
            if stops_at(i, self.cancelled) {
                return Err(TargetError::Cancelled);
            }
            work(self.corners(triangle));
        }
        Ok(())
    }

    pub fn corners(&self, triangle: &[u32; 3]) -> [Vector3<f64>; 3] {
        triangle.map(|i| self.vertices.get(i as usize).copied().unwrap_or_default())
    }

    /// Area, centroid and second moments about it. For a triangle
    /// `int p p^T dA = A/12 (sum v_i v_i^T + (sum v_i)(sum v_i)^T)`.
    fn moments(&self) -> Result<(f64, Vector3<f64>, Matrix3<f64>), TargetError> {
        let origin = self.vertices.first().copied().unwrap_or_default();
        let (mut area, mut first, mut second) = (0.0, Vector3::zeros(), Matrix3::zeros());
        self.for_each_triangle(|corners| {
            let [a, b, c] = corners.map(|p| p - origin);
            let weight = 0.5 * (b - a).cross(&(c - a)).norm();
            let sum = a + b + c;
            area += weight;
            first += sum * (weight / 3.0);
            let products = a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose();
            second += products * (weight / 12.0);
        })?;
        let mean = first / area;
        Ok((area, origin + mean, second - mean * mean.transpose() * area))
    }

    /// Candidates without a given direction, the most trustworthy first.
    pub fn free_candidates(&self) -> Result<Vec<Frame>, TargetError> {
        let (_, centroid, moments) = self.moments()?;
        let eigen = SymmetricEigen::new(moments);
        let values = eigen.eigenvalues;
        // The axis is the one whose two others are nearest to each other.
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| {
            let split = |k: usize| (values[(k + 1) % 3] - values[(k + 2) % 3]).abs();
            split(i).total_cmp(&split(j))
        });
        let mut frames: Vec<Frame> =
            order.iter().map(|&k| Frame::new(centroid, eigen.eigenvectors.column(k).into())).collect();
        frames.extend(self.complex_axes()?);
        frames.retain(|f| f.direction.iter().chain(f.point.iter()).all(|c| c.is_finite()));
        Ok(frames)
    }

    /// Candidates along a given direction: through the centroid, and where the normals pass nearest.
    pub fn directed_candidates(&self, direction: Vector3<f64>) -> Result<Vec<Frame>, TargetError> {
        let (_, centroid, _) = self.moments()?;
        let frame = Frame::new(centroid, direction);
        let (mut normal, mut right) = (Matrix2::zeros(), Vector2::zeros());
        self.for_each_triangle(|[a, b, c]| {
            let n = (b - a).cross(&(c - a));
            // ((p - o) x n) . d = 0 with o = centroid + x u + y v; n weighs by twice the area.
            let p = (a + b + c) / 3.0 - centroid;
            let row = n.cross(&frame.direction);
            let row = Vector2::new(row.dot(&frame.u), row.dot(&frame.v));
            let weight = 1.0 / n.norm().max(f64::MIN_POSITIVE);
            normal += row * row.transpose() * weight;
            right += row * (p.cross(&n).dot(&frame.direction) * weight);
        })?;
        let mut frames = vec![frame];
        if let Some(shift) = normal.lu().solve(&right)
            && shift.iter().all(|x| x.is_finite() && x.abs() < 1e3)
        {
            frames.push(Frame { point: centroid + frame.u * shift.x + frame.v * shift.y, ..frame });
        }
        Ok(frames)
    }

    /// The axes of the linear complexes that fit the normals best and second best.
    fn complex_axes(&self) -> Result<Vec<Frame>, TargetError> {
        let (mut nn, mut nm, mut mm) = (Matrix3::zeros(), Matrix3::zeros(), Matrix3::zeros());
        self.for_each_triangle(|[a, b, c]| {
            let n = (b - a).cross(&(c - a));
            let weight = 1.0 / n.norm().max(f64::MIN_POSITIVE);
            let moment = ((a + b + c) / 3.0).cross(&n);
            nn += n * n.transpose() * weight;
            nm += n * moment.transpose() * weight;
            mm += moment * moment.transpose() * weight;
        })?;
        // For a given c the best c' is -nn^-1 nm c; what is left is a quadratic form in c.
        let Some(inverse) = nn.try_inverse() else { return Ok(Vec::new()) };
        let map = -inverse * nm;
        let left = mm + nm.transpose() * map;
        let eigen = SymmetricEigen::new((left + left.transpose()) * 0.5);
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
        let axis = |k: &usize| {
            let c: Vector3<f64> = eigen.eigenvectors.column(*k).into();
            Frame::new(c.cross(&(map * c)), c)
        };
        Ok(order.iter().take(2).map(axis).collect())
    }
}
