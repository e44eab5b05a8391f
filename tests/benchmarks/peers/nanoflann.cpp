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

class NanoflannContestant : public CrowdContestant {
public:
    void move(const FrameBoxes& frame) override { frame_ = frame; }

    void ask(float radius) override {
        build();
        for (std::size_t agent = 0; agent < points_.positions.size(); ++agent) {
            counts_[agent] = static_cast<std::uint32_t>(search(agent, radius) - 1);
        }
    }

    void listAnswers(float radius, std::vector<AgentAnswer>& answers) override {
        for (std::size_t agent = 0; agent < points_.positions.size(); ++agent) {
            search(agent, radius);
            for (const auto& [object, squared] : found_) {
                if (object != agent) {
                    answers[agent].add(object);
                }
            }
            // What was timed counts.
            answers[agent].sum += answers[agent].count == counts_[agent] ? 0 : 1;
        }
    }

private:
    using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>,
                                                     Points, 3, std::uint32_t>;

    void build() {
        points_.positions.resize(frame_.boxes.size());
        counts_.resize(frame_.boxes.size());
        for (std::size_t i = 0; i < frame_.boxes.size(); ++i) {
            points_.positions[i] = frame_.boxes[i].min() / 2 + frame_.boxes[i].max() / 2;
        }
        // Ten points a leaf is the default.
        tree_ = std::make_unique<Tree>(3, points_, nanoflann::KDTreeSingleIndexAdaptorParams(10));
        tree_->buildIndex();
    }

    // The agent itself is found as well.
    std::size_t search(std::size_t agent, float radius) {
        nanoflann::SearchParams parameters;
        parameters.sorted = false;
        // nanoflann's ball is open.
        const float squared =
            std::nextafter(radius * radius, std::numeric_limits<float>::infinity());
        return tree_->radiusSearch(points_.positions[agent].data(), squared, found_, parameters);
    }

    FrameBoxes frame_;
    Points points_;
    std::unique_ptr<Tree> tree_;
    std::vector<std::pair<std::uint32_t, float>> found_;
    std::vector<std::uint32_t> counts_;
};

}  // namespace

std::vector<CrowdKind> nanoflannKinds() {
    CrowdKind crowd;
    crowd.kind.name = "nanoflann";
    crowd.kind.title = "nanoflann::KDTreeSingleIndexAdaptor";
    crowd.kind.description = "a kd-tree made anew, radiusSearch without sorting for each agent";
    crowd.kind.package = HASHPHASE_BENCHMARKS_NANOFLANN_PACKAGE;
    crowd.make = [] { return std::make_unique<NanoflannContestant>(); };
    return {std::move(crowd)};
}

}  // namespace hashphase::benchmarks
