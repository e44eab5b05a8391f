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

/// Collects messages while it lives, in place of stderr. One at a time.
class CaughtMessages {
public:
    CaughtMessages() : previous_(setMessageHandler(&note)) {
        const std::lock_guard lock(mutex());
        list().clear();
    }
    ~CaughtMessages() { setMessageHandler(previous_); }
    CaughtMessages(const CaughtMessages&) = delete;
    CaughtMessages& operator=(const CaughtMessages&) = delete;

    [[nodiscard]] std::vector<std::string> all() const {
        const std::lock_guard lock(mutex());
        return list();
    }

private:
    static void note(const char* message) {
        const std::lock_guard lock(mutex());
        list().emplace_back(message);
    }
    static std::vector<std::string>& list() {
        static std::vector<std::string> messages;
        return messages;
    }
    static std::mutex& mutex() {
        static std::mutex mutex;
        return mutex;
    }

    MessageHandler previous_;
};

/// What a broken assertion throws while ThrowingAsserts lives.
struct BrokenAssert : std::logic_error {
    using std::logic_error::logic_error;
};

/// Makes broken assertions throw BrokenAssert with the sentence.
class ThrowingAsserts {
public:
    ThrowingAsserts() : previous_(setAssertHandler(&throwIt)) {}
    ~ThrowingAsserts() { setAssertHandler(previous_); }
    ThrowingAsserts(const ThrowingAsserts&) = delete;
    ThrowingAsserts& operator=(const ThrowingAsserts&) = delete;

private:
    [[noreturn]] static void throwIt(const char* /*condition*/, const char* sentence,
                                     const char* /*file*/, int /*line*/) {
        throw BrokenAssert(sentence);
    }

    AssertHandler previous_;
};

/// Counts broken assertions while it lives, and goes on, as without assertions.
class CaughtAsserts {
public:
    CaughtAsserts() : previous_(setAssertHandler(&note)) { count_ = 0; }
    ~CaughtAsserts() { setAssertHandler(previous_); }
    CaughtAsserts(const CaughtAsserts&) = delete;
    CaughtAsserts& operator=(const CaughtAsserts&) = delete;

    [[nodiscard]] int count() const { return count_; }

private:
    static void note(const char* /*condition*/, const char* /*sentence*/, const char* /*file*/,
                     int /*line*/) {
        ++count_;
    }
    static inline std::atomic<int> count_ = 0;

    AssertHandler previous_;
};

}  // namespace hashphase::test
