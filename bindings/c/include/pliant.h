/* pliant.h: exact collision detection for triangle meshes that deform. C11 and C++11.

   Every function that can be refused returns a status, PLIANT_OK or another, and says more in
   `error`, unless that is NULL; `error` is written only then. A refused call changes nothing but
   what it was to write. Nothing is printed, but by PLIANT_PANIC, and no state is global. No
   exception leaves a function. A process that has no memory left ends.

   Arrays and structures are read and written during the call only, and need no alignment. Other
   threads may read them at the time. Counts above UINT32_MAX are PLIANT_TOO_LARGE.

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
    PLIANT_BAD_SCALAR = 2,           /* an unknown pliant_scalar, or not that of the others */
    PLIANT_PANIC = 3,                /* a fault of the library, which is worth a report */
    PLIANT_OTHER = 4,                /* a reason that this version has no number for */
    PLIANT_BAD_INDEX = 5,            /* indices of an unknown size */
    PLIANT_BAD_OPTION = 6,           /* an unknown option, selection or choice */
    PLIANT_WOULD_ROUND = 7,          /* positions of double precision for a world of single */
    PLIANT_BUSY = 8,                 /* another call is inside the world */
    PLIANT_DIFFERENT_COUNTS = 10,    /* arrays of one call have different counts */
    PLIANT_BAD_CORNER = 11,          /* a coordinate: as PLIANT_BAD_POSITION, _NEEDS_SUBNORMALS */
    PLIANT_BAD_WIDTH = 12,           /* a width is negative, infinite or NaN */
    PLIANT_BAD_POINT = 13,           /* a coordinate of a point: as PLIANT_BAD_CORNER */
    PLIANT_NO_SUCH_BODY = 20,        /* the world has no such body, or has it no more */
    PLIANT_SAME_BODY = 21,           /* one body is given as two */
    PLIANT_NO_TRIANGLES = 22,        /* a body would have no triangle */
    PLIANT_TOO_LARGE = 23,           /* more triangles or vertices than 32-bit numbers keep apart */
    PLIANT_TOO_MANY_BODIES = 24,     /* all numbers of bodies were given away */
    PLIANT_VERTEX_OUT_OF_RANGE = 25, /* a triangle names a vertex that is not there */
    PLIANT_WRONG_LENGTH = 26,        /* not one for each vertex */
    PLIANT_BAD_POSITION = 27,        /* a coordinate is NaN, infinite or beyond 3.4e38 */
    PLIANT_NEEDS_SUBNORMALS = 28,    /* the thread flushes subnormal numbers, and there are some */
    PLIANT_NOT_CLOSED = 29,          /* a body has no inside: not closed at count edges */
    PLIANT_TOO_MANY_HITS = 30,       /* more than pliant_query.at_most */
    PLIANT_INTERRUPTED = 31,         /* pliant_query.interrupt said so */
    PLIANT_BAD_MARGIN = 32,          /* a radius is negative, infinite or NaN */
    PLIANT_BAD_DISTANCE = 33,        /* a distance is negative, infinite or NaN */
    PLIANT_BAD_TIME = 34,            /* a time is not from 0 to 1 */
    PLIANT_BAD_THICKNESS = 35,       /* a thickness is negative, infinite or NaN */
    PLIANT_NO_SUCH_TRIANGLE = 40,    /* the body has no triangle of this number */
    PLIANT_EMPTY_TRIANGLE = 41,      /* the triangle of this number was removed */
    PLIANT_NO_SUCH_VERTEX = 42,      /* the body has no vertex of this number */
    PLIANT_EMPTY_VERTEX = 43,        /* the vertex of this number is gone */
    PLIANT_VERTEX_IN_USE = 44,       /* an edit places a vertex that is there */
    PLIANT_NOT_A_CORNER = 45,        /* an edit splits a vertex for a triangle without it */
    PLIANT_NO_SUCH_EDGE = 46,        /* the body has no edge of this number: count */
    PLIANT_MISSING_EDGE = 47,        /* edges lack one of the mesh: vertex is its first end */
    PLIANT_NOT_AN_EDGE = 48,         /* edges have one that the mesh has not, or twice: row count */
    PLIANT_EDITED_MESH = 49,         /* edges of an edited mesh keep the numbers that they have */
    PLIANT_OUTDATED_EDIT = 50,       /* the mesh was changed since; the edit is of another world */
    PLIANT_BAD_LOOSE_BOX = 51,       /* corners are not finite, or exchanged */
    PLIANT_OUTSIDE_LOOSE_BOX = 52,   /* a position is outside the body's loose box */
    PLIANT_INVALID = 60              /* pliant_world_validate found a fault, worth a report */
};

