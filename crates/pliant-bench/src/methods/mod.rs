//! Methods of collision detection, one file or folder each.

mod aabb;
mod all_boxes;
mod answer;
mod bodies;
mod brute_force;
mod bucket_tree;
#[cfg(feature = "peers")]
mod changing_obvhs;
mod floor;
mod near;
#[cfg(feature = "peers")]
mod obvhs;
mod ours;
#[cfg(feature = "peers")]
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
#[cfg(feature = "peers")]
pub use changing_obvhs::ChangingObvhs;
pub use floor::Floor;
pub use near::NearSweep;
#[cfg(feature = "peers")]
pub use obvhs::{NearObvhs, Obvhs};
pub use ours::{Ours, Precision, add_step};
#[cfg(feature = "peers")]
pub use parry::{FarParry, NearParry, Parry};
pub use rebuilt::{Rebuilt, Unedited};
pub use smith::Smith;
pub use sweep::{Everywhere, Sweep};
pub use van_den_bergen::{Frame, VanDenBergen};
