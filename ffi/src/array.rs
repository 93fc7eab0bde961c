//! Arrays that are lent to the caller.

/// Numbers that belong to a handle: read them, never write or free them. They stay where they are until the handle that
/// lent them is freed. Value `(row, column)` stands at `(const char *)data + row * stride + column * sizeof(double)`.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ArrayF64 {
    /// First value; not to be used where `rows` is 0.
    pub data: *const f64,
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Distance of two rows in bytes.
    pub stride: usize,
}

/// As `voxelastica_array_f64`, for 32-bit whole numbers.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ArrayU32 {
    /// First value; not to be used where `rows` is 0.
    pub data: *const u32,
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Distance of two rows in bytes.
    pub stride: usize,
}

/// As `voxelastica_array_f64`, for sizes and places.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ArraySize {
    /// First value; not to be used where `rows` is 0.
    pub data: *const usize,
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Distance of two rows in bytes.
    pub stride: usize,
}

/// As `voxelastica_array_f64`, for bytes.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ArrayU8 {
    /// First value; not to be used where `rows` is 0.
    pub data: *const u8,
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Distance of two rows in bytes.
    pub stride: usize,
}

macro_rules! lend {
    ($array:ident, $value:ty) => {
        impl $array {
            /// Lends one value a row.
            #[allow(dead_code)]
            pub(crate) fn column(values: &[$value]) -> Self {
                Self { data: values.as_ptr(), rows: values.len(), columns: 1, stride: size_of::<$value>() }
            }

            /// Lends `N` values a row.
            #[allow(dead_code)]
            pub(crate) fn table<const N: usize>(values: &[[$value; N]]) -> Self {
                let stride = size_of::<[$value; N]>();
                Self { data: values.as_ptr().cast(), rows: values.len(), columns: N, stride }
            }
        }
    };
}

lend!(ArrayF64, f64);
lend!(ArrayU32, u32);
lend!(ArraySize, usize);
lend!(ArrayU8, u8);
