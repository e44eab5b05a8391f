// SPDX-License-Identifier: Zlib
#include <demos/compare/open_trial.hpp>

#include <demos/console/format.hpp>
#include <demos/scenes/bullet_world_file.hpp>
#include <demos/scenes/file_bytes.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/scenes/recording_scene.hpp>
#include <demos/scenes/text_boxes.hpp>
#include <demos/scenes/world_scenes.hpp>

#include <algorithm>
#include <utility>

namespace hashphase::demos {
namespace {

constexpr std::size_t kQuickObjects = 10'000;

OpenedTrial openScene(const CompareOptions& options, const TellWaiting& tell) {
    std::vector<std::string> names;
    const auto objectsOf = [&options](std::size_t usual) {
        return options.objects.value_or(options.isQuick ? std::min(usual, kQuickObjects) : usual);
    };
    for (const BoxSceneKind& kind : boxSceneKinds()) {
        if (kind.name == options.scene) {
            auto scene = kind.make(objectsOf(kind.defaultObjects), options.sceneSeed());
            return {std::string(kind.name), std::string(kind.description), std::string(kind.noun),
                    boxTrial(std::move(scene), options.reference)};
        }
        names.emplace_back(kind.name);
    }
    for (const WorldSceneKind& kind : worldSceneKinds()) {
        if (kind.name == options.scene) {
            const std::size_t objects = objectsOf(kind.defaultObjects);
            auto fill = [fillScene = kind.fill, objects, seed = options.sceneSeed()](
                            WorldContents& contents) { fillScene(contents, objects, seed); };
            return {std::string(kind.name), std::string(kind.description), "bodies",
                    worldTrial(std::move(fill), options.reference, tell)};
        }
        names.emplace_back(kind.name);
    }
    throw InputError(unknownNameSentence("scene", options.scene, names));
}

OpenedTrial openTextBoxes(const CompareOptions& options, const TellWaiting& tell) {
    std::vector<Aabb<float>> boxes = readTextBoxes(options.file, tell);
    const std::size_t objects = options.objects.value_or(boxes.size());
    if (objects > boxes.size()) {
        throw InputError(options.file + " holds " + withThousands(boxes.size()) +
                         " boxes, but --objects asks for " + withThousands(objects) + ".");
    }
    boxes.resize(objects);
    auto scene = std::make_unique<BrownianScene>(driftingBoxes(boxes), options.sceneSeed());
    return {options.file, "boxes from a text file, drifting", "boxes",
            boxTrial(std::move(scene), options.reference)};
}

OpenedTrial openFile(const CompareOptions& options, const TellWaiting& tell) {
    const bool isWorld = hasExtension(options.file, ".bullet");
    const bool isRecording = hasExtension(options.file, ".aabbs");
    if (options.seed && (isWorld || isRecording)) {
        throw InputError("--seed has no effect on " + options.file + "; leave it out.");
    }
    if (isWorld) {
        if (options.objects) {
            throw InputError(
                "--objects has no effect on a .bullet file, which holds a whole world; leave it "
                "out.");
        }
        auto file = std::make_shared<const BulletWorldFile>(options.file, tell);
        std::string description = "a world serialised by Bullet";
        if (!file->omissions().empty()) {
            description += ", without " + file->omissions() + ", which its importer passes over";
        }
        return {options.file, std::move(description), "bodies",
                worldTrial([file](WorldContents& contents) { file->fill(contents); },
                           options.reference, tell)};
    }
    if (isRecording) {
        auto scene =
            std::make_unique<RecordingScene>(options.file, options.objects.value_or(0), tell);
        return {options.file, "a Broadmark recording", "boxes",
                boxTrial(std::move(scene), options.reference)};
    }
    return openTextBoxes(options, tell);
}

}  // namespace

OpenedTrial openTrial(const CompareOptions& options, const TellWaiting& tell) {
    return options.file.empty() ? openScene(options, tell) : openFile(options, tell);
}

}  // namespace hashphase::demos
