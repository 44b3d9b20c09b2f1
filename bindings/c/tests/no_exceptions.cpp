/* Classes without exceptions: compiled with -fno-exceptions. C++17. */
#define PLIANT_NO_EXCEPTIONS
#include "pliant.hpp"

int main() {
    const std::vector<std::array<int, 3>> triangle{{0, 1, 2}};
    const std::vector<std::array<double, 3>> at{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    pliant::World world;
    world.add(triangle, at);
    const auto body = world.add(triangle, at);
    std::size_t seen = 0;
    pliant::Query query;
    query.visit = [&](const pliant_hits &some) { return seen += some.count, false; };
    query.interrupt = [] { return false; };
    world.intersections(query);
    if (seen != 1) {
        return 1;
    }
    /* For statuses there is pliant.h; a refused call of a class ends the program, loudly. */
    if (pliant_world_remove(world.get(), 77, nullptr) != PLIANT_NO_SUCH_BODY) {
        return 2;
    }
    world.remove(body);
    return world.intersections().count == 0 ? 0 : 3;
}
