// SPDX-License-Identifier: Zlib
#include <integration/distributed/detail/parcels.hpp>

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
        raiseBadParcel(parcel, "says that it has " + std::to_string(size) + " bytes, and has " +
                                   std::to_string(parcel.bytes.size()) + ".");
    }
    return reader;
}

void raiseBadParcel(const Parcel& parcel, const std::string& fault) {
    throw RankError("What rank " + std::to_string(parcel.rank) + " has sent " + fault);
}

}  // namespace hashphase::detail
