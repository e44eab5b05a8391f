// SPDX-License-Identifier: Zlib
#include <demos/scenes/input_error.hpp>
#include <demos/scenes/text_boxes.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace hashphase::demos {
namespace {

TEST(TextBoxes, ReadsALineABox) {
    const auto boxes = parseTextBoxes("0 0 0 1 2 3\n-1.5 2e1 3 -1 21 3.25\n");
    ASSERT_EQ(boxes.size(), 2U);
    EXPECT_EQ(boxes[0].max(), Vector3<float>(1, 2, 3));
    EXPECT_EQ(boxes[1].min(), Vector3<float>(-1.5F, 20, 3));
    EXPECT_EQ(boxes[1].max(), Vector3<float>(-1, 21, 3.25F));
}

TEST(TextBoxes, SkipsEmptyLinesAndCommentsAndAcceptsTabsAndCarriageReturns) {
    EXPECT_EQ(parseTextBoxes("# boxes\r\n\r\n  0\t0 0 1 1 1 \r\n\n0 0 0 0 0 0").size(), 2U);
}

TEST(TextBoxes, NamesLineAndColumnOfTheFirstFault) {
    const std::string none = "no boxes found; each line must be: min x y z max x y z.";
    const std::pair<std::string, std::string> faults[] = {
        {"0 0 0 1 1 1\n0 0 zero 1 1 1\n", "line 2, column 5: expected a number, found 'zero'."},
        {"0 0 0 1 1 1x\n", "line 1, column 11: expected a number, found '1x'."},
        {"0 0 0 1 1\n",
         "line 1, column 10: the line has fewer than six numbers: min x y z max x y z."},
        {"0 0 0 1 1 1 7\n", "line 1, column 13: the line has more than six numbers."},
        {"0 0 nan 1 1 1", "line 1, column 5: 'nan' is not a finite number."},
        {"0 0 0 1 inf 1", "line 1, column 9: 'inf' is not a finite number."},
        {"0 0 0 1 1 1e60", "line 1, column 11: '1e60' does not fit a single-precision number."},
        {"0 0 0 1 1 1e35",
         "line 1, column 11: '1e35' is not between -1e30 and 1e30, the limits of coordinates."},
        {"0 0 0 1 1 1\n0 0 0 1 -1 1\n",
         "line 2, column 9: the box is inverted: its max y is below its min."},
        {"", none},
        {"\n# nothing\n", none},
        // Long words, and what a terminal would obey, in a short sentence.
        {"0 0 " + std::string(1000, '9') + " 1 1 1",
         "line 1, column 5: '" + std::string(40, '9') +
             "...' does not fit a single-precision number."},
        {std::string("0 \0\x1b[0m", 7) + " 1 1 1",
         "line 1, column 3: expected a number, found '??[0m'."},
    };
    for (const auto& [text, fault] : faults) {
        EXPECT_EQ(messageOf<InputError>([&] { return parseTextBoxes(text); }), fault) << text;
    }
}

TEST(TextBoxes, RefusesEveryTruncationThatLosesANumber) {
    const std::string text = "0 0 0 1 1 1\n2 2 2 3 3 3";
    for (std::size_t length = 0; length < text.size(); ++length) {
        const bool whole = length == 11 || length == 12;
        if (whole) {
            EXPECT_EQ(parseTextBoxes(text.substr(0, length)).size(), 1U) << length;
        } else {
            EXPECT_THROW(static_cast<void>(parseTextBoxes(text.substr(0, length))), InputError)
                << length;
        }
    }
}

TEST(TextBoxes, PutsThePathInFrontOfTheFault) {
    const TemporaryFolder folder;
    const std::string path = folder.write("boxes.txt", "1 2\n");
    const std::string fault = messageOf<InputError>([&path] { return readTextBoxes(path); });
    EXPECT_EQ(fault.rfind(path + ": line 1, column 4: ", 0), 0U) << fault;
}

TEST(TextBoxes, DriftWithinTheirCommonBoundsAndKeepTheirSizes) {
    const auto boxes = parseTextBoxes("0 0 0 1 1 1\n10 10 10 12 14 16\n4 4 4 4 4 4\n");
    BrownianScene scene(driftingBoxes(boxes), 7);
    for (int frame = 0; frame < 200; ++frame) {
        scene.advance();
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            EXPECT_TRUE(scene.bounds().contains(scene.boxes()[i]));
            EXPECT_TRUE(scene.boxes()[i].sizes().isApprox(boxes[i].sizes(), 1e-4F));
        }
    }
    EXPECT_NE(scene.boxes()[0].min(), boxes[0].min());
    EXPECT_EQ(scene.boxes()[2].min(), boxes[2].min()) << "a point has no size to drift by";
}

}  // namespace
}  // namespace hashphase::demos
