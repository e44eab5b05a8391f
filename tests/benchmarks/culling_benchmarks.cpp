// SPDX-License-Identifier: Zlib

// What does a camera see, or each of some? All objects move before each frame, and the cameras turn.
// Everybody marks the visible ones by number.

#include <broadphase/convex_region.hpp>
#include <broadphase/simd/kernels.hpp>
#include <integration/bullet/conversions.hpp>
#include <integration/camera/frustum.hpp>
#include <integration/culling/culler.hpp>
#include <tests/benchmarks/culling_loop.hpp>
#include <tests/benchmarks/workload.hpp>
#include <tests/support/cameras.hpp>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace hashphase::benchmarks {
namespace {

/// The six planes of a frustum, which face inwards.
using FrustumPlanes = std::array<Eigen::Hyperplane<float, 3>, 6>;

/// Where the cameras stand, seen from the middle of the scene, and how far they see.
struct CullingPlan {
    double backwards = 0;    // from the middle, against its heading, in sides of the scene
    double height = 0;       // above the middle [m]
    double fieldOfView = 1;  // vertical [rad]
    double farPlane = 1;     // in sides of the scene
    int cameras = 1;         // a frame, one after another, in as many directions
    bool isSecond = false;   // only a second look is timed: all that it reads is in the cache
};

/// The boxes and the cameras of a frame.
struct CullingScene {
    SceneBoxes boxes;
    CullingPlan plan;
    std::vector<FrustumPlanes> views = {};
};

/// Who culls.
class CullingRunner : public Runner {
public:
    explicit CullingRunner(const CullingScene& scene) : scene_(scene) {}

    void prepare() override {
        if (scene_.plan.isSecond) {
            run();
        }
    }
    void run() override {
        for (const FrustumPlanes& view : scene_.views) {
            look(view);
        }
    }

    // Of the last camera, what the frame left; the others look again.
    void listAnswers(std::vector<Answer>& answers) override {
        answers.clear();
        for (std::size_t camera = scene_.views.size(); camera-- > 0;) {
            if (camera + 1 < scene_.views.size()) {
                look(scene_.views[camera]);
            }
            const std::size_t first = answers.size();
            listVisible(answers);
            for (std::size_t i = first; i < answers.size(); ++i) {
                answers[i] += camera * scene_.boxes.size();
            }
        }
    }

protected:
    /// Finds the visible objects.
    virtual void look(const FrustumPlanes& planes) = 0;

    /// Appends them, in any order.
    virtual void listVisible(std::vector<Answer>& visible) const = 0;

    static void listMarked(const std::vector<std::uint8_t>& marks, std::vector<Answer>& visible) {
        for (std::size_t i = 0; i < marks.size(); ++i) {
            if (marks[i] != 0) {
                visible.push_back(i);
            }
        }
    }

    const CullingScene& scene_;
};

/// Our culler, of bits by the proxies' own indices, or Bullet's own walk of its trees for planes.
class FilledCulling final : public CullingRunner {
public:
    FilledCulling(const CullingScene& scene, const demos::BroadphaseKind& kind)
        : CullingRunner(scene),
          filled_(filledWith(scene.boxes, kind)),
          own_(dynamic_cast<const SpatialHashBroadphase*>(&filled_->broadphase())),
          isVisible_(scene.boxes.size()) {}

    void beginFrame() override {
        filled_->setAll(scene_.boxes.frame().bulletBoxes);
        filled_->findPairs();
    }

    void look(const FrustumPlanes& planes) override {
        if (own_ != nullptr) {
            const ConvexRegion<float> view(planes, Containment::touching, Touch::byPlanes);
            culler_.look(own_->grid(), view);
            return;
        }
        std::fill(isVisible_.begin(), isVisible_.end(), std::uint8_t{0});
        std::array<btVector3, 6> normals;
        std::array<btScalar, 6> offsets;
        for (std::size_t i = 0; i < planes.size(); ++i) {
            normals[i] = toBullet(planes[i].normal());
            offsets[i] = planes[i].offset();
        }
        Mark mark(isVisible_);
        for (const btDbvt& tree : dynamic_cast<btDbvtBroadphase&>(filled_->broadphase()).m_sets) {
            btDbvt::collideKDOP(tree.m_root, normals.data(), offsets.data(), 6, mark);
        }
    }

    void listVisible(std::vector<Answer>& visible) const override {
        if (own_ == nullptr) {
            listMarked(isVisible_, visible);
            return;
        }
        own_->grid().forEach([&](ProxyId id, const Aabb<float>& /*box*/) {
            if (culler_.isVisible(id)) {
                visible.push_back(demos::FilledBroadphase::objectOf(*own_->proxyOf(id)));
            }
        });
    }

private:
    struct Mark final : btDbvt::ICollide {
        explicit Mark(std::vector<std::uint8_t>& marks) : isVisible(marks) {}
        void Process(const btDbvtNode* leaf) override {
            const auto* proxy = static_cast<const btBroadphaseProxy*>(leaf->data);
            isVisible[demos::FilledBroadphase::objectOf(*proxy)] = 1;
        }
        std::vector<std::uint8_t>& isVisible;
    };

    std::unique_ptr<demos::FilledBroadphase> filled_;
    const SpatialHashBroadphase* own_;
    Culler<float> culler_;
    std::vector<std::uint8_t> isVisible_;
};

/// A loop over the boxes, by column and by object, compiled for any x86-64 or for AVX-512.
class LoopCulling final : public CullingRunner {
public:
    LoopCulling(const CullingScene& scene, bool isWide)
        : CullingRunner(scene), isWide_(isWide), isVisible_(scene.boxes.size()) {
        for (std::vector<float>& column : columns_) {
            column.resize(scene.boxes.size());
        }
    }

