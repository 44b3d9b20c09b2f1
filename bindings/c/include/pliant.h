/* pliant.h: exact collision detection for triangle meshes that deform. C11 and C++11.

   Every function that can be refused returns a status, PLIANT_OK or another, and says more in
   `error`, unless that is NULL; `error` is written only then. A refused call changes nothing but
   what it was to write. Nothing is printed, but by PLIANT_PANIC, and no state is global. No
   exception leaves a function.

   Arrays of numbers are read and written during the call only, and need no alignment. Other threads
   may read them at the time.

   Structures may grow until version 1: compile with the header of the library that you run. */
#ifndef PLIANT_H
#define PLIANT_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define PLIANT_VERSION_MAJOR 0
#define PLIANT_VERSION_MINOR 1
#define PLIANT_VERSION_PATCH 0

/* Version of the library that runs: major << 16 | minor << 8 | patch. */
uint32_t pliant_version(void);

/* ---- Statuses and errors ------------------------------------------------------------------ */

/* 0 is success. A number keeps its meaning in all versions. */
typedef int32_t pliant_status;
enum {
    PLIANT_OK = 0,
    PLIANT_NULL = 1,                 /* a pointer is NULL that may not be */
    PLIANT_BAD_SCALAR = 2,           /* a pliant_scalar that is none, or not that of the others */
    PLIANT_PANIC = 3,                /* a fault of the library, which is worth a report */
    PLIANT_OTHER = 4,                /* a reason that this version has no number for */
    PLIANT_BAD_INDEX = 5,            /* indices of a size that is none */
    PLIANT_BAD_OPTION = 6,           /* an option, selection or choice that is none */
    PLIANT_WOULD_ROUND = 7,          /* positions of double precision for a world of single */
    PLIANT_BUSY = 8,                 /* another call is inside the world */
    PLIANT_DIFFERENT_COUNTS = 10,    /* arrays of one call have different counts */
    PLIANT_BAD_CORNER = 11,          /* a coordinate of a pair: as PLIANT_BAD_POSITION */
    PLIANT_BAD_WIDTH = 12,           /* a width is negative, infinite or NaN */
    PLIANT_NO_SUCH_BODY = 20,        /* the world has no such body, or has it no more */
    PLIANT_SAME_BODY = 21,           /* one body is given as two */
    PLIANT_NO_TRIANGLES = 22,        /* a body would have no triangle */
    PLIANT_TOO_LARGE = 23,           /* more triangles or vertices than 32-bit numbers keep apart */
    PLIANT_TOO_MANY_BODIES = 24,     /* all numbers of bodies were given away */
    PLIANT_VERTEX_OUT_OF_RANGE = 25, /* a triangle names a vertex that is not there */
    PLIANT_WRONG_LENGTH = 26,        /* not one for each vertex */
    PLIANT_BAD_POSITION = 27,        /* a coordinate is NaN, infinite or beyond 3.4e38 */
    PLIANT_NEEDS_SUBNORMALS = 28,    /* the thread flushes subnormal numbers, and there are some */
    PLIANT_TOO_MANY_HITS = 30,       /* more than pliant_query.at_most */
    PLIANT_INTERRUPTED = 31,         /* pliant_query.interrupt said so */
    PLIANT_BAD_MARGIN = 32,          /* a radius is negative, infinite or NaN */
    PLIANT_BAD_DISTANCE = 33,        /* a distance is negative, infinite or NaN */
    PLIANT_BAD_TIME = 34,            /* a time is not from 0 to 1 */
    PLIANT_BAD_THICKNESS = 35        /* a thickness is negative, infinite or NaN */
};

/* Why a call was refused. Facts that do not apply are UINT32_MAX, UINT64_MAX, or NaN. */
typedef struct pliant_error {
    pliant_status status;
    uint32_t body, triangle;
    uint32_t vertex;      /* of the body; of a pair the corner, from 0 */
    uint64_t pair;        /* the pair of elements, from 0 */
    uint64_t count;       /* how many were given */
    uint64_t limit;       /* how many were expected, or may be */
    double number;        /* the width, radius, distance, thickness or time that is refused */
    double position[3];   /* the position that is refused */
    char message[256];    /* one line of UTF-8 that ends with 0: what is wrong, and what to do */
} pliant_error;

