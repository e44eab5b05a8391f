// SPDX-License-Identifier: Zlib
#include <integration/bullet/pair_cache.hpp>

#include <broadphase/core/caught.hpp>
#include <broadphase/core/limits.hpp>
#include <integration/bullet/detail/cache_watch.hpp>

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>

#include <algorithm>
#include <utility>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

// Two signed numbers as one unsigned that sorts like (high, low).
std::uint64_t ascending(int high, int low) noexcept {
    constexpr std::uint32_t kSignBit = 0x80000000U;
    return (std::uint64_t{static_cast<std::uint32_t>(high) ^ kSignBit} << 32) |
           (static_cast<std::uint32_t>(low) ^ kSignBit);
}

std::uint64_t idOf(const btBroadphaseProxy& proxy) noexcept {
    return static_cast<std::uint32_t>(proxy.m_uniqueId);
}

std::uint64_t idsOf(const btBroadphaseProxy& a, const btBroadphaseProxy& b) noexcept {
    const std::uint64_t idA = idOf(a);
    const std::uint64_t idB = idOf(b);
    return idA < idB ? (idA << 32) | idB : (idB << 32) | idA;
}

}  // namespace

/// Counts a call that is under way, however it ends.
class PairCache::Processing {
public:
    explicit Processing(int& depth) noexcept : depth_(depth) { ++depth_; }
    ~Processing() { --depth_; }
    Processing(const Processing&) = delete;
    Processing& operator=(const Processing&) = delete;

private:
    int& depth_;
};

int PairCache::uniqueId(const btBroadphaseProxy& proxy) {
    return proxy.m_uniqueId;
}

PairCache::~PairCache() {
    if (watcher_ != nullptr) {
        watcher_->endCache();
    }
}

// --- Who may pair --------------------------------------------------------------------------------

namespace {

/// What a cache does without a callback.
struct GroupsAndMasks final : btOverlapFilterCallback {
    bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override {
        return PairCache::doGroupsAccept(*a, *b);
    }
};

GroupsAndMasks groupsAndMasks;

}  // namespace

bool PairCache::needsBroadphaseCollision(btBroadphaseProxy* proxy0,
                                         btBroadphaseProxy* proxy1) const {
    const bool isRefused =
        watcher_ != nullptr && watcher_->mayRefuse() && watcher_->refuses(*proxy0, *proxy1);
    return !isRefused && doFiltersAccept(proxy0, proxy1);
}

btOverlapFilterCallback* PairCache::getOverlapFilterCallback() {
    const bool mayRefuse = watcher_ != nullptr && watcher_->mayRefuse();
    return filter_ == nullptr && mayRefuse ? &groupsAndMasks : filter_;
}

void PairCache::setOverlapFilterCallback(btOverlapFilterCallback* callback) {
    filter_ = callback == &groupsAndMasks ? nullptr : callback;
}

// --- One pair ------------------------------------------------------------------------------------

btBroadphasePair* PairCache::addOverlappingPair(btBroadphaseProxy* proxy0,
                                                btBroadphaseProxy* proxy1) {
    return needsBroadphaseCollision(proxy0, proxy1) ? addAcceptedPair(proxy0, proxy1) : nullptr;
}

btBroadphasePair* PairCache::addAcceptedPair(btBroadphaseProxy* proxy0, btBroadphaseProxy* proxy1) {
    return add({*proxy0, *proxy1});
}

void PairCache::checkMayChange() const {
    HASHPHASE_ASSERT(!detail::QueryScope::forbidsChanges(this),
                     "A PairCache was changed from within its filter. Note the change, and make it "
                     "after the step.");
}

void PairCache::checkRoomFor(std::size_t bornCount) const {
    detail::checkCount(ids_.size() + bornCount, kMostPairs,
                       "A PairCache holds at most 1,073,741,824 pairs. Use fewer overlapping "
                       "objects, or filter more pairs.");
}

btBroadphasePair* PairCache::add(const BulletProxyPair& proxies) {
    checkMayChange();
    checkRoomFor(1);
    const auto index = static_cast<int>(ids_.findOrInsert(proxies.ids()));
    if (index < pairs_.size()) {
        HASHPHASE_ASSERT(isNamedBy(proxies, pairs_[index]),
                         "Two live proxies have the same m_uniqueId. Give each proxy of a "
                         "PairCache an id of its own.");
        return &pairs_[index];
    }
    btBroadphasePair pair;
    name(proxies, pair);
    pairs_.push_back(pair);
    isSorted_ = false;

    if (ghosts_ == nullptr) {
        return &pairs_[index];
    }
    // Here, and wherever else others are called: a snapshot refuses to be used from within.
    const detail::QueryScope scope(this, detail::QueryScope::Changes::allowed);
    ghosts_->addOverlappingPair(pair.m_pProxy0, pair.m_pProxy1);
    return findPair(pair.m_pProxy0, pair.m_pProxy1);
}

