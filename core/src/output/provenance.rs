//! Where a file comes from: version, seed and the hash of the design.

use serde::Serialize;

use crate::input::DesignInput;
use crate::input::files::hex_sha256;

/// What the header of every written file states, so that it can be traced and reproduced.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Provenance {
    /// Version of the library.
    pub version: String,
    /// Seed of the random patterns.
    pub seed: u64,
    /// SHA-256 of the design: the input with defaults filled in and the contents of the files it names, never paths.
    pub design_sha256: String,
}

impl Provenance {
    /// The provenance of a design.
    #[must_use]
    pub fn of(input: &DesignInput) -> Self {
        let mut value = serde_json::to_value(input).unwrap_or_default();
        if let Some(target) = value.get_mut("target").and_then(serde_json::Value::as_object_mut) {
            target.remove("file");
        }
        // Fields come in the order of their declaration, so the text is canonical.
        let hash = hex_sha256(value.to_string().as_bytes());
        Self { version: env!("CARGO_PKG_VERSION").to_owned(), seed: input.voxels.seed, design_sha256: hash }
    }

    /// One line for a header.
    #[must_use]
    pub fn line(&self) -> String {
        format!("Voxelastica {}, seed {}, design {}", self.version, self.seed, self.design_sha256)
    }
}
