//! `fabrication.json`: what was made, and the files of an earlier design that have to go.

use std::fs;
use std::path::{Component, Path};

use serde_json::{Map, Value, json};

use super::{FOLDER, Made};
use crate::input::files::read_bytes;
use crate::input::{FabricationInput, FabricationKind};
use crate::output::Provenance;
use crate::progress::never;

/// Name and version of the format of `fabrication.json`.
pub const SCHEMA: &str = "voxelastica/fabrication/1";

/// The record, relative to the design's folder.
pub const FILE: &str = "fabrication/fabrication.json";

/// Largest record that is read, bytes.
const LARGEST: u64 = 64 << 20;

/// Endings of the files that this library makes.
const ENDINGS: [&str; 9] = ["csv", "stl", "3mf", "png", "gcvf", "dxf", "svg", "glb", "json"];

/// The kinds that an earlier run left in a design's folder.
#[derive(Debug, Default)]
pub struct Earlier {
    /// Version, seed and hash of the design that they were made of.
    provenance: Value,
    kinds: Map<String, Value>,
}

impl Earlier {
    /// Reads the record in a design's folder; nothing where there is none or it is not ours.
    #[must_use]
    pub fn read(folder: &Path) -> Self {
        let read = || {
            let mut value: Value =
                serde_json::from_slice(&read_bytes(&folder.join(FILE), LARGEST, &never).ok()?).ok()?;
            (value["schema"] == SCHEMA).then_some(())?;
            let kinds = value["kinds"].as_object_mut().map(std::mem::take)?;
            Some(Self { provenance: value["provenance"].take(), kinds })
        };
        read().unwrap_or_default()
    }

    /// Whether it was made of the same design by the same version.
    #[must_use]
    pub fn is_of(&self, provenance: &Provenance) -> bool {
        serde_json::to_value(provenance).is_ok_and(|ours| ours == self.provenance)
    }

    /// Removes its files, except those that are written anew and those of kinds that stay.
    pub fn remove(&self, folder: &Path, written: &[String], staying: &Map<String, Value>) {
        let stays = |file: &str| {
            written.iter().any(|name| name == file) || staying.values().any(|kind| files(kind).any(|name| name == file))
        };
        let mut folders = vec![folder.join(FOLDER)];
        for file in self.kinds.values().flat_map(files).chain([FILE]).filter(|file| is_ours(file) && !stays(file)) {
            let path = folder.join(file);
            let _ = fs::remove_file(&path);
            folders.extend(path.parent().map(Path::to_owned));
        }
        folders.sort();
        folders.dedup();
        // Innermost first; only empty ones go.
        for folder in folders.iter().rev() {
            let _ = fs::remove_dir(folder);
        }
    }

    /// The kinds that stay beside those written now: of the same design, and not made again.
    #[must_use]
    pub fn staying(&self, provenance: &Provenance, made: &[(FabricationKind, Made)]) -> Map<String, Value> {
        if !self.is_of(provenance) {
            return Map::new();
        }
        let again = |name: &str| made.iter().any(|(kind, _)| kind.name() == name);
        self.kinds.iter().filter(|(name, _)| !again(name)).map(|(name, kind)| (name.clone(), kind.clone())).collect()
    }
}

fn files(kind: &Value) -> impl Iterator<Item = &str> {
    kind["files"].as_array().into_iter().flatten().filter_map(Value::as_str)
}

/// Whether a path in a record can be a file of this library: nothing else is ever removed.
fn is_ours(file: &str) -> bool {
    let path = Path::new(file);
    let inside = path.components().all(|part| matches!(part, Component::Normal(_)));
    let ending = path.extension().and_then(|e| e.to_str()).is_some_and(|e| ENDINGS.contains(&e));
    inside && ending && path.starts_with(FOLDER)
}

/// The contents of `fabrication.json`.
#[must_use]
pub fn document(
    input: &FabricationInput,
    provenance: &Provenance,
    made: &[(FabricationKind, Made)],
    mut kinds: Map<String, Value>,
) -> Value {
    for (kind, made) in made {
        let mut entry = Map::new();
        entry.insert("files".to_owned(), json!(made.files));
        entry.extend(made.details.clone());
        kinds.insert(kind.name().to_owned(), Value::Object(entry));
    }
    // The same order whatever was written first.
    let order = |name: &str| FabricationKind::from_name(name);
    let mut entries: Vec<(String, Value)> = kinds.into_iter().collect();
    entries.sort_by_key(|(name, _)| order(name));
    let kinds: Map<String, Value> = entries.into_iter().collect();
    json!({
        "schema": SCHEMA,
        "provenance": provenance,
        "settings": input,
        "files": kinds.values().flat_map(files).collect::<Vec<_>>(),
        "kinds": kinds,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_paths_that_can_be_ours_are_ever_removed() {
        for good in ["fabrication/spoke.gcvf", "fabrication/print_stack/slice_0001.png"] {
            assert!(is_ours(good), "{good}");
        }
        for bad in ["fabrication/../design.json", "/etc/passwd.json", "design.json", "fabrication/x.sh", "fabrication"]
        {
            assert!(!is_ours(bad), "{bad}");
        }
    }

    #[test]
    fn kinds_of_the_same_design_stay_and_the_others_files_go() {
        let root = tempfile::tempdir().unwrap();
        let of = |hash: &str| Provenance { version: "1".to_owned(), seed: 1, design_sha256: hash.to_owned() };
        let made = |file: &str| Made { files: vec![file.to_owned()], ..Made::default() };
        let input = FabricationInput::defaults().unwrap();
        let first = [
            (FabricationKind::Stl, made("fabrication/a.stl")),
            (FabricationKind::PrintStack, made("fabrication/print_stack/slice_0.png")),
        ];
        let text = document(&input, &of("x"), &first, Map::new()).to_string();
        fs::create_dir_all(root.path().join("fabrication/print_stack")).unwrap();
        let write = |file: &str, text: &str| fs::write(root.path().join(file), text).unwrap();
        write(FILE, &text);
        write("fabrication/a.stl", "a");
        write("fabrication/mine.txt", "mine");
        write("fabrication/print_stack/slice_0.png", "b");

        let again = [(FabricationKind::Stl, made("fabrication/b.stl"))];
        let earlier = Earlier::read(root.path());
        let staying = earlier.staying(&of("x"), &again);
        assert_eq!(staying.keys().collect::<Vec<_>>(), ["print_stack"]);
        earlier.remove(root.path(), &["fabrication/b.stl".to_owned(), FILE.to_owned()], &staying);
        assert!(!root.path().join("fabrication/a.stl").exists());
        assert!(root.path().join("fabrication/print_stack/slice_0.png").exists() && root.path().join(FILE).exists());

        let staying = earlier.staying(&of("y"), &again);
        assert!(staying.is_empty());
        earlier.remove(root.path(), &[], &staying);
        let left: Vec<_> =
            fs::read_dir(root.path().join("fabrication")).unwrap().map(|e| e.unwrap().file_name()).collect();
        assert_eq!(left, ["mine.txt"]);
    }
}
