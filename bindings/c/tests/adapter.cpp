/* The broad phase for ipc-toolkit lists what its definition says, for random meshes. C++17.

   With WITH_TOOLKIT it is compiled against the toolkit, and compared with its BruteForce, too. Else
   the folder stand_in has what is needed of it. Eigen must be installed. */
#include "check.h"
#include "pliant_ipc.hpp"

#ifdef WITH_TOOLKIT
#include <ipc/broad_phase/brute_force.hpp>
#include <ipc/broad_phase/lbvh.hpp>
#include <ipc/candidates/candidates.hpp>
#endif

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

using Pair = std::pair<int, int>;
using Pairs = std::vector<Pair>;
using Filter = std::function<bool(std::size_t, std::size_t)>;
using Random = std::mt19937;

static int below(Random &random, int count) { return int(random() % unsigned(count)); }

enum Kind { VERTEX_VERTEX, EDGE_VERTEX, EDGE_EDGE, FACE_VERTEX, EDGE_FACE, FACE_FACE, KINDS };
using Lists = std::array<Pairs, KINDS>;

/* A mesh, where it is, and where it goes. */
struct Scene {
    Eigen::MatrixXd start, end; /* end has no rows if nothing moves */
    Eigen::MatrixXi edges, faces;
    double radius = 0;
};

/* Coordinates are from 1 to 2, and multiples of 2^-52. So differences are exact. */
static double coordinate(Random &random, int steps) {
    if (steps == 0) { /* near a lattice: by one unit of the last place, or not */
        const double on = 1 + (1 + below(random, 6)) / 8.0;
        return on + (below(random, 3) - 1) * std::ldexp(1.0, -52);
    }
    return 1 + below(random, steps) / double(steps);
}

static Eigen::MatrixXd positions(Random &random, int vertices, int columns, int steps) {
    Eigen::MatrixXd at(vertices, columns);
    for (int column = 0; column < columns; column++) {
        for (int vertex = 0; vertex < vertices; vertex++) {
            at(vertex, column) = coordinate(random, steps);
        }
    }
    return at;
}

/* Small faces and edges, if `at` is where they are: their vertices are near each other. */
static int near(Random &random, const Eigen::MatrixXd &at, int vertex) {
    int best = vertex;
    double least = 99;
    for (int tries = 0; tries < 6; tries++) {
        const int other = below(random, int(at.rows()));
        const double far = (at.row(other) - at.row(vertex)).norm();
        if (other != vertex && far < least) {
            best = other;
            least = far;
        }
    }
    return best;
}

static Scene scene(Random &random) {
    Scene made;
    const int vertices = 2 + below(random, 40), columns = 2 + below(random, 2);
    const int steps = std::array<int, 4>{0, 8, 64, 64}[std::size_t(below(random, 4))];
    made.start = positions(random, vertices, columns, steps);
    made.radius = below(random, 4) / (steps == 64 ? 64.0 : 16.0);
    if (below(random, 2) == 0) {
        const Eigen::MatrixXd other = positions(random, vertices, columns, steps);
        made.end = made.start;
        for (int vertex = 0; vertex < vertices; vertex++) {
            if (below(random, 3) == 0) {
                made.end.row(vertex) = other.row(vertex);
            }
        }
    }

    std::vector<std::array<int, 3>> faces;
    std::set<Pair> sides;
    const bool has_faces = columns == 3 || below(random, 4) == 0;
    for (int left = has_faces ? below(random, 40) : 0; left > 0; left--) {
        const int a = below(random, vertices), b = near(random, made.start, a);
        const int c = near(random, made.start, a);
        if (a != b && b != c && c != a) {
            faces.push_back({a, b, c});
            sides.insert({std::minmax(a, b), std::minmax(b, c), std::minmax(c, a)});
        }
    }
    const int most = below(random, 3); /* no edges of faces, all, or some */
    std::set<Pair> listed;
    for (const Pair &side : sides) {
        if (most == 1 || (most == 2 && below(random, 2) == 0)) {
            listed.insert(side);
        }
    }
    for (int left = below(random, 12); left > 0; left--) {
        const int a = below(random, vertices), b = near(random, made.start, a);
        if (a != b) {
            listed.insert(std::minmax(a, b));
        }
    }
    std::vector<Pair> edges(listed.begin(), listed.end());
    std::shuffle(edges.begin(), edges.end(), random);
    made.faces.resize(int(faces.size()), faces.empty() ? 0 : 3);
    for (int face = 0; face < int(faces.size()); face++) {
        for (int corner = 0; corner < 3; corner++) {
            made.faces(face, corner) = faces[std::size_t(face)][std::size_t(corner)];
        }
    }
    made.edges.resize(int(edges.size()), edges.empty() ? 0 : 2);
    for (int edge = 0; edge < int(edges.size()); edge++) {
        const auto [a, b] = edges[std::size_t(edge)];
        const bool turned = below(random, 2) == 0;
        made.edges.row(edge) << (turned ? b : a), (turned ? a : b);
    }
    return made;
}

