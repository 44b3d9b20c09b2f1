/* A world from C: bodies of every layout, answers side by side, visitors, and every wrong argument.
   C11 and C++17. */
#include "check.h"

#include <math.h>
#include <string.h>

static pliant_points points_of(const void *data, size_t count, pliant_scalar scalar) {
    pliant_points points;
    points.data = data;
    points.count = count;
    points.row = points.column = 0;
    points.scalar = scalar;
    return points;
}

static pliant_faces faces_of(const void *data, size_t count, int bytes, int is_signed) {
    pliant_faces faces;
    faces.data = data;
    faces.count = count;
    faces.row = faces.column = 0;
    faces.bytes = (uint8_t)bytes;
    faces.is_signed = (uint8_t)is_signed;
    return faces;
}

/* A large floor, and a leaf whose tip is below it. */
static const double floor_at[3][3] = {{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}};
static const double leaf_at[3][3] = {{0, 0, -1}, {1, 0, 1}, {0, 1, 1}};
static const uint16_t small[3] = {0, 1, 2};

static pliant_world *a_world(uint32_t bodies[2]) {
    pliant_world *world = NULL;
    pliant_error error;
    CHECK(pliant_world_new(NULL, &world, &error) == PLIANT_OK && world);
    CHECK(pliant_world_add(world, faces_of(small, 1, 2, 0), points_of(floor_at, 3, PLIANT_F64),
                           &bodies[0], &error) == PLIANT_OK);
    CHECK(pliant_world_add(world, faces_of(small, 1, 2, 1), points_of(leaf_at, 3, PLIANT_F64),
                           &bodies[1], NULL) == PLIANT_OK);
    return world;
}

static void layouts(void) {
    /* As Eigen has them, of 8 bytes and of 4; floats between others; all in a world of f64. */
    const int64_t wide[3][3] = {{0, 1, 2}, {7, 7, 7}, {7, 7, 7}};
    const int32_t columns[3] = {0, 1, 2};
    const double in_columns[3][3] = {{0, 1, 0}, {0, 0, 1}, {-1, 1, 1}};
    struct {
        float weight, at[3];
    } vertices[3];
    for (int vertex = 0; vertex < 3; vertex++) {
        for (int axis = 0; axis < 3; axis++) {
            vertices[vertex].at[axis] = (float)leaf_at[vertex][axis];
        }
        vertices[vertex].weight = NAN;
    }
    uint32_t bodies[2], more[2];
    pliant_world *world = a_world(bodies);
    pliant_faces faces = faces_of(columns, 1, 4, 1);
    faces.row = 4;
    faces.column = 4;
    pliant_points points = points_of(in_columns, 3, PLIANT_F64);
    points.row = 8;
    points.column = 24;
    CHECK(pliant_world_add(world, faces, points, &more[0], NULL) == PLIANT_OK);
    points.data = vertices[0].at;
    points.row = sizeof vertices[0];
    points.column = 4;
    points.scalar = PLIANT_F32;
    CHECK(pliant_world_add(world, faces_of(wide, 1, 8, 0), points, &more[1], NULL) == PLIANT_OK);
    for (int body = 0; body < 2; body++) {
        double there[3][3];
        size_t triangles = 0, count = 0;
        CHECK(pliant_world_counts(world, more[body], &triangles, &count, NULL) == PLIANT_OK);
        CHECK(triangles == 1 && count == 3);
        CHECK(pliant_world_positions(world, more[body], &there[0][0], 3, NULL) == PLIANT_OK);
        CHECK(memcmp(there, leaf_at, sizeof there) == 0);
    }
    pliant_hits hits;
    CHECK(pliant_world_intersections(world, NULL, &hits, NULL) == PLIANT_OK);
    CHECK(hits.count == 6); /* three leaves with the floor, and with each other */
    pliant_world_free(world);
}

