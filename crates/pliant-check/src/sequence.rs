//! Sources read side by side, and a world that is brought to their frames.
//!
//! The world gets a new mesh only if the mesh of a source, or its closed seams, have changed. If
//! only seams have changed, triangles keep their numbers. Between two frames, seams are closed that
//! are closed in both. For impacts, the later frame becomes the end of a motion, which finishes
//! when that frame is asked for. So each frame is read once.

use crate::any_world::{AnyWorld, NotTaken};
use crate::error::Error;
use crate::labels::SourceLabels;
use crate::rest::RestShape;
use crate::{one_point, with_world};
use pliant::{BodyId, Labels, Options};
use pliant_io::{Body as Source, Positions, Precision};
use std::collections::HashMap;

/// Number of a source's mesh, whatever seams are closed: [`Source::mesh_number`].
pub(crate) type MeshNumber = u64;

/// Number of the mesh of a source's first frame.
pub(crate) const FIRST: MeshNumber = 0;

/// Sources of a check and their world.
///
/// Frame counts are equal, or 1: such a source stands still while others move. In memory are the
/// reader's frame, the world's shape and its previous one. The previous shape's memory takes the
/// next. Sources widened to f64 take memory for that too.
pub(crate) struct Sequence {
    pub(crate) sources: Vec<Source>,
    pub(crate) frame_count: usize,
    pub(crate) world: AnyWorld,
    /// Scratch memory: positions widened from single precision.
    widened: Vec<[f64; 3]>,
    /// Body of the world for each source; empty before the first frame.
    pub(crate) ids: Vec<BodyId>,
    /// Number of the mesh that the world has for each source.
    pub(crate) meshes: Vec<MeshNumber>,
    /// Version of the world's triangles: incremented when a mesh or its seams change.
    pub(crate) given: usize,
    /// Rest shapes of all sources, if they are known.
    rest: Option<Vec<RestShape>>,
    /// Labels of the sources that have any.
    labels: Vec<Option<SourceLabels>>,
    /// Frame after the one that the sources are in.
    next: usize,
    /// Whether the sources that stand still were read.
    has_still: bool,
    /// Frame that the world is in; `None` while it changes.
    shown: Option<usize>,
    /// Frame at the end of the world's motion.
    moves_to: Option<usize>,
}

impl Sequence {
    /// Starts before the first frame. Refuses sources whose frame counts do not match.
    pub(crate) fn new(
        mut sources: Vec<Source>,
        rest: Option<RestShape>,
        options: Options,
    ) -> Result<Self, Error> {
        let Some(frame_count) = sources.iter().map(Source::frame_count).max() else {
            return Err(Error::NoSources);
        };
        let has_other_frames = |source: &&Source| ![1, frame_count].contains(&source.frame_count());
        if let Some(other) = sources.iter().find(has_other_frames) {
            let has_most = |source: &&Source| source.frame_count() == frame_count;
            let longest = sources.iter().find(has_most);
            return Err(Error::FrameCounts {
                longest: longest.map_or_else(String::new, |source| source.name().to_owned()),
                frames: frame_count,
                other: other.name().to_owned(),
                other_frames: other.frame_count(),
            });
        }
        let precision = sources.iter().map(Source::precision);
        let precision = precision
            .chain(rest.as_ref().map(|rest| rest.precision))
            .max();
        sources.iter_mut().for_each(Source::let_mesh_change);
        Ok(Self {
            meshes: vec![FIRST; sources.len()],
            given: 0,
            sources,
            frame_count,
            world: AnyWorld::new(precision.unwrap_or(Precision::F64), options),
            widened: Vec::new(),
            ids: Vec::new(),
            rest: rest.map(|rest| vec![rest]),
            labels: Vec::new(),
            next: 0,
            has_still: false,
            shown: None,
            moves_to: None,
        })
    }

