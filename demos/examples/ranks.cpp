// SPDX-License-Identifier: Zlib

// 2,000 balls that push each other apart, shared by the processes of an MPI program: mpirun -n 3 ranks
//
// You should see how many live on each rank, and the same number of contacts however many ranks there are. All balls
// begin on rank 0; the grid moves each to the rank that owns its place, and its payload, the ball, travels along.

#include <integration/mpi/distributed_grid.hpp>

#include <array>
#include <cstdio>
#include <cstring>
#include <vector>

using namespace hashphase;
using Numbers = std::array<int, 3>;

struct Ball {
    std::array<float, 3> at{};        // [m]
    std::array<float, 3> velocity{};  // [m / frame]
};

Aabb<float> boxOf(const Ball& ball) {
    return boxAround<float>({ball.at[0], ball.at[1], ball.at[2]}, 0.5F);
}

void run(DistributedGrid<float>& grid) {
    const RankGrid<float>& here = grid.here();
    for (unsigned i = 0; here.rank() == 0 && i < 2000; ++i) {
        const float x = static_cast<float>(i % 13), y = static_cast<float>(i / 13 % 13),
                    z = static_cast<float>(i / 169);
        const Ball ball{{x, 0.9F * y, 0.8F * z},
                        {0.01F * (y - 6), 0.01F * (z - 6), 0.01F * (x - 6)}};
        std::memcpy(grid.payload(grid.add(GlobalId{i}, boxOf(ball))).data(), &ball, sizeof(ball));
    }
    unsigned long long contacts = 0;
    std::vector<Numbers>
        pushes;  // by ProxyId::index; whole numbers, whose sum does not depend on their order
    for (int frame = 0; frame < 100; ++frame) {
        grid.update();
        pushes.assign(here.grid().indexLimit(), Numbers{});
        here.forEachPair([&](const ProxyPair& pair) {  // one of the two, or both, may be ghosts
            ++contacts;
            const Vector3<float> way =
                here.grid().box(pair.second).min() - here.grid().box(pair.first).min();
            for (int axis = 0; axis < 3; ++axis) {
                const int push = (way[axis] > 0 ? 1 : 0) - (way[axis] < 0 ? 1 : 0);
                pushes[pair.first.index][axis] -= push;
                pushes[pair.second.index][axis] += push;
            }
        });
        std::vector<Contribution> forGhosts;
        here.grid().forEach([&](ProxyId id, const Aabb<float>&) {
            if (!here.isOwned(id) && pushes[id.index] != Numbers{}) {
                forGhosts.push_back({id, std::as_bytes(std::span(pushes[id.index]))});
            }
        });
        for (const Contribution& one :
             grid.sendHome(forGhosts)) {  // what others have found for our balls
            Numbers more{};
            std::memcpy(more.data(), one.bytes.data(), sizeof(more));
            for (int axis = 0; axis < 3; ++axis) {
                pushes[one.proxy.index][axis] += more[axis];
            }
        }
        here.forEachOwned([&](ProxyId id, const Aabb<float>&) {
            Ball ball;
            std::memcpy(&ball, here.readPayload(id).data(), sizeof(ball));
            for (int axis = 0; axis < 3; ++axis) {
                ball.velocity[axis] += 0.01F * static_cast<float>(pushes[id.index][axis]);
                ball.at[axis] += ball.velocity[axis];
            }
            std::memcpy(grid.payload(id).data(), &ball, sizeof(ball));
            grid.move(id, boxOf(ball));
        });
    }
    unsigned long long all = 0;
    MPI_Reduce(&contacts, &all, 1, MPI_UNSIGNED_LONG_LONG, MPI_SUM, 0, MPI_COMM_WORLD);
    std::printf("rank %u of %u: %zu balls\n", here.rank(), here.partition().rankCount(),
                here.size());
    if (here.rank() == 0) {
        std::printf("contacts in 100 frames: %llu\n", all);
    }
}

int main(int argc, char** argv) {
    MPI_Init(&argc, &argv);
    try {
        DistributedConfig config;
        config.rankGrid.payloadBytes = sizeof(Ball);
        DistributedGrid<float> grid(MPI_COMM_WORLD, config);
        run(grid);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    MPI_Finalize();
}
