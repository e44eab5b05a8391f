// SPDX-License-Identifier: Zlib
#include <demos/scenes/text_boxes.hpp>

#include <demos/console/format.hpp>
#include <demos/console/from_chars.hpp>
#include <demos/scenes/file_bytes.hpp>
#include <demos/scenes/input_error.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <system_error>

namespace hashphase::demos {
namespace {

constexpr std::string_view kBlanks = " \t\r";

// Leaves room for sums and differences of coordinates.
constexpr float kLargest = 1e30F;

// One line being read, which knows how to say where it is.
class LineReader {
public:
    LineReader(std::string_view line, std::size_t number) : line_(line), number_(number) {}

    [[nodiscard]] bool atEnd() {
        position_ = std::min(line_.find_first_not_of(kBlanks, position_), line_.size());
        return position_ == line_.size();
    }

    [[nodiscard]] float number() {
        if (atEnd()) {
            fail("the line has fewer than six numbers: min x y z max x y z");
        }
        const std::size_t end = std::min(line_.find_first_of(kBlanks, position_), line_.size());
        const std::string_view word = line_.substr(position_, end - position_);
        float value = 0;
        const auto [parsed, error] = fromChars(word.data(), word.data() + word.size(), value);
        if (error == std::errc::result_out_of_range) {
            fail(quotedWord(word) + " does not fit a single-precision number");
        }
        if (error != std::errc() || parsed != word.data() + word.size()) {
            fail("expected a number, found " + quotedWord(word));
        }
        if (!std::isfinite(value)) {
            fail(quotedWord(word) + " is not a finite number");
        }
        if (std::abs(value) > kLargest) {
            fail(quotedWord(word) + " is not between -1e30 and 1e30, the limits of coordinates");
        }
        lastStart_ = position_;
        position_ = end;
        return value;
    }

    [[noreturn]] void fail(const std::string& fault) const { failAt(position_, fault); }
    [[noreturn]] void failAtLast(const std::string& fault) const { failAt(lastStart_, fault); }

private:
    [[noreturn]] void failAt(std::size_t position, const std::string& fault) const {
        throw InputError("line " + std::to_string(number_) + ", column " +
                         std::to_string(position + 1) + ": " + fault + ".");
    }

    std::string_view line_;
    std::size_t number_;
    std::size_t position_ = 0;
    std::size_t lastStart_ = 0;
};

Aabb<float> readBox(LineReader& line) {
    Aabb<float> box;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        box.min()[axis] = line.number();
    }
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        box.max()[axis] = line.number();
        if (box.max()[axis] < box.min()[axis]) {
            line.failAtLast(std::string("the box is inverted: its max ") + "xyz"[axis] +
                            " is below its min");
        }
    }
    if (!line.atEnd()) {
        line.fail("the line has more than six numbers");
    }
    return box;
}

}  // namespace

std::vector<Aabb<float>> parseTextBoxes(std::string_view text, const TellWaiting& tell) {
    std::vector<Aabb<float>> boxes;
    std::size_t number = 0;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        LineReader line(text.substr(0, end), ++number);
        const bool comment = text.front() == '#';
        text.remove_prefix(std::min(end + 1, text.size()));
        if (!comment && !line.atEnd()) {
            boxes.push_back(readBox(line));
        }
        constexpr std::size_t kLinesBetweenWords = 10'000;
        if (tell && number % kLinesBetweenWords == 0) {
            tell("reading, " + withThousands(boxes.size()) + " boxes so far");
        }
    }
    if (boxes.empty()) {
        throw InputError("no boxes found; each line must be: min x y z max x y z.");
    }
    return boxes;
}

std::vector<Aabb<float>> readTextBoxes(const std::filesystem::path& path, const TellWaiting& tell) {
    const std::string text = readText(path);
    try {
        return parseTextBoxes(text, tell);
    } catch (const InputError& error) {
        throw InputError(path.string() + ": " + error.what());
    }
}

BrownianBoxes driftingBoxes(const std::vector<Aabb<float>>& boxes) {
    Aabb<float> room;
    for (const Aabb<float>& box : boxes) {
        room.extend(box.center());
    }
    BrownianBoxes drifting;
    drifting.bodies.reserve(boxes.size());
    for (const Aabb<float>& box : boxes) {
        const Vector3<float> halfEdges = box.sizes() / 2;
        drifting.bodies.push_back({box.center(), halfEdges, 0.2F * halfEdges.mean(), room});
    }
    return drifting;
}

}  // namespace hashphase::demos
