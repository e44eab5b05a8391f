// SPDX-License-Identifier: Zlib
#include <broadphase/pairs/step.hpp>

#include <broadphase/pairs/begun.inl>
#include <broadphase/pairs/ended.inl>
#include <broadphase/pairs/update.inl>

namespace hashphase::detail {

template <class Scalar>
UpdateCost step(Store<Scalar>& store, PairState<Scalar>* pairs, PairFilter filter,
                ParallelFor parallelFor) {
    store.releaseAfterPeak();
    try {
        store.listMovedSettled();
        if (pairs != nullptr) {
            beginUpdate(*pairs);
        }
        for (bool isDone = !store.mustFile(); !isDone;) {
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
            isDone = pairs == nullptr || findBegun(*pairs, someSettled, filter, parallelFor);
            if (!isDone) {
                rememberInstead(*pairs);
            }
        }
        if (pairs != nullptr) {
            askAndMakeRoom(*pairs, filter, parallelFor);
        }
    } catch (...) {
        store.wakeAll();
        throw;
    }
    // From here on nothing takes memory, and so nothing throws.
    if (pairs != nullptr) {
        publish(*pairs);
    }
    if (store.mustFile()) {
        store.relistMobile();
    }
    return store.endUpdate();
}

template UpdateCost step<float>(Store<float>&, PairState<float>*, PairFilter, ParallelFor);
template UpdateCost step<double>(Store<double>&, PairState<double>*, PairFilter, ParallelFor);

}  // namespace hashphase::detail
