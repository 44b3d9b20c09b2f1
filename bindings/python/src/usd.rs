//! USD files as bodies of a check, evaluated frame by frame by `usd-core` in Python (`_usd.py`).
//!
//! Frames are read without the interpreter lock; a frame of USD takes it back. An exception of
//! Python meanwhile is kept aside and comes out of the call as it was.

use crate::answers::Any;
use crate::arrays::CopiedCoordinates;
use crate::error::{Refused, Result};
use pliant_io::{Body, Error, Evaluated, OpenOptions, Positions};
use pyo3::prelude::*;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// Exception that Python raised, kept until the call ends in which it came up.
#[derive(Clone, Default)]
pub(crate) struct Raised(Arc<Mutex<Option<PyErr>>>);

impl Raised {
    fn keep(&self, error: PyErr) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
    }

    /// The exception if one was raised, else the outcome.
    pub(crate) fn rather<T>(&self, outcome: Result<T>) -> Result<T> {
        let mut raised = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match raised.take() {
            Some(raised) => Err(Refused::Python(raised)),
            None => outcome,
        }
    }
}

/// Whether an argument names a USD file, or a prim of one.
pub(crate) fn is_usd(argument: &str) -> bool {
    let ends = |path: &str| {
        let ending = Path::new(path).extension().unwrap_or_default();
        ["usd", "usda", "usdc", "usdz"]
            .iter()
            .any(|usd| ending.eq_ignore_ascii_case(usd))
    };
    ends(argument)
        || argument
            .rsplit_once('#')
            .is_some_and(|(file, _)| ends(file))
}

/// A mesh of a stage.
struct Mesh {
    /// Object of `Mesh` in `_usd.py`.
    evaluator: Py<PyAny>,
    frames: usize,
    counts: Vec<u32>,
    corners: Vec<u32>,
    raised: Raised,
}

impl Evaluated for Mesh {
    fn frame_count(&self) -> usize {
        self.frames
    }

    fn polygons(&self) -> (&[u32], &[u32]) {
        (&self.counts, &self.corners)
    }

    fn positions(&mut self, frame: usize, list: &mut Vec<[f64; 3]>) -> Result<(), String> {
        let evaluated = Python::attach(|py| {
            let positions = self
                .evaluator
                .bind(py)
                .call_method1("positions", (frame,))?;
            let positions = CopiedCoordinates::of(&positions)?;
            match positions.get()? {
                Positions::F32(rows) => list.extend(rows.iter().map(|row| row.map(f64::from))),
                Positions::F64(rows) => list.extend_from_slice(rows),
            }
            Ok::<_, PyErr>(())
        });
        evaluated.map_err(|error| {
            self.raised.keep(error);
            "could not be evaluated".to_owned()
        })
    }
}

/// Opens the meshes that an argument names, in the order of the stage.
pub(crate) fn open(
    argument: &str,
    options: &OpenOptions,
    raised: &Raised,
) -> Result<Vec<Body>, Error> {
    let opened = Python::attach(|py| {
        let module = py.import("pliant._usd")?;
        let (file, meshes): (String, Vec<Any<'_>>) =
            module.call_method1("opened", (argument,))?.extract()?;
        let meshes = meshes.into_iter().map(|mesh| {
            let name: String = mesh.getattr("name")?.extract()?;
            let source = Mesh {
                frames: mesh.getattr("frame_count")?.extract()?,
                counts: mesh.getattr("counts")?.extract()?,
                corners: mesh.getattr("corners")?.extract()?,
                evaluator: mesh.unbind(),
                raised: raised.clone(),
            };
            Ok((name, source))
        });
        Ok((file, meshes.collect::<PyResult<Vec<_>>>()?))
    });
    let (file, meshes) = opened.unwrap_or_else(|error| {
        raised.keep(error);
        (argument.to_owned(), Vec::new())
    });
    let bodies = meshes.into_iter().map(|(name, source)| {
        let source = Box::new(source);
        pliant_io::evaluated(Path::new(&file), argument, &name, source, options)
    });
    bodies.collect()
}
