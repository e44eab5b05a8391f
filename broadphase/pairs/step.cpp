// SPDX-License-Identifier: Zlib
#include <broadphase/pairs/step.hpp>

#include <broadphase/core/on_failure.hpp>
#include <broadphase/pairs/begun.inl>
#include <broadphase/pairs/ended.inl>
#include <broadphase/pairs/few.inl>
#include <broadphase/pairs/update.inl>

namespace hashphase::detail {

template <class Scalar>
void step(Store<Scalar>& store, PairState<Scalar>* pairs, PairFilter filter,
          ParallelFor parallelFor, UpdateCost& cost) {
    store.releaseAfterPeak();
    bool stayListed = false;
    const OnFailure wakeAll([&] { store.wakeAll(); });
    store.listMovedSettled();
    if (pairs != nullptr) {
        beginUpdate(*pairs);
    }
    stayListed = store.haveFewMoved() && (pairs == nullptr || areOnlyWatched(*pairs));
    if (stayListed && (pairs == nullptr || !compareFew(*pairs))) {
        store.endUpdate(cost);
        return;
    }
    for (bool isDone = stayListed || !store.mustFile(); !isDone;) {
        store.stage(parallelFor, Store<Scalar>::StageFor::update);
        if (pairs != nullptr) {
            findEnded(*pairs, parallelFor);
        }
        store.refreshSettled(parallelFor);
        if (pairs != nullptr) {
            findTurned(*pairs, parallelFor);
        }
        const bool someSettled = store.settleIdle(parallelFor);
        if (pairs != nullptr) {
            listSettled(*pairs, parallelFor);
        }
        store.refreshFiled(parallelFor);
        store.fileMobile(parallelFor);
        store.tables.mustRefileMobile.store(false, std::memory_order_relaxed);
        isDone = pairs == nullptr || findBegun(*pairs, someSettled, filter, parallelFor);
        if (!isDone) {
            rememberInstead(*pairs);
        }
    }
    if (pairs != nullptr) {
        askAndMakeRoom(*pairs, filter, parallelFor);
    }
    // From here on nothing takes memory, and so nothing throws.
    const bool isFiled = store.mustFile() && !stayListed;
    if (pairs != nullptr) {
        publish(*pairs, isFiled);
    }
    if (isFiled) {
        store.relistMobile();
    }
    store.endUpdate(cost);
}

template void step<float>(Store<float>&, PairState<float>*, PairFilter, ParallelFor, UpdateCost&);
template void step<double>(Store<double>&, PairState<double>*, PairFilter, ParallelFor,
                           UpdateCost&);

}  // namespace hashphase::detail
