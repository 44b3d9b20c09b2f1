/* pliant.hpp: pliant.h as classes. Header only, C++17.

   A refused call throws pliant::Error, which has the facts of pliant_error; the world is as it was.
   With PLIANT_NO_EXCEPTIONS it ends the program with the message; call pliant.h for statuses.
   Arrays are taken from anything that has data() and size(), or rows() and cols(): std::vector of
   std::array<double, 3>, flat vectors of three numbers a row, Eigen::MatrixXd, Eigen::Ref,
   Eigen::Map. Eigen is not included. Of an expression of Eigen give its .eval().

   Hits and other views are valid as pliant.h says; lists of numbers and positions are copies. */
#ifndef PLIANT_HPP
#define PLIANT_HPP

#include "pliant.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

namespace pliant {

/* A refused call: what() is the message. */
class Error : public std::runtime_error {
public:
    explicit Error(const pliant_error &error) : std::runtime_error(error.message), facts(error) {}

    pliant_error facts;
};

/* Items that lie behind each other and belong to somebody else. */
template <class T> class View {
public:
    using value_type = T;

    View(const T *data, std::size_t size) : data_(data), size_(size) {}

    bool empty() const { return size_ == 0; }

    const T *data() const { return data_; }
    std::size_t size() const { return size_; }
    const T *begin() const { return data_; }
    const T *end() const { return data_ + size_; }
    const T &operator[](std::size_t place) const { return data_[place]; }

private:
    const T *data_;
    std::size_t size_;
};

namespace detail {

[[noreturn]] inline void refuse(const pliant_error &error) {
#ifdef PLIANT_NO_EXCEPTIONS
    std::fprintf(stderr, "pliant: %s\n", error.message);
    std::abort();
#else
    throw Error(error);
#endif
}

inline void check(pliant_status status, const pliant_error &error) {
    if (status != PLIANT_OK) {
        refuse(error);
    }
}

/* Calls a function of pliant.h with these arguments, and an error behind. */
template <class F, class... Arguments> void call(F function, Arguments... arguments) {
    pliant_error error;
    check(function(arguments..., &error), error);
}

/* Refuses an array of another form: a count that is not the right one. */
inline void check_count(std::size_t count, std::size_t right, const char *words) {
    if (count != right) {
        pliant_error error{};
        error.status = PLIANT_DIFFERENT_COUNTS;
        error.body = error.triangle = error.vertex = UINT32_MAX;
        error.pair = UINT64_MAX;
        error.limit = right;
        error.count = count;
        std::snprintf(error.message, sizeof error.message, "%zu %s; give %zu", count, words, right);
        refuse(error);
    }
}

template <class S> constexpr pliant_scalar scalar() {
    static_assert(std::is_same_v<S, float> || std::is_same_v<S, double>,
                  "coordinates are float or double");
    return std::is_same_v<S, float> ? PLIANT_F32 : PLIANT_F64;
}

template <class A, class = void> struct has_rows : std::false_type {};
template <class A>
struct has_rows<A, std::void_t<decltype(std::declval<const A &>().rowStride())>>
    : std::true_type {};

/* Address of the first number, count, and strides in bytes, of an array of rows of 3. */
template <class S> struct Rows {
    using Scalar = S;
    const S *data;
    std::size_t count;
    std::ptrdiff_t row, column;
};

template <class A> auto rows_of(const A &array) {
    if constexpr (has_rows<A>::value) {
        using S = std::remove_cv_t<std::remove_reference_t<decltype(*array.data())>>;
        const std::ptrdiff_t size = sizeof(S);
        if (array.rows() != 0) {
            check_count(static_cast<std::size_t>(array.cols()), 3,
                        "columns in an array of rows of three, perhaps its transpose");
        }
        return Rows<S>{array.data(), static_cast<std::size_t>(array.rows()),
                       array.rowStride() * size, array.colStride() * size};
    } else {
        using R = std::remove_cv_t<std::remove_reference_t<decltype(*array.data())>>;
        const std::size_t count = array.size();
        if constexpr (std::is_arithmetic_v<R>) {
            check_count(count % 3, 0, "numbers too many in a flat array of rows of three");
            return Rows<R>{array.data(), count / 3, 3 * sizeof(R), sizeof(R)};
        } else {
            /* Rows of three numbers, as std::array<double, 3> has them. */
            using S = std::remove_cv_t<std::remove_reference_t<decltype(std::declval<R &>()[0])>>;
            static_assert(sizeof(R) >= 3 * sizeof(S) && std::is_trivially_destructible_v<R>,
                          "rows hold three numbers themselves, as std::array<double, 3> does");
            const S *first = count == 0 ? nullptr : &array.data()[0][0];
            if (count != 0) {
                /* Not somewhere else. */
                const auto from = reinterpret_cast<std::uintptr_t>(array.data());
                const auto at = reinterpret_cast<std::uintptr_t>(first);
                const bool holds = at >= from && at + 3 * sizeof(S) <= from + sizeof(R);
                check_count(holds ? 1 : 0, 1, "rows of the first hold three numbers themselves");
            }
            return Rows<S>{first, count, static_cast<std::ptrdiff_t>(sizeof(R)), sizeof(S)};
        }
    }
}

/* Numbers of an array with an index, wherever they lie: std::vector, a column of Eigen's. */
template <class T, class A> std::vector<T> flat(const A &array) {
    using Size = decltype(array.size());
    std::vector<T> all;
    all.reserve(static_cast<std::size_t>(array.size()));
    for (Size place = 0; place < array.size(); place++) {
        static_assert(std::is_integral_v<std::decay_t<decltype(array[place])>> ||
                          !std::is_integral_v<T>,
                      "these are integers");
        all.push_back(static_cast<T>(array[place]));
    }
    return all;
}

/* Pairs of vertices: rows as std::array<int, 2>, or a matrix of Eigen's with two columns. */
template <class A> std::vector<std::array<std::uint32_t, 2>> pairs_of(const A &array) {
    std::vector<std::array<std::uint32_t, 2>> all;
    if constexpr (has_rows<A>::value) {
        if (array.rows() != 0) {
            check_count(static_cast<std::size_t>(array.cols()), 2,
                        "columns in an array of edges");
        }
        for (auto row = array.rows() * 0; row < array.rows(); row++) {
            all.push_back({static_cast<std::uint32_t>(array(row, 0)),
                           static_cast<std::uint32_t>(array(row, 1))});
        }
    } else {
        for (const auto &row : array) {
            static_assert(sizeof(row) == 2 * sizeof(row[0]), "edges have two vertices");
            all.push_back({static_cast<std::uint32_t>(row[0]), static_cast<std::uint32_t>(row[1])});
        }
    }
    return all;
}

} // namespace detail

/* Points of an array; it must live as long as the result. */
template <class A> pliant_points points(const A &array) {
    const auto rows = detail::rows_of(array);
    using S = typename decltype(rows)::Scalar;
    return {rows.data, rows.count, rows.row, rows.column, detail::scalar<S>()};
}

/* Triangles of an array of integers; it must live as long as the result. */
template <class A> pliant_faces faces(const A &array) {
    const auto rows = detail::rows_of(array);
    using I = typename decltype(rows)::Scalar;
    static_assert(std::is_integral_v<I>, "corners are integers");
    const auto bytes = static_cast<std::uint8_t>(sizeof(I));
    return {rows.data, rows.count, rows.row, rows.column, bytes, std::is_signed_v<I>};
}

/* Whom a question is about. */
inline constexpr pliant_selection everything{PLIANT_EVERYTHING, 0, 0};
inline constexpr pliant_selection world{PLIANT_WORLD, 0, 0};
constexpr pliant_selection between(std::uint32_t a, std::uint32_t b) {
    return {PLIANT_BETWEEN, a, b};
}
constexpr pliant_selection within(std::uint32_t body) { return {PLIANT_WITHIN, body, 0}; }

/* How a question is asked: whom, how much, and what ends it. */
struct Query {
    pliant_selection of = everything;
    std::uint8_t how = PLIANT_ALL;
    std::uint64_t at_most = 0;                       /* 0: any number */
    std::function<bool(const pliant_hits &)> visit;  /* true ends the question */
    std::function<bool()> interrupt;                 /* any thread may call it */

