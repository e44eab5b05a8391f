// SPDX-License-Identifier: Zlib
#include <demos/accuracy/baselines/paper_map.hpp>
#include <demos/paper/phase_method.hpp>
#include <integration/ai/rarest_colour.hpp>

#include <algorithm>
#include <utility>

namespace hashphase::demos {
namespace {

/// The rarest colour that one agent sees, of equally rare ones the lowest. `forEachOther` calls what it is
/// given for all who may be near enough.
template <class ForEachOther>
std::uint32_t rarestAround(std::uint32_t agent, const TestBed& bed, float radius,
                           const ForEachOther& forEachOther) {
    std::array<std::uint32_t, TestBed::kColours> counts{};
    const Vector3<float> position = bed.centres()[agent];
    forEachOther([&](std::uint32_t other) {
        const Vector3<float>& at = bed.centres()[other];
        const float x = position.x() - at.x();
        const float y = position.y() - at.y();
        const float z = position.z() - at.z();
        if ((x * x + y * y) + z * z <= radius * radius && other != agent) {
            ++counts[bed.colours()[other]];
        }
    });
    return static_cast<std::uint32_t>(std::min_element(counts.begin(), counts.end()) -
                                      counts.begin());
}

/// Whose list has the subjects' colours.
class AiMethod : public ListMethod {
public:
    using ListMethod::ListMethod;

    [[nodiscard]] PhaseAnswer answer() const override {
        PhaseAnswer answer;
        for (std::size_t i = 0; i < list_.size(); ++i) {
            answer.found.push_back(keyOf(subjects_.list()[i], list_[i]));
        }
        return answer;
    }
};

/// Everybody looks at everybody.
class BruteAi final : public AiMethod {
public:
    using AiMethod::AiMethod;

    void run(const TestBed& bed) override {
        list_.clear();
        for (const std::uint32_t agent : subjects_.list()) {
            list_.push_back(rarestAround(agent, bed, radius_, [&](const auto& look) {
                for (std::uint32_t other = 0; other < bed.objects(); ++other) {
                    look(other);
                }
            }));
        }
    }
};

/// The paper's: agents filed by position, so that none is in two cells, and for each one all cells
/// that its radius touches.
class PaperAi final : public AiMethod {
public:
    PaperAi(const MethodPlan& plan, const TestBed& bed, Subjects subjects)
        : AiMethod(plan, bed, std::move(subjects)),
          map_(bed.domain(), static_cast<float>(plan.cellSize)) {}

    void hash(const TestBed& bed) override { map_.refile(bed.centres()); }

    void run(const TestBed& bed) override {
        // Rounded outward: a distance that is rounded down must not be beyond the last cell.
        const float reach = radius_ + 1e-4F * (1 + radius_);
        list_.resize(bed.objects());
        for (std::uint32_t agent = 0; agent < bed.objects(); ++agent) {
            const Vector3<float>& position = bed.centres()[agent];
            const PaperMap::Range cells = map_.range(position.x() - reach, position.z() - reach,
                                                     position.x() + reach, position.z() + reach);
            list_[agent] = rarestAround(agent, bed, radius_, [&](const auto& look) {
                for (int z = cells.lowZ; z <= cells.highZ; ++z) {
                    for (const std::uint32_t other : map_.row(cells.lowX, cells.highX, z)) {
                        look(other);
                    }
                }
            });
        }
    }

    [[nodiscard]] std::size_t memoryBytes() const override {
        return map_.memoryBytes() + AiMethod::memoryBytes();
    }

private:
    PaperMap map_;
};

/// The crowd sorts agents into cells of its own, which follow the radius; the grid's are refiled.
class HashAi final : public OnGrid<AiMethod> {
public:
    using OnGrid::OnGrid;

    void run(const TestBed& bed) override {
        list_.assign(bed.colours().begin(), bed.colours().end());
        rarest_.update(grid_, radius_, TestBed::kColours, list_);
    }

    [[nodiscard]] std::size_t memoryBytes() const override {
        return rarest_.memoryBytes() + OnGrid::memoryBytes();
    }

private:
    RarestColour<float> rarest_;
};

}  // namespace

std::unique_ptr<PhaseMethod> makeAiMethod(const MethodPlan& plan, const TestBed& bed,
                                          Subjects subjects) {
    return makeOneOf<BruteAi, PaperAi, HashAi>(plan, bed, std::move(subjects));
}

}  // namespace hashphase::demos
