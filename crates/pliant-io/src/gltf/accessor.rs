//! Accessors: numbers in groups of one, three, four or sixteen, with gaps between them or replaced here and there (sparse).
//!
//! Own reader. The library at hand, gltf 1.4.1, was read and could not be used on files from strangers: it holds the file and its
//! JSON whole, subtracts from the length of a GLB header without looking, and unwraps where a sparse accessor has fewer values
//! than indices.
//!
//! Every count is held against the bytes that it needs before anything is read, and rows are handed out some thousand at a time.

use super::buffers::Buffers;
use super::document::{Accessor, Document, Sparse};
use crate::error::{Fault, Place, Reason};
use crate::memory::{Account, bytes_of};

/// Rows read at a time.
const ROWS: u64 = 4096;

/// The largest gap from row to row that the format allows.
const WIDEST: u64 = 252;

/// A file while its bodies are made.
pub(super) struct Reader {
    pub(super) document: Document,
    pub(super) buffers: Buffers,
    /// All that is held for the bodies.
    pub(super) account: Account,
    /// How often a morph target said that a vertex stays where it is.
    pub(super) stay: u64,
}

/// What an accessor must be to be what it is used as.
#[derive(Clone, Copy)]
pub(super) struct Wanted {
    pub(super) what: &'static str,
    shape: &'static str,
    width: usize,
    components: &'static [Component],
    /// Whole numbers are fractions of their largest.
    normalised: bool,
    /// Whole numbers are such fractions if the accessor says so, and else themselves.
    quantised: bool,
    /// May be all zero with no data behind, but for sparse values.
    optional_data: bool,
    /// The least that is held of a row, in bytes.
    held: u64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

use Component::{F32, I8, I16, U8, U16, U32};

impl Wanted {
    const fn new(
        what: &'static str,
        shape: &'static str,
        width: usize,
        components: &'static [Component],
    ) -> Self {
        Self {
            what,
            shape,
            width,
            components,
            normalised: false,
            quantised: false,
            optional_data: false,
            // As numbers of 32 bits.
            held: 4 * width as u64,
        }
    }

    /// `KHR_mesh_quantization` allows whole numbers; the place of the node, or of the joints, makes up for it.
    pub(super) const POSITIONS: Self = Self {
        quantised: true,
        ..Self::new("positions", "VEC3", 3, &[F32, I8, U8, I16, U16])
    };
    pub(super) const DELTAS: Self = Self {
        quantised: true,
        optional_data: true,
        // What is zero is not.
        held: 0,
        ..Self::new(
            "positions of a morph target",
            "VEC3",
            3,
            &[F32, I8, U8, I16, U16],
        )
    };
    pub(super) const INDICES: Self = Self::new("indices", "SCALAR", 1, &[U8, U16, U32]);
    pub(super) const JOINTS: Self = Self::new("joints", "VEC4", 4, &[U8, U16]);
    pub(super) const WEIGHTS: Self = Self {
        normalised: true,
        // They join their joints.
        held: 0,
        ..Self::new("weights", "VEC4", 4, &[F32, U8, U16])
    };
    pub(super) const MATRICES: Self = Self::new("inverse bind matrices", "MAT4", 16, &[F32]);
    pub(super) const TIMES: Self = Self::new("times", "SCALAR", 1, &[F32]);
    pub(super) const VECTORS: Self = Self::new("translations or scales", "VEC3", 3, &[F32]);
    pub(super) const ROTATIONS: Self = Self {
        normalised: true,
        ..Self::new("rotations", "VEC4", 4, &[F32, I8, U8, I16, U16])
    };
    pub(super) const MORPHS: Self = Self {
        normalised: true,
        ..Self::new(
            "weights of morph targets",
            "SCALAR",
            1,
            &[F32, I8, U8, I16, U16],
        )
    };
}

impl Component {
    fn of(number: u32) -> Option<Self> {
        Some(match number {
            5120 => I8,
            5121 => U8,
            5122 => I16,
            5123 => U16,
            5125 => U32,
            5126 => F32,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            I8 | U8 => 1,
            I16 | U16 => 2,
            U32 | F32 => 4,
        }
    }

    /// The number that these bytes write, exactly; a fraction of the largest where it is `normalised`.
    fn value(self, bytes: &[u8], normalised: bool) -> f64 {
        let [a, b, c, d] = std::array::from_fn(|at| bytes.get(at).copied().unwrap_or(0));
        let (value, largest) = match self {
            I8 => (i8::from_le_bytes([a]).into(), 127.0),
            U8 => (a.into(), 255.0),
            I16 => (i16::from_le_bytes([a, b]).into(), 32767.0),
            U16 => (u16::from_le_bytes([a, b]).into(), 65535.0),
            U32 => (u32::from_le_bytes([a, b, c, d]).into(), 1.0),
            F32 => (f32::from_le_bytes([a, b, c, d]).into(), 1.0),
        };
        if normalised && largest > 1.0 {
            // The lowest of the signed ones is one below minus the largest.
            f64::max(value / largest, -1.0)
        } else {
            value
        }
    }
}

/// Rows of numbers in a view.
#[derive(Clone, Copy)]
struct Rows {
    view: usize,
    offset: u64,
    component: Component,
    width: usize,
    count: u64,
    normalised: bool,
    /// Whether the view may have gaps.
    gaps: bool,
    /// The least that is held of a row, in bytes.
    held: u64,
}

impl Reader {
    /// The number of rows of an accessor.
    pub(super) fn count(&self, accessor: usize) -> Result<u64, Fault> {
        self.accessor(accessor).map(|accessor| accessor.count)
    }

