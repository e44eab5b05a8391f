// SPDX-License-Identifier: Zlib

// nanoflann's kd-tree, made anew in each frame, and a query for each agent.

#include <tests/benchmarks/peers/peers.hpp>

#include <nanoflann.hpp>

#include <cmath>
#include <limits>
#include <utility>

namespace hashphase::benchmarks {
namespace {

// nanoflann's concept of a data set.
struct Points {
    [[nodiscard]] std::size_t kdtree_get_point_count() const { return positions.size(); }
    [[nodiscard]] float kdtree_get_pt(std::size_t point, std::size_t axis) const {
        return positions[point][static_cast<int>(axis)];
    }
    template <class Bounds>
    bool kdtree_get_bbox(Bounds& /*bounds*/) const {
        return false;
    }

    std::vector<Vector3<float>> positions;
};

class NanoflannCrowd final : public CrowdRunner {
public:
    using CrowdRunner::CrowdRunner;

    void run() override {
        build();
        for (std::size_t agent = 0; agent < points_.positions.size(); ++agent) {
            counts_[agent] = static_cast<std::uint32_t>(search(agent) - 1);
        }
    }

    bool setAnswers(std::vector<AgentAnswer>& answers) override {
        for (std::size_t agent = 0; agent < points_.positions.size(); ++agent) {
            search(agent);
            for (const auto& [object, squared] : found_) {
                if (object != agent) {
                    answers[agent].add(object);
                }
            }
            // What was timed counts.
            answers[agent].sum += answers[agent].count == counts_[agent] ? 0 : 1;
        }
        return true;
    }

private:
    using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>,
                                                     Points, 3, std::uint32_t>;

    void build() {
        points_.positions.resize(crowd_.scene.size());
        counts_.resize(crowd_.scene.size());
        for (std::size_t i = 0; i < points_.positions.size(); ++i) {
            points_.positions[i] = crowd_.centreOf(i);
        }
        // Ten points a leaf is the default.
        tree_ = std::make_unique<Tree>(3, points_, nanoflann::KDTreeSingleIndexAdaptorParams(10));
        tree_->buildIndex();
    }

    // The agent itself is found as well.
    std::size_t search(std::size_t agent) {
        nanoflann::SearchParams parameters;
        parameters.sorted = false;
        // nanoflann's ball is open.
        const float squared =
            std::nextafter(crowd_.radius * crowd_.radius, std::numeric_limits<float>::infinity());
        return tree_->radiusSearch(points_.positions[agent].data(), squared, found_, parameters);
    }

    Points points_;
    std::unique_ptr<Tree> tree_;
    std::vector<std::pair<std::uint32_t, float>> found_;
    std::vector<std::uint32_t> counts_;
};

}  // namespace

std::vector<CrowdKind> nanoflannKinds() {
    return {{{.name = "nanoflann",
              .title = "nanoflann::KDTreeSingleIndexAdaptor",
              .package = HASHPHASE_BENCHMARKS_NANOFLANN_PACKAGE},
             [](const Crowd& crowd) { return std::make_unique<NanoflannCrowd>(crowd); }}};
}

}  // namespace hashphase::benchmarks
