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

    void sort() {
        std::sort(picked_.begin(), picked_.end(), [](const auto& a, const auto& b) {
            return std::tie(a.fraction, a.id) < std::tie(b.fraction, b.id);
        });
    }

private:
    const RayRegion<Scalar>& ray_;
    std::vector<Picked<Scalar>>& picked_;
};

template <class Scalar, class Collector>
QueryCost visitIf(const Grid<Scalar>& grid, const RayRegion<Scalar>& ray, Collector& collector,
                  ProxyFilter filter) {
    CollectIf accepted(collector, filter);
    return grid.visit(ray, accepted);
}

void addTo(QueryCost* sum, const QueryCost& cost) {
    if (sum != nullptr) {
        *sum += cost;
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
    addTo(cost, visitIf(grid, ray, closest, filter));
    return nearestOf(ray, closest);
}

template <class Scalar>
Picked<Scalar> pickNearest(const Grid<Scalar>& grid, const RayRegion<Scalar>& ray,
                           std::type_identity_t<ExactTest<Scalar>> test, ProxyFilter filter,
                           QueryCost* cost) {
    CollectClosest<Scalar> closest;
    CollectConfirmed confirmed(ray, test, closest);
    addTo(cost, visitIf(grid, ray, confirmed, filter));
    return nearestOf(ray, closest);
}

template <class Scalar>
QueryCost pickAll(const Grid<Scalar>& grid, const RayRegion<Scalar>& ray,
                  std::vector<Picked<Scalar>>& picked, ProxyFilter filter) {
    CollectPicked<Scalar> all(ray, picked);
    const QueryCost cost = visitIf(grid, ray, all, filter);
    all.sort();
    return cost;
}

template <class Scalar>
QueryCost pickAll(const Grid<Scalar>& grid, const RayRegion<Scalar>& ray,
                  std::vector<Picked<Scalar>>& picked, std::type_identity_t<ExactTest<Scalar>> test,
                  ProxyFilter filter) {
    CollectPicked<Scalar> all(ray, picked);
    CollectConfirmed confirmed(ray, test, all);
    const QueryCost cost = visitIf(grid, ray, confirmed, filter);
    all.sort();
    return cost;
}

#define HASHPHASE_INSTANTIATE(Scalar)                                                              \
    template Picked<Scalar> pickNearest(const Grid<Scalar>&, const RayRegion<Scalar>&,             \
                                        ProxyFilter, QueryCost*);                                  \
    template Picked<Scalar> pickNearest(const Grid<Scalar>&, const RayRegion<Scalar>&,             \
                                        ExactTest<Scalar>, ProxyFilter, QueryCost*);               \
    template QueryCost pickAll(const Grid<Scalar>&, const RayRegion<Scalar>&,                      \
                               std::vector<Picked<Scalar>>&, ProxyFilter);                         \
    template QueryCost pickAll(const Grid<Scalar>&, const RayRegion<Scalar>&,                      \
                               std::vector<Picked<Scalar>>&, ExactTest<Scalar>, ProxyFilter)

HASHPHASE_INSTANTIATE(float);
HASHPHASE_INSTANTIATE(double);
#undef HASHPHASE_INSTANTIATE

}  // namespace hashphase
