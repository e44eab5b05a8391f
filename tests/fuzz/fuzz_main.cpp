// SPDX-License-Identifier: Zlib

// What a fuzzer does with bytes: plays them on the subject that it is compiled for. A fault is shrunk, written to
// stderr as C++, and ends the program.

#include <tests/fuzz/operation.hpp>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hashphase::test;
    constexpr const Subject& subject = HASHPHASE_FUZZ_SUBJECT;
    const Operations operations = operationsOf({data, size});
    if (subject.play(operations, false).fault.empty()) {
        return 0;
    }
    const Operations least = shrunk(subject, operations);
    std::fprintf(stderr, "%s\n\nThe fewest operations that show it:\n\n%s\n",
                 subject.play(least, false).fault.c_str(), asSource(subject, least).c_str());
    std::abort();
}
