//! The surface of every phase in the small neighbourhood of a lattice vertex where voxels touch along an edge or a corner.
//!
//! There is one template a configuration of the eight octants. It holds closed polygons, which lie in the neighbourhood, and
//! *chains*: the ends, on this vertex's side, of polygons that reach to a neighbouring vertex (faces between voxels, the
//! walls of prisms, and strips of prisms that face void). Offsets from the vertex are in the unit of [`super::Scale`].
//!
//! A point of a phase's surface that lies on an edge of one of its polygons is a vertex of that polygon: nothing is left
//! that could become a T-junction.

use std::sync::{LazyLock, OnceLock};

use super::contact::{Contact, Octants, PHASES, Ray, SIZES, VOID, ray, size};

/// Offset from a vertex.
pub type Offset = [i8; 3];

/// A closed polygon and its outward normal (not of unit length).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Patch {
    /// Corners, in either order.
    pub corners: Vec<Offset>,
    /// Outward normal.
    pub normal: Offset,
}

/// One phase's surface around a vertex.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct PhaseTemplate {
    /// Corners of faces in lattice planes: by normal axis `n`, and by quadrant `u + 2 w` of the axes `u`, `w` that follow
    /// `n`; from the side along `u` to the side along `w`.
    pub faces: [[Vec<Offset>; 4]; 3],
    /// Ends of prisms' walls: by ray and position in [`Octants::around`].
    pub walls: [[Vec<Offset>; 4]; 6],
    /// Ends of prisms' strips that face void: by ray, by position in [`Octants::around`] of the voxel that lost them, and
    /// by which of the two axes across the ray they are normal to.
    pub strips: [[[Vec<Offset>; 2]; 4]; 6],
    /// Closed polygons.
    pub patches: Vec<Patch>,
}

/// The phases' surfaces around a vertex.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Template {
    /// What is done there.
    pub contact: Contact,
    /// One entry a phase.
    pub phases: [PhaseTemplate; PHASES],
}

static TEMPLATES: LazyLock<Vec<OnceLock<Option<Box<Template>>>>> =
    LazyLock::new(|| (0..=u16::MAX).map(|_| OnceLock::new()).collect());

/// The template of a configuration, see [`Octants::code`]; `None` where nothing has to be done.
#[must_use]
pub fn template(code: u16) -> Option<&'static Template> {
    TEMPLATES[usize::from(code)]
        .get_or_init(|| Contact::of(Octants::from_code(code)).map(|contact| Box::new(Template::new(contact))))
        .as_deref()
}

impl Template {
    fn new(contact: Contact) -> Self {
        let phases = std::array::from_fn(|phase| {
            let builder = Builder { contact: &contact, phase: phase as u8 };
            let mut template = PhaseTemplate::default();
            builder.faces(&mut template);
            builder.prisms(&mut template);
            (0..8).for_each(|octant| builder.patches(octant, &mut template));
            template.without_t_junctions()
        });
        Self { contact, phases }
    }
}

struct Builder<'a> {
    contact: &'a Contact,
    phase: u8,
}

