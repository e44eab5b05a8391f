// SPDX-License-Identifier: Zlib
#pragma once

// A recording of a session: its scene, the commands with the frames in which they came, and a hash of what
// each frame has come to: Session::hash() says of what. Whoever plays them back sees the same, to the last
// bit, or is told where it differs.

#include <demos/viewer/session/scene_choice.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

struct LoggedCommand {
    std::uint64_t frame = 0;  // before which it was run
    std::string line;

    friend bool operator==(const LoggedCommand&, const LoggedCommand&) = default;
};

struct CommandLog {
    /// Hashes are kept of every so many frames.
    static constexpr std::uint64_t kHashEvery = 60;

    void add(std::uint64_t frame, std::string_view line) {
        commands.push_back({frame, std::string(line)});
    }
    /// Takes in what came out of a frame.
    void note(std::uint64_t frame, std::uint64_t result);

    /// The frame up to which both have seen the same, as far as their hashes tell; `frames` of the shorter
    /// one where there is no difference.
    [[nodiscard]] std::uint64_t sameUntil(const CommandLog& other) const;

    /// As JSON, and back. Throws InputError that begins with `name` and says what is wrong.
    [[nodiscard]] std::string text() const;
    [[nodiscard]] static CommandLog parse(std::string_view text, const std::string& name);

    SceneChoice choice = {};
    std::vector<LoggedCommand> commands = {};
    std::uint64_t frames = 0;
    std::uint64_t hash = 0xcbf29ce484222325U;
    std::vector<std::uint64_t> hashes = {};  // after every kHashEvery frames
};

struct Session;

/// Adds the commands that set up a new session as this one is set, where logged ones can.
void logSetting(const Session& session, CommandLog& log);

}  // namespace hashphase::demos
