//! Files of `pliant check --hits`, read by a small XML reader and compared with the JSON output.
//!
//! `benchmarks/read_hits.py` shows that other readers accept them.

use crate::common::{Said, pliant};
use base64::prelude::{BASE64_STANDARD, Engine};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// An array of a file: type and bytes.
struct Array {
    kind: String,
    bytes: Vec<u8>,
}

impl Array {
    fn numbers(&self) -> Vec<f64> {
        let width = match self.kind.as_str() {
            "UInt8" => 1,
            "UInt32" | "Float32" => 4,
            "Int64" | "Float64" => 8,
            other => panic!("no array is of {other}"),
        };
        assert_eq!(self.bytes.len() % width, 0);
        let number = |bytes: &[u8]| match self.kind.as_str() {
            "UInt8" => f64::from(bytes[0]),
            "UInt32" => f64::from(u32::from_le_bytes(bytes.try_into().unwrap())),
            "Float32" => f64::from(f32::from_le_bytes(bytes.try_into().unwrap())),
            "Int64" => i64::from_le_bytes(bytes.try_into().unwrap()) as f64,
            _ => f64::from_le_bytes(bytes.try_into().unwrap()),
        };
        self.bytes.chunks(width).map(number).collect()
    }
}

/// A VTK file: attributes of its elements, and its arrays by name.
#[derive(Default)]
struct Vtk {
    attributes: BTreeMap<String, String>,
    arrays: BTreeMap<String, Array>,
    data_sets: Vec<BTreeMap<String, String>>,
}

fn unescaped(value: &str) -> String {
    assert!(!value.contains(['<', '"']), "{value}");
    // An XML reader would turn these into spaces if they were not escaped.
    assert!(!value.contains(['\t', '\n', '\r']), "{value:?}");
    let text = value.replace("&lt;", "<").replace("&quot;", "\"");
    let text = [("&#9;", "\t"), ("&#10;", "\n"), ("&#13;", "\r")]
        .iter()
        .fold(text, |text, (number, c)| text.replace(number, c));
    assert_eq!(
        text.matches('&').count(),
        text.matches("&amp;").count(),
        "{text}"
    );
    text.replace("&amp;", "&")
}

/// Reads a file. Fails unless all elements are closed in order.
fn read(path: &Path) -> Vtk {
    let text =
        fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let body = text.strip_prefix("<?xml version=\"1.0\"?>\n").unwrap();
    let body = body.strip_prefix("<!-- written by pliant -->\n").unwrap();
    let (mut vtk, mut open) = (Vtk::default(), Vec::new());
    for element in body.split('<').skip(1) {
        let (tag, content) = element.split_once('>').unwrap();
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name), "{tag}");
            continue;
        }
        let (name, rest) = tag.split_once(' ').unwrap_or((tag, ""));
        let mut attributes = BTreeMap::new();
        let mut rest = rest.trim_end_matches('/');
        while let Some((key, after)) = rest.trim().split_once("=\"") {
            let (value, after) = after.split_once('"').unwrap();
            assert!(
                attributes
                    .insert(key.to_owned(), unescaped(value))
                    .is_none(),
                "{tag}"
            );
            rest = after;
        }
        assert_eq!(rest.trim(), "");
        if !tag.ends_with('/') {
            open.push(name);
        }
        if name == "DataSet" {
            vtk.data_sets.push(attributes.clone());
        }
        if name == "DataArray" && attributes["format"] == "binary" {
            let components = attributes.get("NumberOfComponents").map(String::as_str);
            let expected = (attributes["Name"] == "Points").then_some("3");
            assert_eq!(components, expected, "{tag}");
            let bytes = BASE64_STANDARD.decode(content).unwrap();
            let (length, bytes) = bytes.split_at(8);
            assert_eq!(
                u64::from_le_bytes(length.try_into().unwrap()),
                bytes.len() as u64
            );
            let array = Array {
                kind: attributes["type"].clone(),
                bytes: bytes.to_vec(),
            };
            let name = &attributes["Name"];
            let name = match open[open.len() - 2] {
                "Lines" => format!("Lines {name}"),
                _ => name.clone(),
            };
            assert!(vtk.arrays.insert(name, array).is_none());
        } else if name == "DataArray" {
            vtk.attributes
                .insert(attributes["Name"].clone(), content.to_owned());
        }
        for (key, value) in attributes {
            vtk.attributes.insert(format!("{name} {key}"), value);
        }
    }
    assert!(open.is_empty(), "{open:?}");
    vtk
}

