//! A small reader of shell decks, for tests.

use std::collections::BTreeMap;

/// A node or element: instance (empty in flat decks and for the assembly's own nodes) and number.
pub type Label = (String, u64);

/// What the tests look at, with instances expanded.
#[derive(Debug, Default)]
pub struct Model {
    pub nodes: BTreeMap<Label, [f64; 3]>,
    pub elements: BTreeMap<Label, Vec<Label>>,
    pub node_sets: BTreeMap<String, Vec<Label>>,
    pub element_sets: BTreeMap<String, Vec<Label>>,
    pub field: BTreeMap<Label, f64>,
    pub transforms: BTreeMap<String, Vec<f64>>,
    /// Node set and the reference node's set it is tied to.
    pub rigid: Vec<(String, String)>,
    pub equations: Vec<String>,
    pub amplitudes: BTreeMap<String, Vec<[f64; 2]>>,
    /// Value at the end of the step by set and degree of freedom.
    pub boundary: BTreeMap<(String, u8), f64>,
}

#[derive(Default)]
struct Part {
    nodes: Vec<(u64, [f64; 3])>,
    elements: Vec<Vec<u64>>,
}

impl Model {
    /// Reads a deck in parts or a flat one; what the tests do not look at is skipped.
    pub fn read(text: &str) -> Self {
        let mut model = Self::default();
        let mut parts: BTreeMap<String, Part> = BTreeMap::new();
        let mut part: Option<String> = None;
        for block in text.split("\n*").filter(|b| !b.starts_with('*')) {
            let mut lines = block.lines().filter(|l| !l.starts_with("**"));
            let head: Vec<&str> = lines.next().unwrap().trim_start_matches('*').split(',').map(str::trim).collect();
            let get = |key: &str| {
                let found = head.iter().find_map(|p| p.strip_prefix(key).and_then(|rest| rest.strip_prefix('=')));
                found.unwrap_or_default().to_owned()
            };
            let numbers = |line: &str| line.split(',').map(|w| w.parse::<f64>().unwrap()).collect::<Vec<_>>();
            match head[0] {
                "PART" => part = Some(get("NAME")),
                "END PART" => part = None,
                "INSTANCE" => {
                    let turn = lines.nth(1).map_or(0.0, |l| numbers(l)[6]).to_radians();
                    let (sin, cos) = turn.sin_cos();
                    let (name, part) = (get("NAME"), &parts[&get("PART")]);
                    for (id, [x, y, z]) in &part.nodes {
                        model.nodes.insert((name.clone(), *id), [x * cos - y * sin, x * sin + y * cos, *z]);
                    }
                    for ids in &part.elements {
                        let nodes = ids[1..].iter().map(|id| (name.clone(), *id)).collect();
                        model.elements.insert((name.clone(), ids[0]), nodes);
                    }
                }
                "NODE" => {
                    for line in lines {
                        let v = numbers(line);
                        let (id, point) = (v[0] as u64, [v[1], v[2], v[3]]);
                        match &part {
                            Some(part) => parts.entry(part.clone()).or_default().nodes.push((id, point)),
                            None => {
                                assert!(model.nodes.insert((String::new(), id), point).is_none());
                                let set = get("NSET");
                                if !set.is_empty() {
                                    model.node_sets.entry(set).or_default().push((String::new(), id));
                                }
                            }
                        }
                    }
                }
                "ELEMENT" => {
                    for line in lines {
                        let ids: Vec<u64> = numbers(line).iter().map(|v| *v as u64).collect();
                        match &part {
                            Some(part) => parts.entry(part.clone()).or_default().elements.push(ids),
                            None => {
                                let nodes = ids[1..].iter().map(|id| (String::new(), *id)).collect();
                                assert!(model.elements.insert((String::new(), ids[0]), nodes).is_none());
                                let label = (String::new(), ids[0]);
                                model.element_sets.entry(get("ELSET")).or_default().push(label);
                            }
                        }
                    }
                }
                "NSET" | "ELSET" => {
                    let owner = part.clone().unwrap_or_else(|| get("INSTANCE"));
                    let generate = head.contains(&"GENERATE");
                    let mut ids: Vec<u64> = Vec::new();
                    for line in lines {
                        let v: Vec<u64> = numbers(line).iter().map(|v| *v as u64).collect();
                        if generate { ids.extend((v[0]..=v[1]).step_by(v[2] as usize)) } else { ids.extend(v) }
                    }
                    let labels = ids.into_iter().map(|id| (owner.clone(), id));
                    if head[0] == "NSET" {
                        model.node_sets.entry(get("NSET")).or_default().extend(labels);
                    } else {
                        model.element_sets.entry(get("ELSET")).or_default().extend(labels);
                    }
                }
                "TRANSFORM" => {
                    model.transforms.insert(get("NSET"), numbers(lines.next().unwrap()));
                }
                "RIGID BODY" => model.rigid.push((get("TIE NSET"), get("REF NODE"))),
                "EQUATION" => model.equations.push(lines.collect::<Vec<_>>().join(" ")),
                "AMPLITUDE" => {
                    let values: Vec<f64> = lines.flat_map(numbers).collect();
                    model.amplitudes.insert(get("NAME"), values.chunks(2).map(|p| [p[0], p[1]]).collect());
                }
                "INITIAL CONDITIONS" => {
                    for line in lines {
                        let (name, value) = line.split_once(',').unwrap();
                        let value = value.parse().unwrap();
                        let (instance, label) = name.rsplit_once('.').unwrap_or(("", name));
                        let labels = match label.parse() {
                            Ok(id) => vec![(instance.to_owned(), id)],
                            Err(_) => model.node_sets[name].clone(),
                        };
                        model.field.extend(labels.into_iter().map(|l| (l, value)));
                    }
                }
                "BOUNDARY" => {
                    let amplitude = get("AMPLITUDE");
                    for line in lines {
                        let words: Vec<&str> = line.split(',').collect();
                        let value: f64 = words.get(3).map_or(0.0, |w| w.parse().unwrap());
                        let last = model.amplitudes.get(&amplitude).map_or(1.0, |a| a[a.len() - 1][1]);
                        for dof in words[1].parse::<u8>().unwrap()..=words[2].parse().unwrap() {
                            let known = model.boundary.insert((words[0].to_owned(), dof), value * last);
                            assert!(known.is_none(), "{line}");
                        }
                    }
                }
                // What comes after the morph is not what the flower is.
                "END STEP" => break,
                _ => {}
            }
        }
        model
    }

    /// Positions of the nodes of a set, in its order.
    pub fn points(&self, set: &str) -> Vec<[f64; 3]> {
        self.node_sets[set].iter().map(|n| self.nodes[n]).collect()
    }

    /// Positions of an element's nodes.
    pub fn corners(&self, element: &Label) -> Vec<[f64; 3]> {
        self.elements[element].iter().map(|n| self.nodes[n]).collect()
    }
}
