// SPDX-License-Identifier: Zlib
#pragma once

// From what a session knows to what is drawn: who is visible, in which colour, and what is laid over it.

#include <demos/viewer/draw/palette.hpp>
#include <demos/viewer/draw/picture.hpp>
#include <demos/viewer/session/session.hpp>

#include <cstdint>
#include <vector>

namespace hashphase::demos {

class PictureMaker {
public:
    /// Spheres larger than `contactFrom` have a dark spot below them [pixels]. Valid until the next
    /// call, or the session changes. Cost: O(bodies).
    [[nodiscard]] const Picture& make(const Session& session, float contactFrom = kContactFrom);

private:
    void addBodies(const Session& session);
    void addBody(const StageBody& body, Colour colour);
    [[nodiscard]] Colour colourOf(const Session& session, std::uint32_t index,
                                  const StageBody& body) const;
    [[nodiscard]] Colour highlightOf(const Session& session, std::uint32_t index,
                                     Colour otherwise) const;
    void countPairs(const Session& session);
    void addFrustum(const CameraPose& pose);
    void addPairs(const Session& session);
    void addLink(const Session& session, PairKey pair, Colour colour, bool isOnTop);
    void addWireBox(const StageBody& body, Colour colour);
    void addMarks(const Session& session);
    void setGround(const Session& session);

    Picture picture_;
    Palette palette_;
    std::vector<DrawnSphere> spheres_;
    std::vector<DrawnBox> boxes_;
    std::vector<DrawnCapsule> capsules_;
    std::vector<DrawnLine> lines_;
    std::vector<std::uint32_t> pairCounts_;  // by index
    float fastest_ = 1;                      // of all bodies, lately [m/s]
};

}  // namespace hashphase::demos