static void answers_live_side_by_side(void) {
    uint32_t bodies[2];
    pliant_world *world = a_world(bodies), *copy = NULL;
    pliant_query query;
    memset(&query, 0, sizeof query);
    query.of.kind = PLIANT_BETWEEN;
    query.of.a = bodies[0];
    query.of.b = bodies[1];
    pliant_hits hits, contacts, close, impacts;
    CHECK(pliant_world_intersections(world, &query, &hits, NULL) == PLIANT_OK);
    CHECK(pliant_world_contacts(world, &query, PLIANT_APART, &contacts, NULL) == PLIANT_OK);
    CHECK(pliant_world_close_triangle_pairs(world, &query, 0.5, &close, NULL) == PLIANT_OK);
    /* The leaf falls away; lists stay. */
    const double below[3][3] = {{0, 0, -9}, {1, 0, -8}, {0, 1, -8}};
    CHECK(pliant_world_set_motion(world, bodies[1], points_of(below, 3, PLIANT_F64), NULL) == 0);
    query.of.kind = PLIANT_WORLD;
    CHECK(pliant_world_vertex_triangle_impacts(world, &query, 1e-6, &impacts, NULL) == 0);
    CHECK(pliant_world_clone(world, &copy, NULL) == PLIANT_OK);
    CHECK(pliant_world_advance_motion(world, 1.0, NULL) == PLIANT_OK);
    const uint32_t expected[4] = {bodies[0], 0, bodies[1], 0};
    CHECK(hits.count == 1 && memcmp(hits.pairs, expected, sizeof expected) == 0);
    CHECK(!hits.kinds && !hits.distances && !hits.low);
    CHECK(contacts.count == 1 && contacts.kinds[0] == PLIANT_CROSSING);
    CHECK(close.count == 1 && close.distances[0] == 0.0 && close.points && close.weights);
    CHECK(impacts.count == 2 && impacts.low[0] < impacts.high[0] && impacts.high[0] < 1.0);
    pliant_hits later;
    CHECK(pliant_world_intersections(world, NULL, &later, NULL) == PLIANT_OK && later.count == 0);
    CHECK(!later.pairs);
    CHECK(pliant_world_intersections(copy, NULL, &later, NULL) == PLIANT_OK && later.count == 1);
    /* Edges by the caller's numbers, labels, another mesh. */
    const uint32_t own[6] = {1, 2, 0, 2, 0, 1}, labels[1] = {3}, near[2] = {3, 4};
    pliant_list edges;
    CHECK(pliant_world_set_edges(copy, bodies[1], own, 3, NULL) == PLIANT_OK);
    CHECK(pliant_world_edges(copy, bodies[1], &edges, NULL) == PLIANT_OK);
    CHECK(edges.count == 3 && memcmp(edges.numbers, own, sizeof own) == 0);
    CHECK(pliant_world_set_labels(copy, bodies[1], labels, 1, near, 1, NULL) == PLIANT_OK);
    CHECK(pliant_world_set_labels(copy, bodies[1], labels, 1, NULL, 0, NULL) == PLIANT_OK);
    CHECK(pliant_world_set_labels(copy, bodies[1], NULL, 0, NULL, 0, NULL) == PLIANT_OK);
    const uint16_t two[6] = {0, 1, 2, 0, 1, 2};
    CHECK(pliant_world_set_mesh(copy, bodies[1], faces_of(two, 2, 2, 0),
                                points_of(leaf_at, 3, PLIANT_F64), NULL) == PLIANT_OK);
    CHECK(pliant_world_intersections(copy, NULL, &later, NULL) == PLIANT_OK && later.count == 2);
    double step = NAN;
    CHECK(pliant_world_collision_free_step(copy, &query, 0.0, &step, NULL) == PLIANT_OK);
    CHECK(step > 0.0 && step <= 1.0);
    CHECK(pliant_world_remove(copy, bodies[1], NULL) == PLIANT_OK);
    CHECK(pliant_world_intersections(copy, NULL, &later, NULL) == PLIANT_OK && later.count == 0);
    pliant_world_free(copy);
    pliant_world_free(world);
    pliant_world_free(NULL);
}

