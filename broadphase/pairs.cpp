// SPDX-License-Identifier: Zlib
#include <broadphase/pairs.hpp>

#include <broadphase/detail/join.hpp>

#include <algorithm>
#include <limits>

namespace hashphase {
namespace {

// Couples are watched until neither box has changed for this many updates. A proxy that moves again
// after a longer rest has its couples looked up once.
constexpr std::uint32_t kUpdatesWatched = 8;

template <class Scalar>
Aabb<Scalar> nanBox() {
    const Vector3<Scalar> nan = Vector3<Scalar>::Constant(std::numeric_limits<Scalar>::quiet_NaN());
    return {nan, nan};
}

template <class Add>
struct CollectInto {
    Add& add_;

    template <class Scalar>
    void add(ProxyId id, Scalar /*key*/) {
        add_(id);
    }
    static constexpr double limit() { return std::numeric_limits<double>::infinity(); }
};

bool contains(const detail::FlatSet& couples, std::uint64_t couple) {
    return couples.find(couple) != detail::FlatSet::kNone;
}

}  // namespace

template <class Scalar>
Pairs<Scalar>::Pairs(Grid<Scalar>& grid) : grid_(grid) {
    HASHPHASE_ASSERT(!grid_.hasPairs_, "A grid has at most one Pairs.");
    HASHPHASE_ASSERT(grid_.records_.empty(), "Pairs are created before the grid's first proxy.");
    grid_.hasPairs_ = true;
}

template <class Scalar>
Pairs<Scalar>::~Pairs() {
    grid_.hasPairs_ = false;
}

// --- An update -----------------------------------------------------------------------------------

template <class Scalar>
PairChanges Pairs<Scalar>::update(PairFilter filter) {
    beginCall();
    grid_.fileForUpdate();
    captureWoken();
    findNew();
    mergeWatched(filter);
    publish();
    cost_.grid = grid_.cost_;
    grid_.endUpdate();
    return {born_, died_};
}

template <class Scalar>
void Pairs<Scalar>::beginCall() {
    born_.clear();
    died_.clear();
    cost_ = {};
    if (before_.size() < grid_.boxes_.size()) {
        before_.resize(grid_.boxes_.size(), nanBox<Scalar>());
    }
}

// What has rested is not watched. When it changes, its couples are those of its box before: found
// in the tables where the other one has not changed, and among the woken themselves otherwise.
template <class Scalar>
void Pairs<Scalar>::captureWoken() {
    const std::uint32_t lastUpdate = grid_.updateNumber_ - 1;
    woken_.clear();
    for (; capturedChanges_ < grid_.changes_.size(); ++capturedChanges_) {
        const auto [slot, previousChange] = grid_.changes_[capturedChanges_];
        if (!isWatched(previousChange, lastUpdate) && !hasNan(before_[slot])) {
            woken_.push_back(slot);
        }
    }
    const auto capture = [this](std::uint32_t a, std::uint32_t b) {
        const Couple c = couple(a, b, false);
        captured_.push_back(refusedAtRest_.erase(c) != detail::FlatSet::kNone ? c | 1 : c);
    };
    QueryCost cost;
    for (const std::uint32_t slot : woken_) {
        const auto captureUnwatched = [&](std::uint32_t other) {
            if (!grid_.changedNow(other) &&
                !isWatched(grid_.records_[other].changedAt, lastUpdate)) {
                capture(slot, other);
            }
        };
        detail::forOverlapsInTable(grid_.mobile_, before_[slot], cost, captureUnwatched);
        detail::forOverlapsInTable(grid_.resting_, before_[slot], cost, captureUnwatched);
    }
    if (woken_.size() > 1) {
        wokenTable_.build(woken_, before_.data(), grid_.fixedSizes_);
        detail::forOverlapsWithinTable(wokenTable_, cost, [&](std::uint32_t a, std::uint32_t b) {
            capture(wokenTable_.slot(a), wokenTable_.slot(b));
        });
    }
    cost_.boxesTested += cost.boxesTested;
}

template <class Scalar>
bool Pairs<Scalar>::isWatched(std::uint32_t changedAt, std::uint32_t update) const noexcept {
    return changedAt != 0 && update - changedAt < kUpdatesWatched;
}

// A couple is new when its boxes overlap now and did not before; one of them has changed.
template <class Scalar>
void Pairs<Scalar>::findNew() {
    fresh_.clear();
    QueryCost cost;
    // The join reads each neighbourhood once and half of it; it pays unless few have changed.
    const bool byJoin = 4 * grid_.changes_.size() >= grid_.mobileSlots_.size();
    if (byJoin && !grid_.changes_.empty()) {
        joinMobile(cost);
    }
    if (!byJoin || grid_.resting_.size() > 0) {
        walkAroundChanged(!byJoin, cost);
    }
    cost_.boxesTested += cost.boxesTested;
    std::sort(fresh_.begin(), fresh_.end());
}

// What changed against the resting proxies, and against the mobile ones where asked for.
template <class Scalar>
void Pairs<Scalar>::walkAroundChanged(bool amongMobile, QueryCost& cost) {
    const auto found = [this](std::uint32_t a, std::uint32_t b) {
        if (!overlaps(before_[a], before_[b])) {
            fresh_.push_back(couple(a, b, false));
        }
    };
    for (const auto& change : grid_.changes_) {
        const std::uint32_t slot = change.slot;
        if (grid_.records_[slot].place != Grid<Scalar>::Place::mobile) {
            continue;  // removed, or NaN
        }
        if (amongMobile) {
            const auto foundMobile = [&](std::uint32_t other) {
                // Of two that changed, the one with the smaller slot reports.
                if (other != slot && !(other < slot && grid_.changedNow(other))) {
                    found(slot, other);
                }
            };
            detail::forOverlapsInTable(grid_.mobile_, grid_.boxes_[slot], cost, foundMobile);
        }
        const auto foundResting = [&](std::uint32_t other) { found(slot, other); };
        detail::forOverlapsInTable(grid_.resting_, grid_.boxes_[slot], cost, foundResting);
    }
}

// The boxes before are put in the table's order first: what is near each other in space is then near
// in memory, which the slots are not.
template <class Scalar>
void Pairs<Scalar>::joinMobile(QueryCost& cost) {
    const detail::Table<Scalar>& table = grid_.mobile_;
    beforeByEntry_.resize(table.size());
    for (std::uint32_t entry = 0; entry < table.size(); ++entry) {
        beforeByEntry_[entry] = before_[table.slot(entry)];
    }
    detail::forOverlapsWithinTable(table, cost, [&](std::uint32_t a, std::uint32_t b) {
        if (!overlaps(beforeByEntry_[a], beforeByEntry_[b])) {
            fresh_.push_back(couple(table.slot(a), table.slot(b), false));
        }
    });
}

// One pass over the watched couples and the new ones, both sorted: what is born, what died, and
// what is to be watched from now on.
template <class Scalar>
void Pairs<Scalar>::mergeWatched(PairFilter filter) {
    if (!captured_.empty()) {
        std::sort(captured_.begin(), captured_.end());
        merged_.clear();
        std::merge(watched_.begin(), watched_.end(), captured_.begin(), captured_.end(),
                   std::back_inserter(merged_));
        watched_.swap(merged_);
        captured_.clear();
    }
    cost_.couplesWatched = watched_.size();

    merged_.clear();
    const std::size_t most = watched_.size() + fresh_.size();
    if (merged_.capacity() < most) {
        merged_.reserve(most + most / 2);  // undecided_ points into it
    }
    undecided_.clear();
    const auto watch = [this](Couple c) {
        if (!contains(announced_, c)) {
            addUndecided(merged_.emplace_back(c));
        }
    };
    auto next = fresh_.begin();
    for (const Couple c : watched_) {
        for (; next != fresh_.end() && *next < c; ++next) {
            watch(*next);
        }
        keepOrDrop(c);
    }
    std::for_each(next, fresh_.end(), watch);
    watched_.swap(merged_);
    announced_.clear();
    decide(filter);
}

template <class Scalar>
void Pairs<Scalar>::keepOrDrop(Couple c) {
    const std::uint32_t a = first(c);
    const std::uint32_t b = second(c);
    if (!overlaps(grid_.boxes_[a], grid_.boxes_[b])) {
        isRefused(c) ? void(--refusedCount_) : bury(c);
        return;
    }
    if (changedLately(c, grid_.updateNumber_)) {
        merged_.push_back(c);
        if (isRefused(c) && (grid_.changedNow(a) || grid_.changedNow(b))) {
            undecided_.push_back(&merged_.back());
        }
    } else if (isRefused(c)) {
        refusedAtRest_.findOrInsert(c & ~Couple{1});
    }
}

// A new couple counts as refused until it is decided.
template <class Scalar>
void Pairs<Scalar>::addUndecided(Couple& c) {
    c |= 1;
    ++refusedCount_;
    undecided_.push_back(&c);
}

// Asks the filter about the undecided couples.
template <class Scalar>
void Pairs<Scalar>::decide(PairFilter filter) {
    asked_.clear();
    for (const Couple* c : undecided_) {
        asked_.push_back(pairOf(*c));
    }
    accepted_.assign(asked_.size(), 0);
    filter(asked_, accepted_);
    for (std::size_t i = 0; i < undecided_.size(); ++i) {
        Couple& c = *undecided_[i];
        if (isRefused(c) == (accepted_[i] != 0)) {
            c ^= 1;
            isRefused(c) ? (++refusedCount_, bury(c)) : (--refusedCount_, bear(c));
        }
    }
}

template <class Scalar>
bool Pairs<Scalar>::changedLately(Couple c, std::uint32_t update) const noexcept {
    return isWatched(grid_.records_[first(c)].changedAt, update) ||
           isWatched(grid_.records_[second(c)].changedAt, update);
}

template <class Scalar>
void Pairs<Scalar>::bear(Couple c) {
    born_.push_back(pairOf(c));
    ++count_;
}

template <class Scalar>
void Pairs<Scalar>::bury(Couple c) {
    died_.push_back(pairOf(c));
    --count_;
}

template <class Scalar>
void Pairs<Scalar>::publish() {
    for (const auto& change : grid_.changes_) {
        before_[change.slot] = grid_.boxes_[change.slot];
    }
    capturedChanges_ = 0;
}

// --- Between updates -----------------------------------------------------------------------------

template <class Scalar>
PairChanges Pairs<Scalar>::announce(ProxyId id, PairFilter filter) {
    HASHPHASE_ASSERT(grid_.contains(id), "Only a proxy of the grid can announce its pairs.");
    beginCall();
    findUnknown(id.index);
    undecided_.clear();
    announceFresh();
    decide(filter);
    captured_.insert(captured_.end(), fresh_.begin(), fresh_.end());
    return {born_, died_};
}

template <class Scalar>
PairChanges Pairs<Scalar>::refilter(ProxyId id, PairFilter filter) {
    HASHPHASE_ASSERT(grid_.contains(id), "Only a proxy of the grid can be filtered again.");
    beginCall();
    // Noted as changed, the proxy has all its couples of the last update watched or captured, and
    // those announced since captured as well.
    grid_.noteChange(id.index);
    captureWoken();
    findUnknown(id.index);
    undecided_.clear();
    for (std::vector<Couple>* known : {&watched_, &captured_}) {
        for (Couple& c : *known) {
            if ((first(c) == id.index || second(c) == id.index) && isToAskAgain(c)) {
                undecided_.push_back(&c);
            }
        }
    }
    announceFresh();
    std::sort(undecided_.begin(), undecided_.end(),
              [](const Couple* a, const Couple* b) { return *a < *b; });
    decide(filter);
    captured_.insert(captured_.end(), fresh_.begin(), fresh_.end());
    return {born_, died_};
}

template <class Scalar>
void Pairs<Scalar>::announceFresh() {
    for (Couple& c : fresh_) {
        announced_.findOrInsert(c);
        addUndecided(c);
    }
}

// Couples that are apart for the moment and no pair are asked about by update(), should they meet
// again until then.
template <class Scalar>
bool Pairs<Scalar>::isToAskAgain(Couple c) const {
    const std::uint32_t a = first(c);
    const std::uint32_t b = second(c);
    return overlaps(grid_.boxes_[a], grid_.boxes_[b]) ||
           (!isRefused(c) && grid_.isAlive(a) && grid_.isAlive(b));
}

// The proxy's couples that overlap now, did not at the last update, and were not announced since.
template <class Scalar>
void Pairs<Scalar>::findUnknown(std::uint32_t slot) {
    fresh_.clear();
    const auto add = [&](ProxyId other) {
        if (other.index != slot && !overlaps(before_[slot], before_[other.index])) {
            const Couple c = couple(slot, other.index, false);
            if (!contains(announced_, c)) {
                fresh_.push_back(c);
            }
        }
    };
    CollectInto collector{add};
    grid_.visit(BoxRegion<Scalar>{grid_.boxes_[slot]}, collector);
    std::sort(fresh_.begin(), fresh_.end());
}

// --- The whole set -------------------------------------------------------------------------------

template <class Scalar>
void Pairs<Scalar>::forEachOverlap(FunctionRef<void(std::uint32_t, std::uint32_t)> visit) const {
    QueryCost cost;
    for (const detail::Table<Scalar>* table : {&grid_.mobile_, &grid_.resting_}) {
        detail::forOverlapsWithinTable(*table, cost, [&](std::uint32_t a, std::uint32_t b) {
            visit(table->slot(a), table->slot(b));
        });
    }
    for (const std::uint32_t slot : grid_.mobileSlots_) {
        const auto found = [&](std::uint32_t other) { visit(slot, other); };
        detail::forOverlapsInTable(grid_.resting_, grid_.boxes_[slot], cost, found);
    }
}

template <class Scalar>
void Pairs<Scalar>::collect(std::vector<ProxyPair>& pairs) const {
    HASHPHASE_ASSERT(grid_.changes_.empty(),
                     "The set of pairs is asked for directly after an update.");
    const auto begin = static_cast<std::ptrdiff_t>(pairs.size());
    forEachOverlap([&](std::uint32_t a, std::uint32_t b) {
        const Couple refused = couple(a, b, true);
        if (!std::binary_search(watched_.begin(), watched_.end(), refused) &&
            !contains(refusedAtRest_, refused & ~Couple{1})) {
            pairs.push_back(pairOf(refused));
        }
    });
    std::sort(pairs.begin() + begin, pairs.end());
}

template <class Scalar>
std::size_t Pairs<Scalar>::memoryBytes() const noexcept {
    return sizeof(*this) + (before_.capacity() + beforeByEntry_.capacity()) * sizeof(Aabb<Scalar>) +
           (watched_.capacity() + captured_.capacity() + fresh_.capacity() + merged_.capacity()) *
               sizeof(Couple) +
           (born_.capacity() + died_.capacity() + asked_.capacity()) * sizeof(ProxyPair) +
           undecided_.capacity() * sizeof(Couple*) + accepted_.capacity() +
           woken_.capacity() * sizeof(std::uint32_t) + wokenTable_.memoryBytes() +
           announced_.memoryBytes() + refusedAtRest_.memoryBytes();
}

template <class Scalar>
std::string Pairs<Scalar>::validate() const {
    const auto isSameCouple = [](Couple a, Couple b) { return (a | 1) == (b | 1); };
    if (!std::is_sorted(watched_.begin(), watched_.end()) ||
        std::adjacent_find(watched_.begin(), watched_.end(), isSameCouple) != watched_.end()) {
        return "The watched couples are sorted, each once: broken.";
    }
    std::size_t overlapping = 0;
    std::vector<Couple> expected;
    forEachOverlap([&](std::uint32_t a, std::uint32_t b) {
        ++overlapping;
        if (changedLately(couple(a, b, false), grid_.updateNumber_ - 1)) {
            expected.push_back(couple(a, b, false));
        }
    });
    std::sort(expected.begin(), expected.end());
    if (!std::equal(watched_.begin(), watched_.end(), expected.begin(), expected.end(),
                    isSameCouple)) {
        return "The watched couples are exactly the overlapping ones of which one changed lately: "
               "broken.";
    }
    if (count_ + refusedCount_ != overlapping) {
        return "count() is the number of overlapping couples less the refused ones: broken.";
    }
    return {};
}

template class Pairs<float>;
template class Pairs<double>;

}  // namespace hashphase
