// SPDX-License-Identifier: Zlib
#pragma once

// Moved: include integration/camera/view.hpp.

#include <integration/camera/view.hpp>
