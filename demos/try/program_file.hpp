// SPDX-License-Identifier: Zlib
#pragma once

// What a program on disk is, as far as it decides whether its broadphase can be taken over: the file of an
// ELF program, and what the dynamic loader would load for it.

#include <string>
#include <vector>

namespace hashphase::demos {

/// A program that loads Bullet as a shared library.
struct TriedProgram {
    std::string path;  // of the file
    std::string
        bullet;  // "libBulletCollision.so.3.24"; empty: it loads Bullet as it runs, if at all
    std::string precision = "single";  // or "double"
    std::string sanitizer;  // the library that has to be loaded before all others, if any
};

/// The file that the shell would run for that word: itself with a slash, else from PATH. Throws InputError.
[[nodiscard]] std::string findProgram(const std::string& word);

/// The names of the Bullets that those of these libraries link which are there.
[[nodiscard]] std::vector<std::string> bulletsOf(const std::vector<std::string>& libraries);

/// Looks at the program, whose Bullet has to be the one that hashphase was built with: one of `ownBullets`, by
/// their names. With a `precision`, it need not link a Bullet, and if it does, one of that precision. Throws
/// InputError, a sentence that says why it cannot be taken over.
[[nodiscard]] TriedProgram inspectProgram(const std::string& path,
                                          const std::vector<std::string>& ownBullets,
                                          const std::string& precision);

}  // namespace hashphase::demos