    Query() = default;
    Query(pliant_selection selection, std::uint8_t wanted = PLIANT_ALL)
        : of(selection), how(wanted) {}
};

/* A scheduler of the application: calls task(number) for every number below tasks, as
   pliant_parallel_for says. With TBB: tbb::parallel_for(std::size_t(0), tasks, task). */
using ParallelFor =
    std::function<void(std::size_t tasks, const std::function<void(std::size_t)> &task)>;

/* Threads that several worlds share. */
class Pool {
public:
    explicit Pool(std::uint32_t threads) {
        pliant_pool *made = nullptr;
        detail::call(pliant_pool_new, threads, &made);
        pool_.reset(made);
    }

    /* For pliant_options. */
    pliant_pool *get() const { return pool_.get(); }

private:
    struct Free {
        void operator()(pliant_pool *pool) const { pliant_pool_free(pool); }
    };
    std::unique_ptr<pliant_pool, Free> pool_;
};

/* An edit of a world, from World::edit. */
class Edit {
public:
    explicit Edit(pliant_edit *begun) : edit_(begun) {}

    /* The edit, for functions of pliant.h. */
    pliant_edit *get() const { return edit_.get(); }

    std::uint32_t body() const {
        std::uint32_t body = 0;
        call(pliant_edit_counts, &body, nullptr, nullptr);
        return body;
    }
    std::size_t triangle_count() const {
        std::size_t count = 0;
        call(pliant_edit_counts, nullptr, &count, nullptr);
        return count;
    }
    std::size_t vertex_count() const {
        std::size_t count = 0;
        call(pliant_edit_counts, nullptr, nullptr, &count);
        return count;
    }

