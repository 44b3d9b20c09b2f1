//! Scenes of both kinds: with fixed meshes, or with meshes that change.

use super::query::Query;
use anyhow::bail;
use pliant::{BodyId, Scalar, World};
use pliant_bench::methods::add_step;
use pliant_io::shown;
use pliant_scenes::{Asks, ChangingScene, Event, Scene};

/// A scene to play.
pub(super) enum AnyScene {
    Still(Scene),
    Changing(ChangingScene),
}

impl AnyScene {
    pub(super) fn new(name: &str, triangles: Option<usize>, seed: u64) -> anyhow::Result<Self> {
        if ChangingScene::NAMES.contains(&name) {
            let scene = ChangingScene::new(name, triangles, seed)?;
            return Ok(Self::Changing(scene));
        }
        // The library's error names scenes of one kind alone.
        if !Scene::NAMES.contains(&name) {
            let names = [Scene::NAMES, ChangingScene::NAMES].concat().join(", ");
            let name = shown(name);
            bail!("there is no scene \"{name}\"; there are {names}; choose one of these");
        }
        Ok(Self::Still(Scene::new(name, triangles, seed)?))
    }

    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Still(scene) => scene.name(),
            Self::Changing(scene) => scene.name(),
        }
    }

    pub(super) fn steps(&self) -> u32 {
        match self {
            Self::Still(scene) => scene.steps(),
            Self::Changing(scene) => scene.steps(),
        }
    }

    /// The query that is asked by default.
    pub(super) fn query(&self) -> Query {
        match self {
            Self::Changing(_) => Query::Everything,
            Self::Still(scene) => match scene.asks() {
                Asks::BetweenBodies => Query::All,
                Asks::Itself => Query::Itself,
            },
        }
    }

    /// Number of bodies at the beginning.
    pub(super) fn body_count(&self) -> usize {
        match self {
            Self::Still(scene) => scene.body_count(),
            Self::Changing(scene) => scene.body_count(),
        }
    }

    /// Triangles of a body at the beginning.
    pub(super) fn triangles(&self, body: usize) -> &[[u32; 3]] {
        match self {
            Self::Still(scene) => scene.triangles(body),
            Self::Changing(scene) => scene.triangles(body),
        }
    }

    /// Positions of a body when its tree is built, whichever steps are played.
    pub(super) fn first_positions(&self, body: usize, out: &mut Vec<[f32; 3]>) {
        match self {
            Self::Still(scene) => scene.positions(body, 1, out),
            Self::Changing(scene) => *out = scene.first_positions(body),
        }
    }

    /// Positions of a body at a step; empty once it is fused with another.
    pub(super) fn positions(&self, body: usize, step: u32, out: &mut Vec<[f32; 3]>) {
        match self {
            Self::Still(scene) => scene.positions(body, step, out),
            Self::Changing(scene) => scene.positions(body, step, out),
        }
    }

    /// Whether any mesh changes in a step.
    pub(super) fn changes(&self, step: u32) -> bool {
        matches!(self, Self::Changing(scene) if !scene.events(step).is_empty())
    }

    /// Applies the mesh changes of a step to a world. `shapes` are the positions in that step.
    pub(super) fn change<S: Scalar>(
        &self,
        world: &mut World<S>,
        bodies: &[BodyId],
        step: u32,
        shapes: &[Vec<[S; 3]>],
    ) -> Result<(), pliant::Error> {
        let Self::Changing(scene) = self else {
            return Ok(());
        };
        for event in scene.events(step) {
            match event {
                Event::Edit { body, changes } => {
                    let mut edit = world.edit(bodies[*body])?;
                    let at = &shapes[*body];
                    changes
                        .iter()
                        .for_each(|change| add_step(&mut edit, change, at));
                    world.apply(&edit)?;
                }
                Event::Fuse { kept, gone } => {
                    world.fuse(bodies[*kept], bodies[*gone])?;
                }
            }
        }
        Ok(())
    }
}
