/* Every function on single pairs, with arrays of every layout and every wrong argument. C11 and
   C++17. */
#include "check.h"

#include <math.h>
#include <string.h>

enum { PAIRS = 3000 };

static double random_coordinate(void) {
    static uint64_t state = 9;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (double)(state >> 40) / 16777216.0;
}

/* Points of the corners of pairs in one array (PAIRS, corners, 3). */
static void points_of(pliant_points *points, const double *all, int corners, size_t count) {
    for (int corner = 0; corner < corners; corner++) {
        points[corner].data = all + 3 * corner;
        points[corner].count = count;
        points[corner].row = (ptrdiff_t)(3 * (size_t)corners * sizeof(double));
        points[corner].column = (ptrdiff_t)sizeof(double);
        points[corner].scalar = PLIANT_F64;
    }
}

/* The same points in columns, as Eigen has them: x of all, then y, then z. One array a corner. */
static void columns_of(pliant_points *points, double *into, const double *all, int corners) {
    for (int corner = 0; corner < corners; corner++) {
        double *columns = into + 3 * PAIRS * corner;
        for (int pair = 0; pair < PAIRS; pair++) {
            for (int axis = 0; axis < 3; axis++) {
                columns[axis * PAIRS + pair] = all[3 * (pair * corners + corner) + axis];
            }
        }
        points[corner].data = columns;
        points[corner].row = (ptrdiff_t)sizeof(double);
        points[corner].column = (ptrdiff_t)(PAIRS * sizeof(double));
        points[corner].count = PAIRS;
        points[corner].scalar = PLIANT_F64;
    }
}

/* The same points as rows of bytes that are aligned to nothing: one array a corner. */
static void unaligned_of(pliant_points *points, char *into, const double *all, int corners) {
    for (int corner = 0; corner < corners; corner++) {
        char *rows = into + 1 + corner * PAIRS * 25;
        for (int pair = 0; pair < PAIRS; pair++) {
            memcpy(rows + 25 * pair, all + 3 * (pair * corners + corner), 24);
        }
        points[corner].data = rows;
        points[corner].row = 25;
        points[corner].column = 8;
        points[corner].count = PAIRS;
        points[corner].scalar = PLIANT_F64;
    }
}

static double start[PAIRS * 12], end[PAIRS * 12], triangles[PAIRS * 18];
static double in_columns[2][PAIRS * 18];
static char unaligned[2][PAIRS * 25 * 6 + 1];

typedef struct {
    uint8_t hit[PAIRS], features[PAIRS], contact[PAIRS];
    double low[PAIRS], high[PAIRS], distance[PAIRS], direction[3 * PAIRS], weights[4 * PAIRS];
} answers;

static void ask(answers *found, int are_edges, const pliant_points *from, const pliant_points *to,
                const pliant_points *of_triangles) {
    pliant_error error;
    memset(found, 0, sizeof *found);
    CHECK((are_edges ? pliant_edge_edge_impacts : pliant_vertex_triangle_impacts)(
              from, to, 1e-6, found->hit, found->low, found->high, &error) == PLIANT_OK);
    CHECK((are_edges ? pliant_edge_edge_distances : pliant_vertex_triangle_distances)(
              from, found->distance, found->direction, found->weights, found->features, &error) ==
          PLIANT_OK);
    CHECK(pliant_triangle_contacts(of_triangles, found->contact, &error) == PLIANT_OK);
}

static answers reference, found;

