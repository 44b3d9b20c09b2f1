/* Questions with one answer, curves, what a world has, and whose threads work, from C; and every
   wrong argument. C11 and C++17. */
#include "check.h"

#include <math.h>

/* A large floor, and a leaf whose tip is above it. */
static const double floor_at[3][3] = {{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}};
static const double leaf_at[3][3] = {{0, 0, 2}, {1, 0, 3}, {0, 1, 3}};
static const double leaf_to[3][3] = {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}};
static const uint32_t small[3] = {0, 1, 2};

static pliant_points points_of(const void *data) {
    pliant_points points;
    memset(&points, 0, sizeof points);
    points.data = data;
    points.count = 3;
    points.scalar = PLIANT_F64;
    return points;
}

static pliant_world *a_world(const pliant_options *options) {
    pliant_world *world = NULL;
    pliant_faces faces;
    memset(&faces, 0, sizeof faces);
    faces.data = small;
    faces.count = 1;
    faces.bytes = 4;
    CHECK(pliant_world_new(options, &world, NULL) == PLIANT_OK);
    CHECK(pliant_world_add(world, faces, points_of(floor_at), NULL, NULL) == PLIANT_OK);
    CHECK(pliant_world_add(world, faces, points_of(leaf_at), NULL, NULL) == PLIANT_OK);
    return world;
}

static void answers(void) {
    pliant_world *world = a_world(NULL);
    pliant_hits far, nearest, impact;
    pliant_free_step step;
    pliant_clearance clearance;
    pliant_feature_pairs contacts;
    CHECK(pliant_world_distance(world, 1, 0, INFINITY, NULL, &far, NULL) == PLIANT_OK);
    CHECK(pliant_world_nearest_body(world, 1, 1.5, NULL, &nearest, NULL) == PLIANT_OK);
    CHECK(far.count == 1 && far.distances[0] == 2.0 && far.directions[2] == 1.0);
    CHECK(far.points[2] == 2.0 && far.points[5] == 0.0 && nearest.count == 0);
    CHECK(pliant_world_free_step(world, NULL, 0.0, &step, NULL) == PLIANT_OK);
    CHECK(step.t == 1.0 && !step.moves && step.begins_in_contact == PLIANT_NO_CONTACT);
    CHECK(step.pair[0] == UINT32_MAX);
    CHECK(pliant_world_clearance(world, NULL, 5.0, &clearance, NULL) == PLIANT_OK);
    CHECK(clearance.body_count == 2 && clearance.bodies[1] == 1 && clearance.starts[2] == 6);
    CHECK(clearance.clearance[3] > 0.9999 && clearance.clearance[3] <= 1.0);
    CHECK(pliant_world_feature_pairs(world, NULL, 2.5, &contacts, NULL) == PLIANT_OK);
    CHECK(contacts.count == 1 && contacts.kinds[0] == PLIANT_VERTEX_FACE);
    CHECK(contacts.vertices[0] == 0 && contacts.multiplicities[0] == 1);

    CHECK(pliant_world_set_motion(world, 1, points_of(leaf_to), NULL) == PLIANT_OK);
    CHECK(pliant_world_first_impact(world, NULL, 1e-6, &impact, NULL) == PLIANT_OK);
    CHECK(impact.count == 1 && impact.kinds[0] == PLIANT_VERTEX_FACE && impact.pairs[0] == 1);
    CHECK(impact.low[0] < 2.0 / 3.0 && impact.high[0] >= 2.0 / 3.0);
    CHECK(pliant_world_finish_motion(world, NULL) == PLIANT_OK);
    CHECK(pliant_world_free_step(world, NULL, 0.0, &step, NULL) == PLIANT_OK);
    CHECK(step.begins_in_contact == PLIANT_INTERSECTING && step.pair[2] == 1);

    /* Where they meet. */
    pliant_hits hits;
    pliant_query query;
    memset(&query, 0, sizeof query);
    query.how = PLIANT_ROWS;
    pliant_segments segments;
    pliant_curves curves;
    CHECK(pliant_world_intersections(world, &query, &hits, NULL) == PLIANT_OK && hits.count == 1);
    CHECK(hits.rows.count == 2 && hits.rows.body_count == 2 && hits.rows.starts[1] == 1);
    CHECK(hits.rows.offsets[2] == 1 && hits.rows.places[0] == 0);
    CHECK(pliant_world_segments(world, hits.pairs, hits.count, &segments, NULL) == PLIANT_OK);
    CHECK(segments.count == 1 && segments.offsets[1] == 2 && segments.flat[0] == 0);
    CHECK(segments.on[0] == PLIANT_INSIDE && segments.on[1] < PLIANT_ON_EDGE);
    CHECK(pliant_world_curves(world, hits.pairs, hits.count, 1, &curves, NULL) == PLIANT_OK);
    CHECK(curves.count == 1 && !curves.closed[0] && curves.ends[0] == PLIANT_BORDER);
    CHECK(curves.segments.count == 1 && curves.steps[0] == 0 && isnan(curves.areas[0]));
    CHECK(pliant_world_curves(world, NULL, 0, 0, &curves, NULL) == PLIANT_OK);
    CHECK(curves.count == 0 && !curves.areas && curves.touching_count == 0);
    query.how = PLIANT_PREPARE;
    CHECK(pliant_world_intersections(world, &query, &hits, NULL) == PLIANT_OK && hits.count == 0);
    pliant_world_free(world);
}

