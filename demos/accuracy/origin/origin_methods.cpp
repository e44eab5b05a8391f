// SPDX-License-Identifier: Zlib
#include <demos/accuracy/origin/origin_experiment.hpp>

#include <broadphase/pairs.hpp>
#include <demos/accuracy/baselines/dbvt_boxes.hpp>
#include <demos/scenes/list_pairs.hpp>
#include <integration/bullet/conversions.hpp>

#include <cmath>
#include <limits>
#include <optional>

namespace hashphase::demos {
namespace {

// --- How numbers in double precision become those of the grid ------------------------------------

/// The nearest numbers. Rounding keeps order, so boxes that overlap go on to overlap.
template <class Scalar>
struct Nearest {
    void look(std::span<const WorldBox> /*boxes*/) {}
    [[nodiscard]] Aabb<Scalar> box(const WorldBox& box) const {
        return {(box.centre - box.half).template cast<Scalar>(),
                (box.centre + box.half).template cast<Scalar>()};
    }
    [[nodiscard]] RayRegion<Scalar> ray(const WorldRay& ray) const {
        return RayRegion<Scalar>(ray.from.template cast<Scalar>(), ray.to.template cast<Scalar>());
    }
};

/// Boxes are rounded so that they contain the true ones; rays are as thick as their ends are
/// coarse.
struct Outward : Nearest<float> {
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();

    static float below(double number) {
        const auto nearest = static_cast<float>(number);
        return nearest > number ? std::nextafter(nearest, -kInfinity) : nearest;
    }
    static float above(double number) { return -below(-number); }
    static float ulpOf(float number) {
        return std::nextafter(std::abs(number), kInfinity) - std::abs(number);
    }

    [[nodiscard]] Aabb<float> box(const WorldBox& box) const {
        return {(box.centre - box.half).unaryExpr(&below),
                (box.centre + box.half).unaryExpr(&above)};
    }
    [[nodiscard]] RayRegion<float> ray(const WorldRay& ray) const {
        const Vector3<float> from = ray.from.cast<float>();
        const Vector3<float> to = ray.to.cast<float>();
        const Vector3<float> thick = from.unaryExpr(&ulpOf).cwiseMax(to.unaryExpr(&ulpOf));
        return {from, to, {-thick, thick}};
    }
};

/// What a world does that knows positions in single precision alone: both faces are computed from
/// a centre that has been rounded.
struct FromPosition : Nearest<float> {
    [[nodiscard]] Aabb<float> box(const WorldBox& box) const {
        const Vector3<float> centre = box.centre.cast<float>();
        const Vector3<float> half = box.half.cast<float>();
        return {centre - half, centre + half};
    }
};

/// The world is divided into cells that are numbered by whole numbers; numbers in single precision
/// count from the corner of the cell in which the first box was when it was first seen.
struct FromCell : Nearest<float> {
    static constexpr double kCell = 1024;  // [m]

    void look(std::span<const WorldBox> boxes) {
        if (!origin.has_value()) {
            origin = (boxes.front().centre / kCell).array().floor() * kCell;
        }
    }
    [[nodiscard]] Aabb<float> box(const WorldBox& box) const {
        return Nearest::box({box.centre - *origin, box.half});
    }
    [[nodiscard]] RayRegion<float> ray(const WorldRay& ray) const {
        return Nearest::ray({ray.from - *origin, ray.to - *origin});
    }

    std::optional<Vector3<double>> origin;
};

// --- Worlds --------------------------------------------------------------------------------------

/// Indices of an empty grid's proxies count up from 0.
template <class Scalar, class Numbers>
OriginWorld gridWorld() {
    struct Filed {
        Numbers numbers;
        Grid<Scalar> grid;
        Pairs<Scalar> pairs{grid};
        std::vector<ProxyId> ids;
    };
    const auto filed = std::make_shared<Filed>();
    return {[=](std::span<const WorldBox> boxes) {
                filed->numbers.look(boxes);
                for (std::size_t i = 0; i < boxes.size(); ++i) {
                    const Aabb<Scalar> box = filed->numbers.box(boxes[i]);
                    if (i < filed->ids.size()) {
                        filed->grid.move(filed->ids[i], box);
                    } else {
                        filed->ids.push_back(filed->grid.add(box));
                    }
                }
                filed->pairs.update([](ProxyId, ProxyId) { return true; });
            },
            [=](std::vector<PairKey>& pairs) { listPairs(filed->pairs, pairs); },
            [=](const WorldRay& ray, std::vector<std::uint32_t>& boxes) {
                std::vector<ProxyId> hits;
                CollectAll collector(hits);
                filed->grid.visit(filed->numbers.ray(ray), collector);
                for (const ProxyId hit : hits) {
                    boxes.push_back(hit.index);
                }
            }};
}

OriginWorld dbvtWorld() {
    const auto filed = std::make_shared<std::optional<FilledBroadphase>>();
    return {[=](std::span<const WorldBox> boxes) {
                const bool isNew = !filed->has_value();
                if (isNew) {
                    filed->emplace(broadphaseKind("dbvt"),
                                   BroadphaseNeeds{Aabb<float>(), boxes.size()});
                }
                for (std::uint32_t i = 0; i < boxes.size(); ++i) {
                    const Aabb<float> box = Nearest<float>().box(boxes[i]);
                    const BulletBox converted{toBullet(box.min()), toBullet(box.max())};
                    isNew ? (*filed)->create(i, converted, {}) : (*filed)->set(i, converted);
                }
                (*filed)->findPairs();
            },
            [=](std::vector<PairKey>& pairs) { (*filed)->listPairs(pairs); },
            [=](const WorldRay& ray, std::vector<std::uint32_t>& boxes) {
                const btVector3 from = toBullet(ray.from.cast<float>());
                const btVector3 to = toBullet(ray.to.cast<float>());
                if (!(from == to)) {  // Bullet cannot cast a ray without direction
                    castRay((*filed)->broadphase(), from, to, [&](const btBroadphaseProxy& proxy) {
                        boxes.push_back(FilledBroadphase::objectOf(proxy));
                    });
                }
            }};
}

}  // namespace

std::vector<OriginMethod> originMethods() {
    return {
        {"float", "ours misses_no_pair", gridWorld<float, Nearest<float>>},
        {"float, rounded outward", "ours misses_no_pair misses_no_hit", gridWorld<float, Outward>},
        {"float positions", "ours", gridWorld<float, FromPosition>},
        {"integer cell + local float", "ours misses_no_pair misses_no_hit exact",
         gridWorld<float, FromCell>},
        {"double", "ours misses_no_pair misses_no_hit exact", gridWorld<double, Nearest<double>>},
        {"btDbvtBroadphase, float", "bullet", dbvtWorld},
    };
}

}  // namespace hashphase::demos
