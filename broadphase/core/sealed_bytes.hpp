// SPDX-License-Identifier: Zlib
#pragma once

// Bytes that say what they are, and whether they are still what was written.

#include <broadphase/core/byte_stream.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include <broadphase/core/hide_macros.hpp>

namespace hashphase::detail {

/// Of what kind, and of which version of it.
struct Seal {
    std::uint64_t kind;
    std::uint32_t version;
    const char* name;  // "a snapshot of a grid"
};

/// FNV-1a by Fowler, Noll and Vo, over eight bytes at a time, and turned, so that all bits count for all. Tells
/// damage by chance; whoever wants to can find other bytes with the same sum.
[[nodiscard]] inline std::uint64_t checksum(std::span<const std::byte> bytes) noexcept {
    constexpr std::uint64_t kPrime = 0x100000001b3U;
    std::uint64_t sum = 0xcbf29ce484222325U ^ bytes.size();
    while (!bytes.empty()) {
        std::uint64_t word = 0;
        const std::size_t count = std::min(bytes.size(), sizeof(word));
        std::memcpy(&word, bytes.data(), count);
        bytes = bytes.subspan(count);
        sum = (sum ^ word) * kPrime;
        sum ^= sum >> 29;
    }
    return sum;
}

/// Replaces what `sealed` held by the content under a seal.
inline void sealBytes(const Seal& seal, std::span<const std::byte> content,
                      std::vector<std::byte>& sealed) {
    ByteWriter head;
    head.write(seal.kind);
    head.write(seal.version);
    head.write(std::uint64_t{content.size()});
    head.write(checksum(content));
    sealed.assign(head.bytes().begin(), head.bytes().end());
    sealed.insert(sealed.end(), content.begin(), content.end());
}

/// Returns what is wrong with the bytes; else nothing, and `content` is that part of them.
[[nodiscard]] inline std::string openBytes(const Seal& seal, std::span<const std::byte> sealed,
                                           std::span<const std::byte>& content) {
    ByteReader head(sealed);
    const auto kind = head.read<std::uint64_t>();
    const auto version = head.read<std::uint32_t>();
    const auto size = head.read<std::uint64_t>();
    const auto sum = head.read<std::uint64_t>();
    if (head.isTorn() || kind != seal.kind) {
        return std::string("The bytes are not ") + seal.name + ". Pass bytes that write() made.";
    }
    if (version != seal.version) {
        return std::string("The bytes are ") + seal.name + " of version " +
               std::to_string(version) + ", but this library reads version " +
               std::to_string(seal.version) +
               ". Use the same version of hashphase to write and to read.";
    }
    if (size != head.left()) {
        return std::string("The bytes of ") + seal.name +
               " have the wrong length: " + std::to_string(head.left()) + " are here, but " +
               std::to_string(size) + " were written. Pass all of them, and no others.";
    }
    content = head.rest();
    return checksum(content) == sum
               ? std::string()
               : std::string("The bytes of ") + seal.name +
                     " are damaged: their checksum is wrong. Read or receive them again.";
}

}  // namespace hashphase::detail

#include <broadphase/core/restore_macros.hpp>
