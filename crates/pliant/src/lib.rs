//! pliant finds the collisions of triangle meshes that change their shape every time step.
mod broad_phase;
mod error;
mod geometry;
mod kernels;
mod mesh;
mod narrow_phase;
mod options;
mod pairs;
pub mod reference;
mod statistics;
mod traversal;
mod tree;
mod update;
mod world;

pub use error::{Error, ErrorKind};
pub use geometry::Scalar;
pub use options::{BroadPhase, Degree, Options, Partition, Update};
pub use pairs::Pair;
pub use statistics::Statistics;
pub use world::{BodyId, TreeShape, World};
