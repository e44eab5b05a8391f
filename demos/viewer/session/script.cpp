// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/script.hpp>

#include <demos/console/format.hpp>
#include <demos/scenes/input_error.hpp>

#include <sstream>
#include <utility>

namespace hashphase::demos {

Script::Script(std::string_view text, std::string name) : name_(std::move(name)) {
    std::istringstream lines{std::string(text)};
    for (std::string line; std::getline(lines, line);) {
        lines_.push_back(line);
    }
}

void Script::feed(Session& session) {
    while (!isDone() && !session.isWaiting() && !session.wantsScreenshot() && !session.isOver()) {
        const std::size_t line = next_++;
        try {
            session.run(lines_[line]);
        } catch (const InputError& error) {
            throw InputError(name_ + ":" + std::to_string(line + 1) + ": " + error.what());
        }
    }
}

void Playback::feed(Session& session) {
    const std::vector<LoggedCommand>& commands = log_.commands();
    for (; next_ < commands.size() && commands[next_].frame <= session.frame(); ++next_) {
        try {
            session.run(commands[next_].line);
        } catch (const InputError& error) {
            throw InputError("The recording's command \"" + commands[next_].line + "\" of frame " +
                             std::to_string(commands[next_].frame) +
                             " cannot be run: " + error.what());
        }
    }
    if (!isDone(session) && !session.isWaiting()) {
        session.askForSteps(1);
    }
}

std::string Playback::verdict(const Session& session, bool& isSame) const {
    const std::uint64_t same = log_.sameUntil(session.log());
    isSame = same == log_.frameCount();
    if (isSame) {
        return "replay: all " + withThousands(same) + " frames are the same, to the last bit";
    }
    return "replay: not the same after frame " + withThousands(same) + " of " +
           withThousands(log_.frameCount());
}

}  // namespace hashphase::demos
