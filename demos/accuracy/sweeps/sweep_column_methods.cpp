// SPDX-License-Identifier: Zlib

// After Hastings, Mesit and Guha, "Optimization of Large-Scale, Real-Time Simulations by Spatial
// Hashing", 2005: static objects are hashed once, mobile ones every frame, in all cells of their way.
// The loops include their ends and run both ways, which those that were printed do not; a box has
// all its corners.

#include <demos/accuracy/sweeps/sweep_method.hpp>
#include <demos/accuracy/terrain/ground_columns.hpp>

#include <array>
#include <bit>

namespace hashphase::demos {

GroundColumns::GroundColumns(std::size_t expected)
    : heads_(std::bit_ceil(2 * expected + 1), kNone) {}

void GroundColumns::file(const Column& column, std::uint32_t object) {
    if (entries_.size() == heads_.size()) {
        grow();
    }
    std::uint32_t& head = heads_[bucketOf(column)];
    entries_.push_back({column, object, head});
    head = static_cast<std::uint32_t>(entries_.size() - 1);
}

void GroundColumns::grow() {
    heads_.assign(2 * heads_.size(), kNone);
    for (std::uint32_t i = 0; i < entries_.size(); ++i) {
        std::uint32_t& head = heads_[bucketOf(entries_[i].column)];
        entries_[i].next = head;
        head = i;
    }
}

// The newest of a bucket come first.
void GroundColumns::unfile() {
    while (entries_.size() > kept_) {
        heads_[bucketOf(entries_.back().column)] = entries_.back().next;
        entries_.pop_back();
    }
}

namespace {

enum class Raster : std::uint8_t { box, thinLine, thickLine };

class ColumnFinder : public SweepFinder {
public:
    ColumnFinder(Raster raster, const SweptFrame& first)
        : raster_(raster), columns_(first.objects.size()), lastSeenBy_(first.objects.size(), 0) {
        for (std::uint32_t i = first.movers; i < first.objects.size(); ++i) {
            visitBox(first.objects[i].box, [&](const Column& at) { columns_.file(at, i); });
        }
        columns_.keepFiled();
    }

    void step(const SweptFrame& frame) override {
        columns_.unfile();
        pairs_.clear();
        work_ = {};
        for (std::uint32_t i = 0; i < frame.movers; ++i) {
            const MovingBox<float>& mover = frame.objects[i];
            const auto visit = [&](const Column& at) { enter(at, i, frame); };
            ++visit_;
            switch (raster_) {
                case Raster::box:
                    visitBox(wayBox(mover), visit);
                    break;
                case Raster::thinLine:
                    isSmall(mover) ? visitThinLine(mover, visit) : visitBox(wayBox(mover), visit);
                    break;
                case Raster::thickLine:
                    visitThickLine(mover, visit);
                    break;
            }
        }
    }

    void listPairs(std::vector<PairKey>& pairs) const override {
        pairs.insert(pairs.end(), pairs_.begin(), pairs_.end());
    }

    [[nodiscard]] std::optional<SweepWork> work() const override { return work_; }

private:
    void enter(const Column& at, std::uint32_t mover, const SweptFrame& frame) {
        ++work_.cells;
        columns_.visitObjects(at, [&](std::uint32_t other) {
            if (other == mover || lastSeenBy_[other] == visit_) {
                return;
            }
            lastSeenBy_[other] = visit_;
            ++work_.tests;
            if (counts(frame.objects[mover], frame.objects[other])) {
                pairs_.push_back(pairKey(mover, other));
            }
        });
        columns_.file(at, mover);
    }

    /// "Bullets", to the paper.
    [[nodiscard]] static bool isSmall(const MovingBox<float>& mover) {
        return mover.box.sizes().maxCoeff() <= 1;
    }

    [[nodiscard]] bool counts(const MovingBox<float>& a, const MovingBox<float>& b) const {
        return raster_ == Raster::thickLine ? firstContact(a, b).has_value()
                                            : overlaps(wayBox(a), wayBox(b));
    }

    Raster raster_;
    GroundColumns columns_;
    std::vector<std::uint64_t> lastSeenBy_;  // by object; a value of visit_
    std::uint64_t visit_ = 0;
    std::vector<PairKey> pairs_;
    SweepWork work_;
};

SweepMethod columnMethod(Raster raster) {
    constexpr std::array kNames{"paper: box of cells", "paper: line of cells",
                                "thick line of cells, tested"};
    SweepMethod method;
    method.name = kNames[static_cast<std::size_t>(raster)];
    method.origin = SweepOrigin::paper;
    method.missesNothing = raster != Raster::thinLine;
    method.inventsNothing = raster == Raster::thickLine;
    method.oneFrameIn = 32;
    if (raster == Raster::thickLine) {
        method.contactTime = firstContact<float>;
    }
    method.make = [raster](const SweptFrame& first) {
        return std::make_unique<ColumnFinder>(raster, first);
    };
    return method;
}

}  // namespace

SweepMethod paperBox() {
    return columnMethod(Raster::box);
}

SweepMethod paperLine() {
    return columnMethod(Raster::thinLine);
}

SweepMethod thickLine() {
    return columnMethod(Raster::thickLine);
}

}  // namespace hashphase::demos