/* ---- Arrays of the caller ----------------------------------------------------------------- */

/* Type of coordinates. */
typedef int32_t pliant_scalar;
enum { PLIANT_F32 = 0, PLIANT_F64 = 1 };

/* Points: coordinate x of point i is at data + i * row + x * column bytes.

     double xyz[n][3]                  {xyz, n, 24, 8, PLIANT_F64}
     Eigen::MatrixXd V (n, 3)          {V.data(), n, 8, 8 * n, PLIANT_F64}
     vertices of 32 bytes, float xyz   {vertices, n, 32, 4, PLIANT_F32}

   A row and a column of 0 stand for the first form. data may be NULL if count is 0. */
typedef struct pliant_points {
    const void *data;
    size_t count;
    ptrdiff_t row, column; /* in bytes */
    pliant_scalar scalar;
} pliant_points;

/* Triangles: corner x of triangle i is at data + i * row + x * column bytes, an index of 2, 4 or 8
   bytes. 0 for both strides stands for 3 indices behind each other, and triangles likewise.

     uint32_t faces[m][3]              {faces, m, 0, 0, 4, 0}
     Eigen::MatrixXi F (m, 3)          {F.data(), m, 4, 4 * m, 4, 1}

   A triangle with a corner twice is an edge, with one three times a point. */
typedef struct pliant_faces {
    const void *data;
    size_t count;
    ptrdiff_t row, column; /* in bytes */
    uint8_t bytes;         /* of an index */
    uint8_t is_signed;     /* 0 or 1 */
} pliant_faces;

/* ---- Single pairs, without a world ---------------------------------------------------------

   For callers with a search of their own. Pair k has the points k of `corners[0]`, `corners[1]`,
   and so on, all of one count. Arrays that are written have a row for each pair. They may be NULL
   if they are not wanted, and say nothing if the call is refused. One thread works.

   Corners may lie anywhere. If all points of a pair lie behind each other, and the pairs too, they
   are not copied. */

/* When vertices first meet triangles that move, on straight lines from time 0 to time 1.

   `start` and `end` are 4 points each: the vertex, and the corners of the triangle. `hit` is 1 if
   they meet, as closed sets, which is decided exactly, else 0. They are apart from 0 to `low`, both
   included, and first meet after `low` and not after `high`. Both are 0 if they meet at the start,
   and NaN without a hit. `high - low` is at most `width`, which is at least 0; 1e-6 is a good one.

   Some tens of nanoseconds for a pair that stays apart, mostly less than a microsecond for one that
   meets. Tens of microseconds where only exact arithmetic can tell; some ten milliseconds where
   coordinates of a pair are a thousand powers of two apart.

   PLIANT_NULL, PLIANT_BAD_SCALAR, PLIANT_DIFFERENT_COUNTS, PLIANT_BAD_CORNER, PLIANT_BAD_WIDTH. */
pliant_status pliant_vertex_triangle_impacts(const pliant_points start[4],
                                             const pliant_points end[4], double width,
                                             uint8_t *hit, double *low, double *high,
                                             pliant_error *error);

/* When edges first meet edges that move. 4 points: both ends of one edge, then of the other. All
   else is as for pliant_vertex_triangle_impacts. */
pliant_status pliant_edge_edge_impacts(const pliant_points start[4], const pliant_points end[4],
                                       double width, uint8_t *hit, double *low, double *high,
                                       pliant_error *error);

/* Features of two elements that hold their closest points: the smallest parts that do. */
typedef uint8_t pliant_features;
enum {
    PLIANT_VERTEX_VERTEX = 0,
    PLIANT_VERTEX_EDGE = 1,
    PLIANT_VERTEX_FACE = 2,
    PLIANT_EDGE_EDGE = 3
};