static int yes(void *user) { return user == NULL; }

static int look(void *user, const pliant_hits *some) { return user != some; }

static void wrong_questions(void) {
    pliant_world *world = a_world(NULL);
    pliant_error error;
    pliant_query query;
    const uint32_t pair[4] = {0, 0, 1, 9}, stranger[4] = {0, 0, 7, 0};
    memset(&query, 0, sizeof query);
    refused(pliant_world_distance(world, 0, 0, 1, NULL, NULL, &error), &error, PLIANT_SAME_BODY,
            "twice");
    refused(pliant_world_distance(world, 0, 77, 1, NULL, NULL, &error), &error,
            PLIANT_NO_SUCH_BODY, "77");
    refused(pliant_world_distance(world, 0, 1, -1, NULL, NULL, &error), &error,
            PLIANT_BAD_DISTANCE, "-1");
    refused(pliant_world_nearest_body(world, 77, 1, NULL, NULL, &error), &error,
            PLIANT_NO_SUCH_BODY, "77");
    refused(pliant_world_nearest_body(world, 0, NAN, NULL, NULL, &error), &error,
            PLIANT_BAD_DISTANCE, "NaN");
    refused(pliant_world_first_impact(world, NULL, -1, NULL, &error), &error, PLIANT_BAD_WIDTH,
            "-1");
    refused(pliant_world_free_step(world, NULL, -1, NULL, &error), &error, PLIANT_BAD_DISTANCE,
            "-1");
    refused(pliant_world_clearance(world, NULL, -1, NULL, &error), &error, PLIANT_BAD_DISTANCE,
            "-1");
    refused(pliant_world_feature_pairs(world, NULL, -1, NULL, &error), &error, PLIANT_BAD_DISTANCE,
            "-1");
    refused(pliant_world_segments(world, NULL, 1, NULL, &error), &error, PLIANT_NULL, "pairs");
    refused(pliant_world_segments(world, pair, 1, NULL, &error), &error, PLIANT_NO_SUCH_TRIANGLE,
            "9");
    CHECK(error.body == 1 && error.triangle == 9 && error.limit == 1);
    refused(pliant_world_segments(world, stranger, 1, NULL, &error), &error, PLIANT_NO_SUCH_BODY,
            "7");
    refused(pliant_world_curves(world, pair, SIZE_MAX, 0, NULL, &error), &error, PLIANT_TOO_LARGE,
            "pairs");
    refused(pliant_world_curves(world, pair, 1, 0, NULL, &error), &error, PLIANT_NO_SUCH_TRIANGLE,
            "9");
    refused(pliant_world_curves(world, NULL, 0, 2, NULL, &error), &error, PLIANT_BAD_OPTION,
            "areas is 2");

    /* Each with a selection that is none, what is for lists, and an interrupt that says so. */
    for (int wrong = 0; wrong < 5; wrong++) {
        const pliant_status expected = wrong < 4 ? PLIANT_BAD_OPTION : PLIANT_INTERRUPTED;
        const char *words = wrong == 0 ? "of.kind" : wrong < 4 ? "lists" : "interrupted";
        memset(&query, 0, sizeof query);
        query.of.kind = wrong == 0 ? 9 : 0;
        query.how = wrong == 1 ? PLIANT_FIRST : 0;
        query.at_most = wrong == 2;
        query.visit = wrong == 3 ? look : NULL;
        query.interrupt = wrong == 4 ? yes : NULL;
        if (wrong > 0) { /* these read no selection */
            refused(pliant_world_distance(world, 0, 1, 9, &query, NULL, &error), &error, expected,
                    words);
            refused(pliant_world_nearest_body(world, 0, 9, &query, NULL, &error), &error, expected,
                    words);
            refused(pliant_world_weld(world, 0, 1, &query, NULL, &error), &error, expected, words);
        }
        refused(pliant_world_first_impact(world, &query, 0, NULL, &error), &error, expected, words);
        refused(pliant_world_collision_free_step(world, &query, 0, NULL, &error), &error, expected,
                words);
        refused(pliant_world_free_step(world, &query, 0, NULL, &error), &error, expected, words);
        refused(pliant_world_clearance(world, &query, 1, NULL, &error), &error, expected, words);
        refused(pliant_world_feature_pairs(world, &query, 1, NULL, &error), &error, expected,
                words);
    }
    memset(&query, 0, sizeof query);
    query.how = PLIANT_FIRST;
    query.visit = look;
    refused(pliant_world_intersections(world, &query, NULL, &error), &error, PLIANT_BAD_OPTION,
            "visitor");
    query.how = PLIANT_ALL;
    query.at_most = 1;
    refused(pliant_world_intersections(world, &query, NULL, &error), &error, PLIANT_BAD_OPTION,
            "at_most");
    pliant_world_free(world);
}

