/* Cloth on a swinging ball, with Eigen: as the Rust example of this name, to the bit.

   The cloth moves by position-based dynamics (Müller et al. 2007). Points keep their velocity and
   fall; then edges get their lengths back. The library says which triangles intersect, and corners
   of the cloth are pushed out of the ball, with friction.

     c++ -std=c++17 -O2 -ffp-contract=off -I/usr/include/eigen3 cloth_on_ball.cpp \
         $(pkg-config --cflags --libs pliant) -o cloth_on_ball
     ./cloth_on_ball 10    # ten seconds of it */
#include <pliant.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <set>
#include <utility>
#include <vector>

using Points = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;
using Vector = Eigen::RowVector3f;

constexpr int steps_a_second = 240;
constexpr float step_length = 1.0f / steps_a_second, radius = 0.5f, side = 1.6f;
constexpr float friction = 0.9f;      /* share of its sliding that a point loses in a step */
constexpr float thickness = 0.0005f;  /* above the ball, at which a contact puts points */

/* Sums in one order on every machine. */
static float dot(const Vector &a, const Vector &b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
static float length(const Vector &a) { return std::sqrt(dot(a, a)); }
static Vector unit_or(const Vector &a, const Vector &other) {
    const float inverse = 1.0f / length(a);
    return std::isfinite(inverse) && inverse > 0 ? Vector(a * inverse) : other;
}
static Vector cross(const Vector &a, const Vector &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Surface {
    Points points, before; /* of the cloth one step ago, of the ball at the start */
    Triangles triangles;

    /* Over the unit square, cut into squares of two triangles; closed by folding its sides. */
    template <class At> Surface(int squares, bool is_closed, At at) {
        const int across = squares + 1;
        points.resize(across * across, 3);
        for (int i = 0; i < across * across; i++) {
            const float size = float(squares);
            points.row(i) = at(float(i % across) / size, float(i / across) / size);
        }
        before = points;
        triangles.resize(2 * squares * squares, 3);
        for (int square = 0; square < squares * squares; square++) {
            const int low = square / squares * across + square % squares, high = low + across;
            triangles.row(2 * square) << low, low + 1, high + 1;
            triangles.row(2 * square + 1) << low, high + 1, high;
        }
        const auto is_end = [=](int place) { return place == 0 || place == squares; };
        for (int &corner : triangles.reshaped()) {
            int row = corner / across, column = corner % across;
            if (is_closed && is_end(row)) {
                column = std::min(column, squares - column);
            }
            if (is_closed && is_end(column)) {
                row = std::min(row, squares - row);
            }
            corner = row * across + column;
        }
    }
};

static Vector centre(float time) {
    const Vector way(1.0f - std::cos(3.0f * time), std::sin(2.0f * time), 0.0f);
    return 0.15f * way;
}

int main(int count, char **arguments) {
    const int seconds = count > 1 ? std::atoi(arguments[1]) : 10;
    Surface cloth(24, false, [](float u, float v) {
        return Vector(Vector(u - 0.5f, v - 0.5f, 0.4f) * side);
    });
    Surface ball(40, true, [](float u, float v) {
        /* The upper half of an octahedron, and the lower one folded out of its sides. */
        const float x = 2.0f * u - 1.0f, y = 2.0f * v - 1.0f;
        const float up = 1.0f - std::abs(x) - std::abs(y);
        const float over = std::max(std::abs(x) + std::abs(y) - 1.0f, 0.0f);
        const Vector at(x - std::copysign(over, x), y - std::copysign(over, y), up);
        return Vector(radius * (at * (1.0f / length(at))));
    });
    std::set<std::pair<int, int>> edges;
    for (int triangle = 0; triangle < cloth.triangles.rows(); triangle++) {
        for (int k = 0; k < 3; k++) {
            const int a = cloth.triangles(triangle, k), b = cloth.triangles(triangle, (k + 1) % 3);
            edges.emplace(std::min(a, b), std::max(a, b));
        }
    }
    std::vector<float> rest;
    for (const auto &[a, b] : edges) {
        rest.push_back(length(cloth.points.row(a) - cloth.points.row(b)));
    }

    pliant_options options = pliant::default_options();
    options.scalar = PLIANT_F32;
    pliant::World world(options);
    const auto of_cloth = world.add(cloth.triangles, cloth.points);
    const auto of_ball = world.add(ball.triangles, ball.points);
    for (int step = 1; step <= seconds * steps_a_second; step++) {
        /* The application moves the bodies ... */
        for (int i = 0; i < cloth.points.rows(); i++) {
            const Vector velocity = 0.999f * (cloth.points.row(i) - cloth.before.row(i));
            cloth.before.row(i) = cloth.points.row(i);
            cloth.points.row(i) += velocity - Vector(0, 0, 9.81f * step_length * step_length);
        }
        for (int round = 0; round < 10; round++) {
            auto of = rest.begin();
            for (const auto &[a, b] : edges) {
                const Vector apart = cloth.points.row(b) - cloth.points.row(a);
                const Vector half = 0.5f * (apart - *of++ * unit_or(apart, Vector::Zero()));
                cloth.points.row(a) += half;
                cloth.points.row(b) -= half;
            }
        }
        const float time = float(step) * step_length;
        ball.points = ball.before.rowwise() + centre(time);
        const Vector swing = centre(time) - centre(time - step_length);
        world.set_positions(of_cloth, cloth.points);
        world.set_positions(of_ball, ball.points);

        /* ... the library answers ... */
        const auto hits = world.intersections(pliant::between(of_cloth, of_ball));

        /* ... and the application reacts. */
        for (std::size_t hit = 0; hit < hits.count; hit++) {
            const auto met = ball.triangles.row(hits.pairs[4 * hit + 3]);
            const Vector a = ball.points.row(met[0]), b = ball.points.row(met[1]);
            const Vector c = ball.points.row(met[2]);
            const Vector normal = unit_or(cross(b - a, c - a), Vector(0, 0, 1));
            for (const int corner : cloth.triangles.row(hits.pairs[4 * hit + 1])) {
                const Vector point = cloth.points.row(corner), before = cloth.before.row(corner);
                const float depth = thickness - dot(point - a, normal);
                if (depth > 0) {
                    const Vector way = point - before - swing;
                    const Vector sliding = way - normal * dot(way, normal);
                    cloth.points.row(corner) += depth * normal - friction * sliding;
                    cloth.before.row(corner) =
                        cloth.points.row(corner) - swing - (1.0f - friction) * sliding;
                }
            }
        }
        if (step % (steps_a_second / 4) == 0) {
            float depth = -INFINITY;
            for (int i = 0; i < cloth.points.rows(); i++) {
                depth = std::max(depth, radius - length(cloth.points.row(i) - centre(time)));
            }
            const float height = cloth.points(cloth.points.rows() / 2, 2) - centre(time)[2];
            std::printf("%5.2f s: cloth at %.3f m, %3zu pairs, %6.1f mm inside\n",
                        double(float(step) / steps_a_second), double(height), hits.count,
                        double(1e3f * depth));
        }
    }
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const float x : cloth.points.reshaped<Eigen::RowMajor>()) {
        std::uint32_t bits;
        std::memcpy(&bits, &x, sizeof bits);
        hash = (hash ^ bits) * 0x100000001b3;
    }
    std::printf("hash of the cloth: %016llx\n", static_cast<unsigned long long>(hash));
}
