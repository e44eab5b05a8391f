// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/box_recorder.hpp>

#include <demos/scenes/input_error.hpp>
#include <demos/viewer/session/session.hpp>

#include <bit>
#include <fstream>

namespace hashphase::demos {
namespace {

static_assert(std::endian::native == std::endian::little, "Recordings are little-endian.");

class BoxFile {
public:
    explicit BoxFile(const std::filesystem::path& path)
        : path_(path.string()), file_(path, std::ios::binary) {
        refuseIfBad();
    }

    void name(std::string_view text) {
        std::array<char, 128> field{};
        text.copy(field.data(), field.size() - 1);
        file_.write(field.data(), field.size());
    }
    template <class Number>
    void number(Number value) {
        const auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(value);
        file_.write(bytes.data(), bytes.size());
    }
    void box(const Aabb<float>& box) {
        for (const Vector3<float>& corner : {box.min(), box.max()}) {
            for (int axis = 0; axis < 3; ++axis) {
                number(corner[axis]);
            }
            number(0.0F);
        }
    }
    void goTo(std::streamoff place) { file_.seekp(place); }
    void close() {
        file_.close();
        refuseIfBad();
    }

private:
    void refuseIfBad() const {
        if (!file_) {
            throw InputError(path_ + " cannot be written.");
        }
    }

    std::string path_;
    std::ofstream file_;
};

constexpr std::streamoff kWorldBoxPlace = 2 * 128 + 4 * 4;

// The boxes of bodies that are there and have an end.
std::vector<Aabb<float>> boxesOf(const Session& session) {
    std::vector<Aabb<float>> boxes;
    std::vector<CollisionFilter> filters;
    session.stage().listBoxes(boxes, filters);
    constexpr float kEnd = 1e6F;
    std::erase_if(boxes, [](const Aabb<float>& box) {
        return box.min().hasNaN() || box.min().cwiseAbs().maxCoeff() > kEnd ||
               box.max().cwiseAbs().maxCoeff() > kEnd;
    });
    return boxes;
}

}  // namespace

void recordBoxes(Session& session, const std::filesystem::path& path, int frames) {
    BoxFile file(path);
    std::vector<Aabb<float>> boxes = boxesOf(session);
    const std::size_t count = boxes.size();
    file.name(session.choice().name);
    file.name("hashphase wander");
    for (const auto number : {static_cast<std::int32_t>(count), std::int32_t{frames}, 0, 0}) {
        file.number(number);
    }
    Aabb<float> world;
    file.box({Vector3<float>::Zero(), Vector3<float>::Zero()});
    for (int frame = 0; frame <= frames; ++frame) {
        for (const Aabb<float>& box : boxes) {
            file.box(box);
            world.extend(box);
        }
        if (frame < frames) {
            session.askForSteps(1);
            session.advance();
            boxes = boxesOf(session);
        }
        if (boxes.size() != count) {
            throw InputError(path.string() + " is not complete: bodies have come or gone.");
        }
    }
    file.goTo(kWorldBoxPlace);
    file.box(world);
    file.close();
}

}  // namespace hashphase::demos
