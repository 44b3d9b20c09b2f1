//! Lines of an experiment: a scene at some steps, with a query. Used by `near`, `close` and `when`.

use super::{Form, Planned, every, scene, whole};
use crate::contest::{Contender, Contest, Query};
use crate::method::Method;
use crate::motion::Motion;
use pliant_scenes::Scene;

/// A scene at some steps, and its query.
pub(super) struct Line<Q> {
    name: &'static str,
    scene: &'static str,
    /// Triangles a body, in full and in small form.
    triangles: [usize; 2],
    steps: Vec<u32>,
    pub(super) asked: Q,
}

impl<Q> Line<Q> {
    /// The two spheres.
    pub(super) fn spheres(name: &'static str, asked: Q) -> Self {
        Self {
            name,
            scene: "spheres",
            triangles: [20_480, 320],
            steps: every(20, 180),
            asked,
        }
    }

    /// The 27 spheres.
    pub(super) fn crowd(name: &'static str, asked: Q) -> Self {
        Self {
            scene: "crowd",
            triangles: [5_120, 320],
            steps: every(40, 160),
            ..Self::spheres(name, asked)
        }
    }

    /// The sheet that folds.
    pub(super) fn cloth(name: &'static str, asked: Q) -> Self {
        Self {
            scene: "cloth",
            triangles: [79_202, 648],
            steps: (35..=49).step_by(2).collect(),
            ..Self::spheres(name, asked)
        }
    }

    /// The line at other steps.
    #[cfg(feature = "peers")]
    pub(super) fn at(self, steps: impl IntoIterator<Item = u32>) -> Self {
        Self {
            steps: steps.into_iter().collect(),
            ..self
        }
    }

    /// The line with another number of triangles a body in full form.
    #[cfg(feature = "peers")]
    pub(super) fn of(self, triangles: usize) -> Self {
        Self {
            triangles: [triangles, self.triangles[1]],
            ..self
        }
    }

    /// The scene, and its motion from step to step.
    pub(super) fn played(&self, form: Form) -> (Scene, Motion) {
        let scene = scene(self.scene, self.triangles[usize::from(form == Form::Small)]);
        let motion = Motion::of_scene(&scene, self.steps.iter().copied());
        (scene, motion)
    }

    /// A contest of methods on a motion, with one window of all steps.
    pub(super) fn contest(
        &self,
        motion: Motion,
        query: Query,
        truth: impl Method + 'static,
        methods: impl Into<Vec<Contender>>,
    ) -> Contest {
        Contest {
            name: self.name.to_owned(),
            motion,
            query,
            truth: Box::new(truth),
            methods: methods.into(),
            windows: whole(&self.steps),
            cold: false,
        }
    }
}

/// Plans one contest of `methods` methods for each line. The small form has the last two steps.
pub(super) fn planned<Q: 'static>(
    lines: Vec<Line<Q>>,
    form: Form,
    methods: impl Fn(&Q) -> usize,
    contest: fn(&Line<Q>, Form) -> Contest,
) -> Vec<Planned> {
    let plan = |mut line: Line<Q>| {
        if form == Form::Small {
            line.steps.drain(..line.steps.len() - 2);
        }
        let methods = methods(&line.asked);
        Planned::new(methods, line.steps.len(), move || contest(&line, form))
    };
    lines.into_iter().map(plan).collect()
}
