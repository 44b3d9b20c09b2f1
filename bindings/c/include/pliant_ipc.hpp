/* pliant_ipc.hpp: pliant as a broad phase of ipc-toolkit 1.6. Header only, C++17.

     pliant::BroadPhase broad_phase; // keep it from step to step
     ipc::Candidates candidates;
     candidates.build(mesh, V0, V1, radius, &broad_phase);

   A pair is listed if the closed boxes of both elements on their way, each grown by the radius,
   meet, and no vertex is shared. That is decided without rounding. Lists of the toolkit's own
   methods have these pairs, and those that the rounding of their boxes brings in. */
#ifndef PLIANT_IPC_HPP
#define PLIANT_IPC_HPP

#include "pliant.hpp"

#include <ipc/broad_phase/broad_phase.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <list>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace pliant {
namespace detail {

template <std::size_t N> using Corners = std::array<std::uint32_t, N>;
using Edges = std::vector<Corners<2>>;
using Faces = std::vector<Corners<3>>;
using Points = std::vector<std::array<double, 3>>;

/* All vertices, as elements with one corner each. */
struct Vertices {
    std::size_t count;

    std::size_t size() const { return count; }
    Corners<1> operator[](std::size_t vertex) const { return {std::uint32_t(vertex)}; }
};

/* Rows of indices, each of a vertex. */
template <std::size_t N>
std::vector<Corners<N>> elements(const Eigen::Ref<const Eigen::MatrixXi> &rows,
                                 std::size_t vertices, const std::string &name) {
    if (rows.size() != 0 && rows.cols() != int(N)) {
        throw std::invalid_argument(name + "s have not " + std::to_string(N) + " columns");
    }
    std::vector<Corners<N>> all(rows.size() == 0 ? 0 : std::size_t(rows.rows()));
    for (std::size_t column = 0; column < N; column++) {
        for (std::size_t row = 0; row < all.size(); row++) {
            const int vertex = rows(Eigen::Index(row), Eigen::Index(column));
            if (vertex < 0 || std::size_t(vertex) >= vertices) {
                throw std::invalid_argument(name + " " + std::to_string(row) + " names vertex " +
                                            std::to_string(vertex) + ", and there are " +
                                            std::to_string(vertices) + " vertices");
            }
            all[row][column] = std::uint32_t(vertex);
        }
    }
    return all;
}

/* Rows of two or three coordinates; z is 0 in the plane. */
inline Points positions(const Eigen::Ref<const Eigen::MatrixXd> &rows) {
    if (rows.rows() != 0 && rows.cols() != 2 && rows.cols() != 3) {
        throw std::invalid_argument("vertices have neither 2 nor 3 columns");
    }
    Points points(std::size_t(rows.rows()));
    for (std::size_t column = 0; column < std::size_t(rows.cols()); column++) {
        for (std::size_t row = 0; row < points.size(); row++) {
            points[row][column] = rows(Eigen::Index(row), Eigen::Index(column));
        }
    }
    return points;
}

/* Edges with the smaller end first, sorted. */
inline Edges sorted(Edges edges) {
    for (auto &[a, b] : edges) {
        if (b < a) {
            std::swap(a, b);
        }
    }
    std::sort(edges.begin(), edges.end());
    return edges;
}

/* A mesh with the caller's numbers. */
struct Mesh {
    Vertices vertices{0};
    Edges edges{};
    Faces faces{};

    bool operator==(const Mesh &other) const {
        return vertices.count == other.vertices.count && edges == other.edges &&
               faces == other.faces;
    }

    /* Refuses edges that are listed twice, or have one end. */
    void check() const {
        const Edges all = sorted(edges);
        for (std::size_t edge = 0; edge < all.size(); edge++) {
            const auto &[a, b] = all[edge];
            const bool is_twice = edge > 0 && all[edge] == all[edge - 1];
            if (a == b || is_twice) {
                throw std::invalid_argument(
                    "an edge of vertices " + std::to_string(a) + " and " + std::to_string(b) +
                    (is_twice ? " is listed twice" : " has both ends in one"));
            }
        }
    }

