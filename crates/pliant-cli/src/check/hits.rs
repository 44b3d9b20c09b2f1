//! `--hits`: the triangles that intersect, in [XML files of VTK][vtk] for ParaView, and the curves
//! in which they meet.
//!
//! A file, `.vtp` (polygons) or `.vtu` (unstructured cells), holds the intersecting triangles of
//! one frame. Cells have the numbers of their `body` and `triangle` and the count of their
//! `partners`; points have the number of their `vertex`. Curves are cells with their number and
//! `length`: polylines before the triangles, or in a `.vtu` lines behind them. A number that is
//! none is 4,294,967,295. Of several frames each has a file, even without hits, since ParaView
//! would keep showing the last; a `.pvd` file beside them lists all.
//!
//! [vtk]: https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html

use super::pictures::of_sources;
use crate::output::{self, MARK, Overwrite};
use anyhow::bail;
use base64::prelude::{BASE64_STANDARD, Engine};
use pliant::{Curves, Pair};
use pliant_check::{Check, Found, with_world};
use pliant_io::{Precision, shown};
use std::io::{self, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Output files of one check.
pub(super) struct Hits {
    path: PathBuf,
    kind: Kind,
    over: Overwrite,
    /// Number of digits of frame numbers in file names; `None` where there is one file.
    digits: Option<usize>,
    /// Frame numbers and file names, where there are several files.
    written: Vec<(usize, String)>,
}

#[derive(Clone, Copy)]
enum Kind {
    PolyData,
    UnstructuredGrid,
}

impl Kind {
    fn name(self) -> &'static str {
        match self {
            Self::PolyData => "PolyData",
            Self::UnstructuredGrid => "UnstructuredGrid",
        }
    }
}

/// Intersecting triangles and curves of one frame, as they are written.
#[derive(Default)]
struct Mesh {
    /// Source and vertex of each point of triangles, sorted.
    points: Vec<(usize, u32)>,
    /// Points of curves, behind them.
    of_curves: Vec<[f64; 3]>,
    triangles: Vec<Cell>,
    /// Curves, or the sides of curves.
    lines: Vec<Cell>,
    /// Indices of the points of all cells.
    corners: Vec<i64>,
}

/// Cell of a file.
struct Cell {
    body: u32,
    triangle: u32,
    partners: u32,
    curve: u32,
    length: f64,
    /// Its part of the corners.
    corners: Range<usize>,
}

/// Number of a body, a triangle, a vertex or a curve where there is none.
const NONE: u32 = u32::MAX;

/// Types of cells.
const TRIANGLE: u8 = 5;
const LINE: u8 = 3;

impl Hits {
    /// Checks that files can be written for these frames.
    pub(super) fn new(
        path: &Path,
        frames: impl Iterator<Item = usize> + Clone,
        over: Overwrite,
    ) -> anyhow::Result<Self> {
        let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
        let kind = match ending.to_str() {
            Some("vtp") => Kind::PolyData,
            Some("vtu") => Kind::UnstructuredGrid,
            _ => bail!("--hits {}: the name must end in .vtp or .vtu", shown(path)),
        };
        let last = frames.clone().skip(1).last();
        let hits = Self {
            path: path.to_owned(),
            kind,
            over,
            digits: last.map(|last| last.to_string().len()),
            written: Vec::new(),
        };
        if hits.digits.is_some() {
            let name = path.file_name().unwrap_or_default();
            if !name.to_string_lossy().chars().all(is_xml) {
                bail!(
                    "--hits {}: with several frames a .pvd file, which is XML, lists the others, \
                     and cannot hold this name; give another",
                    shown(path)
                );
            }
            output::prepare(&hits.collection(), MARK, over)?;
        }
        for frame in frames {
            output::prepare(&hits.of_frame(frame), MARK, over)?;
        }
        Ok(hits)
    }

    /// Path of a frame's file.
    fn of_frame(&self, frame: usize) -> PathBuf {
        let Some(digits) = self.digits else {
            return self.path.clone();
        };
        let [stem, ending] = [self.path.file_stem(), self.path.extension()]
            .map(|part| part.unwrap_or_default().display());
        let name = format!("{stem}_{frame:0digits$}.{ending}");
        self.path.with_file_name(name)
    }

    /// Path of the `.pvd` file, which lists all others.
    fn collection(&self) -> PathBuf {
        self.path.with_extension("pvd")
    }

    /// Writes the file of the frame that was checked last.
    pub(super) fn frame(&mut self, check: &Check, found: &Found) -> anyhow::Result<()> {
        let path = self.of_frame(found.frame);
        if self.digits.is_some() {
            let name = path.file_name().unwrap_or_default();
            let name = name.to_string_lossy().into_owned();
            self.written.push((found.frame, name));
        }
        let mesh = Mesh::of(check, found, self.kind);
        output::write(&path, MARK, self.over, |out| {
            mesh.write(out, check, self.kind, found.frame)
        })
    }

