// SPDX-License-Identifier: Zlib
#include <demos/scenes/scatter.hpp>

#include <demos/console/format.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace hashphase::demos {
namespace {

constexpr std::size_t kPerCluster = 1000;
constexpr float kClusterDistance = 20;  // between clusters, by the edge of one

Vector3<float> drawEdges(const ScatterPlan& plan, Random& random) {
    switch (plan.sizes) {
        case SizeLaw::equal:
            return Vector3<float>::Ones();
        case SizeLaw::near:
            return {random.between(0.5F, 1.5F), random.between(0.5F, 1.5F),
                    random.between(0.5F, 1.5F)};
        case SizeLaw::logUniform:
            return Vector3<float>::Constant(std::pow(plan.sizeRatio, random.unit()));
        case SizeLaw::fewLarge:
            return Vector3<float>::Constant(random.unit() < 0.01F ? plan.sizeRatio : 1);
    }
    return Vector3<float>::Ones();
}

// Two boxes overlap when their centres lie within (a + b) / 2 on each axis: the mean volume, or on a
// plain the mean area, in which that is so.
double meanReach(const std::vector<Vector3<float>>& edges, bool flat, Random& random) {
    constexpr int kSamples = 100'000;
    const auto draw = [&edges, &random] {
        const float place = random.unit() * static_cast<float>(edges.size());
        return edges[std::min(static_cast<std::size_t>(place), edges.size() - 1)];
    };
    double sum = 0;
    for (int sample = 0; sample < kSamples; ++sample) {
        const Vector3<double> reach = (draw() + draw()).cast<double>();
        sum += reach.x() * reach.z() * (flat ? 1 : reach.y());
    }
    return sum / kSamples;
}

// Where the centres of one cluster, or of all boxes, may lie.
Vector3<float> roomEdges(const ScatterPlan& plan, std::size_t objects, double reach) {
    const double measure = static_cast<double>(objects) * reach / plan.overlapsPerBox;
    const bool flat = plan.placement == Placement::plain;
    const auto side = static_cast<float>(flat ? std::sqrt(measure) : std::cbrt(measure));
    return {side, flat ? 0 : side, side};
}

Vector3<float> pointIn(Random& random, const Aabb<float>& room) {
    const Vector3<float> share(random.unit(), random.unit(), random.unit());
    return room.min() + share.cwiseProduct(room.sizes());
}

}  // namespace

BrownianBoxes scatter(const ScatterPlan& plan, std::size_t objects, std::uint64_t seed) {
    Random random(seed);
    std::vector<Vector3<float>> edges(objects);
    float meanEdge = 0;
    for (Vector3<float>& edge : edges) {
        edge = drawEdges(plan, random);
        meanEdge += edge.mean() / static_cast<float>(objects);
    }
    const bool clustered = plan.placement == Placement::clusters;
    const std::size_t perRoom = clustered ? std::min(kPerCluster, objects) : objects;
    const Vector3<float> room =
        roomEdges(plan, perRoom, meanReach(edges, plan.placement == Placement::plain, random));
    const float clusters = std::ceil(static_cast<float>(objects) / static_cast<float>(perRoom));
    const Aabb<float> domain(Vector3<float>::Zero(),
                             room * (kClusterDistance * std::cbrt(clusters)));

    BrownianBoxes boxes;
    boxes.bodies.reserve(objects);
    Aabb<float> place(Vector3<float>::Zero(), room);
    for (std::size_t i = 0; i < objects; ++i) {
        if (clustered && i % perRoom == 0) {
            const Vector3<float> corner = pointIn(random, domain);
            place = {corner, corner + room};
        }
        const Vector3<float> centre = pointIn(random, place);
        const bool moves = random.unit() < plan.movingShare;
        boxes.bodies.push_back({centre, 0.5F * edges[i], moves ? plan.step * meanEdge : 0, place});
    }
    return boxes;
}

double meanEdge(const BrownianBoxes& boxes) {
    double sum = 0;
    for (const BrownianBoxes::Body& body : boxes.bodies) {
        sum += 2 * static_cast<double>(body.halfEdges.mean());
    }
    return sum / static_cast<double>(boxes.bodies.size());
}

RandomScene drawScene(std::uint64_t seed) {
    Random random(seed);
    const auto upTo = [&random](float low, float high) {  // log-uniform
        return low * std::pow(high / low, random.unit());
    };
    RandomScene scene;
    scene.objects = static_cast<std::size_t>(upTo(300, 50'000));
    scene.plan.sizes = static_cast<SizeLaw>(static_cast<int>(4 * random.unit()));
    scene.plan.sizeRatio = upTo(10, 1000);
    scene.plan.placement = static_cast<Placement>(static_cast<int>(3 * random.unit()));
    scene.plan.overlapsPerBox = upTo(0.1F, 10);
    // All, or any share.
    scene.plan.movingShare = std::min(1.0F, 1.5F * random.unit());
    scene.plan.step = upTo(0.01F, 1);
    return scene;
}

std::string describe(const ScatterPlan& plan) {
    constexpr std::array kSizes{"equal cubes", "edges 0.5-1.5", "log-uniform cubes",
                                "cubes, one in 100 large"};
    constexpr std::array kPlacements{"in a cube", "on a plain", "in clusters"};
    std::string text = kSizes[static_cast<std::size_t>(plan.sizes)];
    if (plan.sizes == SizeLaw::logUniform || plan.sizes == SizeLaw::fewLarge) {
        text += " 1:" + fixed(static_cast<double>(plan.sizeRatio), 0);
    }
    text += std::string(", ") + kPlacements[static_cast<std::size_t>(plan.placement)];
    text += ", " + fixed(static_cast<double>(plan.overlapsPerBox), 1) + " overlaps a box, ";
    text += fixed(100.0 * static_cast<double>(plan.movingShare), 0) + " % moving by " +
            fixed(static_cast<double>(plan.step), 2) + " edges";
    return text;
}

}  // namespace hashphase::demos
