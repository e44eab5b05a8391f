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
    /// `name` is what errors begin with. Throws InputError where there is no command.
    Script(std::string_view text, std::string name);

    /// Runs lines until the session waits for steps, or for a picture to be taken, or there are no more. Throws
    /// InputError with name and line.
    void feed(Session& session);

    [[nodiscard]] bool isDone() const noexcept { return next_ == lines_.size(); }

    /// Whether all lines have been run, to the last step that was asked for.
    [[nodiscard]] bool isComplete(const Session& session) const noexcept {
        return isDone() && !session.isWaiting();
    }

    /// What has come of it, in a sentence; empty where expectations do not hold, as has been said already.
    [[nodiscard]] std::string verdict(const Session& session) const;

private:
    std::string name_;
    std::vector<std::string> lines_;
    std::size_t next_ = 0;
};

/// A recording that is played back, in a session that plays: whoever looks on can let it pause, step and
/// begin again.
class Playback {
public:
    explicit Playback(CommandLog log) : log_(std::move(log)) {}

    /// To be called before each frame: runs what was run before it, from the first command where the scene has
    /// begun again. Throws InputError where a command cannot be run.
    void feed(Session& session);

    /// Throws InputError, which says what can be done, for a command of who looks on that would change
    /// what is compared.
    static void refuseChange(std::string_view line);

    [[nodiscard]] bool isDone(const Session& session) const noexcept {
        return session.frame >= log_.frames;
    }

    /// Says whether the session has come to the same, in a sentence, and how far it has come where that is not
    /// the end; `isSame` is false where there is a difference.
    [[nodiscard]] std::string verdict(const Session& session, bool& isSame) const;

    [[nodiscard]] const CommandLog& log() const noexcept { return log_; }

private:
    CommandLog log_;
    std::size_t next_ = 0;
    std::uint64_t scene_ = 0;  // the session's, by its count, whose commands are run
};

}  // namespace hashphase::demos
