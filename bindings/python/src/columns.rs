//! Columns of hits: arrays side by side, filled by as many threads as a long list pays for.
//!
//! numpy allocates the arrays, because it asks for large pages where there is much to write. The
//! first write to a page takes longest, and threads share that well. Hits are read once, in blocks,
//! for all columns.

use numpy::ndarray::{Dimension, Ix1, Ix2};
use numpy::{Element, PyArray1, PyArray2, PyArrayMethods, PyReadwriteArray};
use pyo3::prelude::*;
use std::any::Any;
use std::mem;
use std::sync::{Mutex, PoisonError};
use std::thread;

/// Hits of one share; fewer do not pay for a thread.
const SHARE: usize = 1 << 16;
/// Hits that stay in the cache while their columns are written.
const BLOCK: usize = 256;

/// Hits, and the columns that they are copied into.
pub(crate) struct Columns<'h, 'py, H> {
    py: Python<'py>,
    hits: &'h [H],
    threads: usize,
    filled: Vec<Box<dyn Column<H> + 'py>>,
}

impl<'h, 'py, H: Sync> Columns<'h, 'py, H> {
    pub(crate) fn new(py: Python<'py>, hits: &'h [H], threads: usize) -> Self {
        Self {
            py,
            hits,
            threads,
            filled: Vec::new(),
        }
    }

    /// Adds an array (k,): a number of each hit.
    pub(crate) fn number<T: Element + Copy + 'py>(
        self,
        of: impl Fn(&H) -> T + Copy + Send + 'py,
    ) -> PyResult<Self> {
        let array = PyArray1::zeros(self.py, self.hits.len(), false);
        Ok(self.with::<T, Ix1, 1>(array.try_readwrite()?, move |hit| [of(hit)]))
    }

    /// Adds an array (k, K): a row of each hit.
    pub(crate) fn row<T: Element + Copy + 'py, const K: usize>(
        self,
        of: impl Fn(&H) -> [T; K] + Copy + Send + 'py,
    ) -> PyResult<Self> {
        let array = PyArray2::zeros(self.py, [self.hits.len(), K], false);
        Ok(self.with::<T, Ix2, K>(array.try_readwrite()?, of))
    }

    fn with<T: Element + Copy + 'py, D: Dimension + 'py, const K: usize>(
        mut self,
        array: PyReadwriteArray<'py, T, D>,
        of: impl Fn(&H) -> [T; K] + Copy + Send + 'py,
    ) -> Self {
        self.filled.push(Box::new(Filled { array, of }));
        self
    }

    /// Copies the hits into the arrays, and returns these.
    pub(crate) fn filled(mut self) -> PyResult<Vec<Py<PyAny>>> {
        self.fill()?;
        let columns = self.filled.into_iter();
        Ok(columns.map(Column::array).collect())
    }

    fn fill(&mut self) -> PyResult<()> {
        let hits = self.hits;
        let threads = self.threads.min(hits.len() / SHARE).max(1);
        let share = hits.len().div_ceil(threads).max(1);
        let mut jobs: Vec<_> = hits.chunks(share).map(|hits| (hits, Vec::new())).collect();
        for column in &mut self.filled {
            let parts = column.parts(share)?;
            let jobs = jobs.iter_mut().zip(parts);
            jobs.for_each(|((_, parts), part)| parts.push(part));
        }
        let fill = |(hits, mut parts): (&[H], Vec<Part<'_, H>>)| {
            for block in hits.chunks(BLOCK) {
                parts.iter_mut().for_each(|part| part(block));
            }
        };
        if let Some(alone) = jobs.pop_if(|_| threads == 1) {
            fill(alone);
        } else {
            self.py.detach(|| share_out(jobs, fill));
        }
        Ok(())
    }
}

/// Does all jobs, each on a thread of its own, or on fewer where the system has no more.
fn share_out<J: Send>(jobs: Vec<J>, work: impl Fn(J) + Sync) {
    let others = jobs.len().saturating_sub(1);
    let jobs = Mutex::new(jobs.into_iter());
    let next = || jobs.lock().unwrap_or_else(PoisonError::into_inner).next();
    let work = || {
        while let Some(job) = next() {
            work(job);
        }
    };
    thread::scope(|scope| {
        for _ in 0..others {
            if thread::Builder::new().spawn_scoped(scope, work).is_err() {
                break;
            }
        }
        work();
    });
}

/// Part of a column, which takes its next hits at each call.
type Part<'c, H> = Box<dyn FnMut(&[H]) + Send + 'c>;

trait Column<H> {
    /// The column in parts, each for `share` hits.
    fn parts(&mut self, share: usize) -> PyResult<Vec<Part<'_, H>>>;

    fn array(self: Box<Self>) -> Py<PyAny>;
}

struct Filled<'py, T: Element, D: Dimension, F> {
    array: PyReadwriteArray<'py, T, D>,
    of: F,
}

impl<H, T, D, F, const K: usize> Column<H> for Filled<'_, T, D, F>
where
    T: Element + Copy,
    D: Dimension,
    F: Fn(&H) -> [T; K] + Copy + Send,
{
    fn parts(&mut self, share: usize) -> PyResult<Vec<Part<'_, H>>> {
        let of = self.of;
        let (rows, _) = self.array.as_slice_mut()?.as_chunks_mut::<K>();
        let parts = rows.chunks_mut(share).map(|mut places| -> Part<'_, H> {
            Box::new(move |hits| {
                let (now, later) = mem::take(&mut places).split_at_mut(hits.len());
                let rows = now.iter_mut().zip(hits);
                rows.for_each(|(place, hit)| *place = of(hit));
                places = later;
            })
        });
        Ok(parts.collect())
    }

    fn array(self: Box<Self>) -> Py<PyAny> {
        let array: &Bound<'_, _> = &self.array;
        array.clone().into_any().unbind()
    }
}

/// Resources of an answer: threads, and lists that are kept.
pub(crate) struct Resources<'w> {
    pub(crate) threads: usize,
    pub(crate) kept: &'w mut Kept,
}

/// Lists of hits, one of each type, kept from query to query. New memory would take longer to fill
/// than the search takes.
#[derive(Default)]
pub(crate) struct Kept(Vec<Box<dyn List>>);

impl Kept {
    /// The list of a type, as it was left.
    pub(crate) fn list<H: Send + 'static>(&mut self) -> &mut Vec<H> {
        let is_it = |list: &dyn List| (list as &dyn Any).is::<Vec<H>>();
        let at = self
            .0
            .iter()
            .position(|list| is_it(&**list))
            .unwrap_or_else(|| {
                self.0.push(Box::new(Vec::<H>::new()));
                self.0.len() - 1
            });
        let list = &mut *self.0[at] as &mut dyn Any;
        let Some(list) = list.downcast_mut() else {
            unreachable!("the list is of this type");
        };
        list
    }

    /// Bytes of all lists.
    pub(crate) fn bytes(&self) -> usize {
        self.0.iter().map(|list| list.bytes()).sum()
    }
}

trait List: Any + Send {
    fn bytes(&self) -> usize;
}

impl<H: Send + 'static> List for Vec<H> {
    fn bytes(&self) -> usize {
        self.capacity() * size_of::<H>()
    }
}
