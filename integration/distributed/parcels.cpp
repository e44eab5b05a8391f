// SPDX-License-Identifier: Zlib
#include <integration/distributed/detail/parcels.hpp>

#include <broadphase/core/raise.inl>

namespace hashphase::detail {
namespace {

constexpr std::size_t kSizeAt = sizeof(std::uint32_t);  // behind the magic number

}  // namespace

void beginParcel(ByteWriter& writer, std::uint32_t magic) {
    writer.write(magic);
    writer.write(std::uint64_t{0});
}

void sealParcel(ByteWriter& writer) noexcept {
    writer.rewrite(kSizeAt, std::uint64_t{writer.bytes().size()});
}

ByteReader openParcel(const Parcel& parcel, std::uint32_t magic, const char* isNot) {
    ByteReader reader(parcel.bytes);
    const auto written = reader.read<std::uint32_t>();
    const auto size = reader.read<std::uint64_t>();
    if (reader.isTorn() || written != magic) {
        raiseBadParcel(parcel, isNot);
    }
    if (size != parcel.bytes.size()) {
        raiseBadParcel(parcel, "had " + std::to_string(size) + " bytes when packed, but has " +
                                   std::to_string(parcel.bytes.size()) +
                                   " here. Pass all of its bytes, and no others.");
    }
    return reader;
}

void raiseBadParcel(const Parcel& parcel, const std::string& fault) {
    raise(RankError("The parcel from rank " + std::to_string(parcel.rank) + " " + fault));
}

}  // namespace hashphase::detail
