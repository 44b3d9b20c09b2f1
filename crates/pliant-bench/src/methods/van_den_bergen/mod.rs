//! Van den Bergen 1997: AABB trees with a complete refit of every box in each step.
//!
//! *Efficient Collision Detection of Complex Deformable Models using AABB Trees*, the method that
//! the paper compares with. Whatever the frame, triangles are decided on world positions. Boxes are
//! enlarged by a proven bound, so no pair is lost (`relation`). All is scalar and in single
//! precision, as it was.
//!
//! | part | how |
//! |---|---|
//! | trees | one triangle a leaf; a node has the boxes of its children, centre and half extent |
//! | step | complete refit of all bodies, children before parents |
//! | bodies | brute force over the world boxes of the root boxes |
//! | descent | the larger node is opened; stops at the first pair if asked to (`descent`) |
//! | box test | local frame: six axes, set up once a pair of bodies; world frame: three |
//!
//! - **Local frame** is the published method: trees in the frame of the body, oriented in the
//!   world. A body without a pose has its local frame in the world.
//! - **World frame** is the method where the application deforms bodies in the world, as the
//!   paper's own method wants it. It is the harder rival.
//! - **Four and eight children** are the wide version that the paper mentions, with the same step
//!   and test.

mod centre_box;
mod descent;
mod relation;
mod tree;

use crate::decision::Decision;
use crate::methods::aabb::Aabb;
use crate::methods::answer::{Answer, Proposer, self_pair};
use crate::motion::{BodyMesh, Pose, Shape};
use centre_box::CentreBox;
use descent::{Stack, one_tree, two_trees};
use pliant::Degree;
use relation::{Aligned, Oriented};
use std::ops::ControlFlow;
use tree::Tree;

/// Frame in which the boxes of a body are axis-aligned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// The body's own frame: boxes are oriented in the world, six axes.
    Local,
    /// The world: three axes.
    World,
}

/// Trees of boxes with a complete refit every step.
pub struct VanDenBergen {
    frame: Frame,
    degree: Degree,
    bodies: Vec<Body>,
    stack: Stack,
    answer: Answer,
}

impl VanDenBergen {
    /// Trees in this frame, with this degree and triangle test. `Frame::Local` and `Degree::Two`
    /// are published.
    pub fn new(frame: Frame, degree: Degree, decision: Decision) -> Self {
        Self {
            frame,
            degree,
            bodies: Vec::new(),
            stack: Stack::new(),
            answer: Answer::new(decision),
        }
    }
}

impl Proposer for VanDenBergen {
    fn name(&self) -> String {
        let frame = match self.frame {
            Frame::Local => "local",
            Frame::World => "world",
        };
        let degree = match self.degree {
            Degree::Two => "binary",
            Degree::Four => "4-ary",
            Degree::Eight => "8-ary",
        };
        format!("van den Bergen ({frame} frame, {degree})")
    }

