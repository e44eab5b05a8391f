// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/ray_workload.hpp>

#include <integration/bullet/conversions.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>

#include <LinearMath/btAabbUtil2.h>

#include <algorithm>
#include <array>
#include <bit>

namespace hashphase::benchmarks {
namespace {

constexpr std::size_t kStepsPerFrame = 200;
constexpr float kProbeHalfEdge = 1;  // [m]

// The callback that btCollisionWorld::rayTest() makes, as far as broadphases see it.
struct RayCallback : btBroadphaseRayCallback {
    explicit RayCallback(const Ray& ray) {
        const btVector3 way = ray.to - ray.from;
        const btVector3 direction = way.normalized();
        for (int axis = 0; axis < 3; ++axis) {
            m_rayDirectionInverse[axis] =
                direction[axis] == 0 ? BT_LARGE_FLOAT : 1 / direction[axis];
            m_signs[axis] = m_rayDirectionInverse[axis] < 0 ? 1U : 0U;
        }
        m_lambda_max = direction.dot(way);
    }

    /// True when the cast box meets the box on its way: what every broadphase is to report.
    [[nodiscard]] bool meets(const Ray& ray, const Aabb<float>& box,
                             const btVector3& castHalfExtents) const {
        const std::array bounds{toBullet(box.min()) - castHalfExtents,
                                toBullet(box.max()) + castHalfExtents};
        btScalar distance = 1;
        return btRayAabb2(ray.from, m_rayDirectionInverse, m_signs, bounds.data(), distance, 0,
                          m_lambda_max);
    }
};

// Lists what a query finds: a ray, given as arguments of RayCallback, or a box.
template <class Callback>
struct Finds : Callback {
    template <class... Args>
    Finds(std::size_t number, std::vector<Answer>& answers, const Args&... args)
        : Callback(args...), number_(number), answers_(answers) {}

    bool process(const btBroadphaseProxy* proxy) override {
        answers_.push_back(answerOf(number_, demos::FilledBroadphase::objectOf(*proxy)));
        return true;
    }

private:
    std::size_t number_;
    std::vector<Answer>& answers_;
};

// The nearest of all hits: stock Bullet cannot stop early.
struct ClosestHit : RayCallback {
    explicit ClosestHit(const Ray& ray)
        : RayCallback(ray), region_(toEigen(ray.from), toEigen(ray.to)) {}

