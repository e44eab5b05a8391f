// SPDX-License-Identifier: Zlib
#pragma once

// Which colour a body has, and what colours tell.

#include <demos/viewer/draw/palette.hpp>
#include <demos/viewer/session/session.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace hashphase::demos {

/// What some colours of a picture tell.
struct Legend {
    struct Entry {
        Colour colour;
        std::string meaning;
    };

    std::string title;  // what is told, with its unit
    std::vector<Entry> entries;
};

class BodyColours {
public:
    /// Looks at the session as it is, before the bodies of a picture are asked for. Cost: O(bodies + pairs)
    /// where colours tell speeds or pairs.
    void prepare(const Session& session);

    /// Of a visible body, by what the session's colours tell or by what has been done to it.
    [[nodiscard]] Colour of(const Session& session, std::uint32_t index,
                            const StageBody& body) const;

    /// Of what is coloured by numbers, or by who rests; none where colours only tell bodies apart.
    [[nodiscard]] std::vector<Legend> legends(const Session& session) const;

private:
    [[nodiscard]] Colour byColouring(const Session& session, std::uint32_t index,
                                     const StageBody& body) const;

    Palette palette_;
    std::vector<std::uint32_t> pairCounts_;  // by index
    float fastest_ = 1;                      // of all visible bodies, lately [m/s]
};

}  // namespace hashphase::demos
