// SPDX-License-Identifier: Zlib

// The readers of files, on bytes that are nearly right and on bytes that are not. The first
// operation's kind chooses the reader; the others make up the file.

#include <tests/fuzz/life.hpp>
#include <tests/fuzz/palette.hpp>

#include <demos/scenes/bullet_world_file.hpp>
#include <demos/scenes/effects_file.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/scenes/recording_scene.hpp>
#include <demos/scenes/text_boxes.hpp>
#include <tests/demos/bullet_file.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <regex>
#include <span>
#include <sstream>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

namespace hashphase::test {
namespace {

using demos::InputError;

/// A file in memory, with a path.
class MemoryFile {
public:
    explicit MemoryFile(const std::string& bytes) : descriptor_(memfd_create("recording", 0)) {
        std::ofstream(path(), std::ios::binary) << bytes;
    }
    ~MemoryFile() { close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    [[nodiscard]] std::string path() const {
        return "/proc/self/fd/" + std::to_string(descriptor_);
    }

private:
    int descriptor_;
};

template <class Value>
void append(std::string& bytes, const Value& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// A recording of so many objects and frames.
std::string recording(std::int32_t objects, std::int32_t frames) {
    std::string bytes(256, '\0');
    for (const std::int32_t number : {objects, frames, 0, 0}) {
        append(bytes, number);
    }
    const auto states = static_cast<std::size_t>((frames + 1) * objects);
    for (std::size_t box = 0; box <= states; ++box) {
        for (int i = 0; i < 8; ++i) {
            append(bytes, static_cast<float>(box % 7) + static_cast<float>(i < 4 ? 0 : 1));
        }
    }
    return bytes;
}

/// A scene of effects that declares so many of them.
std::string sceneOfEffects(std::uint32_t count) {
    demos::EffectsFile file;
    for (std::uint32_t i = 0; i < count && i < kAllEffects.size(); ++i) {
        file.effects.declare(kAllEffects[i]);
    }
    return demos::effectsFileText(file);
}

/// What one line of text holds by a slow look: a box, nothing, or a fault; undecided where numbers
/// are so small or so many digits long that readers may differ.
struct TextLine {
    bool isBox = false;
    bool isFaulty = false;
    bool isUndecided = false;
    std::array<float, 6> numbers{};
};

bool looksLikeNumber(const std::string& word) {
    static const std::regex number(R"(-?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?)");
    return std::regex_match(word, number);
}

TextLine readTextLine(const std::string& text) {
    TextLine line;
    if (!text.empty() && text[0] == '#') {
        return line;
    }
    std::string blanks = text;
    for (char& letter : blanks) {
        letter = letter == '\t' || letter == '\r' ? ' ' : letter;
    }
    std::size_t count = 0;
    for (std::size_t at = blanks.find_first_not_of(' '); at != std::string::npos;) {
        const std::size_t end = std::min(blanks.find(' ', at), blanks.size());
        const std::string word = blanks.substr(at, end - at);
        at = blanks.find_first_not_of(' ', end);
        if (word.find('\0') != std::string::npos || !looksLikeNumber(word) || count == 6) {
            line.isFaulty = true;
            return line;
        }
        const float number = std::strtof(word.c_str(), nullptr);
        line.isUndecided = line.isUndecided || std::abs(number) < 2e-38F || word.size() > 60;
        line.isFaulty = line.isFaulty || !(std::abs(number) <= 1e30F);
        line.numbers[count++] = number;
    }
    line.isBox = count > 0;
    for (std::size_t axis = 0; axis < 3 && count == 6; ++axis) {
        line.isFaulty = line.isFaulty || line.numbers[axis + 3] < line.numbers[axis];
    }
    line.isFaulty = line.isFaulty || (count > 0 && count < 6);
    return line;
}

void expectBox(const Aabb<float>& box, std::span<const float> low, std::span<const float> high) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<Eigen::Index>(axis);
        ASSERT_EQ(box.min()[at], low[axis]);
        ASSERT_EQ(box.max()[at], high[axis]);
        ASSERT_LE(box.min()[at], box.max()[at]);
    }
}

class FilePlay {
public:
    FilePlay(const Operation& first, OperationLog& story) : story_(story), reader_(first.kind % 4) {
        Arguments arguments(first);
        const std::uint32_t size = arguments.below(4);
        if (reader_ == 1) {
            const std::uint32_t frames = arguments.below(3);
            bytes_ = recording(static_cast<std::int32_t>(size), static_cast<std::int32_t>(frames));
        } else if (reader_ == 2) {
            bytes_ = demos::serialisedWorld(static_cast<int>(size));
        } else if (reader_ == 3) {
            bytes_ = sceneOfEffects(5 * size);
        }
        story_.tell("reader ", reader_, " of ", size);
        read();
    }

