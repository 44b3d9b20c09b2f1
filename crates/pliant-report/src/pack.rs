//! Binary encoding of a motion, which compresses well: small differences, bytes of equal weight
//! together.
//!
//! Positions are quantised to 65,535 steps along the longest side that their body ever has. Their
//! box moves with the body. A list of numbers is delta-coded, and written in byte planes, the
//! lowest first. Positions are coded against the best of three predictions: the vertex before, the
//! frame before, or linear extrapolation of the last two frames. `web/src/data.js` is the decoder.

use crate::frames::{BodyRecord, Frame, Hits, LineShown, Motion, Shape};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::io::Write;

/// Quantisation steps along the longest side of a body.
pub(crate) const STEPS: f64 = 65_535.0;

/// Map from a motion to the page's coordinates: this point is the origin, this distance is 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Normalisation {
    pub(crate) centre: [f64; 3],
    pub(crate) radius: f64,
}

impl Motion {
    /// Normalisation that fits the bounding box of all frames that are shown.
    pub(crate) fn normalisation(&self) -> Normalisation {
        let (mut lower, mut upper) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for shape in self.shapes() {
            for axis in 0..3 {
                let highest = shape
                    .inside
                    .iter()
                    .map(|position| position[axis])
                    .fold(0.0, f32::max);
                lower[axis] = lower[axis].min(shape.lower[axis]);
                upper[axis] = upper[axis].max(shape.lower[axis] + f64::from(highest) * shape.side);
            }
        }
        let radius = (0..3)
            .map(|axis| (upper[axis] - lower[axis]) / 2.0)
            .fold(0.0, f64::max);
        let is_real = radius.is_finite() && radius > 0.0;
        Normalisation {
            centre: if is_real {
                std::array::from_fn(|axis| f64::midpoint(lower[axis], upper[axis]))
            } else {
                lower.map(|x| if x.is_finite() { x } else { 0.0 })
            },
            radius: if is_real { radius } else { 1.0 },
        }
    }

    /// Shapes of all bodies in all frames that are shown.
    fn shapes(&self) -> impl Iterator<Item = &Shape> {
        self.frames.iter().flat_map(|frame| &frame.shapes).flatten()
    }

    /// Longest side that a body ever has.
    pub(crate) fn side(&self, body: usize) -> f64 {
        self.frames
            .iter()
            .filter_map(|frame| frame.shapes.get(body)?.as_ref())
            .map(|shape| shape.side)
            .fold(0.0, f64::max)
    }

    /// Encodes and compresses everything but names and numbers.
    pub(crate) fn pack(&self) -> Vec<u8> {
        let normalisation = self.normalisation();
        let mut out = Packer::new();
        for body in &self.bodies {
            out.body(body);
        }
        let sides: Vec<f64> = (0..self.bodies.len()).map(|body| self.side(body)).collect();
        let mut before: Vec<[Vec<u16>; 2]> = vec![Default::default(); self.bodies.len()];
        let levels = self.bodies.iter().flat_map(|body| &body.starts);
        let bits: usize = levels.map(Vec::len).sum();
        for frame in &self.frames {
            for body in 0..self.bodies.len() {
                // A byte tells whether the body has this mesh.
                let shape = frame.shapes.get(body).and_then(Option::as_ref);
                out.bytes(&[u8::from(shape.is_some())]);
                let Some(shape) = shape else {
                    continue;
                };
                for axis in 0..3 {
                    out.float(
                        (shape.lower[axis] - normalisation.centre[axis]) / normalisation.radius,
                    );
                }
                let steps = if sides[body] > 0.0 {
                    STEPS * (shape.side / sides[body])
                } else {
                    0.0
                };
                // Axis by axis, so that neighbours in the list are alike.
                let rounded: Vec<u16> = (0..3)
                    .flat_map(|axis| shape.inside.iter().map(move |position| position[axis]))
                    .map(|inside| (f64::from(inside) * steps).round() as u16)
                    .collect();
                out.positions(&rounded, &before[body]);
                let [last, _] = std::mem::take(&mut before[body]);
                before[body] = [rounded, last];
            }
            out.hits(frame);
            out.bytes(&(frame.near.len() as u32).to_le_bytes());
            out.words(frame.near.iter().copied());
            out.bytes(&(frame.gaps.len() as u32).to_le_bytes());
            for end in 0..2 {
                out.words(frame.gaps.iter().map(|gap| gap.triangles[end]));
            }
            for gap in &frame.gaps {
                for point in gap.points {
                    for axis in 0..3 {
                        out.float(
                            (point[axis] - normalisation.centre[axis]) / normalisation.radius,
                        );
                    }
                }
            }
            out.lines(frame);
            if self.depths.is_some() {
                out.bytes(&(frame.deep.len() as u32).to_le_bytes());
                out.words(frame.deep.iter().map(|&(triangle, _)| triangle));
                frame.deep.iter().for_each(|&(_, depth)| out.float(depth));
            }
            let mut made = frame.made.clone();
            made.resize(bits.max(made.len()), false);
            out.bits(&made);
        }
        out.finish()
    }
}