/* ---- The definition ------------------------------------------------------------------------ */

struct Element {
    std::vector<int> corners;
    std::array<double, 3> lower, upper; /* of its way, not grown */
};

static std::vector<Element> elements(const Scene &scene, const Eigen::MatrixXi *rows) {
    std::vector<Element> all;
    for (int row = 0; row < (rows ? rows->rows() : scene.start.rows()); row++) {
        Element element{{}, {9, 9, 9}, {-9, -9, -9}};
        for (int column = 0; column < (rows ? rows->cols() : 1); column++) {
            element.corners.push_back(rows ? (*rows)(row, column) : row);
        }
        for (const int vertex : element.corners) {
            for (const Eigen::MatrixXd *at : {&scene.start, &scene.end}) {
                for (int axis = 0; axis < 3 && at->rows() > 0; axis++) {
                    const double x = axis < at->cols() ? (*at)(vertex, axis) : 0.0;
                    const auto which = std::size_t(axis);
                    element.lower[which] = std::min(element.lower[which], x);
                    element.upper[which] = std::max(element.upper[which], x);
                }
            }
        }
        all.push_back(element);
    }
    return all;
}

/* The gap of two boxes, exact for these coordinates; negative if they overlap. */
static double gap(const Element &a, const Element &b) {
    double widest = -9;
    for (std::size_t axis = 0; axis < 3; axis++) {
        widest = std::max({widest, a.lower[axis] - b.upper[axis], b.lower[axis] - a.upper[axis]});
    }
    return widest;
}

/* Elements of both sides of a kind, and whether they are of one list. */
static std::pair<std::array<std::vector<Element>, 2>, bool> sides(const Scene &scene, int kind) {
    const auto vertices = [&] { return elements(scene, nullptr); };
    const auto edges = [&] { return elements(scene, &scene.edges); };
    const auto faces = [&] { return elements(scene, &scene.faces); };
    switch (kind) {
    case VERTEX_VERTEX:
        return {{vertices(), vertices()}, true};
    case EDGE_VERTEX:
        return {{edges(), vertices()}, false};
    case EDGE_EDGE:
        return {{edges(), edges()}, true};
    case FACE_VERTEX:
        return {{faces(), vertices()}, false};
    case EDGE_FACE:
        return {{edges(), faces()}, false};
    default:
        return {{faces(), faces()}, true};
    }
}

static Pairs defined(const Scene &scene, int kind, const Filter &filter) {
    const auto [of, is_one] = sides(scene, kind);
    Pairs pairs;
    for (int a = 0; a < int(of[0].size()); a++) {
        for (int b = is_one ? a + 1 : 0; b < int(of[1].size()); b++) {
            const Element &one = of[0][std::size_t(a)], &other = of[1][std::size_t(b)];
            bool share = false, may_meet = false;
            for (const int u : one.corners) {
                for (const int v : other.corners) {
                    /* The toolkit asks from a lone vertex to the element before it. */
                    const bool turned = kind == EDGE_VERTEX || kind == FACE_VERTEX;
                    share |= u == v;
                    may_meet |= filter(std::size_t(turned ? v : u), std::size_t(turned ? u : v));
                }
            }
            if (!share && may_meet && gap(one, other) <= 2 * scene.radius) {
                pairs.push_back({a, b});
            }
        }
    }
    return pairs;
}

