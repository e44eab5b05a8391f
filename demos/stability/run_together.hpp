// SPDX-License-Identifier: Zlib
#pragma once

#include <cstddef>
#include <system_error>
#include <thread>
#include <vector>

namespace hashphase::demos {

/// False where no thread can be started, as in a browser for which nobody asked for threads.
[[nodiscard]] inline bool hasThreads() {
    static const bool has = [] {
        try {
            std::thread([] {}).join();
            return true;
        } catch (const std::system_error&) {
            return false;
        }
    }();
    return has;
}

/// Calls work(0) to work(count - 1), each on a thread of its own, or one after another where there are no
/// threads, and returns when all are done. The work throws nothing. Where a thread cannot be started, throws
/// what std::thread does, when those that could are done.
template <class Work>
void runTogether(std::size_t count, const Work& work) {
    if (!hasThreads()) {
        for (std::size_t i = 0; i < count; ++i) {
            work(i);
        }
        return;
    }
    struct Threads {
        std::vector<std::thread> all;
        ~Threads() {
            for (std::thread& thread : all) {
                thread.join();
            }
        }
    } threads;
    for (std::size_t i = 0; i < count; ++i) {
        threads.all.emplace_back([&work, i] { work(i); });
    }
}

}  // namespace hashphase::demos