    /* Numbers of the first of what is new. */
    template <class P> std::uint32_t add_vertices(const P &positions) {
        std::uint32_t first = 0;
        call(pliant_edit_add_vertices, pliant::points(positions), &first);
        return first;
    }
    template <class F> std::uint32_t add_triangles(const F &triangles) {
        std::uint32_t first = 0;
        call(pliant_edit_add_triangles, pliant::faces(triangles), &first);
        return first;
    }
    template <class S> void place_vertex(std::uint32_t vertex, const std::array<S, 3> &point) {
        const pliant_points at{point.data(), 1, 0, 0, detail::scalar<S>()};
        call(pliant_edit_place_vertex, vertex, at);
    }
    template <class A> std::uint32_t split_vertex(std::uint32_t vertex, const A &triangles) {
        const auto of = detail::flat<std::uint32_t>(triangles);
        std::uint32_t made = 0;
        call(pliant_edit_split_vertex, vertex, of.data(), of.size(), &made);
        return made;
    }
    void merge_vertices(std::uint32_t kept, std::uint32_t gone) {
        call(pliant_edit_merge_vertices, kept, gone);
    }
    void set_triangle(std::uint32_t triangle, const std::array<std::uint32_t, 3> &corners) {
        call(pliant_edit_set_triangle, triangle, corners.data());
    }
    template <class A> void remove_triangles(const A &triangles) {
        const auto gone = detail::flat<std::uint32_t>(triangles);
        call(pliant_edit_remove_triangles, gone.data(), gone.size());
    }

private:
    struct Free {
        void operator()(pliant_edit *edit) const { pliant_edit_free(edit); }
    };

    template <class F, class... Arguments> void call(F function, Arguments... arguments) const {
        detail::call(function, get(), arguments...);
    }

    std::unique_ptr<pliant_edit, Free> edit_;
};

/* pliant_options_default. */
inline pliant_options default_options() {
    pliant_options options;
    pliant_options_default(&options);
    return options;
}

/* A world; it moves, and is copied by clone(). Hits are views, as pliant.h says. One call at a time
   is inside, const or not. */
class World {
public:
    /* A scheduler, if one is given, takes at most options.threads tasks at a time. */
    explicit World(pliant_options options = default_options(), ParallelFor scheduler = nullptr) {
        if (scheduler) {
            scheduler_ = std::make_shared<ParallelFor>(std::move(scheduler));
            options.parallel_for = schedule;
            options.parallel_user = scheduler_.get();
        }
        pliant_world *made = nullptr;
        detail::call(pliant_world_new, &options, &made);
        world_.reset(made);
    }

    World clone() const {
        pliant_world *copy = nullptr;
        call(pliant_world_clone, &copy);
        return World(copy, scheduler_);
    }

    /* The world, for functions of pliant.h. */
    pliant_world *get() const { return world_.get(); }

    template <class F, class P> std::uint32_t add(const F &triangles, const P &positions) {
        std::uint32_t body = 0;
        call(pliant_world_add, pliant::faces(triangles), pliant::points(positions), &body);
        return body;
    }
    template <class F, class P>
    void set_mesh(std::uint32_t body, const F &triangles, const P &positions) {
        call(pliant_world_set_mesh, body, pliant::faces(triangles), pliant::points(positions));
    }
    void remove(std::uint32_t body) { call(pliant_world_remove, body); }

