// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/command_log.hpp>

#include <demos/report/json_values.hpp>
#include <demos/scenes/effects_fields.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/viewer/session/commands.hpp>
#include <demos/viewer/session/session.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>

namespace hashphase::demos {
namespace {

constexpr int kVersion = 2;
constexpr std::uint64_t kMostFrames = 1'000'000'000;

// Numbers in JSON are doubles to many readers.
std::string hexadecimal(std::uint64_t number) {
    std::array<char, 16> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number, 16).ptr;
    return "0x" + std::string(digits.data(), end);
}

std::uint64_t fromHexadecimal(const std::string& text) {
    std::uint64_t number = 0;
    const char* const end = text.data() + text.size();
    if (!text.starts_with("0x") ||
        std::from_chars(text.data() + 2, end, number, 16) != std::from_chars_result{end, {}}) {
        throw InputError("'" + text + "' is not a hash: 0x and up to 16 hexadecimal digits");
    }
    return number;
}

// Throws InputError unless it is a whole number from 0 to `most`.
std::uint64_t countIn(const Json& json, const char* name, std::uint64_t most) {
    const Json& number = json.at(name);
    if (!number.is_number_unsigned() || number.get<std::uint64_t>() > most) {
        throw InputError("'" + std::string(name) + "' must be a whole number from 0 to " +
                         std::to_string(most) + ", not " + number.dump());
    }
    return number.get<std::uint64_t>();
}

void requireVersion(const Json& json) {
    if (json.at("schema") != "hashphase/wander-recording") {
        throw InputError("it is not a recording of hashphase wander");
    }
    if (const Json& version = json.at("version"); version != kVersion) {
        throw InputError("it has version " + version.dump() +
                         ", but this program replays only version " + std::to_string(kVersion) +
                         ", which also compares agents' colours: record it again");
    }
}

// A recording may come from anywhere: it writes no files.
void requireLogged(const std::string& line) {
    const CommandKind* const kind = findCommand(line);
    if (kind == nullptr || !isLogged(kind->role)) {
        throw InputError("'" + line + "' is not a command of a recording");
    }
}

// Read back as the same number, and not as the nearest with so many digits.
std::string exactText(double number) {
    if (number == NumberField::kInfinite) {
        return std::string(kNoBound);
    }
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

// First what is not declared, then what is, which needs nothing that is not.
void logEffects(const Stage& stage, CommandLog& log) {
    const SceneEffects& effects = stage.effects();
    for (const bool isOn : {false, true}) {
        for (const Effect effect : kAllEffects) {
            if (stage.possibleEffects().contains(effect) &&
                effects.set().contains(effect) == isOn) {
                log.add(0, "effect " + std::string(nameOf(effect)) + (isOn ? " on" : " off"));
            }
        }
    }
    log.add(0, "cell " + exactText(effects.grid.cellSize));
    log.add(0, "ratio " + exactText(effects.grid.levelRatio));
    if (effects.proximity) {
        log.add(0, "radius " + exactText(effects.proximity->radius));
    }
    log.add(0, "broadphase " + std::string(stage.broadphase().name));
}

}  // namespace

void CommandLog::note(std::uint64_t frame, std::uint64_t result) {
    // FNV-1a, by Fowler, Noll and Vo.
    hash = (hash ^ result) * 0x100000001b3U;
    frames = frame;
    if (frame % kHashEvery == 0) {
        hashes.push_back(hash);
    }
}

std::uint64_t CommandLog::sameUntil(const CommandLog& other) const {
    const auto [mine, theirs] =
        std::mismatch(hashes.begin(), hashes.end(), other.hashes.begin(), other.hashes.end());
    const std::uint64_t shorter = std::min(frames, other.frames);
    if ((mine != hashes.end() && theirs != other.hashes.end()) ||
        (frames == other.frames && hash != other.hash)) {
        return kHashEvery * static_cast<std::uint64_t>(mine - hashes.begin());
    }
    return shorter;
}

std::string CommandLog::text() const {
    Json json;
    json["schema"] = "hashphase/wander-recording";
    json["version"] = kVersion;
    json["scene"] = choice.name;
    json["file"] = choice.file;
    json["objects"] = orNull(choice.objects);
    json["seed"] = choice.seed;
    json["frames"] = frames;
    json["hash"] = hexadecimal(hash);
    json["hashEvery"] = kHashEvery;
    json["hashes"] = Json::array();
    for (const std::uint64_t each : hashes) {
        json["hashes"].push_back(hexadecimal(each));
    }
    json["commands"] = Json::array();
    for (const LoggedCommand& command : commands) {
        json["commands"].push_back({{"frame", command.frame}, {"command", command.line}});
    }
    return textOf(json);
}

CommandLog CommandLog::parse(std::string_view text, const std::string& name) {
    try {
        const Json json = Json::parse(text);
        requireVersion(json);
        CommandLog log;
        log.choice.name = json.at("scene").get<std::string>();
        log.choice.file = json.at("file").get<std::string>();
        if (!json.at("objects").is_null()) {
            log.choice.objects = countIn(json, "objects", kMostObjects);
        }
        log.choice.seed = countIn(json, "seed", kMostSeed);
        log.frames = countIn(json, "frames", kMostFrames);
        log.hash = fromHexadecimal(json.at("hash").get<std::string>());
        for (const Json& hash : json.at("hashes")) {
            log.hashes.push_back(fromHexadecimal(hash.get<std::string>()));
        }
        for (const Json& command : json.at("commands")) {
            log.commands.push_back(
                {countIn(command, "frame", kMostFrames), command.at("command").get<std::string>()});
            requireLogged(log.commands.back().line);
        }
        const auto comesLater = [](const LoggedCommand& a, const LoggedCommand& b) {
            return a.frame < b.frame;
        };
        if (!std::is_sorted(log.commands.begin(), log.commands.end(), comesLater) ||
            log.hashes.size() != log.frames / kHashEvery) {
            throw InputError(
                "its commands are not in the order of their frames, or hashes are missing");
        }
        if (log.frames > 0 && log.frames % kHashEvery == 0 && log.hashes.back() != log.hash) {
            throw InputError("its last hash differs from its hash of all frames");
        }
        return log;
    } catch (const Json::exception& error) {
        const std::string_view fault = error.what();  // after the number of its kind, in brackets
        throw InputError(name + " cannot be read as a recording: " +
                         std::string(fault.substr(fault.find("] ") + 2)) + ".");
    } catch (const InputError& error) {
        throw InputError(name + " cannot be read as a recording: " + error.what() + ".");
    }
}

// --- What a session begins with ------------------------------------------------------------------

void logSetting(const Session& session, CommandLog& log) {
    const auto nameOf = [](const auto& names, auto value) {
        return ' ' + std::string(names[static_cast<std::size_t>(value)]);
    };
    const ViewOptions& options = session.options;
    std::ostringstream line;
    line.precision(9);  // which a float is read back by
    const auto add = [&](const auto&... parts) {
        line.str({});
        (line << ... << parts);
        log.add(0, line.str());
    };
    add("size ", session.width, ' ', session.height);
    std::ostringstream state;
    state.precision(9);
    for (const float number : session.camera.state()) {
        state << ' ' << number;
    }
    add("pose", nameOf(kCameraModes, session.camera.mode()), state.str());
    logEffects(*session.stage, log);
    add("colour", nameOf(kColourings, options.colouring));
    for (std::size_t i = 0; i < kOverlays.size(); ++i) {
        add("overlay", nameOf(kOverlays, i), options.overlays[i] ? " on" : " off");
    }
    add("dots ", options.dots);
    add("theme", nameOf(kThemes, options.theme));
    add("check ", session.isChecking ? "on" : "off");
}

}  // namespace hashphase::demos
