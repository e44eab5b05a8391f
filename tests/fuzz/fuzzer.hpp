// SPDX-License-Identifier: Zlib
#pragma once

// What a fuzzer does with bytes.

#include <tests/fuzz/operation.hpp>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace hashphase::test {

/// Plays the bytes. A fault is shrunk, written to stderr as C++, and ends the program.
inline int fuzz(const Subject& subject, const std::uint8_t* data, std::size_t size) {
    const Operations operations = operationsOf({data, size});
    const Verdict verdict = subject.play(operations, false);
    if (verdict.fault.empty()) {
        return 0;
    }
    const Operations least = shrunk(subject, operations);
    std::fprintf(stderr, "%s\n\nThe fewest operations that show it:\n\n%s\n",
                 subject.play(least, false).fault.c_str(), asSource(subject, least).c_str());
    std::abort();
}

}  // namespace hashphase::test
