//! Software renderer: one frame as an image, without a browser and without a GPU.
//!
//! Triangles are flat; intersecting ones are red, and faintly so where others hide them. The
//! projection is parallel, without perspective, and the bodies fill the image. A picture of a place
//! shows it and its surroundings, and an inset of everything, where a frame marks the place. There
//! are four samples a pixel. All computation is sums, products, quotients and square roots in
//! double precision, in a fixed order: the same bytes on every machine.

mod letters;
mod raster;

use crate::MARK;
use crate::colours::{Colour, HIT, of_body};
use crate::frames::Spot;
use pliant::{Scalar, World};
use raster::Canvas;
use std::io::{self, Write};
use std::str::FromStr;

/// Default size of a picture: pixels across and down.
pub const SIZE: [usize; 2] = [1280, 960];

const PAPER: Colour = [255, 255, 255];

const INK: Colour = [0x1e, 0x20, 0x24];
const LINE: Colour = [0xe5, 0xe3, 0xde];

/// Size of the inset, as a part of the picture in each direction.
const INSET: f64 = 0.28;

/// Direction of view; y is up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum View {
    /// From the right, from above, from the front, where the page's camera begins too.
    #[default]
    Corner,
    /// Against z.
    Front,
    /// Along z.
    Back,
    /// Along x.
    Left,
    /// Against x.
    Right,
    /// Down along y.
    Top,
    /// Up along y.
    Bottom,
}

impl View {
    /// All views, by the names that people type.
    pub const NAMES: [(&str, Self); 7] = [
        ("corner", Self::Corner),
        ("front", Self::Front),
        ("back", Self::Back),
        ("left", Self::Left),
        ("right", Self::Right),
        ("top", Self::Top),
        ("bottom", Self::Bottom),
    ];

    /// Unit vectors towards the eye, to its right, and up.
    fn directions(self) -> [[f64; 3]; 3] {
        let (eye, up) = match self {
            Self::Corner => ([0.55, 0.45, 1.0], [0.0, 1.0, 0.0]),
            Self::Front => ([0.0, 0.0, 1.0], [0.0, 1.0, 0.0]),
            Self::Back => ([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]),
            Self::Left => ([-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
            Self::Right => ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
            Self::Top => ([0.0, 1.0, 0.0], [0.0, 0.0, -1.0]),
            Self::Bottom => ([0.0, -1.0, 0.0], [0.0, 0.0, 1.0]),
        };
        let eye = unit(eye);
        let right = unit(cross(up, eye));
        [eye, right, cross(eye, right)]
    }
}

impl FromStr for View {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let known = Self::NAMES.into_iter().find(|(known, _)| *known == name);
        known.map(|(_, view)| view).ok_or_else(|| {
            let names = Self::NAMES.map(|(known, _)| known);
            format!(
                "there is no view {name:?}; choose one of {}",
                names.join(", ")
            )
        })
    }
}

/// Settings of a picture.
#[derive(Clone, Debug, Default)]
pub struct Shot<'a> {
    /// Size: pixels across and down; [`SIZE`] if either is 0.
    pub size: [usize; 2],
    /// Direction of view.
    pub view: View,
    /// Place that fills the picture, with lines where pairs meet; `None` for everything.
    pub spot: Option<&'a Spot>,
    /// Caption: a line of text in the upper left corner, as far as there is room.
    pub caption: String,
}

/// An image: red, green and blue of each pixel, row by row from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Size: pixels across and down.
    pub size: [usize; 2],
    /// Three bytes a pixel.
    pub pixels: Vec<u8>,
}

impl Picture {
    /// Draws the bodies of a world as they are now, from the default view.
    ///
    /// Triangles in `pairs` (body, triangle, body, triangle) are red, and shine through others that
    /// hide them. O(b p + t + s) for b bodies, p pairs, t triangles and s samples that these cover.
    pub fn of<S: Scalar>(world: &World<S>, pairs: &[[u32; 4]], size: [usize; 2]) -> Self {
        let directions = View::Corner.directions();
        let triangles = seen_of(world, pairs, directions);
        draw(&triangles, &[], size, rectangle_of(corners_of(&triangles)))
    }

    /// Draws a picture of a world with the settings of a [`Shot`].
    pub fn shot<S: Scalar>(world: &World<S>, pairs: &[[u32; 4]], shot: &Shot) -> Self {
        let size = if shot.size.contains(&0) {
            SIZE
        } else {
            shot.size
        };
        let directions = shot.view.directions();
        let triangles = seen_of(world, pairs, directions);
        let whole = rectangle_of(corners_of(&triangles));
        let mut picture = match shot.spot {
            None => draw(&triangles, &[], size, whole),
            Some(spot) => {
                let there = rectangle_of(box_seen(spot, directions).into_iter());
                let lines = lines_of(world, pairs, directions);
                let mut picture = draw(&triangles, &lines, size, near(there, whole));
                let inset = size.map(|length| (INSET * length as f64) as usize);
                if inset.iter().all(|&length| length > 16) {
                    let small = draw(&triangles, &[], inset, whole);
                    let marked = mark(there, whole, inset);
                    picture.inlay(&small, marked);
                }
                picture
            }
        };
        picture.write(&shot.caption);
        picture
    }

