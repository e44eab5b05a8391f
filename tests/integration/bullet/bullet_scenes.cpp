// SPDX-License-Identifier: Zlib
#include <tests/integration/bullet/bullet_scenes.hpp>

#include <BulletCollision/BroadphaseCollision/btBroadphaseProxy.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace hashphase::test {

btScalar BulletRandom::uniform(double low, double high) {
    const double unit = static_cast<double>(engine_() >> 11) * 0x1p-53;
    return static_cast<btScalar>(low + (high - low) * unit);
}

int BulletRandom::below(int count) {
    return static_cast<int>(engine_() % static_cast<std::uint64_t>(count));
}

btVector3 BulletRandom::vector(double low, double high) {
    const btScalar x = uniform(low, high);
    const btScalar y = uniform(low, high);
    const btScalar z = uniform(low, high);
    return {x, y, z};
}

btVector3 BulletRandom::direction() {
    for (;;) {
        const btVector3 inCube = vector(-1, 1);
        if (inCube.length2() > btScalar(0.01) && inCube.length2() <= 1) {
            return inCube.normalized();
        }
    }
}

Box boxAround(const btVector3& center, const btVector3& halfExtents) {
    return {center - halfExtents, center + halfExtents};
}

bool overlap(const Box& a, const Box& b) {
    for (int axis = 0; axis < 3; ++axis) {
        if (!(a.min[axis] <= b.max[axis] && b.min[axis] <= a.max[axis])) {
            return false;
        }
    }
    return true;
}

bool isSame(const Box& a, const Box& b) {
    for (int axis = 0; axis < 3; ++axis) {
        if (a.min[axis] != b.min[axis] || a.max[axis] != b.max[axis]) {
            return false;
        }
    }
    return true;
}

