/* Worlds and threads of C++: a scheduler of the application, worlds side by side, and one world for
   two threads. With TBB (WITH_TBB) and OpenMP (-fopenmp), theirs is the scheduler. C++17. */
#include "check.h"
#include "pliant.hpp"

#ifdef WITH_TBB
#include <tbb/parallel_for.h>
#endif

#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

using Task = std::function<void(std::size_t)>;

/* Runs tasks on threads of its own. */
static void by_threads(std::size_t tasks, const Task &task) {
    std::vector<std::thread> threads;
    for (std::size_t number = 0; number < tasks; number++) {
        threads.emplace_back(task, number);
    }
    for (std::thread &thread : threads) {
        thread.join();
    }
}

static void by_the_application(std::size_t tasks, const Task &task) {
#if defined WITH_TBB
    tbb::parallel_for(std::size_t(0), tasks, task);
#elif defined _OPENMP
#pragma omp parallel for
    for (std::size_t number = 0; number < tasks; number++) {
        task(number);
    }
#else
    by_threads(tasks, task);
#endif
}

using Rows = std::vector<std::array<double, 3>>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/* A sheet with waves, whose neighbours are near each other. */
static constexpr std::uint32_t side = 70;

static Triangles triangles() {
    Triangles all;
    for (std::uint32_t row = 0; row < side; row++) {
        for (std::uint32_t column = 0; column < side; column++) {
            const std::uint32_t a = row * (side + 1) + column, b = a + side + 1;
            all.push_back({a, a + 1, b});
            all.push_back({a + 1, b + 1, b});
        }
    }
    return all;
}

static Rows sheet(double time) {
    Rows all;
    for (std::uint32_t vertex = 0; vertex < (side + 1) * (side + 1); vertex++) {
        const double x = vertex % (side + 1), y = vertex / (side + 1);
        all.push_back({x, y, 3 * std::sin(x + time) + 2 * std::cos(2 * y)});
    }
    return all;
}

static std::vector<std::uint32_t> pairs_of(const pliant_hits &hits) {
    return {hits.pairs, hits.pairs + 4 * hits.count};
}

/* Answers of all steps, all one for any threads. */
static std::vector<std::vector<std::uint32_t>> answers(pliant::World &world) {
    std::vector<std::vector<std::uint32_t>> all;
    const auto body = world.add(triangles(), sheet(0));
    for (int step = 0; step < 3; step++) {
        world.set_motion(body, sheet(0.3 * step));
        all.push_back(pairs_of(world.edge_edge_candidates(pliant::within(body), 0.25)));
        pliant::Query query(pliant::within(body), PLIANT_UNSORTED);
        all.push_back(pairs_of(world.vertex_triangle_impacts(query)));
        world.finish_motion();
        all.push_back(pairs_of(world.intersections()));
    }
    return all;
}

int main() {
    pliant::World alone;
    const auto expected = answers(alone);
    CHECK(expected[0].size() > 4000);

    pliant_options options = pliant::default_options();
    options.threads = 4;
    std::atomic<std::size_t> given{0};
    const auto counted = [&](std::size_t tasks, const Task &task) {
        given += tasks;
        by_the_application(tasks, task);
    };
    {
        pliant::World scheduled(options, counted);
        CHECK(answers(scheduled) == expected);
        CHECK(given > 0);
        /* A copy has the scheduler, too, and an exception of it loses nothing. */
        pliant::World copy = scheduled.clone();
        scheduled = pliant::World();
        given = 0;
        CHECK(pairs_of(copy.intersections()) == expected.back());
        CHECK(copy.edge_edge_candidates(pliant::everything, 0.25).count > 0 && given > 0);
    }
    pliant::World throws(options, [](std::size_t, const Task &) { throw 1; });
    CHECK(answers(throws) == expected);

    /* The interrupt is asked from any thread; what it throws goes on. */
    pliant::World asked(options, counted);
    const auto body = asked.add(triangles(), sheet(0));
    pliant::Query query;
    std::atomic<int> asks{0};
    query.interrupt = [&] { return asks++ > 3 ? throw 5 : false; };
    int thrown = 0;
    try {
        for (int step = 0; step < 99; step++) {
            asked.set_positions(body, sheet(0.1 * step));
            asked.close_edge_edge_pairs(query, 0.25);
        }
    } catch (int number) {
        thrown = number;
    }
    CHECK(thrown == 5 && asks > 3);

    /* Worlds side by side, and one that two threads call. */
    std::vector<std::thread> threads;
    std::array<bool, 3> equal{};
    for (bool &is : equal) {
        threads.emplace_back([&] {
            pliant::World own;
            is = answers(own) == expected;
        });
    }
    for (std::thread &thread : threads) {
        thread.join();
    }
    CHECK(equal[0] && equal[1] && equal[2]);
    std::atomic<int> done{0}, busy{0};
    by_threads(2, [&](std::size_t) {
        for (int call = 0; call < 40; call++) {
            try {
                alone.intersections(pliant::Query(pliant::everything, PLIANT_FIRST));
                done++;
            } catch (const pliant::Error &error) {
                CHECK(error.facts.status == PLIANT_BUSY);
                busy++;
            }
        }
    });
    CHECK(done > 0 && done + busy == 80);
    return 0;
}