    template <class P> void set_positions(std::uint32_t body, const P &positions) {
        call(pliant_world_set_positions, body, pliant::points(positions));
    }
    /* Shapes of several bodies, all or none: rows of pliant::points. */
    void set_positions_of(const std::vector<std::uint32_t> &bodies,
                          const std::vector<pliant_points> &positions) {
        detail::check_count(positions.size(), bodies.size(), "shapes, not one for each body");
        call(pliant_world_set_positions_of, bodies.data(), positions.data(), bodies.size());
    }
    template <class P> void set_motion(std::uint32_t body, const P &end) {
        call(pliant_world_set_motion, body, pliant::points(end));
    }
    template <class P> void set_rest_positions(std::uint32_t body, const P &positions) {
        const pliant_points rest = pliant::points(positions);
        call(pliant_world_set_rest_positions, body, &rest);
    }
    void set_rest_positions(std::uint32_t body, std::nullptr_t) {
        call(pliant_world_set_rest_positions, body, nullptr);
    }
    void advance_motion(double t) { call(pliant_world_advance_motion, t); }
    void finish_motion() { call(pliant_world_finish_motion); }
    void rebuild(std::uint32_t body) { call(pliant_world_rebuild, body); }

    /* Edges, rows of two vertices, in the caller's order. */
    template <class A> void set_edges(std::uint32_t body, const A &edges) {
        const auto own = detail::pairs_of(edges);
        call(pliant_world_set_edges, body, own.empty() ? nullptr : own[0].data(), own.size());
    }

    void set_filter(std::uint32_t body, std::uint32_t membership, std::uint32_t mask) {
        call(pliant_world_set_filter, body, membership, mask);
    }
    void set_environment(std::uint32_t body, std::uint32_t environment) {
        call(pliant_world_set_environment, body, environment);
    }
    void ignore(std::uint32_t a, std::uint32_t b) { call(pliant_world_ignore, a, b); }
    void unignore(std::uint32_t a, std::uint32_t b) { call(pliant_world_unignore, a, b); }
    template <class A> void set_vertex_groups(std::uint32_t body, const A &groups) {
        const auto all = detail::flat<std::uint32_t>(groups);
        call(pliant_world_set_vertex_groups, body, all.data(), all.size());
    }
    template <class A> void set_vertex_thickness(std::uint32_t body, const A &thickness) {
        const auto all = detail::flat<double>(thickness);
        call(pliant_world_set_vertex_thickness, body, all.data(), all.size());
    }
    void set_thickness(std::uint32_t body, double thickness) {
        call(pliant_world_set_thickness, body, thickness);
    }
    /* Without neighbours these are labels with a vertex in common. */
    template <class A>
    void set_labels(std::uint32_t body, const A &labels,
                    const std::vector<std::array<std::uint32_t, 2>> *neighbours = nullptr) {
        /* An empty list is a list, though its address may be NULL. */
        const std::uint32_t none[2] = {0, 0};
        const auto all = detail::flat<std::uint32_t>(labels);
        const std::uint32_t *rows = nullptr;
        std::size_t count = 0;
        if (neighbours) {
            count = neighbours->size();
            rows = count ? neighbours->data()->data() : none;
        }
        call(pliant_world_set_labels, body, all.empty() ? none : all.data(), all.size(), rows,
             count);
    }
    void set_labels(std::uint32_t body, std::nullptr_t) {
        call(pliant_world_set_labels, body, nullptr, std::size_t(0), nullptr, std::size_t(0));
    }
    /* Lower and upper corner. */
    void set_loose_box(std::uint32_t body, const std::array<double, 6> &corners) {
        call(pliant_world_set_loose_box, body, corners.data());
    }
    void set_loose_box(std::uint32_t body, std::nullptr_t) {
        call(pliant_world_set_loose_box, body, nullptr);
    }

