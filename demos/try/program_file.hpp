// SPDX-License-Identifier: Zlib
#pragma once

// What a program on disk is, as far as it decides whether its broadphase can be taken over: the file of an
// ELF program, and what the dynamic loader would load for it.

#include <optional>
#include <string>
#include <vector>

namespace hashphase::demos {

enum class BulletPrecision { kSingle, kDouble };

/// "single", "double".
[[nodiscard]] std::string nameOf(BulletPrecision precision);

/// A program that loads Bullet as a shared library.
struct TriedProgram {
    std::string path;  // of the file
    std::string
        bullet;  // "libBulletCollision.so.3.24"; empty: it loads Bullet as it runs, if at all
    BulletPrecision precision = BulletPrecision::kSingle;
    std::string sanitizer;  // the library that has to be loaded before all others, if any
};

/// The file that the shell would run for that word: itself with a slash, else from PATH. Throws InputError.
[[nodiscard]] std::string findProgram(const std::string& word);

struct SharedLibrary {
    std::string name;  // "libm.so.6"
    std::string path;  // empty: not found
};

/// The dynamic loader that the program asks for. Throws InputError, a sentence, for what is no program of this
/// machine, or is linked statically.
[[nodiscard]] std::string loaderOf(const std::string& path);

/// What that loader would load for a program or library, in its order. Throws InputError where it cannot.
[[nodiscard]] std::vector<SharedLibrary> sharedLibrariesOf(const std::string& path,
                                                           const std::string& loader);

/// Looks at the program, whose Bullet has to be the one that hashphase was built with: one of `ownBullets`, by
/// their names. With `precision`, it need not link a Bullet, and if it does, one of that precision. Throws
/// InputError, a sentence that says why it cannot be taken over.
[[nodiscard]] TriedProgram inspectProgram(const std::string& path,
                                          const std::vector<std::string>& ownBullets,
                                          std::optional<BulletPrecision> precision);

}  // namespace hashphase::demos
