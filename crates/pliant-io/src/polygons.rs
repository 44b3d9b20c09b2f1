//! Connectivity of a body: polygons as triangle fans, recorded once and compared in later frames.
//!
//! A fan goes round the polygon's first corner: a b c d e gives (a b c) (a c d) (a d e). The
//! triangles of a polygon follow each other in the list, which is enough to rebuild it. Once all
//! positions of the first frame are known, polygons whose fan would be wrong get other triangles;
//! their corners are then kept.

use std::collections::BTreeMap;

use crate::error::{Fault, Place, Reason};
use crate::memory::Account;
use crate::note::Note;
use crate::positions::Positions;
use crate::triangulate::{self, Cut};

/// Connectivity of a body as in its files, before welding.
#[derive(Debug)]
pub(crate) struct Polygons {
    triangles: Vec<[u32; 3]>,
    /// Polygon of each triangle; None until a polygon with more than three corners comes.
    faces: Option<Vec<u32>>,
    /// Corners of the polygons that are no fans, by number.
    outlines: BTreeMap<u32, Vec<u32>>,
    count: u64,
    comparing: bool,
    /// Number of polygons and triangles in this frame so far.
    met: u64,
    met_triangles: usize,
    largest: Option<Largest>,
    /// Reused buffer: the corners of a large polygon, sorted.
    sorted: Vec<u32>,
    /// Number of polygons of the first frame with two corners, and the first of them.
    segments: (usize, usize),
}

/// Polygons up to this many corners may repeat corners freely.
const MOST_UNCOUNTED: usize = 64;

/// Average visits per corner allowed in larger polygons.
///
/// A hole is tied to its rim by an edge there and back, which visits two corners twice. A
/// triangular hole has five corners, three of them different.
const MOST_VISITS: usize = 3;

/// The largest index of this frame, and a face that uses it.
///
/// Faces may come before vertices, so the valid range is known only at the end.
#[derive(Debug)]
struct Largest {
    index: u32,
    face: u64,
    place: Place,
}

impl Polygons {
    pub(crate) fn new() -> Self {
        Self {
            triangles: Vec::new(),
            faces: None,
            outlines: BTreeMap::new(),
            count: 0,
            comparing: false,
            met: 0,
            met_triangles: 0,
            largest: None,
            sorted: Vec::new(),
            segments: (0, 0),
        }
    }

    /// Makes later polygons be compared with the recorded ones.
    pub(crate) fn compare_from_now_on(&mut self) {
        self.comparing = true;
        self.triangles.shrink_to_fit();
    }

    /// Begins a frame.
    pub(crate) fn rewind(&mut self) {
        self.met = 0;
        self.met_triangles = 0;
        self.largest = None;
    }

    /// Declares that this frame has the recorded polygons: files with one list of faces for many
    /// frames.
    pub(crate) fn repeat(&mut self) {
        self.met = self.count;
    }

    /// Appends the next polygon, or compares it with the recorded one; false where they differ.
    ///
    /// `place` is where it is written.
    pub(crate) fn push(
        &mut self,
        corners: &[u32],
        place: impl FnOnce() -> Place,
        account: &mut Account,
    ) -> Result<bool, Reason> {
        // A segment is a triangle with two corners in one vertex.
        let segment;
        let corners = if let &[a, b] = corners {
            if !self.comparing {
                let (count, first) = self.segments;
                let first = if count == 0 { self.met as usize } else { first };
                self.segments = (count + 1, first);
            }
            segment = [a, b, b];
            &segment
        } else {
            corners
        };
        let &[apex, ref rim @ ..] = corners else {
            return Err(self.too_few(0));
        };
        if rim.is_empty() {
            return Err(self.too_few(1));
        }
        if corners.len() > MOST_UNCOUNTED {
            self.check_corners(corners)?;
        }
        let index = rim
            .iter()
            .fold(apex, |largest, &corner| largest.max(corner));
        if self
            .largest
            .as_ref()
            .is_none_or(|largest| index > largest.index)
        {
            let (face, place) = (self.met, place());
            self.largest = Some(Largest { index, face, place });
        }
        let fan = rim.windows(2).map(|edge| [apex, edge[0], edge[1]]);
        let equal = if self.comparing {
            self.compare(corners, fan)
        } else {
            self.record(fan, account).map(|()| true)?
        };
        self.met += 1;
        Ok(equal)
    }

