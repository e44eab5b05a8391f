// SPDX-License-Identifier: Zlib
//
// A program of a user who asks much of headers (strict_users.cmake): it includes all of ours, and
// makes each of their templates that a user's own code can make, in both precisions. It is compiled,
// never run.

#include "our_headers.hpp"

#include <cstdio>

using namespace hashphase;

namespace {

template <class Scalar, class Region>
void visitBy(const Grid<Scalar>& grid, const Sweeps<Scalar>& sweeps, const Region& region) {
    std::vector<ProxyId> ids;
    std::vector<std::uint64_t> words;
    std::vector<KeyedProxy<Scalar>> keyed;
    CollectAll all(ids);
    CollectCount count;
    CollectAny any;
    CollectClosest<Scalar> closest;
    CollectNearest<Scalar> nearest(3, keyed);
    CollectBits bits(words);
    const auto visit = [&](auto& collector) {
        grid.visit(region, collector);
        sweeps.visit(region, collector);
    };
    visit(all);
    visit(count);
    visit(any);
    visit(closest);
    visit(nearest);
    visit(bits);
    std::printf("%zu %zu %d\n", count.count(), nearest.sort().size(), any.found().isNull() ? 1 : 0);

    const std::vector<Region> regions(2, region);
    std::vector<CollectAll> collectors(2, all);
    grid.visitEach(std::span<const Region>(regions), std::span<CollectAll>(collectors));
    std::vector<CollectClosest<Scalar>> several(2);
    grid.visitEach(std::span<const Region>(regions), std::span<CollectClosest<Scalar>>(several));
}

template <class Scalar>
void useGrid() {
    GridConfig config;
    Grid<Scalar> grid(config);
    Sweeps<Scalar> sweeps(grid);
    Pairs<Scalar> pairs(grid, &sweeps);
    const Vector3<Scalar> origin(0, 0, 0);
    const Aabb<Scalar> box = boxAround(origin, Scalar(1));
    const ProxyId id = grid.add(box);
    sweeps.set(id, {1, 0, 0}, Sweep::line);
    pairs.update([](ProxyId, ProxyId) { return true; });
    pairs.update([](std::span<const ProxyPair> asked, std::span<char> accepted) {
        std::fill_n(accepted.begin(), asked.size(), char{1});
    });
    grid.forEach(
        [](ProxyId, const Aabb<Scalar>& each) { std::printf("%d\n", hasNan(each) ? 1 : 0); });
    CollectCount count;
    grid.visitCell(grid.cellAt(origin), count);

    const Eigen::Matrix<Scalar, 4, 4> camera = Eigen::Matrix<Scalar, 4, 4>::Identity();
    const auto frustum = frustumRegion<Scalar>(camera, DepthRange::zeroToOne);
    visitBy(grid, sweeps, BoxRegion<Scalar>{box});
    visitBy(grid, sweeps, SphereRegion<Scalar>(origin, 1));
    visitBy(grid, sweeps, RayRegion<Scalar>(origin, {1, 1, 1}));
    visitBy(grid, sweeps, PositionRegion<Scalar>(origin, 1));
    visitBy(grid, sweeps, CellsRegion<Scalar>(origin, 1, 1));
    visitBy(grid, sweeps, frustum);

    const auto isOther = [id](ProxyId other) { return other != id; };
    std::vector<KeyedProxy<Scalar>> nearest;
    findNearest(grid, origin, 3, 10, nearest, isOther, id);
    const MovingBox<Scalar> moving{box, origin};
    std::printf("%d\n", firstContact(moving, moving) ? 1 : 0);
    Neighbours<Scalar> neighbours;
    std::printf("%zu\n", neighbours.find(grid, 1).size());
    RadiusSearch<Scalar> search;
    search.take(grid, 1, isOther);
    std::vector<std::uint32_t> counts(search.size());
    search.count(counts);
}

template <class Scalar>
void useClients() {
    Grid<Scalar> grid;
    const Vector3<Scalar> origin(0, 0, 0);
    const Eigen::Matrix<Scalar, 4, 4> camera = Eigen::Matrix<Scalar, 4, 4>::Identity();
    const auto accept = [](ProxyId) { return true; };

    Culler<Scalar> culler;
    culler.look(grid, frustumRegion<Scalar>(camera, DepthRange::zeroToOne), accept);
    culler.forEach([](std::uint32_t index) { std::printf("%u\n", index); });

    const Camera<Scalar> view(camera, DepthRange::zeroToOne, {0, 0, 800, 600});
    std::vector<ProxyId> found;
    std::vector<Picked<Scalar>> picked;
    pickAll(grid, view.rayThrough({1, 2}), picked);
    select(grid, view, {0, 0}, {10, 10}, found);

    findWithin(grid, origin, 1, found, accept);
    visibleFrom(grid, Viewer<Scalar>{}, found, accept, accept);
    Zones<Scalar> zones;
    const ZoneId zone = zones.add({SphereRegion<Scalar>(origin, 1)});
    zones.update(grid, [&](ZoneId each, ProxyId) { return each == zone; });
    Radar<Scalar> radar;
    radar.scan(grid, {}, 2, [](ProxyId) { return 1U; });
    RarestColour<Scalar> colours;
    std::vector<std::uint32_t> chosen;
    colours.update(grid, 1, 2, chosen);

    Terrain<Scalar> terrain(grid, UpAxis::z);
    terrain.add(std::vector<Vector3<Scalar>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    std::printf("%d\n", terrain.surfaceBelow(origin) ? 1 : 0);

    Simulation<Scalar> simulation;
    const BodyId body = simulation.add({.velocity = {1, 0, 0}});
    simulation.advance(1);
    std::printf("%zu\n", std::hash<BodyId>{}(body) + std::hash<ZoneId>{}(zone));
}

void useBullet() {
    SpatialHashConfig config;
    config.parallelFor = bulletFor;
    SpatialHashBroadphase broadphase(config);
    broadphase.shiftOrigin({1, 0, 0});
    CollectCount count;
    broadphase.grid().visit(BoxRegion<btScalar>{toAabb({0, 0, 0}, {1, 1, 1})}, count);
    const WorldEffects effects = worldEffectsOf(SceneEffects{});
    std::printf("%d\n", effects.motion ? 1 : 0);
}

}  // namespace

int main() {
    useGrid<float>();
    useGrid<double>();
    useClients<float>();
    useClients<double>();
    useBullet();
}
