//! Making boxes true for the shape a body has now (paper, 3.3).
//!
//! One idea carries all three strategies of the paper: the boxes down to some level are made *ahead*, all at once and
//! bottom-up; what lies deeper is made top-down, when it is *reached*.
//!
//! ```text
//! bottom-up   ahead: down to the deepest leaf
//! top-down    ahead: the root only
//! hybrid      ahead: down to level floor(n / 2), or a given one, where n is the level of the deepest leaf
//! ```
//!
//! `hybrid` decides how far ahead, `bottom_up` makes some levels below a group, `top_down` makes what a traversal reaches.
//! Each returns the number of boxes it made, so that the strategies can be compared by their work.

mod bottom_up;
mod hybrid;
mod top_down;

pub(crate) use hybrid::refresh_ahead;
pub(crate) use top_down::reach_groups;
