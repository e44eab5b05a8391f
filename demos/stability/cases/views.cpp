// SPDX-License-Identifier: Zlib
//
// Cameras that see strange things, and rectangles dragged strangely.

#include <demos/stability/cases/cases.hpp>

#include <demos/scenes/random.hpp>
#include <demos/stability/isolation.hpp>
#include <demos/stability/pair_scene.hpp>
#include <integration/bullet/conversions.hpp>
#include <integration/camera/frustum.hpp>
#include <integration/culling/culler.hpp>
#include <integration/picking/drag_selection.hpp>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace hashphase::demos {
namespace {

using Point = Vector3<float>;
using Planes = std::array<Eigen::Hyperplane<float, 3>, 6>;

constexpr float kNear = 0.5F;  // [m]
constexpr DepthRange kDepths = DepthRange::zeroToOne;

// A camera at `eye` that looks along -z, turned up by `pitch` [rad]; `far` may be infinite.
Eigen::Matrix4f camera(const Point& eye, float pitch, float far) {
    Eigen::Matrix4f projection = Eigen::Matrix4f::Zero();
    projection(0, 0) = 1;
    projection(1, 1) = 1;
    projection(2, 2) = std::isinf(far) ? -1 : far / (kNear - far);
    projection(2, 3) = std::isinf(far) ? -kNear : kNear * far / (kNear - far);
    projection(3, 2) = -1;
    Eigen::Affine3f view = Eigen::Affine3f::Identity();
    view.rotate(Eigen::AngleAxisf(-pitch, Point::UnitX()));
    view.translate(-eye);
    return projection * view.matrix();
}

// Points that are seen in a rectangle of the screen: where they are is as exact as double makes it.
std::vector<Vector3<double>> pointsSeen(const Eigen::Matrix4f& viewProjection,
                                        const ScreenRectangle<float>& rectangle, Random& random) {
    const Eigen::Matrix4d inverse = viewProjection.cast<double>().inverse();
    std::vector<Vector3<double>> points;
    for (int i = 0; i < 400; ++i) {
        const auto within = [&](int axis) {
            return static_cast<double>(
                random.between(rectangle.min()[axis], rectangle.max()[axis]));
        };
        const double depth = 1 - std::pow(10.0, -4 * static_cast<double>(random.unit()));
        const Eigen::Vector4d seen = inverse * Eigen::Vector4d(within(0), within(1), depth, 1);
        points.emplace_back(seen.hnormalized());
    }
    return points;
}

// The boxes in which one of the points lies, by more than rounding may move it.
Objects boxesAround(const std::vector<Vector3<double>>& points, const Boxes& boxes) {
    const LimitPause pause;
    constexpr double kInside = 1e-3;  // [m]
    Objects around;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        const Vector3<double> low = boxes[i].min().cast<double>().array() + kInside;
        const Vector3<double> high = boxes[i].max().cast<double>().array() - kInside;
        const auto isInside = [&](const Vector3<double>& point) {
            return low[0] <= point[0] && point[0] <= high[0] && low[1] <= point[1] &&
                   point[1] <= high[1] && low[2] <= point[2] && point[2] <= high[2];
        };
        if (std::any_of(points.begin(), points.end(), isInside)) {
            around.push_back(i);
        }
    }
    return around;
}

// Who must be found, and is: what else is found may be seen as well.
void judgeSeen(CaseTally& tally, const Objects& found, const Objects& seen) {
    Objects both;
    std::set_intersection(found.begin(), found.end(), seen.begin(), seen.end(),
                          std::back_inserter(both));
    tally.compare(both, seen);
}

// What our culler or Bullet's trees find between the planes.
class Viewer {
public:
    explicit Viewer(PairScene& scene)
        : hash_(scene.hash()), dbvt_(dynamic_cast<btDbvtBroadphase*>(&scene.broadphase())) {}

    [[nodiscard]] bool canSee() const noexcept { return hash_ != nullptr || dbvt_ != nullptr; }

    [[nodiscard]] Objects look(const Planes& planes) const {
        Objects found;
        if (hash_ != nullptr) {
            Culler<float> culler;
            culler.look(hash_->grid(), ConvexRegion<float>(planes));
            culler.forEach([&](std::uint32_t index) { found.push_back(index); });
            return found;
        }
        std::array<btVector3, 6> normals;
        std::array<btScalar, 6> offsets;
        for (std::size_t i = 0; i < planes.size(); ++i) {
            normals[i] = toBullet(planes[i].normal());
            offsets[i] = planes[i].offset();
        }
        Note note(found);
        for (const btDbvt& tree : dbvt_->m_sets) {
            btDbvt::collideKDOP(tree.m_root, normals.data(), offsets.data(), 6, note);
        }
        std::sort(found.begin(), found.end());
        return found;
    }

private:
    struct Note final : btDbvt::ICollide {
        explicit Note(Objects& list) : found(list) {}
        void Process(const btDbvtNode* leaf) override {
            found.push_back(
                FilledBroadphase::objectOf(*static_cast<const btBroadphaseProxy*>(leaf->data)));
        }
        Objects& found;
    };