/* How far vertices and triangles are apart, and where they are closest.

   `corners` are 4 points: the vertex, and the corners of the triangle. `distance` is off by at most
   2^-30 of itself and 2^-1074, and 0 exactly if they touch. `direction`, 3 numbers a pair, is the
   unit vector from the triangle to the vertex, and 0 if they touch. `weights`, 4 numbers a pair,
   are of the corners in the closest points: 1, and three that sum to 1. `features` says which are
   above 0.

   Some tens of nanoseconds a pair; microseconds where they touch, or a triangle hardly has an area.

   PLIANT_NULL, PLIANT_BAD_SCALAR, PLIANT_DIFFERENT_COUNTS, PLIANT_BAD_CORNER. */
pliant_status pliant_vertex_triangle_distances(const pliant_points corners[4], double *distance,
                                               double *direction, double *weights,
                                               pliant_features *features, pliant_error *error);

/* How far edges are apart. 4 points: both ends of one edge, then of the other. `direction` is from
   the second edge to the first; the first two weights sum to 1, and the last two. Of parallel edges
   an end of one holds the closest points. All else is as for pliant_vertex_triangle_distances. */
pliant_status pliant_edge_edge_distances(const pliant_points corners[4], double *distance,
                                         double *direction, double *weights,
                                         pliant_features *features, pliant_error *error);

/* How two triangles intersect. */
typedef uint8_t pliant_contact;
enum {
    PLIANT_APART = 0,       /* they have no point in common */
    PLIANT_TOUCHING = 1,    /* neither of the others; a small move of corners could part them */
    PLIANT_OVERLAPPING = 2, /* they lie in one plane, and have an area in common */
    PLIANT_CROSSING = 3     /* they go through each other, after every small enough move, too */
};

/* Whether and how triangles intersect, as closed sets; decided exactly. `corners` are 6 points: the
   corners of one triangle, then of the other. Some hundred nanoseconds a pair, microseconds where
   rounding hides a sign.

   PLIANT_NULL, PLIANT_BAD_SCALAR, PLIANT_DIFFERENT_COUNTS, PLIANT_BAD_CORNER. */
pliant_status pliant_triangle_contacts(const pliant_points corners[6], pliant_contact *contact,
                                       pliant_error *error);

/* ---- Worlds --------------------------------------------------------------------------------

   A world holds bodies: meshes that change their shape. It answers questions about all of them, or
   some. Worlds are apart: each may be used by another thread. Into one world goes one call at a
   time; a second is refused, PLIANT_BUSY, as is a call from a visitor or an interrupt. After
   PLIANT_PANIC a world can only be freed.

   Any call with a world may return PLIANT_NULL, PLIANT_BUSY and PLIANT_PANIC; other statuses are
   named. */
typedef struct pliant_world pliant_world;

/* How a world works. No option changes an answer. */
typedef struct pliant_options {
    pliant_scalar scalar;   /* of positions: PLIANT_F64 */
    uint32_t threads;       /* that share the work of a question, at most, from 1: 1 */
    uint32_t degree;        /* most children of a node, 2, 4 or 8: 8 */
    uint32_t partition;     /* of triangles into a tree: PLIANT_BALANCED */
    uint32_t leaf_size;     /* most triangles in a leaf, from 1: 8 */
    uint32_t update;        /* when boxes are made: PLIANT_HYBRID */
    uint32_t broad_phase;   /* how pairs of bodies are found: PLIANT_AUTO */
    uint8_t mending;        /* whether trees that no longer fit mend themselves, 0 or 1: 0 */
} pliant_options;
enum { PLIANT_CENTRE = 0, PLIANT_MEAN = 1, PLIANT_BALANCED = 2, PLIANT_CONNECTIVITY = 3 };
enum { PLIANT_BOTTOM_UP = 0, PLIANT_TOP_DOWN = 1, PLIANT_HYBRID = 2 };
enum { PLIANT_AUTO = 0, PLIANT_BRUTE_FORCE = 1, PLIANT_SWEEP_AND_PRUNE = 2, PLIANT_TREE = 3 };

/* Sets all options to their defaults. Begin with this, then change what you like. */
void pliant_options_default(pliant_options *options);

