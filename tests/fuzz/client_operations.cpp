// SPDX-License-Identifier: Zlib

// The clients of the grid against a look at everything.

#include <integration/ai/proximity.hpp>
#include <integration/ai/radar.hpp>
#include <integration/ai/sight.hpp>
#include <integration/ai/zones.hpp>
#include <integration/camera/frustum.hpp>
#include <integration/culling/culler.hpp>
#include <integration/picking/drag_selection.hpp>
#include <integration/picking/pick.hpp>
#include <integration/terrain/terrain.hpp>
#include <tests/fuzz/grid_world.hpp>
#include <tests/support/ai_oracles.hpp>
#include <tests/support/cameras.hpp>
#include <tests/support/picking_oracle.hpp>
#include <tests/support/terrain_oracle.hpp>

namespace hashphase::test {
namespace {

bool isOdd(ProxyId id) {
    return id.index % 2 == 1;
}

template <class Scalar>
class ClientPlay {
public:
    ClientPlay(const Operation& first, OperationLog& story)
        : story_(story), world_(configOf(first)), life_(first, world_, story) {
        // Something that is no ground.
        static_cast<void>(
            ground_.add(Aabb<Scalar>(Vector3<Scalar>(0, 0, 0), Vector3<Scalar>(1, 1, 1))));
    }

    void play(const Operation& operation) {
        life_.play(operation, *this, kAsking);
        EXPECT_EQ(world_.grid.validate(), "");
    }

private:
    void update(Arguments& /*arguments*/) {
        story_.tell("update");
        world_.grid.update();
    }

    void pick(Arguments& arguments) {
        const Vector3<Scalar> from = life_.palette().point(arguments);
        const Vector3<Scalar> to = life_.palette().point(arguments);
        const RayRegion<Scalar> ray(from, to);
        const bool isFiltered = arguments.flag();
        const auto filter = isFiltered ? ProxyFilter(isOdd) : ProxyFilter(acceptAll);
        story_.tell("pick along ", from, to);
        const auto byBox = [this](ProxyId id, const RayRegion<Scalar>& along, Scalar /*limit*/) {
            const Scalar key = along.key(world_.grid.box(id));
            return key >= 0 ? std::optional(key) : std::nullopt;
        };
        const auto expected = pickAllByBruteForce<Scalar>(life_.proxies(), ray, byBox, filter);
        std::vector<Picked<Scalar>> picked;
        pickAll(world_.grid, ray, picked, filter);
        ASSERT_EQ(picked.size(), expected.size());
        for (std::size_t i = 0; i < picked.size(); ++i) {
            ASSERT_EQ(picked[i].id, expected[i].id) << "at place " << i;
            ASSERT_EQ(picked[i].fraction, expected[i].fraction);
        }
        const Picked<Scalar> nearest = pickNearest(world_.grid, ray, filter);
        EXPECT_EQ(nearest.id, expected.empty() ? ProxyId{} : expected[0].id);
        const Picked<Scalar> tested = pickNearest<Scalar>(world_.grid, ray, byBox, filter);
        EXPECT_EQ(tested.id, nearest.id);
    }

    // Whatever touches what a camera sees is visible; what is dragged is what the region says.
    void look(Arguments& arguments) {
        Random random = arguments.random();
        RegionMaker<Scalar> make(random, life_.proxies());
        const CameraLens lens = randomLens(random);
        const Vector3<double> eye = make.point().template cast<double>();
        const Vector3<double> target = make.point().template cast<double>();
        // Farther away, products with the camera's matrix overflow.
        if (!(std::max(eye.cwiseAbs().maxCoeff(), target.cwiseAbs().maxCoeff()) < 1e18)) {
            return;
        }
        const auto matrix = cameraMatrix<Scalar>(lens, eye, target);
        const auto view = frustumRegion<Scalar>(matrix, lens.depthRange, wholeScreen<Scalar>(),
                                                Containment::touching, Touch::byPlanes);
        story_.tell("look with a camera and drag a box");
        culler_.look(world_.grid, view);
        for (const Placed<Scalar>& proxy : life_.proxies()) {
            EXPECT_TRUE(culler_.isVisible(proxy.id) || !(view.key(proxy.box) >= 0))
                << proxy.id.index << " is culled";
        }
        const Camera<Scalar> window(matrix, lens.depthRange, {0, 0, 640, 480});
        const Pixel a = random.pointIn(-20, 660).head<2>();
        const Pixel b = random.chance(0.2) ? a : Pixel(random.pointIn(-20, 660).head<2>());
        const auto containment = random.chance(0.5) ? Containment::touching : Containment::inside;
        std::vector<ProxyId> selected;
        std::vector<ProxyId> expected;
        select(world_.grid, window, a, b, selected, containment);
        findInByBruteForce(life_.proxies(), selectionRegion(window, a, b, containment), expected,
                           acceptAll);
        EXPECT_EQ(differences(selected, expected), "");
    }

