/* free_step: a tetrahedron falls on a sheet, by ipc-toolkit with pliant as its broad phase.

   Each step goes as far as nothing meets. It is compiled as any program that uses the toolkit, with
   pliant's headers and library beside. */
#include "pliant_ipc.hpp"

#include <ipc/candidates/candidates.hpp>
#include <ipc/collision_mesh.hpp>

#include <cstdio>
#include <set>

/* All edges of faces, once. igl::edges does the same. */
static Eigen::MatrixXi edges_of(const Eigen::MatrixXi &faces) {
    std::set<std::pair<int, int>> edges;
    for (int face = 0; face < faces.rows(); face++) {
        for (int corner = 0; corner < 3; corner++) {
            edges.insert(std::minmax(faces(face, corner), faces(face, (corner + 1) % 3)));
        }
    }
    Eigen::MatrixXi rows(int(edges.size()), 2);
    int row = 0;
    for (const auto &[a, b] : edges) {
        rows.row(row++) << a, b;
    }
    return rows;
}

int main() {
    const int size = 20; /* vertices along a side of the sheet */
    Eigen::MatrixXd at(size * size + 4, 3);
    Eigen::MatrixXi faces(2 * (size - 1) * (size - 1) + 4, 3);
    int face = 0;
    for (int x = 0; x < size; x++) {
        for (int y = 0; y < size; y++) {
            const int vertex = x * size + y;
            at.row(vertex) << x / 10.0 - 1, y / 10.0 - 1, 0;
            if (x > 0 && y > 0) {
                faces.row(face++) << vertex, vertex - 1, vertex - size - 1;
                faces.row(face++) << vertex, vertex - size - 1, vertex - size;
            }
        }
    }
    const int tip = size * size;
    at.bottomRows(4) << 0.03, 0.02, 0.5, -0.3, 0, 1, 0.3, -0.3, 1, 0.3, 0.3, 1;
    faces.bottomRows(4) << tip, tip + 1, tip + 2, tip, tip + 2, tip + 3, tip, tip + 3, tip + 1,
        tip + 1, tip + 3, tip + 2;

    const ipc::CollisionMesh mesh(at, edges_of(faces), faces);
    pliant::BroadPhase broad_phase; /* for all steps: it keeps its trees */
    for (int step = 1; step <= 5; step++) {
        Eigen::MatrixXd next = at;
        next.bottomRows(4).col(2).array() -= 0.2;
        ipc::Candidates candidates;
        candidates.build(mesh, at, next, 0.0, &broad_phase);
        const double free = candidates.compute_collision_free_stepsize(mesh, at, next);
        at += free * (next - at);
        std::printf("step %d: %zu candidates, %.4f of the way; the tip is at %.4f\n", step,
                    candidates.size(), free, at(tip, 2));
    }
    return 0;
}
