"""The exception, and the answers whose fields have names: easier in Python than in Rust."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from operator import index
from typing import Any, NamedTuple, Protocol, SupportsIndex

import numpy as np
from numpy.typing import ArrayLike, NDArray


class Error(ValueError):
    """A refused call: its kind, and the facts as attributes. The world is as it was before.

    Facts that do not apply are None. kind is one of these. Of a mesh and its positions:

      NoTriangles       a body needs at least one triangle
      TooLarge          more triangles, vertices or pairs than there may be: what, count, limit
      TooManyBodies     all 2^32 numbers of bodies were used
      VertexOutOfRange  a triangle names a vertex that is not there: triangle, vertex, vertices
      WrongLength       not one position or group for each vertex: what, expected, found
      BadPosition       a coordinate is NaN, infinite or above 3.4e38: vertex, position
      NeedsSubnormals   a coordinate is so small that this thread would take it for zero: vertex
      NotWritten        World.write_positions left a vertex unwritten: vertex
      OutsideLooseBox   a vertex is outside the loose box of its body: vertex, position
      BadLooseBox       corners not finite, or the lower above the upper
      Precision         float64 positions in a float32 world
      BadArray          an array of a wrong shape or dtype, or with masked numbers
      BadThickness      a thickness is negative, infinite or NaN: vertex, thickness

    Of a question:

      NoSuchBody        no body has this number: it was removed, or is of another world
      SameBody          one body was given as two
      TooManyHits       a list would be longer than at_most: limit
      BadMargin         radius is negative, infinite or NaN
      BadDistance       a distance is negative, infinite or NaN
      BadWidth          width is negative, infinite or NaN
      BadTime           a time is not from 0 to 1
      DifferentCounts   start and end have different numbers of pairs
      BadCorner         a coordinate of a pair is NaN, infinite or above 3.4e38
      BadPoint          a coordinate of a point is NaN, infinite or above 3.4e38: point, position
      NotClosed         a body has no inside: some_edges, count
      Busy              the world is answering another call
      BadOption         an option has no such value

    Of an edit:

      NoSuchTriangle    triangle, triangles
      EmptyTriangle     the triangle was removed: triangle
      NoSuchVertex      vertex, vertices
      NoSuchEdge        edge, edges
      NoSuchHit         a hit names an element that its body does not have: hit
      MissingEdge       edges lack one of the mesh: ends
      NotAnEdge         edges have one that the mesh has not, or have it twice: edge, ends
      EditedMesh        edges are numbered before a mesh is edited
      EmptyVertex       the vertex went with its last triangle: vertex
      VertexInUse       a vertex that is placed is not empty: vertex
      NotACorner        a vertex that is split is no corner of the triangle: triangle, vertex
      OutdatedEdit      the mesh was changed since the edit began, or the edit is of another world

    Of files, and of pliant itself:

      CannotRead        a file: file, place, frame
      Broken            a bug of pliant; please report it

    Ctrl-C during a query is no Error but KeyboardInterrupt, as everywhere.
    """

    #: What was wrong, one of the names above.
    kind: str | None
    #: The body that the call was about; None for a new one.
    body: int | None = None
    #: The triangle, counted from 0.
    triangle: int | None = None
    #: The vertex, counted from 0.
    vertex: int | None = None
    #: Number of vertices of the body.
    vertices: int | None = None
    #: Number of triangles of the body.
    triangles: int | None = None
    #: The edge, counted from 0.
    edge: int | None = None
    #: Number of edges of the body.
    edges: int | None = None
    #: Both vertices of the edge.
    ends: tuple[int, int] | None = None
    #: Some of the edges at which a body is not closed, two vertices each.
    some_edges: list[tuple[int, int]] | None = None
    #: The point, counted from 0.
    point: int | None = None
    #: The hit of the list, counted from 0.
    hit: int | None = None
    #: Thickness of the vertex.
    thickness: float | None = None
    #: Position of the vertex or the point.
    position: tuple[float, float, float] | None = None
    #: Number of vertices of the body.
    expected: int | None = None
    #: Number of positions, groups or thicknesses given.
    found: int | None = None
    #: "triangles", "vertices" or "pairs"; of a wrong length, "positions", "groups" or "thicknesses".
    what: str | None = None
    #: Number of triangles, vertices or pairs; of edges at which a body is not closed.
    count: int | None = None
    #: Largest number allowed, of hits too.
    limit: int | None = None
    #: The file.
    file: str | None = None
    #: Where in the file.
    place: str | None = None
    #: Which frame of the sequence, counted from 0.
    frame: int | None = None

    def __init__(self, message: str = "", kind: str | None = None, **facts: Any) -> None:
        super().__init__(message)
        self.kind = kind
        for name, fact in facts.items():
            setattr(self, name, fact)


class HitRows(NamedTuple):
    """Hits in compressed rows (CSR), one for each first element: what rows() returns.

    Rows of one body follow each other by number, bodies by theirs. Row i has the hits
    places[offsets[i]:offsets[i + 1]]. Which element is first, the hits say: of a vertex and a
    triangle it is the vertex.
    """

    #: All hits in job order, as all(sort=False) returns them.
    hits: Any
    #: (rows + 1,) where each row begins in places, and its end.
    offsets: NDArray[np.uint32]
    #: (k,) rows of hits, row by row.
    places: NDArray[np.uint32]
    #: First row of every body.
    starts: dict[int, int]

    def row(self, body: SupportsIndex, element: SupportsIndex) -> NDArray[np.uint32]:
        """Places of the hits whose first element this is."""
        row = self.starts[index(body)] + index(element)
        return self.places[self.offsets[row] : self.offsets[row + 1]]


class FrameHits(NamedTuple):
    """Hits of many frames, one after the other: what Query.of_frames returns.

    Frame i has the hits from offsets[i] to offsets[i + 1].
    """

    #: Hits of all frames, as all() returns them: an array, ClosePairs or Contacts.
    hits: Any
    #: (frames + 1,) where the hits of each frame begin, and their end.
    offsets: NDArray[np.int64]

    @property
    def counts(self) -> NDArray[np.int64]:
        """(frames,) numbers of hits."""
        return np.diff(self.offsets)

    def frame(self, number: SupportsIndex) -> Any:
        """Hits of a frame, counted from 0, or from -1 at the end. Views, not copies."""
        count = len(self.offsets) - 1
        place = range(count)[index(number)]
        its = slice(self.offsets[place], self.offsets[place + 1])
        if isinstance(self.hits, np.ndarray):
            return self.hits[its]
        return type(self.hits)(*(column[its] for column in self.hits))


class Pair(NamedTuple):
    """Two triangles that intersect, of two bodies or of one: a row of Query.all.

    The smaller (body, triangle) is first. With Selection.between(a, b) body a is.
    """

    body_a: int
    triangle_a: int
    body_b: int
    triangle_b: int


class CrossingEdge(NamedTuple):
    """An edge that crosses a triangle, of two bodies or of one: a row of Query.all.

    World.edges numbers edges.
    """

    edge_body: int
    edge: int
    triangle_body: int
    triangle: int


class VertexTriangle(NamedTuple):
    """A vertex near a triangle, of two bodies or of one: a row of Query.all.

    The vertex is no corner of the triangle.
    """

    vertex_body: int
    vertex: int
    triangle_body: int
    triangle: int


class EdgeEdge(NamedTuple):
    """Two edges near each other, of two bodies or of one: a row of Query.all.

    World.edges numbers them. They have no end in common. The smaller (body, edge) is first. With
    Selection.between(a, b) body a is.
    """

    body_a: int
    edge_a: int
    body_b: int
    edge_b: int


class ClosePairs(NamedTuple):
    """Close elements, a row each: numbers, distance, direction and closest points.

    The distance is off by at most 2^-30 of itself and 2^-1074, the smallest number. It is 0
    exactly if the two touch.
    """

    pairs: NDArray[np.uint32]
    """(k, 4): body, vertex, body, triangle. Of edges body, edge, body, edge. Of triangles body,
    triangle, body, triangle."""
    distance: NDArray[np.float64]
    """(k,), in the unit of the positions."""
    direction: NDArray[np.float64]
    """(k, 3), of length 1, from the second element to the first. Zeros where they touch."""
    barycentric: NDArray[np.float64]
    """Weights of the corners in the closest points. (k, 3) for the corners of the triangle. (k, 4)
    for both ends of the first edge, then of the second. (k, 6) for the corners of the first
    triangle, then of the second."""

    def features(self) -> NDArray[np.uint8]:
        """(k,): a FeatureKind each, from the weights that are above 0, which are rounded.

        feature_pairs has exact ones. ValueError for triangles.
        """
        corners = self.barycentric.shape[1]
        if corners not in (3, 4):
            raise ValueError("features are of vertices and triangles, or of edges and edges")
        # Of a triangle one corner, two or three hold the point; of two edges one end more.
        kinds = [0, 0, 1, 3] if corners == 3 else [0, 0, 0, 1, 2]
        return np.array(kinds, dtype=np.uint8)[(self.barycentric > 0).sum(1)]


class ClosePair(NamedTuple):
    """Two close elements, as a row of ClosePairs has them."""

    pair: VertexTriangle | EdgeEdge | Pair
    """Which they are."""
    distance: float
    """How far apart they are, in the unit of the positions."""
    direction: tuple[float, float, float] | None
    """From the second element to the first, of length 1; None if they touch."""
    barycentric: tuple[float, ...]
    """Weights of the corners in the closest points, as in ClosePairs."""


class FeatureKind(IntEnum):
    """Kinds of two features that hold closest points: vertices, insides of edges and of faces."""

    VERTEX_VERTEX = 0
    VERTEX_EDGE = 1
    EDGE_EDGE = 2
    VERTEX_FACE = 3


class FeaturePairs(NamedTuple):
    """Contacts of close elements, each once, a row each: see feature_pairs."""

    kind: NDArray[np.uint8]
    """(k,): a FeatureKind each."""
    bodies: NDArray[np.uint32]
    """(k, 2): the bodies of both features. A vertex comes before an edge or a face; of two of one
    kind the lower by body and number is first."""
    numbers: NDArray[np.uint32]
    """(k, 2): numbers of the features: of a vertex, a row of edges(body), or a triangle."""
    vertices: NDArray[np.uint32]
    """(k, 4): vertices of the first feature, then of the second; 0xFFFFFFFF in the rest. An edge
    has two, as edges(body) orders them, a face three."""
    weights: NDArray[np.float64]
    """(k, 4): weights of these in the closest points; those of either feature sum to 1. 0 in the
    rest."""
    distance: NDArray[np.float64]
    """(k,), in the unit of the positions."""
    direction: NDArray[np.float64]
    """(k, 3), of length 1, from the second feature to the first. Zeros where they touch."""
    multiplicity: NDArray[np.uint32]
    """(k,): how many rows of both lists of close pairs each stands for."""


class PairDistances(NamedTuple):
    """How far elements are apart, a row a pair: see vertex_triangle_distances."""

    distance: NDArray[np.float64]
    """(k,): 0 exactly if they touch."""
    direction: NDArray[np.float64]
    """(k, 3): unit vector from the second element to the first; 0 if they touch."""
    weights: NDArray[np.float64]
    """(k, 4): of the corners in the closest points. Those of either element sum to 1, rounded."""
    kind: NDArray[np.uint8]
    """(k,): a FeatureKind each, from the weights that are above 0, which are rounded."""


class Watertight(NamedTuple):
    """Edges at which a mesh is not a closed surface: see World.watertight.

    Each array is (e, 2): two vertices, the smaller first, sorted, an edge once.
    """

    open: NDArray[np.uint32]
    """Edges in an odd number of triangles: the border of a hole, where that number is 1."""
    turned: NDArray[np.uint32]
    """Edges in an even number of triangles, along which more go in one direction than in the
    other: neighbours that are turned against each other."""
    doubled: NDArray[np.uint32]
    """Edges in more than two triangles. A surface is as closed with them as without."""

    @property
    def is_closed(self) -> bool:
        """Whether each edge is in as many triangles in one direction as in the other."""
        return len(self.open) == len(self.turned) == 0

    @property
    def is_even(self) -> bool:
        """Whether each edge is in an even number of triangles, whichever way these are turned."""
        return len(self.open) == 0


class Located(NamedTuple):
    """Where points are: inside a closed body, outside, or on its surface: see points_inside.

    Arrays have an entry for each point, (k,); of World.inside with frames they are
    (frames, n).
    """

    sides: NDArray[np.int8]
    """1 inside, 0 on the surface, -1 outside."""
    windings: NDArray[np.int32]
    """How often the surface winds round each; 0 on it. With rule="parity" 1 inside, else 0."""

    @property
    def is_inside(self) -> NDArray[np.bool_]:
        """Whether each is inside, and not on the surface."""
        return np.greater(self.sides, 0)


class Containment(NamedTuple):
    """Components that lie inside other bodies: see World.contained."""

    all: NDArray[np.uint32]
    """(c, 3), sorted: body, component of it, body that this lies inside."""
    open: list[int]
    """Bodies that are not closed, so that nothing is said to lie inside them; sorted."""


class ClosestPoints(NamedTuple):
    """Closest points of bodies, a row for each point: see World.closest_points.

    The triangle is exactly the nearest, and of equally near ones the first, by body and number. The
    distance is off by at most 2^-30 of itself and 2^-1074. It is 0 exactly on the surface.
    """

    found: NDArray[np.bool_]
    """(k,): whether any is within the cut-off."""
    bodies: NDArray[np.uint32]
    """(k,): body that has the triangle; 0xFFFFFFFF where none is found."""
    triangles: NDArray[np.uint32]
    """(k,): its nearest triangle; 0xFFFFFFFF where none is found."""
    distance: NDArray[np.float64]
    """(k,), in the unit of the positions; inf where none is found. Of signed_closest_points below 0
    inside the body."""
    points: NDArray[np.float64]
    """(k, 3): the closest points, rounded; NaN where none is found."""
    barycentric: NDArray[np.float64]
    """(k, 3): weights of the corners of the triangle in the closest point; NaN where none is
    found."""
    direction: NDArray[np.float64]
    """(k, 3), of length 1, from the closest point to the given one. Zeros where they are one, NaN
    where none is found."""
    features: NDArray[np.uint8]
    """(k,): the smallest part of the triangle that has the closest point, exactly. 0 to 2 is a
    corner. 3 to 5 is inside the edge from corner 0, 1 or 2 to the next. 6 is inside the triangle,
    and 255 where none is found."""


class Depth(NamedTuple):
    """How deep a body reaches into a closed one: see World.depth.

    The deepest point of its surface is at least as deep as its deepest vertex. It is deeper by at
    most the largest distance of a point of a triangle from its nearest corner.
    """

    of_vertices: NDArray[np.float64]
    """(n,): distance of each vertex inside from the surface of the other body; 0 of all others."""
    vertex: int | None
    """The deepest vertex, the first of several; None if none is inside."""
    at_least: float
    """Its depth, else 0."""
    at_most: float
    """Upper bound of the depth of all points of the surface; 0 if no vertex is inside and no
    triangle meets the other body."""


class ContactKind(IntEnum):
    """How two triangles intersect, decided exactly: touching, overlapping or crossing."""

    TOUCHING = 0
    """Neither of the others: a move of their corners, however small, could part them."""
    OVERLAPPING = 1
    """They lie in one plane, and have an area in common."""
    CROSSING = 2
    """They go through each other: after every small enough move they still intersect."""


class Contacts(NamedTuple):
    """Triangles that intersect, a row each, and how."""

    pairs: NDArray[np.uint32]
    """(k, 4): body, triangle, body, triangle."""
    kind: NDArray[np.uint8]
    """(k,): a ContactKind each."""


class Contact(NamedTuple):
    """Two triangles that intersect, and how: a row of Contacts."""

    pair: Pair
    kind: ContactKind


class Segments(NamedTuple):
    """Where k pairs of triangles meet, from segments: for each a point, a segment or a polygon."""

    offsets: NDArray[np.uint64]
    """(k + 1,): the ends of pair i are rows offsets[i] to offsets[i + 1]. Two ends are those of a
    segment, which runs along the cross product of the normals; three to six are corners of a
    polygon, in order around it. A pair that does not meet has none."""
    points: NDArray[np.float64]
    """(e, 3): positions of the ends of all pairs."""
    on: NDArray[np.uint8]
    """(e, 2): what an end lies on, for each triangle of its pair. 0 to 2 is a corner. 3 to 5 is
    inside the edge from corner 0, 1 or 2 to the next. 6 is inside the triangle."""
    parameters: NDArray[np.float64]
    """(e, 2): the part of the way along that edge; NaN where it is none."""
    normals: NDArray[np.float64]
    """(k, 2, 3): unit normals of both triangles."""
    flat: NDArray[np.bool_]
    """(k,): whether both triangles lie in one plane."""


class CurveEnd(IntEnum):
    """What an open curve ends at."""

    BORDER = 0
    """No other segment goes on: at the border of a mesh, where surfaces begin to touch, or where a
    pair is not listed."""
    SHARED_VERTEX = 1
    """A vertex that both triangles have."""
    OVERLAP = 2
    """A corner of a polygon in which triangles of one plane overlap."""
    BRANCHING = 3
    """A place from which three or more segments go."""


class Curves(NamedTuple):
    """Curves in which pairs of triangles meet, c in number, from curves."""

    segments: Segments
    """Where each pair meets."""
    offsets: NDArray[np.uint64]
    """(c + 1,): the steps of curve i are rows offsets[i] to offsets[i + 1]."""
    steps: NDArray[np.uint64]
    """(s,): the pair in whose segment each step goes."""
    reversed: NDArray[np.bool_]
    """(s,): whether it goes from the second end of the segment to the first."""
    swapped: NDArray[np.bool_]
    """(s,): whether the second triangle of the pair is on the first side of the curve. Where
    surfaces cross, and triangles are oriented alike, curves run along n_0 x n_1, the cross product
    of the normals of both sides."""
    length: NDArray[np.float64]
    """(c,): sum of the lengths of the segments."""
    closed: NDArray[np.bool_]
    """(c,): whether it comes back to where it begins."""
    ends: NDArray[np.uint8]
    """(c, 2): what it begins and ends at, a CurveEnd each; 255 if it is closed."""
    areas: NDArray[np.float64] | None
    """(c, 2): the area that it encloses on the sheets of its two sides, of the smaller part;
    positive if that is on the left, where the normal points up. NaN where it is open, bounds no
    part, passes a vertex or along an edge of the sheet, or triangles that are not oriented alike or
    stand twice. None without areas=True."""
    touching: NDArray[np.uint64]
    """(p,): pairs that meet in one point, where no curve is; one for each point."""

    def polyline(self, curve: int) -> NDArray[np.float64]:
        """Points along a curve, (n, 3); a closed one does not repeat its first."""
        curve = range(len(self.closed))[curve]
        own = slice(int(self.offsets[curve]), int(self.offsets[curve + 1]))
        begins, turned = self.segments.offsets[self.steps[own]], self.reversed[own]
        rows = begins + turned
        if not self.closed[curve]:
            rows = np.append(rows, begins[-1:] + ~turned[-1:])
        return self.segments.points[rows]


class Changed(NamedTuple):
    """Changes from the last list of hits to a new one. Rows of it that did not begin persist."""

    numbers: NDArray[np.uint64]
    """(k,): the number of each row, which it keeps while it persists."""
    began: NDArray[np.uint64]
    """(b,): places in the new list of the rows that began, ascending."""
    ended: NDArray[np.uint32]
    """(e, 4): rows that ended, sorted, by the numbers that their things had last. Of one kind, the lower is first."""
    ended_numbers: NDArray[np.uint64]
    """(e,): the number of each."""


class Edited(NamedTuple):
    """Changes that an edit has made, by number: five arrays (k,), each ascending."""

    new_triangles: NDArray[np.uint32]
    """Triangles that were empty, or not there."""
    changed_triangles: NDArray[np.uint32]
    """Triangles that have other corners."""
    removed_triangles: NDArray[np.uint32]
    """Triangles that are empty now."""
    new_vertices: NDArray[np.uint32]
    """Vertices that were empty, or not there, or that went and came again."""
    removed_vertices: NDArray[np.uint32]
    """Vertices that are empty now."""


class Piece(NamedTuple):
    """A new body that World.split made of a component of another."""

    body: int
    """Number of the new body."""
    triangles: NDArray[np.uint32]
    """(m,): the old number of each of its triangles, ascending."""
    vertices: NDArray[np.uint32]
    """(n,): the old number of each of its vertices, ascending."""


class Fused(NamedTuple):
    """New numbers in the body that World.fuse kept; 0xFFFFFFFF for numbers that were empty."""

    triangles: NDArray[np.uint32]
    """(m,): the new number of each triangle of the removed body."""
    vertices: NDArray[np.uint32]
    """(n,): the new number of each vertex of the removed body."""


class Impacts(NamedTuple):
    """Elements that meet during the motion, a row each, and when.

    Time is 0 at the start of the motion and 1 at its end. A pair is apart from time 0 to low, both
    included. It meets after low and by high. Both are 0 if it meets at the start.
    """

    pairs: NDArray[np.uint32]
    """(k, 4): body, vertex, body, triangle. Of edges body, edge, body, edge."""
    low: NDArray[np.float64]
    """(k,): apart up to here."""
    high: NDArray[np.float64]
    """(k,): have met by here; high - low is at most the width asked for."""


class Impact(NamedTuple):
    """Two elements that meet during the motion, and when: a row of Impacts."""

    pair: VertexTriangle | EdgeEdge
    low: float
    high: float


class FreeStep(NamedTuple):
    """How far everything may go without collision, and how that begins: see World.free_step."""

    t: float
    """A time from 0 to 1, to call World.advance_motion with."""
    begins_in_contact: Pair | VertexTriangle | EdgeEdge | None
    """The first pair in contact at the start: triangles that intersect, else elements at most
    min_distance apart. None if everything begins apart."""
    moves: bool
    """Whether a selected body has a motion, be it to nowhere. If none has, t is 1."""


class TreeShape(NamedTuple):
    """Size of a body's tree. Movement does not change it."""

    depth: int
    """Level of the deepest leaf; the root is level 0."""
    nodes: int
    """Number of nodes, leaves and root included: the boxes of a complete refit."""
    leaves: int
    """Number of nodes that hold triangles."""