/* Makes a world without bodies, to be freed by pliant_world_free. NULL stands for the defaults.
   PLIANT_BAD_OPTION, PLIANT_BAD_SCALAR. */
pliant_status pliant_world_new(const pliant_options *options, pliant_world **world,
                               pliant_error *error);

/* Copies a world, with all that it would answer. The copy is freed, too. */
pliant_status pliant_world_clone(const pliant_world *world, pliant_world **copy,
                                 pliant_error *error);

/* Frees a world, in which there must be no call. NULL is fine. */
void pliant_world_free(pliant_world *world);

/* Adds a body at these positions. `body`, its number, is never used again; it may be NULL.
   PLIANT_BAD_INDEX, PLIANT_BAD_SCALAR, PLIANT_WOULD_ROUND, PLIANT_NO_TRIANGLES, PLIANT_TOO_LARGE,
   PLIANT_TOO_MANY_BODIES, PLIANT_VERTEX_OUT_OF_RANGE, PLIANT_BAD_POSITION,
   PLIANT_NEEDS_SUBNORMALS. O(m log m). */
pliant_status pliant_world_add(pliant_world *world, pliant_faces faces, pliant_points positions,
                               uint32_t *body, pliant_error *error);

/* Removes a body. PLIANT_NO_SUCH_BODY. */
pliant_status pliant_world_remove(pliant_world *world, uint32_t body, pliant_error *error);

/* Gives a body another shape, a point for each vertex. A motion ends. PLIANT_NO_SUCH_BODY,
   PLIANT_BAD_SCALAR, PLIANT_WOULD_ROUND, PLIANT_WRONG_LENGTH, PLIANT_BAD_POSITION,
   PLIANT_NEEDS_SUBNORMALS. O(n). */
pliant_status pliant_world_set_positions(pliant_world *world, uint32_t body,
                                         pliant_points positions, pliant_error *error);

/* Begins a motion of a body, on straight lines from its shape to this one. Statuses and cost as of
   pliant_world_set_positions. */
pliant_status pliant_world_set_motion(pliant_world *world, uint32_t body, pliant_points end,
                                      pliant_error *error);

/* Ends all motions at the part t of their way, from 0 to 1: shapes are then those at t.
   PLIANT_BAD_TIME. O(n). */
pliant_status pliant_world_advance_motion(pliant_world *world, double t, pliant_error *error);

/* Gives a body a rest shape, or takes it away with NULL: pairs of the body that are as close in it
   do not count as close. Statuses and cost as of pliant_world_set_positions. */
pliant_status pliant_world_set_rest_positions(pliant_world *world, uint32_t body,
                                              const pliant_points *positions, pliant_error *error);

/* Gives a body another mesh at these positions, and keeps its number. Statuses as of
   pliant_world_add, and PLIANT_NO_SUCH_BODY. */
pliant_status pliant_world_set_mesh(pliant_world *world, uint32_t body, pliant_faces faces,
                                    pliant_points positions, pliant_error *error);

/* Numbers the edges of a body as in this list, two vertices each: every edge of the mesh once. For
   callers with numbers of their own. PLIANT_NO_SUCH_BODY, PLIANT_OTHER. */
pliant_status pliant_world_set_edges(pliant_world *world, uint32_t body, const uint32_t *edges,
                                     size_t count, pliant_error *error);

/* The edges of a body, two vertices each, in the order of their numbers: a view, valid until this
   is called with the world again, or it is freed. PLIANT_NO_SUCH_BODY. */
pliant_status pliant_world_edges(const pliant_world *world, uint32_t body, const uint32_t **edges,
                                 size_t *count, pliant_error *error);

/* Counts of a body's triangles and vertices; either may be NULL. PLIANT_NO_SUCH_BODY. */
pliant_status pliant_world_counts(const pliant_world *world, uint32_t body, size_t *triangles,
                                  size_t *vertices, pliant_error *error);

/* Copies the positions of a body into `out`, 3 numbers a vertex. `count` is of vertices.
   PLIANT_NO_SUCH_BODY, PLIANT_WRONG_LENGTH. */
pliant_status pliant_world_positions(const pliant_world *world, uint32_t body, double *out,
                                     size_t count, pliant_error *error);