static void layouts_give_the_same(int are_edges) {
    pliant_points from[4], to[4], of_triangles[6];
    points_of(from, start, 4, PAIRS);
    points_of(to, end, 4, PAIRS);
    points_of(of_triangles, triangles, 6, PAIRS);
    ask(&reference, are_edges, from, to, of_triangles);
    int hits = 0, counts[4] = {0, 0, 0, 0}, of_features[4] = {0, 0, 0, 0};
    for (int pair = 0; pair < PAIRS; pair++) {
        hits += reference.hit[pair];
        CHECK(reference.hit[pair] ? reference.high[pair] - reference.low[pair] <= 1e-6
                                  : isnan(reference.low[pair]) && isnan(reference.high[pair]));
        counts[reference.contact[pair]]++;
        of_features[reference.features[pair]]++;
        const double *weights = reference.weights + 4 * pair;
        const double *direction = reference.direction + 3 * pair;
        double points[2][3];
        for (int axis = 0; axis < 3; axis++) {
            const double *corners = start + 12 * pair + axis;
            points[0][axis] = weights[0] * corners[0] + (are_edges ? weights[1] * corners[3] : 0);
            points[1][axis] = (are_edges ? 0 : weights[1] * corners[3]) + weights[2] * corners[6] +
                              weights[3] * corners[9];
            double along = points[0][axis] - points[1][axis];
            CHECK(fabs(along - reference.distance[pair] * direction[axis]) < 1e-6);
        }
    }
    CHECK(hits > PAIRS / 100 && hits < PAIRS / 2);
    CHECK(counts[PLIANT_APART] > 100 && counts[PLIANT_TOUCHING] > 100);
    CHECK(counts[PLIANT_CROSSING] > 100 && counts[PLIANT_OVERLAPPING] > 10);
    CHECK(of_features[PLIANT_VERTEX_VERTEX] > 100 && of_features[PLIANT_VERTEX_EDGE] > 100);
    CHECK(of_features[are_edges ? PLIANT_EDGE_EDGE : PLIANT_VERTEX_FACE] > 100);

    /* Zero for both strides are packed rows, here of each corner. */
    columns_of(from, in_columns[0], start, 4);
    columns_of(to, in_columns[1], end, 4);
    ask(&found, are_edges, from, to, of_triangles);
    CHECK(memcmp(&found, &reference, sizeof found) == 0);
    unaligned_of(from, unaligned[0], start, 4);
    unaligned_of(of_triangles, unaligned[1], triangles, 6);
    ask(&found, are_edges, from, to, of_triangles);
    CHECK(memcmp(&found, &reference, sizeof found) == 0);
    static double packed[4][PAIRS][3];
    for (int corner = 0; corner < 4; corner++) {
        for (int pair = 0; pair < PAIRS; pair++) {
            memcpy(packed[corner][pair], start + 3 * (pair * 4 + corner), sizeof packed[0][0]);
        }
        from[corner].data = packed[corner];
        from[corner].row = from[corner].column = 0;
    }
    ask(&found, are_edges, from, to, of_triangles);
    CHECK(memcmp(&found, &reference, sizeof found) == 0);
}

static void single_precision(void) {
    static float corners[PAIRS * 12];
    static double widened[PAIRS * 12];
    pliant_points narrow[4], wide[4];
    static double distances[2][PAIRS];
    for (int i = 0; i < PAIRS * 12; i++) {
        corners[i] = (float)start[i];
        widened[i] = corners[i];
    }
    points_of(wide, widened, 4, PAIRS);
    for (int corner = 0; corner < 4; corner++) {
        narrow[corner] = wide[corner];
        narrow[corner].data = corners + 3 * corner;
        narrow[corner].row = 48;
        narrow[corner].column = 4;
        narrow[corner].scalar = PLIANT_F32;
    }
    CHECK(pliant_vertex_triangle_distances(narrow, distances[0], NULL, NULL, NULL, NULL) == 0);
    CHECK(pliant_vertex_triangle_distances(wide, distances[1], NULL, NULL, NULL, NULL) == 0);
    for (int pair = 0; pair < PAIRS; pair++) {
        CHECK(fabs(distances[0][pair] - distances[1][pair]) <= 1e-8 * distances[1][pair]);
    }
    CHECK(pliant_edge_edge_impacts(narrow, narrow, 0.0, NULL, NULL, NULL, NULL) == PLIANT_OK);
    CHECK(pliant_edge_edge_impacts(narrow, wide, 0.0, NULL, NULL, NULL, NULL) ==
          PLIANT_DIFFERENT_COUNTS);
}

