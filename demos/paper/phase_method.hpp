// SPDX-License-Identifier: Zlib
#pragma once

// Ways to compute a phase of the paper's simulation.

#include <demos/paper/printed_figures.hpp>
#include <demos/paper/test_bed.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace hashphase::demos {

/// What a phase found, for comparison with what another method found.
struct PhaseAnswer {
    /// Collision: the overlapping pairs, pairKeyOf() each, sorted. Visibility: the objects,
    /// sorted. AI: the new colour of each object.
    std::vector<std::uint64_t> found;

    /// Collision: of each object, the height at which it stands and its velocity, four numbers.
    std::vector<float> numbers;
};

/// Of two objects, the smaller one first.
[[nodiscard]] constexpr std::uint64_t pairKeyOf(std::uint32_t a, std::uint32_t b) noexcept {
    return a < b ? std::uint64_t{a} << 32 | b : std::uint64_t{b} << 32 | a;
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
    std::vector<std::uint32_t> list_;
    std::vector<char> isOne_;  // by object
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

/// A method to be made for a bed.
struct MethodSpec {
    MethodKind kind = MethodKind::hashphase;
    std::optional<double> cellSize;  // [m]; none: un-optimized has no cells, hashphase chooses them
    std::function<std::unique_ptr<PhaseMethod>(const TestBed&)> make;
};

/// Everything with everything, for the subjects: what all others are compared with.
[[nodiscard]] std::unique_ptr<PhaseMethod> bruteForce(Phase phase, Subjects subjects,
                                                      float aiRadius);

/// The method of that kind; a grid of the paper's has a cell size.
[[nodiscard]] MethodSpec methodSpec(Phase phase, MethodKind kind, std::optional<double> cellSize,
                                    float aiRadius);

/// More objects than this are not compared all with all: it takes minutes.
inline constexpr std::uint32_t kMostBruteForced = 50'000;

/// The columns of a figure: un-optimized where there are not too many objects, the paper's grid and
/// hashphase at each printed cell size, hashphase on its own.
[[nodiscard]] std::vector<MethodSpec> figureMethods(Phase phase, std::uint32_t objects,
                                                    float aiRadius);

}  // namespace hashphase::demos
