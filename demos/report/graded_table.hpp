// SPDX-License-Identifier: Zlib
#pragma once

// A table whose cells are judged: by a colour that the colour-blind can tell too, and by a mark.

#include <array>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

enum class Grade { kNone, kGood, kFair, kPoor };

/// What stands behind the text of a cell of that grade: nothing, "~" for fair, "!" for poor.
[[nodiscard]] std::string_view markOf(Grade grade);

struct GradedText {
    std::string text;
    Grade grade = Grade::kNone;

    /// With the mark.
    [[nodiscard]] std::string marked() const { return text + std::string(markOf(grade)); }
};

struct GradedTable {
    std::string caption;
    std::array<std::string, 3> legend;  // what good, fair and poor mean
    std::vector<std::string> header;
    std::vector<std::vector<GradedText>> rows;  // each as long as the header
};

/// As HTML. The first two columns are texts, the others stand to the right; equal texts in the first
/// column stand once.
void writeGradedTable(const GradedTable& table, std::ostream& out);

}  // namespace hashphase::demos
