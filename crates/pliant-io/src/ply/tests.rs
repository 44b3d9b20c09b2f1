//! Tests of the PLY reader: every encoding and type; errors name a line, or in binary an element.

use super::*;
use crate::error::Place;
use crate::positions::Positions;

fn read_bytes(bytes: impl AsRef<[u8]>) -> Result<Frame, Fault> {
    let mut frame = Frame::new(1 << 30, true);
    let _complete = read(bytes.as_ref(), &mut frame)?;
    Ok(frame)
}

fn message(bytes: impl AsRef<[u8]>) -> String {
    let fault = read_bytes(bytes).unwrap_err();
    format!("{}: {}", fault.place, fault.reason)
}

/// A header of three vertices and one face, with `real` coordinates.
fn header(encoding: &str, real: &str) -> String {
    format!(
        "ply\nformat {encoding} 1.0\ncomment made by hand\n\
         element vertex 3\nproperty {real} x\nproperty {real} y\nproperty {real} z\n\
         element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    )
}

const TRIANGLE: &str = "0 0 0\n1 .5 1.\n0.1 -1e-3 0\n3 0 1 2\n";

#[test]
fn ascii_keeps_the_declared_precision() {
    let frame = read_bytes(header("ascii", "float") + TRIANGLE).unwrap();
    let expected = [[0.0; 3], [1.0, 0.5, 1.0], [0.1_f32, -1e-3, 0.0]];
    assert_eq!(frame.positions(), Positions::F32(&expected));
    let frame = read_bytes(header("ascii", "double") + TRIANGLE).unwrap();
    let expected = [[0.0; 3], [1.0, 0.5, 1.0], [0.1_f64, -1e-3, 0.0]];
    assert_eq!(frame.positions(), Positions::F64(&expected));
    assert_eq!(frame.polygons().triangles(), [[0, 1, 2]]);
}

#[test]
fn binary_of_either_endian_returns_every_bit() {
    let coordinates = [
        [0.1, -0.0, f64::from(f32::MAX)],
        [1.0 / 3.0, 5e-324, -7.0],
        [1e-300, 2.0, 3.0],
    ];
    for (encoding, big) in [("binary_little_endian", false), ("binary_big_endian", true)] {
        let bytes = |little: &[u8]| {
            let mut bytes = little.to_vec();
            if big {
                bytes.reverse();
            }
            bytes
        };
        let mut double = header(encoding, "double").into_bytes();
        let mut float = header(encoding, "float32").into_bytes();
        for value in coordinates.as_flattened() {
            double.extend(bytes(&value.to_le_bytes()));
            float.extend(bytes(&(*value as f32).to_le_bytes()));
        }
        for file in [&mut double, &mut float] {
            file.push(3);
            for index in [0_i32, 1, 2] {
                file.extend(bytes(&index.to_le_bytes()));
            }
        }
        let frame = read_bytes(double).unwrap();
        assert_eq!(frame.positions(), Positions::F64(&coordinates));
        assert!(frame.positions().get(0)[1].is_sign_negative());
        let narrow = coordinates.map(|position| position.map(|value| value as f32));
        assert_eq!(
            read_bytes(float).unwrap().positions(),
            Positions::F32(&narrow)
        );
    }
}

#[test]
fn what_is_not_asked_for_is_skipped() {
    let declarations = "obj_info anything at all, even property\n\
        element camera 2\nproperty float view\nproperty list uchar double lens\n\
        element nothing 18446744073709551615\n\
        element face 2\nproperty list ushort uchar colours\n\
        property list uint8 uint16 vertex_index\nproperty char flag\n\
        element vertex 3\nproperty list int short tags\nproperty uchar x\nproperty short z\n\
        property float y\nproperty int q\nelement tail 7\nproperty int t\nend_header\n";
    let ascii = format!(
        "ply\r\nformat ascii 1.0\r\n{declarations}\n\
         1 0\n2 2 0.5 1e9\n0 3 2 1 0 -1\n2 7 8 4 0 1 2 0 5\n\
         0 1 -2 3.5 9\n2 1 1 4 5 6 9\n1 3 7 8 9 9\nand then whatever comes"
    );
    let mut little = format!("ply\nformat binary_little_endian 1.0\n{declarations}").into_bytes();
    let mut big = format!("ply\nformat binary_big_endian 1.0\n{declarations}").into_bytes();
    let mut put = |bytes: &[u8]| {
        little.extend(bytes);
        big.extend(bytes.iter().rev());
    };
    // Cameras, then two faces, then three vertices, as in the text above.
    put(&1_f32.to_le_bytes());
    put(&[0]);
    put(&2_f32.to_le_bytes());
    put(&[2]);
    put(&0.5_f64.to_le_bytes());
    put(&1e9_f64.to_le_bytes());
    for (colours, corners, flag) in [
        (&[][..], &[2_u16, 1, 0][..], 255),
        (&[7, 8], &[0, 1, 2, 0], 5),
    ] {
        put(&(colours.len() as u16).to_le_bytes());
        for colour in colours {
            put(&[*colour]);
        }
        put(&[corners.len() as u8]);
        for corner in corners {
            put(&corner.to_le_bytes());
        }
        put(&[flag]);
    }
    for (tags, x, z, y) in [
        (&[][..], 1, -2_i16, 3.5_f32),
        (&[1_i16, 1], 4, 5, 6.0),
        (&[3], 7, 8, 9.0),
    ] {
        put(&(tags.len() as u32).to_le_bytes());
        for tag in tags {
            put(&tag.to_le_bytes());
        }
        put(&[x]);
        put(&z.to_le_bytes());
        put(&y.to_le_bytes());
        put(&9_i32.to_le_bytes());
    }
    for file in [ascii.into_bytes(), little, big] {
        let frame = read_bytes(file).unwrap();
        let expected = [[1.0, 3.5, -2.0], [4.0, 6.0, 5.0], [7.0, 9.0, 8.0]];
        assert_eq!(frame.positions(), Positions::F32(&expected));
        assert_eq!(
            frame.polygons().triangles(),
            [[2, 1, 0], [0, 1, 2], [0, 2, 0]]
        );
        assert_eq!(frame.polygons().faces(), Some(&[0, 1, 1][..]));
    }
}

#[test]
fn whole_numbers_beyond_f32_are_read_as_f64() {
    let frame =
        read_bytes(header("ascii", "int") + "16777217 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").unwrap();
    let expected = [[16_777_217.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    assert_eq!(frame.positions(), Positions::F64(&expected));
}

#[test]
fn ascii_errors_name_the_line() {
    let with =
        |from: &str, to: &str| message(header("ascii", "float") + &TRIANGLE.replacen(from, to, 1));
    assert_eq!(
        with("1 .5 1.", "1 .5"),
        ", line 12: expected a number, found the end of the line"
    );
    assert_eq!(
        with("1 .5 1.", "1 .5 1. 1"),
        ", line 12: more values than the header declares, from \"1\" on"
    );
    assert_eq!(
        with("1 .5 1.", "1 x 1"),
        ", line 12: expected a number, found \"x\""
    );
    let range = "coordinates must be finite and at most 3.4028235e38 in magnitude";
    assert_eq!(
        with("1 .5 1.", "1 1e39 1"),
        format!(", line 12: y of vertex 1 is inf; {range}")
    );
    assert_eq!(
        with("1 .5 1.", "1 nan 1"),
        format!(", line 12: y of vertex 1 is NaN; {range}")
    );
    assert_eq!(
        with("3 0 1 2", "3 0 1"),
        ", line 14: expected a whole number, found the end of the line"
    );
    assert_eq!(
        with("3 0 1 2", "1 0"),
        ", line 14: face 0 has 1 corners; a face needs at least 3"
    );
    assert_eq!(with("3 0 1 2", "-1"), ", line 14: a list has the length -1");
    assert_eq!(
        with("3 0 1 2", "3 0 1 3"),
        ", line 14: face 0 uses vertex 3, but the vertices are numbered 0 to 2 here"
    );
    assert_eq!(
        with("3 0 1 2", "3 0 1 -1"),
        ", line 14: face 0 uses vertex -1, but vertices are numbered from 0 to 4294967294 at most"
    );
    assert_eq!(
        with("3 0 1 2\n", "\n"),
        ", line 15: ends too early: element face has 0 rows; the header announces 1"
    );
}

#[test]
fn binary_errors_name_the_element() {
    let mut file = header("binary_little_endian", "float").into_bytes();
    for value in [0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
        file.extend(value.to_le_bytes());
    }
    file.push(3);
    for index in [0_i32, 1, 2] {
        file.extend(index.to_le_bytes());
    }
    read_bytes(&file).unwrap();
    let end = file.len();
    let announced = "ends too early: the header announces";
    assert_eq!(
        message(&file[..end - 1]),
        format!(", face 0: {announced} 1 of this element")
    );
    assert_eq!(
        message(&file[..end - 14]),
        format!(", vertex 2: {announced} 3 of this element")
    );
    assert_eq!(
        message(&file[..end - 13 - 36]),
        format!(", vertex 0: {announced} 3 of this element")
    );
    let mut infinite = file.clone();
    infinite[end - 13 - 8..end - 13 - 4].copy_from_slice(&f32::INFINITY.to_le_bytes());
    assert!(message(&infinite).starts_with(", vertex 2: y of vertex 2 is inf;"));
    file[end - 1] = 0x80;
    assert!(message(&file).starts_with(", face 0: face 0 uses vertex -2147483646,"));
}

#[test]
fn claims_without_data_end_at_once() {
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let claims = header(encoding, "float").replace("vertex 3", "vertex 1000000");
        assert!(matches!(
            read_bytes(claims).unwrap_err().reason,
            Reason::Truncated(_)
        ));
        let refused = header(encoding, "float").replace("vertex 3", "vertex 18446744073709551615");
        assert!(matches!(
            read_bytes(refused).unwrap_err().reason,
            Reason::TooLarge { .. }
        ));
    }
    let long_list = header("binary_little_endian", "float")
        .replace(
            "element face",
            "element huge 1\nproperty list uint double l\nelement face",
        )
        .into_bytes();
    let long_list = [&long_list[..], &[0; 36], &[0xff; 100]].concat();
    assert!(message(long_list).starts_with(", huge 0: ends too early"));
}

#[test]
fn headers_are_held_to_the_format() {
    let valid = header("ascii", "float") + TRIANGLE;
    for (from, to, place) in [
        ("ply\n", "plx\n", Place::Line(1)),
        ("format", "former", Place::Line(2)),
        ("ascii", "binary", Place::Line(2)),
        ("ascii 1.0", "ascii 1.1", Place::Line(2)),
        ("comment made by hand", "format ascii 1.0", Place::Line(3)),
        ("comment made by hand", "property int x", Place::Line(3)),
        ("format ascii 1.0\n", "", Place::Line(9)),
        ("vertex 3", "vertex -3", Place::Line(4)),
        ("vertex 3", "vertex 3.0", Place::Line(4)),
        ("vertex 3", "vertex 18446744073709551616", Place::Line(4)),
        ("element face", "element vertex", Place::Line(8)),
        ("float x", "real x", Place::Line(5)),
        ("float x", "float x x", Place::Line(5)),
        ("list uchar int", "list float int", Place::Line(9)),
        ("list uchar int", "list uchar", Place::Line(9)),
        ("float x", "float u", Place::File),
        ("float x", "list uchar float x", Place::File),
        ("list uchar int", "int", Place::File),
        ("list uchar int", "list uchar float", Place::File),
        ("vertex_indices", "vertices", Place::File),
        ("element vertex", "element vertices", Place::File),
        ("element face", "element faces", Place::File),
    ] {
        assert!(valid.contains(from), "{from}");
        let fault = read_bytes(valid.replacen(from, to, 1)).unwrap_err();
        assert_eq!(fault.place, place, "{from} as {to}: {}", fault.reason);
    }
    let (before, _) = valid.split_once("end_header").unwrap();
    assert!(message(before).contains("no line `end_header`"));
    assert_eq!(message(""), ": is empty");
    let endless = format!("ply\n{}", "comment\n".repeat(20_000));
    assert!(message(endless).contains("more than 10000 lines"));
}

#[test]
fn strips_are_triangles() {
    let header = "ply\nformat ascii 1.0\n\
        element vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
        element tristrips 2\nproperty list int int vertex_indices\nend_header\n\
        0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n";
    let frame = read_bytes(format!("{header}10 0 1 2 3 4 -1 4 3 2 0\n5 0 1 1 2 3\n")).unwrap();
    assert_eq!(
        frame.polygons().triangles(),
        [
            [0, 1, 2],
            [2, 1, 3],
            [2, 3, 4],
            [4, 3, 2],
            [2, 3, 0],
            [1, 2, 3]
        ]
    );
    for bad in ["3 0 1 5\n1 0\n", "3 0 1 -2\n1 0\n"] {
        let fault = read_bytes(format!("{header}{bad}")).unwrap_err();
        assert!(matches!(fault.reason, Reason::VertexIndex { .. }));
    }
    // Polygons take precedence over strips.
    let both = header.replace(
        "element tristrips",
        "element face 1\nproperty list uchar int vertex_indices\nelement tristrips",
    );
    let frame = read_bytes(format!("{both}3 0 1 2\n3 0 1 3\n3 0 1 4\n")).unwrap();
    assert_eq!(frame.polygons().triangles(), [[0, 1, 2]]);
}
