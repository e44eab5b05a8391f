// SPDX-License-Identifier: Zlib
#pragma once

#include <broadphase/proxy_groups.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>

namespace hashphase::detail {

/// Numbers the groups that proxies have, so that a few bits tell whether some of them may not pair:
/// mostly none, and then no search need look at groups. Programs have a dozen of them; where there are
/// more than kOther, all others share that number, and may refuse any.
class GroupKinds {
public:
    using Set = std::uint64_t;  // a bit for each number

    static constexpr std::uint8_t kOther = 63;

    static constexpr Set bit(std::uint8_t kind) noexcept { return Set{1} << kind; }

    /// Numbers them, if that has not been done yet. ProxyGroups{} has the number 0; where there is no
    /// memory for more, all others have kOther. Cost: O(kinds).
    std::uint8_t numberOf(const ProxyGroups& groups) noexcept {
        if (groups == ProxyGroups{}) {
            return 0;
        }
        if (known_ == nullptr) {
            known_.reset(new (std::nothrow) Known);
        }
        if (known_ == nullptr) {
            someRefuse_ = true;
            return kOther;
        }
        auto& [kinds, refused] = *known_;
        const std::span<const ProxyGroups> present = std::span(kinds).first(count_);
        const auto known = std::find(present.begin(), present.end(), groups);
        if (known != present.end()) {
            return static_cast<std::uint8_t>(known - present.begin());
        }
        const std::uint8_t number = count_;
        if (number == kOther) {
            refused.fill(~Set{0});
            someRefuse_ = true;
            return kOther;
        }
        kinds[number] = groups;
        ++count_;
        for (std::uint8_t other = 0; other <= number; ++other) {
            if (!mayPair(kinds[other], groups)) {
                refused[other] |= bit(number);
                refused[number] |= bit(other);
                someRefuse_ = true;
            }
        }
        return number;
    }

    /// Of a number below kOther.
    [[nodiscard]] ProxyGroups operator[](std::uint8_t kind) const noexcept {
        return known_ != nullptr ? known_->kinds[kind] : ProxyGroups{};
    }

    /// True when some of the one may not pair with some of the other; or when there are so many that
    /// nothing is known.
    [[nodiscard]] bool refuse(Set some, Set others) const noexcept {
        for (; some != 0 && someRefuse_; some &= some - 1) {
            if ((refusedBy(static_cast<std::size_t>(std::countr_zero(some))) & others) != 0) {
                return true;
            }
        }
        return false;
    }
    [[nodiscard]] bool refuse(std::uint8_t a, std::uint8_t b) const noexcept {
        return someRefuse_ && (refusedBy(a) & bit(b)) != 0;
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
                      : ProxyGroups{all.group | (*this)[kind].group, all.mask | (*this)[kind].mask};
        }
        return all;
    }

    /// See core/copy_parts.hpp. What is made here refuses all until it is written.
    void makeRoomFor(const GroupKinds& from) {
        if (from.known_ != nullptr && known_ == nullptr) {
            known_ = std::make_unique<Known>();
            known_->refused.fill(~Set{0});
        }
    }
    template <class Visit>
    static void forEachPart(GroupKinds& to, const GroupKinds& from, const Visit& visit) {
        visit(to.known_, from.known_);
        visit(to.count_, from.count_);
        visit(to.someRefuse_, from.someRefuse_);
    }

private:
    struct Known {
        std::array<ProxyGroups, kOther> kinds{};  // the first count_
        std::array<Set, kOther + 1> refused{};    // by each, which it may not pair with
    };

    [[nodiscard]] Set refusedBy(std::size_t kind) const noexcept {
        return known_ != nullptr ? known_->refused[kind] : ~Set{0};
    }

    std::unique_ptr<Known> known_;  // made for the first that are not ProxyGroups{}
    std::uint8_t count_ = 1;
    bool someRefuse_ = false;
};

}  // namespace hashphase::detail
