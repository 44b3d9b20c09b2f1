/* broad_phase.hpp: what an adapter sees of ipc-toolkit's broad phases, for tests without it.

   Names, members and functions are those of ipc-toolkit 1.6; nothing here finds a candidate. */
#ifndef STAND_IN_BROAD_PHASE_HPP
#define STAND_IN_BROAD_PHASE_HPP

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace Eigen {
template <class T> using ConstRef = const Ref<const T> &;
}

namespace ipc {

using index_t = std::int32_t;

/* Which two vertices may collide: any function, at first one that lets all pass. */
struct CollisionFilter {
    std::function<bool(std::size_t, std::size_t)> may_pass;

    CollisionFilter() : CollisionFilter([](std::size_t, std::size_t) { return true; }) {}
    template <class F> CollisionFilter(F function) : may_pass(std::move(function)) {}
    bool operator()(std::size_t a, std::size_t b) const { return may_pass(a, b); }
};

struct AABB {
    Eigen::Array3d min, max;
    std::array<index_t, 3> vertex_ids;
};
using AABBs = std::vector<AABB>;

/* A pair of elements, with the names of both numbers. */
#define STAND_IN_CANDIDATE(Name, first, second)                                                    \
    struct Name {                                                                                  \
        index_t first, second;                                                                     \
        Name(index_t a, index_t b) : first(a), second(b) {}                                        \
    };
STAND_IN_CANDIDATE(VertexVertexCandidate, vertex0_id, vertex1_id)
STAND_IN_CANDIDATE(EdgeVertexCandidate, edge_id, vertex_id)
STAND_IN_CANDIDATE(EdgeEdgeCandidate, edge0_id, edge1_id)
STAND_IN_CANDIDATE(FaceVertexCandidate, face_id, vertex_id)
STAND_IN_CANDIDATE(EdgeFaceCandidate, edge_id, face_id)
STAND_IN_CANDIDATE(FaceFaceCandidate, face0_id, face1_id)
#undef STAND_IN_CANDIDATE

class BroadPhase {
public:
    virtual ~BroadPhase() = default;
    virtual std::string name() const = 0;

    using Positions = Eigen::ConstRef<Eigen::MatrixXd>;
    using Indices = Eigen::ConstRef<Eigen::MatrixXi>;
    virtual void build(Positions, Indices, Indices, const double = 0) {}
    virtual void build(Positions, Positions, Indices, Indices, const double = 0) {}
    virtual void build(const AABBs &boxes, Indices edges, Indices faces, const std::uint8_t) {
        vertex_boxes = boxes;
        build(edges, faces);
    }
    virtual void clear() {
        vertex_boxes.clear();
        dim = 0;
    }

    virtual void detect_vertex_vertex_candidates(std::vector<VertexVertexCandidate> &) const = 0;
    virtual void detect_edge_vertex_candidates(std::vector<EdgeVertexCandidate> &) const = 0;
    virtual void detect_edge_edge_candidates(std::vector<EdgeEdgeCandidate> &) const = 0;
    virtual void detect_face_vertex_candidates(std::vector<FaceVertexCandidate> &) const = 0;
    virtual void detect_edge_face_candidates(std::vector<EdgeFaceCandidate> &) const = 0;
    virtual void detect_face_face_candidates(std::vector<FaceFaceCandidate> &) const = 0;

    CollisionFilter can_vertices_collide;

protected:
    virtual void build(Indices, Indices) {}

    AABBs vertex_boxes;
    std::uint8_t dim = 0;
};

} // namespace ipc

#endif
