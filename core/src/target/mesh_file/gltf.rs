//! glTF 2.0, as JSON or binary.
//!
//! The `gltf` crate parses the document; everything that refers to something else, which its iterators take on trust, is
//! looked up here with checks. Read are the triangles, strips and fans of every node of the default scene.

use std::collections::HashMap;
use std::io::BufReader;
use std::path::{Component, Path, PathBuf};

use base64::Engine;
use gltf::Glb;
use gltf::json::accessor::{ComponentType, GenericComponentType, Type};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index, Node, Root};
use nalgebra::{Matrix3, Matrix4, Quaternion, UnitQuaternion, Vector3};

use super::{BufferReader, shortened};
use crate::progress::{Cancelled, Watched, stops_at};
use crate::target::error::TargetError;
use crate::target::triangle_mesh::{TriangleMesh, check_counts};

/// Required extensions that change neither positions nor indices, or only the types of their numbers.
const HARMLESS: [&str; 3] = ["KHR_materials", "KHR_texture", "KHR_mesh_quantization"];

pub(super) fn read(bytes: &[u8], buffers: BufferReader, cancelled: Cancelled<'_>) -> Result<TriangleMesh, TargetError> {
    // The crate subtracts the header's 12 bytes from the declared length unchecked.
    if bytes.starts_with(b"glTF") {
        let length = bytes.get(8..12).and_then(|b| b.try_into().ok()).map_or(0, u32::from_le_bytes);
        if length < 12 || u64::from(length) > bytes.len() as u64 {
            return Err(TargetError::Truncated {
                format: "GLB",
                what: "bytes",
                declared: length.into(),
                held: bytes.len() as u64,
            });
        }
    }
    let damaged = |error: &dyn std::fmt::Display| refused(shortened(&error.to_string()));
    // Borrowed: the binary part may be as long as the file.
    let glb = if bytes.starts_with(b"glTF") { Some(Glb::from_slice(bytes).map_err(|e| damaged(&e))?) } else { None };
    let json = BufReader::new(Watched::new(glb.as_ref().map_or(bytes, |glb| &*glb.json), cancelled));
    let root: Root = serde_json::from_reader(json).map_err(|e| damaged(&e))?;
    let root = &root;
    let harmless = |name: &str| HARMLESS.iter().any(|start| name.starts_with(start));
    if let Some(name) = root.extensions_required.iter().find(|name| !harmless(name)) {
        return Err(refused(format!(
            "it requires the extension {}; export the mesh uncompressed and without extensions",
            shortened(name)
        )));
    }
    let mut reader = Reader {
        root,
        blob: glb.as_ref().and_then(|glb| glb.bin.as_deref()),
        cancelled,
        read: buffers,
        buffers: HashMap::new(),
        mesh: TriangleMesh::default(),
    };
    reader.scene()?;
    Ok(reader.mesh)
}

fn refused(reason: String) -> TargetError {
    TargetError::MeshFile { format: "glTF", reason }
}

/// A relative path from the URI of a buffer; nothing that leads out of the file's own folder.
pub(super) fn relative_path(uri: &str) -> Result<PathBuf, TargetError> {
    let refused = |reason: &str| TargetError::BufferUri { uri: shortened(uri), reason: String::from(reason) };
    let path = percent_decoded(uri).ok_or_else(|| refused("its %-codes are not valid"))?;
    if path.contains([':', '\\', '\0']) {
        return Err(refused("only files beside the glTF file are read, by a relative path with `/`"));
    }
    let inside = Path::new(&path).components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    if path.is_empty() || !inside {
        return Err(refused("absolute paths and `..` are not followed; put the file beside the glTF file"));
    }
    Ok(PathBuf::from(path))
}

