//! glTF animations: the value of each channel at a time.
//!
//! Before the first key a channel has the first key's value, behind the last key the last one's.
//! Between two keys it has the earlier value (STEP), the linear interpolation (LINEAR), or
//! Hermite's cubic with the tangents at both (CUBICSPLINE). Rotations are interpolated along the
//! arc. A channel names a node, or by `KHR_animation_pointer` a place in the JSON: of a node, or
//! the weights of a mesh. Channels that are not evaluated, or move no body, are noted and no error.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::accessor::{Reader, Wanted};
use super::affine::{Trs, slerp};
use super::document::Target;
use crate::error::{Fault, Place, Reason};
use crate::memory::bytes_of;
use crate::note::Note;
use crate::text::quoted;

/// The animation that moves the nodes.
pub(super) struct Clip {
    pub(super) name: Arc<str>,
    /// Time of its last key, in seconds.
    pub(super) end: f64,
    pub(super) channels: Vec<Channel>,
    samplers: Vec<Sampler>,
    still: Still,
}

/// Channels that move nothing here.
#[derive(Default)]
struct Still {
    count: usize,
    /// Number in the file and target of the first of them.
    first: Option<(usize, String)>,
}

impl Still {
    fn add(&mut self, number: usize, target: impl FnOnce() -> String) {
        self.count += 1;
        if self.first.as_ref().is_none_or(|first| number < first.0) {
            self.first = Some((number, target()));
        }
    }
}

/// A channel: the node and property that it moves, and its sampler.
pub(super) struct Channel {
    pub(super) node: usize,
    pub(super) path: Path,
    sampler: usize,
    /// Number among the channels of the file.
    number: u32,
    /// The mesh, where the channel names a mesh instead of its node.
    ///
    /// A channel that names the node takes precedence.
    mesh: Option<u32>,
}

/// The property of a node that a channel moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Path {
    Translation,
    Rotation,
    Scale,
    /// The weights of this many morph targets.
    Weights(usize),
}

/// Keys of a channel: times and values.
struct Sampler {
    path: Path,
    times: Vec<f32>,
    /// One value for each key; in cubic splines three: in-tangent, value, out-tangent.
    values: Vec<f32>,
    interpolation: Interpolation,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Interpolation {
    Step,
    Linear,
    CubicSpline,
}

impl Path {
    /// Numbers per value.
    pub(super) fn width(self) -> usize {
        match self {
            Self::Translation | Self::Scale => 3,
            Self::Rotation => 4,
            Self::Weights(targets) => targets,
        }
    }

    /// Parses the name of a property; None if it is not evaluated.
    fn named(path: &str, targets: impl FnOnce() -> usize) -> Option<Self> {
        Some(match path {
            "translation" => Self::Translation,
            "rotation" => Self::Rotation,
            "scale" => Self::Scale,
            "weights" => Self::Weights(targets()),
            _ => return None,
        })
    }

    /// Name of the property in targets and pointers.
    fn name(self) -> &'static str {
        match self {
            Self::Translation => "translation",
            Self::Rotation => "rotation",
            Self::Scale => "scale",
            Self::Weights(_) => "weights",
        }
    }
}

/// Target of a channel.
enum Moved<'a> {
    Node(usize, &'a str),
    /// The weights of a mesh, for all its nodes that have none of their own.
    Mesh(usize),
    Nothing,
}

impl<'a> Moved<'a> {
    fn by(target: &'a Target) -> Self {
        match (target.pointer(), target.node) {
            (Some(pointer), _) => Self::at(pointer).unwrap_or(Self::Nothing),
            (None, Some(node)) => Self::Node(node, &target.path),
            // Named by another extension.
            (None, None) => Self::Nothing,
        }
    }

    /// Parses a JSON pointer such as `/nodes/3/rotation`.
    fn at(pointer: &'a str) -> Option<Self> {
        let (kind, rest) = pointer.strip_prefix('/')?.split_once('/')?;
        let (number, path) = rest.split_once('/')?;
        let number = number.parse().ok()?;
        match (kind, path) {
            ("nodes", _) => Some(Self::Node(number, path)),
            ("meshes", "weights") => Some(Self::Mesh(number)),
            _ => None,
        }
    }
}

