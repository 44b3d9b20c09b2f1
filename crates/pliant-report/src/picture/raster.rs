//! Rasteriser with a z-buffer: the nearest triangle wins, and red behind it shines through.

use crate::colours::{Colour, HIT};

/// Canvas of samples, row by row from the top.
pub(super) struct Canvas {
    size: [usize; 2],
    colours: Vec<Colour>,
    /// Depth of each sample, as nearness to the eye: larger is nearer.
    nearness: Vec<f64>,
    red: Vec<Red>,
}

/// Position of an intersecting triangle at a sample. It does not depend on the number or order of
/// triangles.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Red {
    Nowhere,
    /// Behind a triangle that does not intersect: it shines through.
    Behind,
    InFront,
}

impl Canvas {
    pub(super) fn new(size: [usize; 2], paper: Colour) -> Self {
        Self {
            size,
            colours: vec![paper; size[0] * size[1]],
            nearness: vec![f64::NEG_INFINITY; size[0] * size[1]],
            red: vec![Red::Nowhere; size[0] * size[1]],
        }
    }

    /// Draws a triangle in samples: x to the right, y down, z towards the eye.
    ///
    /// Of two that are equally near, an intersecting one wins, then the earlier one.
    pub(super) fn triangle(&mut self, [a, b, c]: [[f64; 3]; 3], colour: Colour, is_hit: bool) {
        let area = side(a, b, [c[0], c[1]]);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        // Samples are in the middle of their cells.
        let range = |axis: usize| {
            let all = [a[axis], b[axis], c[axis]];
            let least = all.into_iter().fold(f64::INFINITY, f64::min);
            let most = all.into_iter().fold(f64::NEG_INFINITY, f64::max);
            let first = (least - 0.5).ceil().max(0.0) as usize;
            let end = ((most - 0.5).floor() + 1.0).clamp(0.0, self.size[axis] as f64) as usize;
            first..end
        };
        let columns = range(0);
        for row in range(1) {
            for column in columns.clone() {
                let at = [column as f64 + 0.5, row as f64 + 0.5];
                let of_a = side(b, c, at) / area;
                let of_b = side(c, a, at) / area;
                let of_c = side(a, b, at) / area;
                if of_a < 0.0 || of_b < 0.0 || of_c < 0.0 {
                    continue;
                }
                let near = of_a * a[2] + of_b * b[2] + of_c * c[2];
                let sample = row * self.size[0] + column;
                let before = self.nearness[sample];
                let in_front = near > before || (near == before && is_hit);
                if in_front {
                    self.nearness[sample] = near;
                    self.colours[sample] = colour;
                }
                self.red[sample] = match (is_hit, self.red[sample]) {
                    (true, _) if in_front => Red::InFront,
                    (true, Red::Nowhere) => Red::Behind,
                    (false, Red::InFront) if in_front => Red::Behind,
                    (_, as_before) => as_before,
                };
            }
        }
    }

    /// Draws the edges of an intersecting triangle that is smaller than a pixel and might cover no
    /// sample.
    pub(super) fn edges_of_small(&mut self, [a, b, c]: [[f64; 3]; 3], colour: Colour) {
        const PIXEL: f64 = 2.0;
        let size = side(a, b, [c[0], c[1]]).abs();
        let long = |p: [f64; 3], q: [f64; 3]| (p[0] - q[0]).abs().max((p[1] - q[1]).abs());
        let longest = long(a, b).max(long(b, c)).max(long(c, a));
        // Narrow triangles too: their height is twice the area divided by their longest side.
        let is_small = size < PIXEL * longest.max(PIXEL);
        let is_near = longest < 4.0 * (self.size[0] + self.size[1]) as f64;
        if !is_small || !is_near {
            return;
        }
        for (p, q) in [(a, b), (b, c), (c, a)] {
            let steps = long(p, q).ceil().max(1.0) as usize;
            for step in 0..=steps {
                let part = step as f64 / steps as f64;
                let at: [f64; 3] = std::array::from_fn(|axis| p[axis] + part * (q[axis] - p[axis]));
                self.red_at(at, colour);
            }
        }
    }

    /// Draws a line in samples, a pixel wide, over everything.
    pub(super) fn line(&mut self, [p, q]: [[f64; 3]; 2], colour: Colour) {
        let long = (p[0] - q[0]).abs().max((p[1] - q[1]).abs());
        if long > 4.0 * (self.size[0] + self.size[1]) as f64 {
            return;
        }
        let steps = long.ceil().max(1.0) as usize;
        for step in 0..=steps {
            let part = step as f64 / steps as f64;
            let [x, y] = [0, 1].map(|axis| p[axis] + part * (q[axis] - p[axis]));
            for [across, down] in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]] {
                let (x, y) = (x + across - 0.5, y + down - 0.5);
                let [width, height] = self.size;
                if x >= 0.0 && y >= 0.0 && x < width as f64 && y < height as f64 {
                    let sample = y as usize * width + x as usize;
                    self.colours[sample] = colour;
                    self.red[sample] = Red::InFront;
                }
            }
        }
    }

    /// Colours a whole pixel of an intersecting triangle, since one sample would be a quarter as
    /// red.
    fn red_at(&mut self, [x, y, near]: [f64; 3], colour: Colour) {
        let is_inside = x >= 0.0 && y >= 0.0 && x < self.size[0] as f64 && y < self.size[1] as f64;
        if !is_inside {
            return;
        }
        let [column, row] = [x as usize / 2 * 2, y as usize / 2 * 2];
        for [across, down] in [[0, 0], [1, 0], [0, 1], [1, 1]] {
            let sample = (row + down) * self.size[0] + column + across;
            if near >= self.nearness[sample] {
                self.nearness[sample] = near;
                self.colours[sample] = colour;
                self.red[sample] = Red::InFront;
            } else if self.red[sample] == Red::Nowhere {
                self.red[sample] = Red::Behind;
            }
        }
    }

    /// Image of half the size: each pixel is the mean of its four samples.
    pub(super) fn halved(&self) -> Vec<u8> {
        let [width, height] = self.size;
        let mut pixels = Vec::with_capacity(width * height / 4 * 3);
        for row in (0..height).step_by(2) {
            for column in (0..width).step_by(2) {
                let above = row * width + column;
                let samples = [above, above + 1, above + width, above + width + 1];
                for part in 0..3 {
                    let sum: u16 = samples
                        .iter()
                        .map(|&sample| u16::from(self.shown(sample)[part]))
                        .sum();
                    pixels.push(((sum + 2) / 4) as u8);
                }
            }
        }
        pixels
    }

    /// Colour of a sample: the front, with a third of red if red is behind.
    fn shown(&self, sample: usize) -> Colour {
        let front = self.colours[sample];
        if self.red[sample] != Red::Behind {
            return front;
        }
        std::array::from_fn(|part| {
            let parts = 2 * u16::from(front[part]) + u16::from(HIT[part]);
            ((parts + 1) / 3) as u8
        })
    }
}

/// Signed area of a triangle, doubled. Its sign tells the side of the edge from `a` to `b` that
/// `at` is on.
fn side(a: [f64; 3], b: [f64; 3], at: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (at[1] - a[1]) - (b[1] - a[1]) * (at[0] - a[0])
}
