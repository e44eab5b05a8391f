// SPDX-License-Identifier: Zlib
#pragma once

// Whoever keeps the pairs of a scene's boxes: ours, Bullet's broadphases, and those of other
// libraries, behind one interface.
//
// A frame  setAll(), then findPairs(); both are timed; then the complete set of pairs is there.
// Objects  are numbered by their place in the scene.

#include <demos/compare/filled_broadphase.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace hashphase::benchmarks {

/// How far an object moves during a frame, for those who look for what it passes.
struct ObjectMotion {
    std::uint32_t object = 0;
    Vector3<float> displacement;  // [m]
};

/// The boxes of a frame, in the forms in which broadphases take them.
struct FrameBoxes {
    std::span<const Aabb<float>> boxes;
    std::span<const demos::BulletBox> bulletBoxes;    // the same
    std::span<const demos::CollisionFilter> filters;  // empty: all may pair
    std::span<const btVector3> bulletMins = {};       // the same boxes once more
    std::span<const btVector3> bulletMaxs = {};
    std::span<const ObjectMotion> motions = {};  // of those that sweep

    [[nodiscard]] demos::CollisionFilter filterOf(std::size_t object) const {
        return filters.empty() ? demos::CollisionFilter{} : filters[object];
    }
    [[nodiscard]] bool mayPair(std::uint32_t a, std::uint32_t b) const {
        return filters.empty() || demos::mayPair(filters[a], filters[b]);
    }
};

/// What a broadphase of ours says that it holds [bytes].
struct OwnBytes {
    std::size_t forObjects = 0;
    std::size_t forPairs = 0;
};

/// What is used through a base class.
class Interface {
public:
    Interface() = default;
    Interface(const Interface&) = delete;
    Interface& operator=(const Interface&) = delete;
    virtual ~Interface() = default;
};

class Contestant : public Interface {
public:
    /// Takes in all objects, once, into the empty structure.
    virtual void fill(const FrameBoxes& frame) = 0;

    virtual void setAll(const FrameBoxes& frame) = 0;
    virtual void findPairs() = 0;

    /// Called after every frame, outside of the timing.
    virtual void afterFrame() {}

    /// Replaces `pairs` by what was found, in any order; what was reported twice is listed twice.
    virtual void listPairs(std::vector<demos::PairKey>& pairs) = 0;

    /// Objects come and go, and some alone are set, where the kind `changes`.
    virtual void add(std::span<const std::uint32_t> /*objects*/, const FrameBoxes& /*frame*/) {}
    virtual void remove(std::span<const std::uint32_t> /*objects*/) {}
    virtual void set(std::span<const std::uint32_t> /*objects*/, const FrameBoxes& /*frame*/) {}

    [[nodiscard]] virtual std::optional<OwnBytes> ownBytes() const { return std::nullopt; }
};

constexpr std::size_t kAnyNumber = std::numeric_limits<std::size_t>::max();

struct ContestantKind {
    std::string name = {};
    std::string title = {};              // the class, for readers
    std::string description = {};        // for the list of contestants
    std::string package = "this build";  // where it comes from, with its version
    bool ours = false;                   // a wrong answer of it fails the run
    bool changes = false;                // takes in, sets and removes single objects at any time
    bool inBatches = false;  // ours, when they come and go in batches: measured where they do
    bool onThreads = false;  // measured on the wall clock, on request
    std::size_t upTo = kAnyNumber;       // objects; else too slow
    std::size_t fillsUpTo = kAnyNumber;  // objects; else too slow
    std::function<std::unique_ptr<Contestant>(const demos::BroadphaseNeeds&)> make =
        {};                                         // of pairs
    const demos::BroadphaseKind* bullet = nullptr;  // where it is one of Bullet's kind
};

/// A broadphase of Bullet's kind, pair cache included. `bullet` must outlive what this returns.
[[nodiscard]] ContestantKind bulletKind(const demos::BroadphaseKind& bullet,
                                        bool inBatches = false);

/// Everything that this build can measure: ours, Bullet's, then the libraries found.
[[nodiscard]] const std::vector<ContestantKind>& contestantKinds();

/// By name, which must be one of contestantKinds().
[[nodiscard]] const ContestantKind& contestantKind(std::string_view name);

/// The contestant against which all ratios are taken.
inline constexpr std::string_view kBaseline = "dbvt";

}  // namespace hashphase::benchmarks