/// Three files of two crossing sheets of many triangles, in f64, f32 and f64.
///
/// In three frames the second sheet falls through the first.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let grid = |z: &dyn Fn(f64, f64) -> f64| {
        let mut text = String::new();
        for i in 0..100 {
            let (x, y) = (f64::from(i % 10) / 3.0, f64::from(i / 10) / 7.0);
            writeln!(text, "v {x} {y} {}", z(x, y)).unwrap();
        }
        for i in (0..90).filter(|i| i % 10 < 9) {
            writeln!(text, "f {} {} {} {}", i + 1, i + 2, i + 12, i + 11).unwrap();
        }
        text
    };
    let write = |name: &str, text: String| fs::write(folder.path().join(name), text).unwrap();
    write("still.obj", grid(&|x, y| x * y / 10.0));
    for frame in 0..3 {
        let fall = f64::from(frame) - 1.3;
        write(
            &format!("falls{frame}.obj"),
            grid(&|x, y| (x - y) / 3.0 - fall / 2.0),
        );
    }
    folder
}

fn check(folder: &Path, arguments: &[&str]) -> Said {
    pliant(
        folder,
        &[&["check", "--format", "json"], arguments].concat(),
    )
}

/// Fails unless the file has exactly the triangles of the pairs, with the corners of the OBJ file.
fn assert_same(vtk: &Vtk, pairs: &serde_json::Value, kind: &str, files: &[&Path]) {
    let pairs: Vec<[u32; 4]> = serde_json::from_value(pairs.clone()).unwrap();
    let mut partners: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    for [body_a, a, body_b, b] in pairs {
        *partners.entry([body_a, a]).or_default() += 1;
        *partners.entry([body_b, b]).or_default() += 1;
    }
    assert_eq!(vtk.attributes["VTKFile type"], kind);
    let whole = |name: &str| -> Vec<u32> {
        let numbers = vtk.arrays[name].numbers();
        let whole = numbers.iter().map(|number| number.to_string().parse());
        whole.collect::<Result<_, _>>().unwrap()
    };
    // Curves are before the triangles, or behind.
    let is_curve: Vec<bool> = whole("curve").iter().map(|&it| it != u32::MAX).collect();
    let lines = is_curve.iter().filter(|is| **is).count();
    let is_poly = kind == "PolyData";
    let count = |name: &str| vtk.attributes[name].parse::<usize>().unwrap();
    if is_poly {
        assert_eq!(count("Piece NumberOfLines"), lines);
        assert_eq!(count("Piece NumberOfPolys"), partners.len());
    } else {
        assert_eq!(count("Piece NumberOfCells"), partners.len() + lines);
    }
    let of_triangles = if is_poly { lines.. } else { 0.. };
    let of_triangles = |name: &str| -> Vec<u32> {
        let all = &whole(name)[of_triangles.clone()];
        all[..partners.len()].to_vec()
    };
    let (bodies, triangles) = (of_triangles("body"), of_triangles("triangle"));
    let found = of_triangles("partners");
    let found = bodies.iter().zip(&triangles).zip(found);
    let found: Vec<_> = found
        .map(|((&body, &triangle), n)| ([body, triangle], n))
        .collect();
    assert_eq!(found, partners.into_iter().collect::<Vec<_>>());

    // Corners, by their vertex numbers and by their positions.
    let (mut corners, vertices) = (whole("connectivity"), whole("vertex"));
    let offsets: Vec<u32> = (1..=bodies.len() as u32).map(|cell| 3 * cell).collect();
    let mut all_offsets = whole("offsets");
    let (along, stops) = if is_poly {
        (whole("Lines connectivity"), whole("Lines offsets"))
    } else {
        let stops = all_offsets.split_off(bodies.len());
        let along = corners.split_off(3 * bodies.len());
        let from = 3 * bodies.len() as u32;
        (along, stops.iter().map(|stop| stop - from).collect())
    };
    assert_eq!((corners.len(), all_offsets), (3 * bodies.len(), offsets));
    let points = vtk.arrays["Points"].numbers();
    let points: Vec<[f64; 3]> = points
        .chunks(3)
        .map(|point| point.try_into().unwrap())
        .collect();
    assert_eq!(
        vtk.attributes["Piece NumberOfPoints"],
        points.len().to_string()
    );
    assert_eq!(vertices.len(), points.len());
    let texts: Vec<_> = files
        .iter()
        .map(|file| fs::read_to_string(file).unwrap())
        .collect();
    for (cell, corners) in corners.chunks(3).enumerate() {
        let text = &texts[bodies[cell] as usize];
        let positions: Vec<[f64; 3]> = text
            .lines()
            .filter_map(|line| line.strip_prefix("v "))
            .map(|line| {
                let numbers: Vec<f64> = line.split(' ').map(|word| word.parse().unwrap()).collect();
                numbers.try_into().unwrap()
            })
            .collect();
        let quad = text.lines().filter_map(|line| line.strip_prefix("f "));
        let mut quad = quad.map(|line| {
            line.split(' ')
                .map(|word| word.parse::<u32>().unwrap() - 1)
                .collect::<Vec<_>>()
        });
        let quad = quad.nth(triangles[cell] as usize / 2).unwrap();
        let second = triangles[cell] as usize % 2;
        let expected = [quad[0], quad[1 + second], quad[2 + second]];
        let named: Vec<u32> = corners
            .iter()
            .map(|&corner| vertices[corner as usize])
            .collect();
        assert_eq!(named, expected);
        for (&corner, vertex) in corners.iter().zip(expected) {
            assert_eq!(
                points[corner as usize], positions[vertex as usize],
                "exactly"
            );
        }
    }
    assert_eq!((lines > 0, stops.len()), (!bodies.is_empty(), lines));
    assert!(
        along
            .iter()
            .all(|&point| vertices[point as usize] == u32::MAX)
    );
    assert_curves(vtk, [&along, &stops], is_poly);
    let used: BTreeSet<_> = corners.iter().chain(&along).collect();
    assert_eq!(used.len(), points.len(), "no point is written for nothing");
}

