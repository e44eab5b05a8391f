// SPDX-License-Identifier: Zlib
#pragma once

// Moved: include integration/ai/nearest.hpp, and link hashphase::ai.

#include <integration/ai/nearest.hpp>
