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

class CommandLog {
public:
    /// Hashes are kept of every so many frames.
    static constexpr std::uint64_t kHashEvery = 60;

    void begin(const SceneChoice& choice);
    void add(std::uint64_t frame, std::string_view line) {
        commands_.push_back({frame, std::string(line)});
    }
    /// Takes in what came out of a frame.
    void note(std::uint64_t frame, std::uint64_t result);

    [[nodiscard]] const SceneChoice& choice() const noexcept { return choice_; }
    [[nodiscard]] const std::vector<LoggedCommand>& commands() const noexcept { return commands_; }
    [[nodiscard]] std::uint64_t frameCount() const noexcept { return frames_; }
    [[nodiscard]] std::uint64_t hash() const noexcept { return hash_; }

    /// The frame up to which both have seen the same, as far as their hashes tell; frameCount() of the shorter
    /// one where there is no difference.
    [[nodiscard]] std::uint64_t sameUntil(const CommandLog& other) const;

    /// As JSON, and back. Throws InputError that begins with `name` and says what is wrong.
    [[nodiscard]] std::string text() const;
    [[nodiscard]] static CommandLog parse(std::string_view text, const std::string& name);

private:
    SceneChoice choice_;
    std::vector<LoggedCommand> commands_;
    std::uint64_t frames_ = 0;
    std::uint64_t hash_ = 0xcbf29ce484222325U;
    std::vector<std::uint64_t> hashes_;  // after every kHashEvery frames
};

}  // namespace hashphase::demos
