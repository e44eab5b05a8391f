// SPDX-License-Identifier: Zlib

// Files that are none, that never end, that are too large, or that hold something else: each reader
// refuses each of them with a sentence.

#include <demos/scenes/bullet_world_file.hpp>
#include <demos/scenes/effects_file.hpp>
#include <demos/scenes/file_bytes.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/scenes/recording_scene.hpp>
#include <demos/scenes/text_boxes.hpp>
#include <tests/demos/bullet_file.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <sys/resource.h>
#include <sys/stat.h>

namespace hashphase::demos {
namespace {

struct Reader {
    const char* name;
    std::function<void(const std::string&)> read;
};

std::vector<Reader> readers() {
    return {
        {"effects", [](const std::string& path) { static_cast<void>(readEffectsFile(path)); }},
        {"text", [](const std::string& path) { static_cast<void>(readTextBoxes(path)); }},
        {"recording", [](const std::string& path) { const RecordingScene scene(path, 0); }},
        {"world", [](const std::string& path) { const BulletWorldFile file(path); }},
    };
}

/// All readers refuse the file, with its path and a sentence of bearable length that can be printed.
void expectRefused(const std::string& path, const std::string& why = {}) {
    for (const Reader& reader : readers()) {
        SCOPED_TRACE(reader.name);
        const std::string message = messageOf<InputError>([&] { reader.read(path); });
        EXPECT_EQ(message.rfind(path, 0), 0U) << message;
        EXPECT_NE(message.find(why), std::string::npos) << message;
        EXPECT_EQ(message.back(), '.') << message;
        EXPECT_LT(message.size(), path.size() + 200);
        EXPECT_EQ(message.find('\0'), std::string::npos);
    }
}

TEST(HostileFiles, ThatAreNoneAreRefused) {
    const TemporaryFolder folder;
    expectRefused(folder.file("none"),
                  folder.file("none") + " cannot be read: No such file or directory.");
    expectRefused(folder.file(""), folder.file("") + " is a folder, not a file.");
    expectRefused(folder.write("empty", ""));
}

TEST(HostileFiles, ThatTheSystemRefusesAreRefusedWithItsReason) {
    const TemporaryFolder folder;
    const std::string loop = folder.file("loop");
    std::filesystem::create_symlink("loop", loop);
    expectRefused(loop, loop + " cannot be read: Too many levels of symbolic links.");
    const std::string whole = folder.write("whole", "0 0 0 1 1 1");
    rlimit before{};
    getrlimit(RLIMIT_NOFILE, &before);
    const rlimit none{0, before.rlim_max};
    setrlimit(RLIMIT_NOFILE, &none);
    expectRefused(whole, whole + " cannot be read: Too many open files.");
    setrlimit(RLIMIT_NOFILE, &before);
}

// A reader that opened them would wait, or read, for ever.
TEST(HostileFiles, ThatNeverBeginOrNeverEndAreRefused) {
    const TemporaryFolder folder;
    ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
    expectRefused(folder.file("pipe"));
    expectRefused("/dev/zero");
    expectRefused("/dev/null");
    const std::string message = messageOf<InputError>([] { return readFile("/dev/zero"); });
    EXPECT_EQ(message,
              "/dev/zero is a device or a pipe, not a file: save its content to a file first.");
}

// It takes no room on the disk, and must take none in memory.
TEST(HostileFiles, ThatAreTooLargeAreNotRead) {
    const TemporaryFolder folder;
    const std::string path = folder.write("large", "");
    std::filesystem::resize_file(path, kLargestFile + 1);
    EXPECT_EQ(messageOf<InputError>([&] { return readFile(path); }),
              path + " has 1,073,741,825 bytes; a file may have at most 1,073,741,824.");
    expectRefused(path);
}

// As editors and spreadsheets of Windows write it.
TEST(TextFiles, MayBeginWithAByteOrderMarkAndEndLinesInAnyWay) {
    const TemporaryFolder folder;
    const std::string mark = "\xef\xbb\xbf";
    EXPECT_EQ(readText(folder.write("text", mark + "a\r\nb")), "a\r\nb");
    EXPECT_EQ(readText(folder.write("none", mark)), "");
    EXPECT_EQ(readTextBoxes(folder.write("boxes", mark + "0 0 0 1 1 1\r\n2 2 2 3 3 3\r\n")).size(),
              2U);
    EXPECT_EQ(messageOf<InputError>(
                  [&] { return readTextBoxes(folder.write("bad", mark + "zero 0 0 1 1 1")); }),
              folder.file("bad") + ": line 1, column 1: expected a number, found 'zero'.")
        << "columns are counted behind the mark";
    EXPECT_EQ(readEffectsFile(folder.write("scene", mark + "{\"scene\":\r\n{\"objects\": 7}}\r\n"))
                  .scene.objects,
              7U);
}

TEST(TextFiles, OfWideLettersAreRefusedByName) {
    const TemporaryFolder folder;
    const std::string why = " is UTF-16 or UTF-32: save it again as UTF-8.";
    using namespace std::string_literals;
    for (const std::string& bytes :
         {"\xff\xfe\x30\0"s, "\xfe\xff\0\x30"s, "0\0 \0"s, "\0{\0}"s, "\xff\xfe\0\0{\0\0\0"s}) {
        const std::string path = folder.write("wide", bytes);
        EXPECT_EQ(messageOf<InputError>([&] { return readTextBoxes(path); }), path + why);
        EXPECT_EQ(messageOf<InputError>([&] { return readEffectsFile(path); }), path + why);
    }
}

TEST(TextFiles, OfAnotherKindAreRefusedByItsName) {
    const TemporaryFolder folder;
    for (const auto& [bytes, why] :
         {std::pair<std::string, std::string>{"\x89PNG\r\n\x1a\n",
                                              " is a PNG picture, not a text file."},
          {"\x1f\x8b\b", " is a gzip archive, not a text file."},
          {"PK\3\4", " is a ZIP archive or an office document, not a text file."},
          {"BULLETf_v282",
           " is a world that Bullet saved, whose name should end in .bullet, not a text file."},
          {"0 0 0 1 1 1 # caf\xe9\n", " is not in UTF-8 (byte 18): save it again as UTF-8."},
          {std::string("0 0\0", 4), " is not a text file: byte 4 is 0."}}) {
        const std::string path = folder.write("other", bytes);
        EXPECT_EQ(messageOf<InputError>([&] { return readTextBoxes(path); }), path + why);
        EXPECT_EQ(messageOf<InputError>([&] { return readEffectsFile(path); }), path + why);
    }
    EXPECT_EQ(readText(folder.write("text", "caf\xc3\xa9 \xf0\x9f\x98\x80")),
              "caf\xc3\xa9 \xf0\x9f\x98\x80");
}

TEST(HostileFiles, ThatHoldSomethingElseAreRefused) {
    const TemporaryFolder folder;
    for (const std::string& bytes :
         {std::string(5000, '\0'), std::string(5000, '\xff'), "\x1b[2J" + std::string(2000, '\x7f'),
          std::string(100'000, '9'), std::string(100'000, '\n'), std::string(100'000, '['),
          "#" + std::string(100'000, ' ')}) {
        SCOPED_TRACE(static_cast<int>(bytes[0]));
        expectRefused(folder.write("else", bytes));
    }
}

TEST(HostileFiles, OfRightShapeAreReadWhateverTheLengthOfALine) {
    const std::string blanks(100'000, ' ');
    EXPECT_EQ(parseTextBoxes("0" + blanks + "0 0 1 1 1" + blanks).size(), 1U);
}

// Each 32-bit number in turn, of a whole world, becomes as bad as can be: the check of the outer shape
// finds it or it is none of its business, but it never reads beyond the file.
TEST(HostileFiles, WithHostileNumbersInAWorldAreReadWithinTheirBounds) {
    const std::string whole = serialisedWorld(1);
    for (const std::int32_t bad : {-1, 0x7fffffff}) {
        for (std::size_t place = 12; place + 4 <= whole.size(); place += 4) {
            // A heap block that ends with the bytes, so that a sanitizer sees what lies beyond.
            std::vector<char> bytes(whole.begin(), whole.end());
            std::memcpy(bytes.data() + place, &bad, sizeof bad);
            const std::string fault = bulletFileFault({bytes.data(), bytes.size()});
            EXPECT_TRUE(fault.empty() || fault.rfind("byte ", 0) == 0 ||
                        fault.rfind("the world", 0) == 0)
                << fault;
        }
    }
}

}  // namespace
}  // namespace hashphase::demos
