// SPDX-License-Identifier: Zlib
#pragma once

// Renamed to RadiusSearch: include broadphase/radius_search.hpp.

#include <broadphase/radius_search.hpp>

namespace hashphase {

template <class Scalar>
using Crowd [[deprecated("RadiusSearch")]] = RadiusSearch<Scalar>;

}  // namespace hashphase
