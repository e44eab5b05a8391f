// SPDX-License-Identifier: Zlib
#include <demos/accuracy/culling/culling_experiment.hpp>

#include <demos/scenes/random.hpp>

#include <Eigen/LU>

#include <numbers>

namespace hashphase::demos {
namespace {

constexpr std::string_view kCullingDeclaration =
#include <demos/accuracy/culling/culling.sql>
    ;

// --- Scenes ------------------------------------------------------------------------------------------

constexpr float kSide = 1000;      // of the ground [m]
constexpr float kEyeHeight = 120;  // [m]
constexpr float kDegree = std::numbers::pi_v<float> / 180;
constexpr int kViewsPerFlight = 8;

// In a 60th of a second, at 6 m/s and 12 degrees a second.
constexpr float kStride = 0.1F;          // [m]
constexpr float kTurn = 0.2F * kDegree;  // [rad]

/// Where the camera looks, and at what.
struct CullingSetting {
    std::string name;
    float fieldOfView = 60;  // [degrees]
    float pitch = -45;       // [degrees]
    float yaw = 20;          // [degrees]
    float tallest = 10;      // [m]
    float cellSize = 10;     // [m]
};

/// A camera that flies straight on from a random place and turns a little.
std::vector<CameraView> flight(const CullingSetting& setting, Random& random) {
    CameraPose pose;
    pose.eye = {random.between(0.3F, 0.7F) * kSide, kEyeHeight, random.between(0.3F, 0.7F) * kSide};
    pose.yaw = setting.yaw * kDegree;
    pose.pitch = setting.pitch * kDegree;
    pose.fieldOfView = setting.fieldOfView * kDegree;
    std::vector<CameraView> views;
    for (int i = 0; i < kViewsPerFlight; ++i) {
        views.push_back(cameraView(pose));
        pose.eye.x() += kStride;
        pose.yaw += kTurn;
    }
    return views;
}

/// Boxes of 1 to 3 m that stand on the ground, up to `tallest` high.
std::vector<Aabb<float>> standingBoxes(std::size_t count, float tallest, std::uint64_t seed) {
    Random random(seed);
    std::vector<Aabb<float>> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        const Vector3<float> low{random.between(0, kSide), 0, random.between(0, kSide)};
        const Vector3<float> size{random.between(1, 3), tallest * random.between(0.1F, 1),
                                  random.between(1, 3)};
        boxes.emplace_back(low, low + size);
    }
    return boxes;
}

// A random point of the left, right, bottom or top plane, between the near plane and the far one.
Vector3<double> pointOnSide(const Eigen::Matrix4d& toWorld, std::size_t plane, Random& random) {
    Eigen::Vector4d onScreen(static_cast<double>(random.between(-1, 1)),
                             static_cast<double>(random.between(-1, 1)),
                             1 - static_cast<double>(random.between(0, 0.01F)), 1);
    onScreen[static_cast<Eigen::Index>(plane / 2)] = plane % 2 == 0 ? -1 : 1;
    return (toWorld * onScreen).eval().hnormalized();
}

/// Boxes above the ground, but not above `tallest`, that stay outside of the view but for a corner,
/// which lies on one of its planes as far as single precision allows: some touch it, others do not.
std::vector<Aabb<float>> touchingBoxes(std::size_t count, float tallest, const CameraView& view,
                                       Random& random) {
    const Eigen::Matrix4d toWorld = view.viewProjection.cast<double>().inverse();
    std::vector<Aabb<float>> boxes;
    while (boxes.size() < count) {
        const auto plane = static_cast<std::size_t>(random.between(0, 4));
        const Vector3<float> corner = pointOnSide(toWorld, plane, random).cast<float>();
        const Vector3<float> size{random.between(1, 3), random.between(1, 3), random.between(1, 3)};
        // The normal points inwards, and so does the corner.
        const Vector3<float> normal = view.planes[plane].normal();
        const Vector3<float> opposite = (normal.array() > 0).select(corner - size, corner + size);
        const Aabb<float> box(corner.cwiseMin(opposite), corner.cwiseMax(opposite));
        if (box.min().y() >= 0 && box.max().y() <= tallest) {
            boxes.push_back(box);
        }
    }
    return boxes;
}

/// One factor after another around the first setting.
std::vector<CullingSetting> cullingSettings() {
    std::vector<CullingSetting> settings{{"as stated"}};
    const auto vary = [&](std::string_view what, float CullingSetting::*member,
                          std::string_view unit, std::initializer_list<float> values) {
        for (const float value : values) {
            CullingSetting setting;
            setting.name =
                std::string(what) + ' ' + valueText(static_cast<double>(value)) + std::string(unit);
            setting.*member = value;
            settings.push_back(setting);
        }
    };
    vary("field of view", &CullingSetting::fieldOfView, " deg", {30, 90, 120});
    vary("pitch", &CullingSetting::pitch, " deg", {-90, -70, -20, 0});
    vary("yaw", &CullingSetting::yaw, " deg", {0, 45});
    vary("objects up to", &CullingSetting::tallest, " m", {1, 40});
    vary("cells", &CullingSetting::cellSize, " m", {5, 25, 50, 100});
    // For the paper's camera from above.
    settings.push_back({.name = "straight down, yaw 0, 1 m", .pitch = -90, .yaw = 0, .tallest = 1});
    return settings;
}

// Whether the settings differ in nothing but the cell size.
bool isSameView(const CullingSetting& a, const CullingSetting& b) {
    return a.fieldOfView == b.fieldOfView && a.pitch == b.pitch && a.yaw == b.yaw &&
           a.tallest == b.tallest;
}

// --- Looks -------------------------------------------------------------------------------------------

/// A method at work on the scene of a setting.
struct Look {
    const CullingMethod* method;
    const CullingSetting* setting;
    Culling culling;
};

std::vector<Look> looksAt(const CullingSetting& setting, std::span<const Aabb<float>> boxes,
                          std::span<const CullingMethod> methods, bool cellsMatterOnly) {
    std::vector<Look> looks;
    for (const CullingMethod& method : methods) {
        if (method.is("takes_cells") || !cellsMatterOnly) {
            looks.push_back(
                {&method, &setting, method.make({boxes, setting.tallest, setting.cellSize})});
        }
    }
    return looks;
}

/// Has all of them look at the boxes, and counts what they get wrong.
void judge(std::span<const Look> looks, std::string_view scene, const CameraView& view,
           std::span<const Aabb<float>> boxes, Measurements& measured) {
    const ExactFrustum truth(view);
    std::vector<bool> isVisible;
    for (const Aabb<float>& box : boxes) {
        isVisible.push_back(truth.sees(box));
    }
    for (const auto& [method, setting, culling] : looks) {
        const CullingCost cost = culling.look(view);
        int visible = 0;
        int lost = 0;
        int inVain = 0;
        for (std::uint32_t object = 0; object < boxes.size(); ++object) {
            const bool isDrawn = culling.draws(object);
            visible += isVisible[object] ? 1 : 0;
            lost += isVisible[object] && !isDrawn ? 1 : 0;
            inVain += isDrawn && !isVisible[object] ? 1 : 0;
        }
        measured.add("looks", {{"scene", scene},
                               {"setting", setting->name},
                               {"cell", setting->cellSize},
                               {"method", method->name},
                               {"visible", visible},
                               {"lost", lost},
                               {"in_vain", inVain},
                               {"cells", cost.cells},
                               {"boxes", cost.boxes}});
    }
}

void time(std::span<const Look> looks, const CullingSetting& setting, int frames,
          std::uint64_t seed, Measurements& measured) {
    Random random(seed);
    std::vector<CameraView> views;
    std::vector<TimedMethod> methods;
    for (const Look& look : looks) {
        methods.push_back({{{"setting", look.setting->name}, {"method", look.method->name}},
                           [&views, &culling = look.culling] {
                               for (const CameraView& view : views) {
                                   culling.look(view);
                               }
                           }});
    }
    measureTimes(
        measured, {frames, 3, 1.0 / kViewsPerFlight}, [&](int) { views = flight(setting, random); },
        methods);
}

void judgeTouching(const CullingPlan& plan, const CullingSetting& setting, std::uint64_t seed,
                   std::span<const CullingMethod> methods, Measurements& measured) {
    Random random(seed);
    for (int i = 0; i < plan.flights; ++i) {
        for (const CameraView& view : flight(setting, random)) {
            const std::vector<Aabb<float>> boxes =
                touchingBoxes(plan.touching, setting.tallest, view, random);
            judge(looksAt(setting, boxes, methods, false), "touching", view, boxes, measured);
        }
    }
}

}  // namespace

