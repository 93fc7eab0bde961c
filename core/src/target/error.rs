//! What can be wrong with a target.

/// A target that cannot be used, with the offending value and what would help.
///
/// The design file's name and key are added by the caller, who knows them.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TargetError {
    /// A length or ratio outside its range.
    #[error("{name} is {value}; it must be {allowed}")]
    OutOfRange { name: &'static str, value: f64, allowed: &'static str },
}