/* ---- Lists of a broad phase ---------------------------------------------------------------- */

static void build(ipc::BroadPhase &of, const Scene &scene) {
    if (scene.end.rows() > 0) {
        of.build(scene.start, scene.end, scene.edges, scene.faces, scene.radius);
    } else {
        of.build(scene.start, scene.edges, scene.faces, scene.radius);
    }
}

/* The same from boxes of vertices. They are exact, since coordinates and radii are multiples of
   2^-52, and below 4. */
static void build_of_boxes(ipc::BroadPhase &of, const Scene &scene) {
    ipc::AABBs boxes;
    for (const Element &vertex : elements(scene, nullptr)) {
        ipc::AABB box;
        for (int axis = 0; axis < 3; axis++) {
            box.min[axis] = vertex.lower[std::size_t(axis)] - scene.radius;
            box.max[axis] = vertex.upper[std::size_t(axis)] + scene.radius;
        }
        box.vertex_ids = {{ipc::index_t(boxes.size()), -1, -1}};
        boxes.push_back(box);
    }
    of.build(boxes, scene.edges, scene.faces, std::uint8_t(scene.start.cols()));
}

template <class C, class Names> Pairs pairs_of(const std::vector<C> &candidates, Names names) {
    Pairs pairs;
    for (const C &candidate : candidates) {
        pairs.push_back(names(candidate));
    }
    return pairs;
}

/* All lists, which had so many pairs in them before. */
static Lists lists(const ipc::BroadPhase &of, std::size_t before = 3) {
    Lists all;
    std::vector<ipc::VertexVertexCandidate> vv(before, {0, 0});
    of.detect_vertex_vertex_candidates(vv);
    all[VERTEX_VERTEX] = pairs_of(vv, [](auto &it) { return Pair(it.vertex0_id, it.vertex1_id); });
    std::vector<ipc::EdgeVertexCandidate> ev(before, {0, 0});
    of.detect_edge_vertex_candidates(ev);
    all[EDGE_VERTEX] = pairs_of(ev, [](auto &it) { return Pair(it.edge_id, it.vertex_id); });
    std::vector<ipc::EdgeEdgeCandidate> ee(before, {0, 0});
    of.detect_edge_edge_candidates(ee);
    all[EDGE_EDGE] = pairs_of(ee, [](auto &it) { return Pair(it.edge0_id, it.edge1_id); });
    std::vector<ipc::FaceVertexCandidate> fv(before, {0, 0});
    of.detect_face_vertex_candidates(fv);
    all[FACE_VERTEX] = pairs_of(fv, [](auto &it) { return Pair(it.face_id, it.vertex_id); });
    std::vector<ipc::EdgeFaceCandidate> ef(before, {0, 0});
    of.detect_edge_face_candidates(ef);
    all[EDGE_FACE] = pairs_of(ef, [](auto &it) { return Pair(it.edge_id, it.face_id); });
    std::vector<ipc::FaceFaceCandidate> ff(before, {0, 0});
    of.detect_face_face_candidates(ff);
    all[FACE_FACE] = pairs_of(ff, [](auto &it) { return Pair(it.face0_id, it.face1_id); });
    return all;
}

static Lists sorted(Lists lists) {
    for (Pairs &pairs : lists) {
        std::sort(pairs.begin(), pairs.end());
    }
    return lists;
}

