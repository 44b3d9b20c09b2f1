//! Meshes that change from file to file, against checks of each file alone.
//!
//! Every frame has the pairs of its file, whichever frames were checked before. The baseline's
//! pairs are left out where the meshes are equal. Seams close and open by chance, since corners are
//! on a lattice.

use pliant_check::{Baseline, Check, Error, Found, Frames, Settings, Split};
use pliant_io::OpenOptions;
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// A random small mesh: its number in [`MESHES`], and its corners.
#[derive(Clone, Debug)]
struct Shape {
    mesh: usize,
    corners: Vec<[u8; 3]>,
}

/// Number of corners of the largest mesh.
const MOST: usize = 9;

/// Vertex counts and triangles. Meshes 0 and 1 have equal numbers of both, 2 has more, 3 fewer.
const MESHES: [(usize, &[[usize; 3]]); 4] = [
    (7, &[[0, 1, 2], [2, 1, 3], [4, 5, 6]]),
    (7, &[[0, 1, 2], [2, 3, 4], [4, 5, 6]]),
    (9, &[[0, 1, 2], [3, 4, 5], [6, 7, 8], [2, 1, 3]]),
    (6, &[[0, 1, 2], [3, 4, 5]]),
];

impl Shape {
    fn text(&self) -> String {
        let (vertices, triangles) = MESHES[self.mesh];
        let mut text = String::new();
        for [x, y, z] in &self.corners[..vertices] {
            writeln!(text, "v {x} {y} {z}").unwrap();
        }
        for triangle in triangles {
            let [a, b, c] = triangle.map(|corner| corner + 1);
            writeln!(text, "f {a} {b} {c}").unwrap();
        }
        text
    }
}

fn shapes() -> impl Strategy<Value = Vec<Shape>> {
    let corner = prop::array::uniform3(0..6_u8);
    let corners = prop::collection::vec(corner, MOST);
    let shape = (0..MESHES.len(), corners);
    let shape = shape.prop_map(|(mesh, corners)| Shape { mesh, corners });
    prop::collection::vec(shape, 1..7)
}

/// Checks a body that changes and one that stands still.
fn find(folder: &Path, changing: &str, settings: &Settings) -> Result<Vec<Found>, Error> {
    let arguments = [changing, "still.obj"].map(|name| folder.join(name).display().to_string());
    let mut check = Check::open(&arguments, &OpenOptions::default(), settings)?;
    let mut all = Vec::new();
    while let Some(found) = check.next_frame()? {
        let [body, _] = [0, 1].map(|body| check.body(body).unwrap());
        if found.changed.is_empty() {
            all.push(found);
            continue;
        }
        assert_eq!(found.changed, [0]);
        assert_eq!(body.triangles, check.sources()[0].triangles().len());
        all.push(found);
    }
    Ok(all)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(120))]

    #[test]
    fn every_frame_is_what_its_file_is(
        shapes in shapes(),
        still in shapes(),
        start in 0..3_usize,
        step in 1..3_usize,
        baseline in 0..6_usize,
    ) {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        for (frame, shape) in shapes.iter().enumerate() {
            fs::write(folder.join(format!("f{frame}.obj")), shape.text()).unwrap();
        }
        fs::write(folder.join("still.obj"), still[0].text()).unwrap();
        let settings = Settings { itself: true, ..Settings::default() };
        let alone: Vec<Found> = (0..shapes.len())
            .map(|frame| find(folder, &format!("f{frame}.obj"), &settings).unwrap().remove(0))
            .collect();

        let start = start.min(shapes.len() - 1);
        let count = (shapes.len() - start).div_ceil(step);
        let frames = Some(Frames { start, step, count });
        let some: Vec<usize> = (start..shapes.len()).step_by(step).collect();
        let settings = Settings { frames, ..settings };
        let found = find(folder, "f*.obj", &settings).unwrap();
        prop_assert_eq!(found.len(), some.len());
        let mut before = 0;
        for (found, &frame) in found.iter().zip(&some) {
            prop_assert_eq!(&found.pairs, &alone[frame].pairs);
            let changed = shapes[frame].mesh != shapes[before].mesh;
            prop_assert_eq!(!found.changed.is_empty(), changed);
            before = frame;
        }

        let baseline = baseline.min(shapes.len() - 1);
        let settings = Settings { baseline: Some(Baseline::Frame(baseline)), ..settings };
        let found = find(folder, "f*.obj", &settings).unwrap();
        for (found, &frame) in found.iter().zip(&some) {
            let same = shapes[frame].mesh == shapes[baseline].mesh;
            let is_known = |row: &[u32; 4]| {
                let known: BTreeSet<_> = alone[baseline].pairs.iter().collect();
                (same || [row[0], row[2]] == [1, 1]) && known.contains(row)
            };
            let expected = alone[frame].pairs.iter().copied().filter(|row| !is_known(row));
            prop_assert_eq!(&found.pairs, &expected.collect::<Vec<_>>());
        }

        let settings = Settings { split: Some(Split::Components), frames, ..Settings::default() };
        match find(folder, "f*.obj", &settings) {
            Ok(_) => prop_assert!(some.iter().all(|&frame| shapes[frame].mesh == shapes[0].mesh)),
            Err(Error::PiecesChanged { frame, .. }) => {
                prop_assert_ne!(shapes[frame].mesh, shapes[0].mesh);
            }
            Err(other) => panic!("{other}"),
        }
    }
}