class TreeBoxes(NamedTuple):
    """Boxes of a level of a tree, a row for each part of World.tree_cut."""

    lower: NDArray[Any]
    """(k, 3), of the world's dtype: the smallest coordinates of the triangles below each node."""
    upper: NDArray[Any]
    """(k, 3), of the world's dtype: the largest."""
    valid: NDArray[np.bool_]
    """(k,): whether the tree holds this box for the present shape; else it is stale."""


class Statistics(NamedTuple):
    """Counters of the work of one query, Query.prepare before it included."""

    body_pairs: int
    """Pairs of bodies whose trees were traversed."""
    boxes_bottom_up: int
    """Boxes refitted ahead of a traversal."""
    boxes_top_down: int
    """Boxes refitted when a traversal reached them."""
    triangle_boxes: int
    """Boxes of single triangles in leaves of several."""
    node_pairs: int
    """Pairs of nodes with overlapping boxes."""
    candidate_pairs: int
    """Pairs of triangles with overlapping boxes, which were therefore decided."""
    scalar_decisions: int
    """Pairs of moving elements that filters eight at a time left open, decided one by one."""
    exact_decisions: int
    """Candidates that needed exact arithmetic."""
    pairs: int
    """Pairs found."""


@dataclass(frozen=True, eq=False)
class Body:
    """A body read from files, or a connected piece or group of one: see Check.bodies."""

    name: str
    """The path as given. # and a name follow for a body of several in a glTF file, or a group. #
    and a number follow for a piece."""
    vertices: int
    """Number of its vertices."""
    triangles: int
    """Number of its triangles."""
    faces: NDArray[np.uint32] | None
    """(m,): the polygon that each triangle of the file is part of. None if all are triangles."""
    welded: int
    """Number of vertices welded away in its file."""
    source: int
    """Its path, counted from 0; each body of a glTF file counts."""
    first_triangle: int
    """Its lowest triangle, as numbered in the file."""