static void what_a_world_has(void) {
    pliant_world *world = a_world(NULL);
    pliant_error error;
    pliant_list list, other;
    pliant_boxes boxes;
    pliant_tree_shape shape;
    pliant_statistics work;
    pliant_options options;
    size_t bytes = 0;
    double out[9], box[6] = {0, 0, 0, 1, 1, 1};
    uint8_t has = 9;
    uint32_t first = 0, second = 0;
    uint64_t revision = 9;
    CHECK(pliant_world_bodies(world, &list, NULL) == PLIANT_OK && list.count == 2);
    CHECK(pliant_world_options(world, &options, NULL) == PLIANT_OK && options.threads == 1);
    CHECK(options.degree == 8 && !options.pool && !options.parallel_for);
    CHECK(pliant_world_tree_boxes(world, 1, 0, &boxes, NULL) == PLIANT_OK && boxes.count == 1);
    CHECK(boxes.corners[2] == 2.0 && boxes.corners[5] == 3.0 && boxes.valid[0] == 0);
    CHECK(pliant_world_tree_shape(world, 1, &shape, NULL) == PLIANT_OK && shape.nodes == 1);
    CHECK(pliant_world_intersections(world, NULL, NULL, NULL) == PLIANT_OK);
    CHECK(pliant_world_statistics(world, &work, NULL) == PLIANT_OK && work.pairs == 0);
    CHECK(pliant_world_memory_usage(world, &bytes, NULL) == PLIANT_OK && bytes > 0);
    CHECK(pliant_world_set_positions_of(world, NULL, NULL, 0, NULL) == PLIANT_OK);
    CHECK(pliant_world_labels(world, 1, &list, &other, NULL) == PLIANT_OK);
    CHECK(!list.numbers && !other.numbers);
    CHECK(pliant_world_set_loose_box(world, 1, NULL, NULL) == PLIANT_OK);
    CHECK(pliant_world_end_positions(world, 1, NULL, 0, &has, NULL) == PLIANT_OK && has == 0);

    refused(pliant_world_set_loose_box(world, 1, box, &error), &error, PLIANT_OUTSIDE_LOOSE_BOX,
            "vertex 0");
    CHECK(error.position[2] == 2.0);
    box[3] = -1;
    refused(pliant_world_set_loose_box(world, 1, box, &error), &error, PLIANT_BAD_LOOSE_BOX,
            "exchanged");
    refused(pliant_world_positions(world, 1, out, 2, &error), &error, PLIANT_WRONG_LENGTH,
            "2 rows");
    refused(pliant_world_thickness(world, 1, out, 2, &error), &error, PLIANT_WRONG_LENGTH,
            "2 rows");
    refused(pliant_world_thickness(world, 1, NULL, 3, &error), &error, PLIANT_NULL, "out");
    refused(pliant_world_set_thickness(world, 1, -1, &error), &error, PLIANT_BAD_THICKNESS, "-1");
    CHECK(pliant_world_set_rest_positions(world, 1, (const pliant_points *)NULL, NULL) == 0);
    const pliant_points rest = points_of(floor_at);
    CHECK(pliant_world_set_rest_positions(world, 1, &rest, NULL) == PLIANT_OK);
    refused(pliant_world_rest_positions(world, 1, out, 2, &has, &error), &error,
            PLIANT_WRONG_LENGTH, "2 rows");
    CHECK(pliant_world_set_motion(world, 1, points_of(leaf_to), NULL) == PLIANT_OK);
    refused(pliant_world_end_positions(world, 1, NULL, 3, &has, &error), &error, PLIANT_NULL,
            "out");
    const uint32_t twice[2] = {1, 1};
    const pliant_points shapes[2] = {rest, rest};
    refused(pliant_world_set_positions_of(world, twice, shapes, 2, &error), &error,
            PLIANT_SAME_BODY, "twice");
    refused(pliant_world_set_positions_of(world, NULL, shapes, 2, &error), &error, PLIANT_NULL,
            "bodies");
    refused(pliant_world_set_positions_of(world, twice, NULL, 2, &error), &error, PLIANT_NULL,
            "positions");

    /* No body of this number, and no world. */
#define NOBODY(call, ...)                                                                          \
    refused(call(world, 77, __VA_ARGS__, &error), &error, PLIANT_NO_SUCH_BODY, "77");              \
    refused(call(NULL, 0, __VA_ARGS__, &error), &error, PLIANT_NULL, "world")
#define NO_WORLD(call, ...) refused(call(NULL, __VA_ARGS__, &error), &error, PLIANT_NULL, "world")
    NOBODY(pliant_world_triangles, &list);
    NOBODY(pliant_world_edges, &list);
    NOBODY(pliant_world_vertex_order, &list);
    NOBODY(pliant_world_components, &list);
    NOBODY(pliant_world_vertex_groups, &list);
    NOBODY(pliant_world_live_triangles, &list);
    NOBODY(pliant_world_live_vertices, &list);
    NOBODY(pliant_world_tree_cut, 1, &list);
    NOBODY(pliant_world_labels, &list, &list);
    NOBODY(pliant_world_counts, NULL, NULL);
    NOBODY(pliant_world_positions, out, 3);
    NOBODY(pliant_world_end_positions, out, 3, &has);
    NOBODY(pliant_world_rest_positions, out, 3, &has);
    NOBODY(pliant_world_thickness, out, 3);
    NOBODY(pliant_world_filter, &first, &second);
    NOBODY(pliant_world_environment, &first);
    NOBODY(pliant_world_mesh_revision, &revision);
    NOBODY(pliant_world_loose_box, box, &has);
    NOBODY(pliant_world_tree_quality, box);
    NOBODY(pliant_world_tree_shape, &shape);
    NOBODY(pliant_world_tree_boxes, 0, &boxes);
    NOBODY(pliant_world_set_loose_box, box);
    NOBODY(pliant_world_set_thickness, 1.0);
    NOBODY(pliant_world_set_filter, 1, 1);
    NOBODY(pliant_world_set_environment, 1);
    NOBODY(pliant_world_set_edges, NULL, 0);
    NOBODY(pliant_world_set_vertex_groups, NULL, 0);
    NOBODY(pliant_world_set_vertex_thickness, NULL, 0);
    NOBODY(pliant_world_set_labels, NULL, 0, NULL, 0);
    NOBODY(pliant_world_set_positions, rest);
    NOBODY(pliant_world_set_motion, rest);
    NOBODY(pliant_world_set_rest_positions, NULL);
    NOBODY(pliant_world_ignore, 1);
    NOBODY(pliant_world_unignore, 1);
    NOBODY(pliant_world_weld, 0, NULL, NULL);
    NOBODY(pliant_world_split, NULL, NULL);
    NOBODY(pliant_world_fuse, 1, NULL);
    NOBODY(pliant_world_distance, 1, 1, NULL, NULL);
    NOBODY(pliant_world_nearest_body, 1, NULL, NULL);
    refused(pliant_world_remove(NULL, 0, &error), &error, PLIANT_NULL, "world");
    refused(pliant_world_rebuild(NULL, 0, &error), &error, PLIANT_NULL, "world");
    refused(pliant_world_rebuild(world, 77, &error), &error, PLIANT_NO_SUCH_BODY, "77");
    refused(pliant_world_finish_motion(NULL, &error), &error, PLIANT_NULL, "world");
    refused(pliant_world_validate(NULL, &error), &error, PLIANT_NULL, "world");
    NO_WORLD(pliant_world_bodies, &list);
    NO_WORLD(pliant_world_ignored, &list);
    NO_WORLD(pliant_world_options, &options);
    NO_WORLD(pliant_world_statistics, &work);
    NO_WORLD(pliant_world_memory_usage, &bytes);
    NO_WORLD(pliant_world_advance_motion, 0.5);
    NO_WORLD(pliant_world_set_positions_of, NULL, NULL, 0);
    NO_WORLD(pliant_world_intersections, NULL, NULL);
    NO_WORLD(pliant_world_contacts, NULL, 0, NULL);
    NO_WORLD(pliant_world_adjacent_intersections, NULL, 0, NULL);
    NO_WORLD(pliant_world_crossing_edges, NULL, NULL);
    NO_WORLD(pliant_world_vertex_triangle_candidates, NULL, 1, NULL);
    NO_WORLD(pliant_world_edge_edge_candidates, NULL, 1, NULL);
    NO_WORLD(pliant_world_close_vertex_triangle_pairs, NULL, 1, NULL);
    NO_WORLD(pliant_world_close_edge_edge_pairs, NULL, 1, NULL);
    NO_WORLD(pliant_world_close_triangle_pairs, NULL, 1, NULL);
    NO_WORLD(pliant_world_vertex_triangle_impacts, NULL, 1, NULL);
    NO_WORLD(pliant_world_edge_edge_impacts, NULL, 1, NULL);
    NO_WORLD(pliant_world_first_impact, NULL, 1, NULL);
    NO_WORLD(pliant_world_collision_free_step, NULL, 1, NULL);
    NO_WORLD(pliant_world_free_step, NULL, 1, NULL);
    NO_WORLD(pliant_world_clearance, NULL, 1, NULL);
    NO_WORLD(pliant_world_feature_pairs, NULL, 1, NULL);
    NO_WORLD(pliant_world_segments, NULL, 0, NULL);
    NO_WORLD(pliant_world_curves, NULL, 0, 0, NULL);
    pliant_world_free(world);
}