void* PairCache::removeOverlappingPair(btBroadphaseProxy* proxy0, btBroadphaseProxy* proxy1,
                                       btDispatcher* dispatcher) {
    return remove(idsOf(*proxy0, *proxy1), dispatcher, freeingNow(), Remover::other);
}

// A callback of processAllOverlappingPairs() is called in canonical order itself.
PairCache::Freeing PairCache::freeingNow() const noexcept {
    const bool inTurn = order_ == PairOrder::canonical && processDepth_ == 0;
    return inTurn ? Freeing::inTurn : Freeing::now;
}

void PairCache::noteTakenOut(const btBroadphasePair& pair) const noexcept {
    if (watcher_ != nullptr) {
        watcher_->note(pair);
    }
}

// The last pair takes a place that is vacant, unless that is the last itself. If it was not chained
// before, it is to be now where its new place is among the chained.
void PairCache::fill(std::uint32_t index) noexcept {
    const auto last = static_cast<std::uint32_t>(pairs_.size()) - 1;
    ids_.fill(index);
    if (index != last) {
        pairs_[static_cast<int>(index)] = pairs_[static_cast<int>(last)];
        isSorted_ = false;
        if (isChained(last)) {
            rename(2 * last, 2 * index);
            rename(2 * last + 1, 2 * index + 1);
        } else {
            chainPair(index);
        }
    }
    if (isChained(last)) {
        links_.resize(links_.size() - 2);
    }
    pairs_.pop_back();
    if (pairs_.size() == 0) {
        dropChains();  // an empty cache is as good as new: no order follows from what it held
    }
}

btBroadphasePair* PairCache::findPair(btBroadphaseProxy* proxy0, btBroadphaseProxy* proxy1) {
    const std::uint32_t index = ids_.find(idsOf(*proxy0, *proxy1));
    return index == kNone ? nullptr : &pairs_[static_cast<int>(index)];
}

// --- All pairs -----------------------------------------------------------------------------------

void PairCache::processAllOverlappingPairs(btOverlapCallback* callback, btDispatcher* dispatcher) {
    prepareWholeArray();
    const Processing processing(processDepth_);
    for (int i = 0; i < pairs_.size();) {
        const std::uint64_t ids = ids_.keys()[static_cast<std::size_t>(i)];
        if (callback->processOverlap(pairs_[i])) {
            remove(ids, dispatcher, Freeing::now, Remover::other);
            continue;
        }
        // Where the callback has removed the pair itself, another one has taken its place. That the
        // pair is gone tells that from a callback that puts the pair back, over and over.
        i += ids_.find(ids) == kNone ? 0 : 1;
    }
}

void PairCache::processAllOverlappingPairs(btOverlapCallback* callback, btDispatcher* dispatcher,
                                           const btDispatcherInfo& dispatchInfo) {
    if (dispatchInfo.m_deterministicOverlappingPairs) {
        processByUniqueId(*callback, dispatcher);
    } else {
        processAllOverlappingPairs(callback, dispatcher);
    }
}

void PairCache::processByUniqueId(btOverlapCallback& callback, btDispatcher* dispatcher) {
    prepareWholeArray();
    const Processing processing(processDepth_);
    std::vector<PairSortKey> notes = std::move(scratch_);
    noteAll(notes);
    std::sort(notes.begin(), notes.end(),
              [](const PairSortKey& a, const PairSortKey& b) { return a.uniqueIds > b.uniqueIds; });
    for (const PairSortKey& note : notes) {
        const std::uint32_t index = indexOf(note);
        if (index != kNone && callback.processOverlap(pairs_[static_cast<int>(index)])) {
            remove(note.uniqueIds, dispatcher, Freeing::now, Remover::other);
        }
    }
    scratch_ = std::move(notes);
}

btBroadphasePair* PairCache::getOverlappingPairArrayPtr() {
    prepareWholeArray();
    return pairs_.size() == 0 ? nullptr : &pairs_[0];
}

const btBroadphasePair* PairCache::getOverlappingPairArrayPtr() const {
    return pairs_.size() == 0 ? nullptr : &pairs_[0];
}

btBroadphasePairArray& PairCache::getOverlappingPairArray() {
    prepareWholeArray();
    return pairs_;
}

void PairCache::sortOverlappingPairs(btDispatcher* /*dispatcher*/) {
    if (!isSorted_ && processDepth_ == 0) {
        sort();
    }
}

void PairCache::prepareWholeArray() {
    if (order_ == PairOrder::canonical && processDepth_ == 0) {
        freeRetired();
        sortOverlappingPairs(nullptr);
    }
}