/// Curves are as long as is said. They are polylines, or the sides of them one by one.
fn assert_curves(vtk: &Vtk, [along, stops]: [&[u32]; 2], are_polylines: bool) {
    let points = vtk.arrays["Points"].numbers();
    let at = |&point: &u32| &points[3 * point as usize..][..3];
    let curves = vtk.arrays["curve"].numbers();
    let lengths = vtk.arrays["length"].numbers();
    let is_curve = |curve: f64| curve < f64::from(u32::MAX);
    let cells = curves
        .iter()
        .zip(lengths)
        .filter(|(curve, _)| is_curve(**curve));
    // A curve's number by its bits, as a key.
    let cells: Vec<(u64, f64)> = cells
        .map(|(&curve, length)| (curve.to_bits(), length))
        .collect();
    let mut found: BTreeMap<u64, f64> = BTreeMap::new();
    let mut start = 0;
    for (&stop, &(curve, _)) in stops.iter().zip(&cells) {
        let line = &along[start..stop as usize];
        assert!(are_polylines || line.len() == 2);
        for pair in line.windows(2) {
            let sides = at(&pair[0]).iter().zip(at(&pair[1]));
            let squares: f64 = sides.map(|(p, q)| (p - q).powi(2)).sum();
            *found.entry(curve).or_default() += squares.sqrt();
        }
        start = stop as usize;
    }
    assert_eq!(start, along.len());
    assert!(
        cells
            .iter()
            .all(|(curve, said)| (found[curve] - said).abs() < 1e-6)
    );
}

