// SPDX-License-Identifier: Zlib
#include <broadphase/pairs.hpp>
#include <demos/paper/collision_parts.hpp>
#include <demos/paper/phase_makers.hpp>
#include <integration/ai/rarest_colour.hpp>
#include <integration/culling/culler.hpp>
#include <integration/terrain/terrain.hpp>

#include <algorithm>
#include <iterator>

namespace hashphase::demos {
namespace {

/// A grid with the spheres of a bed: object i is the proxy with index i.
class SphereGrid {
public:
    SphereGrid(const TestBed& bed, double cellSize) : grid_({.cellSize = cellSize}) {
        grid_.reserve(bed.objects());
        for (const Aabb<float>& box : bed.boxes()) {
            ids_.push_back(grid_.add(box));
        }
    }

    void moveAll(const TestBed& bed) {
        for (std::size_t i = 0; i < ids_.size(); ++i) {
            grid_.move(ids_[i], bed.boxes()[i]);
        }
    }

    [[nodiscard]] Grid<float>& grid() { return grid_; }
    [[nodiscard]] double cellSize() const { return static_cast<double>(grid_.cellSize()); }
    [[nodiscard]] std::size_t memoryBytes() const {
        return grid_.memoryBytes() + ids_.capacity() * sizeof(ids_[0]);
    }

private:
    Grid<float> grid_;
    std::vector<ProxyId> ids_;
};

/// Pairs keep track from frame to frame, and file what has moved; the terrain is asked for all at
/// once.
class HashCollision final : public PhaseMethod {
public:
    HashCollision(const TestBed& bed, double cellSize)
        : spheres_(bed, cellSize),
          pairs_(spheres_.grid()),
          triangles_({.cellSize = cellSize}),
          terrain_(triangles_) {
        terrain_.add(bed.ground().vertices, bed.ground().indices);
        triangles_.update();
    }

    void run(const TestBed& bed) override {
        states_.begin(bed);
        spheres_.moveAll(bed);
        const PairChanges changes = pairs_.update([](ProxyId, ProxyId) { return true; });
        survived_.clear();
        std::set_difference(current_.begin(), current_.end(), changes.died.begin(),
                            changes.died.end(), std::back_inserter(survived_));
        current_.clear();
        std::merge(survived_.begin(), survived_.end(), changes.born.begin(), changes.born.end(),
                   std::back_inserter(current_));
        for (const auto& [a, b] : current_) {
            states_.meet(a.index, b.index);
        }
    }

    void stand(const TestBed& bed) override {
        above_.resize(bed.objects());
        grounds_.resize(bed.objects());
        for (std::size_t i = 0; i < above_.size(); ++i) {
            above_[i] = bed.centres()[i];
            above_[i].y() = Terrain::kHighest + 1;
        }
        terrain_.surfacesBelow(above_, grounds_);
        for (std::uint32_t i = 0; i < bed.objects(); ++i) {
            states_.stand(i, grounds_[i] ? grounds_[i]->height : 0);
        }
    }

    [[nodiscard]] PhaseAnswer answer() const override {
        std::vector<std::uint64_t> pairs;
        for (const auto& [a, b] : current_) {
            pairs.push_back(pairKeyOf(a.index, b.index));
        }
        return {std::move(pairs), states_.numbers(Subjects::all(states_.size()))};
    }

    [[nodiscard]] double cellSize() const override { return spheres_.cellSize(); }
    [[nodiscard]] std::size_t memoryBytes() const override {
        return spheres_.memoryBytes() + pairs_.memoryBytes() + triangles_.memoryBytes() +
               terrain_.memoryBytes() + states_.memoryBytes() +
               (current_.capacity() + survived_.capacity()) * sizeof(ProxyPair) +
               above_.capacity() * sizeof(above_[0]) + grounds_.capacity() * sizeof(grounds_[0]);
    }

private:
    SphereGrid spheres_;
    Pairs<float> pairs_;
    Grid<float> triangles_;
    hashphase::Terrain<float> terrain_;
    SphereStates states_;
    std::vector<ProxyPair> current_;  // sorted
    std::vector<ProxyPair> survived_;
    std::vector<Vector3<float>> above_;
    std::vector<hashphase::Terrain<float>::Found> grounds_;
};

class HashVisibility final : public PhaseMethod {
public:
    HashVisibility(const TestBed& bed, double cellSize) : spheres_(bed, cellSize) {}

    void hash(const TestBed& bed) override {
        spheres_.moveAll(bed);
        spheres_.grid().update();
    }

    void run(const TestBed& bed) override {
        culler_.look(spheres_.grid(), frustumRegion<float>(bed.view().viewProjection, kDepthRange));
        visible_.clear();
        culler_.forEach([this](std::uint32_t object) { visible_.push_back(object); });
    }

    [[nodiscard]] PhaseAnswer answer() const override {
        return {{visible_.begin(), visible_.end()}, {}};
    }
    [[nodiscard]] double cellSize() const override { return spheres_.cellSize(); }
    [[nodiscard]] std::size_t memoryBytes() const override {
        return spheres_.memoryBytes() + culler_.memoryBytes() +
               visible_.capacity() * sizeof(std::uint32_t);
    }

private:
    SphereGrid spheres_;
    Culler<float> culler_;
    std::vector<std::uint32_t> visible_;
};

/// The crowd sorts agents into cells of its own, which follow the radius; the grid's are refiled.
class HashAi final : public PhaseMethod {
public:
    HashAi(const TestBed& bed, double cellSize, float radius)
        : spheres_(bed, cellSize), radius_(radius) {}

    void hash(const TestBed& bed) override {
        spheres_.moveAll(bed);
        spheres_.grid().update();
    }

    void run(const TestBed& bed) override {
        colours_.assign(bed.colours().begin(), bed.colours().end());
        rarest_.update(spheres_.grid(), radius_, TestBed::kColours, colours_);
    }

    [[nodiscard]] PhaseAnswer answer() const override {
        return {{colours_.begin(), colours_.end()}, {}};
    }
    [[nodiscard]] double cellSize() const override { return spheres_.cellSize(); }
    [[nodiscard]] std::size_t memoryBytes() const override {
        return spheres_.memoryBytes() + rarest_.memoryBytes() +
               colours_.capacity() * sizeof(std::uint32_t);
    }

private:
    SphereGrid spheres_;
    float radius_;
    RarestColour<float> rarest_;
    std::vector<std::uint32_t> colours_;
};

}  // namespace

std::unique_ptr<PhaseMethod> hashCollision(const TestBed& bed, double cellSize) {
    return std::make_unique<HashCollision>(bed, cellSize);
}

std::unique_ptr<PhaseMethod> hashVisibility(const TestBed& bed, double cellSize) {
    return std::make_unique<HashVisibility>(bed, cellSize);
}

std::unique_ptr<PhaseMethod> hashAi(const TestBed& bed, double cellSize, float radius) {
    return std::make_unique<HashAi>(bed, cellSize, radius);
}

}  // namespace hashphase::demos
