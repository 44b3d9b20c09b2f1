//! Wavefront OBJ reader: `v x y z` and `f a b c ...`; everything else is passed over.
//!
//! Object and group names (`o`, `g`) are read separately, on request. The crate has its own reader
//! because errors must name the line, and because only the `v` indices give the connectivity.
//!
//! - `v` has at least three numbers; weights and colours behind them are no positions. Each is the
//!   f64 nearest to the text.
//! - `f` (formerly `fo`) has vertex numbers from 1, or backwards from -1. Texture and normal
//!   numbers behind a `/` are passed over.
//! - A `\` at the end of a line continues it, except in a comment. A comment that ends in a Windows
//!   folder would otherwise swallow a vertex and shift all later numbers. The second line of a
//!   comment that is really continued is passed over as an unknown statement.

use std::io::BufRead;

use crate::error::{Fault, Place, Reason};
use crate::frame::{Announced, Complete, Frame};
use crate::groups::Naming;
use crate::positions::Precision;
use crate::text::{LONGEST_LINE, Lines, expected, number, quoted, two_coordinates, words};

/// Reads one file, which is one frame.
pub(crate) fn read(input: impl BufRead, frame: &mut Frame) -> Result<Complete, Fault> {
    frame.begin(Precision::F64, Announced::default())?;
    let mut statements = Statements {
        lines: Lines::new(input),
        text: Vec::new(),
    };
    let mut corners = Vec::new();
    while let Some(place) = statements.advance()? {
        let at = |reason: Reason| reason.at(place.clone());
        let mut words = words(&statements.text).take_while(|word| word[0] != b'#');
        match words.next() {
            Some(b"v") => frame.vertex(position(words).map_err(at)?).map_err(at)?,
            Some(b"f" | b"fo") => {
                corners.clear();
                for word in words {
                    corners.push(corner(word, frame).map_err(at)?);
                }
                frame.face(&corners, || place.clone()).map_err(at)?;
            }
            _ => {}
        }
    }
    frame.complete(1)
}

/// Reads the group names of faces, from a file that was read before.
pub(crate) fn name_faces(input: impl BufRead, naming: &mut Naming) -> Result<(), Fault> {
    let mut statements = Statements {
        lines: Lines::new(input),
        text: Vec::new(),
    };
    while let Some(place) = statements.advance()? {
        let mut words = words(&statements.text);
        match words.next() {
            Some(b"o") => naming.object(name(words)),
            Some(b"g") => naming.group(name(words)),
            Some(b"f" | b"fo") => naming.face().map_err(|reason| reason.at(place))?,
            _ => {}
        }
    }
    Ok(())
}

/// Joins all `words` with blanks, including those behind a `#`: `o Cube #2` is not `o Cube #3`.
///
/// A name that is not UTF-8 is read as Latin-1.
pub(crate) fn name<'a>(words: impl Iterator<Item = &'a [u8]>) -> String {
    let mut name = Vec::new();
    for word in words {
        if !name.is_empty() {
            name.push(b' ');
        }
        name.extend_from_slice(word);
    }
    String::from_utf8(name).unwrap_or_else(|no_text| {
        let bytes = no_text.as_bytes().iter();
        bytes.map(|&latin| char::from(latin)).collect()
    })
}

/// Parses the first three of `words`.
fn position<'a>(mut words: impl Iterator<Item = &'a [u8]>) -> Result<[f64; 3], Reason> {
    let mut position = [0.0; 3];
    for (axis, value) in position.iter_mut().enumerate() {
        let word = words.next();
        if word.is_none() && axis == 2 {
            return Err(two_coordinates());
        }
        *value = word
            .and_then(number)
            .ok_or_else(|| expected("a coordinate", word))?;
    }
    Ok(position)
}