    void play(const Operation& operation) {
        Arguments arguments(operation);
        if (reader_ == 0) {
            write(operation.kind, arguments);
        } else if (reader_ == 3) {
            replace(operation.kind, arguments);
        } else {
            damage(operation.kind, arguments);
        }
        read();
    }

private:
    // Words that make lines, mostly of boxes.
    void write(std::uint8_t kind, Arguments& arguments) {
        static const std::array<std::string, 16> words{
            "0",  "1",   "-1.5", "2e3",   "nan", "inf",  "1e31", "-0",
            "#x", "1e+", "\r",   "1e-46", "0x1", "1e39", "\t",   ".5"};
        std::string text;
        for (std::size_t i = 0; i < Operation::kArguments; ++i) {
            const std::uint8_t byte = arguments.byte();
            if (kind % 4 == 3) {
                text += static_cast<char>(byte);
            } else {
                text += words[byte < 128 ? byte % 3 : byte % words.size()];
                text += i % 6 == 5 || (byte >= 128 && byte / 16 % 8 == 1) ? '\n' : ' ';
            }
        }
        story_.tell("write ", text.size(), " letters");
        bytes_ += text;
    }

    // A name or a value by another one, or any letters by it.
    void replace(std::uint8_t kind, Arguments& arguments) {
        static const std::array<std::string, 24> words{
            "0",          "1",         "-1",        "1.5",       "1e999",    "4294967296",
            "\"none\"",   "\"title\"", "\"scene\"", "\"sweep\"", "\"mode\"", "\"bounds\"",
            "\"xyz\"",    "true",      "false",     "null",      "{}",       "[1, 2, 3]",
            "{\"up\":1}", "{",         "]",         ",",         "\"",       "\xff"};
        const std::string& word = words[arguments.below(words.size())];
        std::size_t begin = arguments.byte() + 256U * arguments.byte();
        begin %= bytes_.size() + 1;
        std::size_t length = arguments.below(4);
        if (kind % 4 != 3) {
            constexpr const char* kBetween = " ,:[]{}\n";
            begin = std::min(bytes_.find_first_not_of(kBetween, begin), bytes_.size());
            length = std::min(bytes_.find_first_of(kBetween, begin), bytes_.size()) - begin;
        }
        story_.tell("write ", word, " at ", begin, " for ", length, " letters");
        bytes_.replace(begin, length, word);
    }

    // Numbers where counts and lengths are, or anywhere; a file cut short or drawn out.
    void damage(std::uint8_t kind, Arguments& arguments) {
        if (bytes_.empty()) {
            return;
        }
        std::size_t place = arguments.byte();
        place += 256U * arguments.byte();
        std::uint32_t bits = 0;
        for (int i = 0; i < 4; ++i) {
            bits |= static_cast<std::uint32_t>(arguments.byte()) << (8 * i);
        }
        const auto value = static_cast<std::int32_t>(bits);
        if (reader_ == 1 && kind % 4 == 0) {
            place = 256 + place % 24 / 4 * 4;
        }
        place %= bytes_.size();
        story_.tell(kind % 8 == 7   ? "cut at "
                    : kind % 8 == 6 ? "add "
                                    : "write at ",
                    place, ": ", value);
        if (kind % 8 == 7) {
            bytes_.resize(place);
        } else if (kind % 8 == 6) {
            bytes_.append(place % 64, 'x');
        } else {
            const std::size_t length =
                std::min<std::size_t>(kind % 8 == 5 ? 1 : sizeof value, bytes_.size() - place);
            std::memcpy(bytes_.data() + place, &value, length);
        }
    }

