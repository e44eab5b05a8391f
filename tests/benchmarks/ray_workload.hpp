// SPDX-License-Identifier: Zlib
#pragma once

// Rays through a scene, as btCollisionWorld casts them, and rays between two writes.

#include <tests/benchmarks/query_workload.hpp>

namespace hashphase::benchmarks {

struct Ray {
    btVector3 from;
    btVector3 to;
};

/// Draws one ray through these boxes.
using DrawRay = std::function<Ray(demos::Random&, const std::vector<Aabb<float>>&)>;

/// What is asked: what the ray meets, or what overlaps a box of 2 m around its start.
enum class Probe { ray, box };

struct RayPlan {
    DrawRay draw;
    std::size_t raysPerFrame = 500;
    btVector3 castHalfExtents{0, 0, 0};  // the box that is moved along the ray
    Probe probe = Probe::ray;            // a box is one query for each of them
    bool closestOnly = false;            // only how far the nearest box is, not all boxes
    bool movesScene = false;             // all boxes move before each frame; else they stand still
};

/// The answers are every box that a ray meets, or the distance to the nearest one.
class RayWorkload : public QueryWorkload {
public:
    RayWorkload(std::unique_ptr<demos::BoxScene> scene, RayPlan plan, std::uint64_t seed);

    void beginFrame() override;
    void listExactAnswers(std::vector<Answer>& answers) override;
    [[nodiscard]] std::size_t operations() const override { return plan_.raysPerFrame; }

private:
    void ask(demos::FilledBroadphase& filled, std::vector<Answer>& answers) override;
    void askForAll(btBroadphaseInterface& broadphase, std::vector<Answer>& answers) const;
    void askForClosest(btBroadphaseInterface& broadphase, std::vector<Answer>& answers) const;

    RayPlan plan_;
    demos::Random random_;
    std::vector<Ray> rays_;
};

/// Sets one box, asks one question, sets the next: what a game does that moves its characters one
/// by one. The pairs are found after the frame, untimed.
class InterleavedWorkload : public QueryWorkload {
public:
    InterleavedWorkload(std::unique_ptr<demos::BoxScene> scene, Probe probe, DrawRay draw,
                        std::uint64_t seed);

    void beginFrame() override;
    void listExactAnswers(std::vector<Answer>& answers) override;
    void endFrame(std::size_t contestant) override { filled(contestant).findPairs(); }
    [[nodiscard]] std::size_t operations() const override { return steps_.size(); }

private:
    struct Step {
        std::uint32_t object;
        demos::BulletBox box;
        Ray ray;
    };

    void ask(demos::FilledBroadphase& filled, std::vector<Answer>& answers) override;

    Probe probe_;
    DrawRay draw_;
    demos::Random random_;
    std::vector<Aabb<float>> boxes_;  // as of the beginning of the frame
    std::vector<Aabb<float>> boxesAtEnd_;
    std::vector<Step> steps_;
};

}  // namespace hashphase::benchmarks
