// SPDX-License-Identifier: Zlib
#include <broadphase/simd/kernels.hpp>

#include <algorithm>

namespace hashphase::detail {

bool PairList::grow(PairSink& sink, std::size_t count) {
    auto& list = *static_cast<PairList*>(sink.owner);
    const auto size = static_cast<std::size_t>(sink.next - list.data_.get());
    // What a search finds in a frame like the last ones has room.
    constexpr std::size_t kFewestPairs = 128;
    const auto capacity = std::max<std::size_t>({2 * list.capacity_, size + count, kFewestPairs});
    auto data = std::make_unique_for_overwrite<IndexPair[]>(capacity);
    std::copy_n(list.data_.get(), size, data.get());
    list.data_ = std::move(data);
    list.capacity_ = capacity;
    sink.next = list.data_.get() + size;
    sink.end = list.data_.get() + capacity;
    return true;
}

void PairList::shrink() {
    if (size_ < capacity_) {
        PairList fresh;
        if (size_ > 0) {
            std::copy_n(data_.get(), size_, fresh.resize(size_));
        }
        swap(fresh);
    }
}

void PairList::makeRoomFor(const PairList& from) {
    if (capacity_ < from.size_) {
        PairList fresh;
        static_cast<void>(fresh.resize(from.size_));
        fresh.size_ = size_;
        std::copy_n(data_.get(), size_, fresh.data_.get());
        swap(fresh);
    }
}

IndexPair* PairList::resize(std::size_t count) {
    if (capacity_ < count) {
        append([&](PairSink& sink) { grow(sink, count); });
    }
    size_ = count;
    return data_.get();
}

bool FewPairs::grow(PairSink& sink, std::size_t count) {
    auto& list = *static_cast<FewPairs*>(sink.owner);
    const auto size = static_cast<std::size_t>(sink.next - list.data_);
    const std::size_t capacity = std::max(2 * list.capacity_, size + count);
    auto many = std::make_unique_for_overwrite<IndexPair[]>(capacity);
    std::copy_n(list.data_, size, many.get());
    list.many_ = std::move(many);
    list.data_ = list.many_.get();
    list.capacity_ = capacity;
    sink.next = list.data_ + size;
    sink.end = list.data_ + capacity;
    return true;
}

}  // namespace hashphase::detail
