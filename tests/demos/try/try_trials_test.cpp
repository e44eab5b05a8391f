// SPDX-License-Identifier: Zlib

// The trials of trials.txt.

#include <tests/demos/try/try_output.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {
namespace {

/// A block of the file.
struct DescribedTrial {
    std::string name;
    std::string words;
    int status = -1;
    std::vector<std::string> lines;  // below the first
};

void PrintTo(const DescribedTrial& trial, std::ostream* out) {
    *out << trial.words;
}

/// "Name: words -> status"
DescribedTrial headOf(const std::string& line) {
    const std::size_t colon = line.find(": ");
    const std::size_t arrow = line.rfind("-> ");
    return {line.substr(0, colon),
            line.substr(colon + 2, arrow - colon - 2),
            std::stoi(line.substr(arrow + 3)),
            {}};
}

std::vector<DescribedTrial> describedTrials() {
    std::vector<DescribedTrial> trials;
    std::ifstream file(HASHPHASE_TRIALS);
    bool isWithin = false;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line.starts_with('#')) {
            isWithin = isWithin && !line.empty();
        } else if (!isWithin) {
            trials.push_back(headOf(line));
            isWithin = true;
        } else {
            trials.back().lines.push_back(line);
        }
    }
    return trials;
}

/// `pointer` begins with '/', or is empty where the figure is found.
void expectFigure(const Json& found, std::string_view pointer, const std::string& expected) {
    if (!pointer.empty()) {
        const std::string token(pointer.substr(1, pointer.find('/', 1) - 1));
        const std::string_view rest = pointer.substr(1 + token.size());
        if (token == "*") {
            EXPECT_FALSE(found.empty());
            for (const Json& element : found) {
                expectFigure(element, rest, expected);
            }
        } else {
            const Json::json_pointer step("/" + token);
            ASSERT_TRUE(found.contains(step)) << token << " in " << found;
            expectFigure(found[step], rest, expected);
        }
        return;
    }
    const Json figure = found.is_array() ? Json(found.size()) : found;
    if (expected.starts_with('>')) {
        EXPECT_GT(figure, std::stod(expected.substr(1)));
    } else if (figure.is_string()) {
        EXPECT_TRUE(has(figure, expected)) << figure;
    } else {
        EXPECT_EQ(figure, Json::parse(expected));
    }
}

class Try : public testing::TestWithParam<DescribedTrial> {};

TEST_P(Try, Says) {
    const DescribedTrial& trial = GetParam();
    const auto [output, json] = measureWords(trial.words);
    EXPECT_EQ(output.status, trial.status) << output.out << output.err;
    for (std::string line : trial.lines) {
        SCOPED_TRACE(line);
        if (line.starts_with('/')) {
            const std::size_t blank = line.find(' ');
            expectFigure(json, std::string_view(line).substr(0, blank), line.substr(blank + 1));
        } else if (line.starts_with("last:")) {
            EXPECT_EQ(lastLineOf(output.out), line.substr(5)) << output.err;
        } else {
            std::ranges::replace(line, '|', '\n');
            EXPECT_TRUE(has(output.out + output.err, line)) << output.out << output.err;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Trials, Try, testing::ValuesIn(describedTrials()),
                         [](const auto& each) { return each.param.name; });

}  // namespace
}  // namespace hashphase::demos
