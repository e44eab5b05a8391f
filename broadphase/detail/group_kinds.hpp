// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/proxy_groups.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace hashphase::detail {

/// Numbers the groups that proxies have, so that a few bits tell whether some of them may not pair:
/// mostly none, and then no search need look at groups. Programs have a dozen of them; where there are
/// more than kOther, all others share that number, and may refuse any.
class GroupKinds {
public:
    using Set = std::uint64_t;  // a bit for each number

    static constexpr std::uint8_t kOther = 63;

    GroupKinds() noexcept { static_cast<void>(numberOf(ProxyGroups{})); }

    static constexpr Set bit(std::uint8_t kind) noexcept { return Set{1} << kind; }

    /// Numbers them, if that has not been done yet. ProxyGroups{} has the number 0. Cost: O(kinds).
    std::uint8_t numberOf(const ProxyGroups& groups) noexcept {
        const auto end = kinds_.begin() + count_;
        const auto known = std::find(kinds_.begin(), end, groups);
        if (known != end) {
            return static_cast<std::uint8_t>(known - kinds_.begin());
        }
        const std::uint8_t number = count_;
        if (number == kOther) {
            refused_.fill(~Set{0});
            someRefuse_ = true;
            return kOther;
        }
        kinds_[number] = groups;
        ++count_;
        for (std::uint8_t other = 0; other <= number; ++other) {
            if (!mayPair(kinds_[other], groups)) {
                refused_[other] |= bit(number);
                refused_[number] |= bit(other);
                someRefuse_ = true;
            }
        }
        return number;
    }

    /// Of a number below kOther.
    [[nodiscard]] const ProxyGroups& operator[](std::uint8_t kind) const noexcept {
        return kinds_[kind];
    }

    /// True when some of the one may not pair with some of the other; or when there are so many that
    /// nothing is known.
    [[nodiscard]] bool refuse(Set some, Set others) const noexcept {
        for (; some != 0 && someRefuse_; some &= some - 1) {
            if ((refused_[static_cast<std::size_t>(std::countr_zero(some))] & others) != 0) {
                return true;
            }
        }
        return false;
    }
    [[nodiscard]] bool refuse(std::uint8_t a, std::uint8_t b) const noexcept {
        return (refused_[a] & bit(b)) != 0;
    }

    /// Among all that were ever numbered.
    [[nodiscard]] bool someRefuse() const noexcept { return someRefuse_; }

    /// All bits of the groups and of the masks of these. What may not pair with that may pair with none.
    [[nodiscard]] ProxyGroups together(Set some) const noexcept {
        ProxyGroups all{0, 0};
        for (; some != 0; some &= some - 1) {
            const auto kind = static_cast<std::uint8_t>(std::countr_zero(some));
            all = kind >= count_
                      ? ProxyGroups{}
                      : ProxyGroups{all.group | kinds_[kind].group, all.mask | kinds_[kind].mask};
        }
        return all;
    }

private:
    std::array<ProxyGroups, kOther> kinds_{};  // the first count_
    std::array<Set, kOther + 1> refused_{};    // by each, which it may not pair with
    std::uint8_t count_ = 0;
    bool someRefuse_ = false;
};

}  // namespace hashphase::detail
