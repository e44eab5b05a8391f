// SPDX-License-Identifier: Zlib
#pragma once

// A contestant that knows the exact pairs and spoils them on purpose.

#include <tests/benchmarks/contestant.hpp>

#include <utility>

namespace hashphase::benchmarks {

/// Does something to the list of pairs before it is handed over.
using Spoil = std::function<void(std::vector<demos::PairKey>&)>;

class FakeContestant : public Contestant {
public:
    explicit FakeContestant(Spoil spoil) : spoil_(std::move(spoil)) {}

    void fill(const FrameBoxes& frame) override { frame_ = frame; }
    void setAll(const FrameBoxes& frame) override { frame_ = frame; }
    void findPairs() override {
        demos::findExactPairs(demos::ReferenceMethod::kBrute, frame_.boxes, frame_.filters, pairs_);
        spoil_(pairs_);
    }
    void listPairs(std::vector<demos::PairKey>& pairs) override { pairs = pairs_; }

private:
    Spoil spoil_;
    FrameBoxes frame_;
    std::vector<demos::PairKey> pairs_;
};

[[nodiscard]] inline ContestantKind fakeKind(std::string name, bool ours, Spoil spoil) {
    ContestantKind kind;
    kind.name = std::move(name);
    kind.title = "a fake";
    kind.description = "for tests";
    kind.package = "none";
    kind.ours = ours;
    kind.make = [spoil = std::move(spoil)](const demos::BroadphaseNeeds&) {
        return std::make_unique<FakeContestant>(spoil);
    };
    return kind;
}

}  // namespace hashphase::benchmarks
