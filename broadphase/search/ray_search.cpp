// SPDX-License-Identifier: Zlib
#include <broadphase/search/ray_search.hpp>

#include <broadphase/simd/kernels.hpp>
#include <broadphase/tree/tree_ray.hpp>

namespace hashphase::detail {
namespace {

using TakeNear = FunctionRef<double(std::span<const std::uint32_t>)>;

/// A search through all levels of a tree.
template <class Scalar>
struct RaySearch {
    const BoxTree& tree;
    TreeRay<Scalar> ray;
    double limit;
    TakeNear take;
    KernelCost cost{};

    [[nodiscard]] bool walk(const BoxTreeLevel& level) {
        RaySink sink{ray.lastFor(limit), &takeLanes, this};
        return kernels<Scalar>().walkRay(tree.blocks(), level.root, level.firstInner, ray.lanes(),
                                         sink, cost);
    }

    // Where numbers are too large for the kernel, every box may be met.
    [[nodiscard]] bool readAll(const BoxTreeLevel& level) {
        for (std::uint32_t index = level.firstBlock; index < level.firstInner; ++index) {
            const TreeNode8& block = tree.blocks()[index];
            cost.boxesTested += block.count;
            if (!handOver({block.children, block.count})) {
                return false;
            }
        }
        return true;
    }

private:
    [[nodiscard]] bool handOver(std::span<const std::uint32_t> proxyIndices) {
        limit = take(proxyIndices);
        return limit >= 0;
    }

    static bool takeLanes(RaySink& sink, const std::uint32_t* proxyIndices, std::uint32_t count) {
        auto& search = *static_cast<RaySearch*>(sink.owner);
        const bool goesOn = search.handOver({proxyIndices, count});
        sink.last = search.ray.lastFor(search.limit);
        return goesOn;
    }
};

}  // namespace

template <class Scalar>
bool searchRay(const BoxTree& tree, const RayRegion<Scalar>& region, double limit, TakeNear take,
               QueryCost& cost) {
    if (tree.levels().empty() || region.isEmpty()) {
        return true;
    }
    RaySearch<Scalar> search{tree, TreeRay<Scalar>(region, tree.origin()), limit, take};
    bool goesOn = true;
    for (const BoxTreeLevel& level : tree.levels()) {
        if (goesOn && search.ray.clipTo(level.radius)) {
            goesOn = search.ray.isExpressible() ? search.walk(level) : search.readAll(level);
        }
    }
    cost.rowsVisited += search.cost.rowsVisited;
    cost.boxesTested += search.cost.boxesTested;
    return goesOn;
}

template bool searchRay(const BoxTree&, const RayRegion<float>&, double, TakeNear, QueryCost&);
template bool searchRay(const BoxTree&, const RayRegion<double>&, double, TakeNear, QueryCost&);

}  // namespace hashphase::detail