struct Packer(ZlibEncoder<Vec<u8>>);

impl Packer {
    fn new() -> Self {
        Self(ZlibEncoder::new(Vec::new(), Compression::new(6)))
    }

    fn finish(self) -> Vec<u8> {
        // Writing to memory cannot fail.
        self.0.finish().unwrap_or_default()
    }

    fn bytes(&mut self, bytes: &[u8]) {
        let _ = self.0.write_all(bytes);
    }

    fn float(&mut self, x: f64) {
        self.bytes(&x.to_le_bytes());
    }

    fn body(&mut self, body: &BodyRecord) {
        self.words(body.triangles.as_flattened().iter().copied());
        self.words(body.order.iter().copied());
        for starts in &body.starts {
            self.words(starts.iter().copied());
        }
        if let Some(faces) = &body.label.faces {
            self.words(faces.iter().copied());
        }
        if let Some(parts) = &body.label.parts {
            self.words(parts.of_triangles.iter().copied());
        }
    }

    /// Writes the difference of each number to the one before.
    fn words(&mut self, numbers: impl Iterator<Item = u32>) {
        let mut last = 0;
        let differences: Vec<u32> = numbers
            .map(|number| number.wrapping_sub(std::mem::replace(&mut last, number)))
            .collect();
        for byte in 0..4 {
            let plane: Vec<u8> = differences
                .iter()
                .map(|word| word.to_le_bytes()[byte])
                .collect();
            self.bytes(&plane);
        }
    }

    fn positions(&mut self, now: &[u16], [last, last_but_one]: &[Vec<u16>; 2]) {
        let mut predictions = vec![(0, left_by(now, |i| if i > 0 { now[i - 1] } else { 0 }))];
        if last.len() == now.len() {
            predictions.push((1, left_by(now, |i| last[i])));
        }
        if last_but_one.len() == now.len() && last.len() == now.len() {
            let straight_on = |i: usize| last[i].wrapping_mul(2).wrapping_sub(last_but_one[i]);
            predictions.push((2, left_by(now, straight_on)));
        }
        let size = |left: &[u16]| {
            left.iter()
                .map(|&x| u64::from((x as i16).unsigned_abs()))
                .sum::<u64>()
        };
        let best = predictions.into_iter().min_by_key(|(_, left)| size(left));
        let (mode, left) = best.unwrap_or_default();
        self.bytes(&[mode]);
        for byte in 0..2 {
            let plane: Vec<u8> = left
                .iter()
                .map(|word| zigzag(*word).to_le_bytes()[byte])
                .collect();
            self.bytes(&plane);
        }
    }

    fn hits(&mut self, frame: &Frame) {
        match &frame.hits {
            Hits::Pairs(pairs) => {
                self.bytes(&(pairs.len() as u32).to_le_bytes());
                self.bytes(&[1]);
                self.words(pairs.iter().map(|pair| pair[0]));
                self.words(pairs.iter().map(|pair| pair[1]));
            }
            Hits::Triangles(triangles) => {
                self.bytes(&(triangles.len() as u32).to_le_bytes());
                self.bytes(&[0]);
                self.words(triangles.iter().copied());
            }
        }
    }

