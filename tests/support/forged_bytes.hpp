// SPDX-License-Identifier: Zlib
#pragma once

// Bytes of a snapshot that a stranger has changed, with a checksum that is right.

#include <broadphase/core/sealed_bytes.hpp>
#include <tests/support/random.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace hashphase::test {

/// Changes some bytes behind the seal, or cuts them off.
inline void forgeBytes(std::vector<std::byte>& bytes, Random& random) {
    constexpr std::size_t kHead = 28;  // kind, version, size, checksum
    for (std::uint32_t i = 1 + random.below(4); i-- > 0;) {
        const auto size = static_cast<std::uint32_t>(bytes.size() - kHead);
        const std::size_t at = kHead + random.below(size);
        switch (random.below(16)) {
            case 0:
                bytes.resize(std::max(kHead + 1, at));
                break;
            case 1:
            case 2:
                bytes[at] = std::byte{0xff};
                break;
            case 3:
            case 4:
            case 5:
                bytes[at] = static_cast<std::byte>(random.below(256));
                break;
            default:
                bytes[at] ^= static_cast<std::byte>(1U << random.below(8));
                break;
        }
    }
    const std::span<const std::byte> content = std::span(bytes).subspan(kHead);
    const std::uint64_t size = content.size();
    const std::uint64_t sum = detail::checksum(content);
    std::memcpy(bytes.data() + 12, &size, sizeof(size));
    std::memcpy(bytes.data() + 20, &sum, sizeof(sum));
}

}  // namespace hashphase::test