/* Why a call was refused. Facts that do not apply are UINT32_MAX, UINT64_MAX, or NaN. */
typedef struct pliant_error {
    pliant_status status;
    uint32_t body, triangle;
    uint32_t vertex;      /* of the body; of a pair the corner, from 0 */
    uint64_t pair;        /* the pair of elements, or the point, from 0 */
    uint64_t count;       /* how many were given; the number of an edge, or its row; open edges */
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

/* Rows of numbers that belong to the library: how long they may be read is said where one is got.
   How many numbers a row has, too. NULL without rows. */
typedef struct pliant_list {
    size_t count;            /* of rows */
    const uint32_t *numbers; /* row by row */
} pliant_list;

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
   2^-30 of itself and 2^-1074, and 0 exactly if they touch. A thread that flushes subnormal numbers
   gets at least 2^-1022 else. `direction`, 3 numbers a pair, is the
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

/* Threads that several worlds share. Made and freed by the functions below; worlds that use it keep
   what they need of it. PLIANT_NULL, PLIANT_BAD_OPTION, PLIANT_OTHER: the system gives none. */
typedef struct pliant_pool pliant_pool;
pliant_status pliant_pool_new(uint32_t threads, pliant_pool **pool, pliant_error *error);
void pliant_pool_free(pliant_pool *pool); /* NULL is fine */

/* Runs task(context, number) for every number below `tasks`, and returns when all have ended. Any
   thread of the caller's may run any of them, side by side or one after the other. The calling
   thread does what is left undone. No exception may leave it. With OpenMP:

     #pragma omp parallel for
     for (size_t number = 0; number < tasks; number++) task(context, number); */
typedef void (*pliant_parallel_for)(void *user, size_t tasks,
                                    void (*task)(const void *context, size_t number),
                                    const void *context);

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
    /* Whose threads work, beside the calling one and at most `threads` with it. NULL: the world's
       own. At most one of the two may be given. */
    const pliant_pool *pool;
    pliant_parallel_for parallel_for; /* any thread that works with the world calls it */
    void *parallel_user;              /* given to parallel_for */
} pliant_options;
enum { PLIANT_CENTRE = 0, PLIANT_MEAN = 1, PLIANT_BALANCED = 2, PLIANT_CONNECTIVITY = 3 };
enum { PLIANT_BOTTOM_UP = 0, PLIANT_TOP_DOWN = 1, PLIANT_HYBRID = 2 };
enum { PLIANT_AUTO = 0, PLIANT_BRUTE_FORCE = 1, PLIANT_SWEEP_AND_PRUNE = 2, PLIANT_TREE = 3 };

/* Sets all options to their defaults. NULL is fine. Begin with this, then change what you like. */
void pliant_options_default(pliant_options *options);

/* Makes a world without bodies, to be freed by pliant_world_free. NULL stands for the defaults.
   PLIANT_BAD_OPTION, PLIANT_BAD_SCALAR. */
pliant_status pliant_world_new(const pliant_options *options, pliant_world **world,
                               pliant_error *error);

/* Copies a world, with all that it would answer, but not the answers that it gave. The copy is
   freed, too. A pool and a parallel_for are shared. */
pliant_status pliant_world_clone(const pliant_world *world, pliant_world **copy,
                                 pliant_error *error);

/* Frees a world, in which there must be no call. NULL is fine. */
void pliant_world_free(pliant_world *world);

/* The options that a world was made with, but no pool and no parallel_for. */
pliant_status pliant_world_options(const pliant_world *world, pliant_options *options,
                                   pliant_error *error);

/* ---- Bodies: shapes, meshes, motions, and who meets whom ----------------------------------- */

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
   PLIANT_NEEDS_SUBNORMALS, PLIANT_OUTSIDE_LOOSE_BOX. O(n). */
pliant_status pliant_world_set_positions(pliant_world *world, uint32_t body,
                                         pliant_points positions, pliant_error *error);

/* Gives several bodies shapes at once, all of them or none: `positions[i]` to `bodies[i]`. Statuses
   as of pliant_world_set_positions, and PLIANT_SAME_BODY. */
pliant_status pliant_world_set_positions_of(pliant_world *world, const uint32_t *bodies,
                                            const pliant_points *positions, size_t count,
                                            pliant_error *error);

/* Begins a motion of a body, on straight lines from its shape to this one. Statuses and cost as of
   pliant_world_set_positions. */
pliant_status pliant_world_set_motion(pliant_world *world, uint32_t body, pliant_points end,
                                      pliant_error *error);

/* Ends all motions at the part t of their way, from 0 to 1: shapes are then those at t.
   PLIANT_BAD_TIME. O(n). */
pliant_status pliant_world_advance_motion(pliant_world *world, double t, pliant_error *error);

/* Ends all motions at their ends, without a copy. */
pliant_status pliant_world_finish_motion(pliant_world *world, pliant_error *error);

/* Gives a body a rest shape, or takes it away with NULL: pairs of the body that are as close in it
   do not count as close. Statuses and cost as of pliant_world_set_positions. */
pliant_status pliant_world_set_rest_positions(pliant_world *world, uint32_t body,
                                              const pliant_points *positions, pliant_error *error);

/* Gives a body another mesh at these positions, and keeps its number. Statuses as of
   pliant_world_add, PLIANT_NO_SUCH_BODY and PLIANT_OUTSIDE_LOOSE_BOX. */
pliant_status pliant_world_set_mesh(pliant_world *world, uint32_t body, pliant_faces faces,
                                    pliant_points positions, pliant_error *error);

/* Numbers the edges of a body as in this list, two vertices each: every edge of the mesh once. For
   callers with numbers of their own. PLIANT_NO_SUCH_BODY, PLIANT_MISSING_EDGE, PLIANT_NOT_AN_EDGE,
   PLIANT_EDITED_MESH. */
