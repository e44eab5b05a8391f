// SPDX-License-Identifier: Zlib
#pragma once

// Copies what one object keeps into another one of its class, which keeps its memory. First room is made for
// all of it, which may fail; then it is copied, which cannot. So either all is copied or nothing has changed.
//
// A class says what it keeps. What it does not name, as scratch, stays as it is.
//
//     template <class Visit>
//     static void forEachPart(Kept& to, const Kept& from, const Visit& visit) {
//         visit(to.boxes_, from.boxes_);
//         visit(to.count_, from.count_);
//     }
//
// Parts are such classes themselves, numbers and other plain values, arrays of these, atomics, and
// std::unique_ptr to all of them. Where a class has them, makeRoomFor(from) is called as well in the first
// pass, finishCopy() after the second, and copyFrom(from) in place of the second.

#include <broadphase/core/ensure_capacity.hpp>

#include <array>
#include <atomic>
#include <memory>
#include <vector>

namespace hashphase::detail {

/// For use in requirements.
struct VisitNoPart {
    template <class Part>
    void operator()(Part& /*to*/, const Part& /*from*/) const {}
};

template <class Kept>
concept HasParts = requires(Kept& to, const Kept& from) {
    Kept::forEachPart(to, from, VisitNoPart{});
};

/// The first pass.
struct MakeRoomForParts {
    template <class Kept>
    void operator()(Kept& to, const Kept& from) const {
        if constexpr (requires { to.makeRoomFor(from); }) {
            to.makeRoomFor(from);
        }
        if constexpr (HasParts<Kept>) {
            Kept::forEachPart(to, from, *this);
        }
    }
    template <class Item>
    void operator()(std::vector<Item>& to, const std::vector<Item>& from) const {
        ensureCapacity(to, from.size());
    }
    template <class Kept>
    void operator()(std::unique_ptr<Kept>& to, const std::unique_ptr<Kept>& from) const {
        if (from != nullptr) {
            if (to == nullptr) {
                to = std::make_unique<Kept>();
            }
            (*this)(*to, *from);
        }
    }
    template <class Kept, std::size_t kCount>
    void operator()(std::array<Kept, kCount>& to, const std::array<Kept, kCount>& from) const {
        for (std::size_t i = 0; i < kCount; ++i) {
            (*this)(to[i], from[i]);
        }
    }
};

/// The second pass.
struct CopyParts {
    template <class Kept>
    void operator()(Kept& to, const Kept& from) const noexcept {
        if constexpr (requires { to.copyFrom(from); }) {
            to.copyFrom(from);
        } else if constexpr (HasParts<Kept>) {
            Kept::forEachPart(to, from, *this);
            if constexpr (requires { to.finishCopy(); }) {
                to.finishCopy();
            }
        } else {
            to = from;
        }
    }
    template <class Item>
    void operator()(std::vector<Item>& to, const std::vector<Item>& from) const noexcept {
        to.assign(from.begin(), from.end());  // there is room
    }
    template <class Kept>
    void operator()(std::unique_ptr<Kept>& to, const std::unique_ptr<Kept>& from) const noexcept {
        if (from == nullptr) {
            to.reset();
        } else {
            (*this)(*to, *from);
        }
    }
    template <class Kept, std::size_t kCount>
    void operator()(std::array<Kept, kCount>& to,
                    const std::array<Kept, kCount>& from) const noexcept {
        for (std::size_t i = 0; i < kCount; ++i) {
            (*this)(to[i], from[i]);
        }
    }
    template <class Number>
    void operator()(std::atomic<Number>& to, const std::atomic<Number>& from) const noexcept {
        to.store(from.load(std::memory_order_relaxed), std::memory_order_relaxed);
    }
};

/// Where memory runs out, nothing has changed. Cost: a pass over what is kept.
template <class Kept>
void copyParts(Kept& to, const Kept& from) {
    MakeRoomForParts{}(to, from);
    CopyParts{}(to, from);
}

}  // namespace hashphase::detail
