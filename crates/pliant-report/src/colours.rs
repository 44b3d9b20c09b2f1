//! Colours: calm ones for bodies, so that red is for intersections and nothing else.

/// Red, green and blue.
pub(crate) type Colour = [u8; 3];

/// Red of intersecting triangles.
pub(crate) const HIT: Colour = [0xd6, 0x2f, 0x2b];

/// Orange of triangles that are close and do not intersect.
pub(crate) const NEAR: Colour = [0xe8, 0x8a, 0x12];

pub(crate) const BODIES: [Colour; 6] = [
    [0x8f, 0xa9, 0xc4], // slate blue
    [0xd3, 0xc0, 0x98], // sand
    [0x9d, 0xb8, 0xa0], // sage
    [0xb4, 0xa7, 0xca], // lilac
    [0x8c, 0xb9, 0xbd], // lagoon
    [0xb9, 0xb5, 0xae], // stone
];

/// Colours of a chart's lines, readable on white and on near-black.
const LINES: [&str; 8] = [
    "#3f7fd0", "#c08a1e", "#3f9c6d", "#8d69c4", "#2b9fb0", "#a8678f", "#7d8590", "#8a7a4a",
];

/// Colour of a body, by its number.
pub(crate) fn of_body(number: usize) -> Colour {
    BODIES[number % BODIES.len()]
}

/// Colour and dashes of a chart's line, by its number.
///
/// Neighbours differ in both, and no two of 24 are alike in both.
pub(crate) fn of_line(number: usize) -> (&'static str, &'static [u8]) {
    const DASHES: [&[u8]; 3] = [&[], &[6, 3], &[2, 3]];
    (LINES[number % LINES.len()], DASHES[number % DASHES.len()])
}
