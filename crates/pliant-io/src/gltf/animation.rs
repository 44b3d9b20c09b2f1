//! An animation: what each of its channels is at a time.
//!
//! Before the first key a channel has the value of the first, behind the last that of the last. Between two keys: the earlier one
//! (STEP), the straight line or for rotations the arc (LINEAR), or Hermite's cubic through both with their tangents (CUBICSPLINE).

use std::collections::BTreeMap;
use std::sync::Arc;

use super::accessor::{Reader, Wanted};
use super::affine::{Trs, slerp};
use crate::error::{Fault, Place, Reason};
use crate::note::Note;
use crate::text::quoted;

/// The animation that moves the nodes.
pub(super) struct Clip {
    pub(super) name: Arc<str>,
    /// When its last key is, in seconds.
    pub(super) end: f64,
    pub(super) channels: Vec<Channel>,
    samplers: Vec<Sampler>,
    /// How many channels are of what is not evaluated, and the first of them.
    still_count: usize,
    still: Option<String>,
}

pub(super) struct Channel {
    pub(super) node: usize,
    pub(super) path: Path,
    sampler: usize,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Path {
    Translation,
    Rotation,
    Scale,
    /// Of so many morph targets.
    Weights(usize),
}

struct Sampler {
    path: Path,
    times: Vec<f32>,
    /// One group a key; with cubic splines three: the tangent before, the value, the tangent behind.
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
    /// Numbers of a value.
    pub(super) fn width(self) -> usize {
        match self {
            Self::Translation | Self::Scale => 3,
            Self::Rotation => 4,
            Self::Weights(targets) => targets,
        }
    }
}

/// The node and the path in a pointer such as `/nodes/3/rotation`.
fn node_in(pointer: &str) -> Option<(usize, &str)> {
    let (node, path) = pointer.strip_prefix("/nodes/")?.split_once('/')?;
    let is_moved = ["translation", "rotation", "scale", "weights"].contains(&path);
    is_moved.then_some((node.parse().ok()?, path))
}

impl Clip {
    /// Reads an animation. `targets` says how many morph targets a node has.
    pub(super) fn read(
        reader: &mut Reader,
        animation: usize,
        targets: impl Fn(&Reader, usize) -> usize,
    ) -> Result<Self, Fault> {
        let at = |fault: Fault| fault.or_at(Place::Part("animation", animation));
        let mut clip = Self {
            name: reader.document.clip_name(animation).into(),
            end: 0.0,
            channels: Vec::new(),
            samplers: Vec::new(),
            still_count: 0,
            still: None,
        };
        // Ours of each of the file.
        let mut known = BTreeMap::new();
        let channels = std::mem::take(&mut reader.document.animations[animation].channels);
        for channel in &channels {
            let (node, path) = match (channel.target.node, channel.target.pointer()) {
                (Some(node), None) => (node, &channel.target.path[..]),
                (_, Some(pointer)) => {
                    let Some(target) = node_in(pointer) else {
                        clip.still_count += 1;
                        clip.still.get_or_insert_with(|| pointer.to_owned());
                        continue;
                    };
                    target
                }
                // Of a node that another extension names.
                (None, None) => continue,
            };
            if node >= reader.document.nodes.len() {
                let reason = format!("moves node {node}, which does not exist");
                return Err(at(Reason::Malformed(reason).into()));
            }
            let path = match path {
                "translation" => Path::Translation,
                "rotation" => Path::Rotation,
                "scale" => Path::Scale,
                "weights" => Path::Weights(targets(reader, node)),
                other => {
                    return Err(at(Reason::Unsupported(format!(
                        "moves {}, which is not evaluated; export it without",
                        quoted(other)
                    ))
                    .into()));
                }
            };
            if path.width() == 0 {
                continue; // weights of nothing
            }
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
                },
                channels.len(),
            )?;
        }
        Ok(clip)
    }

    /// What of it moves nothing here.
    pub(super) fn note(&self) -> Option<Note> {
        self.still.as_ref().map(|first| Note::StillTargets {
            count: self.still_count,
            first: first.clone(),
        })
    }

    /// Brings what a channel moves, one of the three parts of a node's place, to a time.
    pub(super) fn place(&self, channel: &Channel, time: f64, local: &mut Trs) {
        let sampler = &self.samplers[channel.sampler];
        match channel.path {
            Path::Translation => sampler.sample(time, &mut local.translation),
            Path::Rotation => sampler.sample(time, &mut local.rotation),
            Path::Scale => sampler.sample(time, &mut local.scale),
            Path::Weights(_) => {}
        }
    }

    /// Brings the weights that a channel moves to a time.
    pub(super) fn weights(&self, channel: &Channel, time: f64, weights: &mut Vec<f64>) {
        weights.resize(channel.path.width(), 0.0);
        self.samplers[channel.sampler].sample(time, weights);
    }
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
            return Err(malformed("does not exist".into()));
        };
        let (input, output) = (entry.input, entry.output);
        let interpolation = match &entry.interpolation[..] {
            "STEP" => Interpolation::Step,
            "LINEAR" => Interpolation::Linear,
            "CUBICSPLINE" => Interpolation::CubicSpline,
            other => {
                return Err(malformed(format!(
                    "interpolation {} is none of the format",
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
            let rises = times.last().is_none_or(|last| *last < time);
            if !rises || !time.is_finite() {
                return Err(malformed(format!("the time of key {key} does not rise")));
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

    /// Group `group` of the values.
    fn group(&self, group: usize) -> impl Iterator<Item = f64> + '_ {
        let width = self.path.width();
        let values = &self.values[group * width..][..width];
        values.iter().map(|&value| value.into())
    }

    /// The value of a key.
    fn key(&self, key: usize) -> impl Iterator<Item = f64> + '_ {
        self.group(match self.interpolation {
            Interpolation::CubicSpline => 3 * key + 1,
            _ => key,
        })
    }

    /// The value at a time; `value` has the width of the path.
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
        // Of the earlier value, its tangent behind, the later value, its tangent before.
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
        // x^3 - 2x at 1 and 3, with its slopes; the outer tangents are not used.
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
