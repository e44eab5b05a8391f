// SPDX-License-Identifier: Zlib
#include <tests/benchmarks/culling_workload.hpp>

#include <demos/report/frame_clock.hpp>
#include <integration/bullet/conversions.hpp>
#include <integration/camera/frustum.hpp>
#include <integration/culling/culler.hpp>
#include <tests/support/cameras.hpp>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hashphase::benchmarks {
namespace {

/// What Bullet's broadphases have in common: they are filled, and marks are made by object.
class Filled : public CullingContestant {
public:
    Filled(const demos::BroadphaseKind& kind, const SceneBoxes& scene)
        : filled_(kind, scene.needs()) {
        const FrameBoxes frame = scene.frame();
        for (std::size_t i = 0; i < scene.size(); ++i) {
            filled_.create(static_cast<std::uint32_t>(i), frame.bulletBoxes[i], frame.filterOf(i));
        }
        filled_.findPairs();
    }

    void setAll(const FrameBoxes& frame) override {
        filled_.setAll(frame.bulletBoxes);
        filled_.findPairs();
    }

protected:
    template <class Broadphase>
    [[nodiscard]] Broadphase& broadphase() const {
        return dynamic_cast<Broadphase&>(filled_.broadphase());
    }

private:
    demos::FilledBroadphase filled_;
};

/// Bits by the proxies' own indices.
class Ours final : public Filled {
public:
    using Filled::Filled;

    void look(const FrustumPlanes& planes) override {
        const ConvexRegion<float> view(planes, Containment::touching, Touch::byPlanes);
        culler_.look(broadphase<SpatialHashBroadphase>().grid(), view);
    }

    void listVisible(std::vector<Answer>& visible) const override {
        const auto& own = broadphase<SpatialHashBroadphase>();
        own.grid().forEach([&](ProxyId id, const Aabb<float>& /*box*/) {
            if (culler_.isVisible(id)) {
                visible.push_back(demos::FilledBroadphase::objectOf(*own.proxyOf(id)));
            }
        });
    }

private:
    Culler<float> culler_;
};

/// Bullet's own walk of its trees for planes.
class Dbvt final : public Filled {
public:
    Dbvt(const demos::BroadphaseKind& kind, const SceneBoxes& scene)
        : Filled(kind, scene), isVisible_(scene.size()) {}

    void look(const FrustumPlanes& planes) override {
        std::fill(isVisible_.begin(), isVisible_.end(), std::uint8_t{0});
        std::array<btVector3, 6> normals;
        std::array<btScalar, 6> offsets;
        for (std::size_t i = 0; i < planes.size(); ++i) {
            normals[i] = toBullet(planes[i].normal());
            offsets[i] = planes[i].offset();
        }
        Mark mark(isVisible_);
        for (const btDbvt& tree : broadphase<btDbvtBroadphase>().m_sets) {
            btDbvt::collideKDOP(tree.m_root, normals.data(), offsets.data(), 6, mark);
        }
    }

    void listVisible(std::vector<Answer>& visible) const override {
        for (std::size_t i = 0; i < isVisible_.size(); ++i) {
            if (isVisible_[i] != 0) {
                visible.push_back(i);
            }
        }
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

    std::vector<std::uint8_t> isVisible_;
};

using Columns = std::array<std::vector<float>, 6>;

// Every box against every plane, a thousand boxes at a time so that they stay in the cache; compilers
// make vector instructions of it.
[[gnu::always_inline]] inline void testEveryBox(const Columns& columns, const FrustumPlanes& planes,
                                                std::vector<std::uint8_t>& isVisible) {
    constexpr std::size_t atOnce = 1024;
    std::uint8_t* __restrict marks = isVisible.data();
    for (std::size_t begin = 0; begin < isVisible.size(); begin += atOnce) {
        const std::size_t end = std::min(begin + atOnce, isVisible.size());
        std::fill(marks + begin, marks + end, std::uint8_t{1});
        for (const auto& plane : planes) {
            const Vector3<float> normal = plane.normal();
            const float offset = plane.offset();
            const auto corner = [&](int axis) {
                const int column = axis + (normal[axis] > 0 ? 3 : 0);
                return columns[static_cast<std::size_t>(column)].data();
            };
            const float* __restrict x = corner(0);
            const float* __restrict y = corner(1);
            const float* __restrict z = corner(2);
            for (std::size_t i = begin; i < end; ++i) {
                const float sum = normal[0] * x[i] + normal[1] * y[i] + normal[2] * z[i] + offset;
                marks[i] &= static_cast<std::uint8_t>(sum >= 0);
            }
        }
    }
}

[[gnu::noinline]] void testEveryBoxPlainly(const Columns& columns, const FrustumPlanes& planes,
                                           std::vector<std::uint8_t>& isVisible) {
    testEveryBox(columns, planes, isVisible);
}

#if defined(__x86_64__)
[[gnu::noinline, gnu::target("avx512f,avx512vl,avx512bw,avx512dq,prefer-vector-width=512")]] void
testEveryBoxWide(const Columns& columns, const FrustumPlanes& planes,
                 std::vector<std::uint8_t>& isVisible) {
    testEveryBox(columns, planes, isVisible);
}

bool hasWideInstructions() {
    return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512vl") != 0 &&
           __builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512dq") != 0;
}
#else
constexpr auto testEveryBoxWide = testEveryBoxPlainly;
bool hasWideInstructions() {
    return false;
}
#endif

/// A loop over the boxes, by column and by object.
class Loop final : public CullingContestant {
public:
    Loop(std::size_t objects, bool isWide) : isWide_(isWide), isVisible_(objects) {
        for (std::vector<float>& column : columns_) {
            column.resize(objects);
        }
    }