#[test]
fn one_frame_is_one_file() {
    let folder = folder();
    let path = folder.path();
    let files = ["falls2.obj", "still.obj"];
    let from: Vec<_> = files.map(|name| path.join(name)).into();
    let from: Vec<_> = from.iter().map(std::path::PathBuf::as_path).collect();
    for (name, kind) in [("hits.vtp", "PolyData"), ("hits.VTU", "UnstructuredGrid")] {
        let said = check(path, &[&files[..], &["--hits", name]].concat());
        assert_eq!((said.code, said.err.as_str()), (1, ""));
        let pairs = &said.json()["frames"][0]["pairs"];
        assert!(pairs.as_array().unwrap().len() > 20);
        let vtk = read(&path.join(name));
        assert_same(&vtk, pairs, kind, &from);
        assert_eq!(vtk.arrays["Points"].kind, "Float64");
        if kind == "UnstructuredGrid" {
            let curves = vtk.arrays["curve"].numbers();
            let expected = curves.iter().map(|&curve| {
                let is_curve = curve < f64::from(u32::MAX);
                if is_curve { 3.0 } else { 5.0 }
            });
            assert!(vtk.arrays["types"].numbers().into_iter().eq(expected));
        }
        // Without a printed list, the file is the same.
        let bytes = fs::read(path.join(name)).unwrap();
        for other in [&["--count"][..], &["--quiet"], &["--format", "lines"]] {
            let more = [&["check"], &files[..], &["--hits", name], other].concat();
            assert_eq!(pliant(path, &more).code, 1);
            assert_eq!(fs::read(path.join(name)).unwrap(), bytes, "{other:?}");
        }
    }
    assert!(!path.join("hits.pvd").exists());
}

/// A tip through a floor: a closed curve ends where it begins.
#[test]
fn a_closed_curve_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let floor = "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n";
    let tip = "v 0 0 -1\nv 3 0 1\nv -3 4 1\nv -3 -4 1\nf 1 3 2\nf 1 4 3\nf 1 2 4\n";
    fs::write(path.join("floor.obj"), floor).unwrap();
    fs::write(path.join("tip.obj"), tip).unwrap();
    let said = check(path, &["floor.obj", "tip.obj", "--hits", "tip.vtp"]);
    assert_eq!(said.code, 1);
    let vtk = read(&path.join("tip.vtp"));
    assert_eq!(vtk.arrays["Lines offsets"].numbers(), [4.0]);
    let along = vtk.arrays["Lines connectivity"].numbers();
    assert_eq!((along.len(), along[0]), (4, along[3]));
    // Half as large as the opening of the tip.
    let expected = 52f64.sqrt() + 4.0;
    assert!((vtk.arrays["length"].numbers()[0] - expected).abs() < 1e-12);
    assert_eq!(vtk.arrays["curve"].numbers()[0], 0.0);
}

#[test]
fn several_frames_are_a_collection() {
    let folder = folder();
    let path = folder.path();
    fs::create_dir(path.join("out")).unwrap();
    let said = check(path, &["falls*.obj", "still.obj", "--hits", "out/a&b.vtp"]);
    let frames = said.json()["frames"].clone();
    let collection = read(&path.join("out/a&b.pvd"));
    assert_eq!(collection.attributes["VTKFile type"], "Collection");
    assert_eq!(collection.data_sets.len(), 3);
    for (frame, entry) in collection.data_sets.iter().enumerate() {
        let name = format!("a&b_{frame}.vtp");
        assert_eq!(
            (&entry["timestep"], &entry["file"]),
            (&frame.to_string(), &name)
        );
        let vtk = read(&path.join("out").join(name));
        assert_eq!(vtk.attributes["TimeValue"], frame.to_string());
        let files = [
            path.join(format!("falls{frame}.obj")),
            path.join("still.obj"),
        ];
        assert_same(
            &vtk,
            &frames[frame]["pairs"],
            "PolyData",
            &[&files[0], &files[1]],
        );
    }
    let counts = said.counts();
    assert!(
        counts[0] == 0 && counts[1] > 0,
        "a frame without hits is a file without cells: {counts:?}"
    );
}