    void changeZones(Arguments& arguments) {
        const std::uint32_t what = arguments.below(4);
        const auto known = byBruteForce_.zones();
        if (what == 3 && !known.empty()) {
            const ZoneId id =
                known[arguments.below(static_cast<std::uint32_t>(known.size()))].first;
            story_.tell("remove zone ", id.index);
            zones_.remove(id);
            byBruteForce_.remove(id);
            EXPECT_FALSE(zones_.contains(id));
            return;
        }
        const Zone<Scalar> zone = anyZone(arguments);
        if (what == 2 && !known.empty()) {
            const ZoneId id =
                known[arguments.below(static_cast<std::uint32_t>(known.size()))].first;
            story_.tell("set zone ", id.index);
            zones_.set(id, zone);
            byBruteForce_.set(id, zone);
        } else if (known.size() < 12) {
            const ZoneId id = zones_.add(zone);
            story_.tell("add zone ", id.index);
            byBruteForce_.set(id, zone);
        }
        EXPECT_EQ(zones_.size(), byBruteForce_.zones().size());
    }
    Zone<Scalar> anyZone(Arguments& arguments) {
        Zone<Scalar> zone{BoxRegion<Scalar>{life_.palette().box(arguments, life_.proxies())},
                          arguments.flag() ? Presence::box : Presence::position};
        const std::uint32_t form = arguments.below(3);
        if (form == 1) {
            const Vector3<Scalar> center = life_.palette().point(arguments);
            zone.shape = SphereRegion<Scalar>(center, life_.palette().extent(arguments.byte()));
        } else if (form == 2) {
            Random random = arguments.random();
            RegionMaker<Scalar> make(random, life_.proxies());
            zone.shape = make.convex();
        }
        return zone;
    }

    void updateZones(Arguments& arguments) {
        story_.tell("update zones");
        const bool isFiltered = arguments.flag();
        const auto accept = [isFiltered](ZoneId zone, ProxyId proxy) {
            return !isFiltered || (zone.index + proxy.index) % 3 != 0;
        };
        const ZoneEvents events = zones_.update(world_.grid, accept, allZones, anyFor(arguments));
        const auto expected = byBruteForce_.update(life_.proxies(), accept);
        const auto list = [](std::span<const ZoneEvent> from) {
            return std::vector<ZoneEvent>(from.begin(), from.end());
        };
        EXPECT_EQ(differences(list(events.entered), expected.entered), "") << "entered";
        EXPECT_EQ(differences(list(events.stayed), expected.stayed), "") << "stayed";
        EXPECT_EQ(differences(list(events.left), expected.left), "") << "left";
        for (const auto& [id, zone] : byBruteForce_.zones()) {
            const auto occupants = zones_.occupants(id);
            EXPECT_EQ(
                differences({occupants.begin(), occupants.end()}, byBruteForce_.occupants(id)), "");
        }
    }

    void scan(Arguments& arguments) {
        RadarWindow<Scalar> window;
        window.center = life_.palette().point(arguments);
        window.cellSize = life_.palette().extent(arguments.byte());
        window.columns = arguments.below(6);
        window.rows = arguments.below(6);
        window.layers = arguments.below(3);
        window.up = static_cast<UpAxis>(arguments.below(3));
        if (arguments.flag()) {
            window.heading = static_cast<Scalar>(arguments.byte()) / 40;
        }
        story_.tell("radar at ", window.center, " with cells of ", window.cellSize);
        const auto groupOf = [](ProxyId id) { return id.index % 3; };
        const auto counts = radar_.scan(world_.grid, window, 2, groupOf);
        EXPECT_EQ(std::vector<std::uint32_t>(counts.begin(), counts.end()),
                  scanByBruteForce(life_.proxies(), window, 2, groupOf));
    }

    void see(Arguments& arguments) {
        Viewer<Scalar> viewer;
        viewer.eye = life_.palette().point(arguments);
        viewer.direction = life_.palette().point(arguments) - viewer.eye;
        viewer.range = arguments.byte() % 4 == 0 ? std::numeric_limits<Scalar>::infinity()
                                                 : 8 * life_.palette().extent(arguments.byte());
        viewer.halfAngle = static_cast<Scalar>(arguments.byte()) / 64;
        if (arguments.flag()) {
            viewer.self = life_.proxies()[life_.any(arguments)].id;
        }
        const auto blockers = arguments.flag() ? ProxyFilter(isOdd) : ProxyFilter(acceptAll);
        story_.tell("see from ", viewer.eye, " to ", viewer.direction, " as far as ", viewer.range,
                    " within ", viewer.halfAngle);
        std::vector<ProxyId> seen;
        std::vector<ProxyId> expected;
        visibleFrom(world_.grid, viewer, seen, acceptAll, blockers);
        visibleFromByBruteForce(life_.proxies(), viewer, expected, acceptAll, blockers);
        EXPECT_EQ(differences(seen, expected), "");
        const ProxyId target = life_.proxies()[life_.any(arguments)].id;
        EXPECT_EQ(canSee(world_.grid, viewer, target, blockers),
                  std::binary_search(expected.begin(), expected.end(), target));
        const Vector3<Scalar> to = life_.palette().point(arguments);
        EXPECT_EQ(hasLineOfSight(world_.grid, viewer.eye, to, blockers, viewer.self, target),
                  hasLineOfSightByBruteForce(life_.proxies(), viewer.eye, to, blockers, viewer.self,
                                             target));
    }

