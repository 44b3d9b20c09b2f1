//! glTF accessors: rows of 1, 3, 4 or 16 numbers, with strides, or with sparse replacements.
//!
//! The crate has its own reader because gltf 1.4.1 fails on files from strangers. It holds the file
//! and its JSON as a whole and subtracts from the length of a GLB header unchecked. It unwraps
//! where a sparse accessor has fewer values than indices. Here every count is compared with the
//! bytes that it needs before anything is read, and rows are returned some thousands at a time.

use super::buffers::Buffers;
use super::document::{Accessor, Document, Sparse};
use crate::error::{Fault, Place, Reason};
use crate::memory::{Account, bytes_of};
use crate::text::quoted;

/// Rows read at a time, into a buffer of at most 1 MiB (at the largest stride).
const ROWS: u64 = 4096;

/// Largest stride that the format allows, in bytes.
const WIDEST: u64 = 252;

/// State of a file while its bodies are made.
pub(super) struct Reader {
    pub(super) document: Document,
    pub(super) buffers: Buffers,
    /// Memory held for all bodies.
    pub(super) account: Account,
    /// Number of zero displacements in morph targets so far.
    pub(super) stay: u64,
}

/// Requirements on an accessor for one use.
#[derive(Clone, Copy)]
pub(super) struct Wanted {
    pub(super) what: &'static str,
    shape: &'static str,
    width: usize,
    components: &'static [Component],
    /// Integers are fractions of their largest value.
    normalised: bool,
    /// Integers are fractions if the accessor says so, and otherwise themselves.
    quantised: bool,
    /// The accessor may have no data, and is then zero apart from sparse values.
    optional_data: bool,
    /// Least bytes that are held for each row.
    held: u64,
}

/// Type of a number in an accessor.
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
            // Held as 32-bit numbers.
            held: 4 * width as u64,
        }
    }

    /// `KHR_mesh_quantization` allows integers; the transform of the node, or of the joints,
    /// compensates.
    pub(super) const POSITIONS: Self = Self {
        quantised: true,
        ..Self::new("positions", "VEC3", 3, &[F32, I8, U8, I16, U16])
    };
    pub(super) const DELTAS: Self = Self {
        quantised: true,
        optional_data: true,
        // Zero displacements are not held.
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
        // They are held with their joints.
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

impl Wanted {
    /// Message for an accessor of another type.
    fn refusal(&self, entry: &Accessor) -> String {
        let numbers = self.components.iter().map(|it| it.number().to_string());
        format!(
            "has type {} and componentType {}; {} need \"{}\" and one of: {}",
            quoted(&entry.shape),
            entry.component_type,
            self.what,
            self.shape,
            numbers.collect::<Vec<_>>().join(", ")
        )
    }
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

    /// Its `componentType` in the JSON.
    fn number(self) -> u32 {
        match self {
            I8 => 5120,
            U8 => 5121,
            I16 => 5122,
            U16 => 5123,
            U32 => 5125,
            F32 => 5126,
        }
    }

    fn size(self) -> usize {
        match self {
            I8 | U8 => 1,
            I16 | U16 => 2,
            U32 | F32 => 4,
        }
    }

    /// Converts bytes to a number, exactly; a fraction of the largest value if `normalised`.
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
            // The lowest signed integer is one below minus the largest.
            f64::max(value / largest, -1.0)
        } else {
            value
        }
    }
}

/// Rows of numbers in a buffer view.
#[derive(Clone, Copy)]
struct Rows {
    view: usize,
    offset: u64,
    component: Component,
    width: usize,
    count: u64,
    normalised: bool,
    /// Whether the stride of the view applies.
    gaps: bool,
    /// Least bytes that are held for each row.
    held: u64,
}

impl Reader {
    /// Number of rows of an accessor.
    pub(super) fn count(&self, accessor: usize) -> Result<u64, Fault> {
        self.accessor(accessor).map(|accessor| accessor.count)
    }

    fn accessor(&self, accessor: usize) -> Result<&Accessor, Fault> {
        let entry = self.document.accessors.get(accessor);
        entry.ok_or_else(|| wrong(accessor, "there is no such accessor"))
    }

    /// Passes each row of an accessor, with its number, to `each`.
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
            return Err(wrong(accessor, wanted.refusal(entry)));
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
            // Rows of zeros change nothing, and are not passed on.
            None if wanted.optional_data => {
                let mut rows = replaced.iter();
                rows.try_for_each(|(number, values)| {
                    each(&mut self.account, *number, &values[..wanted.width]).map_err(at)
                })
            }
            // Rows that are not replaced are zero.
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

    /// Rows of the indices and values of a sparse accessor, which itself has `rows`.
    fn places(accessor: usize, sparse: &Sparse, rows: Rows) -> Result<[Rows; 2], Fault> {
        let component = Component::of(sparse.indices.component_type)
            .filter(|component| [U8, U16, U32].contains(component))
            .ok_or_else(|| {
                wrong(
                    accessor,
                    "sparse indices must have the type unsigned byte, short or int",
                )
            })?;
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

    /// Reads the replaced rows of a sparse accessor of `count` rows, by ascending number.
    ///
    /// The account still counts them afterwards; they are held until the accessor was read.
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
            if let Some((last, _)) = replaced.last()
                && *last >= place
            {
                let reason = format!("sparse index {place} is not larger than {last} before it");
                return Err(Reason::Malformed(reason).into());
            }
            if place >= count {
                let reason = format!("sparse index {place} is not below the {count} rows");
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

    /// Passes each of `rows` to `each`.
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
        if stride < row {
            let reason = format!("byteStride {stride} is too small for rows of {row} bytes");
            return Err(Reason::Malformed(reason).into());
        }
        if stride > WIDEST.max(row) {
            let reason = format!("byteStride {stride} is above {WIDEST}, the largest in glTF");
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
        // Bytes that exist may belong to a sparse file of any size, which takes no room on disk.
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

/// Converts a number that was read from an unsigned integer.
#[expect(clippy::cast_sign_loss, reason = "none is negative")]
pub(super) fn whole(number: f64) -> u64 {
    number as u64
}

fn wrong(accessor: usize, why: impl Into<String>) -> Fault {
    Reason::Malformed(why.into()).at(Place::Part("accessor", accessor))
}
