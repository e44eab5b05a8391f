// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/script.hpp>

#include <demos/console/format.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/viewer/session/commands.hpp>

#include <algorithm>
#include <sstream>
#include <utility>

namespace hashphase::demos {

Script::Script(std::string_view text, std::string name) : name_(std::move(name)) {
    std::istringstream lines{std::string(text)};
    for (std::string line; std::getline(lines, line);) {
        lines_.push_back(line);
    }
    if (std::all_of(lines_.begin(), lines_.end(),
                    [](const std::string& line) { return firstWord(line).empty(); })) {
        throw InputError(name_ + " contains no command.");
    }
}

void Script::feed(Session& session) {
    while (!isDone() && !session.isWaiting() && session.screenshots.empty() && !session.isOver) {
        const std::size_t line = next_++;
        try {
            session.run(lines_[line]);
        } catch (const InputError& error) {
            throw InputError(name_ + ":" + std::to_string(line + 1) + ": " + error.what());
        }
    }
}

std::string Script::verdict(const Session& session) const {
    if (!isComplete(session)) {
        return "script: stopped at line " + withThousands(next_) + " of " +
               withThousands(lines_.size());
    }
    return session.failureCount == 0 ? "script: all expectations hold" : "";
}

void Playback::feed(Session& session) {
    if (scene_ != session.sceneCount) {
        scene_ = session.sceneCount;
        next_ = 0;
    }
    const std::vector<LoggedCommand>& commands = log_.commands;
    for (; next_ < commands.size() && commands[next_].frame <= session.frame; ++next_) {
        try {
            session.run(commands[next_].line);
        } catch (const InputError& error) {
            throw InputError("The recording's command \"" + commands[next_].line + "\" of frame " +
                             std::to_string(commands[next_].frame) +
                             " cannot be run: " + error.what());
        }
    }
}

void Playback::refuseChange(std::string_view line) {
    const CommandKind* const kind = findCommand(line);
    if (kind != nullptr && !leavesReplay(kind->role)) {
        throw InputError("'" + std::string(kind->name) +
                         "' would change the recording that is replayed. Pause (P), step (O) or "
                         "restart (R).");
    }
}

std::string Playback::verdict(const Session& session, bool& isSame) const {
    const std::uint64_t all = log_.frames;
    const std::uint64_t reached = std::min(session.log.frames, all);
    const std::uint64_t same = log_.sameUntil(session.log);
    isSame = same == reached;
    if (!isSame) {
        return "replay: differs after frame " + withThousands(same) + " of " + withThousands(all);
    }
    if (reached == all) {
        return "replay: all " + withThousands(all) + " frames are the same, to the last bit";
    }
    // As far as there are hashes.
    const std::uint64_t compared = reached - reached % CommandLog::kHashEvery;
    return "replay: compared " + withThousands(compared) + " of " + withThousands(all) + " frames" +
           (compared > 0 ? ", which are the same" : "");
}

}  // namespace hashphase::demos
