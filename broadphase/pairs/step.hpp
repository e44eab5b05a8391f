// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/pairs/pair_state.hpp>

namespace hashphase::detail {

/// Ends a frame: files what has changed, puts to rest what has not changed for a while, and finds which
/// pairs have begun and ended; of a grid without pairs `pairs` is null. Writes to `cost` what it has done.
/// Where it throws, for want of memory or out of the filter, everything is mobile, nothing is lost, and the
/// next one goes on from there.
template <class Scalar>
void step(Store<Scalar>& store, PairState<Scalar>* pairs, PairFilter filter,
          ParallelFor parallelFor, UpdateCost& cost);

}  // namespace hashphase::detail
