// SPDX-License-Identifier: Zlib
#pragma once

// Sub-steps, updateAabbs() and the narrow phase in them, by Bullet's own profile zones; and whole steps by
// the worlds' stepSimulation(), which has none: where Bullet is linked so that this library can stand in
// for it.

namespace hashphase::tryout {

/// From now on. What the program itself has Bullet call in its zones goes on being called.
void watchProfileZones();

}  // namespace hashphase::tryout
