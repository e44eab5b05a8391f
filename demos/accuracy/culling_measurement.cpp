// SPDX-License-Identifier: Zlib
#include <demos/accuracy/culling_experiment.hpp>

#include <demos/accuracy/exact_frustum.hpp>
#include <demos/accuracy/timing.hpp>
#include <demos/scenes/random.hpp>

#include <numbers>

namespace hashphase::demos {
namespace {

constexpr float kSide = 1000;      // of the ground [m]
constexpr float kEyeHeight = 120;  // [m]
constexpr float kDegree = std::numbers::pi_v<float> / 180;

// In a 60th of a second, at 6 m/s and 12 degrees a second.
constexpr float kStride = 0.1F;          // [m]
constexpr float kTurn = 0.2F * kDegree;  // [rad]

/// Boxes of 1 to 3 m on the ground, up to `tallest` high.
std::vector<Aabb<float>> standingBoxes(std::size_t count, float tallest, std::uint64_t seed) {
    Random random(seed);
    std::vector<Aabb<float>> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        const Vector3<float> low{random.between(0, kSide), 0, random.between(0, kSide)};
        const Vector3<float> size{random.between(1, 3), tallest * random.between(0.1F, 1),
                                  random.between(1, 3)};
        boxes.emplace_back(low, low + size);
    }
    return boxes;
}

/// A camera that flies straight on from a random place and turns a little.
std::vector<CameraView> flight(const CullingSetting& setting, Random& random) {
    CameraPose pose;
    pose.eye = {random.between(0.3F, 0.7F) * kSide, kEyeHeight, random.between(0.3F, 0.7F) * kSide};
    pose.yaw = setting.yaw * kDegree;
    pose.pitch = setting.pitch * kDegree;
    pose.fieldOfView = setting.fieldOfView * kDegree;
    std::vector<CameraView> views;
    for (int i = 0; i < kViewsPerFlight; ++i) {
        views.push_back(cameraView(pose));
        pose.eye.x() += kStride;
        pose.yaw += kTurn;
    }
    return views;
}

struct Entry {
    CullingRow row;
    std::unique_ptr<Culling> culling;
};

void look(Entry& entry, const CameraView& view, std::span<const std::uint8_t> isVisible) {
    const CullingCost cost = entry.culling->look(view);
    CullingTally& tally = entry.row.tally;
    tally.cost.cells += cost.cells;
    tally.cost.boxes += cost.boxes;
    ++tally.views;
    for (std::uint32_t object = 0; object < isVisible.size(); ++object) {
        const bool isDrawn = entry.culling->draws(object);
        const bool isSeen = isVisible[object] != 0;
        tally.visible += isSeen ? 1 : 0;
        tally.lost += isSeen && !isDrawn ? 1 : 0;
        tally.inVain += isDrawn && !isSeen ? 1 : 0;
    }
}

void count(std::span<Entry> entries, const CullingSetting& setting,
           std::span<const Aabb<float>> boxes, int flights, std::uint64_t seed) {
    Random random(seed);
    std::vector<std::uint8_t> isVisible(boxes.size());
    for (int i = 0; i < flights; ++i) {
        for (const CameraView& view : flight(setting, random)) {
            const ExactFrustum truth(view);
            for (std::size_t object = 0; object < boxes.size(); ++object) {
                isVisible[object] = truth.sees(boxes[object]) ? 1 : 0;
            }
            for (Entry& entry : entries) {
                look(entry, view, isVisible);
            }
        }
    }
}

void time(std::span<Entry> entries, const CullingSetting& setting, int frames, std::uint64_t seed) {
    constexpr int warmUp = 3;
    Random random(seed);
    std::vector<CameraView> views;
    std::vector<std::function<void()>> looks;
    for (Entry& entry : entries) {
        looks.emplace_back([&views, &culling = *entry.culling] {
            for (const CameraView& view : views) {
                culling.look(view);
            }
        });
    }
    const std::vector<Spread> times = timeInTurn(
        frames, warmUp, [&](int) { views = flight(setting, random); }, looks);
    for (std::size_t i = 0; i < entries.size(); ++i) {
        constexpr double share = 1000.0 / kViewsPerFlight;  // of a flight's milliseconds
        entries[i].row.isTimed = true;
        entries[i].row.microseconds = {times[i].median * share, times[i].low * share,
                                       times[i].high * share};
    }
}

// Whether the settings differ in nothing but the cell size.
bool isSameView(const CullingSetting& a, const CullingSetting& b) {
    return a.fieldOfView == b.fieldOfView && a.pitch == b.pitch && a.yaw == b.yaw &&
           a.tallest == b.tallest;
}

}  // namespace

std::vector<CullingRow> measureCulling(const CullingPlan& plan, std::uint64_t seed,
                                       std::span<const CullingMethod> methods,
                                       std::span<const CullingSetting> settings,
                                       const TellProgress& tell) {
    std::vector<Entry> timed;
    std::vector<CullingRow> rows;
    const CullingSetting& first = settings.front();
    const std::vector<Aabb<float>> firstBoxes = standingBoxes(plan.objects, first.tallest, seed);
    for (std::size_t i = 0; i < settings.size(); ++i) {
        const CullingSetting& setting = settings[i];
        tell(0.7 * static_cast<double>(i) / static_cast<double>(settings.size()), setting.name);
        const bool isFirstView = isSameView(setting, first);
        const std::vector<Aabb<float>> boxes =
            isFirstView ? std::vector<Aabb<float>>()
                        : standingBoxes(plan.objects, setting.tallest, seed);
        const std::span<const Aabb<float>> standing = isFirstView ? firstBoxes : boxes;
        std::vector<Entry> entries;
        for (const CullingMethod& method : methods) {
            if (i == 0 || !isFirstView || method.takesCells) {
                entries.push_back({{&method, &setting, {}},
                                   method.make({standing, setting.tallest, setting.cellSize})});
            }
        }
        count(entries, setting, standing, plan.flights, seed + 1);
        for (Entry& entry : entries) {
            if (isFirstView) {
                timed.push_back(std::move(entry));
            } else {
                rows.push_back(entry.row);
            }
        }
    }
    tell(0.7, "times");
    time(timed, first, plan.frames, seed + 2);
    for (const Entry& entry : timed) {
        rows.push_back(entry.row);
    }
    return rows;
}

}  // namespace hashphase::demos
