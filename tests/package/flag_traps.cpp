// SPDX-License-Identifier: Zlib
//
// Compiled with one set of options, against libraries compiled with another, this prints the same lines
// (tests/checks/flags.sh): what it does is what breaks where the two do not agree. Its matrices and planes are
// Eigen's own, aligned as its options say; its boxes are NaN, infinite and inverted as well.

#include <broadphase/cells_region.hpp>
#include <broadphase/collectors.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/moving_box.hpp>
#include <broadphase/nearest.hpp>
#include <broadphase/neighbours.hpp>
#include <broadphase/pairs.hpp>
#include <broadphase/position_region.hpp>
#include <broadphase/radius_search.hpp>
#include <broadphase/regions.hpp>
#include <broadphase/sweeps.hpp>
#include <integration/ai/sight.hpp>
#include <integration/camera/camera.hpp>
#include <integration/culling/culler.hpp>
#include <integration/effects/simulation.hpp>
#include <integration/picking/pick.hpp>
#include <integration/terrain/terrain.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <vector>

using namespace hashphase;

namespace {

// By its bits, which -ffast-math leaves alone.
template <class Scalar>
Scalar special(std::uint64_t bitsOfDouble) {
    volatile std::uint64_t bits = bitsOfDouble;
    if constexpr (sizeof(Scalar) == 8) {
        return std::bit_cast<Scalar>(std::uint64_t{bits});
    } else {
        return std::bit_cast<Scalar>(static_cast<std::uint32_t>(bits >> 32 << 3 & 0x7fffffff) |
                                     0x7f800000U);
    }
}
constexpr std::uint64_t kNanBits = 0x7ff8000000000000;
constexpr std::uint64_t kInfinityBits = 0x7ff0000000000000;

// Whole numbers, so that no contraction and no other order of additions rounds differently.
struct Random {
    std::uint32_t state = 12345;
    int below(int count) {
        state = state * 1664525U + 1013904223U;
        return static_cast<int>((state >> 8) % static_cast<std::uint32_t>(count));
    }
};

template <class Scalar>
Vector3<Scalar> pointIn(Random& random, int size) {
    const int x = random.below(size);
    const int y = random.below(size);
    const int z = random.below(size);
    return Vector3<Scalar>(Scalar(x), Scalar(y), Scalar(z));
}

template <class Scalar>
struct World {
    World() : sweeps(grid), pairs(grid, &sweeps) {
        Random random;
        for (int i = 0; i < 500; ++i) {
            const Vector3<Scalar> low = pointIn<Scalar>(random, 64);
            ids.push_back(grid.add({low, low + Vector3<Scalar>::Constant(Scalar(1 + i % 4))},
                                   i % 3 == 0 ? Mobility::resting : Mobility::mobile));
        }
    }
    Grid<Scalar> grid;
    Sweeps<Scalar> sweeps;
    Pairs<Scalar> pairs;
    std::vector<ProxyId> ids;
};

template <class Ids>
unsigned long digest(const Ids& ids) {
    std::vector<std::uint32_t> sorted;
    for (const ProxyId id : ids) {
        sorted.push_back(id.index);
    }
    std::sort(sorted.begin(), sorted.end());
    std::uint64_t hash = 1469598103934665603U;
    for (const std::uint32_t index : sorted) {
        hash = (hash ^ index) * 1099511628211U;
    }
    return static_cast<unsigned long>(hash & 0xffffffff);
}

template <class Scalar, class Region>
void printFound(const char* name, const World<Scalar>& world, const Region& region) {
    std::vector<ProxyId> found;
    CollectAll all(found);
    world.grid.visit(region, all);
    std::printf("%s: %u, %lx\n", name, static_cast<unsigned>(found.size()), digest(found));
}

template <class Scalar>
void printPairs(const char* name, World<Scalar>& world) {
    const PairChanges changes = world.pairs.update();
    std::vector<ProxyId> ids;
    for (const ProxyPair& pair : changes.born) {
        ids.push_back(pair.first);
        ids.push_back(pair.second);
    }
    std::printf("%s: %u born, %u died, %lx, %s\n", name, static_cast<unsigned>(changes.born.size()),
                static_cast<unsigned>(changes.died.size()), digest(ids),
                world.pairs.validate().c_str());
}

// Regions that are empty, and those that nearly are, about a box that waits for the next update.
template <class Scalar>
void askOfNothing(World<Scalar>& world) {
    const Scalar nan = special<Scalar>(kNanBits);
    const Scalar infinity = special<Scalar>(kInfinityBits);
    const Vector3<Scalar> inside(28, 20, 20);
    const Aabb<Scalar> all = boxAround<Scalar>({32, 32, 32}, infinity);
    for (int axis = 0; axis < 3; ++axis) {
        Vector3<Scalar> nowhere = inside;
        nowhere[axis] = nan;
        printFound("ray to nowhere", world, RayRegion<Scalar>(inside, nowhere));
        printFound("ray from nowhere", world, RayRegion<Scalar>(nowhere, inside));
        printFound("ball nowhere", world, SphereRegion<Scalar>(nowhere, Scalar(20)));
        printFound("positions nowhere", world, PositionRegion<Scalar>(nowhere, infinity));
        for (const bool isLow : {false, true}) {
            BoxRegion<Scalar> region{all};
            (isLow ? region.box.min() : region.box.max())[axis] = nan;
            printFound("box without a side", world, region);
        }
    }
    for (const Scalar radius : {nan, Scalar(-1), Scalar(0), infinity}) {
        printFound("ball", world, SphereRegion<Scalar>(inside, radius));
        printFound("positions", world, PositionRegion<Scalar>(inside, radius));
        printFound("cells", world, CellsRegion<Scalar>(inside, radius, 4));
    }
}

// Boxes that are none go and come, before an update and after it, at rest and in motion.
template <class Scalar>
void moveWhatIsNoNumber(World<Scalar>& world) {
    const Scalar nan = special<Scalar>(kNanBits);
    const Scalar infinity = special<Scalar>(kInfinityBits);
    printPairs("first", world);
    for (int frame = 0; frame < 12; ++frame) {
        for (std::size_t i = 0; i < world.ids.size(); i += 7) {
            Aabb<Scalar> box = world.grid.box(world.ids[i]);
            const auto axis = static_cast<int>(i + static_cast<std::size_t>(frame)) % 3;
            switch ((i / 7 + static_cast<std::size_t>(frame)) % 5) {
                case 0:
                    box.min()[axis] = nan;
                    break;
                case 1:
                    box.max()[axis] = nan;
                    break;
                case 2:
                    box.max()[axis] = infinity;
                    break;
                case 3:
                    std::swap(box.min()[axis], box.max()[axis]);
                    break;
                default:
                    box = boxAround<Scalar>({Scalar(i % 64), 20, 20}, Scalar(2));
                    break;
            }
            world.grid.move(world.ids[i], box);
            std::printf("%d", hasNan(world.grid.box(world.ids[i])) ? 1 : 0);
        }
        std::printf("\n");
        printFound("before the update", world, RayRegion<Scalar>({0, 20, 20}, {64, 20, 20}));
        printFound("balls", world, SphereRegion<Scalar>({32, 20, 20}, Scalar(20)));
        printFound("positions", world, PositionRegion<Scalar>({32, 20, 20}, Scalar(20)));
        askOfNothing(world);
        printPairs("frame", world);
    }
    printFound("all", world, BoxRegion<Scalar>{boxAround<Scalar>({32, 32, 32}, infinity)});
}

// Every number of a box and of its way in turn is none, or infinite.
template <class Scalar>
void meetOnTheWay(World<Scalar>& world) {
    const MovingBox<Scalar> usual{boxAround<Scalar>({32, 32, 32}, Scalar(4)), {24, -20, 16}};
    printFound("way", world, MovingBoxRegion<Scalar>(usual));
    for (const std::uint64_t bits : {kNanBits, kInfinityBits}) {
        for (int place = 0; place < 9; ++place) {
            MovingBox<Scalar> moving = usual;
            const auto part = place / 3;
            (part == 0   ? moving.box.min()
             : part == 1 ? moving.box.max()
                         : moving.displacement)[place % 3] = special<Scalar>(bits);
            const MovingBox<Scalar> wall{boxAround<Scalar>({40, 20, 40}, Scalar(4))};
            std::printf("%d %d ", firstContact(moving, wall) ? 1 : 0,
                        firstContact(wall, moving) ? 1 : 0);
            printFound("way", world, MovingBoxRegion<Scalar>(moving));
        }
    }
}

// Proxies on their way, some of them to nowhere.
template <class Scalar>
void sweep(World<Scalar>& world) {
    for (std::size_t i = 0; i < world.ids.size(); i += 5) {
        Vector3<Scalar> displacement(Scalar(i % 32), -8, 8);
        if (i % 4 == 0) {
            displacement[static_cast<int>(i % 3)] =
                special<Scalar>(i % 8 == 0 ? kNanBits : kInfinityBits);
        }
        world.sweeps.set(world.ids[i], displacement);
    }
    printPairs("sweeps", world);
    for (const Scalar x : {Scalar(20), special<Scalar>(kNanBits)}) {
        std::vector<ProxyId> found;
        CollectAll all(found);
        world.sweeps.visit(SphereRegion<Scalar>({x, 20, 20}, Scalar(16)), all);
        std::printf("swept: %u, %lx\n", static_cast<unsigned>(found.size()), digest(found));
    }
}

template <class Scalar>
void ask(World<Scalar>& world) {
    const Scalar nan = special<Scalar>(kNanBits);
    const Scalar infinity = special<Scalar>(kInfinityBits);
    const Vector3<Scalar> middle(32, 32, 32);
    const Vector3<Scalar> nowhere(nan, 32, 32);
    const Vector3<Scalar> farAway(infinity, 32, 32);
    for (const Vector3<Scalar>& at : {middle, nowhere, farAway}) {
        for (const Scalar radius : {Scalar(8.5), Scalar(0), infinity}) {
            printFound("sphere", world, SphereRegion<Scalar>(at, radius));
            printFound("position", world, PositionRegion<Scalar>(at, radius));
            printFound("cells", world, CellsRegion<Scalar>(at, radius, 4));
        }
        printFound("ray", world, RayRegion<Scalar>({0, 30.25F, 31.75F}, at));
        printFound("fat ray", world,
                   RayRegion<Scalar>(at, {64, 64, 64}, boxAround<Scalar>({0, 0, 0}, Scalar(3))));
        printFound("box", world, BoxRegion<Scalar>{{at, Vector3<Scalar>(40, 41, 42)}});
    }
    for (const Scalar radius : {nan, Scalar(-1)}) {
        printFound("sphere", world, SphereRegion<Scalar>(middle, radius));
        printFound("position", world, PositionRegion<Scalar>(middle, radius));
    }
    for (const Scalar distance : {infinity, nan, Scalar(8)}) {
        std::vector<KeyedProxy<Scalar>> nearest;
        findNearest(world.grid, Vector3<Scalar>(31.5F, 30.25F, 29), 5, distance, nearest);
        for (const KeyedProxy<Scalar>& each : nearest) {
            std::printf("nearest: %u, %.3f\n", each.id.index, static_cast<double>(each.key));
        }
    }
    Neighbours<Scalar> neighbours;
    std::printf("neighbours: %u\n", static_cast<unsigned>(neighbours.find(world.grid, 3).size()));
    RadiusSearch<Scalar> search;
    search.take(world.grid, Scalar(6.5));
    std::vector<std::uint32_t> counts(search.size());
    search.count(counts);
    unsigned long sum = 0;
    for (const std::uint32_t count : counts) {
        sum = sum * 31 + count;
    }
    std::printf("radius search: %lx\n", sum & 0xffffffff);
}

// At every place that such a matrix may have by itself: 16 bytes from one to the next, or 4.
template <class Scalar>
void look(World<Scalar>& world) {
    using Matrix = Eigen::Matrix<Scalar, 4, 4>;
    using Plane = Eigen::Hyperplane<Scalar, 3>;
    struct alignas(alignof(Matrix)) Holder {
        Scalar before[alignof(Matrix) / sizeof(Scalar)];
        Matrix matrix;
    };
    const auto holder = std::make_unique<Holder>();
    Matrix& matrix = holder->matrix;
    matrix.setZero();
    matrix(0, 0) = matrix(1, 1) = 1;
    matrix(2, 2) = Scalar(-1.25);
    matrix(2, 3) = Scalar(80 - 4.5);
    matrix(3, 2) = -1;
    matrix(3, 3) = 80;  // from (0, 0, 80) along -z
    matrix(0, 3) = matrix(1, 3) = -32;
    std::printf("%s|%s\n", frustumError(matrix).c_str(),
                cameraError(matrix, {0, 0, 800, 600}).c_str());
    for (const Plane& plane : frustumPlanes(matrix, DepthRange::zeroToOne)) {
        std::printf("%.2f %.2f %.2f %.2f\n", static_cast<double>(plane.coeffs()[0]),
                    static_cast<double>(plane.coeffs()[1]), static_cast<double>(plane.coeffs()[2]),
                    static_cast<double>(plane.coeffs()[3]));
    }
    printFound("frustum", world, frustumRegion(matrix, DepthRange::zeroToOne));
    ScreenRectangle<Scalar> part = wholeScreen<Scalar>();
    part.max().x() = 0;
    printFound("half of it", world, frustumRegion<Scalar>(matrix, DepthRange::zeroToOne, part));
    const std::array<Plane, 2> planes{Plane(Vector3<Scalar>(1, 0, 0), -20),
                                      Plane(Vector3<Scalar>(-1, 0, 0), 30)};
    printFound("planes", world, ConvexRegion<Scalar>(planes));
    const Plane none(Vector3<Scalar>(1, 0, 0), special<Scalar>(kNanBits));
    printFound("no plane", world, ConvexRegion<Scalar>(std::vector<Plane>{none}));

    const Camera<Scalar> camera(matrix, DepthRange::zeroToOne, {0, 0, 800, 600});
    std::printf("%d %d\n", camera.isValid() ? 1 : 0, camera.viewProjection() == matrix ? 1 : 0);
    Eigen::Vector2d pixel(400, 300);
    printFound("pixel", world, camera.rayThrough(pixel));
    const ScreenRectangle<Scalar> drag = camera.rectangleBetween(pixel, {600, 200});
    std::printf("%.2f %.2f %.2f %.2f\n", static_cast<double>(drag.min().x()),
                static_cast<double>(drag.min().y()), static_cast<double>(drag.max().x()),
                static_cast<double>(drag.max().y()));
    pixel.x() = special<double>(kNanBits);
    std::printf("%d %d\n", camera.rayThrough(pixel).isEmpty() ? 1 : 0,
                camera.rectangleBetween(pixel, pixel).isEmpty() ? 1 : 0);
    const GroundFootprint<Scalar> ground(matrix, DepthRange::zeroToOne, {0, 4, UpAxis::z});
    std::printf("%u corners\n", static_cast<unsigned>(ground.corners().size()));
    printFound("footprint", world, ground.region());
    Culler<Scalar> culler;
    culler.look(world.grid, frustumRegion<Scalar>(matrix, DepthRange::zeroToOne));
    std::printf("%u\n", static_cast<unsigned>(culler.count()));
    matrix(1, 2) = special<Scalar>(kNanBits);
    std::printf("%s\n", frustumError(matrix).c_str());
}

template <class Scalar>
void live() {
    Simulation<Scalar> simulation;
    const BodyId body = simulation.add({.position = {0, 1, 0}, .velocity = {1, 0, 0}});
    simulation.advance(1);
    std::printf("%.2f\n", static_cast<double>(simulation.position(body).x()));
    Grid<Scalar> grid;
    Terrain<Scalar> terrain(grid, UpAxis::z);
    terrain.add(std::vector<Vector3<Scalar>>{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}});
    for (const Scalar x : {Scalar(1), Scalar(9), special<Scalar>(kNanBits)}) {
        std::printf("%d", terrain.surfaceBelow({x, 1, 5}) ? 1 : 0);
    }
    std::printf("\n");
}

template <class Scalar>
void run() {
    World<Scalar> world;
    look(world);
    ask(world);
    meetOnTheWay(world);
    moveWhatIsNoNumber(world);
    ask(world);
    meetOnTheWay(world);
    sweep(world);
    live<Scalar>();
}

}  // namespace

int main() {
    setMessageHandler([](const char* message) { std::printf("%s\n", message); });
    run<float>();
    run<double>();
}