@dataclass(frozen=True)
class BodyThere:
    """The triangles of a body in a Place."""

    body: int
    """Its number."""
    triangles: int
    """How many of its triangles intersect there."""
    first_triangle: int
    """The lowest of them."""


@dataclass(frozen=True)
class Place:
    """A place of a frame: pairs connected by triangles that are equal or share a vertex."""

    number: int
    """Its number, counted from 0, the same in every frame while the place lives."""
    count: int
    """Number of pairs."""
    first_pair: tuple[int, int, int, int]
    """The smallest pair: body, triangle, body, triangle."""
    bodies: tuple[BodyThere, ...]
    """Bodies whose triangles intersect there."""
    lower: tuple[float, float, float]
    """The smallest coordinates of where pairs meet; of pairs that are only close, of their
    triangles."""
    upper: tuple[float, float, float]
    """The largest."""
    depth: float | None = None
    """How far the deepest vertex of the place is inside the other body, linked with it by vertices
    inside; 0 if there is none. None without solid=True, within one file, and where no file is
    closed."""


@dataclass(frozen=True)
class Life:
    """A place, from its first frame to its last: see Check.places."""

    first_frame: int
    """Its first frame."""
    last_frame: int
    """Its last frame so far."""
    worst_frame: int
    """The first frame in which it has the most pairs."""
    worst: Place
    """The place in that frame."""


