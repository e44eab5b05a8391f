// SPDX-License-Identifier: Zlib
#include <broadphase/search/box_search.hpp>

#include <broadphase/search/join.hpp>

#include <cstddef>

namespace hashphase::detail {
namespace {

using TakePairs = FunctionRef<bool(std::span<const IndexPair>)>;

/// Candidates on their way from a kernel to whoever asks.
class PairBuffer {
public:
    // Its 4 kB are written before they are read.
    // cppcheck-suppress uninitMemberVar
    PairBuffer(TakePairs take, bool isEager) noexcept : take_(take), isEager_(isEager) {}

    [[nodiscard]] PairSink sink() noexcept { return {pairs_, pairs_, &grow, this}; }

    [[nodiscard]] bool handOver(PairSink& sink) {
        const std::span<const IndexPair> found(pairs_, sink.next);
        sink.next = pairs_;
        return found.empty() || take_(found);
    }

private:
    static constexpr std::size_t kRoom = 2 * std::size_t{kMostRoom};

    // With no more room than asked for, the kernel asks again as soon as it has found something.
    static bool grow(PairSink& sink, std::size_t count) {
        auto& buffer = *static_cast<PairBuffer*>(sink.owner);
        const bool goesOn = buffer.handOver(sink);
        sink.end = sink.next + (buffer.isEager_ ? count : kRoom);
        return goesOn;
    }

    TakePairs take_;
    bool isEager_;
    IndexPair pairs_[kRoom];
};

}  // namespace

template <class Scalar>
bool searchBoxes(const Table<Scalar>& table, const Columns<Scalar>& queries, std::uint32_t count,
                 TakePairs take, KernelCost& cost) {
    const bool isSingle = count == 1;
    PairBuffer buffer(take, isSingle);
    PairSink sink = buffer.sink();
    const bool goesOn = isSingle ? queryTable(table, queries, 0, 1, sink, cost, nullptr)
                                 : queryBatch(table, queries, count, sink, cost);
    return goesOn && buffer.handOver(sink);
}

template bool searchBoxes(const Table<float>&, const Columns<float>&, std::uint32_t, TakePairs,
                          KernelCost&);
template bool searchBoxes(const Table<double>&, const Columns<double>&, std::uint32_t, TakePairs,
                          KernelCost&);

}  // namespace hashphase::detail
