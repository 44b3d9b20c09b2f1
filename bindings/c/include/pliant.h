/* pliant.h: exact collision detection for triangle meshes that deform. C11 and C++11.

   Every function that can be refused returns a status, PLIANT_OK or another, and says more in
   `error`, unless that is NULL. A refused call changes nothing but what it was to write. Nothing is
   printed, but by PLIANT_PANIC, and no state is global. No exception leaves a function.

   Arrays are read and written during the call only. They need no alignment. All may be read by
   other threads at the time. */
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
    PLIANT_NULL = 1,               /* a pointer is NULL that may not be */
    PLIANT_BAD_SCALAR = 2,         /* a pliant_scalar that is none */
    PLIANT_PANIC = 3,              /* a fault of the library, which is worth a report */
    PLIANT_OTHER = 4,              /* refused for a reason that this version has no number for */
    PLIANT_DIFFERENT_COUNTS = 10,  /* arrays of one call have different counts */
    PLIANT_BAD_CORNER = 11,        /* a coordinate is NaN, infinite or above 3.4e38 in magnitude */
    PLIANT_BAD_WIDTH = 12          /* a width is negative, infinite or NaN */
};

/* Why a call was refused. Facts that do not apply are UINT64_MAX, or NaN. */
typedef struct pliant_error {
    pliant_status status;
    uint32_t corner;      /* the corner of the pair, from 0; UINT32_MAX */
    uint64_t pair;        /* the pair of elements, from 0 */
    double number;        /* the width that is refused */
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
   corners of one triangle, then of the other. Some tens of nanoseconds a pair, microseconds where
   rounding hides a sign.

   PLIANT_NULL, PLIANT_BAD_SCALAR, PLIANT_DIFFERENT_COUNTS, PLIANT_BAD_CORNER. */
pliant_status pliant_triangle_contacts(const pliant_points corners[6], pliant_contact *contact,
                                       pliant_error *error);

#ifdef __cplusplus
}
#endif

#endif
