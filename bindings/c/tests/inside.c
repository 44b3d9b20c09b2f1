/* Inside and outside, closest points and depth, from C; and every wrong argument. C11 and C++17. */
#include "check.h"

#include <math.h>

/* A large tetrahedron, a small one inside it, and one that reaches into the large one. */
static const uint32_t closed[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
static const double large_at[4][3] = {{0, 0, 0}, {16, 0, 0}, {0, 16, 0}, {0, 0, 16}};
static const double small_at[4][3] = {{1, 1, 1}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}};
static const double deep_at[4][3] = {{4, 4, 3}, {4, 4, -9}, {5, 4, -9}, {4, 5, -9}};
enum { LARGE = 0, SMALL = 1, DEEP = 2, TENT = 3 };

/* Inside the large one, on a face, an edge and a corner of it, and outside. */
static const double asked[5][3] = {{4, 4, 1}, {4, 4, 0}, {4, 0, 0}, {16, 0, 0}, {4, 4, -3}};
static const float asked_too[5][3] = {{4, 4, 1}, {4, 4, 0}, {4, 0, 0}, {16, 0, 0}, {4, 4, -3}};

static pliant_points points_of(const void *data, size_t count, pliant_scalar scalar) {
    pliant_points points;
    memset(&points, 0, sizeof points);
    points.data = data;
    points.count = count;
    points.scalar = scalar;
    return points;
}

static void add(pliant_world *world, const uint32_t faces[][3], size_t count,
                const double at[4][3]) {
    pliant_faces triangles;
    memset(&triangles, 0, sizeof triangles);
    triangles.data = faces;
    triangles.count = count;
    triangles.bytes = 4;
    const pliant_points positions = points_of(at, 4, PLIANT_F64);
    CHECK(pliant_world_add(world, triangles, positions, NULL, NULL) == PLIANT_OK);
}

/* The tent is the last body: the large one without its first triangle. */
static pliant_world *a_world(void) {
    pliant_world *world = NULL;
    CHECK(pliant_world_new(NULL, &world, NULL) == PLIANT_OK);
    add(world, closed, 4, large_at);
    add(world, closed, 4, small_at);
    add(world, closed, 4, deep_at);
    add(world, closed + 1, 3, large_at);
    return world;
}

static void sides(void) {
    pliant_world *world = a_world();
    const pliant_points points = points_of(asked, 5, PLIANT_F64);
    const pliant_points same = points_of(asked_too, 5, PLIANT_F32);
    pliant_located located, again, vertices;
    CHECK(pliant_world_inside(world, SMALL, LARGE, 0, NULL, &vertices, NULL) == PLIANT_OK);
    CHECK(pliant_world_points_inside(world, points, LARGE, PLIANT_POSITIVE, NULL, &located,
                                     NULL) == PLIANT_OK);
    CHECK(located.count == 5 && located.sides[0] == PLIANT_IS_INSIDE && located.windings[0] == 1);
    for (int point = 1; point < 4; point++) {
        CHECK(located.sides[point] == PLIANT_IS_ON && located.windings[point] == 0);
    }
    CHECK(located.sides[4] == PLIANT_IS_OUTSIDE && located.windings[4] == 0);
    CHECK(pliant_world_points_inside(world, same, LARGE, PLIANT_PARITY, NULL, &again, NULL) ==
          PLIANT_OK);
    CHECK(again.count == 5 && again.sides[0] == PLIANT_IS_INSIDE && again.sides[2] == PLIANT_IS_ON);
    /* No points, nowhere. */
    CHECK(pliant_world_points_inside(world, points_of(NULL, 0, PLIANT_F64), LARGE, 0, NULL, &again,
                                     NULL) == PLIANT_OK);
    CHECK(again.count == 0 && !again.sides && !again.windings);
    /* The other answer lives beside these. */
    CHECK(vertices.count == 4 && vertices.sides[0] == PLIANT_IS_INSIDE);
    CHECK(vertices.sides[3] == PLIANT_IS_INSIDE && vertices.windings[3] == 1);
    CHECK(pliant_world_inside(world, DEEP, LARGE, 0, NULL, &vertices, NULL) == PLIANT_OK);
    CHECK(vertices.sides[0] == PLIANT_IS_INSIDE && vertices.sides[1] == PLIANT_IS_OUTSIDE);
    /* A body that need not be closed. */
    CHECK(pliant_world_inside(world, TENT, LARGE, 0, NULL, &vertices, NULL) == PLIANT_OK);
    CHECK(vertices.count == 4 && vertices.sides[0] == PLIANT_IS_ON);
    pliant_world_free(world);
}