static Filter some_filter(Random &random) {
    const auto limit = std::size_t(below(random, 20));
    switch (below(random, 8)) {
    case 0:
        return [](std::size_t a, std::size_t b) { return a % 3 != b % 3; };
    case 1:
        return [=](std::size_t a, std::size_t b) { return a < limit || b < limit; };
    case 2:
        return [=](std::size_t a, std::size_t b) { return (a < limit) != (b < limit); };
    case 3:
        return [](std::size_t, std::size_t) { return false; };
    case 4: /* not symmetric: the order of both is the toolkit's, too */
        return [](std::size_t a, std::size_t b) { return a < b; };
    default:
        return [](std::size_t, std::size_t) { return true; };
    }
}

struct Counts {
    std::array<std::size_t, KINDS> pairs{};
    std::size_t alone = 0;
};

#ifdef WITH_TOOLKIT
/* Theirs has ours, and beyond them only what the rounding of boxes brings in. */
template <class Theirs>
static std::size_t compare(const Scene &scene, const Lists &ours, const Filter &filter,
                           double rounding) {
    Theirs theirs;
    theirs.can_vertices_collide = filter;
    build(theirs, scene);
    Lists others = lists(theirs, 0); /* not all of its methods clear a list */
    for (const int of_one : {VERTEX_VERTEX, EDGE_EDGE, FACE_FACE}) { /* LBVH turns some */
        for (Pair &pair : others[std::size_t(of_one)]) {
            pair = {std::min(pair.first, pair.second), std::max(pair.first, pair.second)};
        }
    }
    others = sorted(others);
    std::size_t alone = 0;
    for (int kind = 0; kind < KINDS; kind++) {
        const Pairs &mine = ours[std::size_t(kind)], &other = others[std::size_t(kind)];
        CHECK(std::includes(other.begin(), other.end(), mine.begin(), mine.end()));
        Pairs more;
        std::set_difference(other.begin(), other.end(), mine.begin(), mine.end(),
                            std::back_inserter(more));
        const auto of = sides(scene, kind).first;
        for (const auto &[a, b] : more) {
            const double wide = gap(of[0][std::size_t(a)], of[1][std::size_t(b)]);
            CHECK(wide > 2 * scene.radius && wide <= 2 * scene.radius + rounding);
        }
        alone += more.size();
    }
    return alone;
}
#endif

/* Asks a broad phase of a scene, in both ways to build it, and compares. */
static void check(pliant::BroadPhase &of, const Scene &scene, Random &random, Counts &counts) {
    const Filter filter = some_filter(random);
    of.can_vertices_collide = filter;
    Lists expected;
    for (int kind = 0; kind < KINDS; kind++) {
        expected[std::size_t(kind)] = defined(scene, kind, filter);
        counts.pairs[std::size_t(kind)] += expected[std::size_t(kind)].size();
    }
    const bool boxes_first = below(random, 2) == 0;
    for (const bool by_boxes : {boxes_first, !boxes_first}) {
        by_boxes ? build_of_boxes(of, scene) : build(of, scene);
        CHECK(sorted(lists(of)) == expected);
    }
#ifdef WITH_TOOLKIT
    /* Each side of a box is rounded once, and moved by one unit more. */
    counts.alone += compare<ipc::BruteForce>(scene, expected, filter, std::ldexp(1.0, -50));
    if (filter(0, 1) == filter(1, 0)) { /* symmetric */
        compare<ipc::LBVH>(scene, expected, filter, std::ldexp(1.0, -19));
    }
#endif
}

