// SPDX-License-Identifier: Zlib
#pragma once

// Recordings for the tests of replays: boxes that drift, and what two broadphases list of them.

#include <demos/compare/reference_pairs.hpp>
#include <demos/replay/replay_recording.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace hashphase::demos {

using FrameBoxes = std::vector<Aabb<float>>;

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kEndless = std::numeric_limits<float>::infinity();
inline const Aabb<float> kTenMetres(Vector3<float>::Zero(), Vector3<float>::Constant(10));

/// So many boxes of about a metre in a cube, of which every other one drifts from frame to frame.
inline std::vector<FrameBoxes> driftingFrames(std::size_t objects, std::size_t frames) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(0, 8);
    std::uniform_real_distribution<float> step(-0.2F, 0.2F);
    const auto vector = [&random](auto& numbers) {
        const float x = numbers(random);
        const float y = numbers(random);
        return Vector3<float>(x, y, numbers(random));
    };
    FrameBoxes boxes;
    for (std::size_t i = 0; i < objects; ++i) {
        const Vector3<float> low = vector(place);
        boxes.emplace_back(low, low + Vector3<float>(1, 1.25F, 0.75F));
    }
    std::vector<FrameBoxes> all;
    for (std::size_t frame = 0; frame < frames; ++frame) {
        all.push_back(boxes);
        for (std::size_t i = 0; i < objects; i += 2) {
            boxes[i].translate(vector(step));
        }
    }
    return all;
}

/// All pairs that overlap, sorted.
inline std::vector<PairKey> overlappingPairs(const FrameBoxes& boxes) {
    std::vector<PairKey> pairs;
    findExactPairs(ReferenceMethod::kBrute, boxes, {}, pairs);
    return pairs;
}

inline ReplaySettings replaySettings() {
    ReplaySettings settings;
    settings.scene = "a test";
    settings.broadphases = {"right", "wrong"};
    return settings;
}

/// Records the frames until the recording is full; "wrong" misses the first pair from frame 2 on.
inline ReplayRecording recorded(ReplaySettings settings, const std::vector<FrameBoxes>& frames) {
    ReplayRecording recording(std::move(settings));
    for (std::size_t frame = 0; frame < frames.size() && !recording.isFull(); ++frame) {
        const std::vector<PairKey> exact = overlappingPairs(frames[frame]);
        recording.add(0, {frames[frame], exact, {}, {}});
        const std::size_t missed = frame < 2 || exact.empty() ? 0 : 1;
        recording.add(1, {frames[frame], exact, std::span(exact).first(missed), {}});
        recording.finishFrame();
    }
    return recording;
}

/// From 20 to 29 m between x = 0 and 10.
inline float heightOfSlope(float x, float /*z*/) {
    return 20 + 0.9F * x;
}

inline std::vector<std::uint32_t> firstNumbers(std::size_t count) {
    std::vector<std::uint32_t> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0U);
    return numbers;
}

}  // namespace hashphase::demos
