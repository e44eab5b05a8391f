// SPDX-License-Identifier: Zlib
#include <broadphase/pairs/pair_state.hpp>

#include <broadphase/diagnostics.hpp>

namespace hashphase::detail {

template <class Scalar>
PairState<Scalar>::PairState(Store<Scalar>& itsStore, Sweeping<Scalar>* itsSweeping)
    : store(itsStore), sweeping(itsSweeping) {
    HASHPHASE_ASSERT(!store.hasPairs,
                     "Pairs: the grid already has Pairs. Use these, or destroy them first.");
    store.forgetLastUpdate();
    store.hasPairs = true;
}

template <class Scalar>
PairState<Scalar>::~PairState() {
    store.endSweeps();
    store.maySettleWithSlack = true;
    store.hasPairs = false;
}

template <class Scalar>
void PairState<Scalar>::setSweeping(Sweeping<Scalar>* next) {
    store.endSweeps();
    sweeping = next;
    if (sweeping != nullptr) {
        sweeping->motions.markAllChanged();
    }
}

template struct HASHPHASE_INSTANCE_EXPORT PairState<float>;
template struct HASHPHASE_INSTANCE_EXPORT PairState<double>;

}  // namespace hashphase::detail