/// Target of a channel as a JSON pointer.
fn said(target: &Target) -> String {
    match (target.pointer(), target.node) {
        (Some(pointer), _) => pointer.to_owned(),
        (None, Some(node)) => format!("/nodes/{node}/{}", target.path),
        (None, None) => target.path.clone(),
    }
}

impl Clip {
    /// Reads an animation. `targets`: number of morph targets of a node.
    pub(super) fn read(
        reader: &mut Reader,
        animation: usize,
        targets: impl Fn(&Reader, usize) -> usize,
    ) -> Result<Self, Fault> {
        let at = |fault: Fault| fault.or_at(Place::Part("animation", animation));
        let malformed = |why: String| at(Reason::Malformed(why).into());
        let mut clip = Self {
            name: reader.document.clip_name(animation).into(),
            end: 0.0,
            channels: Vec::new(),
            samplers: Vec::new(),
            still: Still::default(),
        };
        // Our sampler for each sampler of the file, and the meshes whose weights have been met.
        let (mut known, mut meshes) = (BTreeMap::new(), BTreeSet::new());
        let mut of_meshes = None;
        let channels = std::mem::take(&mut reader.document.animations[animation].channels);
        for (number, channel) in channels.iter().enumerate() {
            let one;
            let (nodes, path, mesh): (&[u32], _, _) = match Moved::by(&channel.target) {
                Moved::Node(node, path) => {
                    if node >= reader.document.nodes.len() {
                        let reason = format!("moves node {node}, which does not exist");
                        return Err(malformed(reason));
                    }
                    one = [node as u32];
                    (&one, path, None)
                }
                Moved::Mesh(mesh) => {
                    if !meshes.insert(mesh) {
                        let reason = format!("moves the weights of mesh {mesh} more than once");
                        return Err(malformed(reason));
                    }
                    let of_meshes = match &mut of_meshes {
                        Some(found) => found,
                        none => none.insert(nodes_of_meshes(reader)?),
                    };
                    let nodes = of_meshes.get(&mesh);
                    let nodes = nodes.map_or(&[][..], |nodes| &nodes[..]);
                    (nodes, "weights", Some(mesh as u32))
                }
                Moved::Nothing => (&[], "", None),
            };
            let before = clip.channels.len();
            for &node in nodes {
                let node = node as usize;
                let path = Path::named(path, || targets(reader, node));
                // Not evaluated, or weights of no morph target.
                let Some(path) = path.filter(|path| path.width() > 0) else {
                    continue;
                };
                let key = (channel.sampler, path);
                let sampler = if let Some(&sampler) = known.get(&key) {
                    sampler
                } else {
                    let sampler =
                        Sampler::read(reader, animation, channel.sampler, path).map_err(at)?;
                    let last = sampler.times.last().copied().unwrap_or(0.0);
                    clip.end = clip.end.max(last.into());
                    clip.samplers.push(sampler);
                    known.insert(key, clip.samplers.len() - 1);
                    clip.samplers.len() - 1
                };
                reader.account.push(
                    &mut clip.channels,
                    Channel {
                        node,
                        path,
                        sampler,
                        number: number as u32,
                        mesh,
                    },
                    channels.len(),
                )?;
            }
            if clip.channels.len() == before {
                clip.still.add(number, || said(&channel.target));
            }
        }
        if !meshes.is_empty() {
            // Of two channels that move the same, the later counts.
            let channels = &mut clip.channels;
            channels.sort_unstable_by_key(|it| (it.mesh.is_none(), it.number, it.node));
        }
        let of_meshes = of_meshes.iter().flat_map(BTreeMap::values);
        reader
            .account
            .take_off(of_meshes.map(|nodes| bytes_of(nodes)).sum());
        Ok(clip)
    }

    /// Notes channels none of whose parts moves anything, according to `moves`.
    pub(super) fn note_still(&mut self, moves: impl Fn(&Channel) -> bool) {
        let Self {
            channels, still, ..
        } = self;
        for parts in channels.chunk_by(|a, b| a.number == b.number) {
            if let [first, ..] = parts
                && !parts.iter().any(&moves)
            {
                still.add(first.number as usize, || match first.mesh {
                    Some(mesh) => format!("/meshes/{mesh}/weights"),
                    None => format!("/nodes/{}/{}", first.node, first.path.name()),
                });
            }
        }
    }

