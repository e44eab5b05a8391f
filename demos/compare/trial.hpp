// SPDX-License-Identifier: Zlib
#pragma once

// A scene with several broadphases at work on it. What runs the trial knows nothing of the scene.
//
// Order   add() for each broadphase; then for each frame beginFrame(), and runFrame() once for each
//         broadphase, in any order.

#include <demos/compare/broadphase_kind.hpp>
#include <demos/compare/reference_pairs.hpp>
#include <demos/report/profile_zones.hpp>
#include <demos/scenes/file_bytes.hpp>
#include <demos/scenes/terrain.hpp>
#include <demos/scenes/world_contents.hpp>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>

namespace hashphase::demos {

/// What one broadphase did in one frame. The spans hold until the next call of the trial.
struct Observation {
    double setAabbMs = 0;          // setAabb for all objects
    double calculateMs = 0;        // calculateOverlappingPairs
    std::optional<double> stepMs;  // the whole simulation step, where there is one
    std::span<const PairKey> reported;
    std::span<const PairKey> exact;
    std::span<const Aabb<float>> boxes;  // as the broadphase knows them
    std::optional<float> cellSize;       // of its finest cells [m], where it has cells

    // Of a profiled trial, which has no pairs and boxes.
    std::span<const ProfileZone> zones;
    double shapeBoxesMs = 0;  // of setAabbMs, what Bullet takes to make the boxes
};

/// Called now and then with the number of objects that have been dealt with; false: stop.
using GoOn = std::function<bool(std::size_t done)>;

/// So many objects are dealt with between two calls of GoOn, which look at the clock.
inline constexpr std::size_t kObjectsBetweenLooks = 64;

/// What is known of a trial from the beginning.
struct TrialFacts {
    std::size_t objects = 0;
    Aabb<float> bounds;                            // where they are; what leaves it is rare
    bool sharesBoxes = true;                       // all broadphases see the same boxes in a frame
    std::optional<int> frameLimit = std::nullopt;  // how many frames there are
    GroundHeight ground = {};                      // under the objects, within the bounds
};

class Trial {
public:
    explicit Trial(const TrialFacts& itsFacts) : facts(itsFacts) {}
    Trial(const Trial&) = delete;
    Trial& operator=(const Trial&) = delete;
    virtual ~Trial() = default;

    /// Makes the broadphase, the next contestant, and fills it with the scene's objects. Returns the
    /// time of that alone [ms]; nothing where it was to stop: then it is no contestant.
    virtual std::optional<double> add(const BroadphaseKind& kind, const GoOn& goOn) = 0;

    /// Moves on to the next frame; the first call shows the initial state.
    virtual void beginFrame() = 0;

    /// Lets the broadphase that was added as number `contestant` do its frame.
    virtual Observation runFrame(std::size_t contestant) = 0;

    /// Destroys `count` objects of this broadphase, spread over all, and returns the time [ms];
    /// nothing where the trial cannot tell, or was to stop. For after the last frame.
    virtual std::optional<double> removeObjects(std::size_t contestant, std::size_t count,
                                                const GoOn& goOn) = 0;

    /// Heap that the broadphase took so far [bytes], where that can be told.
    [[nodiscard]] virtual std::optional<std::int64_t> memoryBytes(std::size_t contestant) const = 0;

    /// The same scene from its beginning, to be filled again, whose frames are profiled and not verified; null
    /// where there is no simulation step.
    [[nodiscard]] virtual std::unique_ptr<Trial> profiled() const { return nullptr; }

    const TrialFacts facts;
};

/// Broadphases alone on a scene of moving boxes: in every frame each gets setAabb for all boxes, then
/// calculateOverlappingPairs.
[[nodiscard]] std::unique_ptr<Trial> boxTrial(std::unique_ptr<BoxScene> scene,
                                              ReferenceMethod reference);

/// Fills a world, always with the same contents.
using FillWorld = std::function<void(WorldContents&)>;

/// Broadphases at work in Bullet worlds: each gets a world of its own with the same contents, stepped at
/// 1/60 s. The worlds part company with time, so each broadphase is judged by the boxes of its own. Filling
/// takes the time of the broadphase, and of the boxes of what is put into it: nothing else of the world's;
/// nothing can be told of removal. Makes one world to learn its size, and tells how far that is. Throws what
/// `fill` throws.
[[nodiscard]] std::unique_ptr<Trial> worldTrial(FillWorld fill, ReferenceMethod reference,
                                                const TellWaiting& tell = {});

/// Replaces `pairs` by what the cache lists, sorted; `objectOf` tells a proxy's object number.
template <class ObjectOf>
void listPairs(btOverlappingPairCache& cache, const ObjectOf& objectOf,
               std::vector<PairKey>& pairs) {
    pairs.clear();
    const int count = cache.getNumOverlappingPairs();
    const btBroadphasePair* listed = count > 0 ? cache.getOverlappingPairArrayPtr() : nullptr;
    for (int i = 0; i < count; ++i) {
        pairs.push_back(pairKey(objectOf(*listed[i].m_pProxy0), objectOf(*listed[i].m_pProxy1)));
    }
    std::sort(pairs.begin(), pairs.end());
}

}  // namespace hashphase::demos