    void setAll(const FrameBoxes& frame) override {
        for (std::size_t i = 0; i < frame.boxes.size(); ++i) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto at = static_cast<Eigen::Index>(axis);
                columns_[axis][i] = frame.boxes[i].min()[at];
                columns_[axis + 3][i] = frame.boxes[i].max()[at];
            }
        }
    }

    void look(const FrustumPlanes& planes) override {
        (isWide_ ? testEveryBoxWide : testEveryBoxPlainly)(columns_, planes, isVisible_);
    }

    void listVisible(std::vector<Answer>& visible) const override {
        for (std::size_t i = 0; i < isVisible_.size(); ++i) {
            if (isVisible_[i] != 0) {
                visible.push_back(i);
            }
        }
    }

private:
    bool isWide_;
    Columns columns_;
    std::vector<std::uint8_t> isVisible_;
};

}  // namespace

std::vector<ContestantKind> cullingKinds() {
    ContestantKind own = contestantKind("hash");
    own.title = "Culler";
    own.description = "the visible set of the broadphase's own grid, as bits";
    ContestantKind bullet = contestantKind(kBaseline);
    bullet.title = "btDbvt::collideKDOP";
    bullet.description = "Bullet's walk of its two trees of fattened boxes";
    ContestantKind loop;
    loop.name = "loop";
    loop.title = "every box";
    loop.description = "a loop over all boxes, compiled for any x86-64";
    loop.package = "none";
    std::vector<ContestantKind> kinds{own, bullet, loop};
    if (hasWideInstructions()) {
        loop.name = "loop-avx512";
        loop.description = "the same, compiled for AVX-512";
        kinds.push_back(loop);
    }
    return kinds;
}

void CullingWorkload::add(const ContestantKind& kind) {
    if (kind.name == kBaseline) {
        contestants_.push_back(std::make_unique<Dbvt>(*kind.bullet, scene_));
    } else if (kind.bullet != nullptr) {
        contestants_.push_back(std::make_unique<Ours>(*kind.bullet, scene_));
    } else {
        contestants_.push_back(std::make_unique<Loop>(scene_.size(), kind.name != "loop"));
    }
}

void CullingWorkload::beginFrame() {
    scene_.advance();
    for (const auto& contestant : contestants_) {
        contestant->setAll(scene_.frame());
    }
    const Aabb<float> all = scene_.needs().bounds;
    const auto side = static_cast<double>(all.sizes().maxCoeff());
    test::CameraLens lens;
    lens.fieldOfView = plan_.fieldOfView;
    lens.farPlane = plan_.farPlane * side;
    const double turned = 0.37 * frame_++;
    views_.clear();
    for (int camera = 0; camera < plan_.cameras; ++camera) {
        const double heading = turned + 2 * std::numbers::pi * camera / plan_.cameras;
        const Vector3<double> ahead(std::cos(heading), -0.1, std::sin(heading));
        const Vector3<double> eye = all.center().cast<double>() +
                                    Vector3<double>(0, plan_.height, 0) -
                                    ahead * (plan_.backwards * side);
        const auto matrix = test::cameraMatrix<float>(lens, eye, eye + ahead);
        views_.push_back(frustumPlanes<float>(matrix, lens.depthRange));
    }
}

double CullingWorkload::runFrame(std::size_t contestant) {
    const auto look = [&] {
        for (const FrustumPlanes& view : views_) {
            contestants_[contestant]->look(view);
        }
    };
    if (plan_.isSecond) {
        look();
    }
    const demos::FrameClock watch;
    look();
    return watch.milliseconds();
}

// Of the last camera, what the frame left; the others look again.
void CullingWorkload::listAnswers(std::size_t contestant, std::vector<Answer>& answers) {
    answers.clear();
    for (std::size_t camera = views_.size(); camera-- > 0;) {
        if (camera + 1 < views_.size()) {
            contestants_[contestant]->look(views_[camera]);
        }
        const std::size_t first = answers.size();
        contestants_[contestant]->listVisible(answers);
        for (std::size_t i = first; i < answers.size(); ++i) {
            answers[i] += camera * scene_.size();
        }
    }
}

void CullingWorkload::listExactAnswers(std::vector<Answer>& answers) {
    answers.clear();
    for (std::size_t camera = 0; camera < views_.size(); ++camera) {
        const ConvexRegion<float> view(views_[camera], Containment::touching, Touch::byPlanes);
        for (std::size_t i = 0; i < scene_.size(); ++i) {
            if (view.key(scene_.boxes()[i]) >= 0) {
                answers.push_back(camera * scene_.size() + i);
            }
        }
    }
}

}  // namespace hashphase::benchmarks
