//! PLY reader: a header that declares elements and properties, then values in ASCII or binary.
//!
//! The crate has its own reader (`header.rs`, `values.rs`), because ply-rs-bw 4.0.1 failed on
//! strange files:
//!
//! - it loops as often as the header claims, even where an element has no properties and so no
//!   data;
//! - it reads a header line of any length;
//! - its ASCII grammar refuses `1.` and `.5`;
//! - it returns rows as maps of names.
//!
//! What is read:
//!
//! - Positions are `x`, `y`, `z` of `vertex`: f32 where all three types are exact in f32 (`float`
//!   and small integers), otherwise f64.
//! - Polygons are the list `vertex_indices`, or `vertex_index`, of `face`.
//! - Without polygons, `tristrips` are read. Each vertex of a strip makes a triangle with the two
//!   before it, with every other triangle reversed. A new strip follows -1. Triangles with a
//!   repeated corner only lead to the next one.
//! - Other elements and properties are passed over. Elements behind the last needed are not read.

mod header;
mod values;

use std::io::BufRead;

use crate::error::{Fault, Reason};
use crate::frame::{Announced, Complete, Frame};
use crate::positions::Precision;
use crate::text::{Lines, two_coordinates};
use header::{Element, Encoding, Header, Kind, Scalar};
use values::{Ascii, BigEndian, Binary, LittleEndian, Values};

/// Most corners of a polygon: more than the longest ASCII line can hold.
const MOST_CORNERS: usize = 16 << 20;

/// Reads one file, which is one frame.
pub(crate) fn read(mut input: impl BufRead, frame: &mut Frame) -> Result<Complete, Fault> {
    let mut lines = Lines::new(&mut input);
    let header = Header::read(&mut lines)?;
    match header.encoding {
        Encoding::Ascii => read_elements(&header, Ascii::new(lines), frame),
        Encoding::LittleEndian => {
            read_elements(&header, Binary::<_, LittleEndian>::new(input), frame)
        }
        Encoding::BigEndian => read_elements(&header, Binary::<_, BigEndian>::new(input), frame),
    }
}

fn read_elements(
    header: &Header,
    mut values: impl Values,
    frame: &mut Frame,
) -> Result<Complete, Fault> {
    let vertex = header.element("vertex").ok_or(Reason::NoVertices)?;
    let polygons = header.element("face").filter(|face| face.count > 0);
    let strips = header.element("tristrips");
    let is_strips = polygons.is_none() && strips.is_some();
    let face = polygons.or(strips).or_else(|| header.element("face"));
    let face = face.ok_or(Reason::NoFaces)?;
    let axes = axes(vertex)?;
    let corners = corners_of(face)?;
    let announced = Announced {
        vertices: vertex.count,
        // A strip tells its length only where it is stored.
        faces: if is_strips { 0 } else { face.count },
    };
    frame.begin(precision(vertex, axes), announced)?;

    let mut polygon = Vec::new();
    let (mut vertices_read, mut faces_read) = (false, false);
    for element in &header.elements {
        // Without properties an element has no data, whatever count it claims.
        let rows = if element.properties.is_empty() {
            0
        } else {
            element.count
        };
        for row in 0..rows {
            values.begin_row(element, row)?;
            if std::ptr::eq(element, vertex) {
                let position = read_vertex(element, axes, &mut values)?;
                frame
                    .vertex(position)
                    .map_err(|reason| reason.at(values.place()))?;
            } else if std::ptr::eq(element, face) && is_strips {
                read_strips(element, corners, &mut values, frame)?;
            } else if std::ptr::eq(element, face) {
                polygon.clear();
                read_face(element, corners, row, &mut polygon, &mut values)?;
                frame
                    .face(&polygon, || values.place())
                    .map_err(|reason| reason.at(values.place()))?;
            } else {
                for property in &element.properties {
                    skip(property.kind, &mut values)?;
                }
            }
            values.end_row()?;
        }
        vertices_read |= std::ptr::eq(element, vertex);
        faces_read |= std::ptr::eq(element, face);
        if vertices_read && faces_read {
            break;
        }
    }
    frame.complete(0)
}

/// Columns of x, y and z.
fn axes(vertex: &Element) -> Result<[usize; 3], Reason> {
    let mut axes = [0; 3];
    for (axis, name) in axes.iter_mut().zip(["x", "y", "z"]) {
        let property = vertex
            .properties
            .iter()
            .position(|property| property.name == name.as_bytes());
        *axis = property.ok_or_else(|| match name {
            "z" => two_coordinates(),
            _ => Reason::Malformed(format!("element vertex has no property {name}")),
        })?;
        if let Kind::List { .. } = vertex.properties[*axis].kind {
            return Err(Reason::Malformed(format!(
                "property {name} of element vertex is a list, not a number"
            )));
        }
    }
    Ok(axes)
}