fn percent_decoded(text: &str) -> Option<String> {
    let mut bytes = text.bytes();
    let mut out = Vec::with_capacity(text.len());
    while let Some(byte) = bytes.next() {
        if byte == b'%' {
            let digits = [bytes.next()?, bytes.next()?];
            let digits = std::str::from_utf8(&digits).ok()?;
            out.push(u8::from_str_radix(digits, 16).ok()?);
        } else {
            out.push(byte);
        }
    }
    String::from_utf8(out).ok()
}

struct Reader<'a> {
    root: &'a Root,
    blob: Option<&'a [u8]>,
    cancelled: Cancelled<'a>,
    read: BufferReader<'a>,
    buffers: HashMap<usize, Vec<u8>>,
    mesh: TriangleMesh,
}

impl<'a> Reader<'a> {
    /// Walks the default scene, or the first; without scenes, the nodes that are no other's children.
    fn scene(&mut self) -> Result<(), TargetError> {
        let scene = match self.root.scene {
            Some(index) => Some(self.get(&self.root.scenes, index, "scene")?),
            None => self.root.scenes.first(),
        };
        let children = |node: &Node| node.children.clone().unwrap_or_default();
        let starts: Vec<usize> = match scene {
            Some(scene) => scene.nodes.iter().map(Index::value).collect(),
            None => {
                let inner: std::collections::HashSet<usize> =
                    self.root.nodes.iter().flat_map(children).map(|c| c.value()).collect();
                (0..self.root.nodes.len()).filter(|i| !inner.contains(i)).collect()
            }
        };
        let mut seen = vec![false; self.root.nodes.len()];
        let mut open: Vec<(usize, Matrix4<f64>)> = starts.into_iter().map(|i| (i, Matrix4::identity())).collect();
        while let Some((index, parent)) = open.pop() {
            let node = self.root.nodes.get(index).ok_or_else(|| missing("node", index))?;
            // A node has at most one parent; this also ends circles.
            match seen.get_mut(index) {
                Some(seen) if !*seen => *seen = true,
                _ => return Err(refused(format!("node {index} is part of the scene twice"))),
            }
            let transform = parent * local_transform(node);
            open.extend(children(node).into_iter().map(|child| (child.value(), transform)));
            let Some(mesh) = node.mesh else { continue };
            for primitive in &self.get(&self.root.meshes, mesh, "mesh")?.primitives {
                self.primitive(primitive, &transform)?;
            }
        }
        Ok(())
    }

    fn get<T>(&self, list: &'a [T], index: Index<T>, what: &str) -> Result<&'a T, TargetError> {
        list.get(index.value()).ok_or_else(|| missing(what, index.value()))
    }

    fn primitive(&mut self, primitive: &Primitive, transform: &Matrix4<f64>) -> Result<(), TargetError> {
        let mode = match primitive.mode {
            Checked::Valid(mode) => mode,
            Checked::Invalid => return Err(refused(String::from("a primitive has an unknown mode"))),
        };
        if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            return Ok(());
        }
        let Some(&positions) = primitive.attributes.get(&Checked::Valid(Semantic::Positions)) else { return Ok(()) };
        let positions = self.get(&self.root.accessors, positions, "accessor")?;
        check_counts((self.mesh.vertices.len() as u64).saturating_add(positions.count.0), 0)?;
        let first = self.mesh.vertices.len();
        let values = self.numbers(positions, Type::Vec3)?;
        let count = values.len() / 3;
        for p in values.chunks_exact(3) {
            let &[x, y, z] = p else { continue };
            let p = transform.fixed_view::<3, 3>(0, 0) * Vector3::new(x, y, z) + transform.fixed_view::<3, 1>(0, 3);
            self.mesh.vertices.push(p.into());
        }
        let triangles = self.mesh.triangles.len() as u64;
        let order: Vec<u64> = match primitive.indices {
            Some(index) => {
                let accessor = self.get(&self.root.accessors, index, "accessor")?;
                check_counts(0, accessor.count.0 / 3 + triangles)?;
                self.numbers(accessor, Type::Scalar)?.into_iter().map(|i| i as u64).collect()
            }
            None => (0..count as u64).collect(),
        };
        if let Some(place) = order.iter().position(|&i| i >= count as u64) {
            let index = order.get(place).copied().unwrap_or(0);
            return Err(TargetError::IndexOutOfRange { triangle: place / 3, index, vertices: count });
        }
        let corners = |i: u64| (first as u64 + i) as u32;
        let before = order.len().saturating_sub(2);
        check_counts(0, triangles + if mode == Mode::Triangles { order.len() / 3 } else { before } as u64)?;
        let push = |mesh: &mut TriangleMesh, t: &[u64], flip: bool| {
            if let &[a, b, c] = t {
                mesh.triangles.push(if flip { [b, a, c] } else { [a, b, c] }.map(corners));
            }
        };
        match mode {
            Mode::TriangleStrip => {
                order.windows(3).enumerate().for_each(|(i, t)| push(&mut self.mesh, t, i % 2 == 1));
            }
            Mode::TriangleFan => {
                if let Some((&centre, rest)) = order.split_first() {
                    rest.windows(2).for_each(|w| {
                        if let &[b, c] = w {
                            push(&mut self.mesh, &[centre, b, c], false);
                        }
                    });
                }
            }
            _ => order.chunks_exact(3).for_each(|t| push(&mut self.mesh, t, false)),
        }
        Ok(())
    }

