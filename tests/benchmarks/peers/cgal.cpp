// SPDX-License-Identifier: Zlib

// CGAL's box_intersection_d: Zomorodian and Edelsbrunner, "Fast software for box intersections"
// (2000), a streamed segment tree that is made anew in each frame.

#include <tests/benchmarks/peers/peers.hpp>

#include <CGAL/box_intersection_d.h>

namespace hashphase::benchmarks {
namespace {

using demos::PairKey;

// CGAL's concept BoxIntersectionBox_d.
struct CgalBox {
    using NT = float;
    using ID = std::uint32_t;
    static int dimension() { return 3; }
    [[nodiscard]] ID id() const { return object; }
    [[nodiscard]] NT min_coord(int axis) const { return box.min()[axis]; }
    [[nodiscard]] NT max_coord(int axis) const { return box.max()[axis]; }

    Aabb<float> box;
    std::uint32_t object;
};

// Below as many boxes CGAL scans instead of dividing further; its manual leaves the number to the
// user. Of 10 (the default) to 3,000 this was the fastest on 10,000 to 100,000 uniform boxes, three
// times as fast as 10. Pointers to boxes, which the manual advises, were slower than such small boxes.
constexpr std::ptrdiff_t kCutoff = 1000;

class CgalContestant : public Contestant {
public:
    void fill(const FrameBoxes& frame) override { setAll(frame); }

    void setAll(const FrameBoxes& frame) override {
        frame_ = frame;
        boxes_.resize(frame.boxes.size());
        for (std::size_t i = 0; i < boxes_.size(); ++i) {
            boxes_[i] = {frame.boxes[i], static_cast<std::uint32_t>(i)};
        }
    }

    void findPairs() override {
        pairs_.clear();
        CGAL::box_self_intersection_d(
            boxes_.begin(), boxes_.end(),
            [this](const CgalBox& a, const CgalBox& b) {
                if (frame_.mayPair(a.object, b.object)) {
                    pairs_.push_back(demos::pairKey(a.object, b.object));
                }
            },
            kCutoff);
    }

    void listPairs(std::vector<PairKey>& pairs) override { pairs = pairs_; }

private:
    FrameBoxes frame_;
    std::vector<CgalBox> boxes_;
    std::vector<PairKey> pairs_;
};

}  // namespace

std::vector<ContestantKind> cgalKinds() {
    return {
        {.name = "cgal",
         .title = "CGAL::box_self_intersection_d",
         .description = "CGAL's streamed segment tree, from scratch in each frame",
         .package = HASHPHASE_BENCHMARKS_CGAL_PACKAGE ", compiled with our flags",
         .upTo = 300'000,
         .make = [](const demos::BroadphaseNeeds&) { return std::make_unique<CgalContestant>(); }}};
}

}  // namespace hashphase::benchmarks
