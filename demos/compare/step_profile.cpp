// SPDX-License-Identifier: Zlib
#include <demos/compare/step_profile.hpp>

#include <algorithm>
#include <string_view>

namespace hashphase::demos {
namespace {

void recordStep(std::string_view name, int frame, const Observation& seen, Measurements& measured) {
    measured.add("steps", {{"name", name},
                           {"frame", frame},
                           {"step_ms", seen.stepMs},
                           {"shape_boxes_ms", seen.shapeBoxesMs}});
    std::vector<std::string_view> path;  // from the outside inwards
    for (const ProfileZone& zone : seen.zones) {
        path.resize(static_cast<std::size_t>(zone.depth));
        measured.add("zones", {{"name", name},
                               {"frame", frame},
                               {"within", path.empty() ? std::string_view() : path.back()},
                               {"zone", zone.name},
                               {"ms", zone.milliseconds}});
        path.push_back(zone.name);
    }
}

}  // namespace

void profileSteps(Trial& trial, const ComparisonSettings& settings, const ComparisonEnd& compared,
                  const std::vector<Contestant>& contestants, Measurements& measured) {
    std::vector<const BroadphaseKind*> kinds;
    for (const Contestant& each : contestants) {
        if (!each.leftOutAfter) {
            kinds.push_back(each.kind);
        }
    }
    std::vector<Contestant> again = fillBroadphases(trial, kinds, settings);
    std::erase_if(again, [](const Contestant& each) { return each.leftOutAfter.has_value(); });

    const int frames = std::min(compared.framesDone, kMostProfiledFrames);
    Progress progress(settings.err, settings.progress, "profiling frame",
                      static_cast<std::size_t>(frames));
    for (int frame = 0; frame < frames && !settings.limit.isOver(); ++frame) {
        progress.update(static_cast<std::size_t>(frame));
        trial.beginFrame();
        for (std::size_t turn = 0; turn < again.size(); ++turn) {
            const std::size_t i = (turn + static_cast<std::size_t>(frame)) % again.size();
            const Observation seen = trial.runFrame(i);
            if (frame >= compared.warmUpFrames) {
                recordStep(again[i].kind->name, frame, seen, measured);
            }
        }
    }
}

}  // namespace hashphase::demos
