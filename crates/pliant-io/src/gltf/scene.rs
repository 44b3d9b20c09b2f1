//! glTF nodes, skins and clip, and their pose in a frame.
//!
//! Each node's transform is relative to its parent. Parents come first in [`Scene::order`], so
//! trees of any depth are evaluated without recursion. All bodies of a file share one pose, made
//! when the first of them asks for its frame.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use super::accessor::{Reader, Wanted, whole};
use super::affine::{Affine, Trs};
use super::animation::{Clip, Path};
use super::document::Node;
use crate::error::{Fault, Place, Reason};
use crate::memory::{Account, bytes_of};

/// Nodes and skins of a file, and the clip that moves them.
pub(super) struct Scene {
    parents: Vec<Option<u32>>,
    rest: Vec<Local>,
    order: Vec<u32>,
    skins: Vec<Skin>,
    pub(super) clip: Option<Clip>,
    /// Frames per second, and number of steps of the clip; the last step may be shorter.
    fps: f64,
    pub(super) steps: usize,
    pose: Mutex<Pose>,
}

/// Transform of a node relative to its parent.
#[derive(Clone, Copy)]
enum Local {
    Trs(Trs),
    Matrix(Affine),
}

/// Joints of a skin, and the inverse bind matrix of each.
struct Skin {
    joints: Vec<u32>,
    inverse_bind: Vec<Affine>,
}

/// Transforms of all nodes and skins in a frame.
#[derive(Default)]
pub(super) struct Pose {
    frame: Option<usize>,
    local: Vec<Trs>,
    /// World transform of every node.
    pub(super) nodes: Vec<Affine>,
    /// For every skin, the map from rest to the world for each of its joints.
    pub(super) skins: Vec<Vec<Affine>>,
    /// Weights that the clip gives to the morph targets of a node.
    pub(super) weights: BTreeMap<usize, Vec<f64>>,
}

/// Nodes and skins that a clip moves: found once, not for each body.
pub(super) struct Moves {
    /// Nodes that move by themselves or with a parent.
    nodes: Vec<bool>,
    /// Skins with a joint that moves.
    skins: Vec<bool>,
    /// Nodes whose morph targets the clip moves.
    weights: Vec<bool>,
}

impl Moves {
    /// Whether the clip moves the body of a node.
    pub(super) fn body(&self, node: usize, skin: Option<usize>) -> bool {
        let places = match skin {
            Some(skin) => self.skins.get(skin),
            None => self.nodes.get(node),
        };
        places.is_some_and(|moves| *moves) || self.weights[node]
    }
}

/// Most frames of a clip: six days at 30 per second.
const MOST_STEPS: u32 = 1 << 24;

impl Scene {
    /// Reads nodes and skins; `clip` moves them at `fps` frames per second.
    pub(super) fn read(reader: &mut Reader, clip: Option<Clip>, fps: f64) -> Result<Self, Fault> {
        let nodes = &reader.document.nodes;
        let (parents, order) = tree(nodes)?;
        reader
            .account
            .enter(bytes_of(&parents) + bytes_of(&order))?;
        let mut rest = Vec::new();
        for (number, node) in nodes.iter().enumerate() {
            let at = |reason: Reason| reason.at(Place::Part("node", number));
            let local = local(node).map_err(at)?;
            reader.account.push(&mut rest, local, nodes.len())?;
        }
        for channel in clip.iter().flat_map(|clip| &clip.channels) {
            if channel.path.places() && matches!(rest[channel.node], Local::Matrix(_)) {
                let reason = "has a matrix and is animated; \
                    only translation, rotation and scale can be";
                return Err(Reason::Malformed(reason.into()).at(Place::Part("node", channel.node)));
            }
        }
        let steps = match &clip {
            Some(clip) => steps(clip.end, fps)?,
            None => 0,
        };
        let mut scene = Self {
            parents,
            rest,
            order,
            skins: Vec::new(),
            clip,
            fps,
            steps,
            pose: Mutex::default(),
        };
        for skin in 0..reader.document.skins.len() {
            let at = |fault: Fault| fault.or_at(Place::Part("skin", skin));
            let skin = scene.read_skin(reader, skin).map_err(at)?;
            scene.skins.push(skin);
        }
        scene.enter_pose(&mut reader.account)?;
        Ok(scene)
    }