    const SpatialHashBroadphase* hash_;
    btDbvtBroadphase* dbvt_;
};

Boxes town(std::uint64_t seed) {
    Boxes boxes = scatteredCubes(1500, 120, 0.5F, 6, seed);
    boxes.push_back(cubeAt({0, 2, 0}, 3));         // around the camera
    boxes.push_back(cubeAt({0, 0, 0}, 2e4F));      // around all that it sees
    boxes.push_back(cubeAt({0, 40, -3000}, 100));  // far away
    return boxes;
}

CaseOutcome strangeViews(const CaseContext& context) {
    CaseTally tally;
    PairScene scene(context, town(context.seed));
    const Viewer viewer(scene);
    if (!viewer.canSee()) {
        return {};
    }
    scene.findPairs();
    Random random(context.seed);
    using Corner = ScreenRectangle<float>::VectorType;
    const ScreenRectangle<float> line(Corner(0, -1), Corner(0, 1));
    const ScreenRectangle<float> dot(Corner(0.25F, 0.25F), Corner(0.25F, 0.25F));
    for (const float far : {10.0F, 400.0F, std::numeric_limits<float>::infinity()}) {
        for (const float pitch : {0.0F, -0.6F, 0.5F}) {
            const Eigen::Matrix4f matrix = camera({0, 2, 0}, pitch, far);
            for (const ScreenRectangle<float>& part : {wholeScreen<float>(), line, dot}) {
                const Objects seen = boxesAround(pointsSeen(matrix, part, random), scene.boxes());
                judgeSeen(tally, viewer.look(frustumPlanes(matrix, kDepths, part)), seen);
            }
        }
    }
    // All planes the wrong way round: there is no point behind all of them.
    Planes inverted = frustumPlanes(camera({0, 2, 0}, 0, 400), kDepths);
    for (Eigen::Hyperplane<float, 3>& plane : inverted) {
        plane.coeffs() = -plane.coeffs();
    }
    const Objects found = viewer.look(inverted);
    tally.compare(found, Objects{});
    return tally.outcome();
}

// --- Dragged rectangles ---------------------------------------------------------------------------

CaseOutcome strangeRectangles(const CaseContext& context) {
    CaseTally tally;
    PairScene scene(context, town(context.seed));
    const SpatialHashBroadphase* hash = scene.hash();
    if (hash == nullptr) {
        return {};
    }
    scene.findPairs();
    Random random(context.seed);
    const auto chosen = [&](const Camera<float>& view, const Pixel& a, const Pixel& b) {
        std::vector<ProxyId> selected;
        Objects objects;
        select(hash->grid(), view, a, b, selected);
        for (const ProxyId id : selected) {
            objects.push_back(id.index);
        }
        std::sort(objects.begin(), objects.end());
        return objects;
    };
    // Level, down, and up over the horizon.
    for (const float pitch : {0.0F, -0.5F, 0.6F}) {
        const Eigen::Matrix4f matrix = camera({0, 2, 0}, pitch, 5000);
        const Camera<float> view(matrix, kDepths, {0, 0, 800, 600});
        const auto judge = [&](const Pixel& a, const Pixel& b) {
            const Objects seen =
                boxesAround(pointsSeen(matrix, view.rectangleBetween(a, b), random), scene.boxes());
            const Objects found = chosen(view, a, b);
            judgeSeen(tally, found, seen);
            tally.compare(chosen(view, b, a), found);
            tally.compare(chosen(view, {a.x(), b.y()}, {b.x(), a.y()}), found);
        };
        judge({100, 50}, {700, 550});
        judge({400, 300}, {400, 300});    // without area
        judge({10, 300}, {790, 300});     // a line
        judge({-500, -500}, {300, 200});  // partly beside the window
        judge({-1e9, -1e9}, {1e9, 1e9});
        tally.compare(chosen(view, {-300, 10}, {-10, 500}), Objects{});
        constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
        tally.compare(chosen(view, {kNan, 10}, {100, 100}), Objects{});
        tally.expect(!selectionError(view, {kNan, 10}, {100, 100}).empty() &&
                         !selectionError(view, {-300, 10}, {-10, 500}).empty(),
                     "what selects nothing says why");
    }
    return tally.outcome();
}

constexpr std::array kViewCases{
    HardCase{
        "H41", "strange cameras",
        "1,503 boxes, one around the camera, one around all that it sees, one 3 km away; far "
        "planes at 10 m, 400 m and infinity; a line and a dot of the screen; all planes inverted",
        "never without what is seen (where one of 400 points that are seen lies inside of a "
        "box); nothing behind inverted planes",
        strangeViews},
    HardCase{
        "H42", "strange rectangles",
        "rectangles dragged from any corner, without area, as a line, partly and wholly beside "
        "the window, of 2e9 pixels, over the horizon, with NaN; 1,503 boxes",
        "what is seen there, whichever way it was dragged; nothing beside the window, with a "
        "reason",
        strangeRectangles},
};

}  // namespace

std::span<const HardCase> viewCases() {
    return kViewCases;
}

}  // namespace hashphase::demos