    /// Puts another picture into the lower right corner, framed, and marks a part of it: left, top,
    /// right, bottom.
    fn inlay(&mut self, small: &Self, marked: [usize; 4]) {
        let [width, height] = small.size;
        let from = [self.size[0] - width - 8, self.size[1] - height - 8];
        for row in 0..height {
            for column in 0..width {
                let at = 3 * (row * width + column);
                let colour = [small.pixels[at], small.pixels[at + 1], small.pixels[at + 2]];
                let is_edge = row == 0 || column == 0 || row + 1 == height || column + 1 == width;
                self.dot(
                    [from[0] + column, from[1] + row],
                    if is_edge { LINE } else { colour },
                );
            }
        }
        let [left, top, right, bottom] = marked;
        for thick in 0..2 {
            for column in left..=right {
                self.dot([from[0] + column, from[1] + top + thick], HIT);
                self.dot([from[0] + column, from[1] + bottom - thick], HIT);
            }
            for row in top..=bottom {
                self.dot([from[0] + left + thick, from[1] + row], HIT);
                self.dot([from[0] + right - thick, from[1] + row], HIT);
            }
        }
    }

    /// Writes a line of text into the upper left corner, as far as there is room.
    fn write(&mut self, text: &str) {
        const SCALE: usize = 2;
        const MARGIN: usize = 12;
        let room = self.size[0].saturating_sub(2 * MARGIN) / (SCALE * letters::ADVANCE);
        if self.size[1] < 2 * MARGIN + SCALE * letters::LINE {
            return;
        }
        let text: String = text.chars().take(room).collect();
        for [x, y] in letters::dots(&text) {
            for part in 0..SCALE * SCALE {
                let at = [SCALE * x + part % SCALE, SCALE * y + part / SCALE];
                self.dot(at.map(|x| x + MARGIN), INK);
            }
        }
    }

    /// Sets the colour of a pixel, if it is in the picture.
    fn dot(&mut self, [x, y]: [usize; 2], colour: Colour) {
        if x < self.size[0] && y < self.size[1] {
            let at = 3 * (y * self.size[0] + x);
            self.pixels[at..at + 3].copy_from_slice(&colour);
        }
    }