    fn build(&mut self, bodies: &[BodyMesh<'_>]) {
        let halvings = self.degree.get().ilog2();
        self.bodies = bodies
            .iter()
            .map(|body| Body::build(body, self.frame, halvings))
            .collect();
    }

    fn step(&mut self, shapes: &[Shape<'_>]) {
        for (body, shape) in self.bodies.iter_mut().zip(shapes) {
            body.take_over(shape, self.frame);
            self.answer.counters.boxes += body.tree.all().len() as u64;
        }
    }

    fn between_bodies(&mut self) -> ControlFlow<()> {
        let Self { answer, stack, .. } = self;
        for (i, a) in self.bodies.iter().enumerate() {
            for (j, b) in self.bodies.iter().enumerate().skip(i + 1) {
                if !a.bounds.overlaps(&b.bounds) {
                    continue;
                }
                let mut tests = 0;
                let leaves = |s, t| {
                    let pair = [i as u32, a.tree.number(s), j as u32, b.tree.number(t)];
                    answer.candidate(pair, &a.corners(s), &b.corners(t))
                };
                let (trees, slack) = ([&a.tree, &b.tree], [a.slack, b.slack]);
                let flow = match self.frame {
                    Frame::World => {
                        two_trees(trees, &Aligned::new(slack), stack, &mut tests, leaves)
                    }
                    Frame::Local => {
                        let relation = Oriented::new(&a.pose, &b.pose, slack);
                        two_trees(trees, &relation, stack, &mut tests, leaves)
                    }
                };
                answer.counters.box_tests += tests;
                flow?;
            }
        }
        ControlFlow::Continue(())
    }

    fn within_bodies(&mut self) -> ControlFlow<()> {
        let Self { answer, stack, .. } = self;
        for (number, body) in self.bodies.iter().enumerate() {
            let mut tests = 0;
            let leaves = |s, t| {
                if body.tree.share_a_vertex(s, t) {
                    return ControlFlow::Continue(());
                }
                let pair = self_pair(number, body.tree.number(s), body.tree.number(t));
                answer.candidate(pair, &body.corners(s), &body.corners(t))
            };
            // One body has one frame: three axes, whichever it is.
            let relation = Aligned::new([body.slack; 2]);
            one_tree(&body.tree, &relation, stack, &mut tests, leaves)?;
            answer.counters.box_tests += tests;
        }
        ControlFlow::Continue(())
    }

    fn answer(&mut self) -> &mut Answer {
        &mut self.answer
    }
}

/// A body in the shape of the last step.
struct Body {
    tree: Tree,
    pose: Pose,
    /// World positions in the tree's order, on which triangles are decided.
    world: Vec<[f32; 3]>,
    /// Positions in the frame of the boxes, in the tree's order; empty if that is the world.
    local: Vec<[f32; 3]>,
    /// Possible cost of rounding: see `relation`.
    slack: f64,
    /// World box of the root.
    bounds: Aabb,
}

impl Body {
    fn build(body: &BodyMesh<'_>, frame: Frame, halvings: u32) -> Self {
        let positions = match frame {
            Frame::World => body.shape.world,
            Frame::Local => local(&body.shape).1,
        };
        let mut own = Self {
            tree: Tree::build(body.triangles, positions, halvings),
            pose: Pose::IDENTITY,
            world: Vec::new(),
            local: Vec::new(),
            slack: 0.0,
            bounds: Aabb::EMPTY,
        };
        own.take_over(&body.shape, frame);
        own
    }

    /// Takes a new shape, and refits all boxes.
    fn take_over(&mut self, shape: &Shape<'_>, frame: Frame) {
        self.tree.take_over(shape.world, &mut self.world);
        match frame {
            Frame::World => self.tree.refit(&self.world),
            Frame::Local => {
                let (pose, local) = local(shape);
                self.pose = pose;
                self.tree.take_over(local, &mut self.local);
                self.tree.refit(&self.local);
            }
        }
        let (root, levels) = (self.tree.root(), self.tree.levels());
        let pose = (frame == Frame::Local).then_some(&self.pose);
        self.slack = relation::slack(root, levels, pose);
        self.bounds = placed(root, &self.pose, self.slack);
        debug_assert!(self.is_placed_as_promised());
    }

    #[inline]
    fn corners(&self, triangle: u32) -> [[f32; 3]; 3] {
        self.tree.corners(triangle, &self.world)
    }

    /// Whether local and world positions belong together, which the bound on boxes needs.
    fn is_placed_as_promised(&self) -> bool {
        self.local.iter().zip(&self.world).all(|(local, world)| {
            let placed = self.pose.place(local.map(f64::from));
            (0..3).all(|axis| (placed[axis] - f64::from(world[axis])).abs() <= self.slack)
        })
    }
}

/// Pose and local positions; a body without a pose has its local frame in the world.
fn local<'a>(shape: &Shape<'a>) -> (Pose, &'a [[f32; 3]]) {
    shape.rigid.map_or((Pose::IDENTITY, shape.world), |rigid| {
        (rigid.pose, rigid.local)
    })
}

/// World box around a box that is oriented there, enlarged by `slack`.
fn placed(bounds: &CentreBox, pose: &Pose, slack: f64) -> Aabb {
    let centre = pose.place(bounds.centre.map(f64::from));
    let half = pose.rotation.map(|row| {
        let along = |axis: usize| row[axis].abs() * f64::from(bounds.half[axis]);
        along(0) + along(1) + along(2) + slack
    });
    Aabb {
        lo: std::array::from_fn(|axis| ((centre[axis] - half[axis]) as f32).next_down()),
        hi: std::array::from_fn(|axis| ((centre[axis] + half[axis]) as f32).next_up()),
    }
}