    fn accessor(&self, accessor: usize) -> Result<&Accessor, Fault> {
        let entry = self.document.accessors.get(accessor);
        entry.ok_or_else(|| wrong(accessor, "there is no such accessor"))
    }

    /// Hands out the rows of an accessor, with their numbers.
    pub(super) fn each_row(
        &mut self,
        accessor: usize,
        wanted: Wanted,
        mut each: impl FnMut(&mut Account, u64, &[f64]) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        let at = |fault: Fault| fault.or_at(Place::Part("accessor", accessor));
        let entry = self.accessor(accessor)?;
        let component = Component::of(entry.component_type)
            .filter(|component| wanted.components.contains(component));
        let (Some(component), true) = (component, entry.shape == wanted.shape) else {
            return Err(wrong(
                accessor,
                format!("its type is not one that {} can have", wanted.what),
            ));
        };
        if component != F32 && wanted.normalised && !entry.normalized {
            return Err(wrong(
                accessor,
                format!("{} that are whole numbers must be normalised", wanted.what),
            ));
        }
        let count = entry.count;
        let (view, offset) = (entry.buffer_view, entry.byte_offset);
        let normalised = wanted.normalised || (wanted.quantised && entry.normalized);
        let rows = |view| Rows {
            view,
            offset,
            component,
            width: wanted.width,
            count,
            normalised,
            gaps: true,
            held: wanted.held,
        };
        let is_sparse = entry.sparse.is_some();
        let replaced = match &entry.sparse {
            Some(sparse) => {
                let places = Self::places(accessor, sparse, rows(0)).map_err(at)?;
                self.replaced(places, count).map_err(at)?
            }
            None => Vec::new(),
        };
        let bytes = bytes_of(&replaced);
        let mut replaced = &replaced[..];
        let read = match view {
            Some(view) => self
                .rows(rows(view), |account, number, row| match replaced {
                    [(first, values), rest @ ..] if *first == number => {
                        replaced = rest;
                        each(account, number, &values[..wanted.width])
                    }
                    _ => each(account, number, row),
                })
                .map_err(at),
            // What is zero is as it was: it is not handed out.
            None if wanted.optional_data => {
                let mut rows = replaced.iter();
                rows.try_for_each(|(number, values)| {
                    each(&mut self.account, *number, &values[..wanted.width]).map_err(at)
                })
            }
            // The rows that are not replaced are zero.
            None if is_sparse => {
                let announced = self.account.check(count.saturating_mul(wanted.held));
                announced.map_err(|excess| at(Reason::from(excess).into()))?;
                (0..count).try_for_each(|number| {
                    let zero = [0.0; 4];
                    let values = match replaced {
                        [(first, values), rest @ ..] if *first == number => {
                            replaced = rest;
                            values
                        }
                        _ => &zero,
                    };
                    each(&mut self.account, number, &values[..wanted.width]).map_err(at)
                })
            }
            None => Err(wrong(
                accessor,
                "has no data; only morph targets may be zero throughout",
            )),
        };
        self.account.take_off(bytes);
        read
    }

    /// Where the places and the values of a sparse accessor are, which is of such `rows`.
    fn places(accessor: usize, sparse: &Sparse, rows: Rows) -> Result<[Rows; 2], Fault> {
        let component = Component::of(sparse.indices.component_type)
            .filter(|component| [U8, U16, U32].contains(component))
            .ok_or_else(|| wrong(accessor, "sparse indices must be whole numbers from 0"))?;
        let sparse_rows = Rows {
            count: sparse.count,
            gaps: false,
            held: 0,
            ..rows
        };
        Ok([
            Rows {
                view: sparse.indices.buffer_view,
                offset: sparse.indices.byte_offset,
                component,
                width: 1,
                normalised: false,
                held: size_of::<(u64, [f64; 4])>() as u64,
                ..sparse_rows
            },
            Rows {
                view: sparse.values.buffer_view,
                offset: sparse.values.byte_offset,
                ..sparse_rows
            },
        ])
    }

