// SPDX-License-Identifier: Zlib
#include <tests/fuzz/fuzzer.hpp>
#include <tests/fuzz/subjects.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace hashphase::test;
    return fuzz(kFiles, data, size);
}
