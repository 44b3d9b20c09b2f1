//! Fuzzes intersection of two triangles: every query of the library agrees with the oracle, which
//! uses another definition.
#![no_main]

use arbitrary::Arbitrary;
use pliant::{Scalar, Selection, World, reference};
use pliant_fuzz::places::Grid;
use pliant_oracle::intersect;

/// Six corners: three of one triangle, then three of the other.
#[derive(Arbitrary, Debug)]
enum Corners {
    /// Few numbers, so that many coincide.
    Grid(Grid, [[i8; 3]; 6]),
    /// Small numbers times powers of two, one each.
    Scaled([[(i8, i16); 3]; 6]),
    /// Any bits.
    Narrow([[u32; 3]; 6]),
    Wide([[u64; 3]; 6]),
}

#[derive(Arbitrary, Debug)]
struct Pair {
    corners: Corners,
    wide: bool,
    /// For each corner of the second triangle, a corner of the first that replaces it.
    shared: [Option<u8>; 3],
    /// A corner, and two others between which it is put half way, as nearly as coordinates allow.
    halfway: Option<(u8, u8, u8)>,
}

libfuzzer_sys::fuzz_target!(|pair: Pair| {
    let mut corners: [[f64; 3]; 6] = match pair.corners {
        Corners::Grid(grid, points) => {
            points.map(|point| point.map(|small| grid.coordinate(small, pair.wide)))
        }
        Corners::Scaled(points) => points.map(|point| {
            point.map(|(small, power)| f64::from(small) * 2_f64.powi(i32::from(power) % 1100))
        }),
        Corners::Narrow(points) => {
            points.map(|point| point.map(|bits| f32::from_bits(bits).into()))
        }
        Corners::Wide(points) => points.map(|point| point.map(f64::from_bits)),
    };
    for (place, shared) in pair.shared.into_iter().enumerate() {
        if let Some(corner) = shared {
            corners[3 + place] = corners[usize::from(corner % 3)];
        }
    }
    if let Some((between, a, b)) = pair.halfway {
        let [between, a, b] = [between, a, b].map(|corner| usize::from(corner % 6));
        corners[between] =
            std::array::from_fn(|axis| corners[a][axis] / 2.0 + corners[b][axis] / 2.0);
    }
    if pair.wide {
        check::<f64>(corners);
    } else {
        check::<f32>(corners.map(|corner| corner.map(|x| x as f32)));
    }
});

const ONE: [[u32; 3]; 1] = [[0, 1, 2]];

fn check<S: Scalar>(corners: [[S; 3]; 6]) {
    let exact = corners.map(|corner| corner.map(S::to_f64));
    let [a, b] = [&corners[..3], &corners[3..]];
    let mut world = World::new();
    let added = [
        world.add(&ONE, a),
        world.add(&ONE, b),
        world.add(&[[0, 1, 2], [3, 4, 5]], &corners),
    ];
    let in_range = exact
        .as_flattened()
        .iter()
        .all(|x| x.abs() <= f64::from(f32::MAX));
    assert_eq!(added.iter().all(Result::is_ok), in_range);
    let [Ok(one), Ok(other), Ok(both)] = added else {
        return;
    };

    let triangle = |at: usize| [exact[at], exact[at + 1], exact[at + 2]];
    let expected = intersect(&triangle(0), &triangle(3));
    let pairs = if expected { vec![[0, 0]] } else { vec![] };
    assert_eq!(
        reference::intersection_pairs(&ONE, a, &ONE, b).as_ref(),
        Ok(&pairs)
    );
    assert_eq!(
        reference::intersection_pairs(&ONE, b, &ONE, a).as_ref(),
        Ok(&pairs)
    );
    assert_eq!(triangles(&mut world, Selection::Between(one, other)), pairs);
    assert_eq!(triangles(&mut world, Selection::Between(other, one)), pairs);
    let own = if expected { vec![[0, 1]] } else { vec![] };
    assert_eq!(triangles(&mut world, Selection::Within(both)), own);
}

/// All pairs of triangles of a selection, without their bodies.
fn triangles<S: Scalar>(world: &mut World<S>, of: Selection) -> Vec<[u32; 2]> {
    let pairs = world.intersections(of).all().expect("the bodies are there");
    pairs.iter().map(pliant::Pair::triangles).collect()
}