    bool process(const btBroadphaseProxy* proxy) override {
        const float key = region_.key(toAabb(proxy->m_aabbMin, proxy->m_aabbMax));
        closest_ = key >= 0 ? std::min(closest_, key) : closest_;
        return true;
    }
    [[nodiscard]] float closest() const noexcept { return closest_; }

private:
    RayRegion<float> region_;
    float closest_ = std::numeric_limits<float>::infinity();
};

Answer closestAnswer(std::size_t ray, float distance) {
    return answerOf(ray, std::bit_cast<std::uint32_t>(distance));
}

Aabb<float> probeBox(const Ray& ray) {
    const Vector3<float> half = Vector3<float>::Constant(kProbeHalfEdge);
    return {toEigen(ray.from) - half, toEigen(ray.from) + half};
}

void askForBox(std::size_t number, const Ray& ray, btBroadphaseInterface& broadphase,
               std::vector<Answer>& answers) {
    Finds<btBroadphaseAabbCallback> finds(number, answers);
    const Aabb<float> box = probeBox(ray);
    broadphase.aabbTest(toBullet(box.min()), toBullet(box.max()), finds);
}

}  // namespace

RayWorkload::RayWorkload(std::unique_ptr<demos::BoxScene> scene, RayPlan plan, std::uint64_t seed)
    : QueryWorkload(std::move(scene)), plan_(std::move(plan)), random_(seed) {}

void RayWorkload::beginFrame() {
    if (plan_.movesScene) {
        advanceScene();
    }
    rays_.clear();
    while (rays_.size() < plan_.raysPerFrame) {
        const Ray ray = plan_.draw(random_, scene().boxes());
        if (ray.from != ray.to) {
            rays_.push_back(ray);
        }
    }
}

void RayWorkload::ask(demos::FilledBroadphase& filled, std::vector<Answer>& answers) {
    if (plan_.closestOnly) {
        askForClosest(filled.broadphase(), answers);
    } else {
        askForAll(filled.broadphase(), answers);
    }
}

void RayWorkload::askForAll(btBroadphaseInterface& broadphase, std::vector<Answer>& answers) const {
    for (std::size_t i = 0; i < rays_.size(); ++i) {
        if (plan_.probe == Probe::box) {
            askForBox(i, rays_[i], broadphase, answers);
            continue;
        }
        Finds<RayCallback> hits(i, answers, rays_[i]);
        broadphase.rayTest(rays_[i].from, rays_[i].to, hits, -plan_.castHalfExtents,
                           plan_.castHalfExtents);
    }
}

void RayWorkload::askForClosest(btBroadphaseInterface& broadphase,
                                std::vector<Answer>& answers) const {
    const auto* own = dynamic_cast<const SpatialHashBroadphase*>(&broadphase);
    for (std::size_t i = 0; i < rays_.size(); ++i) {
        const Ray& ray = rays_[i];
        if (own != nullptr) {
            CollectClosest<float> closest;
            own->grid().visit(RayRegion<float>(toEigen(ray.from), toEigen(ray.to)), closest);
            answers.push_back(closestAnswer(i, closest.key()));
        } else {
            ClosestHit closest(ray);
            broadphase.rayTest(ray.from, ray.to, closest);
            answers.push_back(closestAnswer(i, closest.closest()));
        }
    }
}

void RayWorkload::listExactAnswers(std::vector<Answer>& answers) {
    answers.clear();
    for (std::size_t i = 0; i < rays_.size(); ++i) {
        const Finds<RayCallback> test(i, answers, rays_[i]);
        const RayRegion<float> region(toEigen(rays_[i].from), toEigen(rays_[i].to));
        float closest = std::numeric_limits<float>::infinity();
        for (std::uint32_t object = 0; object < scene().size(); ++object) {
            const Aabb<float>& box = scene().boxes()[object];
            if (plan_.probe == Probe::box) {
                if (overlaps(probeBox(rays_[i]), box)) {
                    answers.push_back(answerOf(i, object));
                }
            } else if (plan_.closestOnly) {
                const float key = region.key(box);
                closest = key >= 0 ? std::min(closest, key) : closest;
            } else if (test.meets(rays_[i], box, plan_.castHalfExtents)) {
                answers.push_back(answerOf(i, object));
            }
        }
        if (plan_.closestOnly) {
            answers.push_back(closestAnswer(i, closest));
        }
    }
}

InterleavedWorkload::InterleavedWorkload(std::unique_ptr<demos::BoxScene> scene, Probe probe,
                                         DrawRay draw, std::uint64_t seed)
    : QueryWorkload(std::move(scene)), probe_(probe), draw_(std::move(draw)), random_(seed) {
    boxesAtEnd_ = this->scene().boxes();
    steps_.resize(kStepsPerFrame);
}

void InterleavedWorkload::beginFrame() {
    boxes_ = boxesAtEnd_;
    for (Step& step : steps_) {
        const float share = random_.unit() * static_cast<float>(boxes_.size());
        const std::size_t object = std::min(static_cast<std::size_t>(share), boxes_.size() - 1);
        Aabb<float>& box = boxesAtEnd_[object];
        const Vector3<float> move(random_.between(-1, 1), random_.between(-1, 1),
                                  random_.between(-1, 1));
        box.translate(move);
        step.object = static_cast<std::uint32_t>(object);
        step.box = {toBullet(box.min()), toBullet(box.max())};
        do {
            step.ray = draw_(random_, boxesAtEnd_);
        } while (step.ray.from == step.ray.to);
    }
}

void InterleavedWorkload::ask(demos::FilledBroadphase& filled, std::vector<Answer>& answers) {
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        const Step& step = steps_[i];
        filled.set(step.object, step.box);
        if (probe_ == Probe::ray) {
            Finds<RayCallback> hits(i, answers, step.ray);
            filled.broadphase().rayTest(step.ray.from, step.ray.to, hits);
        } else {
            askForBox(i, step.ray, filled.broadphase(), answers);
        }
    }
}

void InterleavedWorkload::listExactAnswers(std::vector<Answer>& answers) {
    answers.clear();
    std::vector<Aabb<float>> boxes = boxes_;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        const Step& step = steps_[i];
        boxes[step.object] = toAabb(step.box.min, step.box.max);
        const Finds<RayCallback> test(i, answers, step.ray);
        for (std::uint32_t object = 0; object < boxes.size(); ++object) {
            const bool found = probe_ == Probe::ray
                                   ? test.meets(step.ray, boxes[object], btVector3(0, 0, 0))
                                   : overlaps(probeBox(step.ray), boxes[object]);
            if (found) {
                answers.push_back(answerOf(i, object));
            }
        }
    }
}

}  // namespace hashphase::benchmarks
