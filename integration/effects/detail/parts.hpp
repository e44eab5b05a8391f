// SPDX-License-Identifier: Zlib
#pragma once

// Tables that are there while their effect is declared. What is missing is made before anything else is
// changed, so that where memory runs out all that was declared still runs.

#include <memory>

namespace hashphase::detail {

/// Makes a part that is declared and not there yet.
template <class Part>
void makeIf(bool isDeclared, std::unique_ptr<Part>& part) {
    if (isDeclared && !part) {
        part = std::make_unique<Part>();
    }
}

/// Takes away a part that is not declared any more.
template <class Part>
void dropUnless(bool isDeclared, std::unique_ptr<Part>& part) {
    if (!isDeclared) {
        part.reset();
    }
}

}  // namespace hashphase::detail