static void random_meshes(int count) {
    Random random(54);
    pliant_options options = pliant::default_options();
    options.scalar = PLIANT_F32; /* is not taken */
    options.leaf_size = 1;
    options.degree = 2;
    pliant::BroadPhase kept, other(options);
    Counts counts;
    Scene last;
    for (int number = 0; number < count; number++) {
        Scene next = scene(random);
        if (number % 3 == 1) { /* the same mesh somewhere else */
            const auto columns = int(last.start.cols());
            last.start = positions(random, int(last.start.rows()), columns, 64);
            last.radius = below(random, 9) / 64.0;
            last.end.resize(0, 0);
            if (below(random, 2) == 0) {
                last.end = positions(random, int(last.start.rows()), columns, 64);
            }
        } else if (number % 3 == 2 && below(random, 2) == 0) { /* the same vertices */
            last.faces.resize(0, 0);
        } else {
            last = next;
        }
        check(number % 2 == 0 ? kept : other, last, random, counts);
        if (below(random, 4) == 0) {
            kept.clear();
            CHECK(lists(kept) == Lists());
        }
    }
    std::printf("pairs");
    for (const std::size_t of_kind : counts.pairs) {
        std::printf(" %zu", of_kind);
        CHECK(of_kind > 5 * std::size_t(count)); /* lists that say something */
    }
#ifdef WITH_TOOLKIT
    CHECK(counts.alone > 0);
    std::printf("; BruteForce alone %zu", counts.alone);
#endif
    std::printf("\n");
}

/* A sheet of quads, two triangles each, whose height waves. */
static Scene sheet(int size, double phase) {
    Scene made;
    made.start.resize(size * size, 3);
    made.faces.resize(2 * (size - 1) * (size - 1), 3);
    for (int x = 0, face = 0; x < size; x++) {
        for (int y = 0; y < size; y++) {
            const int at = x * size + y;
            made.start.row(at) << x / double(size), y / double(size),
                std::sin(9.0 * x / size + phase) * std::cos(7.0 * y / size);
            if (x + 1 < size && y + 1 < size) {
                made.faces.row(face++) << at, at + size, at + size + 1;
                made.faces.row(face++) << at, at + size + 1, at + 1;
            }
        }
    }
    return made;
}

/* Equal lists, in equal order, however many threads work. */
static void threads() {
    pliant_options options = pliant::default_options();
    pliant::BroadPhase one(options);
    options.threads = 4;
    pliant::BroadPhase four(options);
    std::atomic<std::size_t> tasks{0};
    pliant::BroadPhase scheduled(options, [&](std::size_t count, const auto &task) {
        for (; count > 0; count--) {
            task(count - 1);
            tasks++;
        }
    });
    Scene scene = sheet(40, 0.0);
    scene.radius = 0.05;
    for (int step = 0; step < 3; step++) {
        scene.end = sheet(40, step + 1).start;
        build(one, scene);
        build(four, scene);
        build(scheduled, scene);
        const Lists expected = lists(one);
        CHECK(expected[FACE_VERTEX].size() > 1000 && lists(four) == expected);
        CHECK(lists(scheduled) == expected && tasks > 0);
        scene.start = scene.end;
    }

    /* Two threads may ask at a time. */
    Lists here, there;
    const Lists expected = lists(four);
    std::thread beside([&] { there = lists(four); });
    here = lists(four);
    beside.join();
    CHECK(here == expected && there == expected);
}

/* What ipc::Candidates builds at every step: the mesh, its loose vertices, these and its loose
   edges. The filter changes on the way. */
static void steps_of_a_simulator() {
    Random random(7);
    Counts counts;
    pliant::BroadPhase kept;
    Scene whole = scene(random);
    for (int step = 0; step < 20; step++) {
        whole.start = positions(random, 24, 3, 64);
        whole.end = positions(random, 24, 3, 64);
        whole.faces.resize(3, 3);
        whole.faces << 0, 1, 2, 2, 1, 3, 4, 5, 6;
        whole.edges.resize(8, 2);
        whole.edges << 1, 0, 1, 2, 0, 2, 3, 1, 2, 3, 7, 8, 8, 9, 2, 9;
        whole.radius = step % 3 / 64.0;
        check(kept, whole, random, counts);
        Scene loose{whole.start.bottomRows(14), whole.end.bottomRows(14), {}, {}, whole.radius};
        check(kept, loose, random, counts);
        Scene both = loose;
        both.edges.resize(2, 2);
        both.edges << 3, 4, 4, 5;
        check(kept, both, random, counts);
    }
}

