// SPDX-License-Identifier: Zlib
#pragma once

// Finds what is in a convex volume.

#include <broadphase/export.hpp>
#include <broadphase/function_ref.hpp>
#include <broadphase/hash/table.hpp>
#include <broadphase/simd/kernel_types.hpp>

#include <cstdint>
#include <span>

namespace hashphase::detail {

/// Hands the indices of all entries that are filed by cells and that are in the volume, and perhaps
/// of some that were erased, to take(indices), some at a time, until it returns false. Returns false
/// when it has. Entries of the list are the caller's to test. Allocates nothing.
template <class Scalar>
HASHPHASE_BROADPHASE_EXPORT bool searchVolume(
    const Table<Scalar>& table, const Volume<Scalar>& volume,
    FunctionRef<bool(std::span<const std::uint32_t>)> take, KernelCost& cost);

}  // namespace hashphase::detail