/// The vertex, counted from 0, that `7`, `7/1`, `7//3`, `7/1/3` or, backwards, `-1` means.
fn corner(word: &[u8], frame: &Frame) -> Result<u32, Reason> {
    let written = word.split(|&c| c == b'/').next().unwrap_or(word);
    let index: i64 = number(written).ok_or_else(|| expected("a vertex number", Some(word)))?;
    let so_far = i64::try_from(frame.vertex_count()).unwrap_or(i64::MAX);
    let zero_based = match index {
        0 => {
            return Err(Reason::Malformed(format!(
                "found vertex number {}, but numbers begin at 1",
                quoted(word)
            )));
        }
        1.. => index - 1,
        _ => so_far.saturating_add(index),
    };
    let face = frame.next_face();
    let (first, last) = if index > 0 {
        (1, i64::from(u32::MAX))
    } else {
        (-so_far, -1)
    };
    u32::try_from(zero_based)
        .ok()
        .filter(|&vertex| vertex < u32::MAX)
        .ok_or(Reason::VertexIndex {
            face,
            index,
            first,
            last,
        })
}

/// Reader of statements: lines, with continued ones joined.
struct Statements<R> {
    lines: Lines<R>,
    text: Vec<u8>,
}

impl<R: BufRead> Statements<R> {
    /// Moves to the next statement and returns where it begins; None at the end of the text.
    fn advance(&mut self) -> Result<Option<Place>, Fault> {
        self.text.clear();
        if !self.lines.advance()? {
            return Ok(None);
        }
        let place = self.lines.place();
        let mut line = self.lines.line();
        if place == Place::Line(1) {
            // The byte order mark that some editors put before UTF-8.
            line = line.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(line);
            if line.starts_with(b"\xFF\xFE") || line.starts_with(b"\xFE\xFF") {
                let reason = "is text in UTF-16; save it as UTF-8";
                return Err(Reason::Unsupported(reason.into()).at(place));
            }
        }
        self.text.extend_from_slice(line);
        let comment = words(line).next().is_some_and(|word| word[0] == b'#');
        while !comment && self.text.last() == Some(&b'\\') {
            self.text.pop();
            self.text.push(b' ');
            if !self.lines.advance()? {
                break;
            }
            if (self.text.len() + self.lines.line().len()) as u64 > LONGEST_LINE {
                let reason = "the statement has more than 16 MiB, the most that is read";
                return Err(Reason::Malformed(reason.into()).at(place));
            }
            self.text.extend_from_slice(self.lines.line());
        }
        Ok(Some(place))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::positions::Positions;

    fn read_text(text: impl AsRef<[u8]>) -> Result<Frame, Fault> {
        let mut frame = Frame::new(1 << 30, true);
        let _complete = read(text.as_ref(), &mut frame)?;
        Ok(frame)
    }

    fn message(text: &str) -> String {
        let fault = read_text(text).unwrap_err();
        format!("{}: {}", fault.place, fault.reason)
    }

    const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

    #[test]
    fn text_in_utf_16_is_refused_for_what_it_is() {
        for (mark, order) in [
            ([0xFF, 0xFE], u16::to_le_bytes as fn(u16) -> [u8; 2]),
            ([0xFE, 0xFF], u16::to_be_bytes),
        ] {
            let text = CORNERS.encode_utf16().map(order);
            let bytes = [&mark[..], text.collect::<Vec<_>>().as_flattened()].concat();
            let fault = read_text(bytes).unwrap_err();
            assert!(
                fault.reason.to_string().contains("UTF-16"),
                "{}",
                fault.reason
            );
        }
    }

    #[test]
    fn everything_but_vertices_and_faces_is_passed_over() {
        let text = "\u{feff}# from \\\nmtllib a.mtl\r\n  v 0.1 -2e-3 +3. 1 0.5 0.5\n\
            vt 0 0\nvn 0 0 1\nvp 1\nv .5 1E-400 0 # oh\nv\t1\t1\t1\n\
            o thing\ng\ns off\nusemtl #1\nl 1 2\n\
            f 1/1/1 2//7 3/2 # 9\n\nfo -3 -2 -1\nstrange words\n";
        let frame = read_text(text).unwrap();
        assert_eq!(
            frame.positions(),
            Positions::F64(&[[0.1, -2e-3, 3.0], [0.5, 0.0, 0.0], [1.0; 3]])
        );
        assert_eq!(frame.polygons().triangles(), [[0, 1, 2], [0, 1, 2]]);
    }

    #[test]
    fn coordinates_are_the_nearest_f64() {
        let written = [
            "0.1",
            "3.4028234663852886e38",
            "9007199254740993",
            "4.9e-324",
            "0.30000000000000004441",
        ];
        for word in written {
            let frame = read_text(format!("v {word} 0 0\nv 0 0 0\nf 1 2 1")).unwrap();
            assert_eq!(
                frame.positions().get(0)[0].to_bits(),
                word.parse::<f64>().unwrap().to_bits()
            );
        }
    }

    #[test]
    fn a_backslash_continues_a_line_but_not_a_comment() {
        let frame =
            read_text("# in C:\\\nv 0 0 0\nv 1 \\\n  0 0\nv 0 1 \\\r\n0\nf 1 2 3\\\n 1\nf 1 2 3\\")
                .unwrap();
        assert_eq!(frame.positions().len(), 3);
        assert_eq!(
            frame.polygons().triangles(),
            [[0, 1, 2], [0, 2, 0], [0, 1, 2]]
        );
    }

    #[test]
    fn relative_numbers_count_from_where_they_stand() {
        let frame =
            read_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -3 -2 -1").unwrap();
        assert_eq!(frame.polygons().triangles(), [[0, 1, 2], [1, 2, 3]]);
    }

    #[test]
    fn faces_may_come_before_their_vertices() {
        assert_eq!(
            read_text(format!("f 1 2 3 4\n{CORNERS}"))
                .unwrap()
                .polygons()
                .triangles()
                .len(),
            2
        );
    }

    #[test]
    fn errors_name_the_line() {
        let with = |line: &str| message(&format!("{CORNERS}{line}\nf 1 2 3\n"));
        assert_eq!(
            with("f 2/1"),
            ", line 5: face 0 has 1 corners; a face needs at least 3"
        );
        assert_eq!(
            with("f"),
            ", line 5: face 0 has 0 corners; a face needs at least 3"
        );
        assert_eq!(
            with("f 1 2 5"),
            ", line 5: face 0 uses vertex 5, but the vertices are numbered 1 to 4 here"
        );
        assert_eq!(
            with("f 1 -5 3"),
            ", line 5: face 0 uses vertex -5, but the vertices are numbered -4 to -1 here"
        );
        assert_eq!(
            with("f 1 0 3"),
            ", line 5: found vertex number \"0\", but numbers begin at 1"
        );
        assert_eq!(
            with("f 1 two 3"),
            ", line 5: expected a vertex number, found \"two\""
        );
        assert_eq!(
            with("f 1 /2 3"),
            ", line 5: expected a vertex number, found \"/2\""
        );
        assert_eq!(
            with("f 1 2 1.5"),
            ", line 5: expected a vertex number, found \"1.5\""
        );
        assert_eq!(
            with("\\\nf 1 \\\n2 4294967296"),
            ", line 5: face 0 uses vertex 4294967296, \
             but vertices are numbered from 1 to 4294967295 at most"
        );
        assert_eq!(
            with("v 1"),
            ", line 5: expected a coordinate, found the end of the line"
        );
        for two in ["v 1 2", "v 1 2 # 3"] {
            assert_eq!(
                with(two),
                ", line 5: a vertex has two coordinates; pliant needs three"
            );
        }
        assert_eq!(
            with("v 1 2,5 3"),
            ", line 5: expected a coordinate, found \"2,5\""
        );
        let range = "coordinates must be finite and at most 3.4028235e38 in magnitude";
        assert_eq!(
            with("v 1 nan 3"),
            format!(", line 5: y of vertex 4 is NaN; {range}")
        );
        assert_eq!(
            with("v 1 2 -inf"),
            format!(", line 5: z of vertex 4 is -inf; {range}")
        );
        assert_eq!(
            message("\nf -1 -2 -3"),
            ", line 2: face 0 uses vertex -1, but there are no vertices yet"
        );
    }

    #[test]
    fn a_surface_needs_vertices_and_faces() {
        assert_eq!(message(""), ": holds no vertices");
        assert_eq!(message("f 1 2 3"), ": holds no vertices");
        assert_eq!(
            message(CORNERS),
            ": holds no faces, so there is no surface to check"
        );
    }

    #[test]
    fn i64_extremes_do_not_overflow() {
        for index in [i64::MAX, i64::MIN, i64::MIN + 1] {
            assert!(read_text(format!("{CORNERS}f 1 2 {index}")).is_err());
        }
        assert!(read_text(format!("{CORNERS}f 1 2 99999999999999999999")).is_err());
    }
}
