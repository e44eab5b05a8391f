// SPDX-License-Identifier: Zlib
#pragma once

// Ways to compute a phase of the paper's simulation.

#include <broadphase/grid.hpp>
#include <demos/paper/test_bed.hpp>
#include <demos/scenes/pair_key.hpp>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace hashphase::demos {

/// What the paper times apart from everything else, a figure each; paper.sql has what it printed.
enum class Phase : std::uint8_t { collision, visibility, ai };
inline constexpr std::array kPhases{Phase::collision, Phase::visibility, Phase::ai};
[[nodiscard]] std::string_view nameOf(Phase phase);

/// The rows and the columns of the figures.
inline constexpr std::array<std::uint32_t, 7> kPrintedObjects{500,    1'000,  2'500, 5'000,
                                                              10'000, 20'000, 50'000};
inline constexpr std::array<double, 5> kPrintedCellSizes{5, 10, 25, 50, 100};  // [m]

/// What a phase found, for comparison with what another method found.
struct PhaseAnswer {
    /// Keys, sorted. Collision: pairKey() of the two of each overlapping pair. Visibility: keyOf(object,
    /// object) of each visible one. AI: keyOf(object, its new colour).
    std::vector<std::uint64_t> found;

    /// Collision: of each object, the height at which it stands and its velocity, four numbers.
    std::vector<float> numbers;
};

[[nodiscard]] constexpr std::uint64_t keyOf(std::uint32_t high, std::uint32_t low) noexcept {
    return std::uint64_t{high} << 32 | low;
}

/// For whom the slow way is gone: for all, or for some objects drawn at random.
class Subjects {
public:
    [[nodiscard]] static Subjects all(std::uint32_t objects);
    [[nodiscard]] static Subjects drawn(std::uint32_t objects, std::uint32_t count,
                                        std::uint64_t seed);

    [[nodiscard]] bool areAll() const { return list_.size() == isOne_.size(); }
    [[nodiscard]] const std::vector<std::uint32_t>& list() const { return list_; }  // ascending
    [[nodiscard]] bool contains(std::uint32_t object) const { return isOne_[object] != 0; }

private:
    explicit Subjects(std::vector<char> isOne);

    std::vector<char> isOne_;  // by object
    std::vector<std::uint32_t> list_;
};

/// One way at work on a phase.
class PhaseMethod {
public:
    PhaseMethod() = default;
    PhaseMethod(const PhaseMethod&) = delete;
    PhaseMethod& operator=(const PhaseMethod&) = delete;
    virtual ~PhaseMethod() = default;

    /// Files all objects anew, as they are in the bed's present frame, where that is a step apart.
    virtual void hash(const TestBed& /*bed*/) {}

    /// Computes the phase for the frame, after hash() for it.
    virtual void run(const TestBed& bed) = 0;

    /// Puts all objects on the ground, after run(), where the phase has a ground. All three are timed.
    virtual void stand(const TestBed& /*bed*/) {}

    /// What was found for the last frame: for all objects, or for the subjects of brute force.
    [[nodiscard]] virtual PhaseAnswer answer() const = 0;

    /// Bytes held for all frames, those of spheres and triangles as they are handed in left out.
    [[nodiscard]] virtual std::size_t memoryBytes() const = 0;

    /// Of the cells that the spheres are filed in [m]; 0 where there are none.
    [[nodiscard]] virtual double cellSize() const { return 0; }
};

enum class MethodKind : std::uint8_t {
    unoptimized,  // everybody with everybody
    paperGrid,    // the paper's structure, its errors corrected
    hashphase,
};
[[nodiscard]] std::string_view nameOf(MethodKind kind);

/// What to make. Of hashphase a cell size of 0 is automatic.
struct MethodPlan {
    Phase phase = Phase::collision;
    MethodKind kind = MethodKind::hashphase;
    double cellSize = 0;  // [m]
    float aiRadius = 10;  // [m]
};

/// The method at work on the bed; un-optimized for the subjects, others for all, who are the subjects then.
using MakeMethod = std::unique_ptr<PhaseMethod>(const MethodPlan&, const TestBed&, Subjects);
[[nodiscard]] MakeMethod makeMethod;

// The same of a phase.
[[nodiscard]] MakeMethod makeCollisionMethod;
[[nodiscard]] MakeMethod makeVisibilityMethod;
[[nodiscard]] MakeMethod makeAiMethod;

/// The class of the plan's kind.
template <class Unoptimized, class PaperGrid, class Hashphase>
[[nodiscard]] std::unique_ptr<PhaseMethod> makeOneOf(const MethodPlan& plan, const TestBed& bed,
                                                     Subjects subjects) {
    if (plan.kind == MethodKind::unoptimized) {
        return std::make_unique<Unoptimized>(plan, bed, std::move(subjects));
    }
    if (plan.kind == MethodKind::paperGrid) {
        return std::make_unique<PaperGrid>(plan, bed, std::move(subjects));
    }
    return std::make_unique<Hashphase>(plan, bed, std::move(subjects));
}

/// A method that takes part, whatever the phase.
struct MethodSpec {
    MethodKind kind = MethodKind::hashphase;
    std::optional<double> cellSize;  // [m]; none: un-optimized has no cells, hashphase chooses them
    std::function<MakeMethod> make = makeMethod;
};

/// What methods have in common whose answer is a list.
class ListMethod : public PhaseMethod {
public:
    ListMethod(const MethodPlan& plan, const TestBed& /*bed*/, Subjects subjects)
        : radius_(plan.aiRadius), subjects_(std::move(subjects)) {}

    [[nodiscard]] std::size_t memoryBytes() const override {
        return list_.capacity() * sizeof(std::uint32_t);
    }

protected:
    float radius_;
    Subjects subjects_;
    std::vector<std::uint32_t> list_;
};

/// What methods of hashphase have in common: a grid with the spheres, of which object i is the proxy with
/// index i.
template <class Base>
class OnGrid : public Base {
public:
    OnGrid(const MethodPlan& plan, const TestBed& bed, Subjects subjects)
        : Base(plan, bed, std::move(subjects)), grid_({.cellSize = plan.cellSize}) {
        grid_.reserve(bed.objects());
        for (const Aabb<float>& box : bed.boxes()) {
            ids_.push_back(grid_.add(box));
        }
    }

    void hash(const TestBed& bed) override {
        moveAll(bed);
        grid_.update();
    }
    [[nodiscard]] double cellSize() const override { return static_cast<double>(grid_.cellSize()); }
    [[nodiscard]] std::size_t memoryBytes() const override {
        return grid_.memoryBytes() + ids_.capacity() * sizeof(ids_[0]) + Base::memoryBytes();
    }

protected:
    void moveAll(const TestBed& bed) {
        for (std::size_t i = 0; i < ids_.size(); ++i) {
            grid_.move(ids_[i], bed.boxes()[i]);
        }
    }

    Grid<float> grid_;

private:
    std::vector<ProxyId> ids_;
};

/// More objects than this are not compared all with all: it takes minutes.
inline constexpr std::uint32_t kMostBruteForced = 50'000;

/// The columns of a figure: un-optimized where there are not too many objects, the paper's grid and
/// hashphase at each printed cell size, hashphase on its own.
[[nodiscard]] std::vector<MethodSpec> figureMethods(std::uint32_t objects);

}  // namespace hashphase::demos
