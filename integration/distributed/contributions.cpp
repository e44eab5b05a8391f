// SPDX-License-Identifier: Zlib
#include <integration/distributed/contributions.hpp>

#include <integration/distributed/detail/parcels.hpp>

// A parcel has the head of detail/parcels.hpp, then for each contribution the object's id, the number of its bytes,
// and these.

#include <broadphase/diagnostics.hpp>

#include <algorithm>
#include <string>

namespace hashphase {
namespace {

constexpr std::uint32_t kContributionMagic = 0x68706331;  // "hpc1"
constexpr std::size_t kMostBytes = 65'536;

}  // namespace

template <class Scalar>
std::span<const Parcel> Contributions::pack(const RankGrid<Scalar>& grid,
                                            std::span<const Contribution> forGhosts) {
    for (const std::uint32_t rank : destinations_) {
        writers_[rank].clear();
    }
    destinations_.clear();
    parcels_.clear();
    writers_.resize(std::max<std::size_t>(writers_.size(), grid.partition().rankCount()));
    for (const Contribution& one : forGhosts) {
        const bool isGhost = grid.grid().contains(one.proxy) && !grid.isOwned(one.proxy);
        HASHPHASE_ASSERT(isGhost,
                         "Contributions::pack(): a proxy is not a ghost of this rank. Pass ghosts "
                         "only; change objects of this rank directly.");
        HASHPHASE_ASSERT(one.bytes.size() <= kMostBytes,
                         "Contributions::pack(): a contribution has more than 65,536 bytes. Pass "
                         "fewer for each object.");
        if (!isGhost || one.bytes.size() > kMostBytes) {
            continue;
        }
        const std::uint32_t home = grid.homeOf(one.proxy);
        detail::ByteWriter& writer = writers_[home];
        if (writer.bytes().empty()) {
            destinations_.push_back(home);
            detail::beginParcel(writer, kContributionMagic);
        }
        writer.write(grid.globalId(one.proxy).value);
        writer.write(static_cast<std::uint32_t>(one.bytes.size()));
        writer.write(one.bytes.data(), one.bytes.size());
    }
    std::sort(destinations_.begin(), destinations_.end());
    for (const std::uint32_t rank : destinations_) {
        detail::sealParcel(writers_[rank]);
        parcels_.push_back({rank, writers_[rank].bytes()});
    }
    return parcels_;
}

template <class Scalar>
std::span<const Contribution> Contributions::finish(const RankGrid<Scalar>& grid,
                                                    std::span<const Parcel> received) {
    std::vector<Parcel> sorted(received.begin(), received.end());
    std::sort(sorted.begin(), sorted.end(),
              [](const Parcel& a, const Parcel& b) { return a.rank < b.rank; });
    received_.clear();
    for (const Parcel& parcel : sorted) {
        detail::ByteReader reader =
            detail::openParcel(parcel, kContributionMagic,
                               "is not from Contributions::pack() of this version. Use the same "
                               "hashphase on all ranks.");
        while (reader.left() > 0) {
            const GlobalId object{reader.read<std::uint64_t>()};
            const auto count = reader.read<std::uint32_t>();
            if (reader.isTorn() || count > reader.left()) {
                detail::raiseBadParcel(
                    parcel, "ends within a contribution. Pass all bytes that pack() made.");
            }
            const ProxyId proxy = grid.find(object);
            if (!grid.isOwned(proxy)) {
                detail::raiseBadParcel(parcel, "is for object " + std::to_string(object.value) +
                                                   ", which does not live here. Call pack() and "
                                                   "finish() on all ranks before the next change.");
            }
            received_.push_back({proxy, reader.rest().first(count), parcel.rank});
            reader.skip(count);
        }
    }
    return received_;
}

template HASHPHASE_DISTRIBUTED_EXPORT std::span<const Parcel> Contributions::pack(
    const RankGrid<float>&, std::span<const Contribution>);
template HASHPHASE_DISTRIBUTED_EXPORT std::span<const Parcel> Contributions::pack(
    const RankGrid<double>&, std::span<const Contribution>);
template HASHPHASE_DISTRIBUTED_EXPORT std::span<const Contribution> Contributions::finish(
    const RankGrid<float>&, std::span<const Parcel>);
template HASHPHASE_DISTRIBUTED_EXPORT std::span<const Contribution> Contributions::finish(
    const RankGrid<double>&, std::span<const Parcel>);

}  // namespace hashphase
