/* Meshes that change, from C: edits, pieces, fusion, welding, lists that are followed; and every
   wrong argument. C11 and C++17. */
#include "check.h"

#include <math.h>

/* Two triangles with a side in common, and one apart. */
static const double at[7][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                {5, 0, 0}, {6, 0, 0}, {5, 1, 0}};
static const uint32_t triangles[3][3] = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}};

static pliant_points points_of(const void *data, size_t count) {
    pliant_points points;
    memset(&points, 0, sizeof points);
    points.data = data;
    points.count = count;
    points.scalar = PLIANT_F64;
    return points;
}

static pliant_faces faces_of(const void *data, size_t count) {
    pliant_faces faces;
    memset(&faces, 0, sizeof faces);
    faces.data = data;
    faces.count = count;
    faces.bytes = 4;
    return faces;
}

static pliant_world *a_world(uint32_t *body) {
    pliant_world *world = NULL;
    CHECK(pliant_world_new(NULL, &world, NULL) == PLIANT_OK);
    CHECK(pliant_world_add(world, faces_of(triangles, 3), points_of(at, 7), body, NULL) == 0);
    return world;
}

static int is(pliant_list list, size_t count, uint32_t first) {
    return list.count == count && (count == 0 ? !list.numbers : list.numbers[0] == first);
}

static void edits_and_pieces(void) {
    uint32_t body, made = 0, first = 0, of = 9;
    size_t m = 0, n = 0, count = 9;
    pliant_world *world = a_world(&body);
    pliant_edit *edit = NULL;
    pliant_edited edited;
    const uint32_t second[1] = {1}, last[1] = {2}, new_corners[3] = {0, 1, 7};
    const double above[2][3] = {{0, 0, 1}, {1, 0, 1}};

    /* The square is torn along its diagonal, the third triangle goes, another comes. */
    CHECK(pliant_world_edit(world, body, &edit, NULL) == PLIANT_OK);
    CHECK(pliant_edit_split_vertex(edit, 0, second, 1, &made, NULL) == PLIANT_OK && made == 7);
    CHECK(pliant_edit_split_vertex(edit, 2, second, 1, NULL, NULL) == PLIANT_OK);
    CHECK(pliant_edit_remove_triangles(edit, last, 1, NULL) == PLIANT_OK);
    CHECK(pliant_edit_add_vertices(edit, points_of(above, 2), &first, NULL) == 0 && first == 9);
    CHECK(pliant_edit_add_triangles(edit, faces_of(new_corners, 1), &first, NULL) == 0);
    CHECK(first == 3);
    CHECK(pliant_edit_counts(edit, &of, &m, &n, NULL) == PLIANT_OK);
    CHECK(of == body && m == 4 && n == 11);
    CHECK(pliant_edit_counts(edit, NULL, NULL, NULL, NULL) == PLIANT_OK);
    CHECK(pliant_world_apply(world, edit, &edited, NULL) == PLIANT_OK);
    CHECK(is(edited.new_triangles, 1, 3) && is(edited.changed_triangles, 1, 1));
    CHECK(is(edited.removed_triangles, 1, 2) && is(edited.removed_vertices, 3, 4));
    CHECK(edited.new_vertices.count == 4);
    pliant_error error;
    refused(pliant_world_apply(world, edit, NULL, &error), &error, PLIANT_OUTDATED_EDIT, "edit");
    pliant_edit_free(edit);
    pliant_list live;
    CHECK(pliant_world_live_triangles(world, body, &live, NULL) == PLIANT_OK);
    const uint32_t there[4] = {1, 1, 0, 1};
    CHECK(live.count == 4 && memcmp(live.numbers, there, sizeof there) == 0);

    /* Its numbers are used again, and a vertex goes into another. */
    CHECK(pliant_world_edit(world, body, &edit, NULL) == PLIANT_OK);
    CHECK(pliant_edit_place_vertex(edit, 4, points_of(at[4], 1), NULL) == PLIANT_OK);
    const uint32_t corners[3] = {4, 9, 10};
    CHECK(pliant_edit_set_triangle(edit, 2, corners, NULL) == PLIANT_OK);
    CHECK(pliant_edit_merge_vertices(edit, 0, 7, NULL) == PLIANT_OK);
    CHECK(pliant_world_apply(world, edit, &edited, NULL) == PLIANT_OK);
    CHECK(is(edited.new_triangles, 1, 2) && is(edited.new_vertices, 1, 4));
    CHECK(edited.removed_vertices.count == 1 && edited.removed_vertices.numbers[0] == 7);
    pliant_edit_free(edit);
    pliant_edit_free(NULL);

    /* A piece leaves, comes back, and is welded. */
    const pliant_piece *pieces = NULL;
    pliant_fused fused;
    CHECK(pliant_world_split(world, body, &pieces, &count, NULL) == PLIANT_OK && count == 1);
    CHECK(pieces[0].triangles.count == 1 && pieces[0].triangles.numbers[0] == 2);
    CHECK(pieces[0].vertices.count == 3 && pieces[0].vertices.numbers[0] == 4);
    CHECK(pliant_world_fuse(world, body, pieces[0].body, &fused, NULL) == PLIANT_OK);
    CHECK(fused.triangles.count == 1 && fused.vertices.count == 3);
    CHECK(pliant_world_weld(world, body, 0.0, NULL, &edited, NULL) == PLIANT_OK);
    CHECK(is(edited.removed_vertices, 1, 8) && is(edited.changed_triangles, 1, 1));
    CHECK(pliant_world_validate(world, NULL) == PLIANT_OK);
    pliant_world_free(world);
}

