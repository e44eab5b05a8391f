// SPDX-License-Identifier: Zlib
#include <demos/scenes/input_error.hpp>
#include <demos/scenes/recording_scene.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace hashphase::demos {
namespace {

constexpr std::size_t kHeaderBytes = 304;
constexpr std::size_t kBoxBytes = 32;

template <class Number>
void append(std::string& bytes, Number number) {
    char raw[sizeof number];
    std::memcpy(raw, &number, sizeof number);
    bytes.append(raw, sizeof number);
}

void appendBox(std::string& bytes, float low, float high) {
    for (const float corner : {low, high}) {
        for (int axis = 0; axis < 3; ++axis) {
            append(bytes, corner + static_cast<float>(axis));
        }
        append(bytes, 0.0F);
    }
}

// Object i of state s spans from 10 i + s to 10 i + s + 1, shifted by one from axis to axis.
std::string recording(std::int32_t objects, std::int32_t frames) {
    std::string bytes(256, 'n');
    for (const std::int32_t number : {objects, frames, 0, 0}) {
        append(bytes, number);
    }
    appendBox(bytes, -1000, 1000);
    for (std::int32_t state = 0; state <= frames; ++state) {
        for (std::int32_t i = 0; i < objects; ++i) {
            const auto low = static_cast<float>(10 * i + state);
            appendBox(bytes, low, low + 1);
        }
    }
    return bytes;
}

template <class Number>
void overwrite(std::string& bytes, std::size_t place, Number number) {
    std::memcpy(bytes.data() + place, &number, sizeof number);
}

std::string faultIn(const std::string& bytes) {
    const TemporaryFolder folder;
    const std::string path = folder.write("r.aabbs", bytes);
    const std::string message =
        messageOf<InputError>([&path] { const RecordingScene scene(path, 0); });
    EXPECT_EQ(message.rfind(path + ": byte ", 0), 0U) << message;
    return message.substr(std::min(message.size(), path.size() + 2));
}

TEST(Recording, PlaysTheInitialStateAndEveryFrame) {
    const TemporaryFolder folder;
    RecordingScene scene(folder.write("r.aabbs", recording(3, 2)), 0);
    ASSERT_EQ(scene.boxes().size(), 3U);
    EXPECT_EQ(scene.frameLimit(), 3);
    for (int state = 0; state <= 2; ++state) {
        EXPECT_EQ(scene.boxes()[2].min().x(), 20 + static_cast<float>(state));
        EXPECT_EQ(scene.boxes()[2].max().z(), 23 + static_cast<float>(state));
        scene.advance();
    }
    EXPECT_EQ(scene.boxes()[2].min().x(), 22) << "past the last frame it stays";
    EXPECT_EQ(scene.bounds().min(), Vector3<float>(0, 1, 2));
    EXPECT_EQ(scene.bounds().max(), Vector3<float>(23, 24, 25));
}

TEST(Recording, PlaysTheFirstObjectsWhenFewerAreAskedFor) {
    const TemporaryFolder folder;
    const std::string path = folder.write("r.aabbs", recording(3, 1));
    RecordingScene scene(path, 2);
    scene.advance();
    ASSERT_EQ(scene.boxes().size(), 2U);
    EXPECT_EQ(scene.boxes()[1].min().x(), 11);
    EXPECT_EQ(messageOf<InputError>([&path] { const RecordingScene more(path, 4); }),
              path + " holds 3 objects, but --objects asks for 4.");
}

TEST(Recording, IsRefusedWhenTruncatedAtAnyByte) {
    const std::string whole = recording(2, 1);
    for (std::size_t length = 0; length < whole.size(); ++length) {
        const std::string fault = faultIn(whole.substr(0, length));
        EXPECT_EQ(fault.rfind("byte " + std::to_string(length) + ": the file ends in", 0), 0U)
            << fault;
    }
}

TEST(Recording, IsRefusedWhenItGoesOnBeyondItsCounts) {
    EXPECT_EQ(faultIn(recording(2, 1) + "x"),
              "byte 432: the recording ends here (2 objects, 1 frames), but the file has more "
              "bytes.");
}

TEST(Recording, IsRefusedForHostileCountsWithoutAllocatingThem) {
    constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
    for (const std::int32_t count : {kMost, 0, -1, std::numeric_limits<std::int32_t>::min()}) {
        std::string bytes = recording(2, 1);
        overwrite(bytes, 256, count);
        EXPECT_NE(faultIn(bytes).find(count > 0 ? "byte 432: the file ends in state 0, but"
                                                : "byte 256: the object count is"),
                  std::string::npos);
    }
    for (const std::int32_t count : {kMost, -1}) {
        std::string bytes = recording(2, 1);
        overwrite(bytes, 260, count);
        EXPECT_NE(faultIn(bytes).find("byte 260: the frame count is"), std::string::npos);
    }
    std::string bytes = recording(2, 1);
    overwrite(bytes, 256, kMost);
    overwrite(bytes, 260, std::int32_t{1'000'000'000});
    EXPECT_NE(faultIn(bytes).find("must hold 1000000001 states of 2147483647 objects each"),
              std::string::npos);
}

TEST(Recording, IsRefusedForNanAndInfinityAndNamesTheByte) {
    for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
        std::string bytes = recording(2, 1);
        overwrite(bytes, kHeaderBytes + 3 * kBoxBytes + 4, bad);
        EXPECT_EQ(faultIn(bytes),
                  "byte 400: object 1 of state 1 has a coordinate that is not a "
                  "finite number.");
    }
}

TEST(Recording, IsRefusedForInvertedBoxesAndNamesTheAxis) {
    std::string bytes = recording(2, 1);
    overwrite(bytes, kHeaderBytes + 16 + 8, -5.0F);
    EXPECT_EQ(faultIn(bytes),
              "byte 304: object 0 of state 0 is inverted: its max z is below its min.");
}

}  // namespace
}  // namespace hashphase::demos
