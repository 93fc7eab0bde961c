//! Where the phases sit in a cross-section.

use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};
use serde::{Deserialize, Serialize};

/// How the phases of a slice are arranged. The softest phase takes the places named first, the stiffest the last ones,
/// an intermediate one those between.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Pattern {
    /// A seeded shuffle of the whole slice.
    Random,
    /// A seeded shuffle of every layer, with the same counts in all of them.
    RandomLayered,
    /// Soft in the middle of the width, all layers alike.
    Centred,
    /// Soft at both edges, all layers alike.
    Split,
    /// Soft fills whole layers from the lower face, the remainder centred in the next one.
    ThroughThickness,
    /// Soft at one edge; the side alternates from spoke to spoke.
    OneEdge,
}

impl Pattern {
    /// Counts change by whole multiples of this number of voxels, so that the pattern keeps its symmetry.
    #[must_use]
    pub fn granule(self, layers: usize) -> usize {
        match self {
            Self::Random | Self::ThroughThickness | Self::OneEdge => 1,
            Self::RandomLayered => layers,
            Self::Centred | Self::Split => 2 * layers,
        }
    }

    /// Whether every second spoke is the mirror image of the first.
    #[must_use]
    pub fn alternates(self) -> bool {
        self == Self::OneEdge
    }

    /// Places of a slice of `2 half_width` by `layers` voxels in the order in which they are filled, softest first.
    ///
    /// A place is `layer * 2 half_width + across`. The order of the random patterns depends on the seed and the slice
    /// only, not on the counts, so a corrected design keeps its shuffle.
    #[must_use]
    pub fn order(self, half_width: usize, layers: usize, seed: u64, slice: usize) -> Vec<u32> {
        let width = 2 * half_width;
        let place = |layer: usize, across: usize| (layer * width + across) as u32;
        // Columns from the middle outwards, alternating sides.
        let outward = |k: usize| if k.is_multiple_of(2) { half_width - 1 - k / 2 } else { half_width + k / 2 };
        let by_columns = |column: &dyn Fn(usize) -> usize| -> Vec<u32> {
            (0..width / 2)
                .flat_map(|pair| (0..layers).map(move |layer| (pair, layer)))
                .flat_map(|(pair, layer)| [place(layer, column(2 * pair)), place(layer, column(2 * pair + 1))])
                .collect()
        };
        match self {
            Self::Random => {
                let mut order: Vec<u32> = (0..(width * layers) as u32).collect();
                shuffle(&mut order, &mut generator(seed, slice));
                order
            }
            Self::RandomLayered => {
                let mut rng = generator(seed, slice);
                let mut columns: Vec<Vec<u32>> = Vec::with_capacity(layers);
                for _ in 0..layers {
                    let mut row: Vec<u32> = (0..width as u32).collect();
                    shuffle(&mut row, &mut rng);
                    columns.push(row);
                }
                (0..width)
                    .flat_map(|k| columns.iter().enumerate().map(move |(layer, row)| place(layer, row[k] as usize)))
                    .collect()
            }
            Self::Centred => by_columns(&outward),
            Self::Split => by_columns(&|k| outward(width - 1 - k)),
            Self::ThroughThickness => {
                (0..layers).flat_map(|layer| (0..width).map(move |k| place(layer, outward(k)))).collect()
            }
            Self::OneEdge => {
                // A partly filled column is filled from its middle, to stay as symmetric about the mid-plane as it can.
                let middle_out = |k: usize| {
                    let centre = layers / 2;
                    if layers % 2 == 1 {
                        if k.is_multiple_of(2) { centre - k / 2 } else { centre + k.div_ceil(2) }
                    } else if k.is_multiple_of(2) {
                        centre - 1 - k / 2
                    } else {
                        centre + k / 2
                    }
                };
                (0..width).flat_map(|across| (0..layers).map(move |k| place(middle_out(k), across))).collect()
            }
        }
    }
}

/// A generator of its own for every slice, so that slices can be filled in any order.
fn generator(seed: u64, slice: usize) -> Xoshiro256PlusPlus {
    Xoshiro256PlusPlus::seed_from_u64(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(slice as u64 + 1))
}

/// Fisher and Yates's shuffle; bounded numbers by multiplication, so that the result never depends on a library version.
fn shuffle(places: &mut [u32], rng: &mut Xoshiro256PlusPlus) {
    for i in (1..places.len()).rev() {
        let j = ((u128::from(rng.next_u64()) * (i as u128 + 1)) >> 64) as usize;
        places.swap(i, j);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Pattern; 6] = [
        Pattern::Random,
        Pattern::RandomLayered,
        Pattern::Centred,
        Pattern::Split,
        Pattern::ThroughThickness,
        Pattern::OneEdge,
    ];

    #[test]
    fn every_order_names_every_place_once() {
        for pattern in ALL {
            for (half_width, layers) in [(1, 1), (1, 3), (2, 4), (5, 3), (7, 2)] {
                let mut order = pattern.order(half_width, layers, 7, 3);
                order.sort_unstable();
                let expected: Vec<u32> = (0..(2 * half_width * layers) as u32).collect();
                assert_eq!(order, expected, "{pattern:?} {half_width} {layers}");
            }
        }
    }

    #[test]
    fn symmetric_patterns_stay_symmetric_after_every_granule() {
        for pattern in [Pattern::Centred, Pattern::Split] {
            let (half_width, layers) = (5, 3);
            let order = pattern.order(half_width, layers, 0, 0);
            for count in (0..=2 * half_width * layers).step_by(pattern.granule(layers)) {
                let soft: std::collections::HashSet<u32> = order[..count].iter().copied().collect();
                for place in &soft {
                    let (layer, across) = (*place as usize / 10, *place as usize % 10);
                    assert!(soft.contains(&((layer * 10 + 9 - across) as u32)), "{pattern:?} mirror");
                    assert!(soft.contains(&((((layer + 1) % 3) * 10 + across) as u32)), "{pattern:?} layers");
                }
            }
        }
        let centred = Pattern::Centred.order(3, 1, 0, 0);
        assert_eq!(&centred[..2], &[2, 3]);
        let split = Pattern::Split.order(3, 1, 0, 0);
        assert!(split[..2].contains(&0) && split[..2].contains(&5));
    }

    #[test]
    fn shuffles_depend_on_seed_and_slice_and_on_nothing_else() {
        let order = |seed, slice| Pattern::Random.order(10, 2, seed, slice);
        assert_eq!(order(1, 0), order(1, 0));
        assert_ne!(order(1, 0), order(1, 1));
        assert_ne!(order(1, 0), order(2, 0));
        // Frozen: a change would silently change every published design.
        assert_eq!(&order(1, 0)[..6], &FROZEN);
    }

    const FROZEN: [u32; 6] = [27, 34, 25, 31, 8, 12];
}
