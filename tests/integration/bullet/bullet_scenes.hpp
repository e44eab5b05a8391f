// SPDX-License-Identifier: Zlib
#pragma once

// Scenes of boxes, and scripts over them: what a game does to a broadphase, written down once, so
// that any number of broadphases can be made to do it.
//
// A script holds no pointers and no proxies, only object numbers; player.hpp plays it. Everything
// follows from a scene and a seed.

#include <LinearMath/btVector3.h>

#include <cstdint>
#include <iosfwd>
#include <random>
#include <string>
#include <vector>

namespace hashphase::test {

/// Uniform numbers that are the same with every standard library.
class BulletRandom {
public:
    explicit BulletRandom(std::uint64_t seed) : engine_(seed) {}

    /// In [low, high).
    btScalar uniform(double low, double high);
    /// In [0, count).
    int below(int count);
    bool chance(double probability) { return uniform(0, 1) < btScalar(probability); }
    btVector3 vector(double low, double high);
    btVector3 direction();

private:
    std::mt19937_64 engine_;
};

struct Box {
    btVector3 min;
    btVector3 max;
};

Box boxAround(const btVector3& center, const btVector3& halfExtents);

/// The predicate that decides every pair: closed, and false for NaN.
bool overlap(const Box& a, const Box& b);

/// Equal, bit by bit but for the sign of zero.
bool isSame(const Box& a, const Box& b);

enum class Action {
    create,
    destroy,
    set,
    regroup,       ///< new group and mask, and the cache is asked about the object again
    changeFilter,  ///< another filter callback, and the cache is asked about everything again
};

struct Command {
    Action action = Action::set;
    int object = 0;
    Box box{};
    int group = 0;
    int mask = 0;  ///< with changeFilter: see Filter in player.hpp
};

/// What happens between two calls of calculateOverlappingPairs.
using Frame = std::vector<Command>;

struct Script {
    std::vector<Frame> frames;
    int objectCount = 0;
};

/// Where objects are, how large, and how they move.
struct Scene {
    const char* name;
    Box (*place)(BulletRandom&, int object);
    Box (*step)(BulletRandom&, const Box&);
    double movingShare;  ///< of the objects that are awake, how many are set in a frame
};

/// Names the scene in the output of a parametrised test.
void PrintTo(const Scene& scene, std::ostream* out);

/// uniform, paper, logSizes, flat, piles, touchingLattice, planes, farFromTheOrigin, staticHeavy.
const std::vector<Scene>& allScenes();

const Scene& sceneNamed(const std::string& name);

/// A life in a scene: objects are created and destroyed, move, teleport, go away and come back
/// within a frame, are set to the box they have, rest and wake, change their group; the filter
/// callback changes twice. Every object rests together from a third to a half of the frames.
Script makeScript(const Scene& scene, int objectCount, int frameCount, std::uint64_t seed);

}  // namespace hashphase::test