    /// The numbers of an accessor of the expected type, as they count in the model.
    fn numbers(&mut self, accessor: &Accessor, expected: Type) -> Result<Vec<f64>, TargetError> {
        let (Checked::Valid(kind), Checked::Valid(GenericComponentType(component))) =
            (accessor.type_, accessor.component_type)
        else {
            return Err(refused(String::from("an accessor has an unknown type")));
        };
        if kind != expected {
            return Err(refused(format!("an accessor holds {kind:?}, {expected:?} is needed")));
        }
        if accessor.sparse.is_some() {
            return Err(refused(String::from("sparse accessors are not read; export without them")));
        }
        let view = accessor.buffer_view.ok_or_else(|| refused(String::from("an accessor has no data")))?;
        let view = self.get(&self.root.buffer_views, view, "buffer view")?;
        let components = kind.multiplicity();
        let element = (component.size() * components) as u64;
        let stride = view.byte_stride.map_or(element, |stride| stride.0 as u64);
        if stride < element {
            return Err(refused(format!("a stride of {stride} bytes is less than an element's {element}")));
        }
        let offset = accessor.byte_offset.unwrap_or_default().0;
        let (start, held) = (view.byte_offset.unwrap_or_default().0, view.byte_length.0);
        let normalized = accessor.normalized;
        let (count, cancelled) = (accessor.count.0, self.cancelled);
        let buffer = self.buffer(view.buffer.value())?;
        let view_bytes = usize::try_from(start)
            .ok()
            .zip(usize::try_from(start.saturating_add(held)).ok())
            .and_then(|(from, to)| buffer.get(from..to))
            .ok_or(TargetError::Truncated {
                format: "glTF",
                what: "bytes up to the end of a buffer view",
                declared: start.saturating_add(held),
                held: buffer.len() as u64,
            })?;
        // Elements that fit: the last one needs no full stride.
        let room = (view_bytes.len() as u64).saturating_sub(offset);
        let fitting = if room < element { 0 } else { (room - element) / stride + 1 };
        if count > fitting {
            return Err(TargetError::Truncated { format: "glTF", what: "elements", declared: count, held: fitting });
        }
        let mut numbers = Vec::with_capacity(count as usize * components);
        let elements = view_bytes.get(offset as usize..).unwrap_or_default().chunks(stride.max(1) as usize);
        for (i, bytes) in elements.take(count as usize).enumerate() {
            if stops_at(i, cancelled) {
                return Err(TargetError::Cancelled);
            }
            let parts = bytes.chunks_exact(component.size()).take(components);
            numbers.extend(parts.filter_map(|part| number(part, component, normalized)));
        }
        Ok(numbers)
    }

