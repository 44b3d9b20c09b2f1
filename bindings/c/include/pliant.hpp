/* pliant.hpp: pliant.h as classes. Header only, C++17.

   A refused call throws pliant::Error, which has the facts of pliant_error; the world is as it was.
   Arrays are taken from anything that has data() and size(), or rows() and cols(): std::vector of
   std::array<double, 3>, Eigen::MatrixXd, Eigen::Ref, Eigen::Map. Eigen is not included. */
#ifndef PLIANT_HPP
#define PLIANT_HPP

#include "pliant.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
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
    View(const T *data, std::size_t size) : data_(data), size_(size) {}

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

inline void check(pliant_status status, const pliant_error &error) {
    if (status != PLIANT_OK) {
        throw Error(error);
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
        if (array.cols() != 3 && array.rows() != 0) {
            throw std::invalid_argument("an array of rows has not 3 columns");
        }
        return Rows<S>{array.data(), static_cast<std::size_t>(array.rows()),
                       array.rowStride() * size, array.colStride() * size};
    } else {
        /* Rows of three numbers, as std::array<double, 3> has them. */
        using R = std::remove_cv_t<std::remove_reference_t<decltype(*array.data())>>;
        using S = std::remove_cv_t<std::remove_reference_t<decltype(std::declval<R &>()[0])>>;
        static_assert(sizeof(R) >= 3 * sizeof(S), "rows have three numbers");
        return Rows<S>{reinterpret_cast<const S *>(array.data()), array.size(),
                       static_cast<std::ptrdiff_t>(sizeof(R)), sizeof(S)};
    }
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
    bool first = false;
    bool unsorted = false;
    std::uint64_t at_most = 0;                       /* 0: any number */
    std::function<bool(const pliant_hits &)> visit;  /* true ends the question */
    std::function<bool()> interrupt;                 /* any thread may call it */

    Query() = default;
    Query(pliant_selection selection) : of(selection) {}
};

/* pliant_options_default. */
inline pliant_options default_options() {
    pliant_options options;
    pliant_options_default(&options);
    return options;
}

/* A world; it moves, and is copied by clone(). Hits are views, as pliant.h says. */
class World {
public:
    explicit World(const pliant_options &options = default_options()) {
        pliant_world *made = nullptr;
        pliant_error error;
        detail::check(pliant_world_new(&options, &made, &error), error);
        world_.reset(made);
    }

    World clone() const {
        pliant_world *copy = nullptr;
        pliant_error error;
        detail::check(pliant_world_clone(get(), &copy, &error), error);
        return World(copy);
    }

    /* The world, for functions of pliant.h. */
    pliant_world *get() const { return world_.get(); }

    template <class F, class P> std::uint32_t add(const F &triangles, const P &positions) {
        std::uint32_t body = 0;
        call(pliant_world_add, faces(triangles), points(positions), &body);
        return body;
    }
    template <class F, class P>
    void set_mesh(std::uint32_t body, const F &triangles, const P &positions) {
        call(pliant_world_set_mesh, body, faces(triangles), points(positions));
    }
    void remove(std::uint32_t body) { call(pliant_world_remove, body); }

    template <class P> void set_positions(std::uint32_t body, const P &positions) {
        call(pliant_world_set_positions, body, points(positions));
    }
    template <class P> void set_motion(std::uint32_t body, const P &end) {
        call(pliant_world_set_motion, body, points(end));
    }
    template <class P> void set_rest_positions(std::uint32_t body, const P &positions) {
        const pliant_points rest = points(positions);
        call(pliant_world_set_rest_positions, body, &rest);
    }
    void advance_motion(double t) { call(pliant_world_advance_motion, t); }

    std::size_t triangle_count(std::uint32_t body) const { return counts(body).first; }
    std::size_t vertex_count(std::uint32_t body) const { return counts(body).second; }

    /* Positions, a copy, in double precision. */
    std::vector<std::array<double, 3>> positions(std::uint32_t body) const {
        std::vector<std::array<double, 3>> all(vertex_count(body));
        call(pliant_world_positions, body, all.data()->data(), all.size());
        return all;
    }

    /* Edges, rows of two vertices as std::array<std::uint32_t, 2>, in the caller's order. */
    template <class A> void set_edges(std::uint32_t body, const A &edges) {
        call(pliant_world_set_edges, body, edges.data()->data(), std::size_t(edges.size()));
    }

    /* Edges in the order of their numbers, two vertices each. */
    View<std::uint32_t> edges(std::uint32_t body) const {
        const std::uint32_t *data = nullptr;
        std::size_t count = 0;
        call(pliant_world_edges, body, &data, &count);
        return {data, 2 * count};
    }