@dataclass(frozen=True)
class FirstImpact:
    """The first contact on the way from a frame to the next: see Interval.first."""

    time: float
    """When they have met, from 0, in the frame, to 1, in the next; at most 1e-6 late."""
    kind: str
    """"vertex_triangle" or "edge_edge"."""
    pair: tuple[int, ...]
    """Which they are: a row of Interval.vertex_triangle or Interval.edge_edge."""


@dataclass(frozen=True, eq=False)
class Interval:
    """Contacts on the way from a frame to the next that is checked: see Frame.interval.

    Counted are elements that are apart in the frame and meet before the next, or in it.
    """

    frame: int
    """The frame."""
    until: int
    """The next frame that is checked."""
    changed: tuple[int, ...]
    """Bodies that have another mesh there. If there are any, nothing was looked for."""
    count: int
    """Number of pairs of elements; at most one with first=True."""
    at_start: int
    """Number of other pairs that meet in the frame already."""
    first: FirstImpact | None
    """The pair that meets first."""
    vertex_triangle: NDArray[np.uint32]
    """(k, 4): body, vertex, body, triangle, sorted; numbered as in the file."""
    vertex_triangle_times: NDArray[np.float64]
    """(k, 2): apart up to the first time, and met by the second, at most 1e-6 later."""
    edge_edge: NDArray[np.uint32]
    """(k, 6), sorted: body and two vertices, twice, the smaller first in an edge and of the two."""
    edge_edge_times: NDArray[np.float64]
    """(k, 2): as vertex_triangle_times."""
    complete: bool
    """Whether these are all pairs; not with first=True."""