    /// Brings the world to a frame. Skips frames before it; rewinds if the frame has gone by.
    pub(crate) fn go_to(&mut self, frame: usize) -> Result<(), Error> {
        if self.shown == Some(frame) {
            return Ok(());
        }
        self.shown = None;
        if self.moves_to.take() == Some(frame) {
            with_world!(&mut self.world, world => world.finish_motion());
            // Seams of the frame may differ from the seams of the motion.
            self.give(frame)?;
        } else {
            self.read_to(frame)?;
            self.give(frame)?;
        }
        self.give_rest(frame)?;
        self.give_labels(frame)?;
        self.shown = Some(frame);
        Ok(())
    }

    /// Labels the sources, which must be before the first frame.
    pub(crate) fn label(&mut self, labels: Vec<Option<SourceLabels>>) {
        self.labels = labels;
    }

    /// Gives labels to the bodies of the world that have none and should.
    fn give_labels(&mut self, frame: usize) -> Result<(), Error> {
        for (number, labels) in self.labels.iter().enumerate() {
            let (source, id) = (&self.sources[number], self.ids[number]);
            let Some(of_triangles) = labels else {
                continue;
            };
            let given = with_world!(&mut self.world, world => {
                if matches!(world.labels(id), Ok(Some(_))) {
                    continue;
                }
                if self.meshes[number] != FIRST {
                    let source_name = source.name().to_owned();
                    return Err(Error::LabelsChanged { source_name, frame });
                }
                let neighbours = None;
                world.set_labels(id, Some(Labels { of_triangles, neighbours }))
            });
            given.map_err(|error| not_taken(error.into(), source, frame))?;
        }
        Ok(())
    }

    /// Whether rest shapes are known.
    pub(crate) fn knows_rest(&self) -> bool {
        self.rest.is_some()
    }

    /// Makes the shapes of the frame in which the world is the rest shapes.
    pub(crate) fn rest_in(&mut self, frame: usize) -> Result<(), Error> {
        self.rest = Some(self.sources.iter().map(RestShape::of).collect());
        self.give_rest(frame)
    }

    /// Gives rest shapes to the bodies of the world that have none.
    fn give_rest(&mut self, frame: usize) -> Result<(), Error> {
        for (number, rest) in self.rest.iter().flatten().enumerate() {
            let (source, id) = (&self.sources[number], self.ids[number]);
            let has_one = with_world!(&self.world, world => {
                matches!(world.rest_positions(id), Ok(Some(_)))
            });
            if has_one {
                continue;
            }
            if rest.mesh != self.meshes[number] {
                let source_name = source.name().to_owned();
                return Err(Error::RestChanged { source_name, frame });
            }
            let narrow: Vec<[f32; 3]>;
            let positions = match self.world.precision() {
                Precision::F32 => {
                    // Exact: a world is of single precision if every shape is.
                    let all = rest.positions.iter();
                    narrow = all.map(|it| it.map(|x| x as f32)).collect();
                    Positions::F32(&narrow)
                }
                Precision::F64 => Positions::F64(&rest.positions),
            };
            let given = self
                .world
                .set_rest_positions(id, positions, &mut self.widened);
            given.map_err(|why| not_taken(why, source, frame))?;
        }
        Ok(())
    }

    /// Gives the world, which is in a frame, a motion to a later one.
    ///
    /// If meshes change on the way, nothing moves. Returns the numbers of these sources.
    pub(crate) fn move_to(&mut self, frame: usize) -> Result<Vec<usize>, Error> {
        if self.moves_to == Some(frame) {
            return Ok(Vec::new());
        }
        self.read_to(frame)?;
        let changes = |&number: &usize| self.sources[number].mesh_number() != self.meshes[number];
        let changed = (0..self.sources.len()).filter(changes);
        let changed: Vec<usize> = changed.collect();
        if !changed.is_empty() {
            return Ok(changed);
        }
        for (number, source) in self.sources.iter().enumerate() {
            if source.frame_count() == 1 {
                continue;
            }
            if !is_mesh_of(&self.world, self.ids[number], source) {
                let given = with_common_seams(&mut self.world, self.ids[number], source);
                given.map_err(|error| not_taken(error.into(), source, frame))?;
                self.given += 1;
                // The seams differ from the frame's now.
                self.shown = None;
            }
            let taken =
                self.world
                    .set_motion(self.ids[number], source.positions(), &mut self.widened);
            taken.map_err(|why| not_taken(why, source, frame))?;
        }
        self.moves_to = Some(frame);
        Ok(changed)
    }

