//! Face octree, never stored as a whole: cells are divided during the descent.
//!
//! Faces of all pending cells lie in one list, cell after cell, used as a stack. A cell is an
//! intersection of half-spaces: lower planes belong to it, upper planes do not, and cells at the
//! rim are unbounded. So every point lies in one cell, and comparing a box with the planes is
//! exact: nothing is rounded. Two overlapping boxes are tested in the cell with the lower corner of
//! their overlap; both hold that corner, so both faces get there. Lists keep faces body after body:
//! a cell has faces of two bodies if and only if the first and the last differ in body.

use crate::methods::aabb::Aabb;
use crate::methods::answer::Answer;
use crate::methods::bodies::Bodies;
use std::ops::ControlFlow;

/// A face that was kept.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Face {
    pub(super) bounds: Aabb,
    pub(super) body: u32,
    pub(super) triangle: u32,
}

/// The root cell, and the memory of a descent.
pub(super) struct Octree {
    depth: u32,
    root: Cell,
    ahead: Vec<Cell>,
    /// Faces of the pending cells, as places in the list of kept faces.
    lists: Vec<u32>,
    /// Bit set of the children that get a face, for each face of the cell being divided.
    children_of: Vec<u8>,
}

/// A pending cell.
#[derive(Clone, Copy, Debug)]
struct Cell {
    /// Range of its faces.
    start: usize,
    end: usize,
    /// Number of further divisions.
    depth_left: u32,
    /// Point of division, and its distance from the children's: a quarter of the side.
    centre: [f32; 3],
    quarter: f32,
    /// Lower planes, inclusive, and upper planes, exclusive.
    lo: [f32; 3],
    hi: [f32; 3],
}

impl Cell {
    const EVERYWHERE: Self = Self {
        start: 0,
        end: 0,
        depth_left: 0,
        centre: [0.0; 3],
        quarter: 0.0,
        lo: [f32::NEG_INFINITY; 3],
        hi: [f32::INFINITY; 3],
    };

    /// A child: bit `axis` of its number says whether it is the upper one there.
    fn child(&self, number: usize, start: usize, end: usize) -> Self {
        let mut child = Self {
            start,
            end,
            depth_left: self.depth_left - 1,
            quarter: 0.5 * self.quarter,
            ..*self
        };
        for axis in 0..3 {
            if number >> axis & 1 == 1 {
                child.lo[axis] = self.centre[axis];
                child.centre[axis] += self.quarter;
            } else {
                child.hi[axis] = self.centre[axis];
                child.centre[axis] -= self.quarter;
            }
        }
        child
    }

    /// Bit set of the children that a box meets.
    #[inline]
    fn children_met_by(&self, bounds: &Aabb) -> u8 {
        // Bit sets of the children in the lower and the upper half on x, y, z.
        const HALVES: [[u8; 2]; 3] = [[0x55, 0xaa], [0x33, 0xcc], [0x0f, 0xf0]];
        let on = |axis: usize| {
            let lower = u8::from(bounds.lo[axis] < self.centre[axis]).wrapping_neg();
            let upper = u8::from(bounds.hi[axis] >= self.centre[axis]).wrapping_neg();
            HALVES[axis][0] & lower | HALVES[axis][1] & upper
        };
        on(0) & on(1) & on(2)
    }

    #[inline]
    fn holds(&self, point: [f32; 3]) -> bool {
        (0..3).all(|axis| self.lo[axis] <= point[axis] && point[axis] < self.hi[axis])
    }
}

impl Octree {
    pub(super) fn new(depth: u32) -> Self {
        assert!(depth <= 16, "{depth} divisions of a cell");
        Self {
            depth,
            root: Cell::EVERYWHERE,
            ahead: Vec::new(),
            lists: Vec::new(),
            children_of: Vec::new(),
        }
    }

    pub(super) fn depth(&self) -> u32 {
        self.depth
    }

    /// Makes the root cell the smallest cube around a box, with the same centre.
    pub(super) fn cover(&mut self, all: &Aabb) {
        let side = (0..3).fold(0.0, |side: f32, axis| side.max(all.hi[axis] - all.lo[axis]));
        self.root = Cell {
            depth_left: self.depth,
            centre: std::array::from_fn(|axis| 0.5 * all.lo[axis] + 0.5 * all.hi[axis]),
            quarter: 0.25 * side,
            ..Cell::EVERYWHERE
        };
    }

    /// Proposes every pair of faces of different bodies whose boxes overlap, once.
    pub(super) fn descend(
        &mut self,
        faces: &[Face],
        bodies: &Bodies,
        answer: &mut Answer,
    ) -> ControlFlow<()> {
        self.lists.clear();
        self.lists.extend(0..faces.len() as u32);
        self.ahead.clear();
        if of_two_bodies(&self.lists, faces) {
            answer.counters.boxes += 1;
            self.ahead.push(Cell {
                end: faces.len(),
                ..self.root
            });
        }
        while let Some(cell) = self.ahead.pop() {
            // Lists behind this one belong to cells that are done.
            self.lists.truncate(cell.end);
            if cell.depth_left == 0 {
                let list = &self.lists[cell.start..];
                test_all(&cell, list, faces, bodies, answer)?;
            } else {
                answer.counters.box_tests += (cell.end - cell.start) as u64;
                answer.counters.boxes += self.divide(&cell, faces);
            }
        }
        ControlFlow::Continue(())
    }