    fn read_skin(&self, reader: &mut Reader, skin: usize) -> Result<Skin, Fault> {
        let entry = &mut reader.document.skins[skin];
        let matrices = entry.inverse_bind_matrices;
        let mut joints = Vec::new();
        for joint in std::mem::take(&mut entry.joints) {
            if joint >= self.parents.len() {
                return Err(Reason::Malformed(format!("joint node {joint} does not exist")).into());
            }
            reader.account.push(&mut joints, joint as u32, 0)?;
        }
        let mut inverse_bind = Vec::new();
        if let Some(matrices) = matrices {
            reader.each_row(matrices, Wanted::MATRICES, |account, _, row| {
                let columns = std::array::from_fn(|at| row.get(at).copied().unwrap_or(0.0));
                Ok(account.push(&mut inverse_bind, Affine::from_columns(&columns), 0)?)
            })?;
            if inverse_bind.len() < joints.len() {
                let reason = format!(
                    "has {} inverse bind matrices for {} joints",
                    inverse_bind.len(),
                    joints.len()
                );
                return Err(Reason::Malformed(reason).into());
            }
        }
        Ok(Skin {
            joints,
            inverse_bind,
        })
    }

    /// Counts the memory of a pose.
    ///
    /// Morph weights are included: many nodes may share a mesh with many targets.
    fn enter_pose(&self, account: &mut Account) -> Result<(), Reason> {
        let channels = self.clip.iter().flat_map(|clip| &clip.channels);
        let widths: BTreeMap<usize, usize> = channels
            .filter(|channel| !channel.path.places())
            .map(|channel| (channel.node, channel.path.width()))
            .collect();
        let weights = widths.values().sum::<usize>() * size_of::<f64>();
        account.enter(weights as u64)?;
        let nodes = (self.rest.len() * (size_of::<Trs>() + size_of::<Affine>())) as u64;
        let joints: usize = self.skins.iter().map(|skin| skin.joints.len()).sum();
        Ok(account.enter(nodes + (joints * size_of::<Affine>()) as u64)?)
    }

    pub(super) fn skin_joints(&self, skin: usize) -> Option<usize> {
        self.skins.get(skin).map(|skin| skin.joints.len())
    }

    /// Nodes, skins and morph targets that the clip moves.
    pub(super) fn moves(&self) -> Moves {
        let mut nodes = vec![false; self.parents.len()];
        let mut weights = nodes.clone();
        for channel in self.clip.iter().flat_map(|clip| &clip.channels) {
            let moved = if channel.path.places() {
                &mut nodes
            } else {
                &mut weights
            };
            moved[channel.node] = true;
        }
        for &node in &self.order {
            if let Some(parent) = self.parents[node as usize] {
                nodes[node as usize] |= nodes[parent as usize];
            }
        }
        let any_joint = |skin: &Skin| skin.joints.iter().any(|&joint| nodes[joint as usize]);
        Moves {
            skins: self.skins.iter().map(any_joint).collect(),
            nodes,
            weights,
        }
    }

    /// Notes channels of the clip that move no body.
    ///
    /// A channel counts if it moves a node that is `shown`, a joint, or an ancestor of one.
    pub(super) fn note_still(&mut self, shown: &[bool]) {
        let Self {
            parents,
            order,
            skins,
            clip,
            ..
        } = self;
        let Some(clip) = clip else { return };
        let mut reaches = shown.to_vec();
        for &joint in skins.iter().flat_map(|skin| &skin.joints) {
            reaches[joint as usize] = true;
        }
        for &node in order.iter().rev() {
            if let (true, Some(parent)) = (reaches[node as usize], parents[node as usize]) {
                reaches[parent as usize] = true;
            }
        }
        clip.note_still(|channel| {
            if channel.path.places() {
                reaches[channel.node]
            } else {
                shown[channel.node]
            }
        });
    }

    /// Time of a frame in seconds.
    fn time(&self, frame: usize) -> f64 {
        match &self.clip {
            Some(clip) if frame >= self.steps => clip.end,
            _ => frame as f64 / self.fps,
        }
    }

    /// Calls `each` with the pose of a frame.
    pub(super) fn with_pose<T>(&self, frame: usize, each: impl FnOnce(&Pose) -> T) -> T {
        let mut pose = self.pose.lock().unwrap_or_else(PoisonError::into_inner);
        if pose.frame != Some(frame) {
            pose.frame = None;
            self.make(frame, &mut pose);
            pose.frame = Some(frame);
        }
        each(&pose)
    }

    fn make(&self, frame: usize, pose: &mut Pose) {
        pose.local.clear();
        pose.local.extend(self.rest.iter().map(|local| match local {
            Local::Trs(trs) => *trs,
            Local::Matrix(_) => Trs::IDENTITY,
        }));
        if let Some(clip) = &self.clip {
            let time = self.time(frame);
            for channel in &clip.channels {
                if channel.path.places() {
                    clip.place(channel, time, &mut pose.local[channel.node]);
                } else {
                    let weights = pose.weights.entry(channel.node).or_default();
                    clip.weights(channel, time, weights);
                }
            }
        }
        pose.nodes.resize(self.rest.len(), Affine::IDENTITY);
        for &node in &self.order {
            let node = node as usize;
            let local = match self.rest[node] {
                Local::Trs(_) => pose.local[node].matrix(),
                Local::Matrix(matrix) => matrix,
            };
            pose.nodes[node] = match self.parents[node] {
                Some(parent) => pose.nodes[parent as usize].after(&local),
                None => local,
            };
        }
        pose.skins.resize_with(self.skins.len(), Vec::new);
        for (maps, skin) in pose.skins.iter_mut().zip(&self.skins) {
            maps.clear();
            maps.extend(skin.joints.iter().enumerate().map(|(at, &joint)| {
                let joint = &pose.nodes[joint as usize];
                skin.inverse_bind
                    .get(at)
                    .map_or(*joint, |inverse| joint.after(inverse))
            }));
        }
    }
}