    /* Changes of meshes. Lists are valid until the next of these. */
    Edit edit(std::uint32_t body) const {
        pliant_edit *begun = nullptr;
        call(pliant_world_edit, body, &begun);
        return Edit(begun);
    }
    pliant_edited apply(const Edit &edit) & {
        return told<pliant_edited>(pliant_world_apply, edit.get());
    }
    pliant_edited weld(std::uint32_t body, double tolerance, const Query &query = {}) & {
        return told_unless<pliant_edited>(query, [&](auto *plain, auto *edited, auto *error) {
            return pliant_world_weld(get(), body, tolerance, plain, edited, error);
        });
    }
    View<pliant_piece> split(std::uint32_t body) & {
        const pliant_piece *pieces = nullptr;
        std::size_t count = 0;
        call(pliant_world_split, body, &pieces, &count);
        return {pieces, count};
    }
    pliant_fused fuse(std::uint32_t a, std::uint32_t b) & {
        return told<pliant_fused>(pliant_world_fuse, a, b);
    }

    /* Questions with a list. */
    pliant_hits intersections(const Query &query = {}) & {
        return ask(query, pliant_world_intersections);
    }
    pliant_hits contacts(const Query &query = {}, pliant_contact only = PLIANT_APART) & {
        return ask(query, pliant_world_contacts, only);
    }
    pliant_hits adjacent_intersections(const Query &query = {},
                                       pliant_contact only = PLIANT_APART) & {
        return ask(query, pliant_world_adjacent_intersections, only);
    }
    pliant_hits crossing_edges(const Query &query = {}) & {
        return ask(query, pliant_world_crossing_edges);
    }
    pliant_hits vertex_triangle_candidates(const Query &query, double radius) & {
        return ask(query, pliant_world_vertex_triangle_candidates, radius);
    }
    pliant_hits edge_edge_candidates(const Query &query, double radius) & {
        return ask(query, pliant_world_edge_edge_candidates, radius);
    }
    pliant_hits close_vertex_triangle_pairs(const Query &query, double distance) & {
        return ask(query, pliant_world_close_vertex_triangle_pairs, distance);
    }
    pliant_hits close_edge_edge_pairs(const Query &query, double distance) & {
        return ask(query, pliant_world_close_edge_edge_pairs, distance);
    }
    pliant_hits close_triangle_pairs(const Query &query, double distance) & {
        return ask(query, pliant_world_close_triangle_pairs, distance);
    }
    pliant_hits vertex_triangle_impacts(const Query &query = {}, double width = 1e-6) & {
        return ask(query, pliant_world_vertex_triangle_impacts, width);
    }
    pliant_hits edge_edge_impacts(const Query &query = {}, double width = 1e-6) & {
        return ask(query, pliant_world_edge_edge_impacts, width);
    }

    /* Questions with one answer. */
    pliant_hits distance(std::uint32_t a, std::uint32_t b, double cut_off,
                         const Query &query = {}) & {
        return told_unless<pliant_hits>(query, [&](auto *plain, auto *hits, auto *error) {
            return pliant_world_distance(get(), a, b, cut_off, plain, hits, error);
        });
    }
    pliant_hits nearest_body(std::uint32_t body, double cut_off, const Query &query = {}) & {
        return told_unless<pliant_hits>(query, [&](auto *plain, auto *hits, auto *error) {
            return pliant_world_nearest_body(get(), body, cut_off, plain, hits, error);
        });
    }
    pliant_hits first_impact(const Query &query = {}, double width = 1e-6) & {
        return told_unless<pliant_hits>(query, [&](auto *plain, auto *hits, auto *error) {
            return pliant_world_first_impact(get(), plain, width, hits, error);
        });
    }
    double collision_free_step(const Query &query = {}, double min_distance = 0.0) {
        return told_unless<double>(query, [&](auto *plain, auto *step, auto *error) {
            return pliant_world_collision_free_step(get(), plain, min_distance, step, error);
        });
    }
    pliant_free_step free_step(const Query &query = {}, double min_distance = 0.0) {
        return told_unless<pliant_free_step>(query, [&](auto *plain, auto *step, auto *error) {
            return pliant_world_free_step(get(), plain, min_distance, step, error);
        });
    }
    pliant_clearance clearance(const Query &query, double cut_off) & {
        return told_unless<pliant_clearance>(query, [&](auto *plain, auto *all, auto *error) {
            return pliant_world_clearance(get(), plain, cut_off, all, error);
        });
    }
    pliant_feature_pairs feature_pairs(const Query &query, double distance) & {
        return told_unless<pliant_feature_pairs>(query, [&](auto *plain, auto *all, auto *error) {
            return pliant_world_feature_pairs(get(), plain, distance, all, error);
        });
    }