static void closed_or_not(void) {
    pliant_world *world = a_world();
    pliant_watertight edges, none;
    pliant_containment contained;
    pliant_query query;
    CHECK(pliant_world_watertight(world, LARGE, &none, NULL) == PLIANT_OK);
    CHECK(!none.open.count && !none.turned.count && !none.doubled.count && !none.open.numbers);
    CHECK(pliant_world_watertight(world, TENT, &edges, NULL) == PLIANT_OK);
    CHECK(edges.open.count == 3 && !edges.turned.count && !edges.doubled.count);
    CHECK(edges.open.numbers[0] == 0 && edges.open.numbers[1] == 1 && edges.open.numbers[5] == 2);
    CHECK(pliant_world_contained(world, NULL, &contained, NULL) == PLIANT_OK);
    CHECK(contained.all.count == 1 && contained.all.numbers[0] == SMALL);
    CHECK(contained.all.numbers[1] == 0 && contained.all.numbers[2] == LARGE);
    CHECK(contained.open.count == 1 && contained.open.numbers[0] == TENT);
    memset(&query, 0, sizeof query);
    query.of.kind = PLIANT_BETWEEN;
    query.of.a = DEEP;
    query.of.b = LARGE;
    CHECK(pliant_world_contained(world, &query, &contained, NULL) == PLIANT_OK);
    CHECK(contained.all.count == 0 && !contained.all.numbers && contained.open.count == 0);
    pliant_world_free(world);
}

static void closest(void) {
    pliant_world *world = a_world();
    const pliant_points points = points_of(asked, 5, PLIANT_F64);
    pliant_closest all, of_one, with_signs;
    CHECK(pliant_world_closest_points(world, points, LARGE, INFINITY, NULL, &of_one, NULL) ==
          PLIANT_OK);
    CHECK(of_one.count == 5 && of_one.found[0] == 1 && of_one.bodies[0] == LARGE);
    CHECK(of_one.triangles[0] == 0 && of_one.distances[0] == 1 && of_one.distances[4] == 3);
    CHECK(of_one.points[0] == 4 && of_one.points[1] == 4 && of_one.points[2] == 0);
    CHECK(of_one.features[0] == PLIANT_INSIDE && of_one.features[2] >= PLIANT_ON_EDGE);
    CHECK(of_one.features[2] < PLIANT_INSIDE && of_one.features[3] < PLIANT_ON_EDGE);
    CHECK(of_one.weights[0] == 0.5 && of_one.weights[1] == 0.25 && of_one.weights[2] == 0.25);
    CHECK(of_one.directions[2] == 1 && of_one.directions[14] == -1);
    CHECK(of_one.distances[1] == 0 && of_one.directions[5] == 0);
    /* Signs, and a point beyond the cut-off. */
    CHECK(pliant_world_signed_closest_points(world, points, LARGE, 2, NULL, &with_signs, NULL) ==
          PLIANT_OK);
    CHECK(with_signs.distances[0] == -1 && with_signs.distances[1] == 0);
    CHECK(with_signs.found[3] == 1 && with_signs.found[4] == 0 && isinf(with_signs.distances[4]));
    CHECK(with_signs.bodies[4] == UINT32_MAX && with_signs.triangles[4] == UINT32_MAX);
    CHECK(with_signs.features[4] == 255 && isnan(with_signs.points[12]));
    CHECK(isnan(with_signs.weights[12]) && isnan(with_signs.directions[12]));
    /* Of all bodies; the answer with signs stays. */
    CHECK(pliant_world_remove(world, TENT, NULL) == PLIANT_OK);
    CHECK(pliant_world_closest_points(world, points, PLIANT_ALL_BODIES, 2, NULL, &all, NULL) ==
          PLIANT_OK);
    CHECK(all.bodies[0] == DEEP && all.bodies[3] == LARGE && all.distances[0] < 1);
    CHECK(all.bodies[4] == DEEP && all.found[4] == 1);
    CHECK(pliant_world_closest_points(world, points, SMALL, 0, NULL, &all, NULL) == PLIANT_OK);
    CHECK(all.count == 5 && all.found[0] == 0 && with_signs.distances[0] == -1);
    pliant_world_free(world);
}

