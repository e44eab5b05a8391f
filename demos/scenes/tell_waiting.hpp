// SPDX-License-Identifier: Zlib
#pragma once

// What is said to somebody who waits for a file or a scene.

#include <functional>
#include <string_view>

namespace hashphase::demos {

/// Called many times with what is being done: "reading frame 3 of 100". Empty: nobody waits.
using TellWaiting = std::function<void(std::string_view what)>;

}  // namespace hashphase::demos
