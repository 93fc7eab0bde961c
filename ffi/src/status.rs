//! Status codes.

/// What a call returns. Codes are never reused; those below 6 and 130 are the command line's exit codes.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// Done; outputs are written.
    Ok = 0,
    /// A defect of the library; please report it.
    Internal = 1,
    /// The design, or a file it names, is wrong.
    Input = 2,
    /// Mechanics or the materials rule the design out.
    Infeasible = 3,
    /// A solver is missing, failed or did not converge.
    Solver = 4,
    /// A file could not be written.
    Output = 5,
    /// A pointer that must not be null is null.
    NullArgument = 7,
    /// Not a handle of this type, or one that was freed.
    BadHandle = 8,
    /// A buffer has another length than what is to be written into it.
    WrongLength = 9,
    /// A text is not UTF-8, or holds a zero byte.
    BadText = 10,
    /// A number or an index lies outside what is allowed.
    OutOfRange = 11,
    /// The progress callback cancelled the work.
    Cancelled = 130,
}
