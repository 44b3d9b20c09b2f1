//! A motion as one run of bytes, which compresses well: small differences, bytes of equal weight side by side.
//!
//! Positions are rounded to 65,535 steps along the longest side that their body ever has, in a box that moves with the body. A
//! list of numbers is written as differences, low bytes first, then the next higher bytes. Positions differ from what one of
//! three predictions says, whichever leaves least: the vertex before, the frame before, or the last two frames in a straight line.
//! `web/src/data.js` reads it back.

use crate::frames::{BodyRecord, Frame, Hits, Motion};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::io::Write;

/// Steps along the longest side of a body.
pub(crate) const STEPS: f64 = 65_535.0;

/// Where a page puts a motion: this point in its middle, this distance as 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct View {
    pub(crate) centre: [f64; 3],
    pub(crate) radius: f64,
}

impl Motion {
    /// The box of all frames that are shown.
    pub(crate) fn view(&self) -> View {
        let (mut lower, mut upper) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for shape in self.frames.iter().flat_map(|frame| &frame.shapes) {
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
        View {
            centre: if is_real {
                std::array::from_fn(|axis| f64::midpoint(lower[axis], upper[axis]))
            } else {
                lower.map(|x| if x.is_finite() { x } else { 0.0 })
            },
            radius: if is_real { radius } else { 1.0 },
        }
    }

    /// The longest side that a body ever has.
    pub(crate) fn side(&self, body: usize) -> f64 {
        self.frames
            .iter()
            .map(|frame| frame.shapes[body].side)
            .fold(0.0, f64::max)
    }

    /// Everything but names and numbers, compressed.
    pub(crate) fn pack(&self) -> Vec<u8> {
        let view = self.view();
        let mut out = Packer::new();
        for body in &self.bodies {
            out.body(body);
        }
        let sides: Vec<f64> = (0..self.bodies.len()).map(|body| self.side(body)).collect();
        let mut before: Vec<[Vec<u16>; 2]> = vec![Default::default(); self.bodies.len()];
        for frame in &self.frames {
            for (body, shape) in frame.shapes.iter().enumerate() {
                for axis in 0..3 {
                    out.float((shape.lower[axis] - view.centre[axis]) / view.radius);
                }
                let steps = if sides[body] > 0.0 {
                    STEPS * (shape.side / sides[body])
                } else {
                    0.0
                };
                // Axis by axis: neighbours in the list then mean the same.
                let rounded: Vec<u16> = (0..3)
                    .flat_map(|axis| shape.inside.iter().map(move |position| position[axis]))
                    .map(|inside| (f64::from(inside) * steps).round() as u16)
                    .collect();
                out.positions(&rounded, &before[body]);
                let [last, _] = std::mem::take(&mut before[body]);
                before[body] = [rounded, last];
            }
            out.hits(frame);
            out.bits(&frame.made);
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
        // Into memory: nothing can fail.
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
    }

    /// Each number as its difference to the one before.
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

/// What a prediction leaves to be written.
fn left_by(now: &[u16], prediction: impl Fn(usize) -> u16) -> Vec<u16> {
    (0..now.len())
        .map(|i| now[i].wrapping_sub(prediction(i)))
        .collect()
}

/// Small differences of either sign as small numbers.
fn zigzag(difference: u16) -> u16 {
    let signed = difference as i16;
    ((signed << 1) ^ (signed >> 15)).cast_unsigned()
}