    void set_filter(std::uint32_t body, std::uint32_t membership, std::uint32_t mask) {
        call(pliant_world_set_filter, body, membership, mask);
    }
    void set_environment(std::uint32_t body, std::uint32_t environment) {
        call(pliant_world_set_environment, body, environment);
    }
    void ignore(std::uint32_t a, std::uint32_t b) { call(pliant_world_ignore, a, b); }
    template <class A> void set_vertex_groups(std::uint32_t body, const A &groups) {
        call(pliant_world_set_vertex_groups, body, groups.data(), std::size_t(groups.size()));
    }
    template <class A> void set_vertex_thickness(std::uint32_t body, const A &thickness) {
        call(pliant_world_set_vertex_thickness, body, thickness.data(),
             std::size_t(thickness.size()));
    }
    template <class A> void set_labels(std::uint32_t body, const A &labels) {
        call(pliant_world_set_labels, body, labels.data(), std::size_t(labels.size()), nullptr,
             std::size_t(0));
    }

    pliant_hits intersections(const Query &query = {}) {
        return ask(query, pliant_world_intersections);
    }
    pliant_hits contacts(const Query &query = {}, pliant_contact only = PLIANT_APART) {
        return ask(query, pliant_world_contacts, only);
    }
    pliant_hits adjacent_intersections(const Query &query = {},
                                       pliant_contact only = PLIANT_APART) {
        return ask(query, pliant_world_adjacent_intersections, only);
    }
    pliant_hits crossing_edges(const Query &query = {}) {
        return ask(query, pliant_world_crossing_edges);
    }
    pliant_hits vertex_triangle_candidates(const Query &query, double radius) {
        return ask(query, pliant_world_vertex_triangle_candidates, radius);
    }
    pliant_hits edge_edge_candidates(const Query &query, double radius) {
        return ask(query, pliant_world_edge_edge_candidates, radius);
    }
    pliant_hits close_vertex_triangle_pairs(const Query &query, double distance) {
        return ask(query, pliant_world_close_vertex_triangle_pairs, distance);
    }
    pliant_hits close_edge_edge_pairs(const Query &query, double distance) {
        return ask(query, pliant_world_close_edge_edge_pairs, distance);
    }
    pliant_hits close_triangle_pairs(const Query &query, double distance) {
        return ask(query, pliant_world_close_triangle_pairs, distance);
    }
    pliant_hits vertex_triangle_impacts(const Query &query = {}, double width = 1e-6) {
        return ask(query, pliant_world_vertex_triangle_impacts, width);
    }
    pliant_hits edge_edge_impacts(const Query &query = {}, double width = 1e-6) {
        return ask(query, pliant_world_edge_edge_impacts, width);
    }
    double collision_free_step(pliant_selection of = everything, double min_distance = 0.0) {
        double step = 0.0;
        call(pliant_world_collision_free_step, of, min_distance, &step);
        return step;
    }

private:
    struct Free {
        void operator()(pliant_world *world) const { pliant_world_free(world); }
    };

    explicit World(pliant_world *made) : world_(made) {}

    template <class F, class... Arguments> void call(F function, Arguments... arguments) const {
        pliant_error error;
        detail::check(function(get(), arguments..., &error), error);
    }

    std::pair<std::size_t, std::size_t> counts(std::uint32_t body) const {
        std::size_t triangles = 0, vertices = 0;
        call(pliant_world_counts, body, &triangles, &vertices);
        return {triangles, vertices};
    }

    /* Asks a question. An exception of a visitor ends it, and goes on from here. */
    template <class F, class... Arguments>
    pliant_hits ask(const Query &query, F function, Arguments... arguments) {
        struct Asked {
            const Query *query;
            std::exception_ptr thrown;
        } asked{&query, nullptr};
        pliant_query plain{};
        plain.of = query.of;
        plain.first = query.first;
        plain.unsorted = query.unsorted;
        plain.at_most = query.at_most;
        plain.user = &asked;
        if (query.visit) {
            plain.visit = [](void *user, const pliant_hits *some) {
                Asked &asked = *static_cast<Asked *>(user);
                try {
                    return int(asked.query->visit(*some));
                } catch (...) {
                    asked.thrown = std::current_exception();
                    return 1;
                }
            };
        }
        if (query.interrupt) {
            plain.interrupt = [](void *user) {
                try {
                    return int(static_cast<Asked *>(user)->query->interrupt());
                } catch (...) {
                    return 1;
                }
            };
        }
        pliant_hits hits{};
        pliant_error error;
        const pliant_status status = function(get(), &plain, arguments..., &hits, &error);
        if (asked.thrown) {
            std::rethrow_exception(asked.thrown);
        }
        detail::check(status, error);
        return hits;
    }

    std::unique_ptr<pliant_world, Free> world_;
};

} // namespace pliant

#endif