static void lists_are_followed(void) {
    uint32_t body;
    pliant_world *world = a_world(&body);
    pliant_changes *changes = NULL;
    pliant_changed changed;
    const uint32_t two[2][4] = {{0, 3, 1, 5}, {0, 4, 1, 5}}, other[1][4] = {{0, 4, 1, 5}};
    CHECK(pliant_changes_new(PLIANT_TRIANGLES, &changes, NULL) == PLIANT_OK);
    CHECK(pliant_changes_update(changes, &two[0][0], 2, &changed, NULL) == PLIANT_OK);
    CHECK(changed.count == 2 && changed.began_count == 2 && changed.ended_count == 0);
    CHECK(!changed.ended && changed.numbers[1] == 1);
    CHECK(pliant_changes_update(changes, &other[0][0], 1, &changed, NULL) == PLIANT_OK);
    CHECK(changed.numbers[0] == 1 && changed.began_count == 0 && changed.ended_count == 1);
    CHECK(changed.ended_numbers[0] == 0 && changed.ended[1] == 3);
    CHECK(pliant_changes_update(changes, NULL, 0, NULL, NULL) == PLIANT_OK);
    CHECK(pliant_changes_update(changes, NULL, 0, &changed, NULL) == PLIANT_OK);
    CHECK(changed.count == 0 && changed.ended_count == 0);

    pliant_error error;
    pliant_changes *none = NULL;
    refused(pliant_changes_new(4, &none, &error), &error, PLIANT_BAD_OPTION, "elements is 4");
    refused(pliant_changes_new(0, NULL, &error), &error, PLIANT_NULL, "changes");
    refused(pliant_changes_update(NULL, NULL, 0, NULL, &error), &error, PLIANT_NULL, "changes");
    refused(pliant_changes_update(changes, NULL, 1, NULL, &error), &error, PLIANT_NULL, "pairs");
    refused(pliant_changes_update(changes, &two[0][0], SIZE_MAX, NULL, &error), &error,
            PLIANT_TOO_LARGE, "pairs");
    refused(pliant_changes_edited(changes, 0, NULL, &error), &error, PLIANT_NULL, "edited");
    refused(pliant_changes_edges_edited(changes, 0, NULL, 1, NULL, 0, &error), &error, PLIANT_NULL,
            "before");
    refused(pliant_changes_edges_edited(changes, 0, NULL, 0, NULL, 1, &error), &error, PLIANT_NULL,
            "after");
    refused(pliant_changes_split(changes, 0, NULL, 1, &error), &error, PLIANT_NULL, "pieces");
    refused(pliant_changes_fused(changes, 0, 1, NULL, &error), &error, PLIANT_NULL, "fused");
    pliant_edited lies;
    memset(&lies, 0, sizeof lies);
    lies.new_vertices.count = 1;
    refused(pliant_changes_edited(changes, 0, &lies, &error), &error, PLIANT_NULL, "edited");
    refused(pliant_changes_edited(NULL, 0, &lies, &error), &error, PLIANT_NULL, "changes");
    refused(pliant_changes_edges_edited(NULL, 0, NULL, 0, NULL, 0, &error), &error, PLIANT_NULL,
            "changes");
    refused(pliant_changes_split(NULL, 0, NULL, 0, &error), &error, PLIANT_NULL, "changes");
    refused(pliant_changes_fused(NULL, 0, 1, NULL, &error), &error, PLIANT_NULL, "changes");
    pliant_changes_free(changes);
    pliant_changes_free(NULL);

    /* Numbers that an edit uses again are other things, of each kind by its list. */
    for (int kind = 0; kind < 2; kind++) {
        const uint32_t first[1] = {3}, second[1] = {5};
        CHECK(pliant_changes_new(PLIANT_VERTEX_TRIANGLE, &changes, NULL) == PLIANT_OK);
        CHECK(pliant_changes_update(changes, &two[0][0], 1, &changed, NULL) == PLIANT_OK);
        pliant_edited edited;
        memset(&edited, 0, sizeof edited);
        pliant_list *again = kind == 0 ? &edited.new_vertices : &edited.new_triangles;
        again->count = 1;
        again->numbers = kind == 0 ? first : second;
        CHECK(pliant_changes_edited(changes, kind == 0 ? 0 : 1, &edited, NULL) == PLIANT_OK);
        CHECK(pliant_changes_update(changes, &two[0][0], 1, &changed, NULL) == PLIANT_OK);
        CHECK(changed.began_count == 1 && changed.ended_count == 1 && changed.numbers[0] == 1);
        pliant_changes_free(changes);
    }
    pliant_world_free(world);
}

