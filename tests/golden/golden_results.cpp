// SPDX-License-Identifier: Zlib
#include <tests/golden/golden_results.hpp>

#include <broadphase/convex_region.hpp>
#include <broadphase/neighbours.hpp>
#include <broadphase/radius_search.hpp>
#include <integration/ai/nearest.hpp>
#include <integration/culling/culler.hpp>
#include <integration/terrain/terrain.hpp>
#include <tests/golden/golden_world.hpp>

#include <iomanip>
#include <istream>
#include <ostream>

namespace hashphase::test {
namespace {

constexpr int kFrames = 12;
constexpr int kFramesBetweenQuestions = 4;
constexpr int kQuestions = 12;

/// Keeps who was found, by number, and how far along.
template <class Scalar>
struct NumberCollector {
    const GoldenWorld<Scalar>* world;
    std::vector<std::pair<std::uint32_t, Scalar>> found;

    void add(ProxyId id, Scalar key) { found.emplace_back(world->numberOf(id), key); }
    [[nodiscard]] static constexpr double limit() {
        return std::numeric_limits<double>::infinity();
    }
};

/// All that is asked of a scene, each question with a hash of its own.
template <class Scalar>
class Questions {
public:
    explicit Questions(GoldenWorld<Scalar>& world) : world_(world) {}

    void notePairs() {
        hashes_["pairs"].addAll(world_.born());
        hashes_["pairs"].addAll(world_.died());
    }

    void ask() {
        std::vector<RayRegion<Scalar>> rays;
        for (int i = 0; i < kQuestions; ++i) {
            const Aabb<Scalar>& here = drawBox();
            const Aabb<Scalar>& there = drawBox();
            const Scalar reach = here.sizes().maxCoeff();
            visit("boxes", BoxRegion<Scalar>{here.merged(there)});
            visit("spheres", SphereRegion<Scalar>(here.min(), reach));
            visit("positions", PositionRegion<Scalar>(there.max(), 3 * reach));
            visit("swept", BoxRegion<Scalar>{there}, world_.sweeps());
            rays.emplace_back(here.max(), there.min());
            rays.emplace_back(there.max(), here.max(), Aabb<Scalar>(-here.sizes(), here.sizes()));
            askNearest(here.min());
            askVolume(here, there);
        }
        askRays(rays);
        askAll();
    }

    void appendTo(std::vector<GoldenLine>& lines, const std::string& scene) const {
        for (const auto& [question, hash] : hashes_) {
            lines.push_back(hash.line(scene + "/" + question));
        }
    }

private:
    const Aabb<Scalar>& drawBox() { return world_.box(random_.below(world_.count())); }

    void take(const char* question, NumberCollector<Scalar>& collector) {
        std::sort(collector.found.begin(), collector.found.end());
        hashes_[question].addAll(collector.found);
    }

    template <class Region>
    void visit(const char* question, const Region& region, const auto& from) {
        NumberCollector<Scalar> collector{&world_, {}};
        from.visit(region, collector);
        take(question, collector);
    }
    template <class Region>
    void visit(const char* question, const Region& region) {
        visit(question, region, world_.grid());
    }

    void askRays(const std::vector<RayRegion<Scalar>>& rays) {
        std::vector<NumberCollector<Scalar>> collectors(rays.size(),
                                                        NumberCollector<Scalar>{&world_, {}});
        world_.grid().visitEach(std::span<const RayRegion<Scalar>>(rays), std::span(collectors),
                                world_.parallelFor());
        for (std::size_t i = 0; i < rays.size(); ++i) {
            take("rays", collectors[i]);
            CollectClosest<Scalar> closest;
            world_.grid().visit(rays[i], closest);
            hashes_["closest"].add(closest.key());
        }
    }

    // Of equally near ones the smallest ids are kept, which say nothing about who it is.
    void askNearest(const Vector3<Scalar>& point) {
        findNearest(world_.grid(), point, 5, std::numeric_limits<Scalar>::infinity(), nearest_);
        for (const KeyedProxy<Scalar>& proxy : nearest_) {
            hashes_["nearest"].add(proxy.key);
        }
    }

    /// Eigen's own adds up in an order that depends on the processor.
    static typename ConvexRegion<Scalar>::Plane planeThrough(const Vector3<Scalar>& point,
                                                             const Vector3<Scalar>& normal) {
        const Vector3<Scalar> terms = normal.cwiseProduct(point);
        return {normal, -(terms[0] + (terms[1] + terms[2]))};
    }

