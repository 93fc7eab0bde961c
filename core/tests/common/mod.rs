//! A small reader of flat decks, for tests.

use std::collections::BTreeMap;
use std::path::Path;

use voxelastica_core::deck::{self, DeckPlan};
use voxelastica_core::input::files::Format;
use voxelastica_core::output::Provenance;
use voxelastica_core::{Design, DesignInput, Limits, progress};

/// Computes a design given as TOML.
pub fn design(text: &str) -> Design {
    let input = DesignInput::from_text(text, Format::Toml, "test.toml", "test", Path::new(".")).unwrap();
    Design::compute(&input, Limits::default()).unwrap()
}

/// A provenance that does not change with the version.
pub fn provenance() -> Provenance {
    Provenance { version: "0.0.0".to_owned(), seed: 1, design_sha256: "0".repeat(64) }
}

/// The text of a deck.
pub fn written(design: &Design, plan: &DeckPlan) -> String {
    let mut out = Vec::new();
    deck::write(design, plan, &provenance(), &mut out, &progress::ignore).unwrap();
    String::from_utf8(out).unwrap()
}

/// Nodes, elements and sets of a flat deck.
#[derive(Debug, Default)]
pub struct FlatDeck {
    pub nodes: BTreeMap<u64, [f64; 3]>,
    pub elements: BTreeMap<u64, Vec<u64>>,
    pub node_sets: BTreeMap<String, Vec<u64>>,
    pub element_sets: BTreeMap<String, Vec<u64>>,
}

impl FlatDeck {
    /// Reads what the tests need; everything else is skipped.
    pub fn read(text: &str) -> Self {
        let mut deck = Self::default();
        let (mut keyword, mut set, mut generate) = (String::new(), String::new(), false);
        for line in text.lines() {
            assert!(line.is_ascii() && line.len() <= 256, "{line}");
            if line.starts_with("**") {
                continue;
            }
            if line.starts_with('*') {
                let parts: Vec<&str> = line.split(',').map(str::trim).collect();
                keyword = parts[0].to_owned();
                generate = parts.contains(&"GENERATE");
                let named = |p: &&str| p.strip_prefix("NSET=").or(p.strip_prefix("ELSET=")).map(str::to_owned);
                set = parts.iter().find_map(named).unwrap_or_default();
                continue;
            }
            let ids = || line.split(',').map(|w| w.trim().parse::<u64>().unwrap()).collect::<Vec<_>>();
            match keyword.as_str() {
                "*NODE" => {
                    let mut words = line.split(',');
                    let id = words.next().unwrap().parse().unwrap();
                    let position: Vec<f64> = words.map(|w| w.parse().unwrap()).collect();
                    assert!(deck.nodes.insert(id, position.try_into().unwrap()).is_none(), "node {id} twice");
                    if !set.is_empty() {
                        deck.node_sets.entry(set.clone()).or_default().push(id);
                    }
                }
                "*ELEMENT" => {
                    let ids = ids();
                    assert!(deck.elements.insert(ids[0], ids[1..].to_vec()).is_none(), "element {} twice", ids[0]);
                    deck.element_sets.entry(set.clone()).or_default().push(ids[0]);
                }
                "*NSET" | "*ELSET" => {
                    let sets = if keyword == "*NSET" { &mut deck.node_sets } else { &mut deck.element_sets };
                    let ids = ids();
                    let members = sets.entry(set.clone()).or_default();
                    if generate {
                        members.extend((ids[0]..=ids[1]).step_by(ids[2] as usize));
                    } else {
                        members.extend(ids);
                    }
                }
                _ => {}
            }
        }
        deck
    }

    /// Jacobian determinants of a brick at its corners, times eight.
    pub fn corner_volumes(&self, element: u64) -> [f64; 8] {
        // Each corner's neighbours along the local axes, right-handed.
        const NEXT: [[usize; 3]; 8] =
            [[1, 3, 4], [2, 0, 5], [3, 1, 6], [0, 2, 7], [7, 5, 0], [4, 6, 1], [5, 7, 2], [6, 4, 3]];
        let corners: Vec<[f64; 3]> = self.elements[&element].iter().map(|n| self.nodes[n]).collect();
        let mut volumes = [0.0; 8];
        for (corner, next) in NEXT.iter().enumerate() {
            let edge = |n: usize| [0, 1, 2].map(|i| corners[next[n]][i] - corners[corner][i]);
            let (a, b, c) = (edge(0), edge(1), edge(2));
            volumes[corner] = a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                + a[2] * (b[0] * c[1] - b[1] * c[0]);
        }
        volumes
    }
}