    /// Reads a frame of every source, unless the sources are in it.
    pub(crate) fn read_to(&mut self, frame: usize) -> Result<(), Error> {
        if self.next == frame + 1 {
            return Ok(());
        }
        if frame < self.next {
            for source in self.sources.iter_mut().filter(|it| it.frame_count() > 1) {
                source.rewind()?;
            }
            self.next = 0;
        }
        for source in &mut self.sources {
            let stands = source.frame_count() == 1;
            if stands && self.has_still {
                continue;
            }
            if !stands {
                source.skip(frame - self.next);
            }
            if source.next_frame()?.is_none() {
                return Err(Error::Missing {
                    source_name: source.name().to_owned(),
                    frame: if stands { 0 } else { frame },
                    frames: source.frame_count(),
                });
            }
        }
        self.next = frame + 1;
        self.has_still = true;
        Ok(())
    }

    /// Gives the world the sources' current frame. The first call makes the bodies.
    fn give(&mut self, frame: usize) -> Result<(), Error> {
        for (number, source) in self.sources.iter().enumerate() {
            let makes = self.ids.len() == number;
            let stands = source.frame_count() == 1;
            if !makes && stands {
                continue;
            }
            let frame = if stands { 0 } else { frame };
            let mesh = source.mesh_number();
            if mesh != FIRST && (makes || mesh != self.meshes[number]) {
                one_point::check(source, frame)?;
            }
            self.meshes[number] = mesh;
            let keeps_mesh = !makes && is_mesh_of(&self.world, self.ids[number], source);
            self.given += usize::from(!keeps_mesh);
            let (triangles, positions) = (source.triangles(), source.positions());
            let Self { world, widened, .. } = self;
            let taken = if makes {
                let added = world.add(triangles, positions, widened);
                added.map(|id| self.ids.push(id))
            } else if keeps_mesh {
                world.set_positions(self.ids[number], positions, widened)
            } else {
                world.set_mesh(self.ids[number], triangles, positions, widened)
            };
            taken.map_err(|why| not_taken(why, source, frame))?;
        }
        Ok(())
    }
}

/// The error of a source whose frame the world did not take.
fn not_taken(why: NotTaken, source: &Source, frame: usize) -> Error {
    let source_name = source.name().to_owned();
    match why {
        NotTaken::Refused(error) => Error::Refused {
            source_name,
            frame,
            error,
        },
        // Cannot happen: a world is of double precision if any source is.
        NotTaken::WouldBeRounded => Error::Missing {
            source_name,
            frame,
            frames: source.frame_count(),
        },
    }
}

/// Gives a body of the world the seams that are closed both in it and in its source's frame.
///
/// Its positions stay.
fn with_common_seams(
    world: &mut AnyWorld,
    id: BodyId,
    source: &Source,
) -> Result<(), pliant::Error> {
    let all = source.unwelded();
    with_world!(world, world => {
        // Each vertex has a welded vertex in either frame. Vertices with the same two become one:
        // the smallest.
        let both = world.triangles(id)?.iter().zip(source.triangles());
        let both = both.flat_map(|(a, b)| std::array::from_fn::<_, 3, _>(|at| [a[at], b[at]]));
        let mut smallest: HashMap<[u32; 2], u32> = HashMap::new();
        for (leaders, &vertex) in both.clone().zip(all.as_flattened()) {
            let known = smallest.entry(leaders).or_insert(vertex);
            *known = vertex.min(*known);
        }
        let corners: Vec<u32> = both.map(|leaders| smallest[&leaders]).collect();
        let positions = world.positions(id)?;
        let (triangles, _) = corners.as_chunks();
        world.set_mesh(id, triangles, &positions)
    })
}

/// Whether a body of the world has its source's current mesh and seams.
fn is_mesh_of(world: &AnyWorld, id: BodyId, source: &Source) -> bool {
    with_world!(world, world => {
        world.vertex_count(id) == Ok(source.vertex_count())
            && world.triangles(id) == Ok(source.triangles())
    })
}
