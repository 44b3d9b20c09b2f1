//! glTF 2 and GLB reader: each node with a mesh in the default scene is a body, moved by one clip.
//!
//! ```text
//! nodes        each in its parent; moved by the clip: STEP, LINEAR, CUBICSPLINE
//! morph        rest + sum over targets of weight x delta
//! skin         sum over joints of weight x (joint in the world) x (inverse bind matrix),
//!              weights brought to a sum of 1
//! no skin      the node in the world
//! ```
//!
//! A frame is evaluated on demand, in f64, and rounded to f32 as in files. Source: the glTF 2.0
//! specification, 3.5, 3.7 and Appendix C. Sines come from `libm`: the same bits on every machine.
//!
//! - Data of the file are held: triangles until every body has its first frame, the rest only if
//!   there are more frames.
//! - Frames are at 0, 1/fps, 2/fps, ... and the clip's end. A body that no clip moves has one
//!   frame.
//! - The transform of a node with a skin is ignored, as specified.

mod accessor;
mod affine;
mod animation;
mod buffers;
mod document;
mod mesh;
mod meshopt;
mod scene;

use std::borrow::Cow;
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, HashMap};
use std::fmt::Write as _;
use std::sync::Arc;

use crate::error::{Fault, Place, Reason, listed};
use crate::file::Found;
use crate::frame::{Announced, Complete, Frame};
use crate::memory::{Account, bytes_of};
use crate::note::Note;
use crate::options::OpenOptions;
use crate::positions::Precision;
use crate::source::FrameSource;
use accessor::Reader;
use animation::Clip;
use mesh::{Delta, Mesh};
use scene::{Pose, Scene};

/// Vertices moved at a time: morph targets need a buffer of 96 KiB for them.
const AT_A_TIME: usize = 4096;

/// The bodies of a file, with their names.
pub(crate) struct Bodies {
    pub(crate) bodies: Vec<(String, GltfBody)>,
    /// Bytes that they share.
    pub(crate) held: u64,
}

/// Source of the frames of one body.
pub(crate) struct GltfBody {
    scene: Arc<Scene>,
    mesh: Arc<Mesh>,
    /// Triangles until the first frame; freed with the last body of the mesh that holds them.
    triangles: Option<Arc<Vec<[u32; 3]>>>,
    node: usize,
    skin: Option<usize>,
    /// Weights of morph targets unless the clip has some: the node's own, or the mesh's, which are
    /// shared.
    weights: Arc<[f64]>,
    moves: bool,
    next: usize,
    notes: Vec<Note>,
    /// [`Bodies::held`] of a file with a single body.
    held: u64,
}

/// Opens the one body of a file; an error if it has several.
pub(crate) fn open_one(found: &Found, options: &OpenOptions) -> Result<GltfBody, Fault> {
    let Bodies { mut bodies, held } = open(found, None, options)?;
    match bodies.pop() {
        Some((_, mut body)) if bodies.is_empty() => {
            body.held += held;
            Ok(body)
        }
        last => {
            let names = bodies.into_iter().chain(last).map(|(name, _)| name);
            Err(many_bodies(
                &names.collect::<Vec<_>>(),
                &found.path().display().to_string(),
            )
            .into())
        }
    }
}

/// Opens a file: all its bodies, or the one called `name`.
pub(crate) fn open(
    found: &Found,
    name: Option<&str>,
    options: &OpenOptions,
) -> Result<Bodies, Fault> {
    let fps = options.fps;
    if !(fps > 0.0 && fps.is_finite()) {
        return Err(Reason::BadRate { fps }.into());
    }
    let mut account = Account::new(options.max_memory);
    let (document, buffers) = buffers::open(found, &options.files, &mut account)?;
    let parsed = account.held();
    let mut reader = Reader {
        document,
        buffers,
        account,
        stay: 0,
    };
    let bodies = read(&mut reader, name, options);
    // Before the reader's own error: a change while reading is the likelier cause of it.
    reader.buffers.unchanged()?;
    let bodies = bodies?;
    reader.account.take_off(parsed);
    reader.buffers.forget_decoded(&mut reader.account);
    Ok(Bodies {
        bodies,
        held: reader.account.held(),
    })
}

