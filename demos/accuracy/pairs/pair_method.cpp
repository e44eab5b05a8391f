// SPDX-License-Identifier: Zlib
#include <demos/accuracy/pairs/pair_method.hpp>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace hashphase::demos {
namespace {

class BroadphaseSource : public PairSource {
public:
    BroadphaseSource(const BroadphaseKind& kind, const BroadphaseNeeds& needs,
                     std::span<const BulletBox> boxes)
        : filled_(kind, needs),
          hash_(dynamic_cast<const SpatialHashBroadphase*>(&filled_.broadphase())) {
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            filled_.create(static_cast<std::uint32_t>(i), boxes[i], {});
        }
    }

    void step(std::span<const BulletBox> boxes) override {
        filled_.setAll(boxes);
        filled_.findPairs();
    }
    void listPairs(std::vector<PairKey>& pairs) const override { filled_.listPairs(pairs); }
    [[nodiscard]] std::optional<std::uint64_t> boxesTested() const override {
        return hash_ != nullptr ? std::optional(hash_->lastCost().boxesTested) : std::nullopt;
    }

private:
    FilledBroadphase filled_;
    const SpatialHashBroadphase* hash_;
};

}  // namespace

const BroadphaseKind& broadphaseKind(std::string_view name) {
    for (const BroadphaseKind& kind : broadphaseKinds()) {
        if (kind.name == name) {
            return kind;
        }
    }
    throw std::logic_error("There is no broadphase '" + std::string(name) + "'.");
}

PairMethod hashMethod(std::string name, const GridConfig& grid) {
    return {.name = std::move(name),
            .make = [grid](const BroadphaseNeeds& needs, std::span<const BulletBox> boxes) {
                BroadphaseNeeds own = needs;
                own.grid = grid;
                return std::make_unique<BroadphaseSource>(broadphaseKind("hash"), own, boxes);
            }};
}

PairMethod dbvtMethod(bool isDeferred) {
    const BroadphaseKind& kind = broadphaseKind(isDeferred ? "dbvt-deferred" : "dbvt");
    return {.name = std::string(kind.title),
            .origin = kOfBullet,
            .isExact = false,
            .make = [&kind](const BroadphaseNeeds& needs, std::span<const BulletBox> boxes) {
                return std::make_unique<BroadphaseSource>(kind, needs, boxes);
            }};
}

}  // namespace hashphase::demos
