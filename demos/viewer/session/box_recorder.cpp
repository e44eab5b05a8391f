// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/box_recorder.hpp>

#include <demos/console/format.hpp>
#include <demos/scenes/input_error.hpp>

#include <array>
#include <bit>
#include <ostream>

namespace hashphase::demos {
namespace {

static_assert(std::endian::native == std::endian::little, "Recordings are little-endian.");

constexpr std::streamoff kWorldBoxPlace = 2 * 128 + 4 * 4;

bool isNear(const Aabb<float>& box) {
    return box.min().cwiseAbs().maxCoeff() <= BoxRecorder::kFarthest &&
           box.max().cwiseAbs().maxCoeff() <= BoxRecorder::kFarthest;
}

std::string reach() {
    return withThousands(static_cast<std::uint64_t>(BoxRecorder::kFarthest)) + " m";
}

}  // namespace

BoxRecorder::BoxRecorder(const std::filesystem::path& path, std::string_view title,
                         const Stage& stage, int frames)
    : file_(path), frames_(frames) {
    stage.listBoxes(boxes_, filters_);
    for (std::uint32_t index = 0; index < boxes_.size(); ++index) {
        if (boxes_[index].min().hasNaN()) {
            continue;
        }
        if (isNear(boxes_[index])) {
            indices_.push_back(index);
        } else {
            ++leftOut_;
        }
    }
    if (indices_.empty()) {
        throw InputError(this->path() + " is not written: there are no bodies" +
                         (leftOut_ > 0 ? " but " + leftOutText() : "") + ".");
    }
    for (const std::string_view name : {title, std::string_view("hashphase wander")}) {
        std::array<char, 128> field{};
        name.copy(field.data(), field.size() - 1);
        file_.stream().write(field.data(), field.size());
    }
    for (const auto number :
         {static_cast<std::int32_t>(indices_.size()), std::int32_t{frames}, 0, 0}) {
        writeNumber(number);
    }
    writeBox(Aabb<float>(Vector3<float>::Zero(), Vector3<float>::Zero()));  // see putInPlace()
    writeFrame();
}

void BoxRecorder::add(const Stage& stage) {
    stage.listBoxes(boxes_, filters_);
    for (const std::uint32_t index : indices_) {
        const Aabb<float>& box = boxes_[index];
        if (box.min().hasNaN() || !isNear(box)) {
            throw InputError(faultSentence(
                "body " + std::to_string(index) +
                (box.min().hasNaN() ? " is gone"
                                    : " is farther than " + reach() + " from the origin")));
        }
    }
    writeFrame();
    if (count_ + 1 == frames_) {
        putInPlace();
    }
    ++count_;
}

std::string BoxRecorder::summary() const {
    return "wrote the boxes of " + withThousands(static_cast<std::uint64_t>(count_)) +
           " frames to " + path() + (leftOut_ == 0 ? "" : ", without " + leftOutText());
}

std::string BoxRecorder::progress() const {
    return withThousands(static_cast<std::uint64_t>(count_)) + " of " +
           withThousands(static_cast<std::uint64_t>(frames_)) + " frames";
}

std::string BoxRecorder::leftOutText() const {
    return withThousands(leftOut_) + (leftOut_ == 1 ? " body that is" : " bodies that are") +
           " farther than " + reach() + " from the origin";
}

std::string BoxRecorder::faultSentence(const std::string& reason) const {
    return path() + " is not written: " + reason + " after " + progress() + ".";
}

// --- Bytes ---------------------------------------------------------------------------------------

template <class Number>
void BoxRecorder::writeNumber(Number value) {
    const auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(value);
    file_.stream().write(bytes.data(), bytes.size());
}

void BoxRecorder::writeBox(const Aabb<float>& box) {
    for (const Vector3<float>& corner : {box.min(), box.max()}) {
        for (int axis = 0; axis < 3; ++axis) {
            writeNumber(corner[axis]);
        }
        writeNumber(0.0F);
    }
}

void BoxRecorder::writeFrame() {
    for (const std::uint32_t index : indices_) {
        writeBox(boxes_[index]);
        world_.extend(boxes_[index]);
    }
    file_.requireGood();
}

// The world's box is known at the end.
void BoxRecorder::putInPlace() {
    file_.stream().seekp(kWorldBoxPlace);
    writeBox(world_);
    file_.putInPlace();
}

}  // namespace hashphase::demos
