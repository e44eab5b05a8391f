// SPDX-License-Identifier: Zlib
#pragma once

// Functions that this library stands in for, as the libraries behind it have them.

namespace hashphase::tryout {

/// The next function of that name in the order in which libraries were loaded (dlsym(RTLD_NEXT)), or that of a
/// Bullet which was loaded aside from it; ends the program with a sentence where there is none.
[[nodiscard]] void* findNext(const char* mangledName);

/// Becomes a pointer to that function. Of members, `this` is the first argument, as the Itanium C++ ABI
/// has it on all of Linux.
struct Next {
    const char* mangledName;

    template <class Function>
    operator Function*() const {
        return reinterpret_cast<Function*>(findNext(mangledName));
    }
};

/// Ends the program with a sentence where it has loaded a Bullet beside that which this library links: of
/// the other precision, or another version.
void refuseOtherBullets();

}  // namespace hashphase::tryout
