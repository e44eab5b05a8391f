// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/core/ensure_capacity.hpp>
#include <broadphase/core/pair_key.hpp>
#include <broadphase/pair_filter.hpp>

#include <cstddef>
#include <vector>

namespace hashphase::detail {

/// What a call finds, from its beginning to its report. Keeps its memory.
struct PairCall {
    std::vector<PairKey> ended;     // what overlapped and does not any more, refused or not
    std::vector<PairKey> asked;     // what the filter is to be asked about
    std::vector<PairKey> standing;  // those of them that are pairs
    std::vector<char> accepted;     // the answers
    std::size_t refusedCount = 0;   // of these
    std::vector<PairKey> begun;     // pairs
    std::vector<PairKey> died;

    // What the end of the call changes besides: KnownPairs::kept by the first two, and what is not
    // refused any more.
    std::vector<PairKey> keptNow;
    std::vector<PairKey> notKept;
    std::vector<PairKey> lapsed;
    std::vector<PairKey> immediate;  // between updates: what is decided before the next one

    // Scratch.
    std::vector<ProxyPair> askedPairs;
    std::vector<PairKey> stillEnded;
    std::vector<PairKey> stillBegun;
    std::vector<PairKey> setAside;  // by an update what rests, by other calls what stays immediate
    std::vector<PairKey> sorted;

    void clear() noexcept {
        for (std::vector<PairKey>* keys :
             {&ended, &asked, &standing, &begun, &died, &keptNow, &notKept, &lapsed, &immediate}) {
            keys->clear();
        }
    }
    void releaseMemory() noexcept {
        freeArrays(ended, asked, standing, accepted, begun, died, keptNow, notKept, lapsed,
                   immediate, askedPairs, stillEnded, stillBegun, setAside, sorted);
    }
    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        std::size_t bytes = accepted.capacity() + askedPairs.capacity() * sizeof(ProxyPair);
        for (const std::vector<PairKey>* keys :
             {&ended, &asked, &standing, &begun, &died, &keptNow, &notKept, &lapsed, &immediate,
              &stillEnded, &stillBegun, &setAside, &sorted}) {
            bytes += keys->capacity() * sizeof(PairKey);
        }
        return bytes;
    }
};

/// What a call reports.
struct PairChangeLists {
    std::vector<ProxyPair> born;
    std::vector<ProxyPair> died;

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return (born.capacity() + died.capacity()) * sizeof(ProxyPair);
    }
};

}  // namespace hashphase::detail
