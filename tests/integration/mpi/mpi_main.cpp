// SPDX-License-Identifier: Zlib
//
// GoogleTest on many ranks: each runs all tests, rank 0 tells of them, and every rank of what fails there.

#include <gtest/gtest.h>
#include <mpi.h>

#include <cstdio>
#include <memory>

namespace {

class FailuresOfRank : public testing::EmptyTestEventListener {
public:
    explicit FailuresOfRank(int rank) : rank_(rank) {}

private:
    void OnTestPartResult(const testing::TestPartResult& result) override {
        if (result.failed()) {
            std::printf("rank %d: %s:%d: %s\n", rank_, result.file_name(), result.line_number(),
                        result.summary());
            std::fflush(stdout);
        }
    }

    int rank_;
};

}  // namespace

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    testing::InitGoogleTest(&argc, argv);
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    if (rank != 0) {
        auto& listeners = testing::UnitTest::GetInstance()->listeners();
        delete listeners.Release(listeners.default_result_printer());
        listeners.Append(new FailuresOfRank(rank));
    }
    const int status = RUN_ALL_TESTS();
    const bool wereNone = testing::UnitTest::GetInstance()->test_to_run_count() == 0;
    MPI_Finalize();
    return wereNone ? 1 : status;
}
