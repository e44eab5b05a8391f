// SPDX-License-Identifier: Zlib
#include <integration/culling/culler.hpp>

#include <broadphase/collectors.hpp>

#include <algorithm>
#include <cmath>

namespace hashphase {
namespace {

template <class Scalar>
ConvexRegion<Scalar> nothing() {
    constexpr Scalar nan = std::numeric_limits<Scalar>::quiet_NaN();
    const detail::Plane<Scalar> plane(Vector3<Scalar>::Constant(nan), nan);
    return ConvexRegion<Scalar>(std::span<const detail::Plane<Scalar>>(&plane, 1));
}

/// Counts those that are in a culler's set.
template <class Scalar>
class CountVisible {
public:
    explicit CountVisible(const Culler<Scalar>& culler) : culler_(culler) {}

    void add(ProxyId id, Scalar /*key*/) noexcept { count_ += culler_.isVisible(id) ? 1 : 0; }
    [[nodiscard]] static constexpr Scalar limit() noexcept {
        return std::numeric_limits<Scalar>::infinity();
    }
    [[nodiscard]] std::size_t count() const noexcept { return count_; }

private:
    const Culler<Scalar>& culler_;
    std::size_t count_ = 0;
};

}  // namespace

template <class Scalar>
Culler<Scalar>::Culler(Scalar margin)
    : margin_(margin > 0 ? margin : Scalar(0)),
      moved_(std::numeric_limits<Scalar>::infinity()),
      frustum_(nothing<Scalar>()),
      grown_(frustum_) {}

template <class Scalar>
void Culler<Scalar>::noteMoves(Scalar moved) noexcept {
    constexpr Scalar infinity = std::numeric_limits<Scalar>::infinity();
    const Scalar step = moved >= 0 ? moved : infinity;
    const Scalar sum = moved_ + step;
    // Never rounded down: of many small steps each would be lost.
    const bool isShort = sum - std::max(moved_, step) < std::min(moved_, step);
    moved_ = isShort ? std::nextafter(sum, infinity) : sum;
}

// Whoever touches the view now touched what was looked through before, if since then nobody has moved
// farther than the view lies inside of that. Nobody knows what an infinite distance stands for, whatever the margin.
template <class Scalar>
bool Culler<Scalar>::keepsSet() const {
    return moved_ <= margin_ && std::isfinite(moved_) && frustum_.isEmpty() == grown_.isEmpty() &&
           !frustum_.volume().isInside && !grown_.volume().isInside &&
           grown_.contains(frustum_, moved_);
}

// Returns whether the set is to be found anew, and empties it if so. It is not to be kept before it is
// found: should the query throw, it has not all that is visible.
template <class Scalar>
bool Culler<Scalar>::begin(const Grid<Scalar>& grid, const Frustum& frustum, Scalar moved) {
    HASHPHASE_ASSERT(!detail::QueryScope::isWithin(this),
                     "Culler::look() was called from its own filter or from forEach(). Call it "
                     "after they return.");
    if (!isFrozen_) {
        frustum_ = frustum;
    }
    noteMoves(moved);
    if (population_ == grid.populationNumber() && keepsSet()) {
        return false;
    }
    population_ = grid.populationNumber();
    ++findCount_;
    grown_ = margin_ > 0 ? frustum_.grownBy(margin_) : frustum_;
    moved_ = std::numeric_limits<Scalar>::infinity();
    if (peaks_.isPast(bits_.size(), bits_.capacity())) {
        std::vector<std::uint64_t>().swap(bits_);
    }
    bits_.clear();
    return true;
}

template <class Scalar>
QueryCost Culler<Scalar>::look(const Grid<Scalar>& grid, const Frustum& frustum, Scalar moved) {
    if (!begin(grid, frustum, moved)) {
        return {};
    }
    CollectBits bits(bits_);
    const QueryCost cost = grid.visit(grown_, bits);
    moved_ = 0;
    return cost;
}

template <class Scalar>
QueryCost Culler<Scalar>::look(const Grid<Scalar>& grid, const Frustum& frustum, ProxyFilter filter,
                               Scalar moved) {
    if (!begin(grid, frustum, moved)) {
        return {};
    }
    const detail::QueryScope scope(this);
    CollectBits bits(bits_);
    CollectIf accepted(bits, filter);
    const QueryCost cost = grid.visit(grown_, accepted);
    moved_ = 0;
    return cost;
}

template <class Scalar>
std::size_t Culler<Scalar>::count() const noexcept {
    std::size_t count = 0;
    for (const std::uint64_t word : bits_) {
        count += static_cast<std::size_t>(std::popcount(word));
    }
    return count;
}

template <class Scalar>
Overdraw Culler<Scalar>::overdraw(const Grid<Scalar>& grid) const {
    CountVisible<Scalar> seen(*this);
    grid.visit(frustum_.exact(), seen);
    const std::size_t visible = count();
    return {visible, visible - std::min(visible, seen.count())};
}

template class HASHPHASE_INSTANCE_EXPORT Culler<float>;
template class HASHPHASE_INSTANCE_EXPORT Culler<double>;

}  // namespace hashphase
