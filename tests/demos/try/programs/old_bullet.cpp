// SPDX-License-Identifier: Zlib

// Called as Bullet is, and of another version.

int oldBullet();

int oldBullet() {
    return 283;
}