    /// Writes lines: the places of their pairs in the list, then ends by ends.
    fn lines(&mut self, frame: &Frame) {
        let place = |line: &LineShown| match &frame.hits {
            Hits::Pairs(pairs) => pairs.binary_search(&line.triangles).ok(),
            Hits::Triangles(_) => None,
        };
        let lines = frame.lines.iter();
        let lines = lines.filter_map(|line| Some((place(line)? as u32, line)));
        let lines: Vec<(u32, &LineShown)> = lines.collect();
        self.bytes(&(lines.len() as u32).to_le_bytes());
        self.words(lines.iter().map(|&(place, _)| place));
        for end in 0..2 {
            let on: Vec<u8> = lines.iter().map(|(_, line)| line.on[end]).collect();
            self.bytes(&on);
            for byte in 0..2 {
                let parts = lines.iter().map(|(_, line)| line.parts[end].to_le_bytes());
                let plane: Vec<u8> = parts.map(|part| part[byte]).collect();
                self.bytes(&plane);
            }
        }
    }

    fn bits(&mut self, bits: &[bool]) {
        let bytes: Vec<u8> = bits
            .chunks(8)
            .map(|bits| {
                bits.iter()
                    .rev()
                    .fold(0, |byte, &bit| byte << 1 | u8::from(bit))
            })
            .collect();
        self.bytes(&bytes);
    }
}

/// Differences between values and their predictions.
fn left_by(now: &[u16], prediction: impl Fn(usize) -> u16) -> Vec<u16> {
    (0..now.len())
        .map(|i| now[i].wrapping_sub(prediction(i)))
        .collect()
}

