// SPDX-License-Identifier: Zlib
#pragma once

// Moved: include integration/camera/ground_footprint.hpp, and link hashphase::camera.

#include <integration/camera/ground_footprint.hpp>
