//! NPZ files by hand, honest and not.

/// One entry as the directory announces it.
pub(crate) struct Entry {
    pub(crate) name: &'static str,
    pub(crate) deflated: bool,
    /// Unpacked, in bytes.
    pub(crate) size: u32,
    pub(crate) checksum: u32,
    pub(crate) data: Vec<u8>,
}

impl Entry {
    /// An array that is what it says.
    pub(crate) fn stored(name: &'static str, array: Vec<u8>) -> Self {
        Self {
            name,
            deflated: false,
            size: array.len() as u32,
            checksum: checksum(&array),
            data: array,
        }
    }
}

/// An archive of these entries.
pub(crate) fn archive(entries: &[Entry]) -> Vec<u8> {
    let (mut file, mut directory) = (Vec::new(), Vec::new());
    for entry in entries {
        let start = file.len() as u32;
        let name = format!("{}.npy", entry.name);
        let mut common = vec![20, 0, 0, 0, if entry.deflated { 8 } else { 0 }, 0];
        common.extend([0; 4]);
        for number in [entry.checksum, entry.data.len() as u32, entry.size] {
            common.extend(number.to_le_bytes());
        }
        common.extend((name.len() as u16).to_le_bytes());
        common.extend([0; 2]);
        file.extend([b"PK\x03\x04", &common[..], name.as_bytes(), &entry.data].concat());
        directory.extend([b"PK\x01\x02\x14\0", &common[..], &[0; 10]].concat());
        directory.extend([&start.to_le_bytes()[..], name.as_bytes()].concat());
    }
    let (count, start) = (entries.len() as u16, file.len() as u32);
    file.extend(&directory);
    file.extend(b"PK\x05\x06\0\0\0\0");
    file.extend([count.to_le_bytes(), count.to_le_bytes()].concat());
    file.extend((directory.len() as u32).to_le_bytes());
    file.extend(start.to_le_bytes());
    file.extend([0; 2]);
    file
}

/// An array as numpy saves it.
pub(crate) fn array(dtype: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let header = format!("{{'descr': '{dtype}', 'fortran_order': False, 'shape': {shape}, }}\n");
    let length = (header.len() as u16).to_le_bytes();
    [b"\x93NUMPY\x01\0", &length[..], header.as_bytes(), data].concat()
}

/// CRC-32.
fn checksum(data: &[u8]) -> u32 {
    let table: [u32; 256] = std::array::from_fn(|byte| {
        (0..8).fold(byte as u32, |crc, _| {
            (crc >> 1) ^ (0xedb8_8320 & (crc & 1).wrapping_neg())
        })
    });
    !data.iter().fold(u32::MAX, |crc, &byte| {
        (crc >> 8) ^ table[((crc ^ u32::from(byte)) & 0xff) as usize]
    })
}

/// A bumpy surface that moves, as a whole file.
#[derive(Clone, Copy)]
pub(crate) struct Surface {
    /// Vertices each way.
    pub(crate) side: u32,
    pub(crate) frames: u32,
    /// In float64.
    pub(crate) wide: bool,
    /// Every triangle has vertices of its own.
    pub(crate) split: bool,
}

impl Surface {
    /// In float32, its triangles joined.
    pub(crate) fn new(side: u32, frames: u32) -> Self {
        let (wide, split) = (false, false);
        Self {
            side,
            frames,
            wide,
            split,
        }
    }

    /// Of one frame: the positions and the triangles.
    pub(crate) fn bytes_of_a_frame(self) -> u64 {
        let coordinate = if self.wide { 8 } else { 4 };
        let [vertices, triangles] = [self.vertices(), self.triangles()].map(u64::from);
        3 * coordinate * vertices + 12 * triangles
    }

    pub(crate) fn triangles(self) -> u32 {
        2 * (self.side - 1) * (self.side - 1)
    }

    fn vertices(self) -> u32 {
        if self.split {
            3 * self.triangles()
        } else {
            self.side * self.side
        }
    }

    pub(crate) fn file(self) -> Vec<u8> {
        let Self { side, frames, .. } = self;
        let mut corners: Vec<u32> = Vec::new();
        for y in 0..side - 1 {
            for x in 0..side - 1 {
                let corner = y * side + x;
                corners.extend([0, 1, side, 1, side + 1, side].map(|index| corner + index));
            }
        }
        // The place on the grid of each vertex, and the vertices of the corners.
        let (places, corners) = if self.split {
            let own = 0..corners.len() as u32;
            (corners, own.collect())
        } else {
            ((0..side * side).collect(), corners)
        };
        let mut vertices = Vec::new();
        for frame in 0..frames {
            for place in &places {
                let (x, y) = (place % side, place / side);
                let z = (x * 7 + y * 13 + frame) % 5;
                for number in [x, y, z] {
                    if self.wide {
                        vertices.extend(f64::from(number).to_le_bytes());
                    } else {
                        vertices.extend((number as f32).to_le_bytes());
                    }
                }
            }
        }
        let faces: Vec<u8> = corners
            .iter()
            .flat_map(|corner| corner.to_le_bytes())
            .collect();
        let dtype = if self.wide { "<f8" } else { "<f4" };
        let shape = format!("({frames}, {}, 3)", self.vertices());
        let triangles = format!("({}, 3)", self.triangles());
        archive(&[
            Entry::stored("vertices", array(dtype, &shape, &vertices)),
            Entry::stored("faces", array("<u4", &triangles, &faces)),
        ])
    }
}