static void depths(void) {
    pliant_world *world = a_world();
    pliant_depth depth;
    CHECK(pliant_world_depth(world, DEEP, LARGE, NULL, &depth, NULL) == PLIANT_OK);
    CHECK(depth.count == 4 && depth.vertex == 0 && depth.at_least == depth.of_vertices[0]);
    CHECK(fabs(depth.at_least - 5 / sqrt(3)) < 1e-6 && depth.of_vertices[1] == 0);
    CHECK(depth.at_most > depth.at_least);
    CHECK(pliant_world_depth(world, LARGE, SMALL, NULL, &depth, NULL) == PLIANT_OK);
    CHECK(depth.vertex == UINT32_MAX && depth.at_least == 0 && depth.at_most == 0);
    pliant_world_free(world);
}

static int yes(void *user) { return user == NULL; }

static int look(void *user, const pliant_hits *some) { return user != some; }

static void wrong_arguments(void) {
    pliant_world *world = a_world(), *narrow = NULL;
    const pliant_points points = points_of(asked, 5, PLIANT_F64);
    const double nowhere[2][3] = {{4, 4, 1}, {4, NAN, 1}};
    const pliant_points lost = points_of(nowhere, 2, PLIANT_F64);
    pliant_options options;
    pliant_query query;
    pliant_error error;

    /* Each of the functions that take points, with points, a body and a query. */
#define WITH_POINTS(of, at, body, asks, status, words)                                             \
    refused(pliant_world_points_inside(of, at, body, 0, asks, NULL, &error), &error, status,       \
            words);                                                                                \
    refused(pliant_world_closest_points(of, at, body, 9, asks, NULL, &error), &error, status,      \
            words);                                                                                \
    refused(pliant_world_signed_closest_points(of, at, body, 9, asks, NULL, &error), &error,       \
            status, words)
    WITH_POINTS(NULL, points, LARGE, NULL, PLIANT_NULL, "world");
    WITH_POINTS(world, points_of(NULL, 1, PLIANT_F64), LARGE, NULL, PLIANT_NULL, "points.data");
    WITH_POINTS(world, points_of(asked, 5, 7), LARGE, NULL, PLIANT_BAD_SCALAR, "points.scalar");
    WITH_POINTS(world, points_of(asked, SIZE_MAX, PLIANT_F64), LARGE, NULL, PLIANT_TOO_LARGE,
                "points.count");
    WITH_POINTS(world, points, 77, NULL, PLIANT_NO_SUCH_BODY, "77");
    WITH_POINTS(world, lost, LARGE, NULL, PLIANT_BAD_POINT, "point 1");
    CHECK(error.pair == 1 && error.position[0] == 4 && isnan(error.position[1]));
    CHECK(error.body == UINT32_MAX && error.vertex == UINT32_MAX);
    refused(pliant_world_closest_points(world, lost, PLIANT_ALL_BODIES, 9, NULL, NULL, &error),
            &error, PLIANT_BAD_POINT, "point 1");
    refused(pliant_world_closest_points(world, points, LARGE, NAN, NULL, NULL, &error), &error,
            PLIANT_BAD_DISTANCE, "NaN");
    refused(pliant_world_signed_closest_points(world, points, LARGE, -1, NULL, NULL, &error),
            &error, PLIANT_BAD_DISTANCE, "-1");
    refused(pliant_world_signed_closest_points(world, points, PLIANT_ALL_BODIES, 9, NULL, NULL,
                                               &error),
            &error, PLIANT_NO_SUCH_BODY, "not in this world");

    /* Worlds of single precision take no points of double, and no body that was not given one. */
    pliant_options_default(&options);
    options.scalar = PLIANT_F32;
    CHECK(pliant_world_new(&options, &narrow, NULL) == PLIANT_OK);
    WITH_POINTS(narrow, points, LARGE, NULL, PLIANT_WOULD_ROUND, "points of double");
    WITH_POINTS(narrow, points_of(asked_too, 5, PLIANT_F32), LARGE, NULL, PLIANT_NO_SUCH_BODY, "0");
    pliant_world_free(narrow);

    /* A body that has no inside. */
    refused(pliant_world_points_inside(world, points, TENT, PLIANT_PARITY, NULL, NULL, &error),
            &error, PLIANT_NOT_CLOSED, "3 edges, such as 0-1, 0-2, 1-2");
    CHECK(error.body == TENT && error.count == 3);
    refused(pliant_world_signed_closest_points(world, points, TENT, 1, NULL, NULL, &error), &error,
            PLIANT_NOT_CLOSED, "not closed");
    refused(pliant_world_inside(world, LARGE, TENT, 0, NULL, NULL, &error), &error,
            PLIANT_NOT_CLOSED, "not closed");
    refused(pliant_world_depth(world, LARGE, TENT, NULL, NULL, &error), &error, PLIANT_NOT_CLOSED,
            "not closed");

    /* Rules that are none, bodies that are one, not there, or of no world. */
    refused(pliant_world_points_inside(world, points, LARGE, 3, NULL, NULL, &error), &error,
            PLIANT_BAD_OPTION, "rule is 3");
    refused(pliant_world_inside(world, SMALL, LARGE, 255, NULL, NULL, &error), &error,
            PLIANT_BAD_OPTION, "rule is 255");
    refused(pliant_world_inside(world, LARGE, LARGE, 0, NULL, NULL, &error), &error,
            PLIANT_SAME_BODY, "twice");
    refused(pliant_world_depth(world, LARGE, LARGE, NULL, NULL, &error), &error, PLIANT_SAME_BODY,
            "twice");
    for (int second = 0; second < 2; second++) {
        const uint32_t a = second ? LARGE : 77, b = second ? 77 : LARGE;
        refused(pliant_world_inside(world, a, b, 0, NULL, NULL, &error), &error,
                PLIANT_NO_SUCH_BODY, "77");
        refused(pliant_world_depth(world, a, b, NULL, NULL, &error), &error, PLIANT_NO_SUCH_BODY,
                "77");
    }
    refused(pliant_world_watertight(world, 77, NULL, &error), &error, PLIANT_NO_SUCH_BODY, "77");
    refused(pliant_world_watertight(NULL, LARGE, NULL, &error), &error, PLIANT_NULL, "world");
    refused(pliant_world_inside(NULL, SMALL, LARGE, 0, NULL, NULL, &error), &error, PLIANT_NULL,
            "world");
    refused(pliant_world_contained(NULL, NULL, NULL, &error), &error, PLIANT_NULL, "world");
    refused(pliant_world_depth(NULL, DEEP, LARGE, NULL, NULL, &error), &error, PLIANT_NULL,
            "world");

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
        refused(pliant_world_contained(world, &query, NULL, &error), &error, expected, words);
        if (wrong > 0) { /* these read no selection */
            WITH_POINTS(world, points, LARGE, &query, expected, words);
            refused(pliant_world_inside(world, DEEP, LARGE, 0, &query, NULL, &error), &error,
                    expected, words);
            refused(pliant_world_depth(world, DEEP, LARGE, &query, NULL, &error), &error, expected,
                    words);
        }
    }

    /* Where nothing is to be written nothing is, and the world answers on. */
    CHECK(pliant_world_points_inside(world, points, LARGE, 0, NULL, NULL, NULL) == PLIANT_OK);
    CHECK(pliant_world_inside(world, DEEP, LARGE, 0, NULL, NULL, NULL) == PLIANT_OK);
    CHECK(pliant_world_watertight(world, LARGE, NULL, NULL) == PLIANT_OK);
    CHECK(pliant_world_contained(world, NULL, NULL, NULL) == PLIANT_OK);
    CHECK(pliant_world_closest_points(world, points, LARGE, 1, NULL, NULL, NULL) == PLIANT_OK);
    CHECK(pliant_world_signed_closest_points(world, points, LARGE, 1, NULL, NULL, NULL) ==
          PLIANT_OK);
    CHECK(pliant_world_depth(world, DEEP, LARGE, NULL, NULL, NULL) == PLIANT_OK);
    pliant_world_free(world);
}

int main(void) {
    sides();
    closed_or_not();
    closest();
    depths();
    wrong_arguments();
    return 0;
}
