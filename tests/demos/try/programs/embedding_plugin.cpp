// SPDX-License-Identifier: Zlib

// Beside the programs of a plugin: a constructor of that name, as a plugin has it that links Bullet statically.

extern "C" {
void constructDbvt() asm("_ZN16btDbvtBroadphaseC1EP22btOverlappingPairCache");
void constructDbvt() {}
}
