// SPDX-License-Identifier: Zlib
#pragma once

// Random lives as GoogleTest's tests.

#include <tests/fuzz/operation.hpp>

namespace hashphase::test {

/// Fails where the operations end in a fault; what asSource() writes is a call of this.
void expectNoFault(const Subject& subject, const Operations& operations);

/// Makes up lives by rapidcheck and fails with the fewest operations that end in a fault; skips the
/// test where rapidcheck is not installed. RC_PARAMS in the environment may ask for more:
/// RC_PARAMS='seed=1 max_success=100000'.
void expectNoFaultInRandomLives(const Subject& subject);

/// Plays every file in tests/fuzz/corpus/<name>.
void expectNoFaultInCorpus(const Subject& subject);

}  // namespace hashphase::test
