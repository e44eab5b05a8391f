// SPDX-License-Identifier: Zlib
#include <demos/console/nearest_name.hpp>

#include <demos/console/format.hpp>

#include <algorithm>
#include <vector>

namespace hashphase::demos {

std::size_t editDistance(std::string_view a, std::string_view b) {
    // Three rows of the table of distances between prefixes (optimal string alignment).
    std::vector<std::size_t> before(b.size() + 1);
    std::vector<std::size_t> above(b.size() + 1);
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) {
        row[j] = j;
    }
    for (std::size_t i = 1; i <= a.size(); ++i) {
        before.swap(above);
        above.swap(row);
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = above[j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U);
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, replaced});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                row[j] = std::min(row[j], before[j - 2] + 1);
            }
        }
    }
    return row[b.size()];
}

std::string nearestName(std::string_view name, std::span<const std::string> known) {
    std::string nearest;
    std::size_t least = std::max<std::size_t>(2, name.size() / 3) + 1;
    for (const std::string& candidate : known) {
        const std::size_t distance = editDistance(name, candidate);
        // A word of which every letter differs is no misspelling, however short it is.
        if (distance < least && distance < std::max(name.size(), candidate.size())) {
            least = distance;
            nearest = candidate;
        }
    }
    return nearest;
}

std::string suggestion(std::string_view name, std::span<const std::string> known,
                       const std::string& quote) {
    const std::string nearest = nearestName(name, known);
    return nearest.empty() ? "; there are " + joined(known, ", ") + "."
                           : "; did you mean " + quote + nearest + quote + "?";
}

std::string unknownNameSentence(std::string_view whatItIs, std::string_view name,
                                std::span<const std::string> known) {
    return "There is no " + std::string(whatItIs) + " " + quotedWord(name) +
           suggestion(name, known, "'");
}

}  // namespace hashphase::demos