pliant_status pliant_world_set_edges(pliant_world *world, uint32_t body, const uint32_t *edges,
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

/* Ends what pliant_world_ignore began. PLIANT_NO_SUCH_BODY. */
pliant_status pliant_world_unignore(pliant_world *world, uint32_t a, uint32_t b,
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

/* The same radius for all vertices. */
pliant_status pliant_world_set_thickness(pliant_world *world, uint32_t body, double thickness,
                                         pliant_error *error);

/* Gives a body a box that holds it in every pose to come: lower corner, upper corner, 6 numbers;
   NULL takes it away. Pairs of many bodies that move on their spot are found sooner.
   PLIANT_NO_SUCH_BODY, PLIANT_WOULD_ROUND, PLIANT_BAD_LOOSE_BOX, PLIANT_OUTSIDE_LOOSE_BOX. */
pliant_status pliant_world_set_loose_box(pliant_world *world, uint32_t body, const double *corners,
                                         pliant_error *error);

/* Builds the trees of a body anew, for the shape that it has. PLIANT_NO_SUCH_BODY. O(m log m). */
pliant_status pliant_world_rebuild(pliant_world *world, uint32_t body, pliant_error *error);

/* ---- Questions with a list ----------------------------------------------------------------- */

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

/* Rows of hits, one for each element that may be the first of a pair (CSR). Rows of one body
   follow each other by number, bodies by theirs. */
typedef struct pliant_rows {
    size_t count;            /* of rows */
    const uint32_t *offsets; /* count + 1: row i has the places from offsets[i] to offsets[i + 1] */
    const uint32_t *places;  /* of hits in their columns; ascending in a row */
    size_t body_count;
    const uint32_t *bodies;  /* in the order of their rows */
    const size_t *starts;    /* the first row of each body */
} pliant_rows;

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
    pliant_rows rows;         /* if they are asked for, else all 0 */
} pliant_hits;

/* How a question is asked. All zero: everything, all hits, sorted. */
typedef struct pliant_query {
    pliant_selection of;
    uint8_t how;      /* PLIANT_ALL to PLIANT_PREPARE */
    uint64_t at_most; /* most hits of a list, else PLIANT_TOO_MANY_HITS; 0: any, as of a visit */
    /* Is shown every hit once, some at a time, instead of a list. Another number than 0 ends the
       question. The calling thread calls it, with hits that are there during the call. Groups and
       order do not depend on threads. NULL: no visitor. */
    int (*visit)(void *user, const pliant_hits *some);
    /* Ends the question early by another number than 0. Any thread of the world may call it,
       several at a time. It nearly always does every 10 milliseconds; Rust's document of
       Query::interrupt_if names what takes longer. NULL: never. */
    int (*interrupt)(void *user);
    void *user; /* given to both, which no exception and no longjmp may leave */
} pliant_query;
enum {
    PLIANT_ALL = 0,      /* all hits, sorted; the only one with a visitor */
    PLIANT_UNSORTED = 1, /* all hits in job order, which is equal for any number of threads */
    PLIANT_FIRST = 2,    /* some hit; of impacts the earliest */
    PLIANT_ROWS = 3,     /* all hits in job order, and rows of them */
    PLIANT_PREPARE = 4   /* no hits: the work ahead of a question, for those who time it */
};

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

/* ---- Questions with one answer --------------------------------------------------------------

   Of `query` they read `of`, `interrupt` and `user`, distances not `of`; all else must be 0.
   Views are valid until the same function is called again with the world, or it is freed. All may
   return PLIANT_NO_SUCH_BODY, PLIANT_SAME_BODY, PLIANT_BAD_OPTION, PLIANT_INTERRUPTED. */

/* The closest triangles of two bodies, if these are at most `cut_off` apart: one hit, as of
   pliant_world_close_triangle_pairs, or none. `cut_off` may be infinite. Filters and motions do not
   count. PLIANT_BAD_DISTANCE. */
pliant_status pliant_world_distance(pliant_world *world, uint32_t a, uint32_t b, double cut_off,
                                    const pliant_query *query, pliant_hits *hits,
                                    pliant_error *error);

/* The nearest of the bodies that this one may meet, as pliant_world_distance. */
pliant_status pliant_world_nearest_body(pliant_world *world, uint32_t body, double cut_off,
                                        const pliant_query *query, pliant_hits *hits,
                                        pliant_error *error);

/* The first impact of both kinds on the way: one hit or none. kinds is PLIANT_VERTEX_FACE for a
   vertex and a triangle, else PLIANT_EDGE_EDGE. pairs, low, high, kinds. PLIANT_BAD_WIDTH. */
pliant_status pliant_world_first_impact(pliant_world *world, const pliant_query *query,
                                        double width, pliant_hits *hits, pliant_error *error);

/* The part of the motion, from 0 to 1, that all may go, for pliant_world_advance_motion: nothing
   comes nearer than `min_distance`, unless it begins so. PLIANT_BAD_DISTANCE. */
pliant_status pliant_world_collision_free_step(pliant_world *world, const pliant_query *query,
                                               double min_distance, double *step,
                                               pliant_error *error);

/* A free step, and how it begins. Nothing is promised for what is in contact at the start. */
typedef struct pliant_free_step {
    double t;         /* as of pliant_world_collision_free_step */
    uint32_t pair[4]; /* body, element, body, element: the first pair in contact at the start */
    uint8_t begins_in_contact; /* what these are, PLIANT_NO_CONTACT to PLIANT_EDGES_NEAR */
    uint8_t moves;             /* 1 if any body has a motion, else 0, and t is 1 */
} pliant_free_step;
enum {
    PLIANT_NO_CONTACT = 0,     /* everything begins apart */
    PLIANT_INTERSECTING = 1,   /* triangles that intersect */
    PLIANT_VERTEX_NEAR = 2,    /* a vertex at most min_distance from a triangle */
    PLIANT_EDGES_NEAR = 3      /* two edges at most min_distance apart */
};
pliant_status pliant_world_free_step(pliant_world *world, const pliant_query *query,
                                     double min_distance, pliant_free_step *step,
                                     pliant_error *error);

/* How far each vertex may move before anything can touch: half the least distance of its elements,
   at most half of `cut_off`. PLIANT_BAD_DISTANCE. */
typedef struct pliant_clearance {
    size_t body_count;
    const uint32_t *bodies;  /* ascending */
    const size_t *starts;    /* body_count + 1: body i has the numbers from starts[i] on */
    const double *clearance; /* for each vertex, in the unit of the positions */
} pliant_clearance;
pliant_status pliant_world_clearance(pliant_world *world, const pliant_query *query,
                                     double cut_off, pliant_clearance *clearance,
                                     pliant_error *error);

/* Contacts of elements at most a distance apart, each once, as solvers sum them: of both lists of
   close pairs, those with the same closest features are one. */
typedef struct pliant_feature_pairs {
    size_t count;
    const pliant_features *kinds;
    const uint32_t *bodies;         /* 2: of the first feature, of the second */
    const uint32_t *numbers;        /* 2: of a vertex, an edge or a triangle */
    const uint32_t *vertices;       /* 4: of the first, of the second; UINT32_MAX in the rest */
    const double *weights;          /* 4: of these vertices in the closest points */
    const double *distances;
    const double *directions;       /* 3: from the second to the first; 0 if they touch */
    const uint32_t *multiplicities; /* how many close pairs each stands for: weight a sum by it */
} pliant_feature_pairs;
pliant_status pliant_world_feature_pairs(pliant_world *world, const pliant_query *query,
                                         double distance, pliant_feature_pairs *pairs,
                                         pliant_error *error);

/* ---- Where pairs of triangles meet -----------------------------------------------------------

   `pairs` are rows of 4 numbers as pliant_hits has them, from any question, in the present shapes.
   Views are valid as those above. PLIANT_NO_SUCH_BODY, PLIANT_NO_SUCH_TRIANGLE,
   PLIANT_EMPTY_TRIANGLE. */

/* Feature of a triangle: PLIANT_ON_CORNER + 0, 1, 2, PLIANT_ON_EDGE + 0, 1, 2, or PLIANT_INSIDE.
   Edge k begins at corner k. */
enum { PLIANT_ON_CORNER = 0, PLIANT_ON_EDGE = 3, PLIANT_INSIDE = 6 };

/* A point, a segment or a polygon for each pair. An end is exactly on the features that are said;
   its point is rounded. */
typedef struct pliant_segments {
    size_t count;             /* of pairs */
    const uint64_t *offsets;  /* count + 1: pair i has the ends from offsets[i] to offsets[i + 1] */
    const double *points;     /* 3 an end */
    const uint8_t *on;        /* 2 an end: features of the first triangle and of the second */
    const double *parameters; /* 2 an end: from 0 to 1 along edges, else NaN */
    const double *normals;    /* 6 a pair: unit normals of both triangles */
    const uint8_t *flat;      /* 1 a pair: 1 if they lie in one plane */
} pliant_segments;
pliant_status pliant_world_segments(pliant_world *world, const uint32_t *pairs, size_t count,
                                    pliant_segments *segments, pliant_error *error);

/* Segments linked to curves, by the features of their ends alone. Give every pair once; for curves
   of a body with itself those of pliant_world_adjacent_intersections, too. `areas` is 1 for areas,
   which take O(m + n) a curve, else 0. PLIANT_BAD_OPTION. */
typedef struct pliant_curves {
    pliant_segments segments;
    size_t count;             /* of curves */
    const uint64_t *offsets;  /* count + 1: curve i has the steps offsets[i] to offsets[i + 1] */
    const uint64_t *steps;    /* 1 a step: the pair whose segment it is */
    const uint8_t *reversed;  /* 1 a step: 1 if it runs from the second end to the first */
    const uint8_t *swapped;   /* 1 a step: 1 if the second triangle is on the first side */
    const double *lengths;    /* 1 a curve, rounded */
    const uint8_t *closed;    /* 1 a curve */
    const uint8_t *ends;      /* 2 a curve: PLIANT_BORDER to PLIANT_BRANCHING, or PLIANT_NO_END */
    const double *areas;      /* 2 a curve: enclosed on both sides, NaN for none; NULL unasked */
    size_t touching_count;
    const uint64_t *touching; /* pairs that meet in one point, where no curve is */
} pliant_curves;
enum {
    PLIANT_BORDER = 0,        /* nothing goes on: at the border of a mesh, or a pair is missing */
    PLIANT_SHARED_VERTEX = 1, /* at a vertex that both triangles have */
    PLIANT_OVERLAP = 2,       /* at a corner of an overlap of triangles in one plane */
    PLIANT_BRANCHING = 3,     /* three or more segments end there */
    PLIANT_NO_END = 255       /* the curve is closed */
};
pliant_status pliant_world_curves(pliant_world *world, const uint32_t *pairs, size_t count,
                                  uint8_t areas, pliant_curves *curves, pliant_error *error);

/* ---- Inside and outside, closest points, depth -----------------------------------------------

   Of bodies in their present shapes; but for pliant_world_contained, filters do not count. Of
   `query` they read `interrupt` and `user`, pliant_world_contained also `of`; all else must be 0.
   Views are valid until the same function is called again with the world, or it is freed. All may
   return PLIANT_NO_SUCH_BODY, all with a query PLIANT_BAD_OPTION and PLIANT_INTERRUPTED.

   Those with `points` may return PLIANT_BAD_SCALAR, PLIANT_WOULD_ROUND and PLIANT_BAD_POINT, which
   says which point in `pair`. Those that ask for an inside return PLIANT_NOT_CLOSED for a body that
   has none. */

/* Edges at which a body is not a closed surface, 2 vertices a row, the lower one first; sorted. It
   is closed, and has an inside, if no edge is open or turned. An edge is two vertices, wherever
   they are: seams are open until they are welded. */
typedef struct pliant_watertight {
    pliant_list open;    /* in an odd number of triangles: borders of holes */
    pliant_list turned;  /* in an even number that are turned against each other */
    pliant_list doubled; /* in more than two triangles, which is as closed */
} pliant_watertight;
pliant_status pliant_world_watertight(const pliant_world *world, uint32_t body,
                                      pliant_watertight *edges, pliant_error *error);

/* Where inside is, by how often a surface winds round a point: 1 inside a body whose triangles are
   turned outward, 2 where it overlaps itself, -1 where it is turned inside out. */
typedef uint8_t pliant_inside_rule;
enum {
    PLIANT_NON_ZERO = 0, /* the winding number is not 0 */
    PLIANT_POSITIVE = 1, /* it is above 0 */
    PLIANT_PARITY = 2    /* a ray crosses the surface an odd number of times; edges may be turned */
};

/* Side of a closed surface. */
typedef uint8_t pliant_side;
enum {
    PLIANT_IS_OUTSIDE = 0,
    PLIANT_IS_ON = 1,    /* in one of its triangles */
    PLIANT_IS_INSIDE = 2
};

/* On which side points are. */
typedef struct pliant_located {
    size_t count;
    const pliant_side *sides;
    const int32_t *windings; /* 0 on the surface; by PLIANT_PARITY 1 inside, else 0 */
} pliant_located;

/* On which side of a closed body points are, decided exactly, however near. Right for bodies that
   cross themselves. */
pliant_status pliant_world_points_inside(pliant_world *world, pliant_points points, uint32_t body,
                                         pliant_inside_rule rule, const pliant_query *query,
                                         pliant_located *located, pliant_error *error);

/* On which side of body `b`, a closed one, the vertices of body `a` are: one for each number. Empty
   numbers are outside. PLIANT_SAME_BODY. */
pliant_status pliant_world_inside(pliant_world *world, uint32_t a, uint32_t b,
                                  pliant_inside_rule rule, const pliant_query *query,
                                  pliant_located *located, pliant_error *error);

/* Components that lie inside other bodies, by PLIANT_NON_ZERO. None of its triangles crosses or
   overlaps the body's, no vertex is outside, and one is inside. Of a selection of all these are
   the bodies that may meet; of two either in the other. PLIANT_SAME_BODY. */
typedef struct pliant_containment {
    pliant_list all;  /* 3: body, component as of pliant_world_components, body round it; sorted */
    pliant_list open; /* bodies that are not closed, of whose inside nothing is said; ascending */
} pliant_containment;
pliant_status pliant_world_contained(pliant_world *world, const pliant_query *query,
                                     pliant_containment *contained, pliant_error *error);

/* All bodies, instead of one. */
#define PLIANT_ALL_BODIES UINT32_MAX

/* The closest point of a body for each of some points, in columns. Where none is within the cut-off
   `found` is 0, and all else UINT32_MAX, 255, infinity for distances, or NaN. */
typedef struct pliant_closest {
    size_t count;
    const uint8_t *found;
    const uint32_t *bodies;
    const uint32_t *triangles; /* exactly the nearest; of several the first */
    const double *distances;   /* as good as those of close triangles; 0 exactly on the surface */
    const double *points;      /* 3: the closest point, rounded */
    const uint8_t *features;   /* of the triangle, PLIANT_ON_CORNER to PLIANT_INSIDE, exactly */
    const double *weights;     /* 3: of the triangle's corners in the closest point */
    const double *directions;  /* 3: unit vector from the closest point; 0 at distance 0 */
} pliant_closest;

/* The closest points of a body, closed or not, or with PLIANT_ALL_BODIES of all. None further than
   `cut_off`, which is decided exactly, and may be infinite. PLIANT_BAD_DISTANCE. */
pliant_status pliant_world_closest_points(pliant_world *world, pliant_points points, uint32_t body,
                                          double cut_off, const pliant_query *query,
                                          pliant_closest *closest, pliant_error *error);

/* The same of a closed body, with distances below 0 inside it, by PLIANT_NON_ZERO. The signs are
   exact. */
pliant_status pliant_world_signed_closest_points(pliant_world *world, pliant_points points,
                                                 uint32_t body, double cut_off,
                                                 const pliant_query *query,
                                                 pliant_closest *closest, pliant_error *error);

/* How deep a body reaches into a closed one. */
typedef struct pliant_depth {
    size_t count;
    const double *of_vertices; /* distance of each vertex from the surface if inside, else 0 */
    uint32_t vertex;           /* the deepest, the first of several; UINT32_MAX if none is inside */
    double at_least;           /* its depth, else 0 */
    double at_most;            /* no point of the surface is deeper; 0 if no triangle meets the
                                  other body or has a corner inside */
} pliant_depth;

/* How deep body `a`, closed or not, reaches into body `b`, by PLIANT_NON_ZERO. PLIANT_SAME_BODY. */
pliant_status pliant_world_depth(pliant_world *world, uint32_t a, uint32_t b,
                                 const pliant_query *query, pliant_depth *depth,
                                 pliant_error *error);

/* ---- Meshes that change ----------------------------------------------------------------------

   An edit is a list of steps for one body, applied all at once or not at all. Numbers stay: what
   goes leaves its number empty, what comes is numbered behind all others. A step says nothing yet;
   pliant_world_apply refuses what cannot be. Into one edit goes one call at a time, else
   PLIANT_BUSY. What pliant_edited, pliant_piece and pliant_fused show is valid until the next
   apply, weld, split or fuse of the world, or until it is freed. */
typedef struct pliant_edit pliant_edit;

/* Begins an edit, to be freed by pliant_edit_free. PLIANT_NO_SUCH_BODY. */
pliant_status pliant_world_edit(const pliant_world *world, uint32_t body, pliant_edit **edit,
                                pliant_error *error);
void pliant_edit_free(pliant_edit *edit); /* NULL is fine */

/* The body, and how many numbers there are after the steps so far; any may be NULL. */
pliant_status pliant_edit_counts(const pliant_edit *edit, uint32_t *body, size_t *triangles,
                                 size_t *vertices, pliant_error *error);

/* Adds vertices, and says the number of the first. PLIANT_BAD_SCALAR, PLIANT_WOULD_ROUND. */
pliant_status pliant_edit_add_vertices(pliant_edit *edit, pliant_points positions, uint32_t *first,
                                       pliant_error *error);

/* Places a vertex under an empty number, at one point. PLIANT_BAD_SCALAR, PLIANT_WOULD_ROUND,
   PLIANT_WRONG_LENGTH. */
pliant_status pliant_edit_place_vertex(pliant_edit *edit, uint32_t vertex, pliant_points point,
                                       pliant_error *error);

/* Adds a vertex in the place of one, and gives it to these triangles instead. */
pliant_status pliant_edit_split_vertex(pliant_edit *edit, uint32_t vertex,
                                       const uint32_t *triangles, size_t count,
                                       uint32_t *new_vertex, pliant_error *error);

/* Gives all triangles of vertex `gone` the vertex `kept`, which stays where it is. */
pliant_status pliant_edit_merge_vertices(pliant_edit *edit, uint32_t kept, uint32_t gone,
                                         pliant_error *error);

/* Adds triangles, and says the number of the first. PLIANT_BAD_INDEX,
   PLIANT_VERTEX_OUT_OF_RANGE. */
pliant_status pliant_edit_add_triangles(pliant_edit *edit, pliant_faces faces, uint32_t *first,
                                        pliant_error *error);

/* Gives a triangle three other corners, or uses an empty number again. */
pliant_status pliant_edit_set_triangle(pliant_edit *edit, uint32_t triangle,
                                       const uint32_t *corners, pliant_error *error);

/* Removes triangles. */
pliant_status pliant_edit_remove_triangles(pliant_edit *edit, const uint32_t *triangles,
                                           size_t count, pliant_error *error);

/* Numbers that have changed, one a row, each list ascending. */
typedef struct pliant_edited {
    pliant_list new_triangles, changed_triangles, removed_triangles;
    pliant_list new_vertices, removed_vertices;
} pliant_edited;

/* Applies an edit of this world. PLIANT_OUTDATED_EDIT, PLIANT_NO_SUCH_BODY, and what a step cannot
   do: PLIANT_NO_SUCH_TRIANGLE to PLIANT_NOT_A_CORNER, PLIANT_VERTEX_OUT_OF_RANGE,
   PLIANT_BAD_POSITION, PLIANT_NEEDS_SUBNORMALS, PLIANT_NO_TRIANGLES, PLIANT_TOO_LARGE,
   PLIANT_OUTSIDE_LOOSE_BOX. */
pliant_status pliant_world_apply(pliant_world *world, const pliant_edit *edit,
                                 pliant_edited *edited, pliant_error *error);

/* Makes vertices of boundary edges one where the edges coincide within a tolerance. Of `query`
   it reads `interrupt` and `user`; how, at_most and visit must be 0. PLIANT_NO_SUCH_BODY,
   PLIANT_BAD_DISTANCE, PLIANT_BAD_OPTION, PLIANT_INTERRUPTED. */
pliant_status pliant_world_weld(pliant_world *world, uint32_t body, double tolerance,
                                const pliant_query *query, pliant_edited *edited,
                                pliant_error *error);

/* A body that was a component of another: the numbers that its triangles and vertices had. */
typedef struct pliant_piece {
    uint32_t body;
    pliant_list triangles, vertices;
} pliant_piece;

/* Makes each connected component but the largest a body of its own. PLIANT_NO_SUCH_BODY,
   PLIANT_TOO_MANY_BODIES. */
pliant_status pliant_world_split(pliant_world *world, uint32_t body, const pliant_piece **pieces,
                                 size_t *count, pliant_error *error);

/* New numbers of what came from the second body; UINT32_MAX for numbers that were empty. */
typedef struct pliant_fused {
    pliant_list triangles, vertices;
} pliant_fused;

/* Puts body `b` into body `a`, and removes it. Unless both have a loose box, `a` then has none.
   PLIANT_NO_SUCH_BODY, PLIANT_SAME_BODY, PLIANT_TOO_LARGE. */
pliant_status pliant_world_fuse(pliant_world *world, uint32_t a, uint32_t b, pliant_fused *fused,
                                pliant_error *error);

/* ---- Changes of a list from step to step -----------------------------------------------------

   Remembers the last list of one question. A hit keeps its number while it is in every list. Into
   one memory goes one call at a time, else PLIANT_BUSY. */
typedef struct pliant_changes pliant_changes;
enum {
    PLIANT_TRIANGLES = 0,       /* the pairs are of triangles */
    PLIANT_VERTEX_TRIANGLE = 1, /* of a vertex and a triangle */
    PLIANT_EDGES = 2,           /* of edges */
    PLIANT_EDGE_TRIANGLE = 3    /* of an edge and a triangle: crossing edges */
};

/* Remembers nothing yet: all hits of the first list begin. PLIANT_BAD_OPTION. */
pliant_status pliant_changes_new(uint32_t elements, pliant_changes **changes, pliant_error *error);
void pliant_changes_free(pliant_changes *changes); /* NULL is fine */

/* What began and ended; valid until the next update. */
typedef struct pliant_changed {
    size_t count;
    const uint64_t *numbers;       /* of each hit of the new list */
    size_t began_count;
    const uint64_t *began;         /* places in the new list, ascending */
    size_t ended_count;
    const uint32_t *ended;         /* 4: body, element, body, element */
    const uint64_t *ended_numbers; /* that these had */
} pliant_changed;

/* Compares a list with the last one, and remembers it: `pairs` of pliant_hits. */
pliant_status pliant_changes_update(pliant_changes *changes, const uint32_t *pairs, size_t count,
                                    pliant_changed *changed, pliant_error *error);

/* Tell it of every edit, split and fusion between two lists. Of edges it takes rows of 2 vertices,
   before an edit and after; copy the list of pliant_world_edges before you ask for it again. */
pliant_status pliant_changes_edited(pliant_changes *changes, uint32_t body,
                                    const pliant_edited *edited, pliant_error *error);
pliant_status pliant_changes_edges_edited(pliant_changes *changes, uint32_t body,
                                          const uint32_t *before, size_t before_count,
                                          const uint32_t *after, size_t after_count,
                                          pliant_error *error);
pliant_status pliant_changes_split(pliant_changes *changes, uint32_t body,
                                   const pliant_piece *pieces, size_t count, pliant_error *error);
pliant_status pliant_changes_fused(pliant_changes *changes, uint32_t body, uint32_t gone,
                                   const pliant_fused *fused, pliant_error *error);

/* ---- What a world has ------------------------------------------------------------------------

   A list is valid until the same function is called again with the world, for whatever body, or it
   is freed. All but those without a body may return PLIANT_NO_SUCH_BODY. */

/* All bodies, ascending. */
pliant_status pliant_world_bodies(const pliant_world *world, pliant_list *bodies,
                                  pliant_error *error);

/* Counts of a body's triangles and vertices, empty numbers included; either may be NULL. */
pliant_status pliant_world_counts(const pliant_world *world, uint32_t body, size_t *triangles,
                                  size_t *vertices, pliant_error *error);

/* Triangles, 3 vertices a row; UINT32_MAX three times for an empty number. */
pliant_status pliant_world_triangles(const pliant_world *world, uint32_t body,
                                     pliant_list *triangles, pliant_error *error);

/* Edges in the order of their numbers, 2 vertices a row. */
pliant_status pliant_world_edges(const pliant_world *world, uint32_t body, pliant_list *edges,
                                 pliant_error *error);

/* Copies positions into `out`, 3 numbers a row, a row for each vertex: `count` is of vertices.
   PLIANT_WRONG_LENGTH. */
pliant_status pliant_world_positions(const pliant_world *world, uint32_t body, double *out,
                                     size_t count, pliant_error *error);

/* The same at the end of a motion, if there is one: then `moves` is 1, else 0 and `out` is left. */
pliant_status pliant_world_end_positions(const pliant_world *world, uint32_t body, double *out,
                                         size_t count, uint8_t *moves, pliant_error *error);

/* The same of a rest shape, if there is one: then `rests` is 1, else 0 and `out` is left. */
pliant_status pliant_world_rest_positions(const pliant_world *world, uint32_t body, double *out,
                                          size_t count, uint8_t *rests, pliant_error *error);

/* Copies the thickness of each vertex into `out`. PLIANT_WRONG_LENGTH. */
pliant_status pliant_world_thickness(const pliant_world *world, uint32_t body, double *out,
                                     size_t count, pliant_error *error);

/* What pliant_world_set_filter has set; either may be NULL. */
pliant_status pliant_world_filter(const pliant_world *world, uint32_t body, uint32_t *membership,
                                  uint32_t *mask, pliant_error *error);

/* What pliant_world_set_environment has set. */
pliant_status pliant_world_environment(const pliant_world *world, uint32_t body,
                                       uint32_t *environment, pliant_error *error);

/* Pairs of bodies that ignore each other, 2 a row. */
pliant_status pliant_world_ignored(const pliant_world *world, pliant_list *pairs,
                                   pliant_error *error);

/* What pliant_world_set_labels has set; NULL for no labels, or for neighbours that were not given.
   An empty list of neighbours is not NULL. */
pliant_status pliant_world_labels(const pliant_world *world, uint32_t body, pliant_list *labels,
                                  pliant_list *neighbours, pliant_error *error);

/* The group of each vertex. */
pliant_status pliant_world_vertex_groups(const pliant_world *world, uint32_t body,
                                         pliant_list *groups, pliant_error *error);

/* The loose box, 6 numbers, if there is one: then `has` is 1, else 0 and `corners` is left. */
pliant_status pliant_world_loose_box(const pliant_world *world, uint32_t body, double *corners,
                                     uint8_t *has, pliant_error *error);

/* Whether each number is there, 1, or empty, 0. */
pliant_status pliant_world_live_triangles(const pliant_world *world, uint32_t body,
                                          pliant_list *live, pliant_error *error);
pliant_status pliant_world_live_vertices(const pliant_world *world, uint32_t body,
                                         pliant_list *live, pliant_error *error);

/* How often the mesh was changed. */
pliant_status pliant_world_mesh_revision(const pliant_world *world, uint32_t body,
                                         uint64_t *revision, pliant_error *error);

/* The connected component of each triangle; UINT32_MAX for an empty number. O(m + n). */
pliant_status pliant_world_components(const pliant_world *world, uint32_t body,
                                      pliant_list *components, pliant_error *error);

/* The order in which questions read vertices: bodies whose vertices come so are faster. */
pliant_status pliant_world_vertex_order(const pliant_world *world, uint32_t body,
                                        pliant_list *order, pliant_error *error);

/* How many times as much questions work as with a tree built anew; 1 before one says anything. */
pliant_status pliant_world_tree_quality(const pliant_world *world, uint32_t body, double *quality,
                                        pliant_error *error);

/* Depth and counts of a body's tree. */
typedef struct pliant_tree_shape {
    uint32_t depth;       /* level of the deepest leaf; the root's is 0 */
    size_t nodes, leaves; /* leaves and root are nodes, too */
} pliant_tree_shape;
pliant_status pliant_world_tree_shape(const pliant_world *world, uint32_t body,
                                      pliant_tree_shape *shape, pliant_error *error);

/* For each triangle the part of the tree that it is in, at a level; UINT32_MAX if it is empty. */
pliant_status pliant_world_tree_cut(const pliant_world *world, uint32_t body, uint32_t level,
                                    pliant_list *parts, pliant_error *error);

/* Boxes of these parts. */
typedef struct pliant_boxes {
    size_t count;
    const double *corners; /* 6: lower corner, upper corner */
    const uint8_t *valid;  /* whether the tree holds it for the present shape */
} pliant_boxes;
pliant_status pliant_world_tree_boxes(const pliant_world *world, uint32_t body, uint32_t level,
                                      pliant_boxes *boxes, pliant_error *error);

/* Work of the last question, equal for any number of threads, unless it was a first one. */
typedef struct pliant_statistics {
    uint64_t body_pairs;       /* whose trees were traversed */
    uint64_t boxes_bottom_up;  /* refitted ahead of a traversal */
    uint64_t boxes_top_down;   /* refitted when a traversal reached them */
    uint64_t triangle_boxes;   /* of single triangles in leaves of several */
    uint64_t node_pairs;       /* with boxes that overlap */
    uint64_t candidate_pairs;  /* of triangles that were decided */
    uint64_t scalar_decisions; /* of moving elements, decided one by one */
    uint64_t exact_decisions;  /* that needed exact arithmetic */
    uint64_t pairs;            /* hits */
} pliant_statistics;
pliant_status pliant_world_statistics(const pliant_world *world, pliant_statistics *statistics,
                                      pliant_error *error);

/* Memory of a world in bytes, without answers that it keeps for the caller. */
pliant_status pliant_world_memory_usage(const pliant_world *world, size_t *bytes,
                                        pliant_error *error);

/* Checks every invariant of every tree. PLIANT_INVALID. O(m) a level. */
pliant_status pliant_world_validate(const pliant_world *world, pliant_error *error);

#ifdef __cplusplus
}
#endif

#endif
