// SPDX-License-Identifier: Zlib
#include <demos/accuracy/culling/culling_experiment.hpp>

#include <demos/accuracy/culling/culling_scenes.hpp>
#include <demos/accuracy/culling/exact_frustum.hpp>
#include <demos/accuracy/experiments.hpp>
#include <demos/accuracy/timing.hpp>

namespace hashphase::demos {
namespace {

constexpr std::string_view kCullingDeclaration =
#include <demos/accuracy/culling/culling.sql>
    ;

/// A method at work on the scene of a setting.
struct Look {
    const CullingMethod* method;
    const CullingSetting* setting;
    std::unique_ptr<Culling> culling;
};

std::vector<Look> looksAt(const CullingSetting& setting, std::span<const Aabb<float>> boxes,
                          std::span<const CullingMethod> methods, bool cellsMatterOnly) {
    std::vector<Look> looks;
    for (const CullingMethod& method : methods) {
        if (method.takesCells || !cellsMatterOnly) {
            looks.push_back(
                {&method, &setting, method.make({boxes, setting.tallest, setting.cellSize})});
        }
    }
    return looks;
}

/// Has all of them look at the boxes, and counts what they get wrong.
void judge(std::span<const Look> looks, std::string_view scene, const CameraView& view,
           std::span<const Aabb<float>> boxes, Measurements& measured) {
    const ExactFrustum truth(view);
    std::vector<bool> isVisible;
    for (const Aabb<float>& box : boxes) {
        isVisible.push_back(truth.sees(box));
    }
    for (const auto& [method, setting, culling] : looks) {
        const CullingCost cost = culling->look(view);
        int visible = 0;
        int lost = 0;
        int inVain = 0;
        for (std::uint32_t object = 0; object < boxes.size(); ++object) {
            const bool isDrawn = culling->draws(object);
            visible += isVisible[object] ? 1 : 0;
            lost += isVisible[object] && !isDrawn ? 1 : 0;
            inVain += isDrawn && !isVisible[object] ? 1 : 0;
        }
        measured.add("looks", {{"scene", scene},
                               {"setting", setting->name},
                               {"cell", setting->cellSize},
                               {"method", method->name},
                               {"visible", visible},
                               {"lost", lost},
                               {"in_vain", inVain},
                               {"cells", cost.cells},
                               {"boxes", cost.boxes}});
    }
}

void time(std::span<const Look> looks, const CullingSetting& setting, int frames,
          std::uint64_t seed, Measurements& measured) {
    constexpr int warmUp = 3;
    Random random(seed);
    std::vector<CameraView> views;
    std::vector<std::function<void()>> runs;
    for (const Look& look : looks) {
        runs.emplace_back([&views, &culling = *look.culling] {
            for (const CameraView& view : views) {
                culling.look(view);
            }
        });
    }
    const auto times = timesInTurn(
        frames, warmUp, [&](int) { views = flight(setting, random); }, runs);
    for (std::size_t i = 0; i < looks.size(); ++i) {
        for (const double milliseconds : times[i]) {
            measured.add("times", {{"setting", looks[i].setting->name},
                                   {"method", looks[i].method->name},
                                   {"us", milliseconds * 1000 / kViewsPerFlight}});
        }
    }
}

// Whether the settings differ in nothing but the cell size.
bool isSameView(const CullingSetting& a, const CullingSetting& b) {
    return a.fieldOfView == b.fieldOfView && a.pitch == b.pitch && a.yaw == b.yaw &&
           a.tallest == b.tallest;
}

/// One factor after another around the first setting.
std::vector<CullingSetting> cullingSettings() {
    std::vector<CullingSetting> settings{{"as stated"}};
    const auto vary = [&](std::string_view what, float CullingSetting::*member,
                          std::string_view unit, std::initializer_list<float> values) {
        for (const float value : values) {
            CullingSetting setting;
            setting.name =
                std::string(what) + ' ' + valueText(static_cast<double>(value)) + std::string(unit);
            setting.*member = value;
            settings.push_back(setting);
        }
    };
    vary("field of view", &CullingSetting::fieldOfView, " deg", {30, 90, 120});
    vary("pitch", &CullingSetting::pitch, " deg", {-90, -70, -20, 0});
    vary("yaw", &CullingSetting::yaw, " deg", {0, 45});
    vary("objects up to", &CullingSetting::tallest, " m", {1, 40});
    vary("cells", &CullingSetting::cellSize, " m", {5, 25, 50, 100});
    CullingSetting best;  // for the paper's camera from above
    best.name = "straight down, yaw 0, 1 m";
    best.pitch = -90;
    best.yaw = 0;
    best.tallest = 1;
    settings.push_back(best);
    return settings;
}

void judgeTouching(const CullingPlan& plan, const CullingSetting& setting, std::uint64_t seed,
                   std::span<const CullingMethod> methods, Measurements& measured) {
    Random random(seed);
    for (int i = 0; i < plan.flights; ++i) {
        for (const CameraView& view : flight(setting, random)) {
            const std::vector<Aabb<float>> boxes =
                touchingBoxes(plan.touching, setting.tallest, view, random);
            judge(looksAt(setting, boxes, methods, false), "touching", view, boxes, measured);
        }
    }
}

}  // namespace

Findings findCulling(const CullingPlan& plan, std::uint64_t seed,
                     std::span<const CullingMethod> methods, const TellProgress& tell) {
    Measurements measured;
    measured.add("plan", {{"objects", plan.objects}, {"seed", seed}});
    for (const CullingMethod& method : methods) {
        measured.add("methods", {{"number", &method - methods.data()},
                                 {"method", method.name},
                                 {"ours", method.isOurs},
                                 {"must_see_all", method.mustSeeAll},
                                 {"must_be_exact", method.mustBeExact},
                                 {"takes_cells", method.takesCells}});
    }
    const std::vector<CullingSetting> settings = cullingSettings();
    const CullingSetting& first = settings.front();
    std::vector<std::vector<Aabb<float>>> scenes;  // methods go on reading what they have filed
    std::vector<Look> timed;
    for (const CullingSetting& setting : settings) {
        constexpr double share = 0.7;  // of all the time
        tell(share * static_cast<double>(scenes.size()) / static_cast<double>(settings.size()),
             setting.name);
        scenes.push_back(standingBoxes(plan.objects, setting.tallest, seed));
        const bool isFirstView = isSameView(setting, first);
        std::vector<Look> looks =
            looksAt(setting, scenes.back(), methods, isFirstView && &setting != &first);
        Random random(seed + 1);
        for (int i = 0; i < plan.flights; ++i) {
            for (const CameraView& view : flight(setting, random)) {
                judge(looks, "ground", view, scenes.back(), measured);
            }
        }
        if (isFirstView) {
            std::move(looks.begin(), looks.end(), std::back_inserter(timed));
        }
    }
    time(timed, first, plan.frames, seed + 2, measured);
    judgeTouching(plan, first, seed + 3, methods, measured);
    return findingsOf(kCullingDeclaration, measured);
}

Experiment cullingExperiment() {
    return {"P4",
            "Culling",
            "How many visible objects are lost, and how many are drawn in vain?",
            3,
            20,
            [](const Effort& effort, const TellProgress& tell) {
                const CullingPlan plan{effort.quickOrFull<std::size_t>(20'000, 50'000), 1000,
                                       effort.quickOrFull(1, 8),
                                       effort.quickOrFull(kFewestFrames, 2 * kFewestFrames)};
                return findCulling(plan, effort.seed, cullingMethods(), tell);
            }};
}

}  // namespace hashphase::demos
