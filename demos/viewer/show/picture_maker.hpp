// SPDX-License-Identifier: Zlib
#pragma once

// From what a session knows to what is drawn: who is visible, in which colour, and what is laid over it.

#include <demos/viewer/draw/palette.hpp>
#include <demos/viewer/draw/picture.hpp>
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

class PictureMaker {
public:
    /// Spheres larger than `contactFrom` have a dark spot below them; something else will cover `coveredLeft`
    /// columns [pixels]. Over the map of loads bodies are dots, as they would hide it. Valid until the next call,
    /// or the session changes. Cost: O(bodies).
    [[nodiscard]] const Picture& make(const Session& session, float contactFrom = kContactFrom,
                                      int coveredLeft = 0);

    /// What the colours of the last picture tell, or would tell of the session as it is now.
    [[nodiscard]] std::vector<Legend> legends(const Session& session) const {
        return colours_.legends(session);
    }

private:
    void addBody(const StageBody& body, Colour colour);
    void addDot(const StageBody& body, Colour colour);
    void addCircle(const Vector3<float>& centre, const Vector3<float>& right,
                   const Vector3<float>& up, Colour colour);
    void addZones(const Session& session);
    void addRings(const StageBody& body, const CameraPose& pose);
    void addPairs(const Session& session);
    void addWireBox(const StageBody& body, Colour colour);
    void addMarks(const Session& session);
    void setGround(const Session& session);

    Picture picture_;
    Palette palette_;
    std::vector<DrawnSphere> spheres_;
    std::vector<DrawnBox> boxes_;
    std::vector<DrawnCapsule> capsules_;
    std::vector<DrawnLine> lines_;
    BodyColours colours_;
};

}  // namespace hashphase::demos