    /* Adds a body: faces, then edges of no face as [i, j, j], then lone vertices as [i, i, i].
       Elements keep their numbers; sides of faces that are not listed as edges come after. */
    std::uint32_t add(World &world, const Points &at) const {
        Edges sides;
        for (const auto &[a, b, c] : faces) {
            sides.insert(sides.end(), {{a, b}, {b, c}, {c, a}});
        }
        sides = sorted(std::move(sides));
        const auto is_point = [](const auto &side) { return side[0] == side[1]; };
        sides.erase(std::remove_if(sides.begin(), sides.end(), is_point), sides.end());
        sides.erase(std::unique(sides.begin(), sides.end()), sides.end());
        const Edges listed = sorted(edges);
        Faces triangles = faces;
        for (const auto &edge : listed) {
            if (!std::binary_search(sides.begin(), sides.end(), edge)) {
                triangles.push_back({edge[0], edge[1], edge[1]});
            }
        }
        std::vector<bool> is_lone(vertices.size(), true);
        for (const auto &[a, b, c] : triangles) {
            is_lone[a] = is_lone[b] = is_lone[c] = false;
        }
        for (std::uint32_t vertex = 0; vertex < vertices.size(); vertex++) {
            if (is_lone[vertex]) {
                triangles.push_back({vertex, vertex, vertex});
            }
        }
        const std::uint32_t body = world.add(triangles, at);
        Edges numbered = edges;
        std::set_difference(sides.begin(), sides.end(), listed.begin(), listed.end(),
                            std::back_inserter(numbered));
        if (!numbered.empty()) {
            world.set_edges(body, numbered);
        }
        return body;
    }
};

/* The mesh of the diagonals of boxes: an edge from corner to corner has the same box. */
inline Mesh diagonals(std::size_t boxes) {
    Mesh mesh{{2 * boxes}};
    for (std::uint32_t corner = 0; corner < 2 * boxes; corner += 2) {
        mesh.edges.push_back({corner, corner + 1});
    }
    return mesh;
}

enum class Kind { vertex_vertex, edge_vertex, edge_face, face_face, edge_edge, face_vertex };

/* A world for the questions of a kind about a mesh. */
struct Held {
    std::shared_ptr<const Mesh> mesh;
    Kind kind;
    World world;
    std::vector<std::uint32_t> bodies{};
    std::uint64_t build = 0; /* whose positions it has */
};

} // namespace detail

/* A broad phase for ipc-toolkit. Keep one, and build it again at every step.

   What only moved needs no new trees: four worlds are kept, also by clear(), those that were asked
   last. Each is of a mesh and a kind of lists; ipc::Candidates asks up to three a step.
   options.threads says how many threads work, and options.mending keeps trees fit for shapes that
   change much. A pool must live as long as the broad phase.

   Lists have an order that does not depend on threads. Questions, which are const, may come from
   several threads, and wait for each other. So they must not be tasks of the scheduler.

   build throws std::invalid_argument: for indices of no vertex, an edge that is listed twice or has
   one end, and matrices of other shapes. pliant::Error comes from the first question: for
   positions, radii and options that pliant refuses. */
class BroadPhase : public ipc::BroadPhase {
    using Positions = Eigen::ConstRef<Eigen::MatrixXd>;
    using Indices = Eigen::ConstRef<Eigen::MatrixXi>;
    using Kind = detail::Kind;

public:
    /* Options of all worlds, and a scheduler, as World takes them; the scalar is always double. */
    explicit BroadPhase(pliant_options options = default_options(),
                        ParallelFor scheduler = nullptr)
        : options_(options), scheduler_(std::move(scheduler)) {
        options_.scalar = PLIANT_F64;
    }

    std::string name() const override { return "pliant"; }

    void build(Positions vertices, Indices edges, Indices faces,
               const double inflation_radius = 0) override {
        clear();
        begin(detail::positions(vertices), {}, edges, faces, inflation_radius);
        dim = std::uint8_t(vertices.cols());
    }

    void build(Positions vertices_t0, Positions vertices_t1, Indices edges, Indices faces,
               const double inflation_radius = 0) override {
        clear();
        if (vertices_t0.rows() != vertices_t1.rows() || vertices_t0.cols() != vertices_t1.cols()) {
            throw std::invalid_argument("vertices at both times are not of one shape");
        }
        begin(detail::positions(vertices_t0), detail::positions(vertices_t1), edges, faces,
              inflation_radius);
        dim = std::uint8_t(vertices_t0.cols());
    }

