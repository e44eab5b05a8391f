// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/command_log.hpp>

#include <demos/report/json_values.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/viewer/session/commands.hpp>

#include <algorithm>
#include <charconv>

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
        throw InputError("'" + text + "' is no hash, which is 0x and up to 16 digits");
    }
    return number;
}

// Throws InputError unless it is a whole number from 0 to `most`.
std::uint64_t countIn(const Json& json, const char* name, std::uint64_t most) {
    const Json& number = json.at(name);
    if (!number.is_number_unsigned() || number.get<std::uint64_t>() > most) {
        throw InputError("'" + std::string(name) + "' is a whole number from 0 to " +
                         std::to_string(most) + ", not " + number.dump());
    }
    return number.get<std::uint64_t>();
}

void requireVersion(const Json& json) {
    if (json.at("schema") != "hashphase/wander-recording") {
        throw InputError("it is no recording of hashphase wander");
    }
    if (const Json& version = json.at("version"); version != kVersion) {
        throw InputError("it is of version " + version.dump() + ", and this program plays back " +
                         std::to_string(kVersion) +
                         " alone, with which agents' colours are compared as well: record it anew");
    }
}

// A recording may come from anywhere: it writes no files.
void requireLogged(const std::string& line) {
    const CommandKind* const kind = findCommand(line);
    if (kind == nullptr || !isLogged(kind->role)) {
        throw InputError("'" + line + "' is no command of a recording");
    }
}

}  // namespace

void CommandLog::begin(const SceneChoice& choice) {
    *this = {};
    choice_ = choice;
}

void CommandLog::note(std::uint64_t frame, std::uint64_t result) {
    // FNV-1a, by Fowler, Noll and Vo.
    hash_ = (hash_ ^ result) * 0x100000001b3U;
    frames_ = frame;
    if (frame % kHashEvery == 0) {
        hashes_.push_back(hash_);
    }
}

std::uint64_t CommandLog::sameUntil(const CommandLog& other) const {
    const auto [mine, theirs] =
        std::mismatch(hashes_.begin(), hashes_.end(), other.hashes_.begin(), other.hashes_.end());
    const std::uint64_t shorter = std::min(frames_, other.frames_);
    if ((mine != hashes_.end() && theirs != other.hashes_.end()) ||
        (frames_ == other.frames_ && hash_ != other.hash_)) {
        return kHashEvery * static_cast<std::uint64_t>(mine - hashes_.begin());
    }
    return shorter;
}

std::string CommandLog::text() const {
    Json json;
    json["schema"] = "hashphase/wander-recording";
    json["version"] = kVersion;
    json["scene"] = choice_.name;
    json["file"] = choice_.file;
    json["objects"] = orNull(choice_.objects);
    json["seed"] = choice_.seed;
    json["frames"] = frames_;
    json["hash"] = hexadecimal(hash_);
    json["hashEvery"] = kHashEvery;
    Json& hashes = json["hashes"] = Json::array();
    for (const std::uint64_t hash : hashes_) {
        hashes.push_back(hexadecimal(hash));
    }
    Json& commands = json["commands"] = Json::array();
    for (const LoggedCommand& command : commands_) {
        commands.push_back({{"frame", command.frame}, {"command", command.line}});
    }
    return textOf(json);
}

CommandLog CommandLog::parse(std::string_view text, const std::string& name) {
    try {
        const Json json = Json::parse(text);
        requireVersion(json);
        CommandLog log;
        log.choice_.name = json.at("scene").get<std::string>();
        log.choice_.file = json.at("file").get<std::string>();
        if (!json.at("objects").is_null()) {
            log.choice_.objects = countIn(json, "objects", kMostObjects);
        }
        log.choice_.seed = countIn(json, "seed", kMostSeed);
        log.frames_ = countIn(json, "frames", kMostFrames);
        log.hash_ = fromHexadecimal(json.at("hash").get<std::string>());
        for (const Json& hash : json.at("hashes")) {
            log.hashes_.push_back(fromHexadecimal(hash.get<std::string>()));
        }
        for (const Json& command : json.at("commands")) {
            log.commands_.push_back(
                {countIn(command, "frame", kMostFrames), command.at("command").get<std::string>()});
            requireLogged(log.commands_.back().line);
        }
        const auto comesLater = [](const LoggedCommand& a, const LoggedCommand& b) {
            return a.frame < b.frame;
        };
        if (!std::is_sorted(log.commands_.begin(), log.commands_.end(), comesLater) ||
            log.hashes_.size() != log.frames_ / kHashEvery) {
            throw InputError("its frames are out of order, or hashes are missing");
        }
        if (log.frames_ > 0 && log.frames_ % kHashEvery == 0 && log.hashes_.back() != log.hash_) {
            throw InputError("its last hash is not the one of all frames");
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

}  // namespace hashphase::demos