    /// Writes the picture as a PNG.
    ///
    /// # Errors
    ///
    /// The writer fails, or the encoder refuses the picture.
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

/// A triangle in the coordinates of the view: to the right, up, towards the eye.
struct Seen {
    corners: [[f64; 3]; 3],
    colour: Colour,
    is_hit: bool,
}

/// Triangles of all bodies in the coordinates of a view.
fn seen_of<S: Scalar>(
    world: &World<S>,
    pairs: &[[u32; 4]],
    [eye, right, up]: [[f64; 3]; 3],
) -> Vec<Seen> {
    let seen = |position: &[S; 3]| {
        let position = position.map(S::to_f64);
        [dot(position, right), dot(position, up), dot(position, eye)]
    };
    let mut triangles = Vec::new();
    for (number, body) in world.bodies().enumerate() {
        // Cannot fail: the bodies are this world's.
        let (Ok(corners), Ok(positions)) = (world.triangles(body), world.positions(body)) else {
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
        // Numbers that an edit has left empty are not drawn.
        let live = corners.iter().enumerate();
        let live = live.filter(|(_, corners)| corners.iter().all(|&it| it != u32::MAX));
        triangles.extend(live.map(|(triangle, corners)| {
            let is_hit = is_red[triangle];
            Seen {
                corners: corners.map(|vertex| places[vertex as usize]),
                colour: if is_hit { HIT } else { of_body(number) },
                is_hit,
            }
        }));
    }
    triangles
}

/// Lines where pairs meet, in the coordinates of a view.
fn lines_of<S: Scalar>(
    world: &World<S>,
    pairs: &[[u32; 4]],
    directions: [[f64; 3]; 3],
) -> Vec<[[f64; 3]; 2]> {
    let [eye, right, up] = directions;
    let seen = |point| [dot(point, right), dot(point, up), dot(point, eye)];
    let lines = crate::lines::of_pairs(world, pairs);
    lines
        .into_iter()
        .map(|(_, ends)| ends.map(|end| seen(end.point)))
        .collect()
}

/// A rectangle in the view: lower and upper corner.
type Rectangle = [[f64; 2]; 2];

fn corners_of(triangles: &[Seen]) -> impl Iterator<Item = [f64; 3]> {
    triangles.iter().flat_map(|triangle| triangle.corners)
}

fn rectangle_of(corners: impl Iterator<Item = [f64; 3]>) -> Rectangle {
    let (mut lower, mut upper) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for corner in corners {
        for axis in 0..2 {
            (lower[axis], upper[axis]) =
                (lower[axis].min(corner[axis]), upper[axis].max(corner[axis]));
        }
    }
    [lower, upper]
}

/// Corners of a place's bounding box in the coordinates of a view.
fn box_seen(spot: &Spot, [eye, right, up]: [[f64; 3]; 3]) -> [[f64; 3]; 8] {
    std::array::from_fn(|corner| {
        let at: [f64; 3] =
            std::array::from_fn(|axis| [spot.lower, spot.upper][corner >> axis & 1][axis]);
        [dot(at, right), dot(at, up), dot(at, eye)]
    })
}

/// Rectangle of a place and its surroundings, at least a twentieth of everything.
fn near([lower, upper]: Rectangle, [all_lower, all_upper]: Rectangle) -> Rectangle {
    let side = |lower: [f64; 2], upper: [f64; 2]| (upper[0] - lower[0]).max(upper[1] - lower[1]);
    let half = (1.1 * side(lower, upper)).max(0.025 * side(all_lower, all_upper));
    let middle: [f64; 2] = std::array::from_fn(|axis| f64::midpoint(lower[axis], upper[axis]));
    [middle.map(|x| x - half), middle.map(|x| x + half)]
}

/// Scale in samples a unit, at which a rectangle fills a picture.
///
/// The margin is a twentieth of the picture on every side. There are two samples a pixel in each
/// direction.
fn scale_of([lower, upper]: Rectangle, size: [usize; 2]) -> f64 {
    let scale = (0..2)
        .map(|axis| 0.9 * 2.0 * size[axis] as f64 / (upper[axis] - lower[axis]))
        .fold(f64::INFINITY, f64::min);
    if scale.is_finite() { scale } else { 1.0 }
}

/// Rectangle of a place in a picture of everything, in pixels: left, top, right, bottom; large
/// enough to be seen.
fn mark(there: Rectangle, whole: Rectangle, size: [usize; 2]) -> [usize; 4] {
    let scale = scale_of(whole, size) / 2.0;
    let pixel = |axis: usize, x: f64, room: f64| {
        let from_middle = (x - f64::midpoint(whole[0][axis], whole[1][axis])) * scale;
        let towards = if axis == 0 { from_middle } else { -from_middle };
        let last = size[axis] as f64 - 3.0;
        (size[axis] as f64 / 2.0 + towards + room)
            .round()
            .clamp(2.0, last) as usize
    };
    let [lower, upper] = there;
    [
        pixel(0, lower[0], -6.0),
        pixel(1, upper[1], -6.0),
        pixel(0, upper[0], 6.0),
        pixel(1, lower[1], 6.0),
    ]
}

fn draw(
    triangles: &[Seen],
    lines: &[[[f64; 3]; 2]],
    size: [usize; 2],
    rectangle: Rectangle,
) -> Picture {
    let scale = scale_of(rectangle, size);
    let [lower, upper] = rectangle;
    let samples = size.map(|length| 2.0 * length as f64);
    let middle: [f64; 2] = std::array::from_fn(|axis| f64::midpoint(lower[axis], upper[axis]));
    let mut canvas = Canvas::new(size.map(|length| 2 * length), PAPER);
    let at = |[x, y, z]: [f64; 3]| {
        [
            samples[0] / 2.0 + (x - middle[0]) * scale,
            samples[1] / 2.0 - (y - middle[1]) * scale,
            z * scale,
        ]
    };
    for triangle in triangles {
        let corners = triangle.corners.map(at);
        let colour = lit(triangle.colour, corners);
        canvas.triangle(corners, colour, triangle.is_hit);
        if triangle.is_hit {
            canvas.edges_of_small(corners, colour);
        }
    }
    for line in lines {
        canvas.line(line.map(at), INK);
    }
    Picture {
        size,
        pixels: canvas.halved(),
    }
}

/// Shades a colour: the light comes from the eye, a little from its upper left.
fn lit(colour: Colour, [a, b, c]: [[f64; 3]; 3]) -> Colour {
    let light = unit([-0.3, -0.4, 1.0]);
    let normal = unit(cross(minus(b, a), minus(c, a)));
    let bright = 0.45 + 0.6 * dot(normal, light).abs();
    colour.map(|part| (f64::from(part) * bright).round().clamp(0.0, 255.0) as u8)
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

/// Unit vector; a zero vector stays zero.
fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    if length > 0.0 {
        a.map(|x| x / length)
    } else {
        a
    }
}
