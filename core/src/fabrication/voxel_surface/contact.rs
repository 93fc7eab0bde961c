//! Where voxels of a phase touch along an edge or at a corner only, and who gets the bit of space in between.
//!
//! Around a lattice vertex lie eight octants, each a voxel or void; around a lattice edge four. A phase's solid would not
//! be a manifold where two of its voxels share that edge, or that vertex, and no face connects them there. The rule: **the
//! softest phase that meets there gets a slender prism around the edge (a small octahedron around the vertex), cut off the
//! corners of the other voxels**. So the softest phase joins, the others part, what they lose is what it gains, and void
//! stays void.
//!
//! ```text
//!      stiff \ soft            the prism |b| + |c| <= d around an edge, seen along it:
//!      _______\____            a corner of each stiff voxel goes to the soft phase
//!      soft    \ stiff
//! ```
//!
//! With three phases a prism may end at an octahedron of a softer phase. The harder of the two is the slenderer, so that
//! two of them never meet at the octahedron's edge.

/// Label of what is not a voxel.
pub const VOID: u8 = 3;

/// Most phases that are told apart.
pub const PHASES: usize = 3;

/// Half-diagonal `d` of the prism or octahedron that a phase gets, in the unit of [`super::Scale`]. All even, the second
/// less than half the first.
pub const SIZES: [i8; PHASES] = [42, 20, 2];

/// A direction from a vertex along a lattice edge: `2 axis + 1` upwards, `2 axis` downwards.
pub type Ray = usize;

/// The ray along `axis`, upwards or downwards.
#[must_use]
pub fn ray(axis: usize, up: usize) -> Ray {
    2 * axis + up
}

/// The octants of a vertex: number `o` lies above it in `x`, `y`, `z` where bits 0, 1, 2 of `o` are set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Octants(pub [u8; 8]);

impl Octants {
    /// The octants with a code, see [`Self::code`].
    #[must_use]
    pub fn from_code(code: u16) -> Self {
        Self(std::array::from_fn(|o| (code >> (2 * o) & 3) as u8))
    }

    /// Two bits an octant.
    #[must_use]
    pub fn code(self) -> u16 {
        self.0.iter().enumerate().map(|(o, label)| u16::from(*label) << (2 * o)).sum()
    }

    /// The octants around a ray, in order around it: `(b, c)` in `(0, 0), (1, 0), (1, 1), (0, 1)`, where `b` and `c` are the
    /// axes that follow the ray's.
    #[must_use]
    pub fn around(ray: Ray) -> [usize; 4] {
        let (axis, up) = (ray / 2, ray % 2);
        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
        [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(along_b, along_c)| up << axis | along_b << b | along_c << c)
    }

    fn softest(labels: impl Iterator<Item = u8>) -> Option<u8> {
        labels.filter(|l| *l != VOID).min()
    }

    /// The phase that gets the prism around the edge along a ray, where one is needed.
    fn owner_along(self, ray: Ray) -> Option<u8> {
        let [p, q, r, s] = Self::around(ray).map(|o| self.0[o]);
        let touch = |one: u8, other: u8, between: [u8; 2]| one == other && one != VOID && !between.contains(&one);
        let singular = touch(p, r, [q, s]) || touch(q, s, [p, r]);
        if singular { Self::softest([p, q, r, s].into_iter()) } else { None }
    }

    /// Whether a phase fills two opposite octants only, or all but two opposite ones.
    fn has_opposite_corners(self) -> bool {
        (0..PHASES as u8).any(|phase| {
            let filled = (0..8).filter(|o| self.0[*o] == phase).fold(0_u8, |mask, o| mask | 1 << o);
            (0..4).any(|o| {
                let pair = 1_u8 << o | 1 << (7 - o);
                filled == pair || filled == !pair
            })
        })
    }
}

/// What is done around a vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Contact {
    /// The octants.
    pub labels: [u8; 8],
    /// Owner of the prism along every ray.
    pub rays: [Option<u8>; 6],
    /// Owner of the octahedron: the softest phase at the vertex.
    pub vertex: u8,
}

impl Contact {
    /// `None` where all phases are manifold around the vertex.
    #[must_use]
    pub fn of(octants: Octants) -> Option<Self> {
        let rays: [Option<u8>; 6] = std::array::from_fn(|ray| octants.owner_along(ray));
        if rays.iter().all(Option::is_none) && !octants.has_opposite_corners() {
            return None;
        }
        let vertex = Octants::softest(octants.0.into_iter())?;
        Some(Self { labels: octants.0, rays, vertex })
    }

    /// On which side along `x` and along `y` there is more void: -1, 0 or 1.
    #[must_use]
    pub fn void_side(&self) -> [i8; 2] {
        let void = |o: &usize| self.labels[*o] == VOID;
        let balance = |axis: usize| (0..8).filter(void).map(|o| if o >> axis & 1 == 1 { 1_i8 } else { -1 }).sum::<i8>();
        [balance(0).signum(), balance(1).signum()]
    }
}

/// Half-diagonal of what `owner` gets; nothing for nobody.
#[must_use]
pub fn size(owner: Option<u8>) -> i8 {
    owner.and_then(|o| SIZES.get(usize::from(o))).copied().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_diagonal_pair_around_an_edge_is_a_contact_and_the_softest_phase_gets_it() {
        // Above the vertex a checkerboard of soft and stiff, below all stiff.
        let mut labels = [1_u8; 8];
        labels[4] = 0;
        labels[7] = 0;
        let contact = Contact::of(Octants(labels)).unwrap();
        assert_eq!(contact.rays, [None, None, None, None, None, Some(0)]);
        assert_eq!(contact.vertex, 0);
        // Two stiff voxels across an edge, one neighbour void: parted by the soft one that is left.
        let labels = [3, 3, 3, 3, 1, 0, 3, 1];
        assert_eq!(Contact::of(Octants(labels)).unwrap().rays[5], Some(0));
    }

    #[test]
    fn faces_and_halves_are_no_contacts_opposite_corners_are() {
        for labels in [[0; 8], [0, 0, 0, 0, 1, 1, 1, 1], [1, 0, 0, 0, 0, 0, 0, 0], [0, 1, 1, 1, 0, 1, 1, 1]] {
            assert_eq!(Contact::of(Octants(labels)), None, "{labels:?}");
        }
        for labels in [[0, 1, 1, 1, 1, 1, 1, 0], [1, 0, 0, 0, 0, 0, 0, 1], [0, 1, 1, 1, 1, 1, 1, 2]] {
            let contact = Contact::of(Octants(labels)).unwrap();
            assert_eq!((contact.rays, contact.vertex), ([None; 6], 0), "{labels:?}");
        }
    }

    #[test]
    fn codes_are_one_to_one() {
        for code in [0, 1, 0xFFFF, 0x1234, 0xE41B] {
            assert_eq!(Octants::from_code(code).code(), code);
        }
    }
}
