// SPDX-License-Identifier: Zlib
#pragma once

// Diagnostics: messages about bad data, and assertions about misuse.
//
// Threads   The library may call the handlers on any thread. Set your handlers before other threads start.
// Errors    A message handler must not throw. An assertion handler may throw, to leave the misused function. If that
//           function is noexcept or a destructor, throwing ends the program.
// Messages  The library ignores bad data, such as a box with a NaN. Each Grid and each Sweeps reports its first case
//           to the message handler, which writes to stderr by default.
// Misuse    A broken precondition fails an assertion. The default handler writes an explanation and the source line
//           to stderr, and aborts. Assertions exist if HASHPHASE_ENABLE_ASSERTS is 1: by default in all build types
//           except Release, MinSizeRel and an empty CMAKE_BUILD_TYPE. CMake's HASHPHASE_ASSERTS=ON or OFF overrides
//           the default.

#include <broadphase/export.hpp>

namespace hashphase {

/// Receives one message: full sentences without a trailing newline.
using MessageHandler = void (*)(const char* message);

/// Receives a broken precondition: its source text, a sentence that explains the fault and the remedy, and the source
/// line. If the handler returns, the program continues at the caller's risk.
using AssertHandler = void (*)(const char* condition, const char* sentence, const char* file,
                               int line);

/// Replaces the message handler; nullptr restores the default. Returns the previous handler.
HASHPHASE_BROADPHASE_EXPORT MessageHandler setMessageHandler(MessageHandler handler) noexcept;

/// Replaces the assertion handler; nullptr restores the default. Returns the previous handler.
HASHPHASE_BROADPHASE_EXPORT AssertHandler setAssertHandler(AssertHandler handler) noexcept;

namespace detail {
HASHPHASE_BROADPHASE_EXPORT void reportMessage(const char* message);
HASHPHASE_BROADPHASE_EXPORT void reportBrokenAssert(const char* condition, const char* sentence,
                                                    const char* file, int line);
}  // namespace detail

}  // namespace hashphase

#ifndef HASHPHASE_ENABLE_ASSERTS
#define HASHPHASE_ENABLE_ASSERTS 0
#endif

#if HASHPHASE_ENABLE_ASSERTS
#define HASHPHASE_ASSERT(condition, sentence)                                                      \
    ((condition)                                                                                   \
         ? static_cast<void>(0)                                                                    \
         : ::hashphase::detail::reportBrokenAssert(#condition, sentence, __FILE__, __LINE__))
#else
#define HASHPHASE_ASSERT(condition, sentence) static_cast<void>(0)
#endif