/* Sets whom a body meets in questions of the whole world: each of two must have a bit of the
   other's membership in its mask. At first all are set. PLIANT_NO_SUCH_BODY. */
pliant_status pliant_world_set_filter(pliant_world *world, uint32_t body, uint32_t membership,
                                      uint32_t mask, pliant_error *error);

/* Puts a body into an environment, at first 0: bodies of different ones do not meet in questions of
   the whole world. PLIANT_NO_SUCH_BODY. */
pliant_status pliant_world_set_environment(pliant_world *world, uint32_t body,
                                           uint32_t environment, pliant_error *error);

/* Keeps two bodies, or one and itself, from each other in questions of the whole world.
   PLIANT_NO_SUCH_BODY. */
pliant_status pliant_world_ignore(pliant_world *world, uint32_t a, uint32_t b,
                                  pliant_error *error);

/* Labels the triangles of a body, one for each: pairs of the body of equal labels, or of
   neighbours, are left out. `neighbours` has two labels a row; NULL: labels with a vertex in
   common. UINT32_MAX is left out of nothing. NULL for `labels` takes them away. For intersections,
   contacts and close pairs. PLIANT_NO_SUCH_BODY, PLIANT_WRONG_LENGTH. */
pliant_status pliant_world_set_labels(pliant_world *world, uint32_t body, const uint32_t *labels,
                                      size_t count, const uint32_t *neighbours,
                                      size_t neighbour_count, pliant_error *error);

/* Gives every vertex of a body a group: elements whose vertices are all of one group do not meet,
   unless that is 0. For candidates, close pairs and impacts. PLIANT_NO_SUCH_BODY,
   PLIANT_WRONG_LENGTH. */
pliant_status pliant_world_set_vertex_groups(pliant_world *world, uint32_t body,
                                             const uint32_t *groups, size_t count,
                                             pliant_error *error);

/* Makes every vertex of a body a ball of this radius, at least 0. For candidates, close pairs and
   free steps. PLIANT_NO_SUCH_BODY, PLIANT_WRONG_LENGTH, PLIANT_BAD_THICKNESS. */
pliant_status pliant_world_set_vertex_thickness(pliant_world *world, uint32_t body,
                                                const double *thickness, size_t count,
                                                pliant_error *error);

/* ---- Questions ----------------------------------------------------------------------------- */

/* Whom a question is about. */
typedef struct pliant_selection {
    uint32_t kind;
    uint32_t a, b; /* bodies */
} pliant_selection;
enum {
    PLIANT_EVERYTHING = 0, /* all pairs of bodies that may meet, and each with itself */
    PLIANT_WORLD = 1,      /* all pairs of bodies that may meet */
    PLIANT_BETWEEN = 2,    /* bodies a and b */
    PLIANT_WITHIN = 3      /* body a with itself */
};

/* Hits in columns. A question has some of them; the others are NULL, as all are without hits. */
typedef struct pliant_hits {
    size_t count;
    const uint32_t *pairs;    /* 4: body, element, body, element. An element is the number of a
                                 triangle, a vertex (before a triangle), or an edge */
    const uint8_t *kinds;     /* a pliant_contact, or the pliant_features of close elements */
    const double *distances;
    const double *directions; /* 3: unit vector from the second to the first; 0 if they touch */
    const double *weights;    /* of the closest points: 4 of elements, 6 of triangles */
    const double *points;     /* 6: the closest points of triangles */
    const double *low, *high; /* they are apart to `low`, and meet after it and by `high` */
} pliant_hits;

/* How a question is asked. All zero: everything, all hits, sorted. */
typedef struct pliant_query {
    pliant_selection of;
    uint8_t first;    /* 1: some hit, the earliest impact; 0: all */
    uint8_t unsorted; /* 1: in job order, equal for any number of threads; 0: sorted */
    uint64_t at_most; /* most hits of a list, else PLIANT_TOO_MANY_HITS; 0: any number */
    /* Is shown every hit once, some at a time, instead of a list; ends the question by another
       number than 0. The hits are there during the call. NULL: no visitor. */
    int (*visit)(void *user, const pliant_hits *some);
    /* Ends the question early by another number than 0. Any thread of the world may call it,
       several at a time, and nearly always does every 10 milliseconds; Rust's document of
       Query::interrupt_if names what takes longer. NULL: never. */
    int (*interrupt)(void *user);
    void *user; /* given to both */
} pliant_query;

