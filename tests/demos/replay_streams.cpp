// SPDX-License-Identifier: Zlib
#include <tests/demos/replay_streams.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace hashphase::demos {
namespace {

class StreamReader {
public:
    explicit StreamReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    std::uint32_t byte() {
        EXPECT_LT(at_, bytes_.size());
        return at_ < bytes_.size() ? bytes_[at_++] : 0U;
    }
    std::uint32_t groups() {
        std::uint32_t number = 0;
        for (unsigned shift = 0; shift < 32; shift += 7) {
            const std::uint32_t group = byte();
            number |= (group & 127U) << shift;
            if (group < 128) {
                break;
            }
        }
        return number;
    }
    void expectEnd() const { EXPECT_EQ(at_, bytes_.size()); }

private:
    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0;
};

}  // namespace

std::vector<std::vector<ReplayTrack::Sample>> readBoxes(std::span<const std::uint8_t> stream,
                                                        std::size_t objects, std::size_t frames) {
    StreamReader reader(stream);
    std::vector<std::vector<ReplayTrack::Sample>> all;
    std::vector<ReplayTrack::Sample> now(objects, ReplayTrack::Sample{});
    for (std::size_t frame = 0; frame < frames; ++frame) {
        for (std::size_t i = 0; i < objects; ++i) {
            const std::uint32_t changed = reader.byte();
            if (changed == 0) {
                i += reader.groups();
                continue;
            }
            for (std::size_t k = 0; k < now[i].size(); ++k) {
                if ((changed >> k & 1U) != 0) {
                    const std::uint32_t zigzag = reader.groups();
                    const std::uint32_t difference = zigzag >> 1 ^ (0U - (zigzag & 1U));
                    now[i][k] = static_cast<std::uint16_t>(now[i][k] + difference);
                }
            }
        }
        all.push_back(now);
    }
    reader.expectEnd();
    return all;
}

std::vector<std::vector<PairKey>> readPairs(std::span<const std::uint8_t> stream,
                                            std::size_t frames) {
    StreamReader reader(stream);
    std::vector<std::vector<PairKey>> all;
    std::vector<PairKey> now;
    for (std::size_t frame = 0; frame < frames; ++frame) {
        std::size_t at = 0;
        for (std::uint32_t deaths = reader.groups(); deaths > 0; --deaths) {
            at += reader.groups();
            now.erase(now.begin() + static_cast<std::ptrdiff_t>(at));
        }
        std::uint32_t a = 0;
        std::uint32_t b = 0;
        for (std::uint32_t births = reader.groups(); births > 0; --births) {
            const std::uint32_t next = a + reader.groups();
            b = (next == a ? b : next) + reader.groups();
            a = next;
            now.push_back(pairKey(a, b));
        }
        std::sort(now.begin(), now.end());
        all.push_back(now);
    }
    reader.expectEnd();
    return all;
}

std::vector<std::vector<Aabb<float>>> driftingFrames(std::size_t objects, std::size_t frames) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(0, 8);
    std::uniform_real_distribution<float> step(-0.2F, 0.2F);
    const auto vector = [&random](auto& numbers) {
        const float x = numbers(random);
        const float y = numbers(random);
        return Vector3<float>(x, y, numbers(random));
    };
    std::vector<Aabb<float>> boxes;
    for (std::size_t i = 0; i < objects; ++i) {
        const Vector3<float> low = vector(place);
        boxes.emplace_back(low, low + Vector3<float>(1, 1.25F, 0.75F));
    }
    std::vector<std::vector<Aabb<float>>> all;
    for (std::size_t frame = 0; frame < frames; ++frame) {
        all.push_back(boxes);
        for (std::size_t i = 0; i < objects; i += 2) {  // the others rest
            boxes[i].translate(vector(step));
        }
    }
    return all;
}

std::vector<PairKey> overlappingPairs(std::span<const Aabb<float>> boxes) {
    std::vector<PairKey> pairs;
    for (std::uint32_t a = 0; a < boxes.size(); ++a) {
        for (std::uint32_t b = a + 1; b < boxes.size(); ++b) {
            if (overlaps(boxes[a], boxes[b])) {
                pairs.push_back(pairKey(a, b));
            }
        }
    }
    return pairs;
}

}  // namespace hashphase::demos