    /* Boxes of vertices are taken as they are; the box of an element is their hull. */
    void build(const ipc::AABBs &boxes, Indices edges, Indices faces,
               const std::uint8_t dimension) override {
        begin(boxes, edges, faces);
        dim = dimension;
    }

    /* Forgets what was built, but for the trees. */
    void clear() override {
        ipc::BroadPhase::clear();
        mesh_ = std::make_shared<const detail::Mesh>();
    }

    void detect_vertex_vertex_candidates(
        std::vector<ipc::VertexVertexCandidate> &candidates) const override {
        list<Kind::vertex_vertex>(candidates, mesh_->vertices, mesh_->vertices);
    }
    void detect_edge_vertex_candidates(
        std::vector<ipc::EdgeVertexCandidate> &candidates) const override {
        list<Kind::edge_vertex>(candidates, mesh_->edges, mesh_->vertices);
    }
    void detect_edge_edge_candidates(
        std::vector<ipc::EdgeEdgeCandidate> &candidates) const override {
        list<Kind::edge_edge>(candidates, mesh_->edges, mesh_->edges);
    }
    void detect_face_vertex_candidates(
        std::vector<ipc::FaceVertexCandidate> &candidates) const override {
        list<Kind::face_vertex>(candidates, mesh_->faces, mesh_->vertices);
    }
    void detect_edge_face_candidates(
        std::vector<ipc::EdgeFaceCandidate> &candidates) const override {
        list<Kind::edge_face>(candidates, mesh_->edges, mesh_->faces);
    }
    void detect_face_face_candidates(
        std::vector<ipc::FaceFaceCandidate> &candidates) const override {
        list<Kind::face_face>(candidates, mesh_->faces, mesh_->faces);
    }

protected:
    /* From vertex_boxes, where builds of the toolkit end. */
    void build(Indices edges, Indices faces) override {
        const std::uint8_t dimension = dim;
        const ipc::AABBs boxes = vertex_boxes;
        build(boxes, edges, faces, dimension);
    }

private:
    static constexpr std::size_t kept = 4;

    void begin(detail::Points start, detail::Points end, Indices edges, Indices faces,
               double radius) {
        clear();
        const std::size_t count = start.size();
        const detail::Mesh mesh{{count},
                                detail::elements<2>(edges, count, "edge"),
                                detail::elements<3>(faces, count, "face")};
        const auto known = std::find_if(held_.begin(), held_.end(),
                                        [&](const auto &held) { return *held.mesh == mesh; });
        if (known == held_.end()) {
            mesh.check();
        }
        mesh_ = known == held_.end() ? std::make_shared<const detail::Mesh>(mesh) : known->mesh;
        start_ = std::move(start);
        end_ = std::move(end);
        radius_ = radius;
        build_++;
    }

    /* A vertex that moves from corner to corner of a box has that box. */
    void begin(const ipc::AABBs &boxes, Indices edges, Indices faces) {
        detail::Points lower, upper;
        for (const ipc::AABB &box : boxes) {
            lower.push_back({box.min[0], box.min[1], box.min[2]});
            upper.push_back({box.max[0], box.max[1], box.max[2]});
        }
        begin(std::move(lower), std::move(upper), edges, faces, 0.0);
    }

    /* The world for questions of a kind about the mesh; one that was not used for long goes. */
    detail::Held &held(Kind kind) const {
        const auto known = std::find_if(held_.begin(), held_.end(), [&](const auto &held) {
            return held.mesh == mesh_ && held.kind == kind;
        });
        if (known == held_.end()) {
            held_.push_front({mesh_, kind, World(options_, scheduler_)});
            if (held_.size() > kept) {
                held_.pop_back();
            }
        } else {
            held_.splice(held_.begin(), held_, known);
        }
        return held_.front();
    }

