// SPDX-License-Identifier: Zlib
#pragma once

#include <mpi.h>

namespace hashphase::test {

/// Of this process in MPI_COMM_WORLD.
[[nodiscard]] inline int rankHere() {
    int rank = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return rank;
}

[[nodiscard]] inline int rankCount() {
    int count = 1;
    MPI_Comm_size(MPI_COMM_WORLD, &count);
    return count;
}

}  // namespace hashphase::test