    /// Refuses a large polygon that runs to and fro between few corners.
    ///
    /// No surface has one. All triangles of its fan share vertices, so the intersection test would
    /// take quadratic time to find that no pair counts.
    fn check_corners(&mut self, corners: &[u32]) -> Result<(), Reason> {
        let sorted = &mut self.sorted;
        sorted.clear();
        sorted.extend(corners);
        sorted.sort_unstable();
        sorted.dedup();
        let (face, corners, different) = (self.met, corners.len(), sorted.len());
        if corners > MOST_VISITS * different {
            return Err(Reason::RepeatedCorners {
                face,
                corners,
                different,
            });
        }
        Ok(())
    }

    fn too_few(&self, corners: usize) -> Reason {
        Reason::FewCorners {
            face: self.met,
            corners,
        }
    }

    fn record(
        &mut self,
        fan: impl ExactSizeIterator<Item = [u32; 3]>,
        account: &mut Account,
    ) -> Result<(), Reason> {
        let polygon = u32::try_from(self.count).map_err(|_| Reason::TooMany { what: "faces" })?;
        let size = fan.len();
        if self.triangles.len() + size > u32::MAX as usize {
            return Err(Reason::TooMany { what: "triangles" });
        }
        if size > 1 && self.faces.is_none() {
            let mut faces = Vec::new();
            for triangle in 0..polygon {
                // Until here every polygon was one triangle.
                account.push(&mut faces, triangle, 0)?;
            }
            self.faces = Some(faces);
        }
        for triangle in fan {
            account.push(&mut self.triangles, triangle, 0)?;
        }
        if let Some(faces) = &mut self.faces {
            for _ in 0..size {
                account.push(faces, polygon, 0)?;
            }
        }
        self.count += 1;
        Ok(())
    }

    fn compare(&mut self, corners: &[u32], fan: impl ExactSizeIterator<Item = [u32; 3]>) -> bool {
        if self.met >= self.count {
            return true; // one too many: counted, and reported with both counts at the end
        }
        let begin = self.met_triangles;
        let size = match &self.faces {
            None => 1,
            Some(faces) => faces[begin..]
                .iter()
                .take_while(|&&polygon| u64::from(polygon) == self.met)
                .count(),
        };
        self.met_triangles += size;
        if let Some(outline) = self.outlines.get(&(self.met as u32)) {
            return outline == corners;
        }
        self.triangles[begin..self.met_triangles]
            .iter()
            .copied()
            .eq(fan)
    }

