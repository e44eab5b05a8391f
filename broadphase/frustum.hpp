// SPDX-License-Identifier: Zlib
#pragma once

// Moved: include integration/camera/frustum.hpp, and link hashphase::camera.

#include <integration/camera/frustum.hpp>
