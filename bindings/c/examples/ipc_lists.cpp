/* ipc_lists: candidates of the broad phase for ipc-toolkit, from files and to files, and times.

     ipc_lists FOLDER RADIUS [ROUNDS]

   FOLDER has arrays of rows, without heads, in the byte order of the machine: V0.f64 and V1.f64, 3
   coordinates a vertex, E.i32, 2 vertices an edge, and F.i32, 3 vertices a face. Without V1.f64
   nothing moves. Written are pairs: ee.i32, two edges, and fv.i32, face and vertex; and ev.i32,
   vv.i32, ef.i32 and ff.i32 if ROUNDS is 0.

   Printed are medians over rounds in milliseconds. Each round builds and asks for ee and fv, from
   V0 to V1 and back. The adapter is timed beside pliant's own lists and, if this is compiled with
   WITH_TOOLKIT and linked to the toolkit, beside its LBVH. One thread works.

   Without the toolkit it is compiled with bindings/c/tests/stand_in as a folder of headers. */
#include "pliant_ipc.hpp"

#ifdef WITH_TOOLKIT
#include <ipc/broad_phase/lbvh.hpp>
#include <tbb/global_control.h>
#endif

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>

template <class T> using Rows = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

template <class T>
static Eigen::Matrix<T, -1, -1> read(const std::string &path, int columns) {
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), {});
    Rows<T> rows(Eigen::Index(bytes.size() / sizeof(T)) / columns, columns);
    std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char *>(rows.data()));
    return rows;
}

template <class C, class First, class Second>
static void write(const std::string &path, const std::vector<C> &candidates, First first,
                  Second second) {
    std::ofstream file(path, std::ios::binary);
    for (const C &candidate : candidates) {
        const std::int32_t pair[] = {std::int32_t(candidate.*first),
                                     std::int32_t(candidate.*second)};
        file.write(reinterpret_cast<const char *>(pair), sizeof pair);
    }
}

/* Calls a step there and back in turn, some rounds, and returns how long one takes. */
using Steps = std::vector<std::function<void(bool is_back)>>;
static std::vector<double> medians(const Steps &steps, int rounds) {
    std::vector<std::vector<double>> times(steps.size());
    for (int round = 0; round < rounds; round++) {
        for (std::size_t step = 0; step < steps.size(); step++) {
            steps[step](true); /* what ran before it took the caches */
            const auto begin = std::chrono::steady_clock::now();
            steps[step](false);
            steps[step](true);
            const std::chrono::duration<double, std::milli> spent =
                std::chrono::steady_clock::now() - begin;
            times[step].push_back(spent.count() / 2);
        }
    }
    std::vector<double> middle;
    for (auto &of_step : times) {
        std::sort(of_step.begin(), of_step.end());
        middle.push_back(of_step[of_step.size() / 2]);
    }
    return middle;
}

int main(int count, char **arguments) {
    if (count < 3) {
        std::fprintf(stderr, "ipc_lists FOLDER RADIUS [ROUNDS]\n");
        return 2;
    }
    const std::string folder = std::string(arguments[1]) + "/";
    const double radius = std::atof(arguments[2]);
    const int rounds = count > 3 ? std::atoi(arguments[3]) : 0;
    const Eigen::MatrixXd V0 = read<double>(folder + "V0.f64", 3);
    const Eigen::MatrixXd V1 = read<double>(folder + "V1.f64", 3);
    const Eigen::MatrixXi E = read<int>(folder + "E.i32", 2), F = read<int>(folder + "F.i32", 3);

    std::vector<ipc::EdgeEdgeCandidate> ee;
    std::vector<ipc::FaceVertexCandidate> fv;
    const auto ask = [&](ipc::BroadPhase &of, bool is_back) {
        if (V1.rows() == 0) {
            of.build(V0, E, F, radius);
        } else {
            of.build(is_back ? V1 : V0, is_back ? V0 : V1, E, F, radius);
        }
        ee = {};
        fv = {};
        of.detect_edge_edge_candidates(ee);
        of.detect_face_vertex_candidates(fv);
    };
    pliant::BroadPhase adapter;
    ask(adapter, false);
    write(folder + "ee.i32", ee, &ipc::EdgeEdgeCandidate::edge0_id,
          &ipc::EdgeEdgeCandidate::edge1_id);
    write(folder + "fv.i32", fv, &ipc::FaceVertexCandidate::face_id,
          &ipc::FaceVertexCandidate::vertex_id);
    if (rounds == 0) {
        std::vector<ipc::VertexVertexCandidate> vv;
        std::vector<ipc::EdgeVertexCandidate> ev;
        std::vector<ipc::EdgeFaceCandidate> ef;
        std::vector<ipc::FaceFaceCandidate> ff;
        adapter.detect_vertex_vertex_candidates(vv);
        adapter.detect_edge_vertex_candidates(ev);
        adapter.detect_edge_face_candidates(ef);
        adapter.detect_face_face_candidates(ff);
        write(folder + "vv.i32", vv, &ipc::VertexVertexCandidate::vertex0_id,
              &ipc::VertexVertexCandidate::vertex1_id);
        write(folder + "ev.i32", ev, &ipc::EdgeVertexCandidate::edge_id,
              &ipc::EdgeVertexCandidate::vertex_id);
        write(folder + "ef.i32", ef, &ipc::EdgeFaceCandidate::edge_id,
              &ipc::EdgeFaceCandidate::face_id);
        write(folder + "ff.i32", ff, &ipc::FaceFaceCandidate::face0_id,
              &ipc::FaceFaceCandidate::face1_id);
        return 0;
    }

    pliant::World world;
    const std::uint32_t body = world.add(F, V0);
    world.edges(body);
    const pliant::Query query(pliant::within(body), PLIANT_UNSORTED);
    const std::size_t found = ee.size() + fv.size();
    Steps steps{[&](bool is_back) { ask(adapter, is_back); },
                [&](bool is_back) {
                    world.set_positions(body, is_back && V1.rows() > 0 ? V1 : V0);
                    if (V1.rows() > 0) {
                        world.set_motion(body, is_back ? V0 : V1);
                    }
                    world.edge_edge_candidates(query, radius);
                    world.vertex_triangle_candidates(query, radius);
                }};
    std::vector<std::string> names{"adapter", "pliant's lists"};
#ifdef WITH_TOOLKIT
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 1);
    ipc::LBVH lbvh;
    steps.push_back([&](bool is_back) { ask(lbvh, is_back); });
    names.push_back("LBVH");
#endif
    const std::vector<double> times = medians(steps, rounds);
    std::printf("ee and fv: %zu candidates\n", found);
    for (std::size_t step = 0; step < steps.size(); step++) {
        std::printf("%-15s %9.2f ms\n", names[step].c_str(), times[step]);
    }
    return 0;
}