namespace {

Box moved(const Box& box, const btVector3& by) {
    return {box.min + by, box.max + by};
}

Box walk(BulletRandom& random, const Box& box) {
    return moved(box, random.vector(-0.3, 0.3));
}

Box placeUniform(BulletRandom& random, int /*object*/) {
    return boxAround(random.vector(-6, 6), random.vector(0.25, 0.75));
}

// The paper's scene: spheres on a terrain, which is there as a handful of large static boxes.
constexpr double kTerrainHalfWidth = 24;
constexpr int kTerrainTiles = 16;

btScalar terrainHeight(btScalar x, btScalar z) {
    return 3 * std::sin(x / 5) + 2 * std::cos(z / 4) + std::sin((x + z) / 2);
}

Box sphereOnTerrain(btScalar x, btScalar z, btScalar radius) {
    return boxAround({x, terrainHeight(x, z) + radius, z}, {radius, radius, radius});
}

Box placePaper(BulletRandom& random, int object) {
    if (object < kTerrainTiles) {
        const auto tile = btScalar(kTerrainHalfWidth / 2);
        const btVector3 corner(tile * btScalar(object % 4 - 2), -6,
                               tile * btScalar(object / 4 - 2));
        return {corner, corner + btVector3(tile, 12, tile)};
    }
    const btScalar x = random.uniform(-kTerrainHalfWidth, kTerrainHalfWidth);
    const btScalar z = random.uniform(-kTerrainHalfWidth, kTerrainHalfWidth);
    return sphereOnTerrain(x, z, random.uniform(0.4, 1.5));
}

Box stepPaper(BulletRandom& random, const Box& box) {
    const btVector3 center = (box.min + box.max) / 2;
    const btScalar radius = (box.max.y() - box.min.y()) / 2;
    if (radius > 2) {
        return box;  // terrain
    }
    return sphereOnTerrain(center.x() + random.uniform(-0.4, 0.4),
                           center.z() + random.uniform(-0.4, 0.4), radius);
}

Box placeLogSizes(BulletRandom& random, int /*object*/) {
    const btScalar size = std::pow(btScalar(10), random.uniform(-3, 3));
    const btScalar distance = std::pow(btScalar(10), random.uniform(-3, 3));
    return boxAround(random.direction() * distance, random.vector(0.3, 0.5) * size);
}

Box stepLogSizes(BulletRandom& random, const Box& box) {
    return moved(box, (box.max - box.min) * random.vector(-0.5, 0.5));
}

Box placeFlat(BulletRandom& random, int /*object*/) {
    const btVector3 center(random.uniform(-9, 9), 2, random.uniform(-9, 9));
    return boxAround(center, {random.uniform(0, 0.8), 0, random.uniform(0, 0.8)});
}

Box stepFlat(BulletRandom& random, const Box& box) {
    return moved(box, {random.uniform(-0.3, 0.3), 0, random.uniform(-0.3, 0.3)});
}

Box placePiles(BulletRandom& random, int /*object*/) {
    const btVector3 pile(btScalar(40 * random.below(3)), 0, btScalar(-25 * random.below(2)));
    return boxAround(pile + random.direction() * random.uniform(0, 1.5), random.vector(0.1, 0.35));
}

Box stepPiles(BulletRandom& random, const Box& box) {
    return moved(box, random.vector(-0.05, 0.05));
}

// Neighbours touch exactly, with faces, edges and corners on whole numbers.
Box placeLattice(BulletRandom& random, int /*object*/) {
    const btVector3 corner(btScalar(random.below(7)), btScalar(random.below(7)),
                           btScalar(random.below(7) - 3));
    return {corner, corner + btVector3(1, 1, 1)};
}

Box stepLattice(BulletRandom& random, const Box& box) {
    btVector3 by(0, 0, 0);
    by[random.below(3)] = random.chance(0.5) ? btScalar(1) : btScalar(-1);
    return moved(box, by);
}

// What btStaticPlaneShape reports, half spaces, and slabs, among ordinary boxes.
Box placePlanes(BulletRandom& random, int object) {
    const btScalar large = BT_LARGE_FLOAT;
    const btScalar height = btScalar(random.below(5) - 2);
    switch (object % 20 == 0 ? object / 20 % 4 : -1) {
        case 0:
            return {{-large, -large, -large}, {large, large, large}};
        case 1:
            return {{-large, -large, -large}, {large, height, large}};
        case 2:
            return {{-large, height, -large}, {large, height, large}};
        case 3:
            return {{height, -large, 0}, {height + 1, large, 1}};
        default:
            return placeUniform(random, object);
    }
}

Box stepPlanes(BulletRandom& random, const Box& box) {
    if (box.max.y() - box.min.y() > 1000) {
        return box;
    }
    const btScalar rise = random.uniform(-0.3, 0.3);
    return box.max.x() > 1000 ? moved(box, {0, rise, 0}) : walk(random, box);
}

// So far out that coordinates are multiples of 1/16 in either precision.
constexpr btScalar kFar =
    std::is_same_v<btScalar, float> ? btScalar(1 << 19) : btScalar(1ULL << 48);

Box placeFar(BulletRandom& random, int object) {
    return moved(placeUniform(random, object), {kFar, -kFar, kFar});
}

/// Writes a script frame by frame, knowing what is alive and where.
class Writer {
public:
    Writer(const Scene& scene, int objectCount, std::uint64_t seed)
        : scene_(scene), random_(seed), objects_(static_cast<std::size_t>(objectCount)) {}

    Frame firstFrame() {
        Frame frame;
        for (int object = 0; object < count(); ++object) {
            if (object % 5 != 0) {
                create(frame, object);
            }
        }
        return frame;
    }

    Frame frame(bool allRest, int filter) {
        Frame frame;
        if (filter >= 0) {
            frame.push_back({Action::changeFilter, 0, {}, 0, filter});
        }
        for (int object = 0; object < count(); ++object) {
            if (allRest) {
                rest(frame, object);
            } else if (at(object).isAlive) {
                live(frame, object);
            } else if (random_.chance(0.1)) {
                create(frame, object);
            }
        }
        return frame;
    }

private:
    struct Object {
        Box box{};
        bool isAlive = false;
        int restsFor = 0;  // frames
    };

    [[nodiscard]] int count() const { return static_cast<int>(objects_.size()); }
    Object& at(int object) { return objects_[static_cast<std::size_t>(object)]; }

