// SPDX-License-Identifier: Zlib
#pragma once

// Where hashphase speaks up: messages about bad data, and assertions about misuse.
//
// Threads   The handlers may be called from any thread that uses the library. Replace them before
//           other threads start.
// Errors    A message handler does not throw. An assertion handler may throw, to get away from misuse.
// Messages  Bad data from outside (a NaN box) is set aside, where it does no harm, and told once, in a
//           sentence; the default handler writes it to stderr.
// Misuse    A broken precondition is an assertion. The default handler writes the sentence with its place to
//           stderr and aborts. Assertions are compiled in when HASHPHASE_ENABLE_ASSERTS is 1: in every build
//           type but Release and MinSizeRel, unless CMake's HASHPHASE_ASSERTS says otherwise.

#include <broadphase/export.hpp>

namespace hashphase {

/// Receives one message, a full sentence without a trailing newline.
using MessageHandler = void (*)(const char* message);

/// Receives a broken precondition: the condition's text, a sentence saying what would be right, and
/// the place in the source. Returning continues the program at the caller's risk.
using AssertHandler = void (*)(const char* condition, const char* sentence, const char* file,
                               int line);

/// Replaces the message handler; nullptr restores the default. Returns the previous one.
HASHPHASE_BROADPHASE_EXPORT MessageHandler setMessageHandler(MessageHandler handler) noexcept;

/// Replaces the assertion handler; nullptr restores the default. Returns the previous one.
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