static void wrong_arguments(void) {
    uint32_t body;
    pliant_world *world = a_world(&body), *single = NULL;
    pliant_edit *edit = NULL, *another = NULL;
    pliant_error error;
    pliant_options options;
    const uint32_t corners[3] = {0, 1, 99}, number[1] = {0};
    refused(pliant_world_edit(world, 77, &edit, &error), &error, PLIANT_NO_SUCH_BODY, "77");
    refused(pliant_world_edit(world, body, NULL, &error), &error, PLIANT_NULL, "edit");
    refused(pliant_world_edit(NULL, body, &edit, &error), &error, PLIANT_NULL, "world");
    CHECK(!edit && pliant_world_edit(world, body, &edit, NULL) == PLIANT_OK);
    refused(pliant_edit_counts(NULL, NULL, NULL, NULL, &error), &error, PLIANT_NULL, "edit");
    refused(pliant_edit_add_vertices(NULL, points_of(at, 1), NULL, &error), &error, PLIANT_NULL,
            "edit");
    refused(pliant_edit_add_vertices(edit, points_of(NULL, 1), NULL, &error), &error, PLIANT_NULL,
            "positions");
    refused(pliant_edit_place_vertex(NULL, 0, points_of(at, 1), &error), &error, PLIANT_NULL,
            "edit");
    refused(pliant_edit_place_vertex(edit, 0, points_of(at, 2), &error), &error,
            PLIANT_WRONG_LENGTH, "2 points");
    refused(pliant_edit_split_vertex(NULL, 0, number, 1, NULL, &error), &error, PLIANT_NULL,
            "edit");
    refused(pliant_edit_split_vertex(edit, 0, NULL, 1, NULL, &error), &error, PLIANT_NULL,
            "triangles");
    refused(pliant_edit_merge_vertices(NULL, 0, 1, &error), &error, PLIANT_NULL, "edit");
    refused(pliant_edit_add_triangles(NULL, faces_of(corners, 1), NULL, &error), &error,
            PLIANT_NULL, "edit");
    refused(pliant_edit_add_triangles(edit, faces_of(NULL, 1), NULL, &error), &error, PLIANT_NULL,
            "faces");
    refused(pliant_edit_set_triangle(NULL, 0, corners, &error), &error, PLIANT_NULL, "edit");
    refused(pliant_edit_set_triangle(edit, 0, NULL, &error), &error, PLIANT_NULL, "corners");
    refused(pliant_edit_remove_triangles(NULL, number, 1, &error), &error, PLIANT_NULL, "edit");
    refused(pliant_edit_remove_triangles(edit, NULL, 1, &error), &error, PLIANT_NULL, "triangles");
    refused(pliant_edit_remove_triangles(edit, number, SIZE_MAX, &error), &error, PLIANT_TOO_LARGE,
            "triangles");
    refused(pliant_world_apply(world, NULL, NULL, &error), &error, PLIANT_NULL, "edit");
    refused(pliant_world_apply(NULL, edit, NULL, &error), &error, PLIANT_NULL, "world");

    /* Steps that cannot be are refused when they are applied, one by one. */
    struct {
        pliant_status status;
        const char *words;
    } expected[6] = {{PLIANT_VERTEX_OUT_OF_RANGE, "99"}, {PLIANT_NO_SUCH_TRIANGLE, "33"},
                     {PLIANT_NO_SUCH_VERTEX, "44"},      {PLIANT_VERTEX_IN_USE, "vertex 1"},
                     {PLIANT_NOT_A_CORNER, "vertex 6"},  {PLIANT_BAD_POSITION, "NaN"}};
    const double nowhere[3] = {NAN, 0, 0};
    const uint32_t high[1] = {33};
    for (int step = 0; step < 6; step++) {
        pliant_edit_free(edit);
        CHECK(pliant_world_edit(world, body, &edit, NULL) == PLIANT_OK);
        pliant_status done =
            step == 0   ? pliant_edit_set_triangle(edit, 0, corners, NULL)
            : step == 1 ? pliant_edit_remove_triangles(edit, high, 1, NULL)
            : step == 2 ? pliant_edit_merge_vertices(edit, 0, 44, NULL)
            : step == 3 ? pliant_edit_place_vertex(edit, 1, points_of(at, 1), NULL)
            : step == 4 ? pliant_edit_split_vertex(edit, 6, number, 1, NULL, NULL)
                        : pliant_edit_add_vertices(edit, points_of(nowhere, 1), NULL, NULL);
        CHECK(done == PLIANT_OK);
        refused(pliant_world_apply(world, edit, NULL, &error), &error, expected[step].status,
                expected[step].words);
        CHECK(error.body == body);
    }

    /* An edit belongs to one world. */
    pliant_options_default(&options);
    options.scalar = PLIANT_F32;
    CHECK(pliant_world_new(&options, &single, NULL) == PLIANT_OK);
    refused(pliant_world_apply(single, edit, NULL, &error), &error, PLIANT_OUTDATED_EDIT,
            "precision");
    const float small[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    pliant_points points = points_of(small, 3);
    points.scalar = PLIANT_F32;
    CHECK(pliant_world_add(single, faces_of(triangles, 1), points, NULL, NULL) == PLIANT_OK);
    CHECK(pliant_world_edit(single, 0, &another, NULL) == PLIANT_OK);
    refused(pliant_edit_add_vertices(another, points_of(at, 1), NULL, &error), &error,
            PLIANT_WOULD_ROUND, "double");
    refused(pliant_edit_place_vertex(another, 0, points_of(at, 1), &error), &error,
            PLIANT_WOULD_ROUND, "double");

    refused(pliant_world_weld(world, 77, 0, NULL, NULL, &error), &error, PLIANT_NO_SUCH_BODY, "77");
    refused(pliant_world_weld(world, body, -1, NULL, NULL, &error), &error, PLIANT_BAD_DISTANCE,
            "-1");
    refused(pliant_world_split(world, 77, NULL, NULL, &error), &error, PLIANT_NO_SUCH_BODY, "77");
    refused(pliant_world_fuse(world, body, body, NULL, &error), &error, PLIANT_SAME_BODY, "twice");
    refused(pliant_world_fuse(world, body, 77, NULL, &error), &error, PLIANT_NO_SUCH_BODY, "77");
    pliant_edit_free(edit);
    pliant_edit_free(another);
    pliant_world_free(single);
    pliant_world_free(world);
}

int main(void) {
    edits_and_pieces();
    lists_are_followed();
    wrong_arguments();
    return 0;
}