fn read(
    reader: &mut Reader,
    name: Option<&str>,
    options: &OpenOptions,
) -> Result<Vec<(String, GltfBody)>, Fault> {
    let clip = read_clip(reader, options.clip.as_deref())?;
    let mut scene = Scene::read(reader, clip, options.fps)?;
    let shown = shown(reader)?;
    scene.note_still(&shown);
    let scene = Arc::new(scene);
    let nodes = nodes_with_meshes(reader, &shown);
    let mut names = names(reader, &nodes)?;
    let wanted = |at: &usize| name.is_none_or(|name| name == names[*at]);
    let wanted: Vec<usize> = (0..nodes.len()).filter(wanted).collect();
    let moves = scene.moves();
    let mut meshes = BTreeMap::new();
    let mut bodies = Vec::new();
    for at in wanted {
        let (node, number) = nodes[at];
        let mesh = match meshes.entry(number) {
            Entry::Occupied(mesh) => mesh.into_mut(),
            Entry::Vacant(place) => {
                let read = Mesh::read(reader, number)?;
                place.insert(read.map(|(mesh, triangles)| (Arc::new(mesh), Arc::new(triangles))))
            }
        };
        let Some((mesh, triangles)) = mesh.clone() else {
            continue;
        };
        let entry = &mut reader.document.nodes[node];
        let skin = entry.skin;
        let weights = match entry.weights.take() {
            Some(weights) => {
                reader.account.enter(bytes_of(&weights))?;
                weights.into()
            }
            None => mesh.weights.clone(),
        };
        if let Some(skin) = skin {
            let joints = scene.skin_joints(skin);
            let joints =
                joints.ok_or_else(|| Reason::Malformed(format!("skin {skin} does not exist")));
            let checked = joints.and_then(|joints| mesh.check_joints(joints));
            checked.map_err(|reason| reason.at(Place::Part("node", node)))?;
        }
        let body = GltfBody {
            moves: moves.body(node, skin),
            scene: scene.clone(),
            triangles: Some(triangles),
            held: mesh.memory_of_alike(skin.is_some()),
            mesh,
            node,
            skin,
            weights,
            next: 0,
            notes: Vec::new(),
        };
        let name = std::mem::take(&mut names[at]);
        let account = &mut reader.account;
        account.push(&mut bodies, (name, body), nodes.len())?;
    }
    if let Some((_, first)) = bodies.first_mut() {
        first.notes.extend(scene.clip.as_ref().and_then(Clip::note));
        first
            .notes
            .extend(has_no_scene(reader).then_some(Note::NoScene));
    }
    if bodies.is_empty() {
        return Err(match name {
            Some(name) if !names.iter().any(|known| known == name) => Reason::NoBody {
                name: name.to_owned(),
                names: listed(names.into_iter()),
            },
            _ => Reason::NoFaces,
        }
        .into());
    }
    reader.account.take_off(memory_of(&names));
    Ok(bodies)
}

/// Reads the animation of this name, or the first; None in a file without animations.
fn read_clip(reader: &mut Reader, name: Option<&str>) -> Result<Option<Clip>, Fault> {
    let document = &reader.document;
    let count = document.animations.len();
    let clip = match name {
        None => 0,
        // The body stands still, like a body of another format beside one that moves.
        Some(_) if count == 0 => return Ok(None),
        Some(name) => {
            let known = (0..count).position(|clip| document.clip_name(clip) == name);
            known.ok_or_else(|| Reason::NoClip {
                name: name.to_owned(),
                names: listed((0..count).map(|clip| document.clip_name(clip))),
            })?
        }
    };
    if clip >= count {
        return Ok(None);
    }
    Clip::read(reader, clip, |reader, node| {
        let document = &reader.document;
        let mesh = document
            .nodes
            .get(node)
            .and_then(|node| document.meshes.get(node.mesh?));
        mesh.and_then(|mesh| mesh.primitives.first())
            .map_or(0, |primitive| primitive.targets.len())
    })
    .map(Some)
}