impl Builder<'_> {
    /// Offset of a point of an octant, given by its distances from the vertex along the axes.
    fn place(octant: usize, distances: Offset) -> Offset {
        std::array::from_fn(|axis| if octant >> axis & 1 == 1 { distances[axis] } else { -distances[axis] })
    }

    /// Owner of the prism along `axis` on the side of an octant.
    fn owner(&self, octant: usize, axis: usize) -> Option<u8> {
        self.contact.rays[ray(axis, octant >> axis & 1)]
    }

    fn faces(&self, template: &mut PhaseTemplate) {
        let labels = &self.contact.labels;
        for normal in 0..3 {
            let (u, w) = ((normal + 1) % 3, (normal + 2) % 3);
            for quadrant in 0..4 {
                let low = (quadrant & 1) << u | (quadrant >> 1) << w;
                let high = low | 1 << normal;
                let (octant, other) = if labels[low] == self.phase { (low, high) } else { (high, low) };
                if labels[octant] != self.phase || labels[other] == self.phase {
                    continue;
                }
                // Towards void the owner's share is its own face, so only what others own is cut off.
                let cut = |owner: Option<u8>| size(owner.filter(|o| labels[other] != VOID || *o != self.phase));
                let du = cut(self.owner(octant, u));
                let dw = cut(self.owner(octant, w));
                let dv = cut(Some(self.contact.vertex));
                let at = |along_u: i8, along_w: i8| {
                    let mut distances = [0; 3];
                    distances[u] = along_u;
                    distances[w] = along_w;
                    Self::place(octant, distances)
                };
                template.faces[normal][quadrant] =
                    if dv > du + dw { vec![at(dv - du, du), at(dw, dv - dw)] } else { vec![at(dw, du)] };
            }
        }
    }

    /// Ends of walls and strips. Along the ray runs `t`, across it `b` and `c`; the wall is `b + c = d`.
    fn prisms(&self, template: &mut PhaseTemplate) {
        for (along, owner) in self.contact.rays.iter().enumerate() {
            let Some(owner) = *owner else { continue };
            for (position, octant) in Octants::around(along).into_iter().enumerate() {
                let label = self.contact.labels[octant];
                if label == VOID || label == owner {
                    continue;
                }
                if self.phase == label || self.phase == owner {
                    template.walls[along][position] = self.wall(along, octant, owner);
                }
                if self.phase == owner {
                    for (which, strip) in template.strips[along][position].iter_mut().enumerate() {
                        let normal = (along / 2 + 1 + which) % 3;
                        if self.contact.labels[octant ^ 1 << normal] == VOID {
                            *strip = self.strip(along, octant, normal);
                        }
                    }
                }
            }
        }
    }

    fn wall(&self, along: Ray, octant: usize, owner: u8) -> Vec<Offset> {
        let axis = along / 2;
        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
        let d = size(Some(owner));
        // The voxel's side ends where anything else begins, the prism's where its own phase or a softer one does.
        let ends_at = |o: u8| if self.phase == owner { o <= self.phase } else { o < self.phase };
        let counted = |o: Option<u8>| o.filter(|o| ends_at(*o));
        let (db, dc) = (counted(self.owner(octant, b)), counted(self.owner(octant, c)));
        let dv = counted(Some(self.contact.vertex));
        let start = |s: i8| {
            let mut t = 0.max(size(dv) - d);
            if db.is_some() {
                t = t.max(size(db) - d + s);
            }
            if dc.is_some() {
                t = t.max(size(dc) - s);
            }
            t
        };
        corners_of(d, start).map(|(s, t)| Self::place(octant, Self::along(axis, t, s, d - s))).collect()
    }

    fn strip(&self, along: Ray, octant: usize, normal: usize) -> Vec<Offset> {
        let axis = along / 2;
        let other = 3 - axis - normal;
        let softer = |o: Option<u8>| o.filter(|o| *o < self.phase);
        let across = self.owner(octant, other);
        let start = |k: i8| {
            let mut t = 0.max(size(softer(Some(self.contact.vertex))) - k).max(size(softer(across)));
            if across == Some(self.phase) {
                t = t.max(k);
            }
            t
        };
        let place = |(k, t): (i8, i8)| {
            let mut distances = [0; 3];
            distances[axis] = t;
            distances[other] = k;
            Self::place(octant, distances)
        };
        corners_of(size(Some(self.phase)), start).map(place).collect()
    }

    /// Distances along the axes from those along `axis` and the two that follow it.
    fn along(axis: usize, t: i8, b: i8, c: i8) -> Offset {
        let mut distances = [0; 3];
        distances[axis] = t;
        distances[(axis + 1) % 3] = b;
        distances[(axis + 2) % 3] = c;
        distances
    }

    /// Closed polygons in one octant.
    fn patches(&self, octant: usize, template: &mut PhaseTemplate) {
        let (label, vertex) = (self.contact.labels[octant], self.contact.vertex);
        if label == VOID || label == vertex {
            return;
        }
        let owners: [Option<u8>; 3] = std::array::from_fn(|axis| self.owner(octant, axis).filter(|o| *o != label));
        let dv = size(Some(vertex));
        let mut add = |corners: Vec<Offset>, normal: Offset| {
            template.patches.push(Patch {
                corners: corners.into_iter().map(|p| Self::place(octant, p)).collect(),
                normal: Self::place(octant, normal),
            });
        };
        let octahedron_shows = !owners.contains(&Some(vertex));
        if octahedron_shows && self.phase == vertex {
            add(vec![[dv, 0, 0], [0, dv, 0], [0, 0, dv]], [1, 1, 1]);
        }
        if octahedron_shows && self.phase == label {
            let corner = |axis: usize| {
                let d = size(owners[axis]);
                let ends = if d == 0 { vec![(0, 0)] } else { vec![(0, d), (d, 0)] };
                ends.into_iter().map(move |(b, c)| Self::along(axis, dv - d, b, c))
            };
            add((0..3).flat_map(corner).collect(), [-1, -1, -1]);
        }
        for axis in 0..3 {
            if self.phase == vertex && self.contact.labels[octant ^ 1 << axis] == VOID {
                let in_plane = [(axis + 1) % 3, (axis + 2) % 3];
                if in_plane.iter().all(|k| owners[*k] != Some(vertex)) {
                    let mut normal = [0; 3];
                    normal[axis] = -1;
                    let triangle = [(0, 0), (dv, 0), (0, dv)].map(|(b, c)| Self::along(axis, 0, b, c));
                    add(triangle.to_vec(), normal);
                }
            }
            if owners[axis] == Some(self.phase) && self.phase != vertex {
                self.caps(axis, &owners, &mut add);
            }
        }
    }

    /// Where a prism of this phase ends at a softer octahedron, or at the softer prisms that start there.
    fn caps(&self, axis: usize, owners: &[Option<u8>; 3], add: &mut dyn FnMut(Vec<Offset>, Offset)) {
        let (d, dv) = (size(Some(self.phase)), size(Some(self.contact.vertex)));
        let softer = |axis: usize| owners[axis].is_some_and(|o| o < self.phase);
        let at = |b: i8, c: i8, t: i8| Self::along(axis, t, b, c);
        match (softer((axis + 1) % 3), softer((axis + 2) % 3)) {
            (false, false) => add(vec![at(0, 0, dv), at(d, 0, dv - d), at(0, d, dv - d)], at(-1, -1, -1)),
            (true, false) => add(vec![at(0, 0, dv), at(d, 0, dv), at(0, d, dv - d)], at(0, -1, -1)),
            (false, true) => add(vec![at(0, 0, dv), at(d, 0, dv - d), at(0, d, dv)], at(-1, 0, -1)),
            (true, true) => {
                let middle = at(d / 2, d / 2, dv - d / 2);
                add(vec![at(0, 0, dv), at(d, 0, dv), middle], at(0, -1, -1));
                add(vec![at(0, 0, dv), middle, at(0, d, dv)], at(-1, 0, -1));
            }
        }
    }
}