typedef struct {
    pliant_world *world;
    int seen, asked, stop;
    pliant_status inner;
} notes;

static int look(void *user, const pliant_hits *some) {
    notes *seen = (notes *)user;
    seen->seen += (int)some->count;
    pliant_hits hits;
    seen->inner = pliant_world_intersections(seen->world, NULL, &hits, NULL);
    return seen->stop;
}

static int ask(void *user) { return ((notes *)user)->asked++, ((notes *)user)->stop; }

static void visitors_and_interrupts(void) {
    uint32_t bodies[2];
    notes seen;
    memset(&seen, 0, sizeof seen);
    seen.world = a_world(bodies);
    pliant_query query;
    pliant_error error;
    pliant_hits hits;
    memset(&query, 0, sizeof query);
    query.visit = look;
    query.user = &seen;
    for (seen.stop = 0; seen.stop < 2; seen.stop++) {
        seen.seen = 0;
        CHECK(pliant_world_intersections(seen.world, &query, &hits, NULL) == PLIANT_OK);
        CHECK(seen.seen == 1 && hits.count == 0 && seen.inner == PLIANT_BUSY);
    }
    query.visit = NULL;
    query.interrupt = ask;
    seen.stop = 0;
    CHECK(pliant_world_intersections(seen.world, &query, &hits, NULL) == PLIANT_OK);
    CHECK(hits.count == 1 && seen.asked > 0);
    seen.stop = 1;
    refused(pliant_world_intersections(seen.world, &query, &hits, &error), &error,
            PLIANT_INTERRUPTED, "interrupted");
    query.interrupt = NULL;
    CHECK(pliant_world_intersections(seen.world, &query, &hits, NULL) == PLIANT_OK);
    CHECK(hits.count == 1);
    pliant_world_free(seen.world);
}

