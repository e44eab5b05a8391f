// SPDX-License-Identifier: Zlib

// 2,000 balls in a box, shared by the processes of an MPI program: mpirun -n 3 ranks
//
// You should see how the balls are shared, and that they touch each other as often however many processes there are.
// All begin on rank 0; the grid moves each to the rank that owns its place, and what a ball is travels along.

#include <integration/mpi/distributed_grid.hpp>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>

using namespace hashphase;

struct Ball {
    std::array<float, 3> at{};        // [m]
    std::array<float, 3> velocity{};  // [m / frame]
};

Aabb<float> boxOf(const Ball& ball) {
    return boxAround<float>({ball.at[0], ball.at[1], ball.at[2]}, 0.5F);
}

float drawn(std::uint32_t& seed) {
    seed = seed * 1664525U + 1013904223U;
    return static_cast<float>(seed >> 8) / 16777216.0F;
}

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    {
        DistributedConfig config;
        config.rankGrid.payloadBytes = sizeof(Ball);
        DistributedGrid<float> grid(MPI_COMM_WORLD, config);
        const std::uint32_t rank = grid.here().rank();
        std::uint32_t seed = 1;
        for (std::uint64_t i = 0; rank == 0 && i < 2000; ++i) {
            Ball ball;
            for (int axis = 0; axis < 3; ++axis) {
                ball.at[axis] = 30 * drawn(seed);
                ball.velocity[axis] = 0.4F * drawn(seed) - 0.2F;
            }
            const ProxyId id = grid.add(GlobalId{i}, boxOf(ball));
            std::memcpy(grid.payload(id).data(), &ball, sizeof(ball));
        }
        std::uint64_t touches = 0;  // that begin, and that this rank reports
        for (int frame = 0; frame < 200; ++frame) {
            touches += grid.update().pairs.born.size();
            grid.here().forEachOwned([&](ProxyId id, const Aabb<float>&) {
                Ball ball;
                std::memcpy(&ball, grid.payload(id).data(), sizeof(ball));
                for (int axis = 0; axis < 3; ++axis) {
                    ball.at[axis] += ball.velocity[axis];
                    if (ball.at[axis] < 0 || ball.at[axis] > 30) {
                        ball.velocity[axis] = -ball.velocity[axis];
                    }
                }
                std::memcpy(grid.payload(id).data(), &ball, sizeof(ball));
                grid.move(id, boxOf(ball));
            });
        }
        std::uint64_t all = 0;
        MPI_Reduce(&touches, &all, 1, MPI_UINT64_T, MPI_SUM, 0, MPI_COMM_WORLD);
        std::printf("%zu balls on rank %u\n", grid.here().size(), rank);
        MPI_Barrier(MPI_COMM_WORLD);
        if (rank == 0) {
            std::printf("on %u ranks: 2000 balls have touched %llu times\n",
                        grid.here().partition().rankCount(), static_cast<unsigned long long>(all));
        }
    }
    MPI_Finalize();
}