fn precision(vertex: &Element, axes: [usize; 3]) -> Precision {
    let exact_in_f32 = axes.iter().all(|&axis| match vertex.properties[axis].kind {
        Kind::One(scalar) => !matches!(scalar, Scalar::F64 | Scalar::I32 | Scalar::U32),
        Kind::List { .. } => false,
    });
    if exact_in_f32 {
        Precision::F32
    } else {
        Precision::F64
    }
}

/// Column of the list of corners.
fn corners_of(face: &Element) -> Result<usize, Reason> {
    let listed = |name: &[u8]| {
        face.properties
            .iter()
            .position(|property| property.name == name)
    };
    let property = listed(b"vertex_indices").or_else(|| listed(b"vertex_index"));
    let element = String::from_utf8_lossy(&face.name);
    let property = property.ok_or_else(|| {
        Reason::Malformed(format!(
            "element {element} has no list vertex_indices or vertex_index"
        ))
    })?;
    match face.properties[property].kind {
        Kind::List { item, .. } if item.is_integer() => Ok(property),
        _ => Err(Reason::Malformed(format!(
            "property {} of element {element} is not a list of integers",
            String::from_utf8_lossy(&face.properties[property].name)
        ))),
    }
}

fn read_vertex(
    vertex: &Element,
    axes: [usize; 3],
    values: &mut impl Values,
) -> Result<[f64; 3], Fault> {
    let mut position = [0.0; 3];
    for (at, property) in vertex.properties.iter().enumerate() {
        match (axes.iter().position(|&axis| axis == at), property.kind) {
            (Some(axis), Kind::One(scalar)) => position[axis] = values.real(scalar)?,
            (_, kind) => skip(kind, values)?,
        }
    }
    Ok(position)
}

fn read_face(
    face: &Element,
    corners: usize,
    row: u64,
    polygon: &mut Vec<u32>,
    values: &mut impl Values,
) -> Result<(), Fault> {
    for (at, property) in face.properties.iter().enumerate() {
        match property.kind {
            Kind::List { count, item } if at == corners => {
                for _ in 0..list_length(count, values)? {
                    let index = values.integer(item)?;
                    let (face, first, last) = (row, 0, i64::from(u32::MAX) - 1);
                    let corner = u32::try_from(index)
                        .ok()
                        .filter(|&corner| corner < u32::MAX);
                    corner
                        .ok_or(Reason::VertexIndex {
                            face,
                            index,
                            first,
                            last,
                        })
                        .and_then(|corner| add(polygon, corner))
                        .map_err(|reason| reason.at(values.place()))?;
                }
            }
            kind => skip(kind, values)?,
        }
    }
    Ok(())
}

fn read_strips(
    strips: &Element,
    corners: usize,
    values: &mut impl Values,
    frame: &mut Frame,
) -> Result<(), Fault> {
    for (at, property) in strips.properties.iter().enumerate() {
        let Kind::List { count, item } = property.kind else {
            skip(property.kind, values)?;
            continue;
        };
        if at != corners {
            skip(property.kind, values)?;
            continue;
        }
        let (mut before, mut met) = ([0; 2], 0_u64);
        for _ in 0..list_length(count, values)? {
            let index = values.integer(item)?;
            if index == -1 {
                met = 0;
                continue;
            }
            let (first, last) = (0, i64::from(u32::MAX) - 1);
            let face = frame.next_face();
            let corner = u32::try_from(index).ok().filter(|&it| it < u32::MAX);
            let corner = corner.ok_or(Reason::VertexIndex {
                face,
                index,
                first,
                last,
            });
            let corner = corner.map_err(|reason| reason.at(values.place()))?;
            let [a, b] = before;
            if met >= 2 && a != b && b != corner && corner != a {
                let turned = if met % 2 == 0 {
                    [a, b, corner]
                } else {
                    [b, a, corner]
                };
                let taken = frame.face(&turned, || values.place());
                taken.map_err(|reason| reason.at(values.place()))?;
            }
            before = [b, corner];
            met += 1;
        }
    }
    Ok(())
}

fn add(polygon: &mut Vec<u32>, corner: u32) -> Result<(), Reason> {
    if polygon.len() == MOST_CORNERS {
        return Err(Reason::ManyCorners { most: MOST_CORNERS });
    }
    polygon.push(corner);
    Ok(())
}

fn skip(kind: Kind, values: &mut impl Values) -> Result<(), Fault> {
    match kind {
        Kind::One(scalar) => values.skip(scalar, 1),
        Kind::List { count, item } => {
            let length = list_length(count, values)?;
            values.skip(item, length)
        }
    }
}

fn list_length(count: Scalar, values: &mut impl Values) -> Result<u64, Fault> {
    let length = values.integer(count)?;
    u64::try_from(length).map_err(|_| {
        Reason::Malformed(format!("a list has the length {length}")).at(values.place())
    })
}

#[cfg(test)]
mod tests;