    /// A slanted pyramid from one box to the other.
    void askVolume(const Aabb<Scalar>& from, const Aabb<Scalar>& to) {
        const Vector3<Scalar> along = to.min() - from.min();
        const Vector3<Scalar> across(along[1], -along[0], along[2] / 4);
        const std::array planes{planeThrough(from.min(), along), planeThrough(to.max(), -along),
                                planeThrough(from.min(), along + 2 * across),
                                planeThrough(from.min(), along - 2 * across)};
        const ConvexRegion<Scalar> volume(planes);
        visit("volumes", volume);
        Culler<Scalar> culler;
        culler.look(world_.grid(), volume);
        hashes_["culled"].addCount(culler.count());
    }

    void askAll() {
        const Scalar distance = world_.box(0).sizes().maxCoeff();
        Neighbours<Scalar> neighbours;
        std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
        for (const ProxyPair& pair :
             neighbours.find(world_.grid(), distance, world_.parallelFor())) {
            pairs.push_back(world_.numbersOf(pair));
        }
        std::sort(pairs.begin(), pairs.end());
        hashes_["neighbours"].addAll(pairs);

        RadiusSearch<Scalar> search;
        search.take(world_.grid(), 3 * distance, acceptAll, world_.parallelFor());
        std::vector<std::uint32_t> counts(search.size());
        search.count(counts, world_.parallelFor());
        std::vector<std::pair<std::uint32_t, std::uint32_t>> countOf;
        for (std::uint32_t agent = 0; agent < search.size(); ++agent) {
            countOf.emplace_back(world_.numberOf(search.id(agent)), counts[agent]);
        }
        std::sort(countOf.begin(), countOf.end());
        hashes_["crowd"].addAll(countOf);
    }

    GoldenWorld<Scalar>& world_;
    Random random_{0x90'1d'e5};
    std::map<std::string, GoldenHash> hashes_;
    std::vector<KeyedProxy<Scalar>> nearest_;
};

/// Heights over slopes of all steepnesses, one crossing another.
template <class Scalar>
GoldenLine terrainLine(const GoldenRun& run, const std::string& name) {
    Random random(0x90'1d'e6);
    std::vector<Vector3<Scalar>> corners;
    std::vector<Vector3<Scalar>> points;
    for (int i = 0; i < 300; ++i) {
        const Vector3<double> middle = random.pointIn(-20, 20);
        for (int corner = 0; corner < 3; ++corner) {
            corners.push_back((middle + random.pointIn(-4, 4)).cast<Scalar>());
        }
        points.push_back(random.pointIn(-20, 25).cast<Scalar>());
    }
    Grid<Scalar> grid;
    Terrain<Scalar> terrain(grid);
    terrain.add(corners);
    std::vector<std::optional<Ground<Scalar>>> found(points.size());
    const std::vector<Scalar> radii(points.size(), Scalar(0.7));
    ThreadedFor threads(run.threadCount, 0x90'1d'e7);
    GoldenHash hash;
    const auto take = [&] {
        for (const auto& ground : found) {
            hash.add(ground ? ground->triangle : ~std::uint32_t{0});
            hash.add(ground ? ground->height : Scalar(0));
        }
    };
    terrain.surfacesBelow(points, found, threads);
    take();
    terrain.restingHeights(points, radii, found, threads);
    take();
    return hash.line(name);
}

template <class Scalar>
void appendLines(const GoldenRun& run, const std::string& precision,
                 std::vector<GoldenLine>& lines) {
    for (const BoxScene<Scalar>& scene : allBoxScenes<Scalar>()) {
        if (!run.denormals && (scene.name == "denormal" || scene.name == "hostile numbers")) {
            continue;
        }
        GoldenWorld<Scalar> world(scene, run);
        Questions<Scalar> questions(world);
        for (int frame = 1; frame <= kFrames; ++frame) {
            world.nextFrame();
            questions.notePairs();
            if (frame % kFramesBetweenQuestions == 0) {
                questions.ask();
            }
        }
        std::string name = precision + "/" + scene.name;
        std::replace(name.begin(), name.end(), ' ', '-');
        questions.appendTo(lines, name);
    }
    lines.push_back(terrainLine<Scalar>(run, precision + "/slopes/heights"));
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const GoldenLine& line) {
    return out << line.name << ' ' << std::dec << line.answers << ' ' << std::hex << std::setw(16)
               << std::setfill('0') << line.hash << std::dec;
}

std::istream& operator>>(std::istream& in, GoldenLine& line) {
    return in >> line.name >> std::dec >> line.answers >> std::hex >> line.hash >> std::dec;
}

std::vector<GoldenLine> goldenLines(const GoldenRun& run) {
    std::vector<GoldenLine> lines;
    appendLines<float>(run, "float", lines);
    appendLines<double>(run, "double", lines);
    return lines;
}

}  // namespace hashphase::test
