// SPDX-License-Identifier: Zlib
#include <tests/fuzz/property.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#if HASHPHASE_HAS_RAPIDCHECK
#include <rapidcheck.h>
#endif

namespace hashphase::test {

void expectNoFault(const Subject& subject, const Operations& operations) {
    const std::string fault = subject.play(operations, false).fault;
    EXPECT_TRUE(fault.empty()) << fault << '\n' << asSource(subject, operations);
}

void expectNoFaultInCorpus(const Subject& subject) {
    const std::filesystem::path folder =
        std::filesystem::path(HASHPHASE_FUZZ_CORPUS) / subject.name;
    std::size_t played = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        SCOPED_TRACE(entry.path().filename().string());
        std::ifstream file(entry.path(), std::ios::binary);
        const std::vector<std::uint8_t> bytes((std::istreambuf_iterator<char>(file)),
                                              std::istreambuf_iterator<char>());
        expectNoFault(subject, operationsOf(bytes));
        ++played;
    }
    EXPECT_GT(played, 0U) << "nothing in " << folder;
}

#if HASHPHASE_HAS_RAPIDCHECK

namespace {

// All bytes are as likely, whatever the size that rapidcheck has come to; less is simpler.
rc::Gen<Operation> anyOperation() {
    const auto byte = rc::gen::resize(rc::kNominalSize, rc::gen::arbitrary<std::uint8_t>());
    return rc::gen::build<Operation>(
        rc::gen::set(&Operation::kind, byte),
        rc::gen::set(&Operation::arguments,
                     rc::gen::container<std::array<std::uint8_t, Operation::kArguments>>(byte)));
}

}  // namespace

void expectNoFaultInRandomLives(const Subject& subject) {
    setenv("RC_PARAMS", "seed=20261122 max_success=250 max_size=100", 0);
    const bool isRight = rc::check(subject.name, [&subject] {
        const auto operations = *rc::gen::container<Operations>(anyOperation());
        const std::string fault = subject.play(operations, false).fault;
        if (!fault.empty()) {
            RC_FAIL(fault + "\n\nThe fewest operations that show it:\n\n" +
                    asSource(subject, operations));
        }
    });
    EXPECT_TRUE(isRight) << "see above";
}

#else

void expectNoFaultInRandomLives(const Subject& /*subject*/) {
    GTEST_SKIP() << "rapidcheck is not installed (Debian, Ubuntu: librapidcheck-dev)";
}

#endif

}  // namespace hashphase::test