    /* Where pairs of triangles meet, as hits have them. */
    pliant_segments segments(const std::uint32_t *pairs, std::size_t count) & {
        return told<pliant_segments>(pliant_world_segments, pairs, count);
    }
    pliant_curves curves(const std::uint32_t *pairs, std::size_t count, bool areas = false) & {
        return told<pliant_curves>(pliant_world_curves, pairs, count, std::uint8_t(areas));
    }

    /* Inside and outside, closest points, depth. Points are an array, as positions are. */
    pliant_watertight watertight(std::uint32_t body) const & {
        return told<pliant_watertight>(pliant_world_watertight, body);
    }
    template <class P>
    pliant_located points_inside(const P &at, std::uint32_t body,
                                 pliant_inside_rule rule = PLIANT_NON_ZERO,
                                 const Query &query = {}) & {
        return told_unless<pliant_located>(query, [&](auto *plain, auto *located, auto *error) {
            return pliant_world_points_inside(get(), pliant::points(at), body, rule, plain, located,
                                              error);
        });
    }
    pliant_located inside(std::uint32_t a, std::uint32_t b,
                          pliant_inside_rule rule = PLIANT_NON_ZERO, const Query &query = {}) & {
        return told_unless<pliant_located>(query, [&](auto *plain, auto *located, auto *error) {
            return pliant_world_inside(get(), a, b, rule, plain, located, error);
        });
    }
    pliant_containment contained(const Query &query = {}) & {
        return told_unless<pliant_containment>(query, [&](auto *plain, auto *all, auto *error) {
            return pliant_world_contained(get(), plain, all, error);
        });
    }
    /* Of a body, or of PLIANT_ALL_BODIES. */
    template <class P>
    pliant_closest closest_points(const P &at, std::uint32_t body, double cut_off,
                                  const Query &query = {}) & {
        return told_unless<pliant_closest>(query, [&](auto *plain, auto *closest, auto *error) {
            return pliant_world_closest_points(get(), pliant::points(at), body, cut_off, plain,
                                               closest, error);
        });
    }
    template <class P>
    pliant_closest signed_closest_points(const P &at, std::uint32_t body, double cut_off,
                                         const Query &query = {}) & {
        return told_unless<pliant_closest>(query, [&](auto *plain, auto *closest, auto *error) {
            return pliant_world_signed_closest_points(get(), pliant::points(at), body, cut_off,
                                                      plain, closest, error);
        });
    }
    pliant_depth depth(std::uint32_t a, std::uint32_t b, const Query &query = {}) & {
        return told_unless<pliant_depth>(query, [&](auto *plain, auto *out, auto *error) {
            return pliant_world_depth(get(), a, b, plain, out, error);
        });
    }

    /* What it has. Numbers come in rows: three vertices a triangle, two an edge. */
    std::vector<std::uint32_t> bodies() const { return list<1>(pliant_world_bodies); }
    std::vector<std::uint32_t> triangles(std::uint32_t body) const {
        return list<3>(pliant_world_triangles, body);
    }
    std::vector<std::uint32_t> edges(std::uint32_t body) const {
        return list<2>(pliant_world_edges, body);
    }
    std::vector<std::uint32_t> vertex_order(std::uint32_t body) const {
        return list<1>(pliant_world_vertex_order, body);
    }
    std::vector<std::uint32_t> components(std::uint32_t body) const {
        return list<1>(pliant_world_components, body);
    }
    std::vector<std::uint32_t> vertex_groups(std::uint32_t body) const {
        return list<1>(pliant_world_vertex_groups, body);
    }
    std::vector<std::uint32_t> live_triangles(std::uint32_t body) const {
        return list<1>(pliant_world_live_triangles, body);
    }
    std::vector<std::uint32_t> live_vertices(std::uint32_t body) const {
        return list<1>(pliant_world_live_vertices, body);
    }
    std::vector<std::uint32_t> tree_cut(std::uint32_t body, std::uint32_t level) const {
        return list<1>(pliant_world_tree_cut, body, level);
    }
    /* Bodies that ignore each other, two a pair. */
    std::vector<std::uint32_t> ignored() const { return list<2>(pliant_world_ignored); }
    /* Labels, and pairs of neighbours; neither if there are none. */
    std::pair<std::vector<std::uint32_t>, std::vector<std::uint32_t>>
    labels(std::uint32_t body) const {
        pliant_list all{}, pairs{};
        call(pliant_world_labels, body, &all, &pairs);
        return {std::vector<std::uint32_t>(all.numbers, all.numbers + all.count),
                std::vector<std::uint32_t>(pairs.numbers, pairs.numbers + 2 * pairs.count)};
    }