impl Path {
    /// Whether it is part of the transform of a node.
    fn places(self) -> bool {
        !matches!(self, Self::Weights(_))
    }
}

/// Parent of every node, and an order of the nodes in which parents come first. Takes O(n).
fn tree(nodes: &[Node]) -> Result<(Vec<Option<u32>>, Vec<u32>), Fault> {
    let at = |node: usize, why: String| Reason::Malformed(why).at(Place::Part("node", node));
    let mut parents = vec![None; nodes.len()];
    for (number, node) in nodes.iter().enumerate() {
        for &child in &node.children {
            match parents.get_mut(child) {
                None => return Err(at(number, format!("its child {child} does not exist"))),
                Some(Some(_)) => {
                    return Err(at(child, "is the child of more than one node".into()));
                }
                Some(parent) => *parent = Some(number as u32),
            }
        }
    }
    let mut order: Vec<u32> = (0..nodes.len() as u32)
        .filter(|&node| parents[node as usize].is_none())
        .collect();
    let mut next = 0;
    while let Some(&node) = order.get(next) {
        order.extend(
            nodes[node as usize]
                .children
                .iter()
                .map(|&child| child as u32),
        );
        next += 1;
    }
    if order.len() < nodes.len() {
        let mut reached = vec![false; nodes.len()];
        order.iter().for_each(|&node| reached[node as usize] = true);
        let lost = reached.iter().position(|reached| !reached).unwrap_or(0);
        return Err(at(
            lost,
            "its ancestors form a cycle; the nodes of a scene form trees".into(),
        ));
    }
    Ok((parents, order))
}

/// Transform of a node at rest.
fn local(node: &Node) -> Result<Local, Reason> {
    if let Some(matrix) = &node.matrix {
        return Ok(Local::Matrix(Affine::from_columns(matrix)));
    }
    let mut trs = Trs::IDENTITY;
    if let Some(translation) = &node.translation {
        trs.translation = **translation;
    }
    if let Some(rotation) = &node.rotation {
        trs.rotation = **rotation;
    }
    if let Some(scale) = &node.scale {
        trs.scale = **scale;
    }
    if trs.rotation == [0.0; 4] {
        return Err(Reason::Malformed(
            "its rotation is the zero quaternion; the identity is [0, 0, 0, 1]".into(),
        ));
    }
    Ok(Local::Trs(trs))
}

/// Number of steps of length 1 / `fps` in a clip; the last may be shorter.
///
/// A rest of less than a thousandth of a step does not count: times have 32 bits.
fn steps(end: f64, fps: f64) -> Result<usize, Reason> {
    let steps = (end.max(0.0) * fps - 1e-3).ceil().max(0.0);
    if steps > f64::from(MOST_STEPS) {
        return Err(Reason::ClipTooLong {
            seconds: end,
            most: MOST_STEPS,
            fps,
        });
    }
    Ok(whole(steps) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_frame_is_the_end_of_the_clip() {
        for (end, fps, expected) in [
            (0.0, 30.0, 0),
            (1.0, 30.0, 30),
            (1.01, 30.0, 31),
            (0.99, 30.0, 30),
            // Seventeen frames of 1/24 s, in 32 bits.
            (f64::from(17.0_f32 / 24.0), 24.0, 17),
            (f64::from(1.158_333_3_f32), 30.0, 35),
            (1e-9, 30.0, 0),
            (2.0, 0.25, 1),
        ] {
            assert_eq!(steps(end, fps).unwrap(), expected, "{end} {fps}");
        }
        assert!(steps(1e30, 30.0).is_err());
        assert!(steps(1e6, 1e6).is_err());
    }

    #[test]
    fn no_tree_is_too_deep_and_none_goes_round() {
        let chain = |length: usize, last: Option<usize>| -> Vec<Node> {
            let node = |number| Node {
                children: if number + 1 < length {
                    vec![number + 1]
                } else {
                    last.into_iter().collect()
                },
                ..Node::default()
            };
            (0..length).map(node).collect()
        };
        let (parents, order) = tree(&chain(200_000, None)).unwrap();
        assert_eq!((parents[199_999], order[199_999]), (Some(199_998), 199_999));
        for (length, last) in [(1, 0), (5, 0), (5, 3), (5, 9)] {
            assert!(tree(&chain(length, Some(last))).is_err(), "{length} {last}");
        }
    }
}
