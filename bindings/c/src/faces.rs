//! Triangles of the caller, of indices of any size.

use crate::arrays::countable;
use crate::status::{BAD_INDEX, Refused, VERTEX_OUT_OF_RANGE};
use std::ffi::c_void;

/// `pliant_faces`: where the corners of triangles lie.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PliantFaces {
    /// Address of the first corner of the first triangle.
    pub data: *const c_void,
    /// Number of triangles.
    pub count: usize,
    /// Bytes from a triangle to the next; 0 with a column of 0 if all lie behind each other.
    pub row: isize,
    /// Bytes from a corner of a triangle to the next.
    pub column: isize,
    /// Bytes of an index: 2, 4 or 8.
    pub bytes: u8,
    /// Whether indices have a sign: 0 or 1.
    pub is_signed: u8,
}

impl PliantFaces {
    /// Copies the triangles. Refuses numbers that no vertex has.
    ///
    /// # Safety
    ///
    /// They may be read as they say.
    pub(crate) unsafe fn copied(&self) -> Result<Vec<[u32; 3]>, Refused> {
        if self.data.is_null() && self.count > 0 {
            return Err(Refused::null("faces.data"));
        }
        countable(self.count, "faces.count")?;
        let size = self.bytes as isize;
        if ![2, 4, 8].contains(&self.bytes) || self.is_signed > 1 {
            let (bytes, is_signed) = (self.bytes, self.is_signed);
            return Err(Refused::new(
                BAD_INDEX,
                format_args!(
                    "faces.bytes is {bytes} and faces.is_signed {is_signed}; give 2, 4 or 8, and 0 \
                     or 1"
                ),
            ));
        }
        let [row, column] = match [self.row, self.column] {
            [0, 0] => [3 * size, size],
            strides => strides,
        };
        let mut all = Vec::with_capacity(self.count);
        for triangle in 0..self.count {
            let start = self.data.cast::<u8>();
            let start = start.wrapping_offset(row.wrapping_mul(triangle as isize));
            let mut corners = [0; 3];
            for (corner, place) in corners.iter_mut().zip([0, 1, 2]) {
                let at = start.wrapping_offset(column.wrapping_mul(place));
                // SAFETY: the caller says that an index of this size lies there.
                let index: i128 = unsafe {
                    match (self.bytes, self.is_signed) {
                        (2, 0) => at.cast::<u16>().read_unaligned().into(),
                        (2, _) => at.cast::<i16>().read_unaligned().into(),
                        (4, 0) => at.cast::<u32>().read_unaligned().into(),
                        (4, _) => at.cast::<i32>().read_unaligned().into(),
                        (_, 0) => at.cast::<u64>().read_unaligned().into(),
                        _ => at.cast::<i64>().read_unaligned().into(),
                    }
                };
                *corner = u32::try_from(index).map_err(|_| {
                    let mut refused = Refused::new(
                        VERTEX_OUT_OF_RANGE,
                        format_args!(
                            "triangle {triangle} names vertex {index}; vertices are counted from 0"
                        ),
                    );
                    refused.0.triangle = triangle as u32;
                    refused
                })?;
            }
            all.push(corners);
        }
        Ok(all)
    }
}