    void set(Frame& frame, int object, const Box& box) {
        at(object).box = box;
        frame.push_back({Action::set, object, box, 0, 0});
    }

    void create(Frame& frame, int object) {
        at(object) = {scene_.place(random_, object), true, 0};
        const auto [group, mask] = someGroup();
        frame.push_back({Action::create, object, at(object).box, group, mask});
    }

    void destroy(Frame& frame, int object) {
        at(object).isAlive = false;
        frame.push_back({Action::destroy, object, {}, 0, 0});
    }

    std::pair<int, int> someGroup() {
        using Proxy = btBroadphaseProxy;
        switch (random_.below(8)) {
            case 0:
                return {Proxy::StaticFilter, Proxy::AllFilter ^ Proxy::StaticFilter};
            case 1:
                return {Proxy::SensorTrigger, Proxy::DefaultFilter};
            case 2:
                return {Proxy::CharacterFilter, Proxy::AllFilter};
            default:
                return {Proxy::DefaultFilter, Proxy::AllFilter};
        }
    }

    void rest(Frame& frame, int object) {
        if (at(object).isAlive && object % 2 == 0) {
            set(frame, object, at(object).box);  // as btCollisionWorld does for everything
        }
    }

    void live(Frame& frame, int object) {
        Object& self = at(object);
        const btScalar dice = random_.uniform(0, 100);
        if (self.restsFor > 0) {
            --self.restsFor;
        } else if (dice < 1) {
            destroy(frame, object);
        } else if (dice < 2) {
            destroy(frame, object);
            create(frame, object);
        } else if (dice < 3) {
            set(frame, object, scene_.place(random_, object));
        } else if (dice < 5) {
            const Box here = self.box;
            set(frame, object, scene_.place(random_, object));
            set(frame, object, here);
        } else if (dice < 6) {
            const auto [group, mask] = someGroup();
            frame.push_back({Action::regroup, object, {}, group, mask});
        } else if (dice < 8) {
            self.restsFor = 4 + random_.below(16);
        } else if (random_.chance(scene_.movingShare)) {
            set(frame, object, scene_.step(random_, self.box));
        } else {
            rest(frame, object);
        }
    }

    const Scene& scene_;
    BulletRandom random_;
    std::vector<Object> objects_;
};

}  // namespace

void PrintTo(const Scene& scene, std::ostream* out) {
    *out << scene.name;
}

const std::vector<Scene>& allScenes() {
    static const std::vector<Scene> scenes{
        {"uniform", placeUniform, walk, 0.9},
        {"paper", placePaper, stepPaper, 1.0},
        {"logSizes", placeLogSizes, stepLogSizes, 0.7},
        {"flat", placeFlat, stepFlat, 0.7},
        {"piles", placePiles, stepPiles, 0.7},
        {"touchingLattice", placeLattice, stepLattice, 0.5},
        {"planes", placePlanes, stepPlanes, 0.7},
        {"farFromTheOrigin", placeFar, walk, 0.7},
        {"staticHeavy", placeUniform, walk, 0.05},
    };
    return scenes;
}

const Scene& sceneNamed(const std::string& name) {
    const auto& scenes = allScenes();
    const auto found = std::find_if(scenes.begin(), scenes.end(),
                                    [&](const Scene& scene) { return scene.name == name; });
    if (found == scenes.end()) {
        throw std::invalid_argument("There is no scene named " + name + ".");
    }
    return *found;
}

Script makeScript(const Scene& scene, int objectCount, int frameCount, std::uint64_t seed) {
    Writer writer(scene, objectCount, seed);
    Script script{{writer.firstFrame()}, objectCount};
    for (int frame = 1; frame < frameCount; ++frame) {
        const bool allRest = frame >= frameCount / 3 && frame < frameCount / 2;
        const int filter = frame == frameCount / 4 ? 3 : frame == frameCount * 3 / 4 ? 0 : -1;
        script.frames.push_back(writer.frame(allRest, filter));
    }
    return script;
}

}  // namespace hashphase::test