/// Corners `(s, f(s))` of a piecewise linear function on `[0, d]` whose kinks are at whole numbers.
fn corners_of(d: i8, f: impl Fn(i8) -> i8) -> impl Iterator<Item = (i8, i8)> {
    (0..=d)
        .map(|s| (s, f(s), s == 0 || s == d || f(s + 1) - f(s) != f(s) - f(s - 1)))
        .filter(|(_, _, kink)| *kink)
        .map(|(s, value, _)| (s, value))
        .collect::<Vec<_>>()
        .into_iter()
}

/// How far `point` lies along `direction` from `start`, where it lies on that half-line beyond its start. Directions of
/// lattice lines only.
fn beyond(start: Offset, direction: Offset, point: Offset) -> Option<i8> {
    let along = direction.iter().position(|d| *d != 0)?;
    let distance = (point[along] - start[along]) * direction[along];
    (distance > 0 && (0..3).all(|k| point[k] - start[k] == direction[k] * distance)).then_some(distance)
}

/// Whether `point` lies strictly between two others, and how far along.
fn between(start: Offset, end: Offset, point: Offset) -> Option<i16> {
    let wide = |a: Offset, b: Offset| -> [i16; 3] { std::array::from_fn(|k| i16::from(b[k]) - i16::from(a[k])) };
    let (edge, to) = (wide(start, end), wide(start, point));
    let cross = |k: usize| edge[(k + 1) % 3] * to[(k + 2) % 3] - edge[(k + 2) % 3] * to[(k + 1) % 3];
    let dot = |a: [i16; 3], b: [i16; 3]| (0..3).map(|k| a[k] * b[k]).sum::<i16>();
    let along = dot(edge, to);
    ((0..3).all(|k| cross(k) == 0) && along > 0 && along < dot(edge, edge)).then_some(along)
}

