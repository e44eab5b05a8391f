// SPDX-License-Identifier: Zlib
#include <demos/accuracy/culling_experiment.hpp>

#include <demos/accuracy/exact_frustum.hpp>
#include <demos/accuracy/timing.hpp>

namespace hashphase::demos {
namespace {

struct Entry {
    CullingRow row;
    std::unique_ptr<Culling> culling;
};

/// Which of the boxes are visible; 1 or 0.
std::vector<std::uint8_t> visibleOf(std::span<const Aabb<float>> boxes, const CameraView& view) {
    const ExactFrustum truth(view);
    std::vector<std::uint8_t> isVisible;
    for (const Aabb<float>& box : boxes) {
        isVisible.push_back(truth.sees(box) ? 1 : 0);
    }
    return isVisible;
}

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
    for (int i = 0; i < flights; ++i) {
        for (const CameraView& view : flight(setting, random)) {
            const std::vector<std::uint8_t> isVisible = visibleOf(boxes, view);
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

std::vector<CullingRow> countTouching(const CullingPlan& plan, std::uint64_t seed,
                                      std::span<const CullingMethod> methods,
                                      const CullingSetting& setting) {
    std::vector<CullingRow> rows;
    for (const CullingMethod& method : methods) {
        rows.push_back({&method, &setting, {}});
    }
    Random random(seed);
    for (int i = 0; i < plan.flights; ++i) {
        for (const CameraView& view : flight(setting, random)) {
            const std::vector<Aabb<float>> boxes =
                touchingBoxes(plan.touching, setting.tallest, view, random);
            const std::vector<std::uint8_t> isVisible = visibleOf(boxes, view);
            for (CullingRow& row : rows) {
                Entry entry{row, row.method->make({boxes, setting.tallest, setting.cellSize})};
                look(entry, view, isVisible);
                row = entry.row;
            }
        }
    }
    return rows;
}

}  // namespace

CullingMeasurement measureCulling(const CullingPlan& plan, std::uint64_t seed,
                                  std::span<const CullingMethod> methods,
                                  std::span<const CullingSetting> settings,
                                  const TellProgress& tell) {
    std::vector<Entry> timed;
    CullingMeasurement measured;
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
                measured.rows.push_back(entry.row);
            }
        }
    }
    tell(0.7, "times");
    time(timed, first, plan.frames, seed + 2);
    for (const Entry& entry : timed) {
        measured.rows.push_back(entry.row);
    }
    measured.touching = countTouching(plan, seed + 3, methods, first);
    return measured;
}

}  // namespace hashphase::demos
