/* Worlds as classes: arrays of C++ and of Eigen's form, errors as exceptions, visitors. C++17. */
#include "check.h"
#include "pliant.hpp"

#if __has_include(<Eigen/Core>)
#include <Eigen/Core>
#define HAS_EIGEN
#endif

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

/* What Eigen's matrices have: columns behind each other. */
template <class T> struct Matrix {
    std::vector<T> numbers;
    std::ptrdiff_t count;

    explicit Matrix(const std::vector<std::array<T, 3>> &rows)
        : numbers(3 * rows.size()), count(std::ptrdiff_t(rows.size())) {
        for (std::size_t row = 0; row < rows.size(); row++) {
            for (std::size_t column = 0; column < 3; column++) {
                numbers[column * rows.size() + row] = rows[row][column];
            }
        }
    }
    const T *data() const { return numbers.data(); }
    std::ptrdiff_t rows() const { return count; }
    std::ptrdiff_t cols() const { return 3; }
    std::ptrdiff_t rowStride() const { return 1; }
    std::ptrdiff_t colStride() const { return count; }
};

int main() {
    const std::vector<std::array<int, 3>> triangle{{0, 1, 2}};
    const std::vector<std::array<double, 3>> floor_at{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}};
    const std::vector<std::array<double, 3>> leaf_at{{0, 0, 2}, {1, 0, 3}, {0, 1, 3}};
    const std::vector<std::array<float, 3>> leaf_to{{0, 0, -2}, {1, 0, 1}, {0, 1, 1}};

    pliant::World world;
    const auto floor = world.add(triangle, floor_at);
    const auto leaf = world.add(Matrix<int>(triangle), Matrix<double>(leaf_at));
    CHECK(world.triangle_count(leaf) == 1 && world.vertex_count(floor) == 3);
    CHECK(world.edges(leaf).size() == 6 && world.edges(leaf)[5] == 2);
    world.set_motion(leaf, Matrix<float>(leaf_to));
    const auto impacts = world.vertex_triangle_impacts(pliant::between(floor, leaf));
    CHECK(impacts.count == 1 && impacts.high[0] > 0.49);
    const double step = world.collision_free_step();
    CHECK(step > 0.4 && step < 0.5);
    pliant::World copy = world.clone();
    world.advance_motion(step);
    CHECK(world.intersections().count == 0);
    copy.advance_motion(1.0);
    CHECK(copy.intersections(pliant::world).count == 1);
    CHECK(copy.contacts().kinds[0] == PLIANT_CROSSING);
    CHECK(copy.contacts({}, PLIANT_TOUCHING).count == 0);
    CHECK(copy.crossing_edges().count == 2 && copy.adjacent_intersections().count == 0);
    CHECK(copy.close_triangle_pairs(pliant::everything, 0.1).count == 1);
    CHECK(copy.close_vertex_triangle_pairs(pliant::everything, 1.0).count == 2);
    CHECK(copy.close_edge_edge_pairs(pliant::everything, 0.1).count == 0);
    CHECK(copy.edge_edge_candidates(pliant::everything, 9.0).count == 9);
    CHECK(copy.vertex_triangle_candidates(pliant::everything, 9.0).count == 6);
    CHECK(copy.edge_edge_impacts().count == 0);

    /* Visitors, first hits, and exceptions on their way. */
    std::size_t seen = 0;
    pliant::Query query;
    query.visit = [&](const pliant_hits &some) { return seen += some.count, false; };
    CHECK(copy.intersections(query).count == 0 && seen == 1);
    query.visit = [](const pliant_hits &) -> bool { throw std::string("mine"); };
    bool thrown = false;
    try {
        copy.intersections(query);
    } catch (const std::string &what) {
        thrown = what == "mine";
    }
    CHECK(thrown);
    query = {};
    query.how = PLIANT_FIRST;
    CHECK(copy.intersections(query).count == 1);
    query = {};
    query.interrupt = [] { return true; };
    pliant_status status = PLIANT_OK;
    try {
        copy.intersections(query);
    } catch (const pliant::Error &error) {
        status = error.facts.status;
    }
    CHECK(status == PLIANT_INTERRUPTED);

    try {
        world.set_positions(leaf, floor_at);
        world.set_positions(77, floor_at);
        CHECK(false);
    } catch (const pliant::Error &error) {
        CHECK(error.facts.status == PLIANT_NO_SUCH_BODY && error.facts.body == 77);
        CHECK(std::string(error.what()).find("77") != std::string::npos);
    }
    const std::vector<std::array<std::uint32_t, 2>> own{{2, 1}, {1, 0}, {2, 0}};
    world.set_edges(leaf, own);
    CHECK(world.edges(leaf)[0] == 1 && world.edges(leaf)[2] == 0 && world.edges(leaf)[3] == 1);
    CHECK(world.positions(leaf) == floor_at);