/// Whether each node is in the default scene; all are if the file has no scene.
fn shown(reader: &Reader) -> Result<Vec<bool>, Fault> {
    let document = &reader.document;
    if has_no_scene(reader) {
        return Ok(vec![true; document.nodes.len()]);
    }
    let number = document.scene.unwrap_or(0);
    let Some(scene) = document.scenes.get(number) else {
        let reason = format!("scene {number} does not exist");
        return Err(Reason::Malformed(reason).into());
    };
    // A tree, as `Scene::read` has checked; a root that is listed twice counts once.
    let mut shown = vec![false; document.nodes.len()];
    let mut open = scene.nodes.clone();
    while let Some(node) = open.pop() {
        let Some(entry) = document.nodes.get(node) else {
            let reason = format!("node {node} does not exist");
            return Err(Reason::Malformed(reason).at(Place::Part("scene", number)));
        };
        if !std::mem::replace(&mut shown[node], true) {
            open.extend(&entry.children);
        }
    }
    Ok(shown)
}

fn has_no_scene(reader: &Reader) -> bool {
    reader.document.scenes.is_empty() && reader.document.scene.is_none()
}

/// Shown nodes with their meshes, in the order of nodes.
fn nodes_with_meshes(reader: &Reader, shown: &[bool]) -> Vec<(usize, usize)> {
    let nodes = reader.document.nodes.iter().enumerate().zip(shown);
    let with_meshes = nodes.filter(|&(_, shown)| *shown);
    with_meshes
        .filter_map(|((node, entry), _)| Some((node, entry.mesh?)))
        .collect()
}

/// A unique name for each body: the node's, or else the mesh's.
///
/// The number of the node follows where several have the same. A mesh's name is copied for each of
/// its nodes, so names are counted before they are made.
fn names(reader: &mut Reader, nodes: &[(usize, usize)]) -> Result<Vec<String>, Fault> {
    let Reader {
        document, account, ..
    } = reader;
    let said = |&(node, mesh): &(usize, usize)| -> Cow<'_, str> {
        let own = document.nodes[node].name.as_deref();
        let said = own.or_else(|| document.meshes.get(mesh)?.name.as_deref());
        said.map_or_else(|| format!("node {node}").into(), Cow::Borrowed)
    };
    let all: Vec<Cow<'_, str>> = nodes.iter().map(said).collect();
    account.enter(all.iter().map(|name| name.len() as u64).sum())?;
    let mut times: HashMap<&str, u32> = HashMap::new();
    for name in &all {
        *times.entry(name).or_default() += 1;
    }
    let mut names = Vec::with_capacity(all.len());
    for (name, (node, _)) in all.iter().zip(nodes) {
        let mut different = name.clone().into_owned();
        if times[&name[..]] > 1 {
            // Again while a node has this very name. Names that end in another number are
            // different.
            while times.contains_key(&different[..]) {
                let _ = write!(different, " (node {node})");
            }
            account.enter((different.len() - name.len()) as u64)?;
        }
        names.push(different);
    }
    Ok(names)
}

/// Bytes of names.
fn memory_of(names: &[String]) -> u64 {
    names.iter().map(|name| name.len() as u64).sum()
}

/// The error for a file of several bodies that is opened as one.
pub(crate) fn many_bodies(names: &[String], argument: &str) -> Reason {
    let first = names.first().map_or("", |name| &name[..]);
    Reason::ManyBodies {
        count: names.len(),
        example: format!("{argument}#{first}"),
        names: listed(names.iter().cloned()),
    }
}