/* Every question writes `hits`, unless it is NULL: views, valid until the same question is asked of
   this world again, or it is freed. Lists of different questions live side by side, whatever
   changes. NULL for `query` stands for all zero.

   PLIANT_NO_SUCH_BODY, PLIANT_SAME_BODY, PLIANT_BAD_OPTION, PLIANT_TOO_MANY_HITS,
   PLIANT_INTERRUPTED. */

/* Triangles that intersect, as closed sets. Of one body, those that share no vertex. pairs. */
pliant_status pliant_world_intersections(pliant_world *world, const pliant_query *query,
                                         pliant_hits *hits, pliant_error *error);

/* Triangles that intersect, with their kinds: of one kind alone, or with PLIANT_APART of all.
   pairs, kinds. */
pliant_status pliant_world_contacts(pliant_world *world, const pliant_query *query,
                                    pliant_contact only, pliant_hits *hits, pliant_error *error);

/* Triangles of one body that share a vertex and meet beyond it. As pliant_world_contacts. */
pliant_status pliant_world_adjacent_intersections(pliant_world *world, const pliant_query *query,
                                                  pliant_contact only, pliant_hits *hits,
                                                  pliant_error *error);

/* Edges that cross triangles: edge, triangle. pairs. */
pliant_status pliant_world_crossing_edges(pliant_world *world, const pliant_query *query,
                                          pliant_hits *hits, pliant_error *error);

/* Candidates: elements whose boxes, each grown by `radius`, meet somewhere on their way. The box of
   an element is the hull of its corners at both ends of the motion. PLIANT_BAD_MARGIN. pairs. */
pliant_status pliant_world_vertex_triangle_candidates(pliant_world *world,
                                                      const pliant_query *query, double radius,
                                                      pliant_hits *hits, pliant_error *error);
pliant_status pliant_world_edge_edge_candidates(pliant_world *world, const pliant_query *query,
                                                double radius, pliant_hits *hits,
                                                pliant_error *error);

/* Elements and triangles that are at most `distance` apart, decided exactly. PLIANT_BAD_DISTANCE.
   pairs, distances, directions, weights; of elements kinds, of triangles points. */
pliant_status pliant_world_close_vertex_triangle_pairs(pliant_world *world,
                                                       const pliant_query *query,
                                                       double distance, pliant_hits *hits,
                                                       pliant_error *error);
pliant_status pliant_world_close_edge_edge_pairs(pliant_world *world, const pliant_query *query,
                                                 double distance, pliant_hits *hits,
                                                 pliant_error *error);
pliant_status pliant_world_close_triangle_pairs(pliant_world *world, const pliant_query *query,
                                                double distance, pliant_hits *hits,
                                                pliant_error *error);

/* Elements that meet during the motion, and when first: as pliant_vertex_triangle_impacts.
   PLIANT_BAD_WIDTH. pairs, low, high. */
pliant_status pliant_world_vertex_triangle_impacts(pliant_world *world, const pliant_query *query,
                                                   double width, pliant_hits *hits,
                                                   pliant_error *error);
pliant_status pliant_world_edge_edge_impacts(pliant_world *world, const pliant_query *query,
                                             double width, pliant_hits *hits,
                                             pliant_error *error);

/* The part of the motion, from 0 to 1, that all may go: nothing comes nearer than `min_distance`,
   unless it begins so; `step` may be NULL. PLIANT_NO_SUCH_BODY, PLIANT_SAME_BODY,
   PLIANT_BAD_OPTION, PLIANT_BAD_DISTANCE. */
pliant_status pliant_world_collision_free_step(pliant_world *world, pliant_selection of,
                                               double min_distance, double *step,
                                               pliant_error *error);

#ifdef __cplusplus
}
#endif

#endif