/// Names that Windows does not allow.
#[test]
#[cfg(unix)]
fn a_collection_names_its_files_whatever_is_in_their_names() {
    let folder = folder();
    let path = folder.path();
    let sequence = ["falls*.obj", "still.obj", "--hits"];
    let name = "a\r\n\t<\"&#10;b";
    let file = format!("{name}.vtp");
    assert_eq!(check(path, &[&sequence[..], &[&file]].concat()).code, 1);
    let collection = read(&path.join(format!("{name}.pvd")));
    for (frame, entry) in collection.data_sets.iter().enumerate() {
        assert_eq!(entry["file"], format!("{name}_{frame}.vtp"));
        assert!(path.join(&entry["file"]).exists());
    }
    // XML cannot represent these. With one frame, no file contains the name.
    for control in ["\u{1b}.vtp", "\u{ffff}.vtp"] {
        check(path, &[&sequence[..], &[control]].concat())
            .assert_refused(&["cannot hold this name; give another"]);
        let one = ["falls1.obj", "still.obj", "--hits", control];
        assert_eq!(check(path, &one).code, 1);
    }
}

#[test]
fn pieces_and_what_is_left_out() {
    let folder = folder();
    let path = folder.path();
    let both = ["falls1.obj", "still.obj"].map(|name| path.join(name));
    let [falls, still] = both
        .each_ref()
        .map(|file| fs::read_to_string(file).unwrap());
    let shifted = still.lines().filter_map(|line| line.strip_prefix("f "));
    let mut faces = String::new();
    for line in shifted {
        let corners = line
            .split(' ')
            .map(|word| word.parse::<u32>().unwrap() + 100);
        let corners: Vec<_> = corners.map(|corner| corner.to_string()).collect();
        writeln!(faces, "f {}", corners.join(" ")).unwrap();
    }
    let vertices = still.lines().filter(|line| line.starts_with('v'));
    let one = falls
        + &vertices
            .map(|line| line.to_owned() + "\n")
            .collect::<String>()
        + &faces;
    fs::write(path.join("one.obj"), one).unwrap();
    let arguments = ["one.obj", "--split", "components", "--hits", "hits.vtp"];
    let said = check(path, &arguments);
    let one = path.join("one.obj");
    let pairs = said.json()["frames"][0]["pairs"].clone();
    assert!(pairs[0][0] == 0 && pairs[0][2] == 1, "{}", pairs[0]);
    assert_same(
        &read(&path.join("hits.vtp")),
        &pairs,
        "PolyData",
        &[&one, &one],
    );
    let none = check(path, &[&arguments[..], &["--baseline", "0"]].concat());
    assert_eq!(none.code, 0);
    assert_eq!(
        read(&path.join("hits.vtp")).attributes["Piece NumberOfPolys"],
        "0"
    );
}

#[test]
fn single_precision_stays_single() {
    let folder = tempfile::tempdir().unwrap();
    let header = "ply\nformat ascii 1.0\nelement vertex 6\n\
        property float x\nproperty float y\nproperty float z\n\
        element face 2\nproperty list uchar int vertex_indices\nend_header\n";
    let text = "-1 -1 0\n9 -1 0\n-1 9 0\n.1 0 -1\n.1 0 1\n.1 2 1\n3 0 1 2\n3 3 4 5\n";
    fs::write(folder.path().join("a.ply"), header.to_owned() + text).unwrap();
    check(folder.path(), &["a.ply", "--hits", "hits.vtp"]);
    let points = &read(&folder.path().join("hits.vtp")).arrays["Points"];
    assert_eq!(points.kind, "Float32");
    assert_eq!(points.numbers()[9], f64::from(0.1_f32));
}

#[test]
fn what_cannot_be_written_is_an_error() {
    let folder = folder();
    for (name, words) in [
        ("hits.obj", &["hits.obj", ".vtp", ".vtu"][..]),
        ("hits", &["--hits", ".vtp"]),
        ("absent/hits.vtp", &["cannot write absent/hits.vtp"]),
    ] {
        check(folder.path(), &["falls1.obj", "still.obj", "--hits", name]).assert_refused(words);
    }
}
