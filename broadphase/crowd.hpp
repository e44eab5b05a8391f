// SPDX-License-Identifier: Zlib
#pragma once

// Renamed: include broadphase/radius_search.hpp, and write RadiusSearch.

#include <broadphase/radius_search.hpp>

namespace hashphase {

template <class Scalar>
using Crowd [[deprecated("RadiusSearch")]] = RadiusSearch<Scalar>;

}  // namespace hashphase
