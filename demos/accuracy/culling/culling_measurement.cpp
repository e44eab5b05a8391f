// SPDX-License-Identifier: Zlib
#include <demos/accuracy/culling/culling_experiment.hpp>

#include <demos/accuracy/culling/exact_frustum.hpp>
#include <demos/accuracy/timing.hpp>

#include <algorithm>

namespace hashphase::demos {
namespace {

struct Entry {
    CullingRow row;
    std::unique_ptr<Culling> culling;
};

std::vector<Entry> entriesFor(const CullingSetting& setting, std::span<const Aabb<float>> boxes,
                              std::span<const CullingMethod> methods, bool cellsMatterOnly) {
    std::vector<Entry> entries;
    for (const CullingMethod& method : methods) {
        if (method.takesCells || !cellsMatterOnly) {
            entries.push_back(
                {{&method, &setting, {}}, method.make({boxes, setting.tallest, setting.cellSize})});
        }
    }
    return entries;
}

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
    const CullingSetting& first = settings.front();
    std::vector<std::vector<Aabb<float>>> scenes;  // methods go on reading what they have filed
    std::vector<Entry> timed;
    CullingMeasurement measured;
    for (const CullingSetting& setting : settings) {
        constexpr double share = 0.7;  // of all the time
        tell(share * static_cast<double>(scenes.size()) / static_cast<double>(settings.size()),
             setting.name);
        scenes.push_back(standingBoxes(plan.objects, setting.tallest, seed));
        const bool isFirstView = isSameView(setting, first);
        const bool cellsMatterOnly = isFirstView && &setting != &first;
        std::vector<Entry> entries = entriesFor(setting, scenes.back(), methods, cellsMatterOnly);
        count(entries, setting, scenes.back(), plan.flights, seed + 1);
        for (Entry& entry : entries) {
            if (isFirstView) {
                timed.push_back(std::move(entry));
            } else {
                measured.rows.push_back(entry.row);
            }
        }
    }
    time(timed, first, plan.frames, seed + 2);
    for (const Entry& entry : timed) {
        measured.rows.push_back(entry.row);
    }
    std::stable_sort(
        measured.rows.begin(), measured.rows.end(),
        [](const CullingRow& a, const CullingRow& b) { return a.setting < b.setting; });
    measured.touching = countTouching(plan, seed + 3, methods, first);
    return measured;
}

}  // namespace hashphase::demos
