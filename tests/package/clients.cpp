// SPDX-License-Identifier: Zlib
//
// The example of the README's chapter "One grid for all", and the check that its answers are right.
// Prints the number of overlapping pairs, which is one.

#include <broadphase/pairs.hpp>
#include <broadphase/radius_search.hpp>
#include <integration/ai/nearest.hpp>
#include <integration/ai/proximity.hpp>
#include <integration/ai/radar.hpp>
#include <integration/ai/sight.hpp>
#include <integration/ai/zones.hpp>
#include <integration/camera/frustum.hpp>
#include <integration/culling/culler.hpp>
#include <integration/effects/simulation.hpp>
#include <integration/picking/drag_selection.hpp>
#include <integration/picking/pick.hpp>
#include <integration/terrain/terrain.hpp>

#include <cstdio>
#include <cstdlib>
#include <vector>

using namespace hashphase;

namespace {

void check(bool isRight, const char* what) {
    if (!isRight) {
        std::printf("wrong: %s\n", what);
        std::exit(1);
    }
}

Aabb<float> cubeAt(float x, float y, float z) {
    const Vector3<float> middle(x, y, z);
    const Vector3<float> half(1, 1, 1);
    return {middle - half, middle + half};
}

// An orthographic camera at the origin that looks along -z and sees 40 x 40 m, from 0 to 100 m.
Eigen::Matrix4f camera() {
    Eigen::Matrix4f matrix = Eigen::Matrix4f::Identity();
    matrix(0, 0) = matrix(1, 1) = 1.0F / 20;
    matrix(2, 2) = -1.0F / 100;
    return matrix;
}

}  // namespace

int main() {
    Grid<float> grid;
    Pairs<float> pairs(grid);
    const ProxyId agent = grid.add(cubeAt(0, 0, -10));
    const ProxyId enemy = grid.add(cubeAt(0, 0, -30));
    const ProxyId wall = grid.add(cubeAt(0, 0, -31.5F), Mobility::resting);
    pairs.update([](ProxyId, ProxyId) { return true; });
    const auto isEnemy = [&](ProxyId id) { return id == enemy; };
    const auto isWall = [&](ProxyId id) { return id == wall; };

    // Culling: any view-projection matrix.
    Culler<float> culler;
    culler.look(grid, frustumRegion<float>(camera(), DepthRange::zeroToOne));
    check(culler.isVisible(enemy) && culler.count() == 3, "culling");

    // Picking: the nearest body under the pointer, all of them, and a rectangle that is dragged.
    const Camera<float> view(camera(), DepthRange::zeroToOne, {0, 0, 800, 800});
    std::vector<Picked<float>> underPointer;
    std::vector<ProxyId> selected;
    check(pickNearest(grid, view.rayThrough({400, 400})).id == agent, "the nearest");
    pickAll(grid, view.rayThrough({400, 400}), underPointer);
    check(underPointer.size() == 3, "all");
    select(grid, view, {300, 300}, {500, 500}, selected);
    check(selected.size() == 3, "selection");

    // AI: who is near, who is nearest, who is seen, who is in which zone, a radar.
    std::vector<ProxyId> near;
    std::vector<ProxyId> seen;
    std::vector<KeyedProxy<float>> nearest;
    const Viewer<float> viewer{
        .eye = {0, 0, -10}, .direction = {0, 0, -1}, .range = 50, .halfAngle = 0.6F, .self = agent};
    findWithin(grid, viewer.eye, 25, near, isEnemy, agent);
    findNearest(grid, viewer.eye, 1, 1000, nearest, isEnemy);
    visibleFrom(grid, viewer, seen, isEnemy, isWall);
    check(near.size() == 1 && nearest[0].id == enemy && seen.size() == 1, "neighbours and sight");

    Zones<float> zones;
    const ZoneId lava = zones.add({SphereRegion<float>({0, 0, -30}, 5)});
    const ZoneEvents events = zones.update(grid);  // once a frame: entered, stayed, left
    check(events.entered.size() == 2 && events.entered[0].zone == lava, "zones");

    Radar<float> radar;
    const auto counts =
        radar.scan(grid, {.center = viewer.eye, .cellSize = 10, .columns = 9, .rows = 9}, 2,
                   [&](ProxyId id) { return isEnemy(id) ? 1U : 0U; });
    check(counts.size() == 2 * 9 * 9, "radar");

    RadiusSearch<float> search;  // every agent asks
    search.take(grid, 5);
    std::vector<std::uint32_t> neighbourCounts(search.size());
    search.count(neighbourCounts);

    // Terrain: triangles filed once.
    Grid<float> ground;
    Terrain<float> terrain(ground);
    const std::vector<Vector3<float>> corners{{-50, 0, 0}, {50, 0, 0}, {0, 10, -100}};
    terrain.add(corners);
    const auto below = terrain.surfaceBelow({0, 50, -50});
    const auto rest = terrain.restingHeight({0, 50, -50}, 1);
    check(below && below->height == 5 && rest && rest->height > 6, "terrain");

    // All of them in a frame that runs just what is declared.
    SceneEffects effects;
    effects.motion.emplace();
    effects.culling.emplace();
    Simulation<float> simulation(effects);
    simulation.add({.velocity = {1, 0, 0}});
    check(simulation.advance(1)[SceneCounter::bodiesMoved] == 1, "effects");

    std::printf("pairs: %d\n", static_cast<int>(pairs.count()));
}
