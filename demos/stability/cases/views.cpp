// SPDX-License-Identifier: Zlib
//
// Cameras that see strange things, and rectangles dragged strangely.

#include <demos/stability/cases/cases.hpp>

#include <integration/camera/frustum.hpp>
#include <integration/culling/culler.hpp>
#include <integration/picking/drag_selection.hpp>

#include <Eigen/LU>

#include <array>
#include <iterator>

namespace hashphase::demos {
namespace {

template <class Scalar>
using Matrix4 = Eigen::Matrix<Scalar, 4, 4>;
template <class Scalar>
using Planes = std::array<Plane<Scalar>, 6>;

constexpr DepthRange kDepths = DepthRange::zeroToOne;

// A camera at `eye` that looks along -z, turned up by `pitch` [rad]; `far` may be infinite.
template <class Scalar>
Matrix4<Scalar> cameraAt(const Vector3<Scalar>& eye, float pitch, Scalar far) {
    constexpr Scalar kNear = 0.5F;  // [m]
    Matrix4<Scalar> projection = Matrix4<Scalar>::Zero();
    projection(0, 0) = 1;
    projection(1, 1) = 1;
    projection(2, 2) = std::isinf(far) ? -1 : far / (kNear - far);
    projection(2, 3) = std::isinf(far) ? -kNear : kNear * far / (kNear - far);
    projection(3, 2) = -1;
    Eigen::Transform<Scalar, 3, Eigen::Affine> view =
        Eigen::Transform<Scalar, 3, Eigen::Affine>::Identity();
    view.rotate(Eigen::AngleAxis<Scalar>(-Scalar(pitch), Vector3<Scalar>::UnitX()));
    view.translate(-eye);
    return projection * view.matrix();
}

// Points that are seen in a rectangle of the screen: where they are is as exact as double makes it.
template <class Scalar>
std::vector<Vector3<double>> pointsSeen(const Matrix4<Scalar>& viewProjection,
                                        const ScreenRectangle<Scalar>& rectangle, Random& random) {
    const Eigen::Matrix4d inverse = viewProjection.template cast<double>().inverse();
    std::vector<Vector3<double>> points;
    for (int i = 0; i < 400; ++i) {
        const auto within = [&](int axis) {
            return static_cast<double>(
                between<Scalar>(random, rectangle.min()[axis], rectangle.max()[axis]));
        };
        const double depth = 1 - std::pow(10.0, -4 * static_cast<double>(random.unit()));
        const Eigen::Vector4d seen = inverse * Eigen::Vector4d(within(0), within(1), depth, 1);
        points.emplace_back(seen.hnormalized());
    }
    return points;
}

// The boxes in which one of the points lies, by more than rounding may move it.
template <class Scalar>
Objects boxesAround(const std::vector<Vector3<double>>& points, const Boxes<Scalar>& boxes) {
    const LimitPause pause;
    constexpr double kInside = 1e-3;  // [m]
    return objectsThat(boxes, [&](const Aabb<Scalar>& box) {
        const Vector3<double> low = box.min().template cast<double>().array() + kInside;
        const Vector3<double> high = box.max().template cast<double>().array() - kInside;
        return std::any_of(points.begin(), points.end(), [&](const Vector3<double>& point) {
            return doTouch<double>({point, point}, {low, high});
        });
    });
}

// Who must be found, and is: what else is found may be seen as well.
template <class Scalar>
void judgeSeen(CaseRun<Scalar>& run, const Objects& found, const Objects& seen) {
    Objects both;
    std::set_intersection(found.begin(), found.end(), seen.begin(), seen.end(),
                          std::back_inserter(both));
    run.compare(both, seen);
}

// What our culler finds between the planes, or Bullet's trees; nothing where there are neither.
template <class Scalar>
std::optional<Objects> look(const PairScene<Scalar>& scene, const Planes<Scalar>& planes) {
    if (scene.grid() == nullptr) {
        return scene.subject().behindAll(planes);
    }
    Objects found;
    Culler<Scalar> culler;
    culler.look(*scene.grid(), ConvexRegion<Scalar>(planes));
    culler.forEach([&](std::uint32_t index) { found.push_back(index); });
    return found;
}

template <class Scalar>
Boxes<Scalar> town(std::uint64_t seed) {
    Boxes<Scalar> boxes = scatteredCubes<Scalar>(1500, 120, 0.5F, 6, seed);
    boxes.push_back(cubeAt<Scalar>({0, 2, 0}, 3));         // around the camera
    boxes.push_back(cubeAt<Scalar>({0, 0, 0}, 2e4F));      // around all that it sees
    boxes.push_back(cubeAt<Scalar>({0, 40, -3000}, 100));  // far away
    return boxes;
}

constexpr auto strangeViews = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    PairScene<Scalar> scene(run, town<Scalar>(run.seed));
    Random random(run.seed);
    using Corner = typename ScreenRectangle<Scalar>::VectorType;
    const ScreenRectangle<Scalar> line(Corner(0, -1), Corner(0, 1));
    const ScreenRectangle<Scalar> dot(Corner(0.25F, 0.25F), Corner(0.25F, 0.25F));
    // All planes the wrong way round: there is no point behind all of them.
    Planes<Scalar> inverted =
        frustumPlanes(cameraAt<Scalar>({0, 2, 0}, 0, 400), kDepths, wholeScreen<Scalar>());
    for (Plane<Scalar>& plane : inverted) {
        plane.coeffs() = -plane.coeffs();
    }
    scene.findPairs();
    if (!look(scene, inverted)) {
        return;
    }
    for (const Scalar far : {Scalar(10), Scalar(400), kInfinity<Scalar>}) {
        for (const float pitch : {0.0F, -0.6F, 0.5F}) {
            const Matrix4<Scalar> matrix = cameraAt<Scalar>({0, 2, 0}, pitch, far);
            for (const ScreenRectangle<Scalar>& part : {wholeScreen<Scalar>(), line, dot}) {
                const Objects seen = boxesAround(pointsSeen(matrix, part, random), scene.boxes());
                judgeSeen(run, *look(scene, frustumPlanes(matrix, kDepths, part)), seen);
            }
        }
    }
    run.compare(*look(scene, inverted), Objects{});
    if (run.isOurs) {
        run.expect(ConvexRegion<Scalar>(inverted).isEmpty(),
                   "a region with inverted planes is empty");
    }
};

// --- Dragged rectangles ---------------------------------------------------------------------------

constexpr auto strangeRectangles = [](auto& run) {
    using Scalar = ScalarOf<decltype(run)>;
    PairScene<Scalar> scene(run, town<Scalar>(run.seed));
    if (scene.grid() == nullptr) {
        return;
    }
    scene.findPairs();
    Random random(run.seed);
    const auto chosen = [&](const Camera<Scalar>& view, const Pixel& a, const Pixel& b) {
        std::vector<ProxyId> selected;
        Objects objects;
        select(*scene.grid(), view, a, b, selected);
        for (const ProxyId id : selected) {
            objects.push_back(id.index);
        }
        std::sort(objects.begin(), objects.end());
        return objects;
    };
    // Level, down, and up over the horizon.
    for (const float pitch : {0.0F, -0.5F, 0.6F}) {
        const Matrix4<Scalar> matrix = cameraAt<Scalar>({0, 2, 0}, pitch, 5000);
        const Camera<Scalar> view(matrix, kDepths, {0, 0, 800, 600});
        const auto judge = [&](const Pixel& a, const Pixel& b) {
            const Objects seen =
                boxesAround(pointsSeen(matrix, view.rectangleBetween(a, b), random), scene.boxes());
            const Objects found = chosen(view, a, b);
            judgeSeen(run, found, seen);
            run.compare(chosen(view, b, a), found);
            run.compare(chosen(view, {a.x(), b.y()}, {b.x(), a.y()}), found);
        };
        judge({100, 50}, {700, 550});
        judge({400, 300}, {400, 300});    // without area
        judge({10, 300}, {790, 300});     // a line
        judge({-500, -500}, {300, 200});  // partly beside the window
        judge({-1e9, -1e9}, {1e9, 1e9});
        const Pixel bad(kNan<double>, 10);
        run.compare(chosen(view, {-300, 10}, {-10, 500}), Objects{});
        run.compare(chosen(view, bad, {100, 100}), Objects{});
        run.expect(!selectionError(view, bad, {100, 100}).empty() &&
                       !selectionError(view, {-300, 10}, {-10, 500}).empty(),
                   "selectionError() gives a reason if nothing can be selected");
    }
};

constexpr HardCase kViewCases[] = {
    {"H41", "unusual cameras",
     "1,503 boxes: one around the camera, one around everything that it sees, one 3 km away; far "
     "planes at 10 m, 400 m and infinity; a view of the whole screen, of a line and of a point on "
     "it; all planes inverted",
     "no visible box is missing (a box is visible if one of 400 visible points lies in it); "
     "inverted planes find nothing",
     strangeViews},
    {"H42", "unusual selection rectangles",
     "1,503 boxes; rectangles that are dragged from any corner, without area, as a line, partly or "
     "fully outside the window, 2e9 pixels wide, above the horizon, or with NaN",
     "the visible boxes in the rectangle, from whichever corner it is dragged; nothing, and a "
     "reason, outside the window or with NaN",
     strangeRectangles},
};

}  // namespace

std::span<const HardCase> viewCases() {
    return kViewCases;
}

}  // namespace hashphase::demos