/* A scheduler that runs every other task, from the last, and counts what it was given. */
static void every_other(void *user, size_t tasks, void (*task)(const void *context, size_t number),
                        const void *context) {
    *(size_t *)user += tasks;
    for (size_t number = 0; number < tasks; number += 2) {
        task(context, tasks - 1 - number);
    }
}

static void whose_threads_work(void) {
    enum { SIDE = 90, COUNT = SIDE * SIDE };
    static uint32_t strip[2 * COUNT][3];
    static double sheet[(SIDE + 1) * (SIDE + 1)][3];
    for (uint32_t row = 0, next = 0; row < SIDE; row++) {
        for (uint32_t column = 0; column < SIDE; column++, next += 2) {
            const uint32_t a = row * (SIDE + 1) + column, b = a + SIDE + 1;
            const uint32_t both[2][3] = {{a, a + 1, b}, {a + 1, b + 1, b}};
            memcpy(strip[next], both, sizeof both);
        }
    }
    for (int vertex = 0; vertex < (SIDE + 1) * (SIDE + 1); vertex++) {
        const double x = vertex % (SIDE + 1), y = vertex / (SIDE + 1);
        const double at[3] = {x, y, sin(x) + cos(y)};
        memcpy(sheet[vertex], at, sizeof at);
    }
    pliant_faces faces;
    memset(&faces, 0, sizeof faces);
    faces.data = strip;
    faces.count = 2 * COUNT;
    faces.bytes = 4;
    pliant_points points = points_of(sheet);
    points.count = (SIDE + 1) * (SIDE + 1);
    pliant_pool *pool = NULL;
    pliant_error error;
    pliant_options options;
    pliant_world *worlds[4];
    pliant_hits hits[4];
    size_t tasks = 0;
    CHECK(pliant_pool_new(2, &pool, NULL) == PLIANT_OK);
    for (int which = 0; which < 4; which++) {
        pliant_options_default(&options);
        options.threads = which == 0 ? 1 : 3;
        options.pool = which == 2 ? pool : NULL;
        options.parallel_for = which == 3 ? every_other : NULL;
        options.parallel_user = &tasks;
        CHECK(pliant_world_new(&options, &worlds[which], NULL) == PLIANT_OK);
        CHECK(pliant_world_add(worlds[which], faces, points, NULL, NULL) == PLIANT_OK);
        pliant_hits *all = &hits[which];
        CHECK(pliant_world_edge_edge_candidates(worlds[which], NULL, 0.5, all, NULL) == PLIANT_OK);
        CHECK(all->count > COUNT && all->count == hits[0].count);
        CHECK(memcmp(all->pairs, hits[0].pairs, 4 * sizeof(uint32_t) * all->count) == 0);
    }
    CHECK(tasks > 0);
    pliant_pool_free(pool);
    pliant_pool_free(NULL);
    CHECK(pliant_world_options(worlds[2], &options, NULL) == PLIANT_OK);
    CHECK(options.threads == 3 && !options.pool && !options.parallel_user);
    for (int which = 0; which < 4; which++) {
        CHECK(pliant_world_set_positions(worlds[which], 0, points, NULL) == PLIANT_OK);
        CHECK(pliant_world_intersections(worlds[which], NULL, NULL, NULL) == PLIANT_OK);
        pliant_world_free(worlds[which]);
    }
    pliant_options_default(&options);
    refused(pliant_pool_new(0, &pool, &error), &error, PLIANT_BAD_OPTION, "threads is 0");
    refused(pliant_pool_new(1, NULL, &error), &error, PLIANT_NULL, "pool");
    CHECK(pliant_pool_new(1, &pool, NULL) == PLIANT_OK);
    options.pool = pool;
    options.parallel_for = every_other;
    refused(pliant_world_new(&options, &worlds[0], &error), &error, PLIANT_BAD_OPTION,
            "one of them");
    pliant_pool_free(pool);
}

int main(void) {
    answers();
    wrong_questions();
    what_a_world_has();
    whose_threads_work();
    return 0;
}
