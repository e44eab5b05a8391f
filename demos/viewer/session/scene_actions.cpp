// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/command_actions.hpp>

#include <demos/console/format.hpp>
#include <demos/scenes/effects_fields.hpp>
#include <demos/scenes/input_error.hpp>

#include <algorithm>
#include <array>

namespace hashphase::demos::actions {

// --- Scene ---------------------------------------------------------------------------------------

void scene(Session& session, Arguments& words) {
    SceneChoice choice = session.choice();
    const std::span<const ViewerScene> scenes = viewerScenes();
    const std::string word = words.isEmpty() ? "next" : words.word("scene");
    words.end();
    if (word == "next" || word == "previous") {
        const auto now = std::find_if(scenes.begin(), scenes.end(), [&](const ViewerScene& known) {
            return known.name == choice.name;
        });
        const auto place = static_cast<std::size_t>(now - scenes.begin());
        const std::size_t step = word == "next" ? 1 : scenes.size() - 1;
        choice.name = scenes[(place + step) % scenes.size()].name;
    } else {
        choice.name = word;
    }
    choice.file.clear();
    choice.objects.reset();
    session.choose(choice);
}

void objects(Session& session, Arguments& words) {
    SceneChoice choice = session.choice();
    choice.objects = static_cast<std::size_t>(words.whole("N", 1, kMostObjects));
    words.end();
    session.choose(choice);
}

void seed(Session& session, Arguments& words) {
    SceneChoice choice = session.choice();
    choice.seed = static_cast<std::uint64_t>(words.whole("N", 0, kMostSeed));
    words.end();
    if (isBoxRecording(choice)) {
        throw InputError("A recording of boxes has no seed.");
    }
    session.choose(choice);
}

void restart(Session& session, Arguments& words) {
    words.end();
    session.choose(session.choice());
}

void pause(Session& session, Arguments& words) {
    const bool isPaused = words.onOff(!session.isPlaying() && !session.isWaiting());
    words.end();
    if (isPaused) {
        session.standStill();
    } else {
        session.setPlaying(true);
    }
}

void step(Session& session, Arguments& words) {
    const long long count = words.wholeOr("N", 1, 1'000'000, 1);
    words.end();
    session.askForSteps(static_cast<std::uint64_t>(count));
}

// --- What runs -----------------------------------------------------------------------------------

Effect effectNamed(Arguments& words) {
    std::array<std::string_view, kAllEffects.size()> names;
    std::transform(kAllEffects.begin(), kAllEffects.end(), names.begin(), nameOf);
    return kAllEffects[words.choice("effect", names)];
}

void effect(Session& session, Arguments& words) {
    EffectSet effects = session.stage().effects().set();
    const Effect named = effectNamed(words);
    const bool isOn = words.onOff(effects.contains(named));
    words.end();
    if (isOn && !session.stage().possibleEffects().contains(named)) {
        throw InputError("This scene cannot have " + std::string(nameOf(named)) + "; it can have " +
                         namesOf(session.stage().possibleEffects()) + ".");
    }
    if (isOn) {
        effects = effects | needsOf(named);
        effects.insert(named);
    } else {
        for (const Effect other : kAllEffects) {
            if (needsOf(other).contains(named)) {
                effects.erase(other);
            }
        }
        effects.erase(named);
    }
    session.declare(effects);
}

// The kind after the present one with which so many bodies can be watched. Ours is one, for any number.
const BroadphaseKind& nextQuickKind(const Session& session, std::string& skipped) {
    const std::span<const BroadphaseKind> kinds = broadphaseKinds();
    auto place = static_cast<std::size_t>(&session.stage().broadphase() - kinds.data());
    for (;;) {
        place = (place + 1) % kinds.size();
        const BroadphaseKind& kind = kinds[place];
        if (session.stage().size() <= kind.liveUpTo) {
            return kind;
        }
        skipped += (skipped.empty() ? "" : " and ") + std::string(kind.name) + " (for up to " +
                   withThousands(kind.liveUpTo) + ")";
    }
}

void broadphase(Session& session, Arguments& words) {
    const std::span<const BroadphaseKind> kinds = broadphaseKinds();
    std::vector<std::string_view> names;
    for (const BroadphaseKind& kind : kinds) {
        names.push_back(kind.name);
    }
    names.push_back("next");
    const std::size_t chosen = words.choice("broadphase", names);
    words.end();
    if (chosen < kinds.size()) {
        session.setBroadphase(kinds[chosen]);
        return;
    }
    std::string skipped;
    const BroadphaseKind& next = nextQuickKind(session, skipped);
    session.setBroadphase(next);
    if (!skipped.empty()) {
        session.say("passed over " + skipped + ", as there are " +
                    withThousands(session.stage().size()) +
                    " bodies; \"broadphase NAME\" takes one all the same");
    }
}

void check(Session& session, Arguments& words) {
    const bool isOn = words.onOff(session.isChecking());
    words.end();
    session.setChecking(isOn);
}

// Commands take what files may have, so that whatever a file has can be recorded.
const EffectsField& fileField(std::string_view section, std::string_view name) {
    const std::span<const EffectsField> fields = effectsFields();
    return *std::find_if(fields.begin(), fields.end(), [&](const EffectsField& field) {
        return field.section == section && field.name == name;
    });
}

void cell(Session& session, Arguments& words) {
    SceneEffects effects = session.stage().effects();
    effects.grid.cellSize = words.number("SIZE", fileField("grid", "cellSize"));
    words.end();
    session.declare(effects);
}

void ratio(Session& session, Arguments& words) {
    SceneEffects effects = session.stage().effects();
    effects.grid.levelRatio = words.number("RATIO", fileField("grid", "levelRatio"));
    words.end();
    session.declare(effects);
}

void radius(Session& session, Arguments& words) {
    SceneEffects effects = session.stage().effects();
    if (!effects.proximity) {
        throw InputError("The radius is that of proximity: run \"effect proximity on\" before.");
    }
    effects.proximity->radius = words.number("R", fileField("effects.proximity", "radius"));
    words.end();
    session.declare(effects);
}

}  // namespace hashphase::demos::actions