static void wrong_arguments(void) {
    pliant_points from[4], to[4], of_triangles[6];
    pliant_error error;
    points_of(from, start, 4, PAIRS);
    points_of(to, end, 4, PAIRS);
    points_of(of_triangles, triangles, 6, PAIRS);
    refused(pliant_vertex_triangle_impacts(NULL, to, 0, NULL, NULL, NULL, &error), &error,
            PLIANT_NULL, "start is NULL");
    refused(pliant_edge_edge_impacts(from, NULL, 0, NULL, NULL, NULL, &error), &error, PLIANT_NULL,
            "end is NULL");
    refused(pliant_edge_edge_distances(NULL, NULL, NULL, NULL, NULL, &error), &error, PLIANT_NULL,
            "corners is NULL");
    refused(pliant_triangle_contacts(NULL, NULL, &error), &error, PLIANT_NULL, "corners is NULL");
    CHECK(isnan(error.number) && isnan(error.position[0]) && error.pair == UINT64_MAX);
    CHECK(pliant_triangle_contacts(NULL, NULL, NULL) == PLIANT_NULL);
    const double widths[3] = {-1.0, NAN, INFINITY};
    for (int i = 0; i < 3; i++) {
        refused(pliant_vertex_triangle_impacts(from, to, widths[i], NULL, NULL, NULL, &error),
                &error, PLIANT_BAD_WIDTH, "width");
        CHECK(isnan(widths[i]) ? isnan(error.number) : error.number == widths[i]);
    }
    from[2].data = NULL;
    refused(pliant_vertex_triangle_distances(from, NULL, NULL, NULL, NULL, &error), &error,
            PLIANT_NULL, "corners[2].data");
    points_of(from, start, 4, PAIRS);
    from[3].scalar = PLIANT_F32;
    refused(pliant_vertex_triangle_distances(from, NULL, NULL, NULL, NULL, &error), &error,
            PLIANT_BAD_SCALAR, "corners[3].scalar");
    from[0].scalar = 7;
    refused(pliant_vertex_triangle_impacts(from, to, 0, NULL, NULL, NULL, &error), &error,
            PLIANT_BAD_SCALAR, "is 7");
    points_of(from, start, 4, PAIRS);
    from[1].count = 2;
    refused(pliant_edge_edge_distances(from, NULL, NULL, NULL, NULL, &error), &error,
            PLIANT_DIFFERENT_COUNTS, "corners[1] has 2 points");
    points_of(from, start, 4, 5);
    refused(pliant_edge_edge_impacts(from, to, 0, NULL, NULL, NULL, &error), &error,
            PLIANT_DIFFERENT_COUNTS, "start has 5 pairs and end 3000");
    /* In whichever part of the pairs. */
    const double bad[3] = {NAN, INFINITY, 1e39};
    for (int i = 0; i < 3; i++) {
        const int pair = 2047 + i;
        points_of(from, start, 4, PAIRS);
        const double good = start[12 * pair + 7], other = triangles[18 * pair + 16];
        start[12 * pair + 7] = bad[i];
        triangles[18 * pair + 16] = bad[i];
        for (int layout = 0; layout < 2; layout++) {
            refused(pliant_vertex_triangle_impacts(to, from, 0, NULL, NULL, NULL, &error), &error,
                    PLIANT_BAD_CORNER, "corner 2 of pair");
            CHECK(error.pair == (uint64_t)pair && error.vertex == 2);
            CHECK(isnan(bad[i]) ? isnan(error.position[1]) : error.position[1] == bad[i]);
            refused(pliant_edge_edge_distances(from, NULL, NULL, NULL, NULL, &error), &error,
                    PLIANT_BAD_CORNER, "corner 2 of pair");
            CHECK(error.pair == (uint64_t)pair);
            columns_of(from, in_columns[0], start, 4);
        }
        refused(pliant_triangle_contacts(of_triangles, NULL, &error), &error, PLIANT_BAD_CORNER,
                "corner 5 of pair");
        start[12 * pair + 7] = good;
        triangles[18 * pair + 16] = other;
    }
    /* Nothing is asked, and nowhere. */
    memset(from, 0, sizeof from);
    memset(of_triangles, 0, sizeof of_triangles);
    CHECK(pliant_edge_edge_impacts(from, from, 0, NULL, NULL, NULL, &error) == PLIANT_OK);
    CHECK(pliant_edge_edge_distances(from, NULL, NULL, NULL, NULL, &error) == PLIANT_OK);
    CHECK(pliant_triangle_contacts(of_triangles, NULL, &error) == PLIANT_OK);
    CHECK(pliant_edge_edge_impacts(from, from, -1, NULL, NULL, NULL, &error) == PLIANT_BAD_WIDTH);
}

int main(void) {
    CHECK(pliant_version() == (PLIANT_VERSION_MAJOR << 16 | PLIANT_VERSION_MINOR << 8 |
                               PLIANT_VERSION_PATCH));
    for (int pair = 0; pair < PAIRS; pair++) {
        /* On a lattice, so that many touch, or anywhere. */
        for (int i = 0; i < 12; i++) {
            start[12 * pair + i] = random_coordinate();
            end[12 * pair + i] = random_coordinate();
        }
        for (int i = 0; i < 18; i++) {
            double x = random_coordinate();
            /* A tenth lie in one plane. */
            int is_flat = pair % 10 == 0 && i % 3 == 2;
            triangles[18 * pair + i] = is_flat ? 0.5 : pair % 2 ? x : floor(4 * x);
        }
    }
    layouts_give_the_same(0);
    layouts_give_the_same(1);
    single_precision();
    wrong_arguments();
    return 0;
}
