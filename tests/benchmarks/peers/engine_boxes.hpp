// SPDX-License-Identifier: Zlib
#pragma once

// The broadphase of a whole engine over boxes, in plain types.
//
// An engine is compiled with vector instructions of its own and without run-time types, and so is the file
// that includes its headers. What such a file emits must serve no other one: it names no type of ours but
// these, and shares no inline function.

#include <cstddef>
#include <cstdint>

namespace hashphase::benchmarks {

struct EngineScene {
    const float* boxes;              // by object, six floats each: min x, y, z, max x, y, z
    const unsigned char* areStatic;  // by object; two static ones never pair
    std::size_t objects;
    float bounds[6];  // a box that no box of any frame leaves
};

struct EngineVersion {
    int numbers[3];
};

class EngineBoxes {
public:
    virtual ~EngineBoxes();

    /// Takes the boxes of all objects, and tells the engine of those that changed.
    virtual void set(const float* boxes) = 0;
    virtual void findPairs() = 0;

    /// The complete set as of findPairs(), one object in the upper half and the other in the lower.
    [[nodiscard]] virtual const std::uint64_t* pairs() const = 0;
    [[nodiscard]] virtual std::size_t pairCount() const = 0;
};

/// With a body for each object. Throws std::runtime_error if Jolt was compiled with other settings than
/// its CMake package says.
[[nodiscard]] EngineBoxes* makeJoltBoxes(const EngineScene& scene);
[[nodiscard]] EngineVersion joltVersion();

[[nodiscard]] EngineBoxes* makePhysxAutomaticBoxes(const EngineScene& scene);
[[nodiscard]] EngineBoxes* makePhysxRegionBoxes(const EngineScene& scene);
[[nodiscard]] EngineVersion physxVersion();

}  // namespace hashphase::benchmarks