// Pairs take their algorithms along. Their chains are made anew when they are needed.
void PairCache::sort() {
    noteAll(scratch_);
    std::sort(scratch_.begin(), scratch_.end());
    places_.resize(scratch_.size());
    for (std::uint32_t i = 0; i < scratch_.size(); ++i) {
        places_[scratch_[i].index] = i;
    }
    ids_.renumber(places_, [this](std::uint32_t i, std::uint32_t j) {
        pairs_.swap(static_cast<int>(i), static_cast<int>(j));
    });
    dropChains();
    isSorted_ = true;
}

// --- Order, notes, checks ------------------------------------------------------------------------

bool PairCache::isLower(const btBroadphaseProxy& a, const btBroadphaseProxy& b) const {
    if (key_ == &uniqueId) {
        return a.m_uniqueId < b.m_uniqueId;
    }
    const int keyA = key_(a);
    const int keyB = key_(b);
    return keyA != keyB ? keyA < keyB : a.m_uniqueId < b.m_uniqueId;
}

std::uint64_t PairCache::keysOf(const btBroadphasePair& pair, std::uint64_t ids) const {
    return key_ == &uniqueId ? ids : ascending(key_(*pair.m_pProxy0), key_(*pair.m_pProxy1));
}

PairCache::PairSortKey PairCache::noteOf(std::uint32_t index) const {
    const std::uint64_t ids = ids_.keys()[index];
    return {keysOf(pairs_[static_cast<int>(index)], ids), ids, index};
}

void PairCache::noteAll(std::vector<PairSortKey>& notes) const {
    notes.clear();
    for (std::uint32_t i = 0; i < ids_.size(); ++i) {
        notes.push_back(noteOf(i));
    }
}

// Where the pair is now, or kNone when it is gone.
std::uint32_t PairCache::indexOf(const PairSortKey& note) const {
    const bool isWhereItWas = note.index < ids_.size() && ids_.keys()[note.index] == note.uniqueIds;
    return isWhereItWas ? note.index : ids_.find(note.uniqueIds);
}

std::size_t PairCache::memoryBytes() const noexcept {
    return sizeof(*this) + static_cast<std::size_t>(pairs_.capacity()) * sizeof(btBroadphasePair) +
           ids_.memoryBytes() + links_.capacity() * sizeof(Link) + firstEdge_.memoryBytes() +
           retired_.capacity() * sizeof(Retired) + places_.capacity() * sizeof(std::uint32_t) +
           (parts_ != nullptr ? parts_->memoryBytes() : 0) + ranks_.memoryBytes() +
           scratch_.capacity() * sizeof(PairSortKey);
}

// Bullet's arrays give memory back only when they are emptied. Chains are made anew when they are
// needed.
void PairCache::releaseUnusedMemory() noexcept {
    checkMayChange();
    if (pairs_.capacity() > pairs_.size()) {
        btBroadphasePairArray fresh;
        fresh.reserve(pairs_.size());
        for (int i = 0; i < pairs_.size(); ++i) {
            fresh.push_back(pairs_[i]);
        }
        pairs_.clear();
        pairs_.reserve(fresh.size());
        for (int i = 0; i < fresh.size(); ++i) {
            pairs_.push_back(fresh[i]);
        }
    }
    dropChains();
    retired_.shrink_to_fit();
    detail::freeArrays(links_, places_, scratch_);
    parts_.reset();
    // Where there is no memory to move it to, it is kept as it is.
    static_cast<void>(detail::hasRoomFor([&] {
        ranks_ = {};
        firstEdge_.shrink();
        ids_.shrink();
    }));
}

std::string PairCache::validate() const {
    for (std::string error : {ids_.validate(), firstEdge_.validate()}) {
        if (!error.empty()) {
            return error;
        }
    }
    if (ids_.size() != static_cast<std::size_t>(pairs_.size())) {
        return "Every pair is found by the unique ids of its proxies: broken.";
    }
    for (std::uint32_t i = 0; i < ids_.size(); ++i) {
        const btBroadphasePair& pair = pairs_[static_cast<int>(i)];
        if (ids_.find(idsOf(*pair.m_pProxy0, *pair.m_pProxy1)) != i) {
            return "Every pair is found by the unique ids of its proxies: broken.";
        }
        if (!isLower(*pair.m_pProxy0, *pair.m_pProxy1)) {
            return "Every pair has the proxy with the lower key first: broken.";
        }
        if (isSorted_ && i > 0 && !(noteOf(i - 1) < noteOf(i))) {
            return "An array that counts as sorted is in canonical order: broken.";
        }
    }
    if (!areChainsSound()) {
        return "Every pair that is chained is so once to each of its proxies: broken.";
    }
    return {};
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
