//! Rest shapes of the sources: of one of their frames, or from a file.
//!
//! The world keeps a rest shape until a body gets another mesh, as when its seams open. So it is
//! given again from here, which only works for the mesh that it is of.

use crate::error::Error;
use pliant_io::{Body as Source, OpenOptions, Precision};
use std::path::Path;

/// Rest shape of a source.
pub(crate) struct RestShape {
    /// Number of the mesh that it is of: [`Source::mesh_number`].
    pub(crate) mesh: u64,
    pub(crate) positions: Vec<[f64; 3]>,
    pub(crate) precision: Precision,
}

impl RestShape {
    /// The shape of a source in its present frame.
    pub(crate) fn of(source: &Source) -> Self {
        let positions = source.positions();
        let vertices = 0..source.vertex_count() as u32;
        Self {
            mesh: source.mesh_number(),
            positions: vertices.map(|vertex| positions.get(vertex)).collect(),
            precision: source.precision(),
        }
    }

    /// The first frame of a file, for the mesh of the only source's first frame. `most` is the
    /// limit of its memory, in bytes.
    pub(crate) fn read(path: &Path, sources: &[Source], most: u64) -> Result<Self, Error> {
        let bad = |why: String| Error::BadRest {
            file: path.to_owned(),
            why,
        };
        let [source] = sources else {
            let count = sources.len();
            return Err(bad(format!("it is of one body, and {count} are checked")));
        };
        let name = path
            .to_str()
            .ok_or_else(|| bad("the name is not UTF-8".to_owned()))?;
        let options = OpenOptions {
            max_memory: most,
            files: source.among().clone(),
            ..OpenOptions::default()
        };
        let rest = pliant_io::open(name, &options)?;
        let sizes = [&rest, source].map(|it| (it.vertex_count(), it.triangles().len()));
        let [(rest_vertices, rest_triangles), (vertices, triangles)] = sizes;
        if sizes[0] != sizes[1] {
            return Err(bad(format!(
                "it has {rest_vertices} vertices and {rest_triangles} triangles, and {} has \
                 {vertices} and {triangles}",
                source.name()
            )));
        }
        let both = [rest.unwelded(), source.unwelded()];
        let differs = both[0].iter().zip(&both[1]).position(|(a, b)| a != b);
        if let Some(triangle) = differs {
            return Err(bad(format!(
                "its triangle {triangle} has the corners {:?}, and that of {} {:?}",
                both[0][triangle],
                source.name(),
                both[1][triangle]
            )));
        }
        Ok(Self {
            mesh: source.mesh_number(),
            ..Self::of(&rest)
        })
    }
}
