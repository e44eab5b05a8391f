// SPDX-License-Identifier: Zlib

// One operation of the grid over a scene, in which a tool counts the instructions of the kernels:
//
//     kernel-instructions <operation>-<float|double> <instruction set>
//
// Without arguments, prints the operations.

#include <broadphase/collectors.hpp>
#include <broadphase/convex_region.hpp>
#include <broadphase/grid.hpp>
#include <broadphase/pairs.hpp>
#include <broadphase/radius_search.hpp>
#include <broadphase/regions.hpp>
#include <broadphase/simd/kernels.hpp>
#include <broadphase/sweeps.hpp>

#include <array>
#include <cstdio>
#include <random>
#include <string_view>
#include <utility>
#include <vector>

namespace {

using namespace hashphase;

/// 1,000 boxes, five or so on each of them.
template <class Scalar>
class Scene {
public:
    Scene() {
        for (int i = 0; i < 1000; ++i) {
            boxes_.push_back(boxAround(point()));
            ids_.push_back(grid_.add(boxes_.back()));
        }
        grid_.update();
    }

    void file() {
        for (const ProxyId id : ids_) {
            grid_.move(id, boxAround(point()));
        }
        grid_.update();
    }
    void findPairs() {
        Pairs<Scalar> pairs(grid_);
        pairs.update();
    }
    void findSweptPairs() {
        Pairs<Scalar> pairs(grid_);
        Sweeps<Scalar> sweeps(grid_);
        pairs.setSweeps(&sweeps);
        for (std::size_t i = 0; i < ids_.size(); i += 4) {
            const Vector3<Scalar> from = point();
            sweeps.set(ids_[i], Vector3<Scalar>((point() - from) / 4), Sweep::line);
        }
        pairs.update();
    }
    void findOverlaps() {
        for (const Aabb<Scalar>& box : boxes_) {
            ask(BoxRegion<Scalar>{box});
        }
    }
    void findBatches() {
        std::vector<BoxRegion<Scalar>> regions;
        for (const Aabb<Scalar>& box : boxes_) {
            regions.push_back({box});
        }
        std::vector<CollectCount> counts(regions.size());
        found_ +=
            grid_.visitEach(std::span<const BoxRegion<Scalar>>(regions), std::span(counts)).hits;
    }
    void castRays() {
        grid_.expectRays(200);
        for (int i = 0; i < 200; ++i) {
            ask(RayRegion<Scalar>{point(), point()});
        }
    }
    void walkRays() {
        for (int i = 0; i < 4; ++i) {
            ask(RayRegion<Scalar>{point(), point()});
        }
    }
    void cull() {
        for (int i = 0; i < 20; ++i) {
            const Vector3<Scalar> low = point() / 2;
            std::array<typename ConvexRegion<Scalar>::Plane, 6> planes;
            for (int axis = 0; axis < 3; ++axis) {
                Vector3<Scalar> normal = Vector3<Scalar>::Constant(Scalar(0.1));
                normal[axis] = 1;
                planes[static_cast<std::size_t>(axis)] = {normal, low};
                planes[static_cast<std::size_t>(axis) + 3] = {
                    Vector3<Scalar>(-normal), Vector3<Scalar>(low.array() + kSize / 2)};
            }
            ask(ConvexRegion<Scalar>(planes));
        }
    }
    void findNear() {
        RadiusSearch<Scalar> search;
        search.take(grid_, 1);
        search.forEach(
            [&](std::uint32_t, std::span<const std::uint32_t> near) { found_ += near.size(); });
    }

    [[nodiscard]] std::uint64_t found() const { return found_; }

private:
    static constexpr Scalar kSize = 9.5;  // of the scene [m]

    Scalar number() { return static_cast<Scalar>(random_() % 65536) / 65536; }
    Vector3<Scalar> point() {
        const Scalar x = number();
        const Scalar y = number();
        return Vector3<Scalar>(x, y, number()) * kSize;
    }
    Aabb<Scalar> boxAround(const Vector3<Scalar>& centre) {
        const Vector3<Scalar> half = Vector3<Scalar>::Constant(Scalar(0.25) + number() / 4);
        return {centre - half, centre + half};
    }
    template <class Region>
    void ask(const Region& region) {
        CollectCount count;
        grid_.visit(region, count);
        found_ += count.count();
    }

    std::mt19937 random_;  // of its default seed
    Grid<Scalar> grid_;
    std::vector<Aabb<Scalar>> boxes_;
    std::vector<ProxyId> ids_;
    std::uint64_t found_ = 0;
};

template <class Scalar>
struct Operation {
    std::string_view name;
    void (Scene<Scalar>::*run)();
};

template <class Scalar>
constexpr std::array<Operation<Scalar>, 9> kOperations{{
    {"filing", &Scene<Scalar>::file},
    {"pairs", &Scene<Scalar>::findPairs},
    {"swept-pairs", &Scene<Scalar>::findSweptPairs},
    {"overlaps", &Scene<Scalar>::findOverlaps},
    {"batches", &Scene<Scalar>::findBatches},
    {"rays", &Scene<Scalar>::castRays},
    {"few-rays", &Scene<Scalar>::walkRays},
    {"culling", &Scene<Scalar>::cull},
    {"radius", &Scene<Scalar>::findNear},
}};

template <class Scalar>
bool runNamed(std::string_view name) {
    for (const auto& [operation, run] : kOperations<Scalar>) {
        if (operation == name) {
            Scene<Scalar> scene;
            (scene.*run)();
            std::printf("%llu found\n", static_cast<unsigned long long>(scene.found()));
            return true;
        }
    }
    return false;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        for (const auto& operation : kOperations<float>) {
            std::printf("%.*s-float\n%.*s-double\n", static_cast<int>(operation.name.size()),
                        operation.name.data(), static_cast<int>(operation.name.size()),
                        operation.name.data());
        }
        return 0;
    }
    const std::string_view name = argv[1];
    for (const detail::InstructionSet set : detail::kInstructionSets) {
        if (argc > 2 && std::string_view(argv[2]) == detail::nameOf(set) &&
            detail::isAvailable(set)) {
            detail::useInstructionSet(set);
            const auto dash = name.rfind('-');
            const std::string_view operation = name.substr(0, dash);
            const bool isRun = name.substr(dash + 1) == "float" ? runNamed<float>(operation)
                                                                : runNamed<double>(operation);
            return isRun ? 0 : 2;
        }
    }
    return 2;
}
