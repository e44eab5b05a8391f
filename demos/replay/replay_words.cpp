// SPDX-License-Identifier: Zlib
#include <demos/replay/replay_words.hpp>

#include <demos/report/report_text.hpp>

#include <algorithm>
#include <sstream>

namespace hashphase::demos {
namespace {

/// How far the boxes are apart along the axis that parts them most; at most 0 where they overlap.
struct Gap {
    double metres = 0;
    char axis = 'x';
};

Gap gapBetween(const Aabb<float>& a, const Aabb<float>& b) {
    const Vector3<double> gaps = (b.min().cast<double>() - a.max().cast<double>())
                                     .cwiseMax(a.min().cast<double>() - b.max().cast<double>());
    Eigen::Index axis = 0;
    const double metres = gaps.maxCoeff(&axis);
    return {metres, "xyz"[axis]};
}

std::string lengthAlong(double metres, char axis) {
    std::ostringstream text;
    text.precision(3);
    text << metres << " m along " << axis;
    return text.str();
}

}  // namespace

std::string wrongPairWords(PairKey pair, bool isMissing, const Aabb<float>& first,
                           const Aabb<float>& second) {
    const std::string a = std::to_string(firstOf(pair));
    const std::string b = std::to_string(secondOf(pair));
    const Gap gap = gapBetween(first, second);
    std::string words = "Objects " + a + " and " + b;
    if (gap.metres > 0) {
        words += " are " + lengthAlong(gap.metres, gap.axis) + " apart";
    } else {
        words += " overlap by " + lengthAlong(-gap.metres, gap.axis);
    }
    if (isMissing) {
        words += ", but their pair is missing";
    } else if (gap.metres > 0) {
        words += ", but their pair is listed";
    } else {
        words += ", but their pair is listed twice, or against their filters";
    }
    return words + ": " + a + " is " + boxText(first) + ", " + b + " is " + boxText(second) + ".";
}

}  // namespace hashphase::demos
