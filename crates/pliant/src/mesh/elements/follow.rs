//! Stable numbers of edges in a mesh that is edited.
//!
//! An edge that stays keeps its number; a removed one leaves its number empty. A new edge takes the
//! lowest empty number, else the next. In tree order, elements stay with their triangle, even if it
//! is removed. So an edge of a live triangle may belong to a removed one. New elements belong to
//! the new triangles, which come behind all others.

use super::Elements;
use super::edge_index::{EdgeIndex, NO_EDGE, UNSEEN};
use crate::ids::TreeTriangle;
use crate::mesh::edges::sides;
use crate::mesh::{Bits, Order, Topology, TrianglesAt};
use std::collections::BTreeMap;

/// Triangle that an edit changes: its number, its corners before and after.
pub(crate) type Changed = (u32, [[u32; 3]; 2]);

impl Elements {
    /// Whether a number in tree order is an edge no more.
    #[inline]
    pub(crate) fn is_gone(&self, tree_edge: u32) -> bool {
        let index = self.index.as_ref();
        index.is_some_and(|index| index.gone.has(tree_edge))
    }

    /// Whether edits are followed.
    pub(crate) fn follows(&self) -> bool {
        self.index.is_some()
    }

    /// Builds the index that follows edits, unless it is there.
    pub(crate) fn begin_to_follow(&mut self, topology: &Topology) {
        let (callers, numbers) = (&self.callers, &self.numbers);
        self.index
            .get_or_insert_with(|| Box::new(EdgeIndex::new(callers, numbers, topology)));
    }

    /// Renumbers the sorted edges as `edges` has them: the same edges, with empty numbers among
    /// them.
    ///
    /// Returns false, and changes nothing, if the edges differ or edits are followed already.
    pub(crate) fn renumber(&mut self, edges: &[[u32; 2]], topology: &Topology) -> bool {
        let is_edge = |&(_, ends): &(u32, &[u32; 2])| *ends != NO_EDGE;
        let mut named: Vec<(u32, &[u32; 2])> = (0..).zip(edges).filter(is_edge).collect();
        named.sort_unstable_by_key(|&(_, ends)| ends);
        if self.follows() || !named.iter().map(|(_, ends)| *ends).eq(&self.callers) {
            return false;
        }
        if edges == self.callers {
            return true;
        }
        self.begin_to_follow(topology);
        let Some(index) = &mut self.index else {
            return false;
        };
        let sorted_edges = std::mem::replace(&mut index.tree_edges, vec![UNSEEN; edges.len()]);
        for (&(number, _), tree_edge) in named.iter().zip(sorted_edges) {
            index.tree_edges[number as usize] = tree_edge;
        }
        let of_triangles = index.of_triangles.as_flattened_mut().iter_mut();
        for number in of_triangles.chain(&mut self.numbers) {
            if *number != UNSEEN {
                *number = named[*number as usize].0;
            }
        }
        let empty = (0..).zip(edges).filter(|it| !is_edge(it));
        index.free = empty.map(|(number, _)| number).collect();
        self.callers = edges.to_vec();
        true
    }

    /// Updates the edges after triangles changed. `topology` and `at` are of the changed mesh;
    /// nothing has moved in tree order.
    pub(crate) fn follow(&mut self, changed: &[Changed], topology: &Topology, at: &TrianglesAt) {
        let Some(index) = &mut self.index else {
            return;
        };
        let mut before = BTreeMap::new();
        for &(triangle, [old, _]) in changed {
            let triangle = triangle as usize;
            if triangle >= index.of_triangles.len() {
                index.of_triangles.resize(triangle + 1, [UNSEEN; 3]);
            }
            let edges = std::mem::replace(&mut index.of_triangles[triangle], [UNSEEN; 3]);
            let known = sides(old).into_iter().zip(edges);
            before.extend(known.filter(|&(_, number)| number != UNSEEN));
        }
        for &(triangle, [_, new]) in changed {
            for (place, ends) in sides(new).into_iter().enumerate() {
                if ends[0] == ends[1] {
                    continue;
                }
                let known = before.get(&ends).copied();
                let known = known.or_else(|| index.find(at, topology, ends));
                let number = known.unwrap_or_else(|| {
                    let number = index.free.pop_first().unwrap_or(self.callers.len() as u32);
                    if number as usize == self.callers.len() {
                        self.callers.push(ends);
                        index.tree_edges.push(UNSEEN);
                    }
                    self.callers[number as usize] = ends;
                    before.insert(ends, number);
                    number
                });
                index.of_triangles[triangle as usize][place] = number;
            }
        }
        for (ends, number) in before {
            if index.find(at, topology, ends).is_none() {
                self.callers[number as usize] = NO_EDGE;
                index.free.insert(number);
                let tree_edge = &mut index.tree_edges[number as usize];
                if *tree_edge != UNSEEN {
                    index.gone.insert(*tree_edge);
                    *tree_edge = UNSEEN;
                }
            }
        }
        index.of_triangles.truncate(topology.triangles().len());
    }

    /// Assigns elements to the triangles from `first` on, which were replaced in tree order.
    ///
    /// Elements that belonged to the replaced triangles belong to these, unless they are gone. The
    /// triangles before use `used_before` vertices.
    pub(crate) fn append(
        &mut self,
        order: &Order,
        gone_triangles: &Bits,
        first: TreeTriangle,
        used_before: u32,
    ) {
        self.tree_vertices.take();
        let Some(mut index) = self.index.take() else {
            return;
        };
        let first_edge = self.firsts[first.index()][1];
        for (tree_edge, &number) in (first_edge..).zip(&self.numbers[first_edge as usize..]) {
            let known = &mut index.tree_edges[number as usize];
            if *known == tree_edge {
                *known = UNSEEN;
            }
        }
        index.gone.cut_back(first_edge);
        self.ends.truncate(first_edge as usize);
        self.numbers.truncate(first_edge as usize);
        self.firsts.truncate(first.index());
        let EdgeIndex {
            of_triangles,
            tree_edges,
            ..
        } = &mut *index;
        let numbers = |at: TreeTriangle| {
            if gone_triangles.has(at.0) {
                return [None; 3];
            }
            let edges = of_triangles[order.caller_triangle(at).index()];
            edges.map(|number| Some(number).filter(|&number| number != UNSEEN))
        };
        let is_new = |number: u32, next| {
            let known = &mut tree_edges[number as usize];
            let is_new = *known == UNSEEN;
            if is_new {
                *known = next;
            }
            is_new
        };
        // Nobody stops it.
        let _ = self.give_to_triangles(order, first, used_before, &|| false, numbers, is_new);
        self.index = Some(index);
    }
}