static void wrong_arguments(void) {
    uint32_t bodies[2];
    pliant_world *world = a_world(bodies), *none = NULL;
    pliant_error error;
    pliant_hits hits;
    pliant_options options;
    const uint32_t small_labels[2] = {0, 1};
    const pliant_points floor_points = points_of(floor_at, 3, PLIANT_F64);

    refused(pliant_world_new(NULL, NULL, &error), &error, PLIANT_NULL, "world is NULL");
    memset(&options, 0, sizeof options);
    refused(pliant_world_new(&options, &none, &error), &error, PLIANT_BAD_OPTION, "threads is 0");
    pliant_options_default(NULL);
    for (int field = 0; field < 8; field++) {
        pliant_options_default(&options);
        uint32_t *fields[6] = {&options.threads, &options.degree, &options.partition,
                               &options.leaf_size, &options.update, &options.broad_phase};
        const uint32_t bad[6] = {0, 3, 4, 0, 3, 4};
        if (field < 6) {
            *fields[field] = bad[field];
        } else if (field == 6) {
            options.mending = 2;
        } else {
            options.scalar = 9;
        }
        CHECK(pliant_world_new(&options, &none, &error) ==
              (field == 7 ? PLIANT_BAD_SCALAR : PLIANT_BAD_OPTION));
        CHECK(!none);
    }
    pliant_options_default(&options);
    options.scalar = PLIANT_F32;
    CHECK(pliant_world_new(&options, &none, &error) == PLIANT_OK);
    refused(pliant_world_add(none, faces_of(small, 1, 2, 0), floor_points, NULL, &error), &error,
            PLIANT_WOULD_ROUND, "double");
    pliant_world_free(none);
    none = NULL;

    refused(pliant_world_add(NULL, faces_of(small, 1, 2, 0), floor_points, NULL, &error), &error,
            PLIANT_NULL, "world");
    refused(pliant_world_add(world, faces_of(NULL, 1, 2, 0), floor_points, NULL, &error), &error,
            PLIANT_NULL, "faces.data");
    refused(pliant_world_add(world, faces_of(small, 1, 3, 0), floor_points, NULL, &error), &error,
            PLIANT_BAD_INDEX, "bytes is 3");
    refused(pliant_world_add(world, faces_of(small, 1, 2, 2), floor_points, NULL, &error), &error,
            PLIANT_BAD_INDEX, "is_signed 2");
    refused(pliant_world_add(world, faces_of(small, 0, 2, 0), floor_points, NULL, &error), &error,
            PLIANT_NO_TRIANGLES, "at least one");
    refused(pliant_world_add(world, faces_of(small, 1, 2, 0), points_of(NULL, 3, PLIANT_F64), NULL,
                             &error),
            &error, PLIANT_NULL, "positions.data");
    refused(pliant_world_add(world, faces_of(small, 1, 2, 0), points_of(floor_at, 3, 5), NULL,
                             &error),
            &error, PLIANT_BAD_SCALAR, "is 5");
    refused(pliant_world_add(world, faces_of(small, 1, 2, 0), points_of(floor_at, 2, PLIANT_F64),
                             NULL, &error),
            &error, PLIANT_VERTEX_OUT_OF_RANGE, "vertex 2");
    CHECK(error.triangle == 0 && error.vertex == 2 && error.limit == 2 && error.body == UINT32_MAX);
    const int32_t negative[3] = {0, -1, 2};
    refused(pliant_world_add(world, faces_of(negative, 1, 4, 1), floor_points, NULL, &error),
            &error, PLIANT_VERTEX_OUT_OF_RANGE, "vertex -1");
    double bad[3][3];
    memcpy(bad, leaf_at, sizeof bad);
    bad[1][2] = NAN;
    const pliant_points bad_points = points_of(bad, 3, PLIANT_F64);
    refused(pliant_world_set_positions(world, bodies[1], bad_points, &error), &error,
            PLIANT_BAD_POSITION, "vertex 1");
    CHECK(error.body == bodies[1] && error.vertex == 1 && isnan(error.position[2]));
    refused(pliant_world_set_motion(world, bodies[1], bad_points, &error), &error,
            PLIANT_BAD_POSITION, "vertex 1");
    refused(pliant_world_set_rest_positions(world, bodies[1], &bad_points, &error), &error,
            PLIANT_BAD_POSITION, "vertex 1");
    CHECK(pliant_world_set_rest_positions(world, bodies[1], NULL, NULL) == PLIANT_OK);
    refused(pliant_world_set_positions(world, bodies[1], points_of(bad, 2, PLIANT_F64), &error),
            &error, PLIANT_WRONG_LENGTH, "2 positions for 3");
    CHECK(error.count == 2 && error.limit == 3);
    refused(pliant_world_set_positions(world, 77, floor_points, &error), &error,
            PLIANT_NO_SUCH_BODY, "77");
    refused(pliant_world_remove(world, 77, &error), &error, PLIANT_NO_SUCH_BODY, "77");
    refused(pliant_world_counts(world, 77, NULL, NULL, &error), &error, PLIANT_NO_SUCH_BODY, "77");
    refused(pliant_world_positions(world, bodies[0], NULL, 3, &error), &error, PLIANT_NULL, "out");
    refused(pliant_world_positions(world, bodies[0], &bad[0][0], 2, &error), &error,
            PLIANT_WRONG_LENGTH, "2 rows");
    refused(pliant_world_set_filter(world, 77, 1, 1, &error), &error, PLIANT_NO_SUCH_BODY, "77");
    refused(pliant_world_set_environment(world, 77, 1, &error), &error, PLIANT_NO_SUCH_BODY, "77");
    refused(pliant_world_ignore(world, bodies[0], 77, &error), &error, PLIANT_NO_SUCH_BODY, "77");
    refused(pliant_world_set_vertex_groups(world, bodies[0], NULL, 3, &error), &error, PLIANT_NULL,
            "groups");
    const double thick[3] = {0, -1, 0};
    refused(pliant_world_set_vertex_thickness(world, bodies[0], thick, 3, &error), &error,
            PLIANT_BAD_THICKNESS, "thickness of vertex 1");
    CHECK(error.vertex == 1 && error.number == -1.0);
    refused(pliant_world_add(world, faces_of(small, SIZE_MAX, 2, 0), floor_points, NULL, &error),
            &error, PLIANT_TOO_LARGE, "faces.count");
    refused(pliant_world_set_positions(world, bodies[0], points_of(bad, SIZE_MAX / 2, PLIANT_F64),
                                       &error),
            &error, PLIANT_TOO_LARGE, "positions.count");
    refused(pliant_world_set_vertex_groups(world, bodies[0], small_labels, SIZE_MAX, &error),
            &error, PLIANT_TOO_LARGE, "groups");
    CHECK(error.count == SIZE_MAX && error.limit == UINT32_MAX);
    refused(pliant_world_set_labels(world, bodies[0], small_labels, 2, NULL, 0, &error), &error,
            PLIANT_WRONG_LENGTH, "2 labels for 1 triangles");
    refused(pliant_world_set_edges(world, bodies[0], small_labels, 1, &error), &error,
            PLIANT_MISSING_EDGE, "edges lack");
    refused(pliant_world_set_edges(world, bodies[0], NULL, 1, &error), &error, PLIANT_NULL,
            "edges is");
    refused(pliant_world_edges(world, 77, NULL, &error), &error, PLIANT_NO_SUCH_BODY, "77");
    refused(pliant_world_set_mesh(world, bodies[0], faces_of(small, 1, 2, 0), bad_points, &error),
            &error, PLIANT_BAD_POSITION, "vertex 1");
    refused(pliant_world_advance_motion(world, 2.0, &error), &error, PLIANT_BAD_TIME, "time");

    pliant_query query;
    memset(&query, 0, sizeof query);
    query.of.kind = 4;
    refused(pliant_world_intersections(world, &query, &hits, &error), &error, PLIANT_BAD_OPTION,
            "of.kind is 4");
    query.of.kind = PLIANT_BETWEEN;
    refused(pliant_world_crossing_edges(world, &query, &hits, &error), &error, PLIANT_SAME_BODY,
            "twice");
    query.of.kind = PLIANT_EVERYTHING;
    query.how = 5;
    refused(pliant_world_edge_edge_candidates(world, &query, 0, &hits, &error), &error,
            PLIANT_BAD_OPTION, "how is 5");
    refused(pliant_world_vertex_triangle_candidates(world, NULL, -1, &hits, &error), &error,
            PLIANT_BAD_MARGIN, "-1");
    CHECK(error.number == -1.0);
    refused(pliant_world_close_vertex_triangle_pairs(world, NULL, NAN, &hits, &error), &error,
            PLIANT_BAD_DISTANCE, "NaN");
    refused(pliant_world_close_edge_edge_pairs(world, NULL, -1, &hits, &error), &error,
            PLIANT_BAD_DISTANCE, "-1");
    refused(pliant_world_edge_edge_impacts(world, NULL, -1, &hits, &error), &error,
            PLIANT_BAD_WIDTH, "-1");
    refused(pliant_world_adjacent_intersections(world, NULL, 4, &hits, &error), &error,
            PLIANT_BAD_OPTION, "only is 4");
    refused(pliant_world_collision_free_step(world, NULL, -1, NULL, &error), &error,
            PLIANT_BAD_DISTANCE, "-1");
    refused(pliant_world_clone(world, NULL, &error), &error, PLIANT_NULL, "copy");
    refused(pliant_world_clone(NULL, &none, &error), &error, PLIANT_NULL, "world");
    /* Nothing was changed, and nobody needs an error or a list. */
    CHECK(pliant_world_intersections(world, NULL, NULL, NULL) == PLIANT_OK);
    CHECK(pliant_world_intersections(world, NULL, &hits, NULL) == PLIANT_OK && hits.count == 1);
    pliant_world_free(world);
}

int main(void) {
    layouts();
    answers_live_side_by_side();
    visitors_and_interrupts();
    wrong_arguments();
    return 0;
}
