// SPDX-License-Identifier: Zlib
#pragma once

// The library's messages and assertions, caught.

#include <broadphase/diagnostics.hpp>

#include <atomic>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

namespace hashphase::test {

/// The handler is this one while it lives.
template <auto set, auto handler>
class Handled {
public:
    Handled() : previous_(set(handler)) {}
    ~Handled() { set(previous_); }
    Handled(const Handled&) = delete;
    Handled& operator=(const Handled&) = delete;

private:
    decltype(set(handler)) previous_;
};

/// Collects messages while it lives, in place of stderr. One at a time.
class CaughtMessages {
public:
    CaughtMessages() {
        const std::lock_guard lock(mutex_);
        list_.clear();
    }
    [[nodiscard]] std::vector<std::string> all() const {
        const std::lock_guard lock(mutex_);
        return list_;
    }

private:
    static void note(const char* message) {
        const std::lock_guard lock(mutex_);
        list_.emplace_back(message);
    }
    static inline std::vector<std::string> list_;
    static inline std::mutex mutex_;
    Handled<&setMessageHandler, &note> handled_;
};

/// What a broken assertion throws while ThrowingAsserts lives.
struct BrokenAssert : std::logic_error {
    using std::logic_error::logic_error;
};

[[noreturn]] inline void throwBrokenAssert(const char* /*condition*/, const char* sentence,
                                           const char* /*file*/, int /*line*/) {
    throw BrokenAssert(sentence);
}

/// Makes broken assertions throw BrokenAssert with the sentence.
using ThrowingAsserts = Handled<&setAssertHandler, &throwBrokenAssert>;

/// Counts broken assertions while it lives, and goes on, as without assertions.
class CaughtAsserts {
public:
    CaughtAsserts() { count_ = 0; }
    [[nodiscard]] int count() const { return count_; }

private:
    static void note(const char* /*condition*/, const char* /*sentence*/, const char* /*file*/,
                     int /*line*/) {
        ++count_;
    }
    static inline std::atomic<int> count_ = 0;
    Handled<&setAssertHandler, &note> handled_;
};

}  // namespace hashphase::test
