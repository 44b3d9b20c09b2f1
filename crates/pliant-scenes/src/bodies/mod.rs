//! Bodies of the scenes, one a file: how each deforms.

mod armed;
mod bumpy;
mod folding;

pub(crate) use armed::ArmedSphere;
pub(crate) use bumpy::BumpySphere;
pub(crate) use folding::FoldingSheet;