    /// Makes the children that hold faces of two bodies pending. Returns their number.
    fn divide(&mut self, cell: &Cell, faces: &[Face]) -> u64 {
        let mine = cell.start..cell.end;
        // Bit sets of children: with a face, with a face before this body began, with faces of two
        // bodies.
        let (mut seen, mut seen_before, mut mixed) = (0, 0, 0);
        let mut body = u32::MAX;
        self.children_of.clear();
        for &face in &self.lists[mine.clone()] {
            let face = &faces[face as usize];
            let children = cell.children_met_by(&face.bounds);
            self.children_of.push(children);
            if face.body != body {
                body = face.body;
                seen_before = seen;
            }
            seen |= children;
            mixed |= seen_before & children;
        }
        for child in (0..8).filter(|child| mixed >> child & 1 == 1) {
            let start = self.lists.len();
            self.lists.resize(start + mine.len(), 0);
            let (known, own) = self.lists.split_at_mut(start);
            // Written always, and kept if it belongs to the child: no branch to mispredict.
            let mut count = 0;
            for (&face, &children) in known[mine.clone()].iter().zip(&self.children_of) {
                own[count] = face;
                count += usize::from(children >> child & 1);
            }
            self.lists.truncate(start + count);
            self.ahead.push(cell.child(child, start, start + count));
        }
        u64::from(mixed.count_ones())
    }
}

fn of_two_bodies(list: &[u32], faces: &[Face]) -> bool {
    match (list.first(), list.last()) {
        (Some(&first), Some(&last)) => faces[first as usize].body != faces[last as usize].body,
        _ => false,
    }
}

#[inline]
fn overlaps(a: &Aabb, b: &Aabb) -> bool {
    let on = |axis: usize| (a.lo[axis] <= b.hi[axis]) & (b.lo[axis] <= a.hi[axis]);
    on(0) & on(1) & on(2)
}

/// Tests every pair of faces of different bodies in a cell, if the pair belongs to this cell.
fn test_all(
    cell: &Cell,
    list: &[u32],
    faces: &[Face],
    bodies: &Bodies,
    answer: &mut Answer,
) -> ControlFlow<()> {
    let mut rest = list;
    while let [first, ..] = rest {
        let body = faces[*first as usize].body;
        let count = rest
            .iter()
            .position(|&face| faces[face as usize].body != body)
            .unwrap_or(rest.len());
        let (mine, others) = rest.split_at(count);
        rest = others;
        for a in mine.iter().map(|&face| &faces[face as usize]) {
            answer.counters.box_tests += others.len() as u64;
            for b in others.iter().map(|&face| &faces[face as usize]) {
                if overlaps(&a.bounds, &b.bounds) && cell.holds(a.bounds.overlap(&b.bounds).lo) {
                    let corners = |face: &Face| bodies.corners(face.body as usize, face.triangle);
                    let pair = [a.body, a.triangle, b.body, b.triangle];
                    answer.candidate(pair, &corners(a), &corners(b))?;
                }
            }
        }
    }
    ControlFlow::Continue(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn children_tile_their_parent() {
        let mut octree = Octree::new(2);
        octree.cover(&Aabb {
            lo: [-1.0; 3],
            hi: [3.0, 1.0, 0.0],
        });
        assert_eq!(octree.root.centre, [1.0, 0.0, -0.5]);
        let values = [-5.0, -1.0, 0.0, 0.999, 1.0, 1.001, 3.0, 4.0];
        for x in values {
            for y in values {
                let point = [x, y, -0.5];
                let at = Aabb {
                    lo: point,
                    hi: point,
                };
                let met = octree.root.children_met_by(&at);
                assert_eq!(met.count_ones(), 1);
                for child in 0..8 {
                    let cell = octree.root.child(child, 0, 0);
                    assert_eq!(cell.holds(point), met >> child & 1 == 1);
                }
            }
        }
    }

    #[test]
    fn a_box_across_the_centre_is_in_all_children_it_meets() {
        let mut octree = Octree::new(1);
        octree.cover(&Aabb {
            lo: [-1.0; 3],
            hi: [1.0; 3],
        });
        let met = |lo, hi| octree.root.children_met_by(&Aabb { lo, hi });
        assert_eq!(met([-0.5; 3], [0.5; 3]), 0xff);
        assert_eq!(met([-0.5; 3], [-0.1, 0.5, -0.1]), 0b101);
        // Touching from below counts as the upper child: the corner of an overlap would be there.
        assert_eq!(met([-0.5; 3], [0.0, -0.1, -0.1]), 0b011);
        assert_eq!(met([0.0; 3], [0.5; 3]), 0b1000_0000);
    }
}
