// SPDX-License-Identifier: Zlib
#include <demos/accuracy/baselines/paper_map.hpp>
#include <demos/paper/phase_makers.hpp>

#include <algorithm>
#include <utility>

namespace hashphase::demos {
namespace {

using ColourCounts = std::array<std::uint32_t, TestBed::kColours>;

bool areNear(const Vector3<float>& a, const Vector3<float>& b, float radius) {
    const float x = a.x() - b.x();
    const float y = a.y() - b.y();
    const float z = a.z() - b.z();
    return (x * x + y * y) + z * z <= radius * radius;
}

/// Of equally rare ones the lowest.
std::uint32_t rarestOf(const ColourCounts& counts) {
    return static_cast<std::uint32_t>(std::min_element(counts.begin(), counts.end()) -
                                      counts.begin());
}

/// Everybody looks at everybody.
class BruteAi final : public PhaseMethod {
public:
    BruteAi(Subjects subjects, float radius) : subjects_(std::move(subjects)), radius_(radius) {}

    void run(const TestBed& bed) override {
        colours_.clear();
        for (const std::uint32_t agent : subjects_.list()) {
            ColourCounts counts{};
            const Vector3<float> position = bed.centres()[agent];
            for (std::uint32_t other = 0; other < bed.objects(); ++other) {
                if (areNear(position, bed.centres()[other], radius_) && other != agent) {
                    ++counts[bed.colours()[other]];
                }
            }
            colours_.push_back(rarestOf(counts));
        }
    }

    [[nodiscard]] PhaseAnswer answer() const override {
        return {{colours_.begin(), colours_.end()}, {}};
    }
    [[nodiscard]] std::size_t memoryBytes() const override {
        return colours_.capacity() * sizeof(std::uint32_t);
    }

private:
    Subjects subjects_;
    float radius_;
    std::vector<std::uint32_t> colours_;  // by subject
};

/// The paper's: agents filed by position, so that none is in two cells, and for each one all cells
/// that its radius touches.
class PaperAi final : public PhaseMethod {
public:
    PaperAi(const TestBed& bed, float cellSize, float radius)
        : map_(bed.domain(), cellSize), radius_(radius) {}

    void hash(const TestBed& bed) override { map_.refile(bed.centres()); }

    void run(const TestBed& bed) override {
        colours_.resize(bed.objects());
        for (std::uint32_t agent = 0; agent < bed.objects(); ++agent) {
            colours_[agent] = rarestOf(countsAround(agent, bed));
        }
    }

    [[nodiscard]] PhaseAnswer answer() const override {
        return {{colours_.begin(), colours_.end()}, {}};
    }
    [[nodiscard]] std::size_t memoryBytes() const override {
        return map_.memoryBytes() + colours_.capacity() * sizeof(std::uint32_t);
    }

private:
    [[nodiscard]] ColourCounts countsAround(std::uint32_t agent, const TestBed& bed) const {
        // Rounded outward: a distance that is rounded down must not be beyond the last cell.
        const float reach = radius_ + 1e-4F * (1 + radius_);
        const Vector3<float> position = bed.centres()[agent];
        const PaperMap::Range cells = map_.range(position.x() - reach, position.z() - reach,
                                                 position.x() + reach, position.z() + reach);
        ColourCounts counts{};
        for (int z = cells.lowZ; z <= cells.highZ; ++z) {
            for (const std::uint32_t other : map_.row(cells.lowX, cells.highX, z)) {
                if (areNear(position, bed.centres()[other], radius_) && other != agent) {
                    ++counts[bed.colours()[other]];
                }
            }
        }
        return counts;
    }

    PaperMap map_;
    float radius_;
    std::vector<std::uint32_t> colours_;
};

}  // namespace

std::unique_ptr<PhaseMethod> bruteAi(Subjects subjects, float radius) {
    return std::make_unique<BruteAi>(std::move(subjects), radius);
}

std::unique_ptr<PhaseMethod> paperAi(const TestBed& bed, float cellSize, float radius) {
    return std::make_unique<PaperAi>(bed, cellSize, radius);
}

}  // namespace hashphase::demos
