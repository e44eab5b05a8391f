// SPDX-License-Identifier: Zlib
#pragma once

#include "standard.hpp"

#include <Eigen/Geometry>
#include <btBulletDynamicsCommon.h>