    /// The rows that a sparse accessor of `count` replaces, and by what; their numbers rise. They stay entered: until the accessor was
    /// read they are held.
    fn replaced(
        &mut self,
        [places, values]: [Rows; 2],
        count: u64,
    ) -> Result<Vec<(u64, [f64; 4])>, Fault> {
        if values.width > 4 {
            return Err(Reason::Unsupported(
                "matrices in a sparse accessor are not evaluated; export them in full".into(),
            )
            .into());
        }
        let mut replaced: Vec<(u64, [f64; 4])> = Vec::new();
        self.rows(places, |account, _, row| {
            let place = whole(row[0]);
            let rises = replaced.last().is_none_or(|(last, _)| *last < place);
            if !rises || place >= count {
                let reason = format!("sparse index {place} does not rise, or is not below {count}");
                return Err(Reason::Malformed(reason).into());
            }
            Ok(account.push(&mut replaced, (place, [0.0; 4]), 0)?)
        })?;
        self.rows(values, |_, number, row| {
            if let Some((_, values)) = replaced.get_mut(number as usize) {
                values[..row.len()].copy_from_slice(row);
            }
            Ok(())
        })?;
        Ok(replaced)
    }

    /// Hands out rows.
    fn rows(
        &mut self,
        rows: Rows,
        mut each: impl FnMut(&mut Account, u64, &[f64]) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        let Self {
            document,
            buffers,
            account,
            ..
        } = self;
        let Some(view) = document.buffer_views.get(rows.view) else {
            let reason = format!("there is no buffer view {}", rows.view);
            return Err(Reason::Malformed(reason).into());
        };
        let end = view.byte_offset.saturating_add(view.byte_length);
        let has = document
            .buffers
            .get(view.buffer)
            .map(|buffer| buffer.byte_length);
        if has.is_some_and(|has| end > has) {
            return Err(Reason::Truncated(format!(
                "buffer view {} ends at byte {end}, its buffer has {}",
                rows.view,
                has.unwrap_or(0)
            ))
            .into());
        }
        let size = rows.component.size();
        let row = (size * rows.width) as u64;
        let stride = view.byte_stride.filter(|_| rows.gaps).unwrap_or(row);
        if stride < row || stride > WIDEST.max(row) {
            let reason = format!("rows of {row} bytes cannot be {stride} bytes apart");
            return Err(Reason::Malformed(reason).into());
        }
        if rows.count == 0 {
            return Ok(());
        }
        let needed = (rows.count - 1)
            .checked_mul(stride)
            .and_then(|all| all.checked_add(row.saturating_add(rows.offset)));
        if needed.is_none_or(|needed| needed > view.byte_length) {
            return Err(Reason::Truncated(format!(
                "{} rows from byte {} on do not fit into buffer view {} of {} bytes",
                rows.count, rows.offset, rows.view, view.byte_length
            ))
            .into());
        }
        // Bytes that are there may be those of a hole, which takes no place on any disk, as large as it likes.
        account.check(rows.count.saturating_mul(rows.held))?;
        let mut bytes = Vec::new();
        let mut done = 0;
        let mut values = [0.0; 16];
        while done < rows.count {
            let now = ROWS.min(rows.count - done);
            bytes.resize(((now - 1) * stride + row) as usize, 0);
            let from = rows.offset.saturating_add(done * stride);
            buffers.read_view(document, rows.view, from, &mut bytes, account)?;
            for bytes in bytes.chunks(stride as usize) {
                let numbers = bytes.chunks_exact(size);
                for (value, bytes) in values.iter_mut().zip(numbers.take(rows.width)) {
                    *value = rows.component.value(bytes, rows.normalised);
                }
                each(account, done, &values[..rows.width])?;
                done += 1;
            }
        }
        Ok(())
    }
}

/// A number that was read from an unsigned one.
#[expect(clippy::cast_sign_loss, reason = "none is negative")]
pub(super) fn whole(number: f64) -> u64 {
    number as u64
}

fn wrong(accessor: usize, why: impl Into<String>) -> Fault {
    Reason::Malformed(why.into()).at(Place::Part("accessor", accessor))
}
