// SPDX-License-Identifier: Zlib
#pragma once

// What all parcels begin with: four bytes that say what they are, and how many bytes they have.

#include <broadphase/core/byte_stream.hpp>
#include <broadphase/export.hpp>
#include <integration/distributed/rank_grid.hpp>

#include <cstddef>
#include <cstdint>
#include <string>

namespace hashphase::detail {

/// Begins a parcel; what follows is written behind it.
void beginParcel(ByteWriter& writer, std::uint32_t magic);

/// Writes how many bytes the parcel has, when all are there.
void sealParcel(ByteWriter& writer) noexcept;

/// Returns what follows. Throws RankError where the parcel does not begin so, or has another number of bytes than it
/// says: "The parcel from rank 3 `isNot`", such as "is not from RankQuestions::pack() of this version."
[[nodiscard]] ByteReader openParcel(const Parcel& parcel, std::uint32_t magic, const char* isNot);

/// Throws RankError: "The parcel from rank 3 `fault`".
[[noreturn]] void raiseBadParcel(const Parcel& parcel, const std::string& fault);

}  // namespace hashphase::detail
