// SPDX-License-Identifier: Zlib
#pragma once

// What the grid answers in every scene, as one number a scene and question, so that the answers of two
// builds, two processors, or two ways of running can be compared with ==.
//
// Objects are known by their numbers, not by their ids, and every list is sorted: the order in which
// objects were added makes no difference.

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

namespace hashphase::test {

/// How the same questions are asked.
struct GoldenRun {
    std::size_t threadCount = 1;
    std::uint64_t insertionSeed =
        0;                  ///< objects are added and moved in an order of its own; 0: as numbered
    bool denormals = true;  ///< false leaves out the scenes that are made of them
};

/// A number for all answers to one question in one scene.
struct GoldenLine {
    std::string name;  ///< precision, scene and question, without spaces
    std::uint64_t hash = 0;
    std::uint64_t answers = 0;  ///< how many went into it

    friend bool operator==(const GoldenLine&, const GoldenLine&) = default;
};

/// One line, as in golden.txt: name, answers, and the hash in hexadecimal.
std::ostream& operator<<(std::ostream& out, const GoldenLine& line);
std::istream& operator>>(std::istream& in, GoldenLine& line);

/// Both precisions, all scenes, all questions; in a fixed order. Takes about a tenth of a second.
[[nodiscard]] std::vector<GoldenLine> goldenLines(const GoldenRun& run = {});

}  // namespace hashphase::test