#ifdef WITH_TOOLKIT
static Lists lists(const ipc::Candidates &of) {
    Lists all;
    all[VERTEX_VERTEX] = pairs_of(of.vv_candidates, [](auto &it) {
        return Pair(std::min(it.vertex0_id, it.vertex1_id), std::max(it.vertex0_id, it.vertex1_id));
    });
    all[EDGE_VERTEX] =
        pairs_of(of.ev_candidates, [](auto &it) { return Pair(it.edge_id, it.vertex_id); });
    all[EDGE_EDGE] = pairs_of(of.ee_candidates, [](auto &it) {
        return Pair(std::min(it.edge0_id, it.edge1_id), std::max(it.edge0_id, it.edge1_id));
    });
    all[FACE_VERTEX] =
        pairs_of(of.fv_candidates, [](auto &it) { return Pair(it.face_id, it.vertex_id); });
    return sorted(all);
}

/* Candidates of the toolkit for meshes with loose edges and vertices: equal by all methods. */
static void candidates_of_the_toolkit() {
    Random random(11);
    pliant::BroadPhase kept;
    ipc::BruteForce brute_force;
    ipc::LBVH lbvh;
    std::array<std::size_t, KINDS> counts{};
    for (int number = 0; number < 300; number++) {
        Scene of = scene(random);
        while (of.start.cols() == 2 && of.faces.rows() > 0) {
            of = scene(random);
        }
        of.start = positions(random, int(of.start.rows()), int(of.start.cols()), 64);
        of.radius = below(random, 4) / 64.0;
        std::set<Pair> listed;
        for (int edge = 0; edge < of.edges.rows(); edge++) {
            listed.insert(std::minmax(of.edges(edge, 0), of.edges(edge, 1)));
        }
        for (int face = 0; face < of.faces.rows(); face++) { /* it wants sides as edges */
            const auto corners = of.faces.row(face);
            for (int corner = 0; corner < 3; corner++) {
                listed.insert(std::minmax(corners(corner), corners((corner + 1) % 3)));
            }
        }
        std::vector<Pair> edges(listed.begin(), listed.end());
        std::shuffle(edges.begin(), edges.end(), random);
        Eigen::MatrixXi rows(int(edges.size()), 2);
        for (int edge = 0; edge < int(edges.size()); edge++) {
            rows.row(edge) << edges[std::size_t(edge)].first, edges[std::size_t(edge)].second;
        }
        ipc::CollisionMesh mesh(of.start, rows, of.faces);
        mesh.can_collide = some_filter(random);
        for (int step = 0; step < 3; step++) {
            const Eigen::MatrixXd next =
                positions(random, int(of.start.rows()), int(of.start.cols()), 64);
            std::vector<Lists> all;
            for (ipc::BroadPhase *by : {(ipc::BroadPhase *)&kept, (ipc::BroadPhase *)&brute_force,
                                        (ipc::BroadPhase *)&lbvh}) {
                ipc::Candidates candidates;
                if (step == 0) {
                    candidates.build(mesh, of.start, of.radius, by);
                } else {
                    candidates.build(mesh, of.start, next, of.radius, by);
                }
                all.push_back(lists(candidates));
            }
            const bool is_symmetric = mesh.can_collide(0, 1) == mesh.can_collide(1, 0);
            CHECK(all[0] == all[1] && (all[0] == all[2] || !is_symmetric));
            for (std::size_t kind = 0; kind < KINDS; kind++) {
                counts[kind] += all[0][kind].size();
            }
            of.start = next;
        }
    }
    std::printf("candidates of the toolkit: vv %zu, ev %zu, ee %zu, fv %zu\n",
                counts[VERTEX_VERTEX], counts[EDGE_VERTEX], counts[EDGE_EDGE],
                counts[FACE_VERTEX]);
    CHECK(counts[VERTEX_VERTEX] > 1000 && counts[EDGE_VERTEX] > 1000);
}
#endif

