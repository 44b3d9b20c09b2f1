//! NPZ files built by hand, honest or not; and a surface as an NPZ or a GLB file.

use serde_json::json;

/// An entry, as the directory of the archive announces it.
pub(crate) struct Entry {
    pub(crate) name: &'static str,
    pub(crate) deflated: bool,
    /// Unpacked size in bytes.
    pub(crate) size: u32,
    pub(crate) checksum: u32,
    pub(crate) data: Vec<u8>,
}

impl Entry {
    /// A stored array that is what it claims.
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

/// A bumpy moving surface, written as a whole file.
#[derive(Clone, Copy)]
pub(crate) struct Surface {
    /// Number of vertices each way.
    pub(crate) side: u32,
    pub(crate) frames: u32,
    /// Whether positions are float64.
    pub(crate) wide: bool,
    /// Whether every triangle has vertices of its own.
    pub(crate) split: bool,
}

impl Surface {
    /// A surface in float32 with joined triangles.
    pub(crate) fn new(side: u32, frames: u32) -> Self {
        let (wide, split) = (false, false);
        Self {
            side,
            frames,
            wide,
            split,
        }
    }

    /// Bytes of one frame: positions and triangles.
    pub(crate) fn bytes_of_a_frame(self) -> u64 {
        let coordinate = if self.wide { 8 } else { 4 };
        let [vertices, triangles] = [self.vertices(), self.triangles()].map(u64::from);
        3 * coordinate * vertices + 12 * triangles
    }

    pub(crate) fn triangles(self) -> u32 {
        2 * (self.side - 1) * (self.side - 1)
    }

    pub(crate) fn vertices(self) -> u32 {
        if self.split {
            3 * self.triangles()
        } else {
            self.side * self.side
        }
    }

    /// Place on the grid of each vertex, and the vertices of the corners.
    fn mesh(self) -> (Vec<u32>, Vec<u32>) {
        let Self { side, .. } = self;
        let mut corners: Vec<u32> = Vec::new();
        for y in 0..side - 1 {
            for x in 0..side - 1 {
                let corner = y * side + x;
                corners.extend([0, 1, side, 1, side + 1, side].map(|index| corner + index));
            }
        }
        if self.split {
            let own = 0..corners.len() as u32;
            (corners, own.collect())
        } else {
            ((0..side * side).collect(), corners)
        }
    }

    pub(crate) fn file(self) -> Vec<u8> {
        let Self { side, frames, .. } = self;
        let (places, corners) = self.mesh();
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

    /// The surface as a GLB file in f32, in the shape of its first frame.
    ///
    /// It is held by four joints if `held`, and moved by `targets` morph targets, each at all
    /// vertices. With either it has three frames at thirty a second; otherwise it stands still.
    pub(crate) fn glb(self, held: bool, targets: usize) -> Vec<u8> {
        let (places, corners) = self.mesh();
        let count = places.len();
        let (mut data, mut views, mut accessors) = (Vec::new(), Vec::new(), Vec::new());
        let mut array = |bytes: Vec<u8>, component: u32, count: usize, shape: &str| {
            views.push(json!({"buffer": 0, "byteOffset": data.len(), "byteLength": bytes.len()}));
            let view = views.len() - 1;
            accessors.push(json!({
                "bufferView": view, "componentType": component, "count": count, "type": shape
            }));
            data.extend(bytes);
            view
        };
        let (float, long, byte) = (5126, 5125, 5121);
        let floats =
            |numbers: &[f32]| -> Vec<u8> { numbers.iter().flat_map(|x| x.to_le_bytes()).collect() };
        let rest = places.iter().flat_map(|place| {
            let (x, y) = (place % self.side, place / self.side);
            [x, y, (x * 7 + y * 13) % 5].map(|x| x as f32)
        });
        let rest = floats(&rest.collect::<Vec<_>>());
        let mut attributes = json!({"POSITION": array(rest, float, count, "VEC3")});
        let indices: Vec<u8> = corners.iter().flat_map(|x| x.to_le_bytes()).collect();
        let indices = array(indices, long, corners.len(), "SCALAR");
        if held {
            attributes["JOINTS_0"] = json!(array([0, 1, 2, 3].repeat(count), byte, count, "VEC4"));
            let quarters = floats(&[0.25; 4]).repeat(count);
            attributes["WEIGHTS_0"] = json!(array(quarters, float, count, "VEC4"));
        }
        let mut primitive = json!({"attributes": attributes, "indices": indices});
        let mut channels = Vec::new();
        let mut samplers = Vec::new();
        if targets > 0 {
            let delta = array(floats(&[0.0, 0.0, 1.0]).repeat(count), float, count, "VEC3");
            primitive["targets"] = json!(vec![json!({"POSITION": delta}); targets]);
            let times = array(floats(&[0.0, 2.0 / 30.0]), float, 2, "SCALAR");
            let weights = [vec![0.0; targets], vec![1.0; targets]].concat();
            let weights = array(floats(&weights), float, weights.len(), "SCALAR");
            channels.push(json!({"sampler": 0, "target": {"node": 0, "path": "weights"}}));
            samplers.push(json!({"input": times, "output": weights}));
        }
        let mut nodes = vec![json!({"mesh": 0})];
        let mut skins = Vec::new();
        if held {
            nodes[0]["skin"] = json!(0);
            nodes.extend(vec![json!({}); 4]);
            skins.push(json!({"joints": [1, 2, 3, 4]}));
            let times = array(floats(&[0.0, 2.0 / 30.0]), float, 2, "SCALAR");
            let moves = array(floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]), float, 2, "VEC3");
            let target = json!({"node": 1, "path": "translation"});
            channels.push(json!({"sampler": samplers.len(), "target": target}));
            samplers.push(json!({"input": times, "output": moves}));
        }
        let mut document = json!({
            "asset": {"version": "2.0"},
            "scenes": [{"nodes": (0..nodes.len()).collect::<Vec<_>>()}],
            "nodes": nodes,
            "meshes": [{"primitives": [primitive]}],
            "accessors": accessors,
            "bufferViews": views,
            "buffers": [{"byteLength": data.len()}],
        });
        if !channels.is_empty() {
            document["animations"] = json!([{"channels": channels, "samplers": samplers}]);
        }
        if held {
            document["skins"] = json!(skins);
        }
        let mut text = document.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        data.resize(data.len().next_multiple_of(4), 0);
        let mut file = b"glTF\x02\0\0\0".to_vec();
        file.extend((28 + text.len() as u32 + data.len() as u32).to_le_bytes());
        for (kind, chunk) in [(b"JSON", text), (b"BIN\0", data)] {
            file.extend((chunk.len() as u32).to_le_bytes());
            file.extend(kind);
            file.extend(chunk);
        }
        file
    }
}

/// A NumPy array of integers, (n,), as a file.
pub(crate) fn integers(numbers: &[i64]) -> Vec<u8> {
    let shape = format!("({},)", numbers.len());
    let head = format!("{{'descr': '<i8', 'fortran_order': False, 'shape': {shape}, }}");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((head.len() as u16).to_le_bytes());
    bytes.extend(head.as_bytes());
    bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    bytes
}