class Kinds(NamedTuple):
    """Numbers of pairs of a frame by kind: see ContactKind."""

    crossing: int
    overlapping: int
    touching: int


class CrossingEdges(NamedTuple):
    """Edges of a body that cross triangles of another, or of itself: see Frame.crossing_edges."""

    edge_body: int
    """Body of the edges. An edge between two bodies of a file is of both."""
    triangle_body: int
    """Body of the triangles."""
    edges: int
    """Number of edges that cross any triangle."""
    pairs: int
    """Number of pairs of an edge and a triangle that it crosses."""


@dataclass(frozen=True, eq=False)
class Adjacent:
    """Pairs of a frame that share a vertex and meet beyond it: see Frame.adjacent."""

    count: int
    """Number of pairs."""
    pairs: NDArray[np.uint32]
    """(count, 4), sorted: body, triangle, body, triangle."""
    kinds: Kinds
    """Number of pairs of each kind: see World.adjacent_intersections."""
    twice: int
    """Triangles that stand twice: an earlier one has the same three vertices."""
    left_out: int | None
    """Pairs left out because the baseline has them, as Frame.left_out."""
    only_touching: int | None
    """Pairs left out because they only touch; None without crossing=True."""
    degenerate: int
    """Pairs with a triangle without area: found, or left out with skip_degenerate=True."""