    /// Triangulates polygons by their positions in the first frame; notes doubtful ones.
    pub(crate) fn shape(
        &mut self,
        positions: Positions<'_>,
        account: &mut Account,
    ) -> Result<Vec<Note>, Reason> {
        let (count, first) = self.segments;
        let segments = (count > 0).then_some(Note::Segments { count, first });
        let Some(faces) = &self.faces else {
            return Ok(segments.into_iter().collect());
        };
        let (mut bent, mut crossed) = (Vec::new(), Vec::new());
        let (mut corners, mut points) = (Vec::new(), Vec::new());
        let mut begin = 0;
        for same in faces.chunk_by(|a, b| a == b) {
            let triangles = &mut self.triangles[begin..begin + same.len()];
            begin += same.len();
            if let [_] = triangles {
                continue;
            }
            corners.clear();
            corners.extend(triangles[0]);
            corners.extend(triangles[1..].iter().map(|triangle| triangle[2]));
            points.clear();
            points.extend(corners.iter().map(|&corner| positions.get(corner)));
            if triangulate::is_bent(&points) {
                bent.push(same[0]);
            }
            match triangulate::cut(&points, |i, j| corners[i] == corners[j]) {
                Cut::Fan => {}
                Cut::Crossed => crossed.push(same[0]),
                Cut::Other(others) => {
                    for (triangle, other) in triangles.iter_mut().zip(others) {
                        *triangle = other.map(|corner| corners[corner]);
                    }
                    // A rough size of the map entry.
                    account.enter((64 + size_of_val(&corners[..])) as u64)?;
                    self.outlines.insert(same[0], corners.clone());
                }
            }
        }
        let first = |polygons: &[u32]| polygons.first().map(|&first| first as usize);
        let bent = first(&bent).map(|first| Note::BentPolygons {
            count: bent.len(),
            first,
        });
        let crossed = first(&crossed).map(|first| Note::CrossedPolygons {
            count: crossed.len(),
            first,
        });
        Ok(segments.into_iter().chain(bent).chain(crossed).collect())
    }

    /// Corners of the polygons that are no fans.
    pub(crate) fn outlines(&self) -> &BTreeMap<u32, Vec<u32>> {
        &self.outlines
    }

    /// Checks that every index of this frame is below `vertices`.
    ///
    /// Messages count vertices from `first`, as the file does.
    pub(crate) fn check_range(&self, vertices: usize, first: i64) -> Result<(), Fault> {
        match &self.largest {
            Some(largest) if largest.index as usize >= vertices => {
                let reason = Reason::VertexIndex {
                    face: largest.face,
                    index: i64::from(largest.index) + first,
                    first,
                    last: i64::try_from(vertices).unwrap_or(i64::MAX) + first - 1,
                };
                Err(reason.at(largest.place.clone()))
            }
            _ => Ok(()),
        }
    }

    /// Number of polygons of this frame so far, and of the body.
    pub(crate) fn counts(&self) -> (u64, u64) {
        (self.met, self.count)
    }

    /// Number of the next polygon of this frame.
    pub(crate) fn next_face(&self) -> u64 {
        self.met
    }

