// SPDX-License-Identifier: Zlib
#include <broadphase/search/volume_search.hpp>

#include <broadphase/simd/kernels.hpp>

#include <algorithm>
#include <array>

namespace hashphase::detail {
namespace {

using TakeInside = FunctionRef<bool(std::span<const std::uint32_t>)>;

bool handOver(IndexSink& sink) {
    const std::span<const std::uint32_t> found(sink.begin, sink.next);
    sink.next = sink.begin;
    return found.empty() || (*static_cast<const TakeInside*>(sink.owner))(found);
}

}  // namespace

template <class Scalar>
bool searchVolume(const Table<Scalar>& table, const Volume<Scalar>& volume, TakeInside take,
                  KernelCost& cost) {
    std::array<std::uint32_t, 512> found;
    IndexSink sink{found.data(), found.data(), found.data() + found.size(), &handOver, &take};
    return std::ranges::all_of(table.levels(), [&](const Level<Scalar>& level) {
        return !level.hasCells() || level.count() == 0 ||
               (kernels<Scalar>().walkVolume(level, volume, sink, cost) && handOver(sink));
    });
}

template bool searchVolume(const Table<float>&, const Volume<float>&, TakeInside, KernelCost&);
template bool searchVolume(const Table<double>&, const Volume<double>&, TakeInside, KernelCost&);

}  // namespace hashphase::detail
