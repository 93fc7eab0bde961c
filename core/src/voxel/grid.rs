//! The voxels of one strip.

/// Phases of all voxels of a strip: slices from rim to hub, layers from the lower face up, voxels across the width.
///
/// Slice `i` is `2 half_widths[i]` voxels wide and `layers` high, centred on the strip's axis. Within a slice, voxel
/// `(layer, across)` stands at `layer * 2 half_widths[i] + across`; `across = 0` is at the most negative `y`. Phases count
/// from zero, softest first.
#[derive(Debug, Clone, PartialEq)]
pub struct VoxelGrid {
    size_mm: f64,
    layers: usize,
    half_widths: Vec<usize>,
    offsets: Vec<usize>,
    phases: Vec<u8>,
}

impl VoxelGrid {
    /// A grid whose voxels are all of the softest phase.
    #[must_use]
    pub fn new(size_mm: f64, layers: usize, half_widths: Vec<usize>) -> Self {
        let mut offsets = Vec::with_capacity(half_widths.len() + 1);
        let mut total = 0;
        offsets.push(0);
        for half_width in &half_widths {
            total += 2 * half_width * layers;
            offsets.push(total);
        }
        Self { size_mm, layers, half_widths, offsets, phases: vec![0; total] }
    }

    /// Voxel edge, mm.
    #[must_use]
    pub fn size_mm(&self) -> f64 {
        self.size_mm
    }

    /// Number of layers.
    #[must_use]
    pub fn layers(&self) -> usize {
        self.layers
    }

    /// Number of slices.
    #[must_use]
    pub fn slices(&self) -> usize {
        self.half_widths.len()
    }

    /// Half-width of every slice in voxels.
    #[must_use]
    pub fn half_widths(&self) -> &[usize] {
        &self.half_widths
    }

    /// All phases, slice after slice.
    #[must_use]
    pub fn phases(&self) -> &[u8] {
        &self.phases
    }

    /// Start of every slice in [`Self::phases`], and the total.
    #[must_use]
    pub fn offsets(&self) -> &[usize] {
        &self.offsets
    }

    /// Phases of slice `i`, layer by layer.
    #[must_use]
    pub fn slice(&self, i: usize) -> &[u8] {
        &self.phases[self.offsets[i]..self.offsets[i + 1]]
    }

    /// Phases of slice `i`, to be written.
    pub fn slice_mut(&mut self, i: usize) -> &mut [u8] {
        &mut self.phases[self.offsets[i]..self.offsets[i + 1]]
    }

    /// Disjoint mutable slices, rim first.
    pub fn slices_mut(&mut self) -> Vec<&mut [u8]> {
        let mut rest = self.phases.as_mut_slice();
        let mut slices = Vec::with_capacity(self.half_widths.len());
        for bounds in self.offsets.windows(2) {
            let (slice, tail) = rest.split_at_mut(bounds[1] - bounds[0]);
            slices.push(slice);
            rest = tail;
        }
        slices
    }

    /// Number of voxels of each of `phases` phases.
    #[must_use]
    pub fn counts(&self, phases: usize) -> Vec<u64> {
        let mut counts = vec![0; phases];
        for phase in &self.phases {
            if let Some(count) = counts.get_mut(usize::from(*phase)) {
                *count += 1;
            }
        }
        counts
    }

    /// Volume of all voxels, mm^3.
    #[must_use]
    pub fn volume_mm3(&self) -> f64 {
        self.phases.len() as f64 * self.size_mm.powi(3)
    }
}