#ifdef HAS_EIGEN
    Eigen::MatrixXd at(3, 3);
    at << 0, 0, -1, 1, 0, 1, 0, 1, 1;
    Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor> corners(1, 3);
    corners << 0, 1, 2;
    const auto other = world.add(corners, at);
    const auto part = world.add(Eigen::MatrixXi(corners), at.topRows(3));
    CHECK(world.positions(other) == world.positions(part) && world.positions(part)[1][2] == 1.0);
    const Eigen::Ref<const Eigen::MatrixXd> lifted = at;
    world.set_positions(other, lifted);
    world.set_positions(part, at.cast<float>().eval());
    CHECK(world.intersections(pliant::between(other, part)).count == 1);
    world.remove(other);
    world.remove(part);
#endif
    world.set_filter(leaf, 1, 2);
    world.set_environment(leaf, 1);
    world.ignore(floor, leaf);
    CHECK(world.intersections().count == 0 && world.ignored().size() == 2);
    CHECK(world.filter(leaf).second == 2 && world.environment(leaf) == 1);
    world.unignore(floor, leaf);
    CHECK(world.ignored().size() == 0 && world.ignored().begin() == world.ignored().end());
    world.set_vertex_groups(leaf, std::vector<std::uint32_t>(3, 1));
    CHECK(world.vertex_groups(leaf)[2] == 1);
    world.set_vertex_thickness(leaf, std::vector<double>(3, 0.5));
    world.set_thickness(floor, 0.25);
    CHECK(world.thickness(leaf)[0] == 0.5 && world.thickness(floor)[2] == 0.25);
    const std::vector<std::array<std::uint32_t, 2>> near{{4, 5}}, none;
    world.set_labels(leaf, std::vector<std::uint32_t>(1, 4), &near);
    CHECK(world.labels(leaf).first[0] == 4 && world.labels(leaf).second[1] == 5);
    world.set_labels(leaf, std::vector<std::uint32_t>(1, 4), &none);
    world.set_labels(leaf, std::vector<int>(1, 4));
    const auto refused = [](const auto &call) {
        try {
            call();
        } catch (const pliant::Error &error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const auto holds = [](const std::string &text, const char *words) {
        return text.find(words) != std::string::npos;
    };
    CHECK(holds(refused([&] { world.set_labels(leaf, std::vector<int>()); }), "0 labels for 1"));
    CHECK(world.labels(leaf).first.size() == 1);
    world.set_labels(leaf, nullptr);
    CHECK(holds(refused([&] { world.set_edges(leaf, std::vector<std::array<int, 2>>()); }),
                "edges lack"));
    const std::vector<double> flat{0, 0, 2, 1, 0, 3, 0, 1, 3}, odd(10);
    world.set_positions(leaf, flat);
    CHECK(world.positions(leaf) == leaf_at);
    CHECK(holds(refused([&] { world.set_positions(leaf, odd); }), "flat"));
    CHECK(holds(refused([&] { world.set_positions_of({leaf}, {}); }), "0 shapes"));
#ifdef HAS_EIGEN
    /* Columns of a matrix, which have a stride; edges as a matrix; the transpose, which is none. */
    Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor> table(3, 4);
    table << 0, 0, 2, 0.1, 1, 0, 3, 0.2, 0, 1, 3, 0.3;
    world.set_vertex_thickness(leaf, table.col(3));
    CHECK(world.thickness(leaf)[2] == 0.3);
    world.set_thickness(leaf, 0.5);
    world.set_positions(leaf, table.leftCols(3));
    Eigen::MatrixXi ends(3, 2);
    ends << 2, 1, 1, 0, 2, 0;
    world.set_edges(leaf, ends);
    CHECK(world.edges(leaf)[0] == 1 && world.edges(leaf)[3] == 1);
    const Eigen::MatrixXd across = Eigen::MatrixXd::Zero(3, 5);
    CHECK(holds(refused([&] { world.set_positions(leaf, across); }), "5 columns"));
    CHECK(holds(refused([&] { world.set_edges(leaf, across.cast<int>().eval()); }), "5 columns"));
#endif
    CHECK(world.labels(leaf).first.size() == 0);
    CHECK(world.rest_positions(leaf).empty() && world.end_positions(leaf).empty());
    world.set_rest_positions(leaf, leaf_at);
    CHECK(world.rest_positions(leaf) == leaf_at);
    world.set_rest_positions(leaf, nullptr);
    world.set_loose_box(leaf, {-9, -9, -9, 9, 9, 9});
    CHECK(world.loose_box(leaf)->at(3) == 9 && !world.loose_box(floor));
    world.set_loose_box(leaf, nullptr);
    world.set_motion(leaf, leaf_at);
    CHECK(world.end_positions(leaf) == leaf_at);
    world.finish_motion();
    world.rebuild(leaf);
    world.set_mesh(leaf, triangle, leaf_at);
    world.set_positions_of({floor, leaf}, {pliant::points(floor_at), pliant::points(leaf_at)});
    CHECK(world.bodies().size() == 2 && world.triangles(leaf)[2] == 2);
    CHECK(world.vertex_order(leaf).size() == 3 && world.components(leaf)[0] == 0);
    CHECK(world.tree_shape(leaf).nodes == 1 && world.tree_cut(leaf, 0)[0] == 0);
    CHECK(world.tree_boxes(leaf, 0).count == 1 && world.tree_quality(leaf) == 1.0);
    CHECK(world.options().degree == 8 && world.memory_usage() > 0);
    world.validate();

    /* One answer, also with an interrupt that throws. */
    world.set_environment(leaf, 0);
    world.set_filter(leaf, 1, ~0u);
    CHECK(world.distance(leaf, floor, 9.0).distances[0] == 2.0);
    CHECK(world.nearest_body(leaf, 1.0).count == 0);
    query = {};
    query.interrupt = []() -> bool { throw 7; };
    int number = 0;
    try {
        world.distance(leaf, floor, 9.0, query);
    } catch (int what) {
        number = what;
    }
    CHECK(number == 7);
    CHECK(world.clearance(pliant::everything, 1.0).body_count == 2);
    CHECK(world.feature_pairs(pliant::everything, 2.0).count == 1);
    CHECK(!world.free_step().moves);
    world.set_motion(leaf, leaf_to);
    CHECK(world.free_step().moves && world.first_impact().count == 1);
    world.finish_motion();
    CHECK(world.statistics().pairs > 0);
    const auto met = world.intersections(pliant::Query(pliant::world, PLIANT_ROWS));
    CHECK(met.count == 1 && met.rows.body_count == 2);
    CHECK(world.segments(met.pairs, met.count).offsets[1] == 2);
    CHECK(world.curves(met.pairs, met.count).count == 1);

    /* Inside and outside, closest points and depth, in a world of their own. */
    {
        const std::vector<std::array<int, 3>> faces{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
        const std::vector<std::array<double, 3>> out{{0, 0, 0}, {8, 0, 0}, {0, 8, 0}, {0, 0, 8}};
        const std::vector<std::array<float, 3>> in{{1, 1, 1}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}};
        pliant::World closed;
        const auto large = closed.add(faces, out), small = closed.add(faces, in);
        const auto open = closed.add(triangle, floor_at);
        CHECK(closed.watertight(open).open.count == 3 && closed.watertight(large).open.count == 0);
        CHECK(closed.points_inside(in, large).sides[3] == PLIANT_IS_INSIDE);
        const auto located = closed.points_inside(Matrix<double>(out), large, PLIANT_PARITY);
        CHECK(located.count == 4 && located.sides[1] == PLIANT_IS_ON && located.windings[1] == 0);
        CHECK(closed.inside(small, large).windings[0] == 1);
        CHECK(closed.inside(large, small, PLIANT_POSITIVE).sides[0] == PLIANT_IS_OUTSIDE);
        const auto contained = closed.contained(pliant::between(large, small));
        CHECK(contained.all.count == 1 && contained.all.numbers[2] == large);
        CHECK(closed.contained().open.numbers[0] == open);
        const auto nearest = closed.closest_points(in, PLIANT_ALL_BODIES, 9.0);
        CHECK(nearest.count == 4 && nearest.bodies[0] == small && nearest.distances[0] == 0.0);
        const auto with_signs = closed.signed_closest_points(in, large, 9.0);
        CHECK(with_signs.distances[0] == -1.0 && with_signs.features[0] == PLIANT_INSIDE);
        CHECK(closed.depth(small, large).at_least == 1.0);
        CHECK(holds(refused([&] { closed.inside(large, open); }), "0-1, 0-2, 1-2"));
        CHECK(holds(refused([&] { closed.depth(large, large); }), "twice"));
        query = {};
        query.interrupt = [] { return true; };
        CHECK(holds(refused([&] { closed.contained(query); }), "interrupted"));
        CHECK(holds(refused([&] { closed.depth(small, large, query); }), "interrupted"));
    }

    /* A mesh that changes, and lists that are followed. */
    pliant::Changes changes;
    CHECK(changes.update(met).began_count == 1);
    const auto edges_before = world.edges(leaf);
    pliant::Edit edit = world.edit(leaf);
    const std::uint32_t first = edit.add_vertices(floor_at);
    CHECK(first == 3 && edit.add_triangles(std::vector<std::array<int, 3>>{{3, 4, 5}}) == 1);
    CHECK(edit.body() == leaf && edit.triangle_count() == 2 && edit.vertex_count() == 6);
    const auto edited = world.apply(edit);
    CHECK(edited.new_triangles.count == 1 && edited.new_vertices.count == 3);
    changes.edited(leaf, edited);
    changes.edges_edited(leaf, edges_before, world.edges(leaf));
    const auto pieces = world.split(leaf);
    changes.split(leaf, pieces);
    CHECK(pieces.size() == 1 && world.live_triangles(leaf)[1] == 0);
    CHECK(world.live_vertices(leaf)[3] == 0 && world.mesh_revision(leaf) > 1);
    const std::uint32_t piece = pieces[0].body;
    const auto fused = world.fuse(leaf, piece);
    changes.fused(leaf, piece, fused);
    CHECK(changes.update(world.intersections(pliant::world)).count == 2);
    pliant::Edit other_edit = world.edit(floor);
    const std::uint32_t copied = other_edit.split_vertex(2, std::vector<std::uint32_t>{0});
    other_edit.merge_vertices(copied, 1);
    other_edit.place_vertex(1, std::array<double, 3>{9, -9, 0});
    other_edit.set_triangle(0, {0, 1, copied});
    other_edit.remove_triangles(std::vector<std::uint32_t>{});
    world.apply(other_edit);
    CHECK(world.weld(floor, 0.0).removed_vertices.count == 0);
    CHECK(pliant_changes_new(9, nullptr, nullptr) != PLIANT_OK);

    /* Threads that worlds share. */
    {
        pliant_options shared = pliant::default_options();
        const pliant::Pool pool(2);
        shared.pool = pool.get();
        shared.threads = 2;
        pliant::World one(shared), two(shared);
        one.add(triangle, leaf_at);
        CHECK(one.intersections().count == 0 && two.intersections().count == 0);
    }
    world.remove(leaf);
    pliant::World moved = std::move(world);
    CHECK(moved.intersections().count == 0);
    return 0;
}
