//! What can keep a report from being drawn.

/// Why a figure of a report could not be drawn.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// A value to be drawn is not a number.
    #[error("{figure}: {quantity} is {value}, which cannot be drawn")]
    NotFinite {
        /// The figure.
        figure: &'static str,
        /// What the value is.
        quantity: String,
        /// The value.
        value: f64,
    },
    /// The plotting library refused a chart.
    #[error("{figure}: the chart could not be drawn: {problem}")]
    Chart {
        /// The figure.
        figure: &'static str,
        /// What the plotting library says.
        problem: String,
    },
}
