// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/scene_choice.hpp>

#include <demos/console/format.hpp>
#include <demos/scenes/file_bytes.hpp>
#include <demos/viewer/stage/bullet_stage.hpp>
#include <demos/viewer/stage/paper_stage.hpp>
#include <demos/viewer/stage/recording_stage.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace hashphase::demos {
namespace {

constexpr std::size_t kWanderers = 30'000;

// The paper's test bed, with all that its authors showed. Of more than kWanderers the domain grows, and its
// ground with it, so that they stay as dense, as in `hashphase paper`.
EffectsFile wanderers(std::size_t objects) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const double growth = std::sqrt(std::max(1.0, static_cast<double>(objects) / kWanderers));
    const double domain = 400 * growth;
    EffectsFile file;
    file.scene.objects = static_cast<std::uint32_t>(objects);
    file.scene.domain = domain;
    file.scene.terrain = static_cast<std::uint32_t>(std::lround(64 * growth));
    file.scene.zones = 20;
    file.effects =
        effectsOf({Effect::motion, Effect::terrain, Effect::pairs, Effect::response,
                   Effect::picking, Effect::boxSelection, Effect::culling, Effect::proximity});
    file.effects.motion->bounds = {Vector3<double>(1, -infinity, 1),
                                   Vector3<double>(domain - 1, infinity, domain - 1)};
    file.effects.response->restitution = 0.9;
    file.effects.proximity->radius = 5;
    file.effects.proximity->turns = 30;  // else whole regions would flicker
    return file;
}

std::unique_ptr<Stage> makePaperStage(EffectsFile file, const SceneChoice& choice) {
    if (choice.objects) {
        file.scene.objects = static_cast<std::uint32_t>(*choice.objects);
    }
    file.scene.seed = static_cast<std::uint32_t>(choice.seed);
    try {
        return std::make_unique<PaperStage>(file);
    } catch (const std::invalid_argument& error) {
        throw InputError(titleOf(choice) + ": " + error.what());
    }
}

std::unique_ptr<Stage> openFile(const SceneChoice& choice) {
    if (isBoxRecording(choice)) {
        return std::make_unique<RecordingStage>(choice.file, choice.objects.value_or(0));
    }
    if (hasExtension(choice.file, ".json")) {
        return makePaperStage(readEffectsFile(choice.file), choice);
    }
    throw InputError(choice.file +
                     " is neither a scene file (.json) nor a recording of boxes (.aabbs).");
}

}  // namespace

std::span<const ViewerScene> viewerScenes() {
    static const std::vector<ViewerScene> scenes = [] {
        std::vector<ViewerScene> all{
            {"wander", "the paper's test bed: spheres that roam a random terrain", kWanderers,
             [](const SceneChoice& choice, std::size_t objects) {
                 return makePaperStage(wanderers(objects), choice);
             }}};
        for (const WorldSceneKind& kind : worldSceneKinds()) {
            all.push_back({std::string(kind.name), std::string(kind.description),
                           kind.defaultObjects,
                           [&kind](const SceneChoice& choice, std::size_t objects) {
                               return std::make_unique<BulletStage>(kind, objects, choice.seed);
                           }});
        }
        return all;
    }();
    return scenes;
}

const std::string& titleOf(const SceneChoice& choice) {
    return choice.file.empty() ? choice.name : choice.file;
}

bool isBoxRecording(const SceneChoice& choice) {
    return hasExtension(choice.file, ".aabbs");
}

std::uint64_t ownSeed(const SceneChoice& choice) {
    return hasExtension(choice.file, ".json") ? readEffectsFile(choice.file).scene.seed
                                              : SceneChoice().seed;
}

std::size_t objectCount(const SceneChoice& choice) {
    const auto scene = std::ranges::find(viewerScenes(), choice.name, &ViewerScene::name);
    return choice.objects.value_or(scene != viewerScenes().end() ? scene->objects : 0);
}

std::unique_ptr<Stage> makeStage(const SceneChoice& choice) {
    if (choice.objects && (*choice.objects < 1 || *choice.objects > kMostObjects)) {
        throw InputError("A scene has 1 to " + withThousands(kMostObjects) + " objects, not " +
                         withThousands(*choice.objects) + ".");
    }
    if (!choice.file.empty()) {
        return openFile(choice);
    }
    return rowNamed("scene", choice.name, viewerScenes()).make(choice, objectCount(choice));
}

}  // namespace hashphase::demos