class Counts(NamedTuple):
    """Numbers of several frames, added up: see Check.counts."""

    frames: int
    """Number of frames."""
    pairs: int
    """Intersecting pairs, or close ones with within=."""
    crossing_edges: int | None
    """Edges that cross triangles; None as Frame.crossing_edges."""
    adjacent: int | None
    """Pairs that share a vertex; None as Frame.adjacent."""
    touching: int | None
    """Pairs, among pairs, that only touch; None as Frame.kinds."""
    degenerate: int
    """Pairs with a triangle without area."""
    inside: int
    """Components inside bodies."""


@dataclass(frozen=True, eq=False)
class Frame:
    """A frame that pliant.check has checked."""

    frame: int
    """Its number, counted from 0."""
    count: int
    """Number of pairs."""
    pairs: NDArray[np.uint32]
    """(count, 4), sorted: body, triangle, body, triangle. With first=True one pair; with within=
    too, the nearest."""
    adjacent: Adjacent | None
    """Pairs that share a vertex and meet beyond it, which are not in count. None where they are not
    asked for: between different files, with within= or ignore_adjacent=True, and where first=True
    has found another pair."""
    crossing_edges: tuple[CrossingEdges, ...] | None
    """Edges that cross triangles, for every two bodies with any; None without
    crossing_edges=True, and with first=True or within=."""
    kinds: Kinds | None
    """Number of pairs of each kind; None with first=True or within=."""
    distance: float | None
    """Distance of the nearest pair, in the unit of the files; None without within= or pairs."""
    complete: bool
    """Whether these are all pairs; not with first=True."""
    left_out: int | None
    """Pairs left out because the baseline has them. None without baseline=, or if the search
    stopped at the first new pair."""
    only_touching: int | None
    """Pairs left out because surfaces only touch in their places; None without crossing=True."""
    degenerate: int
    """Pairs with a triangle without area: found, or left out with skip_degenerate=True."""
    changed: dict[int, Body]
    """Bodies with another mesh than in the frame before; in the first frame, than in Check.bodies.
    Pairs number triangles as in the mesh of their frame."""
    places: tuple[Place, ...] | None
    """Places that the pairs join into, most pairs first; None without places=, and with first."""
    inside: tuple[tuple[int, int, int], ...] = ()
    """Components that lie inside bodies, which no pair tells: body, component, body around it. The
    component is numbered by the lowest of its triangles, from 0."""
    not_closed: tuple[int, ...] = ()
    """Bodies that are not closed, so that nothing is said to lie inside them."""
    interval: Interval | None = None
    """Contacts on the way to the next frame; None without swept=, and in the last frame."""