/// Zigzag code: small differences of either sign become small numbers.
fn zigzag(difference: u16) -> u16 {
    let signed = difference as i16;
    ((signed << 1) ^ (signed >> 15)).cast_unsigned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::{GapShown, Shape};
    use crate::label::{BodyLabel, Parts};
    use flate2::read::ZlibDecoder;
    use pliant::BodyId;
    use std::io::Read;

    /// Decoder like `web/src/data.js`, which shares nothing with the encoder.
    struct Unpacker {
        bytes: Vec<u8>,
        at: usize,
    }

    impl Unpacker {
        fn new(packed: &[u8]) -> Self {
            let mut bytes = Vec::new();
            ZlibDecoder::new(packed).read_to_end(&mut bytes).unwrap();
            Self { bytes, at: 0 }
        }

        fn slice(&mut self, length: usize) -> Vec<u8> {
            self.at += length;
            self.bytes[self.at - length..self.at].to_vec()
        }

        fn array<const N: usize>(&mut self) -> [u8; N] {
            self.slice(N).try_into().unwrap()
        }

        fn words(&mut self, count: usize) -> Vec<u32> {
            let planes = [(); 4].map(|()| self.slice(count));
            let mut last = 0_u32;
            let word = |i| {
                last = last.wrapping_add(u32::from_le_bytes(planes.each_ref().map(|p| p[i])));
                last
            };
            (0..count).map(word).collect()
        }

        /// Triangles and their depths.
        fn deep(&mut self) -> Vec<(u32, f64)> {
            let count = u32::from_le_bytes(self.array()) as usize;
            let triangles = self.words(count).into_iter();
            let with_depth = triangles.map(|it| (it, f64::from_le_bytes(self.array())));
            with_depth.collect()
        }

        /// Mode of the prediction, and the decoded positions.
        fn positions(&mut self, count: usize, before: &[Vec<u16>; 2]) -> (u8, Vec<u16>) {
            let [mode] = self.array();
            let planes = [(); 2].map(|()| self.slice(count));
            let mut now: Vec<u16> = Vec::new();
            for i in 0..count {
                let folded = i32::from(u16::from_le_bytes(planes.each_ref().map(|p| p[i])));
                let difference = (folded >> 1) ^ -(folded & 1);
                let expected = match mode {
                    0 => now.last().copied().map_or(0, i32::from),
                    1 => before[0][i].into(),
                    _ => 2 * i32::from(before[0][i]) - i32::from(before[1][i]),
                };
                now.push((expected + difference) as u16);
            }
            (mode, now)
        }
    }

    fn body(number: u32, vertices: usize, triangles: &[[u32; 3]], parts: &[u32]) -> BodyRecord {
        let label = BodyLabel {
            name: String::new(),
            faces: (number == 0).then(|| (0..triangles.len() as u32).map(|t| t / 2).collect()),
            parts: (number == 1).then(|| Parts {
                names: vec!["1".to_owned()],
                of_triangles: (0..triangles.len() as u32).map(|t| t % 2).collect(),
            }),
        };
        let levels = [vec![0; triangles.len()], parts.to_vec()];
        BodyRecord::new(
            BodyId(number),
            number,
            label,
            vertices,
            triangles.to_vec(),
            &levels,
        )
    }

    /// A heap of points that stands, then moves on evenly in a fixed box, then jumps; and a growing
    /// body.
    ///
    /// The second body grows from a point. At its largest it reaches twice as far along x.
    fn motion() -> Motion {
        let heap = |frame: u32| -> Vec<[f64; 3]> {
            let mut points = vec![[0.0; 3], [1.0, 0.5, 0.25]];
            for point in 0..40_u32 {
                let random = |salt: u32| {
                    f64::from((point * 7 + salt).wrapping_mul(2_654_435_761) >> 8) / 16_777_216.0
                };
                let time = f64::from(frame.saturating_sub(1)) / 100.0;
                let [x, y, z] = [random(1), random(2) / 2.0, random(3) / 4.0];
                let far = if frame == 5 { 0.9 - 0.9 * x } else { x / 2.0 };
                points.push([far + time * y, y, z]);
            }
            points
        };
        let grown = |frame: u32| {
            let size = 3.0 * f64::from(frame);
            vec![
                [-1.0; 3],
                [size - 1.0, -1.0, -1.0],
                [-1.0, -1.0, size / 2.0 - 1.0],
            ]
        };
        let frame = |frame: u32| Frame {
            index: frame as usize,
            shapes: [heap(frame), grown(frame)]
                .iter()
                .map(|positions| Some(Shape::of(positions)))
                .collect(),
            spots: Vec::new(),
            all_spots: 0,
            moment: None,
            hits: match frame % 3 {
                0 => Hits::Pairs(vec![[0, 3], [0, 70_000], [1, 2], [258, 259]]),
                1 => Hits::Triangles(vec![0, 2, 3]),
                _ => Hits::Pairs(Vec::new()),
            },
            near: if frame == 0 {
                vec![2, 3, 70_000]
            } else {
                Vec::new()
            },
            gaps: (0..frame % 2)
                .map(|_| GapShown {
                    triangles: [3, 4],
                    points: [[0.5, 0.25, -1.0], [0.5, 0.125, f64::from(frame)]],
                })
                .collect(),
            lines: match frame % 3 {
                0 => vec![
                    LineShown {
                        triangles: [1, 2],
                        on: [3, 11],
                        parts: [70, 65_535],
                    },
                    LineShown {
                        triangles: [0, 70_000],
                        on: [0, 4],
                        parts: [0, 300],
                    },
                ],
                _ => Vec::new(),
            },
            deep: (0..frame % 3)
                .map(|triangle| (300 * triangle, f64::from(frame) / 3.0))
                .collect(),
            made: (0..11)
                .map(|bit| (bit * bit + frame).is_multiple_of(3))
                .collect(),
        };
        Motion {
            sizes: [2, 45, 6],
            bodies: vec![
                body(
                    0,
                    42,
                    &[[0, 1, 2], [41, 3, 2], [7, 8, 1], [9, 9, 9]],
                    &[1, 0, 1, 0],
                ),
                body(1, 3, &[[0, 1, 2], [2, 1, 0]], &[0, 1]),
            ],
            numbers: (0..7).collect(),
            pairs: vec![0; 7],
            depths: Some([1.0 / 3.0, 5.0 / 3.0]),
            frames: (0..7).map(frame).collect(),
            too_large: false,
        }
    }

    #[test]
    fn what_is_packed_can_be_read_back() {
        let motion = motion();
        let normalisation = motion.normalisation();
        // The second body reaches from -1 to 17.
        let expected = Normalisation {
            centre: [8.0, -0.25, 3.5],
            radius: 9.0,
        };
        assert_eq!(normalisation, expected);
        assert_eq!([motion.side(0), motion.side(1)], [1.0, 18.0]);

        let mut packed = Unpacker::new(&motion.pack());
        for body in &motion.bodies {
            let count = body.triangles.len();
            assert_eq!(packed.words(3 * count), body.triangles.as_flattened());
            assert_eq!(packed.words(count), body.order);
            for starts in &body.starts {
                assert_eq!(packed.words(starts.len()), *starts);
            }
            if let Some(faces) = &body.label.faces {
                assert_eq!(packed.words(count), *faces);
            }
            if let Some(parts) = &body.label.parts {
                assert_eq!(packed.words(count), parts.of_triangles);
            }
        }
        let mut before = [(); 2].map(|()| [Vec::new(), Vec::new()]);
        let mut modes = Vec::new();
        for frame in &motion.frames {
            for (number, shape) in frame.shapes.iter().enumerate() {
                let [is_there] = packed.array();
                let Some(shape) = shape else {
                    assert_eq!(is_there, 0);
                    continue;
                };
                assert_eq!(is_there, 1);
                for axis in 0..3 {
                    let lower = f64::from_le_bytes(packed.array()) * normalisation.radius
                        + normalisation.centre[axis];
                    assert!((lower - shape.lower[axis]).abs() < 1e-12);
                }
                let count = shape.inside.len();
                let (mode, now) = packed.positions(3 * count, &before[number]);
                modes.push(mode);
                // Half a step, and the rounding of the largest in single precision.
                let step = motion.side(number) / STEPS;
                for (at, &steps) in now.iter().enumerate() {
                    let truth = f64::from(shape.inside[at % count][at / count]) * shape.side;
                    let off = (f64::from(steps) * step - truth).abs();
                    assert!(off <= 0.500_001 * step, "{off} at {at} of {number}");
                }
                let [last, _] = std::mem::take(&mut before[number]);
                before[number] = [now, last];
            }
            let count = u32::from_le_bytes(packed.array()) as usize;
            match (packed.array(), &frame.hits) {
                ([1], Hits::Pairs(pairs)) => {
                    let [a, b] = [(); 2].map(|()| packed.words(count));
                    let read: Vec<[u32; 2]> = a.into_iter().zip(b).map(|(a, b)| [a, b]).collect();
                    assert_eq!(read, *pairs);
                }
                ([0], Hits::Triangles(triangles)) => assert_eq!(packed.words(count), *triangles),
                (kind, hits) => panic!("{kind:?} for {hits:?}"),
            }
            let count = u32::from_le_bytes(packed.array()) as usize;
            assert_eq!(packed.words(count), frame.near);
            let count = u32::from_le_bytes(packed.array()) as usize;
            let [a, b] = [(); 2].map(|()| packed.words(count));
            assert_eq!((a.len(), b.len()), (frame.gaps.len(), frame.gaps.len()));
            for (number, gap) in frame.gaps.iter().enumerate() {
                assert_eq!([a[number], b[number]], gap.triangles);
                for point in gap.points {
                    for axis in 0..3 {
                        let x = f64::from_le_bytes(packed.array()) * normalisation.radius;
                        assert!((x + normalisation.centre[axis] - point[axis]).abs() < 1e-12);
                    }
                }
            }
            let count = u32::from_le_bytes(packed.array()) as usize;
            assert_eq!(count, frame.lines.len());
            let places = packed.words(count);
            let ends = [(); 2].map(|()| [(); 3].map(|()| packed.slice(count)));
            for (number, line) in frame.lines.iter().enumerate() {
                let Hits::Pairs(pairs) = &frame.hits else {
                    panic!("lines without pairs");
                };
                assert_eq!(pairs[places[number] as usize], line.triangles);
                let [p, q] = &ends;
                assert_eq!([p[0][number], q[0][number]], line.on);
                let part =
                    |end: &[Vec<u8>; 3]| u16::from_le_bytes([end[1][number], end[2][number]]);
                assert_eq!([part(p), part(q)], line.parts);
            }
            assert_eq!(packed.deep(), frame.deep);
            let bytes = packed.slice(frame.made.len().div_ceil(8));
            let bits = (0..frame.made.len()).map(|bit| bytes[bit / 8] >> (bit % 8) & 1 == 1);
            assert!(bits.eq(frame.made.iter().copied()));
        }
        assert_eq!(packed.at, packed.bytes.len());
        // Modes of the heap: no frame before, frame before, frame before, linear, and so on; then a
        // jump.
        let of_heap: Vec<u8> = modes.into_iter().step_by(2).collect();
        assert_eq!(of_heap[..2], [0, 1]);
        assert_eq!(of_heap[3..5], [2, 2]);
    }

    #[test]
    fn small_differences_of_either_sign_are_small_numbers() {
        let folded = [0, -1, 1, -2, 2].map(|difference: i16| zigzag(difference.cast_unsigned()));
        assert_eq!(folded, [0, 1, 2, 3, 4]);
        assert_eq!(zigzag(i16::MIN.cast_unsigned()), u16::MAX);
    }
}