    /// A note about the channels that move nothing.
    pub(super) fn note(&self) -> Option<Note> {
        let Still { count, first } = &self.still;
        first.as_ref().map(|(_, first)| Note::StillTargets {
            count: *count,
            first: first.clone(),
        })
    }

    /// Sets the translation, rotation or scale that a channel moves to its value at `time`.
    pub(super) fn place(&self, channel: &Channel, time: f64, local: &mut Trs) {
        let sampler = &self.samplers[channel.sampler];
        match channel.path {
            Path::Translation => sampler.sample(time, &mut local.translation),
            Path::Rotation => sampler.sample(time, &mut local.rotation),
            Path::Scale => sampler.sample(time, &mut local.scale),
            Path::Weights(_) => {}
        }
    }

    /// Sets the morph weights that a channel moves to their values at `time`.
    pub(super) fn weights(&self, channel: &Channel, time: f64, weights: &mut Vec<f64>) {
        weights.resize(channel.path.width(), 0.0);
        self.samplers[channel.sampler].sample(time, weights);
    }
}

/// For each mesh its nodes without weights of their own. The account still counts them afterwards.
fn nodes_of_meshes(reader: &mut Reader) -> Result<BTreeMap<usize, Vec<u32>>, Reason> {
    let Reader {
        document, account, ..
    } = reader;
    let mut of_meshes: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
    for (number, node) in (0..).zip(&document.nodes) {
        if let (Some(mesh), None) = (node.mesh, &node.weights) {
            account.push(of_meshes.entry(mesh).or_default(), number, 0)?;
        }
    }
    Ok(of_meshes)
}

impl Sampler {
    fn read(
        reader: &mut Reader,
        animation: usize,
        number: usize,
        path: Path,
    ) -> Result<Self, Fault> {
        let malformed =
            |why: String| Fault::from(Reason::Malformed(format!("sampler {number}: {why}")));
        let Some(entry) = reader.document.animations[animation].samplers.get(number) else {
            let reason = format!("a channel names sampler {number}, which does not exist");
            return Err(Reason::Malformed(reason).into());
        };
        let (input, output) = (entry.input, entry.output);
        let interpolation = match &entry.interpolation[..] {
            "STEP" => Interpolation::Step,
            "LINEAR" => Interpolation::Linear,
            "CUBICSPLINE" => Interpolation::CubicSpline,
            other => {
                return Err(malformed(format!(
                    "interpolation {} is unknown; it must be STEP, LINEAR or CUBICSPLINE",
                    quoted(other)
                )));
            }
        };
        let mut sampler = Self {
            path,
            times: Vec::new(),
            values: Vec::new(),
            interpolation,
        };
        let times = &mut sampler.times;
        reader.each_row(input, Wanted::TIMES, |account, key, row| {
            let time = row[0] as f32;
            if !time.is_finite() {
                return Err(malformed(format!("the time of key {key} is not finite")));
            }
            if let Some(last) = times.last()
                && *last >= time
            {
                return Err(malformed(format!(
                    "the time of key {key}, {time:?}, is not later than {last:?} before it"
                )));
            }
            Ok(account.push(times, time, 0)?)
        })?;
        if times.is_empty() {
            return Err(malformed("has no keys".into()));
        }
        let values = &mut sampler.values;
        let wanted = match path {
            Path::Translation | Path::Scale => Wanted::VECTORS,
            Path::Rotation => Wanted::ROTATIONS,
            Path::Weights(_) => Wanted::MORPHS,
        };
        reader.each_row(output, wanted, |account, _, row| {
            for &value in row {
                account.push(values, value as f32, 0)?;
            }
            Ok(())
        })?;
        let groups = if interpolation == Interpolation::CubicSpline {
            3
        } else {
            1
        };
        let needed = times.len().saturating_mul(groups * path.width());
        if values.len() != needed {
            return Err(malformed(format!(
                "{} keys need {needed} numbers, there are {}",
                times.len(),
                values.len()
            )));
        }
        Ok(sampler)
    }