    /// Writes the `.pvd` file, if there are several files.
    pub(super) fn end(self) -> anyhow::Result<()> {
        if self.written.is_empty() {
            return Ok(());
        }
        output::write(&self.collection(), MARK, self.over, |out| {
            begin(out, "Collection")?;
            for (frame, name) in &self.written {
                let name = attribute(name);
                writeln!(out, r#"<DataSet timestep="{frame}" file="{name}"/>"#)?;
            }
            end(out, "Collection")
        })
    }
}

impl Mesh {
    fn of(check: &Check, found: &Found, kind: Kind) -> Self {
        let mut mesh = Self::default();
        let pairs = found.all_pairs();
        let ends = pairs
            .iter()
            .flat_map(|&[body_a, a, body_b, b]| [[body_a, a], [body_b, b]]);
        let mut ends: Vec<[u32; 2]> = ends.collect();
        ends.sort_unstable();
        let corners_of = |&[body, triangle]: &[u32; 2]| {
            let source = check.source_of(body).unwrap_or_default();
            let corners = check.sources()[source].triangles()[triangle as usize];
            corners.map(|vertex| (source, vertex))
        };
        let hits: Vec<&[[u32; 2]]> = ends.chunk_by(|one, other| one == other).collect();
        mesh.points = hits.iter().flat_map(|same| corners_of(&same[0])).collect();
        mesh.points.sort_unstable();
        mesh.points.dedup();
        for same in hits {
            let [body, triangle] = same[0];
            let start = mesh.corners.len();
            let place = |corner| mesh.points.partition_point(|&point| point < corner) as i64;
            mesh.corners.extend(corners_of(&same[0]).map(place));
            mesh.triangles.push(Cell {
                body,
                triangle,
                partners: same.len() as u32,
                curve: NONE,
                length: 0.0,
                corners: start..mesh.corners.len(),
            });
        }
        let pairs: Vec<Pair> = pairs
            .iter()
            .map(|&row| of_sources(check, row).into())
            .collect();
        let mut curves = Curves::new();
        // All pairs are of this world, so nothing can be refused.
        if with_world!(check.world(), world => curves.update(world, &pairs)).is_ok() {
            mesh.take(&curves, kind);
        }
        mesh
    }

    /// Takes curves, as polylines or as their sides. A closed one ends where it begins.
    fn take(&mut self, curves: &Curves, kind: Kind) {
        for (number, curve) in (0..).zip(curves.iter()) {
            let first = (self.points.len() + self.of_curves.len()) as i64;
            self.of_curves.extend(curve.points());
            let end = (self.points.len() + self.of_curves.len()) as i64;
            let start = self.corners.len();
            self.corners.extend(first..end);
            self.corners.extend(curve.is_closed().then_some(first));
            let along = start..self.corners.len();
            let line = |corners| Cell {
                body: NONE,
                triangle: NONE,
                partners: 0,
                curve: number,
                length: curve.length(),
                corners,
            };
            match kind {
                Kind::PolyData => self.lines.push(line(along)),
                // Sides of a curve have its points in common.
                Kind::UnstructuredGrid => {
                    self.lines
                        .extend((along.start + 1..along.end).map(|i| line(i - 1..i + 1)));
                }
            }
        }
    }