    /* Places the body of a number, which is added at first; it rests if `end` is empty. */
    static void place(detail::Held &held, std::size_t number, const detail::Mesh &mesh,
                      const detail::Points &start, const detail::Points &end) {
        if (number == held.bodies.size()) {
            held.bodies.push_back(mesh.add(held.world, start));
        } else {
            held.world.set_positions(held.bodies[number], start);
        }
        if (!end.empty()) {
            held.world.set_motion(held.bodies[number], end);
        }
    }

    /* Lower and upper corners of the boxes of elements on their way. */
    template <class Elements> detail::Points corners(const Elements &elements) const {
        detail::Points corners;
        corners.reserve(2 * elements.size());
        for (std::size_t number = 0; number < elements.size(); number++) {
            const auto element = elements[number];
            auto lower = start_[element[0]], upper = lower;
            for (const std::uint32_t vertex : element) {
                for (const detail::Points *at : {&start_, end_.empty() ? &start_ : &end_}) {
                    for (std::size_t axis = 0; axis < 3; axis++) {
                        lower[axis] = std::min(lower[axis], (*at)[vertex][axis]);
                        upper[axis] = std::max(upper[axis], (*at)[vertex][axis]);
                    }
                }
            }
            corners.insert(corners.end(), {lower, upper});
        }
        return corners;
    }

    /* Whether two elements share no vertex, and any two of their vertices may collide. */
    template <class A, class B> bool may_meet(const A &a, const B &b) const {
        bool is_any = false;
        for (const std::uint32_t of_a : a) {
            for (const std::uint32_t of_b : b) {
                if (of_a == of_b) {
                    return false;
                }
                is_any = is_any || can_vertices_collide(of_a, of_b);
            }
        }
        return is_any;
    }

    /* Lists pairs of elements. Edges with edges and vertices with faces are asked of the mesh as
       it is, others of boxes. */
    template <Kind kind, class C, class A, class B>
    void list(std::vector<C> &candidates, const A &first, const B &second) const {
        constexpr bool is_of_one = std::is_same_v<A, B>;
        constexpr bool is_of_mesh = kind == Kind::edge_edge || kind == Kind::face_vertex;
        constexpr bool vertex_first = kind == Kind::edge_vertex || kind == Kind::face_vertex;
        const std::lock_guard<std::mutex> lock(mutex_);
        candidates.clear();
        if (first.size() == 0 || second.size() == 0) {
            return;
        }
        detail::Held &of = held(is_of_mesh ? Kind::edge_edge : kind);
        if (of.build != build_) {
            if (is_of_mesh) {
                place(of, 0, *mesh_, start_, end_);
            } else {
                place(of, 0, detail::diagonals(first.size()), corners(first), {});
                if (!is_of_one) {
                    place(of, 1, detail::diagonals(second.size()), corners(second), {});
                }
            }
            of.build = build_;
        }
        const bool is_within = is_of_mesh || is_of_one;
        const Query query(is_within ? within(of.bodies[0]) : between(of.bodies[0], of.bodies[1]),
                          PLIANT_UNSORTED);
        const pliant_hits hits = kind == Kind::face_vertex
                                     ? of.world.vertex_triangle_candidates(query, radius_)
                                     : of.world.edge_edge_candidates(query, radius_);
        candidates.reserve(hits.count);
        for (std::size_t hit = 0; hit < hits.count; hit++) {
            std::uint32_t a = hits.pairs[4 * hit + 1], b = hits.pairs[4 * hit + 3];
            if (kind == Kind::face_vertex || (is_of_one && b < a)) {
                std::swap(a, b);
            }
            /* Beyond are sides that are no edges, and triangles that are no faces. */
            const bool is_listed = a < first.size() && b < second.size();
            if (is_listed && (vertex_first ? may_meet(second[b], first[a])
                                           : may_meet(first[a], second[b]))) {
                candidates.emplace_back(ipc::index_t(a), ipc::index_t(b));
            }
        }
    }

    pliant_options options_;
    ParallelFor scheduler_;
    std::shared_ptr<const detail::Mesh> mesh_ = std::make_shared<const detail::Mesh>();
    detail::Points start_, end_; /* end_ is empty if nothing moves */
    double radius_ = 0;
    std::uint64_t build_ = 0; /* builds so far */
    mutable std::mutex mutex_;
    mutable std::list<detail::Held> held_; /* last used first */
};

} // namespace pliant

#endif