    void findNear(Arguments& arguments) {
        const Vector3<Scalar> position = life_.palette().point(arguments);
        const std::uint8_t byte = arguments.byte();
        const Scalar radius =
            byte >= 224 ? Palette<Scalar>::hostile(arguments.byte()) : life_.palette().extent(byte);
        const ProxyId self = life_.proxies()[life_.any(arguments)].id;
        story_.tell("near ", position, " within ", radius);
        std::vector<ProxyId> found;
        std::vector<ProxyId> expected;
        findWithin(world_.grid, position, radius, found, isOdd, self);
        findWithinByBruteForce(life_.proxies(), position, radius, expected, isOdd, self);
        EXPECT_EQ(differences(found, expected), "");
        estimateWithin(world_.grid, position, radius, found, isOdd, self);
        EXPECT_TRUE(std::includes(found.begin(), found.end(), expected.begin(), expected.end()))
            << "the estimate never misses";
    }

    void stand(Arguments& arguments) {
        if (terrain_.size() == 0) {
            clearOrUpdateGround(arguments);
            return;
        }
        const Vector3<Scalar> point = groundPoint(arguments);
        const auto radius = static_cast<Scalar>(arguments.below(8)) / 4;
        story_.tell("stand at ", point, " with ", radius);
        const TerrainOracle<Scalar> oracle(terrain_);
        EXPECT_EQ(oracle.checkSurface(point, terrain_.surfaceBelow(point)), "");
        EXPECT_EQ(oracle.checkRest(point, radius, terrain_.restingHeight(point, radius)), "");
        EXPECT_EQ(ground_.validate(), "");
    }

    void clearOrUpdateGround(Arguments& arguments) {
        const unsigned what = arguments.byte() % 8U;
        if (what == 0) {
            story_.tell("clear the ground");
            terrain_.clear();
            EXPECT_EQ(ground_.size(), 1U);
        } else if (what < 4) {
            changeTriangle(arguments, what == 1);
        } else {
            story_.tell("update the ground");
            ground_.update();
        }
        EXPECT_EQ(ground_.validate(), "");
    }

    void changeTriangle(Arguments& arguments, bool goes) {
        const std::uint32_t number = arguments.below(terrain_.size() + 1);
        if (number == terrain_.size() || terrain_.proxy(number).isNull()) {
            return;
        }
        if (goes) {
            story_.tell("remove triangle ", number);
            terrain_.remove(number);
            return;
        }
        auto corners = terrain_.corners(number);
        corners[arguments.below(3)] = groundPoint(arguments);
        story_.tell("replace triangle ", number, " ", corners[0], corners[1], corners[2]);
        terrain_.replace(number, corners);
    }

    // Halves of metres, so that corners and edges are met and triangles lie in one plane.
    static Vector3<Scalar> groundPoint(Arguments& arguments) {
        const auto half = [&arguments] {
            return (static_cast<Scalar>(arguments.below(17)) - 8) / 2;
        };
        const Scalar x = half();
        const Scalar y = half();
        const Scalar z = half();
        return {x, y, z};
    }
    void addTriangles(Arguments& arguments) {
        constexpr std::uint32_t kMost = 40;
        std::vector<Vector3<Scalar>> corners{groundPoint(arguments), groundPoint(arguments),
                                             groundPoint(arguments)};
        const std::uint8_t spoil = arguments.byte();
        if (terrain_.size() >= kMost) {
            return;
        }
        if (spoil >= 240) {
            corners[spoil % 3][spoil / 3 % 3] = std::numeric_limits<Scalar>::quiet_NaN();
        }
        story_.tell("triangle ", corners[0], corners[1], corners[2]);
        const AddedTriangles added = terrain_.add(corners);
        EXPECT_EQ(added.count, 1U);
        EXPECT_EQ(added.refused.size(), spoil >= 240 ? 1U : 0U);
        EXPECT_EQ(ground_.validate(), "");
    }

    using Self = ClientPlay;
    static constexpr std::array<void (Self::*)(Arguments&), 14> kAsking{
        &Self::update,       &Self::update,
        &Self::pick,         &Self::look,
        &Self::changeZones,  &Self::updateZones,
        &Self::scan,         &Self::see,
        &Self::findNear,     &Self::addTriangles,
        &Self::addTriangles, &Self::stand,
        &Self::stand,        &Self::clearOrUpdateGround};

    OperationLog& story_;
    GridWorld<Scalar> world_;
    BoxModel<Scalar, GridWorld<Scalar>> life_;
    Culler<Scalar> culler_;
    Zones<Scalar> zones_;
    ZonesByBruteForce<Scalar> byBruteForce_;
    Radar<Scalar> radar_;
    Grid<Scalar> ground_;
    Terrain<Scalar> terrain_{ground_};
};

}  // namespace

Verdict playClients(std::span<const Operation> operations, bool tellsStory) {
    return playInEither<ClientPlay>(operations, tellsStory);
}

}  // namespace hashphase::test
