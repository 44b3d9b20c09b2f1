//! One frame as an image, without a browser and without a GPU: flat triangles, those that intersect in red, and faintly
//! so where others hide them.
//!
//! Looks along one direction, without perspective, so that parallel edges stay so; the bodies fill the image. Four samples a
//! pixel. Sums, products, quotients and square roots in double precision only, in a fixed order: the same bytes on every machine.

mod raster;

use crate::MARK;
use crate::colours::{Colour, HIT, of_body};
use pliant::{Scalar, World};
use raster::Canvas;
use std::io::{self, Write};

/// Pixels across and down.
pub const SIZE: [usize; 2] = [1280, 960];

const PAPER: Colour = [255, 255, 255];

/// From where one looks: from the right, from above, from the front. The page's camera begins there too.
const TOWARDS_EYE: [f64; 3] = [0.55, 0.45, 1.0];

/// Red, green and blue of each pixel, row by row from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels across and down.
    pub size: [usize; 2],
    /// Three bytes a pixel.
    pub pixels: Vec<u8>,
}

impl Picture {
    /// The bodies of a world as they are now; red are the triangles in `pairs`: body, triangle, body, triangle. Behind others they
    /// shine through.
    pub fn of<S: Scalar>(world: &World<S>, pairs: &[[u32; 4]], size: [usize; 2]) -> Self {
        let (eye, right, up) = directions();
        let seen = |position: &[S; 3]| {
            let position = position.map(S::to_f64);
            [dot(position, right), dot(position, up), dot(position, eye)]
        };
        let mut triangles = Vec::new();
        for (number, body) in world.bodies().enumerate() {
            // Bodies of this world; neither fails.
            let (Ok(corners), Ok(positions)) = (world.triangles(body), world.positions(body))
            else {
                continue;
            };
            let places: Vec<[f64; 3]> = positions.iter().map(seen).collect();
            let mut is_red = vec![false; corners.len()];
            for &[body_a, a, body_b, b] in pairs {
                for (of, triangle) in [(body_a, a), (body_b, b)] {
                    if of == body.0 && (triangle as usize) < is_red.len() {
                        is_red[triangle as usize] = true;
                    }
                }
            }
            triangles.extend(corners.iter().enumerate().map(|(triangle, corners)| {
                let is_hit = is_red[triangle];
                Seen {
                    corners: corners.map(|vertex| places[vertex as usize]),
                    colour: if is_hit { HIT } else { of_body(number) },
                    is_hit,
                }
            }));
        }
        draw(&triangles, size)
    }

    /// Writes a PNG.
    ///
    /// # Errors
    ///
    /// Those of writing.
    pub fn write_png(&self, to: impl Write) -> io::Result<()> {
        let [width, height] = self
            .size
            .map(|length| u32::try_from(length).unwrap_or(u32::MAX));
        let mut encoder = png::Encoder::new(to, width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.add_text_chunk("Software".to_owned(), MARK.to_owned())?;
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.pixels)?;
        writer.finish()?;
        Ok(())
    }
}

/// A triangle as the eye sees it: to the right, up, towards the eye.
struct Seen {
    corners: [[f64; 3]; 3],
    colour: Colour,
    is_hit: bool,
}

fn draw(triangles: &[Seen], size: [usize; 2]) -> Picture {
    let (mut lower, mut upper) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for corner in triangles.iter().flat_map(|triangle| &triangle.corners) {
        for axis in 0..2 {
            (lower[axis], upper[axis]) =
                (lower[axis].min(corner[axis]), upper[axis].max(corner[axis]));
        }
    }
    // A margin of a twentieth on every side; two samples a pixel each way.
    let samples = size.map(|length| 2.0 * length as f64);
    let scale = (0..2)
        .map(|axis| 0.9 * samples[axis] / (upper[axis] - lower[axis]))
        .fold(f64::INFINITY, f64::min);
    let scale = if scale.is_finite() { scale } else { 1.0 };
    let middle: [f64; 2] = std::array::from_fn(|axis| f64::midpoint(lower[axis], upper[axis]));
    let mut canvas = Canvas::new(size.map(|length| 2 * length), PAPER);
    for triangle in triangles {
        let corners = triangle.corners.map(|[x, y, z]| {
            [
                samples[0] / 2.0 + (x - middle[0]) * scale,
                samples[1] / 2.0 - (y - middle[1]) * scale,
                z * scale,
            ]
        });
        canvas.triangle(corners, lit(triangle.colour, corners), triangle.is_hit);
    }
    Picture {
        size,
        pixels: canvas.halved(),
    }
}

/// A colour in the light, which comes from the eye and a little from its upper left.
fn lit(colour: Colour, [a, b, c]: [[f64; 3]; 3]) -> Colour {
    let light = unit([-0.3, -0.4, 1.0]);
    let normal = unit(cross(minus(b, a), minus(c, a)));
    let bright = 0.45 + 0.6 * dot(normal, light).abs();
    colour.map(|part| (f64::from(part) * bright).round().clamp(0.0, 255.0) as u8)
}

/// Towards the eye, to its right, and up: y is up in the image.
fn directions() -> ([f64; 3], [f64; 3], [f64; 3]) {
    let eye = unit(TOWARDS_EYE);
    let right = unit(cross([0.0, 1.0, 0.0], eye));
    (eye, right, cross(eye, right))
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Of length 1; of nothing, nothing.
fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    if length > 0.0 {
        a.map(|x| x / length)
    } else {
        a
    }
}
