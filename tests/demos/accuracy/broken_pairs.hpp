// SPDX-License-Identifier: Zlib
#pragma once

// A way to find pairs that gets one of them wrong, for tests of what is to notice it.

#include <demos/accuracy/pairs/pair_method.hpp>

#include <memory>
#include <utility>

namespace hashphase::demos {

enum class Flaw { kMissesOne, kInventsOne };

class BrokenSource : public PairSource {
public:
    BrokenSource(Flaw flaw, std::unique_ptr<PairSource> source)
        : flaw_(flaw), source_(std::move(source)) {}

    void step(std::span<const BulletBox> boxes) override { source_->step(boxes); }
    void listPairs(std::vector<PairKey>& pairs) const override {
        source_->listPairs(pairs);
        if (flaw_ == Flaw::kMissesOne) {
            pairs.pop_back();
        } else {
            pairs.push_back(pairKey(0xfffffffe, 0xffffffff));
        }
    }

private:
    Flaw flaw_;
    std::unique_ptr<PairSource> source_;
};

/// The same method, but for one pair in every frame.
[[nodiscard]] inline PairMethod broken(Flaw flaw, PairMethod method) {
    method.make = [flaw, make = std::move(method.make)](const BroadphaseNeeds& needs,
                                                        std::span<const BulletBox> boxes) {
        return std::make_unique<BrokenSource>(flaw, make(needs, boxes));
    };
    return method;
}

}  // namespace hashphase::demos
