//! Bodies read side by side, frame by frame. In memory are the reader's frame and the world's (its shape and the one before it,
//! whose memory the next is written into); where a file is widened to f64, that too.

use anyhow::{Context, bail};
use pliant::{Scalar, World};
use pliant_io::{Body, OpenOptions, Positions, Precision};

/// The bodies of one check. Frame counts are equal, or 1: such a body stands still while others move.
pub(super) struct Sequence {
    bodies: Vec<Body>,
    frames: usize,
}

/// Coordinates as a world wants them, from a file of the same or a lower precision.
pub(super) trait FromFile: Scalar {
    /// The positions as they are in the file, or widened into `buffer`.
    fn from_file<'a>(positions: Positions<'a>, buffer: &'a mut Vec<[Self; 3]>) -> &'a [[Self; 3]];
}

impl FromFile for f32 {
    fn from_file<'a>(positions: Positions<'a>, buffer: &'a mut Vec<[f32; 3]>) -> &'a [[f32; 3]] {
        match positions {
            Positions::F32(positions) => positions,
            // Not reached: a world is f64 if any body is.
            Positions::F64(positions) => {
                buffer.clear();
                buffer.extend(positions.iter().map(|position| position.map(|x| x as f32)));
                buffer
            }
        }
    }
}

impl FromFile for f64 {
    fn from_file<'a>(positions: Positions<'a>, buffer: &'a mut Vec<[f64; 3]>) -> &'a [[f64; 3]] {
        match positions {
            Positions::F64(positions) => positions,
            Positions::F32(positions) => {
                buffer.clear();
                buffer.extend(positions.iter().map(|position| position.map(f64::from)));
                buffer
            }
        }
    }
}

impl Sequence {
    /// Opens all bodies and compares their frame counts.
    pub(super) fn open(arguments: &[String], options: &OpenOptions) -> anyhow::Result<Self> {
        let bodies = arguments
            .iter()
            .map(|argument| pliant_io::open_all(argument, options))
            .collect::<Result<Vec<_>, _>>()?;
        let bodies: Vec<Body> = bodies.into_iter().flatten().collect();
        let frames = bodies.iter().map(Body::frame_count).max().unwrap_or(0);
        let counted = |body: &Body| format!("{} has {}", body.name(), body.frame_count());
        if let Some(odd) = bodies
            .iter()
            .find(|body| ![1, frames].contains(&body.frame_count()))
        {
            let most = bodies
                .iter()
                .find(|body| body.frame_count() == frames)
                .map_or_else(String::new, counted);
            bail!(
                "frame counts must be equal or 1: {most} frames, {}",
                counted(odd)
            );
        }
        Ok(Self { bodies, frames })
    }

    pub(super) fn frame_count(&self) -> usize {
        self.frames
    }

    pub(super) fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// f64 if any body has it.
    pub(super) fn precision(&self) -> Precision {
        if self
            .bodies
            .iter()
            .any(|body| body.precision() == Precision::F64)
        {
            Precision::F64
        } else {
            Precision::F32
        }
    }

    /// Brings the world to a frame; frames come in order, and the first makes the bodies. `buffer` is scratch.
    pub(super) fn load_frame<S: FromFile>(
        &mut self,
        frame: usize,
        world: &mut World<S>,
        buffer: &mut Vec<[S; 3]>,
    ) -> anyhow::Result<()> {
        let ids: Vec<_> = world.bodies().collect();
        for (place, body) in self.bodies.iter_mut().enumerate() {
            if frame > 0 && body.frame_count() == 1 {
                continue;
            }
            let name = body.name().to_owned();
            let triangles = if frame == 0 {
                body.triangles().to_vec()
            } else {
                Vec::new()
            };
            let Some(positions) = body.next_frame()? else {
                bail!("{name}: frame {frame} is missing")
            };
            let positions = S::from_file(positions, buffer);
            if frame == 0 {
                world.add(&triangles, positions).with_context(|| name)?;
            } else {
                world
                    .set_positions(ids[place], positions)
                    .with_context(|| format!("{name}, frame {frame}"))?;
            }
        }
        Ok(())
    }
}
