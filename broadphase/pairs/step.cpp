// SPDX-License-Identifier: Zlib
#include <broadphase/pairs/step.hpp>

namespace hashphase::detail {

template <class Scalar>
UpdateCost step(Store<Scalar>& store, PairTracker<Scalar>* pairs, PairFilter filter,
                ParallelFor parallelFor) {
    store.releaseAfterPeak();
    try {
        if (pairs != nullptr) {
            pairs->beginUpdate();
        }
        for (bool isDone = store.cost.changed == 0; !isDone;) {
            store.stage(parallelFor);
            if (pairs != nullptr) {
                pairs->findEnded(parallelFor);
            }
            const bool someSettled = store.settleIdle(parallelFor);
            store.fileMobile(parallelFor);
            isDone = pairs == nullptr || pairs->findBegun(someSettled, filter, parallelFor);
            if (!isDone) {
                pairs->rememberInstead();
            }
        }
        if (pairs != nullptr) {
            pairs->askAndMakeRoom(filter);
        }
    } catch (...) {
        store.wakeAll();
        throw;
    }
    // From here on nothing takes memory, and so nothing throws.
    if (pairs != nullptr) {
        pairs->publish();
    }
    if (store.cost.changed > 0) {
        store.relistMobile();
    }
    return store.endUpdate();
}

template UpdateCost step<float>(Store<float>&, PairTracker<float>*, PairFilter, ParallelFor);
template UpdateCost step<double>(Store<double>&, PairTracker<double>*, PairFilter, ParallelFor);

}  // namespace hashphase::detail