    void read() {
        if (reader_ == 0) {
            readText();
        } else if (reader_ == 1) {
            readRecording();
        } else if (reader_ == 2) {
            readBulletFile();
        } else {
            readSceneOfEffects();
        }
    }

    void readText() {
        std::vector<std::array<float, 6>> expected;
        bool isFaulty = false;
        std::istringstream lines(bytes_);
        for (std::string text; !isFaulty && std::getline(lines, text);) {
            const TextLine line = readTextLine(text);
            if (line.isUndecided) {
                return;
            }
            isFaulty = line.isFaulty;
            if (line.isBox) {
                expected.push_back(line.numbers);
            }
        }
        std::optional<std::vector<Aabb<float>>> boxes;
        std::string fault;
        try {
            boxes = demos::parseTextBoxes(bytes_);
        } catch (const InputError& error) {
            fault = error.what();
        }
        if (isFaulty || expected.empty()) {
            EXPECT_FALSE(boxes.has_value());
            EXPECT_NE(fault.find(isFaulty ? ", column " : "no boxes"), std::string::npos) << fault;
            return;
        }
        ASSERT_TRUE(boxes.has_value()) << fault;
        ASSERT_EQ(boxes->size(), expected.size());
        for (std::size_t i = 0; i < expected.size(); ++i) {
            expectBox((*boxes)[i], expected[i], std::span(expected[i]).subspan(3));
        }
    }

    // What is played is what the bytes say, frame by frame.
    void readRecording() {
        const MemoryFile file(bytes_);
        try {
            demos::RecordingScene scene(file.path(), 0);
            std::array<std::int32_t, 2> counts{};
            ASSERT_GE(bytes_.size(), 304U);
            std::memcpy(counts.data(), bytes_.data() + 256, sizeof counts);
            const auto objects = static_cast<std::size_t>(counts[0]);
            ASSERT_EQ(scene.boxes().size(), objects);
            const auto states = static_cast<std::size_t>(counts[1]) + 1;
            ASSERT_EQ(bytes_.size(), 304 + states * objects * 32);
            for (std::size_t state = 0; state < states; ++state) {
                for (std::size_t i = 0; i < objects; ++i) {
                    std::array<float, 8> numbers{};
                    std::memcpy(numbers.data(), bytes_.data() + 304 + (state * objects + i) * 32,
                                sizeof numbers);
                    const Aabb<float>& box = scene.boxes()[i];
                    expectBox(box, numbers, std::span(numbers).subspan(4));
                    ASSERT_TRUE(scene.bounds().contains(box));
                }
                scene.advance();
            }
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(": byte "), std::string::npos) << error.what();
        }
    }

    // What is accepted is not any more when it is cut short.
    void readBulletFile() {
        const std::string fault = demos::bulletFileFault(bytes_);
        if (!fault.empty()) {
            return;
        }
        EXPECT_LT(demos::bulletFileOmissions(bytes_).size(), 100U);
        const std::size_t table = bytes_.rfind("DNA1");
        ASSERT_NE(table, std::string::npos);
        for (const std::size_t length :
             {std::size_t{0}, std::size_t{11}, bytes_.size() / 2, table}) {
            EXPECT_NE(demos::bulletFileFault(bytes_.substr(0, length)), "") << length;
        }
    }

    // What is read is right, and read again as it is written.
    void readSceneOfEffects() {
        try {
            const demos::EffectsFile file = demos::parseEffectsFile(bytes_, "scene");
            EXPECT_EQ(effectsError(file.effects), "");
            const std::string written = demos::effectsFileText(file);
            EXPECT_EQ(demos::effectsFileText(demos::parseEffectsFile(written, "again")), written);
        } catch (const InputError& error) {
            const std::string sentence = error.what();
            EXPECT_EQ(sentence.rfind("scene", 0), 0U) << sentence;
            EXPECT_TRUE(sentence.back() == '.' || sentence.back() == '?') << sentence;
        }
    }

    OperationLog& story_;
    std::uint32_t reader_;
    std::string bytes_;
};

}  // namespace

Verdict playFiles(std::span<const Operation> operations, bool tellsStory) {
    return playLife<FilePlay>(operations, tellsStory);
}

}  // namespace hashphase::test
