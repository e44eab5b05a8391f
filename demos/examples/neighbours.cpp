// SPDX-License-Identifier: Zlib
//
// A flock, after Reynolds (1987): 1,000 birds, each of which keeps away from, flies along with, and
// stays near those within 5 m. You should see how far they agree on where to fly, from 0 (not at all)
// to 1 (all the same way), grow from near 0 to near 1.

#include <broadphase/radius_search.hpp>

#include <cstdio>
#include <random>
#include <span>
#include <vector>

using namespace hashphase;
using Vector = Vector3<float>;

namespace {

constexpr float kRadius = 5;        // [m]
constexpr float kSpeed = 10;        // [m/s]
constexpr float kTimeStep = 0.05F;  // [s]
constexpr float kWorld = 40;        // edge of the cube that they stay in [m]

struct Bird {
    ProxyId id;
    Vector position;
    Vector velocity;
    Vector wish;
};

float agreement(const std::vector<Bird>& birds) {
    Vector sum = Vector::Zero();
    for (const Bird& bird : birds) {
        sum += bird.velocity;
    }
    return sum.norm() / (kSpeed * static_cast<float>(birds.size()));
}

}  // namespace

int main() {
    std::mt19937 random(1);
    const auto uniform = [&] { return static_cast<float>(random()) * 0x1p-32F; };
    Grid<float> grid;
    std::vector<Bird> birds(1000);  // by ProxyId::index
    for (Bird& bird : birds) {
        bird.position = {kWorld * uniform(), kWorld * uniform(), kWorld * uniform()};
        bird.velocity = {uniform() - 0.5F, uniform() - 0.5F, uniform() - 0.5F};
        bird.velocity *= kSpeed / bird.velocity.norm();
        bird.id = grid.add(boxAround(bird.position, 0.2F));
    }
    std::printf("agreement at first: %.2f\n", agreement(birds));

    RadiusSearch<float> search;
    QueryCost first;
    for (int frame = 0; frame < 200; ++frame) {
        search.take(grid, kRadius);
        const QueryCost cost =
            search.forEach([&](std::uint32_t agent, std::span<const std::uint32_t> neighbours) {
                Bird& bird = birds[search.id(agent).index];
                bird.wish.setZero();
                for (const std::uint32_t neighbour : neighbours) {
                    const Bird& other = birds[search.id(neighbour).index];
                    const Vector apart = other.position - bird.position;
                    bird.wish += other.velocity + apart - 10 * apart / (apart.squaredNorm() + 0.1F);
                }
            });
        first = frame == 0 ? cost : first;
        for (Bird& bird : birds) {
            bird.velocity += 0.02F * bird.wish;
            bird.velocity *= kSpeed / bird.velocity.norm();
            bird.position += kTimeStep * bird.velocity;
            // Who leaves comes in on the other side.
            bird.position -= kWorld * (bird.position / kWorld).array().floor().matrix();
            grid.move(bird.id, boxAround(bird.position, 0.2F));
        }
    }
    std::printf("agreement in the end: %.2f\n", agreement(birds));
    std::printf("neighbours in the first frame: %d\n", static_cast<int>(first.hits));
}