    std::size_t triangle_count(std::uint32_t body) const { return counts(body).first; }
    std::size_t vertex_count(std::uint32_t body) const { return counts(body).second; }
    /* Positions, a copy, in double precision. */
    std::vector<std::array<double, 3>> positions(std::uint32_t body) const {
        std::vector<std::array<double, 3>> all(vertex_count(body));
        call(pliant_world_positions, body, all.data()->data(), all.size());
        return all;
    }
    /* Those at the end of a motion, and of a rest shape; empty without one. */
    std::vector<std::array<double, 3>> end_positions(std::uint32_t body) const {
        return positions_if(pliant_world_end_positions, body);
    }
    std::vector<std::array<double, 3>> rest_positions(std::uint32_t body) const {
        return positions_if(pliant_world_rest_positions, body);
    }
    std::vector<double> thickness(std::uint32_t body) const {
        std::vector<double> all(vertex_count(body));
        call(pliant_world_thickness, body, all.data(), all.size());
        return all;
    }
    /* Membership and mask. */
    std::pair<std::uint32_t, std::uint32_t> filter(std::uint32_t body) const {
        std::uint32_t membership = 0, mask = 0;
        call(pliant_world_filter, body, &membership, &mask);
        return {membership, mask};
    }
    std::uint32_t environment(std::uint32_t body) const {
        return told<std::uint32_t>(pliant_world_environment, body);
    }
    std::uint64_t mesh_revision(std::uint32_t body) const {
        return told<std::uint64_t>(pliant_world_mesh_revision, body);
    }
    /* Lower and upper corner, if there is one. */
    std::optional<std::array<double, 6>> loose_box(std::uint32_t body) const {
        std::array<double, 6> corners{};
        std::uint8_t has = 0;
        call(pliant_world_loose_box, body, corners.data(), &has);
        return has ? std::optional(corners) : std::nullopt;
    }
    double tree_quality(std::uint32_t body) const {
        return told<double>(pliant_world_tree_quality, body);
    }
    pliant_tree_shape tree_shape(std::uint32_t body) const {
        return told<pliant_tree_shape>(pliant_world_tree_shape, body);
    }
    pliant_boxes tree_boxes(std::uint32_t body, std::uint32_t level) const & {
        return told<pliant_boxes>(pliant_world_tree_boxes, body, level);
    }
    /* Without pool and scheduler. */
    pliant_options options() const { return told<pliant_options>(pliant_world_options); }
    pliant_statistics statistics() const {
        return told<pliant_statistics>(pliant_world_statistics);
    }
    std::size_t memory_usage() const { return told<std::size_t>(pliant_world_memory_usage); }
    void validate() const { call(pliant_world_validate); }

private:
    struct Free {
        void operator()(pliant_world *made) const { pliant_world_free(made); }
    };

    World(pliant_world *made, std::shared_ptr<ParallelFor> scheduler)
        : scheduler_(std::move(scheduler)), world_(made) {}

    /* Runs tasks by a scheduler. An exception leaves tasks undone, which the library does. */
    static void schedule(void *user, std::size_t tasks,
                         void (*task)(const void *context, std::size_t number),
                         const void *context) {
        const auto one = [=](std::size_t number) { task(context, number); };
#ifdef PLIANT_NO_EXCEPTIONS
        (*static_cast<ParallelFor *>(user))(tasks, one);
#else
        try {
            (*static_cast<ParallelFor *>(user))(tasks, one);
        } catch (...) {
        }
#endif
    }

    template <class F, class... Arguments> void call(F function, Arguments... arguments) const {
        detail::call(function, get(), arguments...);
    }

    std::pair<std::size_t, std::size_t> counts(std::uint32_t body) const {
        std::size_t triangles = 0, vertices = 0;
        call(pliant_world_counts, body, &triangles, &vertices);
        return {triangles, vertices};
    }

    /* What a function writes behind its arguments. */
    template <class T, class F, class... Arguments>
    T told(F function, Arguments... arguments) const {
        T out{};
        call(function, arguments..., &out);
        return out;
    }

