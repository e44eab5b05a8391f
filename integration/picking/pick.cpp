// SPDX-License-Identifier: Zlib
#include <integration/picking/pick.hpp>

#include <algorithm>
#include <tuple>

namespace hashphase {
namespace {

template <class Scalar>
Picked<Scalar> pickedAt(const RayRegion<Scalar>& ray, ProxyId id, Scalar fraction) {
    return {id, fraction, ray.from() + fraction * ray.direction()};
}

/// A collector of those that the exact test confirms.
template <class Scalar, class Collector>
class CollectConfirmed {
public:
    CollectConfirmed(const RayRegion<Scalar>& ray, ExactTest<Scalar> test, Collector& confirmed)
        : ray_(ray), test_(test), confirmed_(confirmed) {}

    void add(ProxyId id, Scalar /*key*/) {
        const Scalar farthest = limit();
        const std::optional<Scalar> fraction = test_(id, ray_, farthest);
        if (fraction && *fraction >= 0 && *fraction <= farthest) {
            confirmed_.add(id, *fraction);
        }
    }
    [[nodiscard]] Scalar limit() const { return std::min(confirmed_.limit(), Scalar(1)); }

private:
    const RayRegion<Scalar>& ray_;
    ExactTest<Scalar> test_;
    Collector& confirmed_;
};

template <class Scalar>
class CollectPicked {
public:
    CollectPicked(const RayRegion<Scalar>& ray, std::vector<Picked<Scalar>>& picked)
        : ray_(ray), picked_(picked) {
        picked_.clear();
    }

    void add(ProxyId id, Scalar fraction) { picked_.push_back(pickedAt(ray_, id, fraction)); }
    [[nodiscard]] static constexpr Scalar limit() { return 1; }

    std::span<const Picked<Scalar>> sort() {
        std::sort(picked_.begin(), picked_.end(), [](const auto& a, const auto& b) {
            return std::tie(a.fraction, a.id) < std::tie(b.fraction, b.id);
        });
        return picked_;
    }

private:
    const RayRegion<Scalar>& ray_;
    std::vector<Picked<Scalar>>& picked_;
};

template <class Scalar, class Collector>
void visitIf(const Grid<Scalar>& grid, const RayRegion<Scalar>& ray, Collector& collector,
             ProxyFilter filter, QueryCost* cost) {
    CollectIf accepted(collector, filter);
    const QueryCost spent = grid.visit(ray, accepted);
    if (cost != nullptr) {
        *cost += spent;
    }
}

template <class Scalar>
Picked<Scalar> nearestOf(const RayRegion<Scalar>& ray, const CollectClosest<Scalar>& closest) {
    return closest.found().isNull() ? Picked<Scalar>{}
                                    : pickedAt(ray, closest.found(), closest.key());
}

}  // namespace

template <class Scalar>
Picked<Scalar> pickNearest(const Grid<Scalar>& grid, const RayRegion<Scalar>& ray,
                           ProxyFilter filter, QueryCost* cost) {
    CollectClosest<Scalar> closest;
    visitIf(grid, ray, closest, filter, cost);
    return nearestOf(ray, closest);
}

template <class Scalar>
Picked<Scalar> pickNearest(const Grid<Scalar>& grid, const RayRegion<Scalar>& ray,
                           std::type_identity_t<ExactTest<Scalar>> test, ProxyFilter filter,
                           QueryCost* cost) {
    CollectClosest<Scalar> closest;
    CollectConfirmed confirmed(ray, test, closest);
    visitIf(grid, ray, confirmed, filter, cost);
    return nearestOf(ray, closest);
}

template <class Scalar>
std::span<const Picked<Scalar>> pickAll(const Grid<Scalar>& grid, const RayRegion<Scalar>& ray,
                                        std::vector<Picked<Scalar>>& picked, ProxyFilter filter,
                                        QueryCost* cost) {
    CollectPicked<Scalar> all(ray, picked);
    visitIf(grid, ray, all, filter, cost);
    return all.sort();
}

template <class Scalar>
std::span<const Picked<Scalar>> pickAll(const Grid<Scalar>& grid, const RayRegion<Scalar>& ray,
                                        std::vector<Picked<Scalar>>& picked,
                                        std::type_identity_t<ExactTest<Scalar>> test,
                                        ProxyFilter filter, QueryCost* cost) {
    CollectPicked<Scalar> all(ray, picked);
    CollectConfirmed confirmed(ray, test, all);
    visitIf(grid, ray, confirmed, filter, cost);
    return all.sort();
}

#define HASHPHASE_INSTANTIATE(Scalar)                                                              \
    template Picked<Scalar> pickNearest(const Grid<Scalar>&, const RayRegion<Scalar>&,             \
                                        ProxyFilter, QueryCost*);                                  \
    template Picked<Scalar> pickNearest(const Grid<Scalar>&, const RayRegion<Scalar>&,             \
                                        ExactTest<Scalar>, ProxyFilter, QueryCost*);               \
    template std::span<const Picked<Scalar>> pickAll(                                              \
        const Grid<Scalar>&, const RayRegion<Scalar>&, std::vector<Picked<Scalar>>&, ProxyFilter,  \
        QueryCost*);                                                                               \
    template std::span<const Picked<Scalar>> pickAll(                                              \
        const Grid<Scalar>&, const RayRegion<Scalar>&, std::vector<Picked<Scalar>>&,               \
        ExactTest<Scalar>, ProxyFilter, QueryCost*)

HASHPHASE_INSTANTIATE(float);
HASHPHASE_INSTANTIATE(double);
#undef HASHPHASE_INSTANTIATE

}  // namespace hashphase
