//! The bumpy sphere: the body of the paper's first experiment, of the crowd and of the gathering.

use crate::bumps::{Bumps, LANES};
use crate::motion::{Moment, Path, Pose, Spin};
use crate::scene::Body;
use crate::vector::{Vec3, scale};

/// A unit sphere with wandering bumps that turns and moves.
#[derive(Debug)]
pub(crate) struct BumpySphere {
    pub(crate) bumps: Bumps,
    pub(crate) spin: Spin,
    pub(crate) path: Path,
}

impl Body for BumpySphere {
    fn place(&self, now: Moment, rest: &[Vec3], out: &mut [[f32; 3]]) {
        let pose = Pose::new(&self.spin, &self.path, now);
        for (points, out) in rest.chunks(LANES).zip(out.chunks_mut(LANES)) {
            let heights = self.bumps.heights(now.step, points);
            for ((point, height), out) in points.iter().zip(heights).zip(out) {
                *out = pose.place(scale(*point, 1.0 + height));
            }
        }
    }
}