    /* A list whose rows have several numbers. */
    template <int Columns, class F, class... Arguments>
    std::vector<std::uint32_t> list(F function, Arguments... arguments) const {
        const auto rows = told<pliant_list>(function, arguments...);
        return {rows.numbers, rows.numbers + Columns * rows.count};
    }

    template <class F>
    std::vector<std::array<double, 3>> positions_if(F function, std::uint32_t body) const {
        std::vector<std::array<double, 3>> all(vertex_count(body));
        std::uint8_t has = 0;
        call(function, body, all.data()->data(), all.size(), &has);
        all.resize(has ? all.size() : 0);
        return all;
    }

    /* A query on its way through C, and what a function of it threw. */
    struct Asked {
        const Query *query;
        std::exception_ptr thrown;
        std::mutex lock;
    };

    /* Calls a function of the query. An exception ends the question, and goes on from there. */
    template <class F> static int guarded(void *user, F function) {
        Asked &asked = *static_cast<Asked *>(user);
#ifdef PLIANT_NO_EXCEPTIONS
        return int(function(*asked.query));
#else
        try {
            return int(function(*asked.query));
        } catch (...) {
            const std::lock_guard<std::mutex> held(asked.lock);
            if (!asked.thrown) {
                asked.thrown = std::current_exception();
            }
            return 1;
        }
#endif
    }

    /* Asks: `function` has the query of C, and where the answer and an error go. */
    template <class T, class F> T told_unless(const Query &query, F function) const {
        Asked asked{&query, nullptr, {}};
        pliant_query plain{};
        plain.of = query.of;
        plain.how = query.how;
        plain.at_most = query.at_most;
        plain.user = &asked;
        if (query.visit) {
            plain.visit = [](void *user, const pliant_hits *some) {
                return guarded(user, [=](const Query &asked_of) { return asked_of.visit(*some); });
            };
        }
        if (query.interrupt) {
            plain.interrupt = [](void *user) {
                return guarded(user, [](const Query &asked_of) { return asked_of.interrupt(); });
            };
        }
        T out{};
        pliant_error error;
        const pliant_status status = function(&plain, &out, &error);
        if (asked.thrown) {
            std::rethrow_exception(asked.thrown);
        }
        detail::check(status, error);
        return out;
    }

    template <class F, class... Arguments>
    pliant_hits ask(const Query &query, F function, Arguments... arguments) {
        return told_unless<pliant_hits>(query, [&](auto *plain, auto *hits, auto *error) {
            return function(get(), plain, arguments..., hits, error);
        });
    }

    std::shared_ptr<ParallelFor> scheduler_;
    std::unique_ptr<pliant_world, Free> world_;
};

/* Memory of the last list of hits: what began, persists and ended is told of the next. */
class Changes {
public:
    /* PLIANT_TRIANGLES to PLIANT_EDGE_TRIANGLE. */
    explicit Changes(std::uint32_t elements = PLIANT_TRIANGLES) {
        pliant_changes *made = nullptr;
        detail::call(pliant_changes_new, elements, &made);
        changes_.reset(made);
    }

    pliant_changed update(const pliant_hits &hits) {
        pliant_changed changed{};
        call(pliant_changes_update, hits.pairs, hits.count, &changed);
        return changed;
    }
    void edited(std::uint32_t body, const pliant_edited &edited) {
        call(pliant_changes_edited, body, &edited);
    }
    /* Edges of a body before and after an edit, as World::edges has them. */
    template <class A, class B>
    void edges_edited(std::uint32_t body, const A &before, const B &after) {
        const auto from = detail::flat<std::uint32_t>(before);
        const auto to = detail::flat<std::uint32_t>(after);
        call(pliant_changes_edges_edited, body, from.data(), from.size() / 2, to.data(),
             to.size() / 2);
    }
    void split(std::uint32_t body, const View<pliant_piece> &pieces) {
        call(pliant_changes_split, body, pieces.data(), pieces.size());
    }
    void fused(std::uint32_t body, std::uint32_t gone, const pliant_fused &fused) {
        call(pliant_changes_fused, body, gone, &fused);
    }

private:
    struct Free {
        void operator()(pliant_changes *changes) const { pliant_changes_free(changes); }
    };

    template <class F, class... Arguments> void call(F function, Arguments... arguments) {
        detail::call(function, changes_.get(), arguments...);
    }

    std::unique_ptr<pliant_changes, Free> changes_;
};

} // namespace pliant

#endif
