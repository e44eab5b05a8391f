// SPDX-License-Identifier: Zlib
#pragma once

// Random lives, written down as operations: numbers that mean something whatever they are, so that
// whoever makes them up (a property test, a fuzzer, a person) needs to know nothing.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace hashphase::test {

/// What is done, and with what. Arguments that are not there count as 0.
struct Operation {
    static constexpr std::size_t kArguments = 15;

    std::uint8_t kind = 0;
    std::array<std::uint8_t, kArguments> arguments{};

    friend bool operator==(const Operation&, const Operation&) = default;
};

using Operations = std::vector<Operation>;

/// Longer lives are cut short.
inline constexpr std::size_t kMostOperations = 256;

/// Sixteen bytes an operation; the last one may be shorter.
[[nodiscard]] Operations operationsOf(std::span<const std::uint8_t> bytes);

/// How a life went.
struct Verdict {
    std::string fault;  // the first thing that was not as it should be; empty when all was well
    std::size_t length = 0;          // operations played, the faulty one included
    std::vector<std::string> story;  // of each operation, when it was asked for
};

/// A structure under test with its naive model. The first operation says how they are made; after
/// each of the others they are compared.
struct Subject {
    const char* name;
    Verdict (*play)(std::span<const Operation> operations, bool tellsStory);
};

// The subjects. The first bit of the first operation's kind chooses the precision, but for Bullet's, which are
// compiled for either.
using Play = Verdict(std::span<const Operation> operations, bool tellsStory);

/// The grid: changes, updates, and every query but those of pairs.
Play playGrid;
inline constexpr Subject kGrid{"grid", &playGrid};

/// Pairs and sweeps over a grid, with a filter that changes its mind.
Play playPairs;
inline constexpr Subject kPairs{"pairs", &playPairs};

/// Picking, culling, zones, radar, sight and terrain over one grid.
Play playClients;
inline constexpr Subject kClients{"clients", &playClients};

/// SpatialHashBroadphase with its queries and batches, over several pair caches; and PairCache
/// under btDbvtBroadphase.
Play playBroadphase;
inline constexpr Subject kBroadphase{"broadphase", &playBroadphase};

/// PairCache by itself.
Play playCache;
inline constexpr Subject kCache{"cache", &playCache};

/// The readers of recordings, of boxes as text and of the outer shape of .bullet files.
Play playFiles;
inline constexpr Subject kFiles{"files", &playFiles};

/// The operations as C++, one a line, with what each of them does beside it: what is between the
/// braces may stand in a test.
[[nodiscard]] std::string asSource(const Subject& subject, std::span<const Operation> operations);

/// Fewer operations with smaller arguments that still end in a fault, found by leaving out; those given
/// must end in one. Cost: some hundred lives.
[[nodiscard]] Operations shrunk(const Subject& subject, Operations operations);

}  // namespace hashphase::test
