//! Vertex positions of one frame, in the precision of the body: f32 or f64.

use crate::error::Reason;
use crate::memory::{Account, bytes_of};

/// Floating-point type of a body's coordinates, fixed by its first frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Precision {
    /// 32-bit coordinates.
    F32,
    /// 64-bit coordinates.
    F64,
}

impl Precision {
    /// Size of one position in bytes.
    pub(crate) fn bytes(self) -> u64 {
        match self {
            Self::F32 => size_of::<[f32; 3]>() as u64,
            Self::F64 => size_of::<[f64; 3]>() as u64,
        }
    }
}

/// Vertex positions of one frame, one per vertex of the file, in the file's unit.
///
/// Every coordinate is finite and at most `f32::MAX` in magnitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Positions<'a> {
    /// 32-bit coordinates, exactly as in the file.
    F32(&'a [[f32; 3]]),
    /// 64-bit coordinates. Frames of 32 bits in a 64-bit body are widened exactly.
    F64(&'a [[f64; 3]]),
}

impl Positions<'_> {
    /// Number of vertices.
    pub fn len(&self) -> usize {
        match self {
            Positions::F32(positions) => positions.len(),
            Positions::F64(positions) => positions.len(),
        }
    }

    /// Whether there are no vertices; never true for a body that could be opened.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Position of `vertex`, widened to f64.
    ///
    /// # Panics
    ///
    /// If `vertex` is not below [`len`](Self::len).
    pub fn get(&self, vertex: u32) -> [f64; 3] {
        match self {
            Positions::F32(positions) => positions[vertex as usize].map(f64::from),
            Positions::F64(positions) => positions[vertex as usize],
        }
    }
}

/// Vertex buffer that readers fill, reused from frame to frame.
#[derive(Debug)]
pub(crate) struct Vertices {
    stored: Stored,
    announced: usize,
}

/// Positions in the precision of the body.
#[derive(Debug)]
enum Stored {
    F32(Vec<[f32; 3]>),
    F64(Vec<[f64; 3]>),
}

impl Vertices {
    pub(crate) fn new() -> Self {
        Self {
            stored: Stored::F64(Vec::new()),
            announced: 0,
        }
    }

    /// Empties the buffer and sets its precision: the precision of the body's first frame.
    pub(crate) fn set_precision(&mut self, precision: Precision) {
        self.stored = match precision {
            Precision::F32 => Stored::F32(Vec::new()),
            Precision::F64 => Stored::F64(Vec::new()),
        };
    }

    /// Empties the buffer for a frame that announces `count` vertices, or 0 if it announces none.
    pub(crate) fn clear(&mut self, count: u64, account: &mut Account) {
        account.take_off(self.bytes());
        self.announced = usize::try_from(count).unwrap_or(usize::MAX);
        match &mut self.stored {
            Stored::F32(stored) => stored.clear(),
            Stored::F64(stored) => stored.clear(),
        }
    }

    fn bytes(&self) -> u64 {
        match &self.stored {
            Stored::F32(stored) => bytes_of(stored),
            Stored::F64(stored) => bytes_of(stored),
        }
    }

    /// Checks and appends one vertex. In a buffer of f32, `position` must be exact in f32.
    pub(crate) fn push(&mut self, position: [f64; 3], account: &mut Account) -> Result<(), Reason> {
        let vertex = self.len() as u64;
        for (axis, value) in ['x', 'y', 'z'].into_iter().zip(position) {
            // Negated comparison, so that NaN fails.
            let in_range = value.abs() <= f64::from(f32::MAX);
            if !in_range {
                return Err(Reason::Coordinate {
                    vertex,
                    axis,
                    value,
                });
            }
        }
        if vertex >= u64::from(u32::MAX) {
            return Err(Reason::TooMany { what: "vertices" });
        }
        match &mut self.stored {
            Stored::F32(stored) => {
                account.push(stored, position.map(|value| value as f32), self.announced)
            }
            Stored::F64(stored) => account.push(stored, position, self.announced),
        }
    }

    pub(crate) fn precision(&self) -> Precision {
        match self.stored {
            Stored::F32(_) => Precision::F32,
            Stored::F64(_) => Precision::F64,
        }
    }

    pub(crate) fn positions(&self) -> Positions<'_> {
        match &self.stored {
            Stored::F32(stored) => Positions::F32(stored),
            Stored::F64(stored) => Positions::F64(stored),
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.positions().len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_range_ends_at_the_largest_f32() {
        let largest = f64::from(f32::MAX);
        for precision in [Precision::F32, Precision::F64] {
            let mut vertices = Vertices::new();
            let mut account = Account::new(1 << 20);
            vertices.set_precision(precision);
            vertices
                .push([largest, -largest, -0.0], &mut account)
                .unwrap();
            let bits = [largest, -largest, -0.0].map(f64::to_bits);
            assert_eq!(vertices.positions().get(0).map(f64::to_bits), bits);
            for (at, bad) in [
                f64::NAN,
                f64::INFINITY,
                -f64::INFINITY,
                largest.next_up(),
                -largest.next_up(),
            ]
            .into_iter()
            .enumerate()
            {
                let mut position = [0.0; 3];
                position[at % 3] = bad;
                let refused = vertices.push(position, &mut account);
                assert!(matches!(
                    refused,
                    Err(Reason::Coordinate { vertex: 1, axis, .. })
                        if axis == ['x', 'y', 'z'][at % 3]
                ));
            }
            assert_eq!(vertices.len(), 1);
        }
    }
}