    fn write(
        &self,
        out: &mut dyn Write,
        check: &Check,
        kind: Kind,
        frame: usize,
    ) -> io::Result<()> {
        let (triangles, lines) = (self.triangles.len(), self.lines.len());
        let points = self.points.len() + self.of_curves.len();
        begin(out, kind.name())?;
        write!(
            out,
            r#"<FieldData><DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" "#
        )?;
        writeln!(out, r#"format="ascii">{frame}</DataArray></FieldData>"#)?;
        let (count, cells) = match kind {
            Kind::PolyData => (
                format!(r#"NumberOfLines="{lines}" NumberOfPolys="{triangles}""#),
                [&self.lines, &self.triangles],
            ),
            Kind::UnstructuredGrid => (
                format!(r#"NumberOfCells="{}""#, triangles + lines),
                [&self.triangles, &self.lines],
            ),
        };
        writeln!(out, r#"<Piece NumberOfPoints="{points}" {count}>"#)?;

        writeln!(out, "<PointData>")?;
        let vertices = self.points.iter().map(|&(_, vertex)| vertex);
        let vertices = vertices.chain(self.of_curves.iter().map(|_| NONE));
        array(out, "UInt32", "vertex", vertices.map(u32::to_le_bytes))?;
        writeln!(out, "</PointData>")?;

        let all = || cells.into_iter().flatten();
        writeln!(out, r#"<CellData Scalars="partners">"#)?;
        let numbers: [(&str, fn(&Cell) -> u32); 4] = [
            ("body", |cell| cell.body),
            ("triangle", |cell| cell.triangle),
            ("partners", |cell| cell.partners),
            ("curve", |cell| cell.curve),
        ];
        for (name, number) in numbers {
            array(
                out,
                "UInt32",
                name,
                all().map(|cell| number(cell).to_le_bytes()),
            )?;
        }
        let lengths = all().map(|cell| cell.length.to_le_bytes());
        array(out, "Float64", "length", lengths)?;
        writeln!(out, "</CellData>")?;

        writeln!(out, "<Points>")?;
        let sources = check.sources();
        let coordinates = self
            .points
            .iter()
            .flat_map(|&(source, vertex)| sources[source].positions().get(vertex))
            .chain(self.of_curves.as_flattened().iter().copied());
        if sources.iter().all(|it| it.precision() == Precision::F32) {
            let coordinates = coordinates.map(|x| (x as f32).to_le_bytes());
            array(out, "Float32", "Points", coordinates)?;
        } else {
            array(out, "Float64", "Points", coordinates.map(f64::to_le_bytes))?;
        }
        writeln!(out, "</Points>")?;

        match kind {
            Kind::PolyData => {
                self.list(out, "Lines", self.lines.iter())?;
                writeln!(out, "</Lines>")?;
                self.list(out, "Polys", self.triangles.iter())?;
                writeln!(out, "</Polys>")?;
            }
            Kind::UnstructuredGrid => {
                self.list(out, "Cells", all())?;
                let kind = |cell: &Cell| if cell.curve == NONE { TRIANGLE } else { LINE };
                array(out, "UInt8", "types", all().map(|cell| [kind(cell)]))?;
                writeln!(out, "</Cells>")?;
            }
        }
        writeln!(out, "</Piece>")?;
        end(out, kind.name())
    }

    /// Writes cells: the points of each, and where it ends in them.
    fn list<'c>(
        &self,
        out: &mut dyn Write,
        name: &str,
        cells: impl Iterator<Item = &'c Cell> + Clone,
    ) -> io::Result<()> {
        writeln!(out, "<{name}>")?;
        let points = cells.clone();
        let points = points.flat_map(|cell| &self.corners[cell.corners.clone()]);
        array(
            out,
            "Int64",
            "connectivity",
            points.map(|point| point.to_le_bytes()),
        )?;
        let ends = cells.scan(0, |end, cell| {
            *end += cell.corners.len() as i64;
            Some(end.to_le_bytes())
        });
        array(out, "Int64", "offsets", ends)
    }
}

fn begin(out: &mut dyn Write, kind: &str) -> io::Result<()> {
    writeln!(
        out,
        r#"<?xml version="1.0"?>
<!-- {MARK} -->
<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian" header_type="UInt64">
<{kind}>"#
    )
}

fn end(out: &mut dyn Write, kind: &str) -> io::Result<()> {
    writeln!(out, "</{kind}>\n</VTKFile>")
}

/// Writes an array: its length in bytes and its bytes, together in base64, which has every bit and
/// is half as long as text.
fn array<const N: usize>(
    out: &mut dyn Write,
    kind: &str,
    name: &str,
    numbers: impl Iterator<Item = [u8; N]>,
) -> io::Result<()> {
    let components = match name {
        "Points" => r#" NumberOfComponents="3""#,
        // One is the default. Where it is written, meshio makes a column of the numbers.
        _ => "",
    };
    let mut bytes = vec![0; size_of::<u64>()];
    bytes.extend(numbers.flatten());
    let length = (bytes.len() - size_of::<u64>()) as u64;
    bytes[..size_of::<u64>()].copy_from_slice(&length.to_le_bytes());
    writeln!(
        out,
        r#"<DataArray type="{kind}" Name="{name}"{components} format="binary">{}</DataArray>"#,
        BASE64_STANDARD.encode(bytes)
    )
}

/// Escapes a name for an attribute. Readers of XML turn line breaks into spaces, unless they are
/// written as numbers.
fn attribute(name: &str) -> String {
    let escaped = name.chars().map(|c| match c {
        '&' => "&amp;".to_owned(),
        '<' => "&lt;".to_owned(),
        '"' => "&quot;".to_owned(),
        '\t' | '\n' | '\r' => format!("&#{};", u32::from(c)),
        c => c.to_string(),
    });
    escaped.collect()
}

/// Whether a character can be written in XML.
fn is_xml(c: char) -> bool {
    !matches!(c, '\0'..='\u{8}' | '\u{b}' | '\u{c}' | '\u{e}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}')
}
