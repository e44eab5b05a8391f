// SPDX-License-Identifier: Zlib

// Kernel part: finds what a ray may meet in a tree of boxes, from near to far. See kernels.inl. A
// ray against the boxes of a block errs to the side of a hit: what it lets pass is for the region's
// own key() to decide. After the slab test of Kay and Kajiya, "Ray tracing complex scenes", widened
// as in Ize, "Robust BVH ray traversal".

// Bit k of the result tells whether the ray may meet box k at some t in [0, last]; enter[k] is then
// a lower bound of that t. A NaN changes nothing.
inline std::uint32_t mayMeet(const TreeNode8& block, const RayLanes& ray, float last,
                             float* enter) {
    using Floats = Pack<float>;
    std::uint32_t mask = 0;
    for (std::uint32_t k = 0; k < kBlockWidth; k += Floats::kWidth) {
        auto first = Floats::broadcast(0);
        auto exit = Floats::broadcast(last);
        for (int axis = 0; axis < 3; ++axis) {
            const std::uint32_t nearColumn = ray.nearColumn[axis];
            const std::uint32_t farColumn = ray.farColumn[axis];
            const auto slabEnter =
                Floats::times(Floats::minus(Floats::load(block.bounds[nearColumn] + k),
                                            Floats::broadcast(ray.offset[nearColumn])),
                              Floats::broadcast(ray.inverse[axis]));
            const auto slabExit =
                Floats::times(Floats::minus(Floats::load(block.bounds[farColumn] + k),
                                            Floats::broadcast(ray.offset[farColumn])),
                              Floats::broadcast(ray.farInverse[axis]));
            first = Floats::greatest(slabEnter, first);
            exit = Floats::least(slabExit, exit);
        }
        Floats::store(enter + k, first);
        mask |= Floats::bits(Floats::lessEqual(first, exit)) << k;
    }
    return mask;
}

/// A block to be read, and where the ray enters the box around it.
struct PendingBlock {
    float enter;
    std::uint32_t block;
};

// Each of at most 32 storeys leaves seven behind.
constexpr std::uint32_t kMostPending = 256;

// The lane of `mask`, which has one, that is entered first; of several, that with the smallest
// number.
inline std::uint32_t nearestLane(const float* enter, std::uint32_t mask) {
    std::uint32_t nearest = lowestBit(mask);
    for (mask &= mask - 1; mask != 0; mask &= mask - 1) {
        const std::uint32_t lane = lowestBit(mask);
        nearest = enter[lane] < enter[nearest] ? lane : nearest;
    }
    return nearest;
}

// Brings the indices of the lanes to the sink.
inline bool takeLanes(const TreeNode8& block, const float* enter, std::uint32_t mask,
                      RaySink& sink) {
    std::uint32_t proxyIndices[kBlockWidth];
    std::uint32_t count = 0;
    while (mask != 0) {
        const std::uint32_t lane = nearestLane(enter, mask);
        mask ^= 1U << lane;
        proxyIndices[count++] = block.children[lane];
    }
    return count == 0 || sink.take(sink, proxyIndices, count);
}

// Puts the blocks of the lanes on top of those that are pending, the nearest at the very top.
inline std::uint32_t pushLanes(const TreeNode8& block, const float* enter, std::uint32_t mask,
                               PendingBlock* pending, std::uint32_t count) {
    const std::uint32_t bottom = count;
    for (; mask != 0; mask &= mask - 1) {
        const std::uint32_t lane = lowestBit(mask);
        std::uint32_t i = count++;
        for (; i > bottom && pending[i - 1].enter < enter[lane]; --i) {
            pending[i] = pending[i - 1];
        }
        pending[i] = {enter[lane], block.children[lane]};
    }
    return count;
}

inline bool walkRay(const TreeNode8* blocks, std::uint32_t root, std::uint32_t firstInner,
                    const RayLanes& ray, RaySink& sink, KernelCost& cost) {
    PendingBlock pending[kMostPending];
    pending[0] = {0, root};
    std::uint32_t count = 1;
    while (count > 0) {
        const auto [entered, index] = pending[--count];
        if (entered > sink.last) {
            continue;
        }
        const TreeNode8& block = blocks[index];
        float enter[kBlockWidth];
        const std::uint32_t mask = mayMeet(block, ray, sink.last, enter);
        ++cost.rowsVisited;
        if (index >= firstInner) {
            count = pushLanes(block, enter, mask, pending, count);
            continue;
        }
        cost.boxesTested += block.count;
        if (!takeLanes(block, enter, mask, sink)) {
            return false;
        }
    }
    return true;
}
