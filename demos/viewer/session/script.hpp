// SPDX-License-Identifier: Zlib
#pragma once

// Runs a session by lines of text, or by a recording of an earlier one.

#include <demos/viewer/session/session.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

/// Lines of commands, one after the other.
class Script {
public:
    /// `name` is what errors begin with.
    Script(std::string_view text, std::string name);

    /// Runs lines until the session waits for steps, or for a picture to be taken, or there are no more. Throws
    /// InputError with name and line.
    void feed(Session& session);

    [[nodiscard]] bool isDone() const noexcept { return next_ == lines_.size(); }

private:
    std::string name_;
    std::vector<std::string> lines_;
    std::size_t next_ = 0;
};

/// A recording that is played back.
class Playback {
public:
    explicit Playback(CommandLog log) : log_(std::move(log)) {}

    /// Runs what was run before the next frame, and asks for that frame. Throws InputError where a command
    /// cannot be run.
    void feed(Session& session);

    [[nodiscard]] bool isDone(const Session& session) const noexcept {
        return session.frame() >= log_.frameCount();
    }

    /// Says whether the session has come to the same, in a sentence; `isSame` tells it too.
    [[nodiscard]] std::string verdict(const Session& session, bool& isSame) const;

    [[nodiscard]] const CommandLog& log() const noexcept { return log_; }

private:
    CommandLog log_;
    std::size_t next_ = 0;
};

}  // namespace hashphase::demos
