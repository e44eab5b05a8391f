// SPDX-License-Identifier: Zlib
#pragma once

// A hard case: an input on which plain code goes wrong, and what is required instead. Every outcome is
// found by running it; nothing is known beforehand.
//
// `hashphase stability` runs the cases with our broadphase and Bullet's; tests run them with our
// broadphase, and with our grid alone in both precisions, of which more is asked.

#include <demos/stability/case_tally.hpp>
#include <demos/stability/subject.hpp>

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace hashphase::demos {

/// Who runs a case, how much of it, and what comes out.
template <class Scalar>
struct CaseRun : CaseTally {
    using Number = Scalar;

    MakeSubject<Scalar> make = makeGridSubject<Scalar>;
    std::string_view name = "grid";
    bool isOurs = true;
    bool isQuick = false;
    std::uint64_t seed = 1;

    /// What rays of ours find by rayTest(), where Bullet's btRayAabb2() decides.
    CaseTally throughBullet;

    template <class Amount>
    [[nodiscard]] Amount quickOrFull(Amount quick, Amount full) const {
        return isQuick ? quick : full;
    }
};

/// The precision of a run of which a case knows the type alone: decltype(run).
template <class Run>
using ScalarOf = typename std::remove_reference_t<Run>::Number;

struct HardCase {
    const char* id;        // "H16"
    const char* name;      // a few words
    const char* input;     // exactly what is handed in
    const char* required;  // of a subject that holds

    // Runs one subject through it; one of the two is missing where only Bullet's precision will do.
    void (*inSingle)(CaseRun<float>& run) = nullptr;
    void (*inDouble)(CaseRun<double>& run) = nullptr;

    /// `run` takes a CaseRun of either precision, or of Bullet's.
    template <class Run>
    constexpr HardCase(const char* itsId, const char* itsName, const char* itsInput,
                       const char* isRequired, const Run& run)
        : id(itsId), name(itsName), input(itsInput), required(isRequired) {
        if constexpr (std::is_convertible_v<Run, decltype(inSingle)>) {
            inSingle = run;
        }
        if constexpr (std::is_convertible_v<Run, decltype(inDouble)>) {
            inDouble = run;
        }
    }

    template <class Scalar>
    [[nodiscard]] auto in() const {
        if constexpr (std::is_same_v<Scalar, float>) {
            return inSingle;
        } else {
            return inDouble;
        }
    }
};

/// The cases of some groups, by their numbers.
[[nodiscard]] std::vector<HardCase> inOrder(
    std::initializer_list<std::span<const HardCase>> groups);

/// Of any subject: numbers, borders, rays, sweeps, sizes, crowds, views, going back.
[[nodiscard]] std::span<const HardCase> gridCases();

/// Of broadphases by Bullet's interface, in its precision: bodies, and callbacks that ask and change.
[[nodiscard]] std::span<const HardCase> bulletCases();

/// H1 to H48, in that order: both.
[[nodiscard]] std::span<const HardCase> hardCases();

/// Whether the outcome is as required.
[[nodiscard]] inline bool holds(const CaseOutcome& outcome) {
    return outcome.kind == OutcomeKind::exact;
}

}  // namespace hashphase::demos