Findings findCulling(const CullingPlan& plan, std::uint64_t seed,
                     std::span<const CullingMethod> methods, const TellProgress& tell) {
    Measurements measured;
    measured.add("plan", {{"objects", plan.objects}, {"seed", seed}});
    addMethods(methods, {"must_see_all", "must_be_exact", "takes_cells"}, measured);
    const std::vector<CullingSetting> settings = cullingSettings();
    const CullingSetting& first = settings.front();
    std::vector<std::vector<Aabb<float>>> scenes;  // methods go on reading what they have filed
    std::vector<Look> timed;
    for (const CullingSetting& setting : settings) {
        constexpr double share = 0.7;  // of all the time
        tell(share * static_cast<double>(scenes.size()) / static_cast<double>(settings.size()),
             setting.name);
        scenes.push_back(standingBoxes(plan.objects, setting.tallest, seed));
        const bool isFirstView = isSameView(setting, first);
        std::vector<Look> looks =
            looksAt(setting, scenes.back(), methods, isFirstView && &setting != &first);
        Random random(seed + 1);
        for (int i = 0; i < plan.flights; ++i) {
            for (const CameraView& view : flight(setting, random)) {
                judge(looks, "ground", view, scenes.back(), measured);
            }
        }
        if (isFirstView) {
            std::move(looks.begin(), looks.end(), std::back_inserter(timed));
        }
    }
    time(timed, first, plan.frames, seed + 2, measured);
    judgeTouching(plan, first, seed + 3, methods, measured);
    return findingsOf(kCullingDeclaration, measured);
}

Experiment cullingExperiment() {
    return {"P4",
            "Culling",
            "How many visible objects are lost, and how many objects are drawn needlessly?",
            3,
            20,
            [](const Effort& effort, const TellProgress& tell) {
                const CullingPlan plan{effort.quickOrFull<std::size_t>(20'000, 50'000), 1000,
                                       effort.quickOrFull(1, 8),
                                       effort.quickOrFull(kFewestFrames, 2 * kFewestFrames)};
                return findCulling(plan, effort.seed, cullingMethods(), tell);
            }};
}

}  // namespace hashphase::demos
