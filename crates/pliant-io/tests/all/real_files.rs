//! Real files that are not part of this repository.
//!
//! Where they are absent the tests say so and pass.

use std::path::{Path, PathBuf};

use pliant_io::{OpenOptions, Positions, Precision};

fn data() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("skipped: {} is absent", folder.display());
    None
}

#[test]
fn every_mesh_has_the_counts_of_its_source() {
    let Some(data) = data() else { return };
    let (single, double) = (Precision::F32, Precision::F64);
    for (file, vertices, triangles, frames, precision) in [
        ("armadillo-rollers/*.ply", 12_135, 24_242, 2, double),
        ("cloth-funnel/*.ply", 9_450, 18_484, 2, double),
        ("human-morph.npz", 13_380, 26_756, 60, single),
        ("ipc-toolkit/cube.ply", 8, 12, 1, double),
        ("ipc-toolkit/height-field.ply", 2_540, 4_904, 1, double),
        ("ipc-toolkit/two-cubes-far.ply", 262, 480, 1, double),
        ("ipc-toolkit/two-cubes-close.ply", 262, 480, 1, double),
        (
            "ipc-toolkit/two-cubes-intersecting.ply",
            262,
            480,
            1,
            double,
        ),
        ("ipc-toolkit/thick-cloth/t*.ply", 233, 404, 2, double),
    ] {
        let argument = data.join(file).display().to_string();
        let mut body = match pliant_io::open(&argument, &OpenOptions::default()) {
            Ok(body) => body,
            Err(error) => panic!("{error}"),
        };
        assert_eq!(
            (body.vertex_count(), body.triangles().len()),
            (vertices, triangles),
            "{file}"
        );
        assert_eq!(
            (body.frame_count(), body.precision()),
            (frames, precision),
            "{file}"
        );
        assert_eq!((body.welded(), body.faces()), (0, None), "{file}");
        match crate::common::all_frames(&mut body) {
            Ok(read) => {
                assert_eq!(read.len(), frames, "{file}");
                assert!(
                    read.iter().all(|positions| positions.len() == vertices),
                    "{file}"
                );
            }
            Err(error) => panic!("{error}"),
        }
    }
}

#[test]
fn the_human_moves() {
    let Some(data) = data() else { return };
    let argument = data.join("human-morph.npz").display().to_string();
    let mut body = pliant_io::open(&argument, &OpenOptions::default()).unwrap();
    let mut moved = 0;
    let mut last: Option<Vec<[f32; 3]>> = None;
    while let Some(positions) = body.next_frame().unwrap() {
        let Positions::F32(positions) = positions else {
            panic!("float32 in the file")
        };
        // In decimetres: from a small child to a tall man.
        let tall = |axis: usize| {
            let (low, high) = positions
                .iter()
                .fold((f32::MAX, f32::MIN), |(low, high), p| {
                    (low.min(p[axis]), high.max(p[axis]))
                });
            high - low
        };
        let height = (0..3).map(tall).fold(0.0, f32::max);
        assert!((5.0..25.0).contains(&height), "{height}");
        moved += usize::from(last.as_ref().is_some_and(|last| last != positions));
        last = Some(positions.to_vec());
    }
    assert_eq!(moved, 59);
}
