// SPDX-License-Identifier: Zlib
//
// Compiled for AVX-512, for which Eigen aligns some of its matrices more than for any x86-64, and as if it
// aligned none (tests/checks/flags.sh): what a program and a library share must not know of it.

#include <broadphase/cells_region.hpp>
#include <broadphase/neighbours.hpp>
#include <broadphase/position_region.hpp>
#include <broadphase/radius_search.hpp>
#include <broadphase/sweeps.hpp>
#include <integration/ai/radar.hpp>
#include <integration/ai/rarest_colour.hpp>
#include <integration/ai/sight.hpp>
#include <integration/camera/frustum.hpp>
#include <integration/camera/ground_footprint.hpp>
#include <integration/effects/observers.hpp>
#include <integration/effects/simulation.hpp>

#include <Eigen/Core>

using namespace hashphase;

static_assert(alignof(Eigen::Matrix4f) != 16,
              "This is to be compiled for AVX, or without aligning.");

template <template <class> class... Templates>
constexpr bool isSameForAll = ((alignof(Templates<float>) <= alignof(void*) &&
                                alignof(Templates<double>) <= alignof(void*)) &&
                               ...);

static_assert(isSameForAll<Aabb, BoxRegion, CellsRegion, ConvexRegion, GroundFootprint, MovingBox,
                           MovingBoxRegion, PositionRegion, RayRegion, SphereRegion>);
static_assert(isSameForAll<Grid, Neighbours, Pairs, RadiusSearch, Sweeps>);
static_assert(isSameForAll<Culler, Picked, Radar, RadarWindow, RarestColour, Sight, Terrain, Camera,
                           Viewer, SightRegion, Zone, Zones>);
static_assert(isSameForAll<Body, ObservedScene, Observers, Simulation>);
static_assert(alignof(SceneEffects) <= alignof(void*));

// As numbers side by side, whatever Eigen does.
static_assert(sizeof(Pixel) == 16 && alignof(Pixel) == 8);
static_assert(sizeof(detail::Plane<float>) == 16 && alignof(detail::Plane<float>) == 4);
static_assert(sizeof(detail::Plane<double>) == 32 && alignof(detail::Plane<double>) == 8);
static_assert(sizeof(detail::CameraInverse) == 128 + 24 + 8 + 8);
