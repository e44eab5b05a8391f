// SPDX-License-Identifier: Zlib
#include <demos/viewer/show/wander.hpp>

#include <demos/console/format.hpp>
#include <demos/report/json_values.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/viewer/session/commands.hpp>
#include <demos/viewer/show/annotations.hpp>

#include <iomanip>
#include <ostream>

namespace hashphase::demos {
namespace {

void tellPhase(const PhaseLine& line, bool hasBefore, std::ostream& out) {
    const auto text = [](std::optional<double> time) { return time ? milliseconds(*time) : "-"; };
    out << std::left << std::setw(20) << line.name << std::right << std::setw(9)
        << text(line.median) << " ms   p95 " << std::setw(8) << text(line.p95) << "   worst "
        << std::setw(8) << text(line.worst);
    if (hasBefore) {
        out << "   before " << std::setw(8) << text(line.before);
    }
    out << '\n';
}

// The scene that was on stage at the end; of a recording of boxes all objects are bodies, and of a scene file,
// in which one can be removed, each has an index.
void addScene(const Session& session, Json& json) {
    const SceneChoice& choice = session.choice;
    const bool isFile = !choice.file.empty();
    json["scene"] = isFile ? Json(nullptr) : Json(choice.name);
    json["file"] = orNull(choice.file);
    json["objects"] = isFile ? session.stage->indexLimit() : objectCount(choice);
    json["seed"] = isBoxRecording(choice) ? Json(nullptr) : Json(choice.seed);
    json["broadphase"] = session.stage->broadphase().name;
}

}  // namespace

void listWander(std::ostream& out) {
    out << "scenes, with their numbers of bodies\n";
    for (const ViewerScene& scene : viewerScenes()) {
        out << "  " << std::left << std::setw(14) << scene.name << scene.description << " ("
            << withThousands(scene.objects) << ")\n";
    }
    out << "\nkeys\n";
    for (const KeyBinding& binding : keyBindings()) {
        out << "  " << std::left << std::setw(8) << binding.key << std::setw(18) << binding.command
            << binding.help << '\n';
    }
    out << "\ncommands for scripts, one per line\n";
    for (const CommandKind& kind : commandKinds()) {
        out << "  " << std::left << std::setw(54) << kind.usage << kind.help << '\n';
    }
    EffectSet effects;
    for (const Effect effect : kAllEffects) {
        effects.insert(effect);
    }
    out << "\neffects, for the command effect\n  " << namesOf(effects) << '\n';
    out << "\nreadings, for print and expect\n";
    for (const Reading& reading : readings()) {
        out << "  " << std::left << std::setw(20) << reading.name << reading.help << '\n';
    }
}

void tellPhases(const Session& session, bool drewPictures, std::ostream& out) {
    if (const std::size_t count = session.history.toldCount(); count > 0) {
        const PhaseHistory* const before = session.former ? &session.former->history : nullptr;
        for (const PhaseLine& line : phaseLines(session.history, before)) {
            tellPhase(line, before != nullptr, out);
        }
        out << "medians of the last " << (count == 1 ? "frame" : withThousands(count) + " frames")
            << (drewPictures ? ", while pictures were drawn" : "") << '\n';
        if (before != nullptr) {
            out << swapText(session) << '\n';
        }
    }
    out << bodiesText(session.stage->size()) << ", " << withThousands(session.visibleCount())
        << " visible, " << withThousands(session.stage->pairCount()) << " pairs after "
        << withThousands(session.frame) << " frames\n";
}

void writeNumbers(const Session& session, std::optional<double> framesPerSecond,
                  std::ostream& out) {
    Json json;
    json["schema"] = "hashphase/wander";
    json["version"] = 1;
    addScene(session, json);
    json["framesPerSecond"] = orNull(framesPerSecond);
    for (const Reading& reading : readings()) {
        Json& number = json["readings"][std::string(reading.name)];
        try {
            number = reading.read(session);
        } catch (const InputError&) {
            number = nullptr;
        }
    }
    const PhaseHistory& history = session.history;
    for (const PhaseHistory::Row& row : history.rows()) {
        json["phases"][std::string(row.name)] = {{"milliseconds", history.median(row)},
                                                 {"p95", history.p95(row)},
                                                 {"worst", history.worst(row)}};
    }
    out << textOf(json);
}

}  // namespace hashphase::demos