    void beginFrame() override {
        const std::vector<Aabb<float>>& boxes = scene_.boxes.boxes();
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto at = static_cast<Eigen::Index>(axis);
                columns_[axis][i] = boxes[i].min()[at];
                columns_[axis + 3][i] = boxes[i].max()[at];
            }
        }
    }

    void look(const FrustumPlanes& planes) override {
        std::array<CullingPlane, 6> all{};
        for (std::size_t i = 0; i < planes.size(); ++i) {
            const auto& normal = planes[i].normal();
            all[i] = {{normal[0], normal[1], normal[2]}, planes[i].offset()};
        }
        std::array<const float*, 6> columns{};
        std::ranges::transform(columns_, columns.begin(), [](const auto& c) { return c.data(); });
        (isWide_ ? cullByWideLoop : cullByLoop)(columns.data(), isVisible_.size(), all.data(),
                                                isVisible_.data());
    }

    void listVisible(std::vector<Answer>& visible) const override {
        listMarked(isVisible_, visible);
    }

private:
    bool isWide_;
    std::array<std::vector<float>, 6> columns_;
    std::vector<std::uint8_t> isVisible_;
};

std::vector<ContestantKind> cullingKinds() {
    ContestantKind own = contestantKind("hash");
    own.title = "Culler";
    ContestantKind bullet = contestantKind(kBaseline);
    bullet.title = "btDbvt::collideKDOP";
    std::vector<ContestantKind> kinds{
        own, bullet, {.name = "loop", .title = "every box", .package = "none"}};
    if (detail::isAvailable(detail::InstructionSet::avx512)) {
        kinds.push_back({.name = "loop-avx512", .title = "every box", .package = "none"});
    }
    return kinds;
}

class CullingWorkload final : public Workload {
public:
    CullingWorkload(std::unique_ptr<demos::BoxScene> scene, const CullingPlan& plan)
        : scene_{SceneBoxes(std::move(scene)), plan} {}

    [[nodiscard]] std::unique_ptr<Runner> make(const ContestantKind& kind) override {
        if (kind.bullet != nullptr) {
            return std::make_unique<FilledCulling>(scene_, *kind.bullet);
        }
        return std::make_unique<LoopCulling>(scene_, kind.name != "loop");
    }

    void beginFrame() override {
        scene_.boxes.advance();
        const CullingPlan& plan = scene_.plan;
        const Aabb<float> all = scene_.boxes.needs().bounds;
        const auto side = static_cast<double>(all.sizes().maxCoeff());
        test::CameraLens lens;
        lens.fieldOfView = plan.fieldOfView;
        lens.farPlane = plan.farPlane * side;
        const double turned = 0.37 * frame_++;
        scene_.views.clear();
        for (int camera = 0; camera < plan.cameras; ++camera) {
            const double heading = turned + 2 * std::numbers::pi * camera / plan.cameras;
            const Vector3<double> ahead(std::cos(heading), -0.1, std::sin(heading));
            const Vector3<double> eye = all.center().cast<double>() +
                                        Vector3<double>(0, plan.height, 0) -
                                        ahead * (plan.backwards * side);
            const auto matrix = test::cameraMatrix<float>(lens, eye, eye + ahead);
            scene_.views.push_back(frustumPlanes<float>(matrix, lens.depthRange));
        }
    }

    void listExactAnswers(std::vector<Answer>& answers) override {
        answers.clear();
        for (std::size_t camera = 0; camera < scene_.views.size(); ++camera) {
            const ConvexRegion<float> view(scene_.views[camera], Containment::touching,
                                           Touch::byPlanes);
            for (std::size_t i = 0; i < objects(); ++i) {
                if (view.key(scene_.boxes.boxes()[i]) >= 0) {
                    answers.push_back(camera * objects() + i);
                }
            }
        }
    }

    [[nodiscard]] std::size_t objects() const override { return scene_.boxes.size(); }
    [[nodiscard]] std::size_t operations() const override {
        return objects() * static_cast<std::size_t>(scene_.plan.cameras);
    }

private:
    CullingScene scene_;
    int frame_ = 0;
};

Benchmark culling(const char* name, const char* description, const char* scene,
                  const CullingPlan& plan) {
    return {.name = name,
            .group = "culling",
            .description = description,
            .sizes = {50'000},
            .contestants = [](std::size_t, std::uint64_t) { return cullingKinds(); },
            .make =
                [makeScene = sceneNamed(scene), plan](std::size_t objects, std::uint64_t seed) {
                    return std::make_unique<CullingWorkload>(makeScene(objects, seed), plan);
                }};
}

}  // namespace

std::vector<Benchmark> cullingBenchmarks() {
    const CullingPlan tenthOfTerrain{0, 15, 0.9, 0.37};
    CullingPlan again = tenthOfTerrain;
    again.isSecond = true;
    CullingPlan fourTenths = tenthOfTerrain;
    fourTenths.cameras = 4;
    const CullingPlan fromFar{3, 0, 1.2, 10};
    return {
        culling("culling-tenth", "a camera among the paper's spheres that sees a tenth of them",
                "paper", tenthOfTerrain),
        culling("culling-again", "the same camera again, with its data in the processor's cache",
                "paper", again),
        culling("culling-four", "four cameras in turn, each of which sees a tenth of them", "paper",
                fourTenths),
        culling("culling-all", "a distant camera that sees all of the paper's spheres", "paper",
                fromFar),
        culling("culling-space-tenth", "a camera among uniform boxes that sees a tenth", "uniform",
                {0.02, 0, 0.9, 0.7}),
        culling("culling-space-all", "a distant camera that sees all uniform boxes", "uniform",
                fromFar)};
}

}  // namespace hashphase::benchmarks
