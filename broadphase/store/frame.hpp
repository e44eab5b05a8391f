// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/geometry/padded_box.hpp>
#include <broadphase/store/population.hpp>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hashphase::detail {

/// Boxes of the mobile proxies, by their place in Population::mobile, and what they have in common.
template <class Scalar>
struct Frame {
    std::vector<PaddedBox<Scalar>> now;
    std::vector<PaddedBox<Scalar>> before;    // as of the last update; where there are pairs
    std::atomic<std::uint32_t> idleCount{0};  // of those that may rest
    std::atomic<bool> someAreCalm{false};     // and change
    // Which kinds of groups there are among the mobile ones, and those that have changed; perhaps more.
    std::atomic<GroupKinds::Set> mobileKinds{0};
    std::atomic<GroupKinds::Set> changedKinds{0};

    std::vector<std::uint32_t> proxyIndices;  // scratch: of what is filed, or has a NaN
    std::vector<PaddedBox<Scalar>> boxes;     // scratch: of what is filed

    /// What is copied: core/copy_parts.hpp.
    template <class Visit>
    static void forEachPart(Frame& to, const Frame& from, const Visit& visit) {
        visit(to.idleCount, from.idleCount);
        visit(to.someAreCalm, from.someAreCalm);
        visit(to.mobileKinds, from.mobileKinds);
        visit(to.changedKinds, from.changedKinds);
    }

    [[nodiscard]] std::size_t memoryBytes() const noexcept {
        return (now.capacity() + before.capacity() + boxes.capacity()) * sizeof(boxes[0]) +
               proxyIndices.capacity() * sizeof(proxyIndices[0]);
    }
};

}  // namespace hashphase::detail
