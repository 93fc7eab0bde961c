//! How much memory a solution takes.

use super::FemError;
use crate::memory::available_bytes;

/// Share of the available memory that a solution may take.
const SHARE: f64 = 0.8;

/// Bytes that a solution may take by default: most of what is available; `None` where the system does not say.
#[must_use]
pub fn default_limit() -> Option<u64> {
    available_bytes().map(|bytes| (SHARE * bytes as f64) as u64)
}

/// Bytes of the sparsity and of the tangent, a node.
const BYTES_A_NODE: f64 = 3500.0;
/// Entries of the factors over `d^2 N log2(N)` for `N` columns of nodes of `d` unknowns: a little less than what nested
/// dissection of strips gave (2.1 to 2.5), since what passes is counted exactly before the factors are taken.
const FILL: f64 = 2.0;

/// Refuses a strip that needs more than `limit` bytes, from its number of elements alone, before any memory is taken.
///
/// # Errors
/// [`FemError::Memory`].
pub fn require(elements: u64, layers: usize, limit: Option<u64>) -> Result<(), FemError> {
    let levels = layers as f64 + 1.0;
    let columns = (elements as f64 / layers.max(1) as f64).max(2.0);
    let unknowns = 3.0 * levels * columns;
    let entries = FILL * (3.0 * levels).powi(2) * columns * columns.log2();
    let needed = (8.0 * entries + BYTES_A_NODE * levels * columns) as u64;
    match limit {
        Some(limit) if needed > limit => Err(FemError::Memory { unknowns: unknowns as usize, needed, limit }),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::require;

    #[test]
    fn a_strip_far_too_large_is_refused_by_its_size() {
        // The 67 000 voxels of the paper's strip take 1.06 GB of factors and about 0.3 GB besides.
        assert!(require(67_000, 4, Some(2_000_000_000)).is_ok());
        assert!(require(67_000, 4, Some(900_000_000)).is_err());
        assert!(require(200_000_000, 20, Some(64_000_000_000)).is_err());
        assert!(require(u64::MAX, 1, None).is_ok());
    }
}
