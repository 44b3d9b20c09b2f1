//! Bumpy sphere: the body of the paper's first experiment, of the crowd and of the gathering.

use crate::bumps::{Bumps, LANES};
use crate::motion::{Moment, Path, Pose, Spin, rounded};
use crate::scene::Body;
use crate::vector::{Vec3, scale};

/// A unit sphere with wandering bumps that turns and moves.
#[derive(Debug)]
pub(crate) struct BumpySphere {
    pub(crate) bumps: Bumps,
    pub(crate) spin: Spin,
    pub(crate) path: Path,
}

impl BumpySphere {
    /// Points of the body in its own frame, each converted by `finish`.
    #[inline]
    fn shape(
        &self,
        now: Moment,
        rest: &[Vec3],
        out: &mut [[f32; 3]],
        finish: impl Fn(Vec3) -> [f32; 3],
    ) {
        for (points, out) in rest.chunks(LANES).zip(out.chunks_mut(LANES)) {
            let heights = self.bumps.heights(now.step, points);
            for ((point, height), out) in points.iter().zip(heights).zip(out) {
                *out = finish(scale(*point, 1.0 + height));
            }
        }
    }
}

impl Body for BumpySphere {
    fn place(&self, now: Moment, rest: &[Vec3], out: &mut [[f32; 3]]) {
        let pose = Pose::new(&self.spin, &self.path, now);
        self.shape(now, rest, out, |p| pose.place(p));
    }

    fn pose(&self, now: Moment) -> Option<Pose> {
        Some(Pose::new(&self.spin, &self.path, now))
    }

    fn place_in_own_frame(&self, now: Moment, rest: &[Vec3], out: &mut [[f32; 3]]) {
        self.shape(now, rest, out, rounded);
    }
}