impl GltfBody {
    fn read_frame(&mut self, frame: &mut Frame) -> Result<Complete, Fault> {
        let number = self.next;
        let place = if self.moves {
            Place::Frame(number as u64)
        } else {
            Place::Part("node", self.node)
        };
        let at = |reason: Reason| reason.at(place.clone());
        let triangles = self.triangles.take();
        let announced = Announced {
            vertices: self.mesh.rest.len() as u64,
            faces: triangles
                .as_ref()
                .map_or(0, |triangles| triangles.len() as u64),
        };
        frame.begin(Precision::F32, announced).map_err(at)?;
        match triangles {
            Some(triangles) => {
                for corners in &*triangles {
                    frame.face(corners, || place.clone()).map_err(at)?;
                }
            }
            None => frame.same_faces(),
        }
        self.scene
            .with_pose(number, |pose| self.place(pose, frame))
            .map_err(at)?;
        self.next += 1;
        frame.complete(0).map_err(|fault| fault.or_at(place))
    }

    /// Appends the positions of a pose, some at a time to limit the memory for morph targets.
    fn place(&self, pose: &Pose, frame: &mut Frame) -> Result<(), Reason> {
        let Self { mesh, .. } = self;
        let moved = pose.weights.get(&self.node);
        let weights = moved.map_or(&*self.weights, |weights| weights);
        // For each active morph target: its weight, and its remaining displacements by vertex.
        let mut targets: Vec<(f64, &[Delta])> = mesh
            .targets
            .iter()
            .zip(weights)
            .filter(|&(_, weight)| *weight != 0.0)
            .map(|(target, &weight)| (weight, &target[..]))
            .collect();
        let mut shapes = Vec::new();
        for (begin, rest) in (0..).step_by(AT_A_TIME).zip(mesh.rest.chunks(AT_A_TIME)) {
            shapes.clear();
            shapes.extend(rest.iter().map(|rest| rest.map(f64::from)));
            for (weight, left) in &mut targets {
                let end =
                    left.partition_point(|&(vertex, _)| (vertex as usize) < begin + rest.len());
                let (now, later) = left.split_at(end);
                for &(vertex, delta) in now {
                    for (x, d) in shapes[vertex as usize - begin].iter_mut().zip(delta) {
                        *x += *weight * f64::from(d);
                    }
                }
                *left = later;
            }
            for (vertex, &shape) in (begin..).zip(&shapes) {
                let position = self.position(pose, vertex, shape);
                frame.vertex(position.map(|x| f64::from(x as f32)))?;
            }
        }
        Ok(())
    }

    /// Position of a vertex in a pose; `shape`: its position at rest with morph targets applied.
    fn position(&self, pose: &Pose, vertex: usize, shape: [f64; 3]) -> [f64; 3] {
        let Some(joints) = self.skin.and_then(|skin| pose.skins.get(skin)) else {
            return pose.nodes[self.node].apply(shape);
        };
        let (mut sum, mut whole) = ([0.0; 3], 0.0);
        for influence in self.mesh.influences(vertex) {
            let weight = f64::from(influence.weight);
            let moved = joints[usize::from(influence.joint)].apply(shape);
            sum.iter_mut()
                .zip(moved)
                .for_each(|(sum, x)| *sum += weight * x);
            whole += weight;
        }
        sum.map(|x| x / whole)
    }
}

impl FrameSource for GltfBody {
    fn frame_count(&self) -> usize {
        if self.moves { self.scene.steps + 1 } else { 1 }
    }

    fn read(&mut self, frame: &mut Frame) -> Result<Complete, Fault> {
        self.read_frame(frame)
    }

    fn skip(&mut self, frames: usize) -> Result<(), Fault> {
        self.next += frames;
        Ok(())
    }

    fn rewind(&mut self) -> Result<bool, Fault> {
        self.next = 0;
        Ok(true)
    }

    fn held(&self) -> u64 {
        self.held
    }

    fn alike(&self) -> Option<Vec<u64>> {
        Some(self.mesh.alike(self.skin.is_some()))
    }

    fn moves_alike(&self, a: u32, b: u32) -> bool {
        self.skin.is_none() || self.mesh.weigh_alike(a, b)
    }

    fn notes(&self) -> Vec<Note> {
        self.notes.clone()
    }

    fn clip(&self) -> Option<&Arc<str>> {
        let clip = self.scene.clip.as_ref().filter(|_| self.moves);
        clip.map(|clip| &clip.name)
    }
}
