// SPDX-License-Identifier: Zlib

// main() for tests that are run once for each instruction set:
//
//     broadphase-tests [--instruction-set=scalar|SSE2|AVX2|AVX-512|NEON|SIMD128] [GoogleTest options]
//
// Tests are skipped where the processor or the build lacks the instructions.

#include <broadphase/simd/kernels.hpp>

#include <gtest/gtest.h>

#include <cstdio>
#include <string_view>

namespace {

using hashphase::detail::InstructionSet;

class NotAvailable : public testing::Environment {
public:
    void SetUp() override { GTEST_SKIP() << "the instruction set is not available here"; }
};

bool choose(std::string_view name) {
    for (const InstructionSet set : hashphase::detail::kInstructionSets) {
        if (name != hashphase::detail::nameOf(set)) {
            continue;
        }
        if (hashphase::detail::isAvailable(set)) {
            hashphase::detail::useInstructionSet(set);
        } else {
            testing::AddGlobalTestEnvironment(new NotAvailable);
        }
        return true;
    }
    return false;
}

}  // namespace

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    constexpr std::string_view option = "--instruction-set=";
    for (int i = 1; i < argc; ++i) {
        const std::string_view argument(argv[i]);
        if (!argument.starts_with(option) || !choose(argument.substr(option.size()))) {
            std::fprintf(stderr, "unknown argument: %s\n", argv[i]);
            return 2;
        }
    }
    return RUN_ALL_TESTS();
}
