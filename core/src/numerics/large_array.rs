//! Hundreds of megabytes of numbers.
//!
//! Memory that a system hands out in pages of 4 kB takes longest when it is first written and when it is given back: together
//! a second a gigabyte or more on virtual machines. Where the system has huge pages (2 MB, Linux), it is asked for them.

use std::io;
use std::ops::{Deref, DerefMut};

use memmap2::MmapMut;

/// An array of a fixed length that is zero at first; memory is taken as it is written.
pub struct LargeArray {
    pages: MmapMut,
    len: usize,
}

impl LargeArray {
    /// `len` zeros.
    ///
    /// # Errors
    /// Where the system has no such memory.
    pub fn zeros(len: usize) -> io::Result<Self> {
        let bytes = len.checked_mul(size_of::<f64>()).ok_or(io::ErrorKind::OutOfMemory)?;
        // Nothing cannot be mapped.
        let pages = MmapMut::map_anon(bytes.max(1))?;
        // An advice: systems without huge pages go on with small ones.
        #[cfg(target_os = "linux")]
        let _ = pages.advise(memmap2::Advice::HugePage);
        Ok(Self { pages, len })
    }
}

impl Deref for LargeArray {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        bytemuck::cast_slice(&self.pages[..self.len * size_of::<f64>()])
    }
}

impl DerefMut for LargeArray {
    fn deref_mut(&mut self) -> &mut [f64] {
        bytemuck::cast_slice_mut(&mut self.pages[..self.len * size_of::<f64>()])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_are_zero_and_keep_what_is_written() {
        let mut array = LargeArray::zeros(3_000_000).unwrap();
        assert_eq!(array.len(), 3_000_000);
        assert!(array.iter().all(|x| *x == 0.0));
        array[2_999_999] = 1.5;
        assert_eq!(array.iter().sum::<f64>(), 1.5);
        assert!(LargeArray::zeros(0).unwrap().is_empty());
    }

    #[test]
    fn too_much_is_an_error() {
        assert!(LargeArray::zeros(usize::MAX / 4).is_err());
        assert!(LargeArray::zeros(usize::MAX / 16).is_err());
    }
}
