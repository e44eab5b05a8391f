// SPDX-License-Identifier: Zlib
#include <broadphase/diagnostics.hpp>

#include <broadphase/core/same_library.hpp>

#include <atomic>
#include <cstdio>
#include <cstdlib>

namespace hashphase {

const char HASHPHASE_STANDARD_LIBRARY = 0;

namespace {

void printMessage(const char* message) {
    std::fprintf(stderr, "hashphase: %s\n", message);
}

void printAndAbort(const char* condition, const char* sentence, const char* file, int line) {
    std::fprintf(stderr, "hashphase: %s (%s:%d: %s is false)\n", sentence, file, line, condition);
    std::abort();
}

std::atomic<MessageHandler> messageHandler{&printMessage};
std::atomic<AssertHandler> assertHandler{&printAndAbort};

}  // namespace

MessageHandler setMessageHandler(MessageHandler handler) noexcept {
    return messageHandler.exchange(handler != nullptr ? handler : &printMessage);
}

AssertHandler setAssertHandler(AssertHandler handler) noexcept {
    return assertHandler.exchange(handler != nullptr ? handler : &printAndAbort);
}

namespace detail {

void reportMessage(const char* message) {
    messageHandler.load()(message);
}

void reportBrokenAssert(const char* condition, const char* sentence, const char* file, int line) {
    assertHandler.load()(condition, sentence, file, line);
}

}  // namespace detail
}  // namespace hashphase
