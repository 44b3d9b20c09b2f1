//! Bodies that the calling program evaluates are checked like bodies from files.

use pliant_io::{Evaluated, OpenOptions, Positions, evaluated};
use std::path::Path;

/// A square that rises, or a spoilt one.
struct Square {
    counts: Vec<u32>,
    corners: Vec<u32>,
    frames: Vec<Result<Vec<[f64; 3]>, String>>,
}

impl Square {
    fn rising() -> Self {
        let at = |z| {
            Ok(vec![
                [0.0, 0.0, z],
                [1.0, 0.0, z],
                [1.0, 1.0, z],
                [0.0, 1.0, z],
            ])
        };
        Self {
            counts: vec![4],
            corners: vec![0, 1, 2, 3],
            frames: [0.0, 1.0, 2.0].map(at).to_vec(),
        }
    }
}

impl Evaluated for Square {
    fn frame_count(&self) -> usize {
        self.frames.len()
    }

    fn polygons(&self) -> (&[u32], &[u32]) {
        (&self.counts, &self.corners)
    }

    fn positions(&mut self, frame: usize, list: &mut Vec<[f64; 3]>) -> Result<(), String> {
        list.extend(self.frames[frame].clone()?);
        Ok(())
    }
}

/// An arbitrary existing file.
fn file() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"))
}

fn open(square: Square) -> Result<pliant_io::Body, pliant_io::Error> {
    let options = OpenOptions::default();
    evaluated(file(), "stage", "stage#/square", Box::new(square), &options)
}

#[test]
fn frames_come_in_order_and_are_passed_over_and_begin_again() {
    let mut body = open(Square::rising()).unwrap();
    assert_eq!((body.argument(), body.name()), ("stage", "stage#/square"));
    assert_eq!((body.frame_count(), body.triangles().len()), (3, 2));
    let height = |body: &mut pliant_io::Body| match body.next_frame().unwrap() {
        Some(Positions::F64(positions)) => Some(positions[3][2]),
        _ => None,
    };
    let heights: Vec<_> = (0..4).map(|_| height(&mut body)).collect();
    assert_eq!(heights, [Some(0.0), Some(1.0), Some(2.0), None]);
    body.rewind().unwrap();
    body.skip(2);
    assert_eq!(height(&mut body), Some(2.0));
    body.rewind().unwrap();
    assert_eq!(height(&mut body), Some(0.0));
}

#[test]
fn what_is_wrong_is_said() {
    let refused = |change: fn(&mut Square)| {
        let mut square = Square::rising();
        change(&mut square);
        let all = open(square).and_then(|mut body| {
            while body.next_frame()?.is_some() {}
            Ok(())
        });
        let message = all.unwrap_err().to_string();
        assert!(!message.contains('\n'), "{message}");
        message
    };
    let changes: [(fn(&mut Square), &str); 8] = [
        (|square| square.frames.clear(), "no frames"),
        (|square| square.corners[3] = 4, "4"),
        (
            |square| square.counts[0] = 5,
            "lists 4 corners, but its polygons need 5",
        ),
        (
            |square| square.counts[0] = 3,
            "lists 4 corners, but its polygons need 3",
        ),
        (|square| square.counts[0] = 1, "1 corners"),
        (
            |square| square.frames[1] = Err("the sun is down".into()),
            "the sun is down",
        ),
        (
            |square| square.frames[2] = Ok(vec![[0.0; 3]; 3]),
            "3 vertices",
        ),
        (
            |square| square.frames[1] = Ok(vec![[f64::NAN; 3]; 4]),
            "NaN",
        ),
    ];
    for (change, expected) in changes {
        let message = refused(change);
        assert!(message.contains(expected), "{expected}: {message}");
    }
}