    /// Value number `group` in the list of values.
    fn group(&self, group: usize) -> impl Iterator<Item = f64> + '_ {
        let width = self.path.width();
        let values = &self.values[group * width..][..width];
        values.iter().map(|&value| value.into())
    }

    /// Value of a key.
    fn key(&self, key: usize) -> impl Iterator<Item = f64> + '_ {
        self.group(match self.interpolation {
            Interpolation::CubicSpline => 3 * key + 1,
            _ => key,
        })
    }

    /// Writes the value at `time` to `value`, which has the width of the path. Takes O(log keys).
    fn sample(&self, time: f64, value: &mut [f64]) {
        // The first key that is later.
        let next = self.times.partition_point(|&key| f64::from(key) <= time);
        let put = |value: &mut [f64], from: &mut dyn Iterator<Item = f64>| {
            value
                .iter_mut()
                .zip(from)
                .for_each(|(value, from)| *value = from);
        };
        let stays = self.interpolation == Interpolation::Step;
        if next == 0 || next == self.times.len() || stays {
            return put(value, &mut self.key(next.saturating_sub(1)));
        }
        let last = next - 1;
        let [from, to] = [last, next].map(|key| f64::from(self.times[key]));
        let step = to - from;
        let t = (time - from) / step;
        if self.interpolation == Interpolation::Linear {
            if let ([x, y, z, w], Path::Rotation) = (&mut *value, self.path) {
                let [mut a, mut b] = [[0.0; 4]; 2];
                put(&mut a, &mut self.key(last));
                put(&mut b, &mut self.key(next));
                [*x, *y, *z, *w] = slerp(a, b, t);
                return;
            }
            let between = self.key(last).zip(self.key(next));
            return put(value, &mut between.map(|(a, b)| a + (b - a) * t));
        }
        let (t2, t3) = (t * t, t * t * t);
        // Hermite weights: earlier value, its out-tangent, later value, its in-tangent.
        let [of_a, of_out, of_b, of_in] = [
            2.0 * t3 - 3.0 * t2 + 1.0,
            (t3 - 2.0 * t2 + t) * step,
            3.0 * t2 - 2.0 * t3,
            (t3 - t2) * step,
        ];
        let a = self.key(last).zip(self.group(3 * last + 2));
        let b = self.key(next).zip(self.group(3 * next));
        let sum = a
            .zip(b)
            .map(|((a, out), (b, into))| of_a * a + of_out * out + of_b * b + of_in * into);
        let mut sum = sum;
        put(value, &mut sum);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampler(interpolation: Interpolation, times: &[f32], values: &[f32]) -> Sampler {
        Sampler {
            path: Path::Weights(1),
            times: times.to_vec(),
            values: values.to_vec(),
            interpolation,
        }
    }

    fn at(sampler: &Sampler, time: f64) -> f64 {
        let mut value = [f64::NAN];
        sampler.sample(time, &mut value);
        value[0]
    }

    #[test]
    fn between_keys_and_beyond() {
        let keys = [1.0, 2.0, 4.0];
        let step = sampler(Interpolation::Step, &keys, &[5.0, 7.0, 3.0]);
        let linear = sampler(Interpolation::Linear, &keys, &[5.0, 7.0, 3.0]);
        for (time, stepped, straight) in [
            (-1.0, 5.0, 5.0),
            (1.0, 5.0, 5.0),
            (1.75, 5.0, 6.5),
            (2.0, 7.0, 7.0),
            (3.0, 7.0, 5.0),
            (4.0, 3.0, 3.0),
            (9.0, 3.0, 3.0),
        ] {
            assert_eq!(
                [at(&step, time), at(&linear, time)],
                [stepped, straight],
                "{time}"
            );
        }
        let one = sampler(Interpolation::CubicSpline, &[1.0], &[9.0, 5.0, 9.0]);
        assert_eq!([at(&one, 0.0), at(&one, 1.0), at(&one, 2.0)], [5.0; 3]);
    }

    #[test]
    fn a_cubic_spline_is_the_cubic_it_was_made_of() {
        // The cubic x^3 - 2x at 1 and 3, with its slopes; the outer tangents are not used.
        let cubic = |x: f64| x * x * x - 2.0 * x;
        let slope = |x: f64| 3.0 * x * x - 2.0;
        let values = [99.0, cubic(1.0), slope(1.0), slope(3.0), cubic(3.0), 99.0];
        let spline = sampler(
            Interpolation::CubicSpline,
            &[1.0, 3.0],
            &values.map(|value| value as f32),
        );
        for time in [1.0, 1.25, 2.0, 2.875, 3.0] {
            assert!((at(&spline, time) - cubic(time)).abs() < 1e-12, "{time}");
        }
    }
}
