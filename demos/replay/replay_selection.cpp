// SPDX-License-Identifier: Zlib
#include <demos/replay/replay_recording.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace hashphase::demos {
namespace {

using Numbers = std::vector<float>;

/// Larger numbers would overflow where they are added to each other.
constexpr float kFarthest = 1e30F;

float bounded(float number) {
    return std::isnan(number) ? 0 : std::clamp(number, -kFarthest, kFarthest);
}

Numbers centresAlong(int axis, std::span<const Aabb<float>> boxes,
                     std::span<const std::uint32_t> objects) {
    Numbers centres;
    centres.reserve(objects.size());
    for (const std::uint32_t object : objects) {
        const Aabb<float>& box = boxes[object];
        centres.push_back((bounded(box.min()[axis]) + bounded(box.max()[axis])) / 2);
    }
    return centres;
}

/// The number below which that share of them lies.
float quantile(Numbers numbers, double share) {
    const auto place =
        static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(numbers.size() - 1)));
    std::nth_element(numbers.begin(), numbers.begin() + place, numbers.end());
    return numbers[static_cast<std::size_t>(place)];
}

void keepThoseAroundTheMiddle(std::span<const Aabb<float>> boxes, std::size_t most,
                              std::vector<std::uint32_t>& objects) {
    const Numbers x = centresAlong(0, boxes, objects);
    const Numbers z = centresAlong(2, boxes, objects);
    const float middleX = quantile(x, 0.5);
    const float middleZ = quantile(z, 0.5);
    const auto fromMiddle = [&](std::uint32_t object) {
        return std::max(std::abs(x[object] - middleX), std::abs(z[object] - middleZ));
    };
    const auto end = objects.begin() + static_cast<std::ptrdiff_t>(most);
    std::nth_element(objects.begin(), end, objects.end(), [&](std::uint32_t a, std::uint32_t b) {
        return fromMiddle(a) < fromMiddle(b);
    });
    objects.erase(end, objects.end());
    std::sort(objects.begin(), objects.end());
}

float typicalEdgeOf(std::span<const Aabb<float>> boxes, std::span<const std::uint32_t> objects) {
    Numbers edges;
    for (const std::uint32_t object : objects) {
        float longest = 0;
        for (int axis = 0; axis < 3; ++axis) {
            longest = std::max(
                longest, bounded(boxes[object].max()[axis]) - bounded(boxes[object].min()[axis]));
        }
        edges.push_back(longest);
    }
    const float median = quantile(std::move(edges), 0.5);
    return median > 0 ? median : 1;
}

Aabb<float> boundsAround(std::span<const Aabb<float>> boxes, std::span<const std::uint32_t> objects,
                         float edge, const Aabb<float>& world) {
    Aabb<float> bounds;
    for (int axis = 0; axis < 3; ++axis) {
        const Numbers centres = centresAlong(axis, boxes, objects);
        bounds.min()[axis] = quantile(centres, 0.01) - edge;
        bounds.max()[axis] = quantile(centres, 0.99) + edge;
    }
    // As much on every side as what is there now is long, and a half: objects move.
    const float room = 1.5F * bounds.sizes().maxCoeff();
    for (int axis = 0; axis < 3; ++axis) {
        const float low = bounds.min()[axis] - room;
        const float high = bounds.max()[axis] + room;
        // The world's own end is nearer, unless it leaves out what is there.
        const float worldLow = world.min()[axis];
        const float worldHigh = world.max()[axis];
        bounds.min()[axis] = worldLow > low && worldLow < high ? worldLow : low;
        bounds.max()[axis] = worldHigh < high && worldHigh > bounds.min()[axis] ? worldHigh : high;
    }
    return bounds;
}

}  // namespace

ReplaySelection selectForReplay(std::span<const Aabb<float>> boxes, const Aabb<float>& world,
                                std::size_t most) {
    ReplaySelection selection;
    selection.objects.resize(boxes.size());
    std::iota(selection.objects.begin(), selection.objects.end(), 0U);
    if (boxes.size() > most) {
        keepThoseAroundTheMiddle(boxes, most, selection.objects);
    }
    if (selection.objects.empty()) {
        selection.bounds = {Vector3<float>::Zero(), Vector3<float>::Zero()};
        return selection;
    }
    selection.typicalEdge = typicalEdgeOf(boxes, selection.objects);
    selection.bounds = boundsAround(boxes, selection.objects, selection.typicalEdge, world);
    return selection;
}

}  // namespace hashphase::demos
