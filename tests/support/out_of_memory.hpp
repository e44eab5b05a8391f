// SPDX-License-Identifier: Zlib
#pragma once

// What becomes of something for which memory runs out, at each of its allocations in turn.

#include <broadphase/parallel_for.hpp>
#include <tests/support/count_allocations.hpp>

#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <new>
#include <string>

namespace hashphase::test {

/// Makes a World, lets attempt(world) run out of memory at its first allocation, and calls
/// check(world, n); the same with a new world and the second allocation, and so on, until the attempt
/// comes to its end, after which check() is called too. Nothing must be left of any world. Returns
/// how often it failed.
template <class MakeWorld, class Attempt, class Check>
std::size_t runOutOfMemory(const MakeWorld& make, const Attempt& attempt, const Check& check) {
    for (std::size_t n = 0;; ++n) {
        SCOPED_TRACE("after " + std::to_string(n) + " allocations");
        bool hasFailed = false;
        const std::size_t heldBefore = blocksHeld();
        {
            auto world = make();
            try {
                const FailingAllocations failing(n);
                attempt(*world);
            } catch (const std::bad_alloc&) {
                hasFailed = true;
            }
            check(*world, n);
        }
        EXPECT_EQ(blocksHeld(), heldBefore) << "blocks are left";
        if (!hasFailed || testing::Test::HasFatalFailure()) {
            return n;
        }
    }
}

/// Updates the pairs of a PairWorld while memory may run out: for them alone.
template <class World>
void updatePairsInWant(World& world, ParallelFor parallelFor = serialFor) {
    const auto accept = [&world](auto a, auto b) { return world.colours.accept(a, b); };
    const auto changes = world.pairs.update(accept, parallelFor);
    const WorkingAllocations lifted;
    world.apply(changes);
}

/// A query that runs out of memory, and is asked again, is answered as if it had not: ask() of a fresh
/// Asked fails at each of its allocations in turn, then ask() and answer() are as those of another.
/// Returns how often it failed.
template <class Asked>
std::size_t askOutOfMemory() {
    Asked whole;
    whole.ask();
    return runOutOfMemory([] { return std::make_unique<Asked>(); },
                          [](Asked& asked) { asked.ask(); },
                          [&](Asked& asked, std::size_t) {
                              asked.ask();
                              EXPECT_EQ(asked.answer(), whole.answer());
                          });
}

}  // namespace hashphase::test
