//! Methods without edits, on changing meshes.
//!
//! [`Rebuilt`] builds anew whenever a mesh changes, as people do today. [`Unedited`] sees the same
//! shapes as if no mesh changed, which shows the cost of edits.

use crate::method::{Counters, Method, Pair};
use crate::motion::{BodyMesh, Shape};
use pliant_scenes::{ChangingMesh, Event};

/// A method that is built anew, from the triangles that exist, whenever a mesh changes.
pub struct Rebuilt<M> {
    method: M,
    /// Original numbers of bodies, triangles and vertices, by the method's numbers.
    bodies: Vec<Numbers>,
    shapes: Vec<Vec<[f32; 3]>>,
    pairs: Vec<Pair>,
}

/// A body as the method has it.
struct Numbers {
    body: u32,
    triangles: Vec<u32>,
    vertices: Vec<u32>,
}

impl<M> Rebuilt<M> {
    /// Wraps a method.
    pub fn new(method: M) -> Self {
        Self {
            method,
            bodies: Vec::new(),
            shapes: Vec::new(),
            pairs: Vec::new(),
        }
    }

    /// Shapes of the bodies and vertices that the method has.
    fn gather(&mut self, shapes: &[Shape<'_>]) {
        self.shapes.resize_with(self.bodies.len(), Vec::new);
        for (shape, numbers) in self.shapes.iter_mut().zip(&self.bodies) {
            let all = shapes[numbers.body as usize].world;
            shape.clear();
            shape.extend(numbers.vertices.iter().map(|&vertex| all[vertex as usize]));
        }
    }
}

fn shape(world: &[[f32; 3]]) -> Shape<'_> {
    Shape {
        world,
        rigid: None,
        end: None,
    }
}

impl<M: Method> Method for Rebuilt<M> {
    fn name(&self) -> String {
        format!("{}, built anew when a mesh changes", self.method.name())
    }

    fn build(&mut self, bodies: &[BodyMesh<'_>]) {
        let meshes: Vec<_> = bodies
            .iter()
            .map(|body| ChangingMesh::new(body.triangles, body.shape.world.len()))
            .collect();
        let shapes: Vec<_> = bodies.iter().map(|body| body.shape).collect();
        self.change(&[], &shapes, &meshes);
    }

    fn change(&mut self, _: &[Event], shapes: &[Shape<'_>], meshes: &[ChangingMesh]) {
        self.bodies.clear();
        let mut compact = Vec::new();
        for (body, mesh) in (0..).zip(meshes) {
            let (triangles, numbers, vertices) = mesh.compact();
            if triangles.is_empty() {
                continue;
            }
            compact.push(triangles);
            self.bodies.push(Numbers {
                body,
                triangles: numbers,
                vertices,
            });
        }
        self.gather(shapes);
        let bodies = compact.iter().zip(&self.shapes);
        let bodies: Vec<_> = bodies
            .map(|(triangles, world)| BodyMesh {
                triangles,
                shape: shape(world),
            })
            .collect();
        self.method.build(&bodies);
    }

    fn step(&mut self, shapes: &[Shape<'_>]) {
        self.gather(shapes);
        let shapes: Vec<_> = self.shapes.iter().map(|world| shape(world)).collect();
        self.method.step(&shapes);
    }

    fn all_pairs(&mut self) -> &[Pair] {
        &[]
    }

    fn first_pair(&mut self) -> Option<Pair> {
        None
    }

    fn candidates(&mut self) -> Option<&[Pair]> {
        let found = self.method.candidates()?;
        let name = |body: u32, triangle: u32| {
            let numbers = &self.bodies[body as usize];
            (numbers.body, numbers.triangles[triangle as usize])
        };
        let named = |&[a, s, b, t]: &Pair| {
            let [(a, s), (b, t)] = [name(a, s), name(b, t)];
            [a, s, b, t]
        };
        self.pairs.clear();
        // The method's numbers are in the order of the original ones, so the list stays sorted.
        self.pairs.extend(found.iter().map(named));
        Some(&self.pairs)
    }

    fn take_counters(&mut self) -> Counters {
        self.method.take_counters()
    }
}

/// A method that is told of no change: new vertices are missing.
pub struct Unedited<M> {
    method: M,
    vertices: Vec<usize>,
}

impl<M> Unedited<M> {
    /// Wraps a method.
    pub fn new(method: M) -> Self {
        Self {
            method,
            vertices: Vec::new(),
        }
    }
}

impl<M: Method> Method for Unedited<M> {
    fn name(&self) -> String {
        format!("{}, without edits", self.method.name())
    }

    fn build(&mut self, bodies: &[BodyMesh<'_>]) {
        self.vertices = bodies.iter().map(|body| body.shape.world.len()).collect();
        self.method.build(bodies);
    }

    fn change(&mut self, _: &[Event], _: &[Shape<'_>], _: &[ChangingMesh]) {}

    fn step(&mut self, shapes: &[Shape<'_>]) {
        let known = shapes.iter().zip(&self.vertices);
        let shapes: Vec<_> = known
            .map(|(it, &vertices)| shape(&it.world[..vertices]))
            .collect();
        self.method.step(&shapes);
    }

    fn all_pairs(&mut self) -> &[Pair] {
        self.method.all_pairs()
    }

    fn first_pair(&mut self) -> Option<Pair> {
        self.method.first_pair()
    }

    fn candidates(&mut self) -> Option<&[Pair]> {
        self.method.candidates()
    }

    fn take_counters(&mut self) -> Counters {
        self.method.take_counters()
    }
}
