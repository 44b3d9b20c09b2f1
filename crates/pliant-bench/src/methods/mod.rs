//! One file or folder a method.

mod aabb;
mod all_boxes;
mod answer;
mod bodies;
mod brute_force;
mod bucket_tree;
mod changing_obvhs;
mod floor;
mod near;
mod obvhs;
mod ours;
mod parry;
mod plain_distance;
mod rebuilt;
mod region;
mod smith;
mod sweep;
mod triangle_box;
mod van_den_bergen;

pub use all_boxes::AllBoxes;
pub use brute_force::BruteForce;
pub use bucket_tree::BucketTree;
pub use changing_obvhs::ChangingObvhs;
pub use floor::Floor;
pub use near::NearSweep;
pub use obvhs::{NearObvhs, Obvhs};
pub use ours::{Ours, Precision, add_step};
pub use parry::{FarParry, NearParry, Parry};
pub use rebuilt::{Rebuilt, Unedited};
pub use smith::Smith;
pub use sweep::{Everywhere, Sweep};
pub use van_den_bergen::{Frame, VanDenBergen};