impl PhaseTemplate {
    /// Adds to every chain and polygon the points of the surface that lie on its edges.
    fn without_t_junctions(mut self) -> Self {
        let mut points: Vec<Offset> = Vec::new();
        let chains = self.faces.iter().flatten().chain(self.walls.iter().flatten());
        points.extend(chains.chain(self.strips.iter().flatten().flatten()).flatten());
        points.extend(self.patches.iter().flat_map(|p| &p.corners));
        points.sort_unstable();
        points.dedup();

        let within = |start: Offset, end: Offset, out: &mut Vec<Offset>| {
            let mut found: Vec<_> = points.iter().filter_map(|p| between(start, end, *p).map(|d| (d, *p))).collect();
            found.sort_unstable();
            out.extend(found.into_iter().map(|(_, p)| p));
        };
        let outward = |start: Offset, direction: Offset| {
            let mut found: Vec<_> =
                points.iter().filter_map(|p| beyond(start, direction, *p).map(|d| (d, *p))).collect();
            found.sort_unstable();
            found.into_iter().map(|(_, p)| p)
        };
        let complete = |chain: &mut Vec<Offset>, from: Offset, to: Offset| {
            let (Some(first), Some(last)) = (chain.first().copied(), chain.last().copied()) else { return };
            let mut whole: Vec<Offset> = outward(first, from).rev().collect();
            for pair in chain.windows(2) {
                whole.push(pair[0]);
                within(pair[0], pair[1], &mut whole);
            }
            whole.push(last);
            whole.extend(outward(last, to));
            *chain = whole;
        };
        let direction = |axis: usize, up: usize| {
            let mut direction = [0; 3];
            direction[axis] = if up == 1 { 1 } else { -1 };
            direction
        };
        for (normal, quadrants) in self.faces.iter_mut().enumerate() {
            for (quadrant, chain) in quadrants.iter_mut().enumerate() {
                let from = direction((normal + 1) % 3, quadrant & 1);
                complete(chain, from, direction((normal + 2) % 3, quadrant >> 1));
            }
        }
        for along in 0..6 {
            let out = direction(along / 2, along % 2);
            let chains = self.walls[along].iter_mut().chain(self.strips[along].iter_mut().flatten());
            chains.for_each(|chain| complete(chain, out, out));
        }
        for patch in &mut self.patches {
            let corners = std::mem::take(&mut patch.corners);
            for (k, corner) in corners.iter().enumerate() {
                patch.corners.push(*corner);
                within(*corner, corners[(k + 1) % corners.len()], &mut patch.corners);
            }
        }
        self
    }
}

const _: () = assert!(2 * SIZES[1] < SIZES[0] && SIZES[0] % 2 == 0 && SIZES[1] % 2 == 0);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_checkerboard_edge_gives_two_walls_to_either_phase() {
        // Soft and stiff alternate around the whole z axis.
        let labels = [0, 1, 1, 0, 0, 1, 1, 0];
        let template = template(Octants(labels).code()).unwrap();
        for phase in 0..2 {
            let up: Vec<_> = template.phases[phase].walls[5].iter().filter(|w| !w.is_empty()).collect();
            assert_eq!(up.len(), 2, "phase {phase}");
            assert!(up.iter().all(|w| w.len() == 2 && w.iter().all(|p| p[2] == 0)), "{up:?}");
            assert!(template.phases[phase].patches.is_empty());
        }
        // Faces of the checkerboard start beside the prism.
        assert_eq!(template.phases[1].faces[0][3], [[0, 42, 0]]);
    }

    #[test]
    fn opposite_corners_are_joined_by_an_octahedron() {
        let template = template(Octants([0, 1, 1, 1, 1, 1, 1, 0]).code()).unwrap();
        let soft = &template.phases[0];
        assert_eq!(soft.patches.len(), 6);
        assert_eq!(template.phases[1].patches.len(), 6);
        // A face of the soft corner loses nothing but its corner.
        assert_eq!(soft.faces[2][3].len(), 2);
    }
}