    fn buffer(&mut self, index: usize) -> Result<&[u8], TargetError> {
        let buffer = self.root.buffers.get(index).ok_or_else(|| missing("buffer", index))?;
        let Some(uri) = &buffer.uri else {
            return self
                .blob
                .filter(|_| index == 0)
                .ok_or_else(|| refused(format!("buffer {index} has neither an address nor the file's binary part")));
        };
        if !self.buffers.contains_key(&index) {
            let bytes = match uri.strip_prefix("data:") {
                Some(data) => embedded(data, self.cancelled)?,
                None => (self.read)(uri)?,
            };
            let total = self.buffers.values().map(|b| b.len() as u64).sum::<u64>() + bytes.len() as u64;
            super::check_size(total)?;
            self.buffers.insert(index, bytes);
        }
        Ok(self.buffers.get(&index).map_or(&[], Vec::as_slice))
    }
}

fn missing(what: &str, index: usize) -> TargetError {
    refused(format!("it refers to {what} {index}, which it has not"))
}

/// Letters decoded between two questions whether to stop: a multiple of four, base64's group.
const DECODED: usize = 1 << 20;

fn embedded(data: &str, cancelled: Cancelled<'_>) -> Result<Vec<u8>, TargetError> {
    let refused = |reason: String| TargetError::BufferUri { uri: format!("data:{}...", shortened(data)), reason };
    let (_, text) =
        data.split_once(";base64,").ok_or_else(|| refused(String::from("only data embedded as base64 are read")))?;
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3);
    let mut pieces = text.as_bytes().chunks(DECODED).peekable();
    while let Some(piece) = pieces.next() {
        if cancelled() {
            return Err(TargetError::Cancelled);
        }
        // Padding may only end the last piece.
        if pieces.peek().is_some() && piece.contains(&b'=') {
            return Err(refused(String::from("padding stands within the base64 data")));
        }
        base64::engine::general_purpose::STANDARD
            .decode_vec(piece, &mut bytes)
            .map_err(|error| refused(error.to_string()))?;
    }
    Ok(bytes)
}

fn local_transform(node: &Node) -> Matrix4<f64> {
    if let Some(columns) = node.matrix {
        return Matrix4::from_column_slice(&columns.map(f64::from));
    }
    let [x, y, z, w] = node.rotation.unwrap_or_default().0.map(f64::from);
    let rotation = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)).to_rotation_matrix();
    let scale = Matrix3::from_diagonal(&Vector3::from(node.scale.unwrap_or([1.0; 3]).map(f64::from)));
    let mut transform = (rotation.matrix() * scale).to_homogeneous();
    for (k, t) in node.translation.unwrap_or_default().into_iter().enumerate() {
        transform[(k, 3)] = f64::from(t);
    }
    transform
}

/// One component; normalised integers count from -1 or 0 to 1 (glTF 2.0 specification, section 3.11).
fn number(bytes: &[u8], component: ComponentType, normalized: bool) -> Option<f64> {
    let (value, largest) = match component {
        ComponentType::I8 => (f64::from(i8::from_le_bytes(bytes.try_into().ok()?)), 127.0),
        ComponentType::U8 => (f64::from(u8::from_le_bytes(bytes.try_into().ok()?)), 255.0),
        ComponentType::I16 => (f64::from(i16::from_le_bytes(bytes.try_into().ok()?)), 32_767.0),
        ComponentType::U16 => (f64::from(u16::from_le_bytes(bytes.try_into().ok()?)), 65_535.0),
        ComponentType::U32 => (f64::from(u32::from_le_bytes(bytes.try_into().ok()?)), 4_294_967_295.0),
        ComponentType::F32 => return Some(f64::from(f32::from_le_bytes(bytes.try_into().ok()?))),
    };
    Some(if normalized { (value / largest).max(-1.0) } else { value })
}
