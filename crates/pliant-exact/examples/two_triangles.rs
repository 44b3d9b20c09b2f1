//! Whether two triangles meet, how, and how far apart they are: eighteen coordinates on the command
//! line.
//!
//! ```sh
//! cargo run -p pliant-exact --example two_triangles -- \
//!     0 0 0  1 0 0  0 1 0   0.2 0.3 0  0.2 0.3 1  0.9 0.3 1
//! ```

use pliant_exact::distance::{SomePoints, closest_triangles};
use pliant_exact::{Precision::Double, Triangle, contact_kind, intersect, is_in_range};

fn main() -> Result<(), String> {
    let numbers: Result<Vec<f64>, _> = std::env::args().skip(1).map(|it| it.parse()).collect();
    let numbers = numbers.map_err(|error| format!("a coordinate: {error}"))?;
    let [a, b] = triangles(&numbers).ok_or("eighteen coordinates: two triangles, three corners")?;
    if !a.iter().chain(&b).all(is_in_range) {
        return Err("coordinates are finite and at most f32::MAX in magnitude".into());
    }
    if intersect(Double, &a, &b, &mut 0) {
        println!("they meet: {:?}", contact_kind(Double, &a, &b));
    }
    // No points are known yet.
    let unknown = SomePoints {
        which: 0,
        along: [0.0; 2],
        apart: f64::INFINITY,
    };
    let closest = closest_triangles(Double, &a, &b, unknown);
    println!("distance {}", closest.distance);
    println!("closest points, by corners: {:?}", closest.barycentric);
    Ok(())
}

fn triangles(numbers: &[f64]) -> Option<[Triangle; 2]> {
    let numbers: &[f64; 18] = numbers.try_into().ok()?;
    let (corners, _) = numbers.as_chunks::<3>();
    let (triangles, _) = corners.as_chunks::<3>();
    triangles.try_into().ok()
}
