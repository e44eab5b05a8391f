// SPDX-License-Identifier: Zlib
#include <demos/accuracy/origin/origin_experiment.hpp>

#include <broadphase/pairs.hpp>
#include <demos/accuracy/baselines/dbvt_boxes.hpp>

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
class GridWorld final : public OriginWorld {
public:
    void set(std::span<const WorldBox> boxes) override {
        numbers_.look(boxes);
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const Aabb<Scalar> box = numbers_.box(boxes[i]);
            if (i < ids_.size()) {
                grid_.move(ids_[i], box);
            } else {
                ids_.push_back(grid_.add(box));
            }
        }
        pairs_.update([](ProxyId, ProxyId) { return true; });
    }

    void listPairs(std::vector<PairKey>& pairs) override {
        std::vector<ProxyPair> all;
        pairs_.collect(all);
        for (const ProxyPair& pair : all) {
            pairs.push_back(pairKey(pair.first.index, pair.second.index));
        }
    }

    void listHits(const WorldRay& ray, std::vector<std::uint32_t>& boxes) override {
        std::vector<ProxyId> hits;
        CollectAll collector(hits);
        grid_.visit(numbers_.ray(ray), collector);
        for (const ProxyId hit : hits) {
            boxes.push_back(hit.index);
        }
    }

private:
    Numbers numbers_;
    Grid<Scalar> grid_;
    Pairs<Scalar> pairs_{grid_};
    std::vector<ProxyId> ids_;
};

class DbvtWorld final : public OriginWorld {
public:
    ~DbvtWorld() override {
        for (btBroadphaseProxy* proxy : proxies_) {
            broadphase_.destroyProxy(proxy, nullptr);
        }
    }

    void set(std::span<const WorldBox> boxes) override {
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const Aabb<float> box = Nearest<float>().box(boxes[i]);
            const btVector3 low = toBullet(box.min());
            const btVector3 high = toBullet(box.max());
            if (i < proxies_.size()) {
                broadphase_.setAabb(proxies_[i], low, high, nullptr);
            } else {
                proxies_.push_back(broadphase_.createProxy(low, high, 0, this,
                                                           btBroadphaseProxy::DefaultFilter,
                                                           btBroadphaseProxy::AllFilter, nullptr));
            }
        }
        broadphase_.calculateOverlappingPairs(nullptr);
    }

    void listPairs(std::vector<PairKey>& pairs) override {
        const btBroadphasePairArray& all =
            broadphase_.getOverlappingPairCache()->getOverlappingPairArray();
        for (int i = 0; i < all.size(); ++i) {
            pairs.push_back(pairKey(DbvtBoxes::objectOf(*all[i].m_pProxy0),
                                    DbvtBoxes::objectOf(*all[i].m_pProxy1)));
        }
    }

    void listHits(const WorldRay& ray, std::vector<std::uint32_t>& boxes) override {
        const btVector3 from = toBullet(ray.from.cast<float>());
        const btVector3 to = toBullet(ray.to.cast<float>());
        if (!(from == to)) {  // Bullet cannot cast a ray without direction
            castRay(broadphase_, from, to, [&](const btBroadphaseProxy& proxy) {
                boxes.push_back(DbvtBoxes::objectOf(proxy));
            });
        }
    }

private:
    btDbvtBroadphase broadphase_;
    std::vector<btBroadphaseProxy*> proxies_;
};

template <class World>
std::unique_ptr<OriginWorld> makeWorld() {
    return std::make_unique<World>();
}

}  // namespace

std::vector<OriginMethod> originMethods() {
    return {
        {"float", true, true, false, false, makeWorld<GridWorld<float, Nearest<float>>>},
        {"float, rounded outward", true, true, true, false, makeWorld<GridWorld<float, Outward>>},
        {"float positions", true, false, false, false, makeWorld<GridWorld<float, FromPosition>>},
        {"integer cell + local float", true, true, true, true,
         makeWorld<GridWorld<float, FromCell>>},
        {"double", true, true, true, true, makeWorld<GridWorld<double, Nearest<double>>>},
        {"btDbvtBroadphase, float", false, false, false, false, makeWorld<DbvtWorld>},
    };
}

}  // namespace hashphase::demos
