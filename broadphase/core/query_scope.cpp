// SPDX-License-Identifier: Zlib
#include <broadphase/core/query_scope.hpp>

namespace hashphase::detail {

#if !HASHPHASE_SHARES_VARIABLES
const QueryScope*& QueryScope::innermost() noexcept {
    thread_local const QueryScope* ofThisThread = nullptr;
    return ofThisThread;
}
#endif

}  // namespace hashphase::detail