template <class Function> static std::string refused(Function function) {
    try {
        function();
    } catch (const std::invalid_argument &error) {
        return error.what();
    } catch (const pliant::Error &error) {
        return "pliant " + std::to_string(error.facts.status);
    }
    return "";
}

/* A build that is refused leaves nothing built; the next is as if it had not been. */
static void bad_input() {
    Scene good = sheet(4, 0.0);
    good.edges.resize(2, 2);
    good.edges << 0, 1, 5, 6;
    good.radius = 0.25;
    pliant::BroadPhase of;
    CHECK(of.name() == "pliant" && lists(of) == Lists());
    build(of, good);
    const Lists expected = sorted(lists(of));
    const auto says = [&](const Scene &scene, const std::string &words) {
        const std::string said = refused([&] {
            build(of, scene);
            lists(of);
        });
        const bool is_so = said.find(words) != std::string::npos;
        if (!is_so) {
            std::fprintf(stderr, "said: %s; not: %s\n", said.c_str(), words.c_str());
        }
        CHECK(is_so && (said.find("pliant ") == 0 || lists(of) == Lists()));
        build(of, good);
        CHECK(sorted(lists(of)) == expected);
    };
    Scene bad = good;
    bad.edges(1, 0) = 16;
    says(bad, "edge 1 names vertex 16, and there are 16 vertices");
    bad.edges(1, 0) = -1;
    says(bad, "edge 1 names vertex -1");
    bad.edges.row(1) << 1, 0;
    says(bad, "an edge of vertices 0 and 1 is listed twice");
    bad.edges.row(1) << 3, 3;
    says(bad, "an edge of vertices 3 and 3 has both ends in one");
    bad.edges.resize(2, 3);
    says(bad, "edges have not 2 columns");
    bad = good;
    bad.faces(17, 2) = 99;
    says(bad, "face 17 names vertex 99, and there are 16 vertices");
    bad.faces.resize(1, 4);
    says(bad, "faces have not 3 columns");
    bad = good;
    bad.end = good.start.topRows(3);
    says(bad, "vertices at both times are not of one shape");
    bad.end = good.start.leftCols(2);
    says(bad, "vertices at both times are not of one shape");
    bad.start.resize(16, 4);
    bad.end.resize(0, 0);
    says(bad, "vertices have neither 2 nor 3 columns");
    bad = good;
    bad.start(3, 1) = std::nan("");
    says(bad, "pliant " + std::to_string(PLIANT_BAD_POSITION));
    bad = good;
    bad.end = good.start;
    bad.end(0, 0) = HUGE_VAL;
    says(bad, "pliant " + std::to_string(PLIANT_BAD_POSITION));
    bad = good;
    bad.radius = -1;
    says(bad, "pliant " + std::to_string(PLIANT_BAD_MARGIN));
    bad.radius = std::nan("");
    says(bad, "pliant " + std::to_string(PLIANT_BAD_MARGIN));
    pliant_options options = pliant::default_options();
    options.degree = 3;
    pliant::BroadPhase other(options);
    build(other, good);
    CHECK(refused([&] { lists(other); }) == "pliant " + std::to_string(PLIANT_BAD_OPTION));

    /* Nothing, and hardly anything. */
    Scene few;
    build(of, few);
    CHECK(lists(of) == Lists());
    few.start = good.start.topRows(1);
    build(of, few);
    CHECK(lists(of) == Lists());
    few.start = good.start.topRows(2);
    few.radius = 9;
    build(of, few);
    CHECK(lists(of)[VERTEX_VERTEX] == Pairs({{0, 1}}));
}

int main() {
    random_meshes(std::getenv("MESHES") ? std::atoi(std::getenv("MESHES")) : 600);
    threads();
    steps_of_a_simulator();
    bad_input();
#ifdef WITH_TOOLKIT
    candidates_of_the_toolkit();
#endif
    return 0;
}