    pub(crate) fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    pub(crate) fn faces(&self) -> Option<&[u32]> {
        self.faces.as_deref()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn account() -> Account {
        Account::new(1 << 20)
    }

    fn recorded(polygons: &[&[u32]]) -> Polygons {
        let mut recorded = Polygons::new();
        for corners in polygons {
            assert!(
                recorded
                    .push(corners, || Place::File, &mut account())
                    .unwrap()
            );
        }
        recorded
    }

    fn compared(first: &[&[u32]], second: &[&[u32]]) -> Vec<bool> {
        let mut polygons = recorded(first);
        polygons.compare_from_now_on();
        polygons.rewind();
        second
            .iter()
            .map(|corners| {
                polygons
                    .push(corners, || Place::File, &mut account())
                    .unwrap()
            })
            .collect()
    }

    #[test]
    fn triangles_alone_need_no_faces() {
        let polygons = recorded(&[&[0, 1, 2], &[2, 1, 3]]);
        assert_eq!(polygons.triangles(), [[0, 1, 2], [2, 1, 3]]);
        assert_eq!(polygons.faces(), None);
    }

    #[test]
    fn fans_go_round_the_first_corner() {
        let polygons = recorded(&[&[0, 1, 2], &[5, 6, 7, 8, 9], &[3, 4, 5], &[1, 2, 3, 4]]);
        let triangles = [
            [0, 1, 2],
            [5, 6, 7],
            [5, 7, 8],
            [5, 8, 9],
            [3, 4, 5],
            [1, 2, 3],
            [1, 3, 4],
        ];
        assert_eq!(polygons.triangles(), triangles);
        assert_eq!(polygons.faces(), Some(&[0, 1, 1, 1, 2, 3, 3][..]));
    }

    #[test]
    fn fewer_than_two_corners_are_refused() {
        let mut polygons = recorded(&[&[0, 1, 2]]);
        for corners in [&[][..], &[1]] {
            let refused = polygons.push(corners, || Place::File, &mut account());
            assert!(matches!(
                refused,
                Err(Reason::FewCorners { face: 1, corners: n }) if n == corners.len()
            ));
        }
    }

    #[test]
    fn two_corners_are_a_segment() {
        let polygons = recorded(&[&[0, 1, 2], &[3, 1], &[0, 1, 2, 3], &[2, 2]]);
        let triangles = [[0, 1, 2], [3, 1, 1], [0, 1, 2], [0, 2, 3], [2, 2, 2]];
        assert_eq!(polygons.triangles(), triangles);
        assert_eq!(polygons.faces(), Some(&[0, 1, 2, 2, 3][..]));
        assert_eq!(polygons.segments, (2, 1));
        assert_eq!(
            compared(&[&[0, 1, 2], &[3, 1]], &[&[0, 1, 2], &[1, 3]]),
            [true, false]
        );
    }

    #[test]
    fn large_polygons_between_few_corners_are_refused() {
        let push = |corners: &[u32]| {
            let pushed = Polygons::new().push(corners, || Place::File, &mut account());
            pushed.map(|_| ()).map_err(|reason| reason.to_string())
        };
        let to_and_fro = |count: u32, different: u32| -> Vec<u32> {
            (0..count).map(|corner| corner % different).collect()
        };
        assert_eq!(
            push(&to_and_fro(80_000, 2)).unwrap_err(),
            "face 0 visits 2 vertices 80000 times in all, which no face of a surface does"
        );
        for (count, different, is_taken) in [
            (64, 2, true),
            (65, 21, false),
            (66, 22, true),
            (1000, 1000, true),
        ] {
            assert_eq!(
                push(&to_and_fro(count, different)).is_ok(),
                is_taken,
                "{count}"
            );
        }
        // A sheet with a thousand triangular holes, each tied to its first corner.
        let hole = |first: u32| [0, first, first + 1, first + 2, first];
        let sheet: Vec<u32> = (4..3004).step_by(3).flat_map(hole).chain(0..4).collect();
        assert!(push(&sheet).is_ok());
    }

    #[test]
    fn later_frames_are_compared_polygon_by_polygon() {
        let quads: &[&[u32]] = &[&[0, 1, 2], &[0, 1, 2, 3], &[0, 1, 2]];
        assert_eq!(compared(quads, quads), [true, true, true]);
        assert_eq!(
            compared(quads, &[&[0, 1, 2], &[0, 1, 3, 2], &[0, 1, 2]]),
            [true, false, true]
        );
        // The same triangles, grouped into other polygons.
        assert_eq!(
            compared(quads, &[&[0, 1, 2], &[0, 1, 2], &[0, 2, 3]]),
            [true, false, false]
        );
        assert_eq!(
            compared(&[&[0, 1, 2], &[0, 2, 3]], &[&[0, 1, 2, 3]]),
            [false]
        );
    }

    #[test]
    fn the_largest_index_decides_the_range() {
        let mut polygons = Polygons::new();
        polygons
            .push(&[0, 1, 2], || Place::Line(1), &mut account())
            .unwrap();
        polygons
            .push(&[0, 9, 2], || Place::Line(2), &mut account())
            .unwrap();
        polygons
            .push(&[0, 9, 8], || Place::Line(3), &mut account())
            .unwrap();
        assert!(polygons.check_range(10, 1).is_ok());
        let fault = polygons.check_range(9, 1).unwrap_err();
        assert_eq!(fault.place, Place::Line(2));
        assert!(matches!(
            fault.reason,
            Reason::VertexIndex {
                face: 1,
                index: 10,
                first: 1,
                last: 9
            }
        ));
    }
}