class Mesh(Protocol):
    """A mesh object as trimesh has it."""

    @property
    def vertices(self) -> ArrayLike:
        """Positions, (n, 3) float32 or float64."""

    @property
    def faces(self) -> ArrayLike:
        """Corners of the triangles, (m, 3) of any integer type."""


class OpenMesh(Protocol):
    """A mesh object as Open3D has it."""

    @property
    def vertices(self) -> Any:
        """Positions, (n, 3) float32 or float64."""

    @property
    def triangles(self) -> Any:
        """Corners of the triangles, (m, 3) of any integer type."""


_PUBLIC = (
    *(Watertight, Located, Containment, ClosestPoints, Depth),
    *(Error, Pair, VertexTriangle, EdgeEdge, ClosePair, ClosePairs, FeatureKind, FeaturePairs, PairDistances, HitRows, FrameHits, Contact, ContactKind, Contacts),
    *(CrossingEdge, Segments, CurveEnd, Curves, Changed, Edited, Fused, Piece, Impact, Impacts, FreeStep, TreeBoxes, TreeShape, Statistics),
    *(Body, BodyThere, Place, Life, FirstImpact, Interval, Kinds, Adjacent, CrossingEdges, Frame, Mesh, OpenMesh),
)
for _public in _PUBLIC:
    _public.__module__ = "pliant"
