//! Quality of mesh connectivity trees: the children of the root beside METIS on the same mesh.
//!
//! ```sh
//! cargo run --release -p pliant-bench --features metis --example cut_against_metis
//! ```
//!
//! METIS partitions the dual graph (triangles, linked over edges) by recursive bisection with its
//! own defaults. It balances to a thousandth and does not care whether parts are connected. Ours
//! are connected, and balanced to a hundredth a cut. A component is never cut unless it must be.

use pliant::{Degree, Options, Partition, World};
use pliant_scenes::Scene;
use std::collections::BTreeMap;

fn main() {
    println!("border: edges with triangles of two parts; pieces: connected pieces of all parts\n");
    println!(
        "{:<16} {:>5}   {:^34}   {:^34}",
        "mesh", "parts", "pliant", "METIS"
    );
    let columns = format!(
        "{:>8} {:>8} {:>8} {:>7}",
        "border", "smallest", "largest", "pieces"
    );
    println!("{:<16} {:>5}   {columns}   {columns}", "", "");
    for (name, triangles) in [
        ("spheres", 1280),
        ("spheres", 20_480),
        ("spheres", 81_920),
        ("cloth", 2888),
        ("cloth", 19_602),
    ] {
        let scene = Scene::new(name, Some(triangles), Scene::DEFAULT_SEED)
            .expect("the scene comes in this size");
        let mesh = Mesh::new(scene.triangles(0));
        let mut positions = Vec::new();
        scene.positions(0, 1, &mut positions);
        for degree in [Degree::Two, Degree::Four, Degree::Eight] {
            let ours = mesh.describe(&ours(mesh.triangles, &positions, degree));
            let theirs = mesh.describe(&mesh.metis(degree.get()));
            let mesh = format!("{name} {triangles}");
            println!("{mesh:<16} {:>5}   {ours}   {theirs}", degree.get());
        }
    }
}

/// Child of the root above each triangle.
fn ours(triangles: &[[u32; 3]], positions: &[[f32; 3]], degree: Degree) -> Vec<u32> {
    let mut options = Options::default();
    options.partition = Partition::Connectivity;
    options.degree = degree;
    let mut world = World::with_options(options);
    let body = world
        .add(triangles, positions)
        .expect("a scene's bodies are good");
    world.tree_cut(body, 1).expect("the body is there")
}

/// Triangles, and the triangles that meet in each edge.
struct Mesh<'a> {
    triangles: &'a [[u32; 3]],
    edges: Vec<Vec<u32>>,
}

impl<'a> Mesh<'a> {
    fn new(triangles: &'a [[u32; 3]]) -> Self {
        let mut edges = BTreeMap::<[u32; 2], Vec<u32>>::new();
        for (triangle, &[a, b, c]) in (0..).zip(triangles) {
            for [a, b] in [[a, b], [b, c], [c, a]] {
                edges
                    .entry([a.min(b), a.max(b)])
                    .or_default()
                    .push(triangle);
            }
        }
        Self {
            triangles,
            edges: edges.into_values().collect(),
        }
    }

    fn metis(&self, parts: usize) -> Vec<u32> {
        let mut neighbours = vec![Vec::new(); self.triangles.len()];
        for around in &self.edges {
            for &a in around {
                let others = around.iter().filter(|&&b| b != a);
                neighbours[a as usize].extend(others.map(|&b| b.cast_signed()));
            }
        }
        let mut starts = vec![0];
        for row in &neighbours {
            starts.push(starts[starts.len() - 1] + row.len() as i32);
        }
        let mut found = vec![0; self.triangles.len()];
        metis::Graph::new(1, parts as i32, &starts, &neighbours.concat())
            .expect("the dual graph is one that METIS takes")
            .part_recursive(&mut found)
            .expect("METIS partitions it");
        found.into_iter().map(i32::cast_unsigned).collect()
    }

    /// Border, smallest and largest part, and number of connected pieces.
    fn describe(&self, parts: &[u32]) -> String {
        let cut = |around: &&Vec<u32>| {
            let part = |triangle: u32| parts[triangle as usize];
            around
                .iter()
                .any(|&triangle| part(triangle) != part(around[0]))
        };
        let border = self.edges.iter().filter(cut).count();
        let mut sizes = BTreeMap::<u32, usize>::new();
        for &part in parts {
            *sizes.entry(part).or_default() += 1;
        }
        let sizes = || sizes.values().copied();
        let (smallest, largest) = (
            sizes().min().unwrap_or_default(),
            sizes().max().unwrap_or_default(),
        );
        let pieces = self.pieces(parts);
        format!("{border:>8} {smallest:>8} {largest:>8} {pieces:>7}")
    }

    /// Total number of connected pieces of all parts.
    fn pieces(&self, parts: &[u32]) -> usize {
        let mut leaders: Vec<usize> = (0..parts.len()).collect();
        for around in &self.edges {
            for (&a, &b) in around.iter().zip(&around[1..]) {
                let (a, b) = (a as usize, b as usize);
                if parts[a] == parts[b] {
                    let (a, b) = (leader(&mut leaders, a), leader(&mut leaders, b));
                    leaders[a] = b;
                }
            }
        }
        (0..parts.len())
            .filter(|&triangle| leaders[triangle] == triangle)
            .count()
    }
}

/// Union-find root of `of`, with path halving.
fn leader(leaders: &mut [usize], mut of: usize) -> usize {
    while leaders[of] != of {
        leaders[of] = leaders[leaders[of]];
        of = leaders[of];
    }
    of
}
