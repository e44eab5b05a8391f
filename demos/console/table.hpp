// SPDX-License-Identifier: Zlib
#pragma once

// A table of text with aligned columns.

#include <iosfwd>
#include <string>
#include <vector>

namespace hashphase::demos {

/// The first column is aligned to the left, the others to the right, as numbers are, or as words are.
class Table {
public:
    explicit Table(std::vector<std::string> header, bool isOfWords = false);

    /// As many cells as the header has.
    void addRow(std::vector<std::string> cells);

    /// Writes the table, a rule under the header, no blanks at line ends.
    void print(std::ostream& out) const;

private:
    std::vector<std::vector<std::string>> rows_;  // the header first
    bool isOfWords_;
};

}  // namespace hashphase::demos
