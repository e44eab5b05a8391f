// SPDX-License-Identifier: Zlib
#pragma once

// Many ranks in one process, whose parcels are handed over by a loop, beside one grid that has all objects: what
// ranks report together has to be what that one reports.

#include <integration/distributed/rank_grid.hpp>
#include <tests/support/box_scenes.hpp>

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <memory>
#include <set>
#include <vector>

namespace hashphase::test {

template <class Scalar>
class RankWorld {
public:
    using Box = Aabb<Scalar>;

    RankWorld(const Partition<Scalar>& partition, const RankGridConfig& config = {})
        : whole_(config.grid), wholePairs_(whole_), config_(config) {
        for (std::uint32_t rank = 0; rank < partition.rankCount(); ++rank) {
            ranks.push_back(std::make_unique<RankGrid<Scalar>>(rank, partition, config));
        }
    }

    /// On any rank.
    GlobalId add(std::uint32_t rank, const Box& box, const ProxyGroups& groups = {}) {
        return add(GlobalId{nextId_++}, rank, box, groups);
    }
    GlobalId add(GlobalId object, std::uint32_t rank, const Box& box,
                 const ProxyGroups& groups = {}) {
        const ProxyId id = ranks[rank]->add(object, box, groups);
        objects[object] = {rank, id, whole_.add(box, Mobility::mobile, groups), 0};
        names_[objects[object].whole] = object;
        return object;
    }
    void move(GlobalId object, const Box& box) {
        const Object& it = objects.at(object);
        ranks[it.rank]->move(it.proxy, box);
        whole_.move(it.whole, box);
    }
    void remove(GlobalId object) {
        const Object& it = objects.at(object);
        ranks[it.rank]->remove(it.proxy);
        whole_.remove(it.whole);
        objects.erase(object);
    }
    void write(GlobalId object, std::uint32_t payload) {
        Object& it = objects.at(object);
        it.payload = payload;
        std::memcpy(ranks[it.rank]->payload(it.proxy).data(), &payload, sizeof(payload));
    }
    [[nodiscard]] const Box& box(GlobalId object) const {
        return whole_.box(objects.at(object).whole);
    }

    void setPartition(const Partition<Scalar>& partition) {
        for (const auto& rank : ranks) {
            rank->setPartition(partition);
        }
    }

    /// A partition for the load as it is.
    [[nodiscard]] Partition<Scalar> balanced(std::size_t samples = 64) const {
        std::vector<WeightedPoint<Scalar>> points;
        for (const auto& rank : ranks) {
            const auto some = rank->sampleLoad(samples);
            points.insert(points.end(), some.begin(), some.end());
        }
        return Partition<Scalar>::balanced(rankCount(), points);
    }

    /// Ends the frame on all ranks, and compares what they report with the whole.
    void update() {
        std::vector<std::vector<Parcel>> received(ranks.size());
        for (const auto& rank : ranks) {
            for (const Parcel& parcel : rank->pack()) {
                EXPECT_NE(rank->rank(), parcel.rank);
                received[parcel.rank].push_back({rank->rank(), parcel.bytes});
            }
        }
        Events reported;
        using Moves = std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<GlobalId>>;
        Moves departed;  // by from and to, in order
        Moves arrived;
        for (const auto& rank : ranks) {
            auto& parcels = received[rank->rank()];
            std::reverse(parcels.begin(), parcels.end());  // any order will do
            const RankChanges changes = rank->finish(parcels);
            for (const ProxyPair& pair : changes.pairs.born) {
                reported.born.push_back(rank->globalPair(pair));
            }
            for (const ProxyPair& pair : changes.pairs.died) {
                reported.died.push_back(rank->globalPair(pair));
            }
            for (const Migration& one : changes.departed) {
                departed[{rank->rank(), one.rank}].push_back(one.object);
                EXPECT_EQ(one.object, rank->globalId(one.proxy));
                EXPECT_EQ(rank->grid().contains(one.proxy), !rank->find(one.object).isNull());
            }
            std::uint32_t lastRank = 0;
            for (const Migration& one : changes.arrived) {
                EXPECT_LE(lastRank, one.rank);
                lastRank = one.rank;
                arrived[{one.rank, rank->rank()}].push_back(one.object);
                EXPECT_EQ(one.proxy, rank->find(one.object));
                objects.at(one.object).rank = rank->rank();
                objects.at(one.object).proxy = one.proxy;
            }
        }
        EXPECT_EQ(departed, arrived);
        EXPECT_EQ(wholeEvents(), reported.sort());
    }

    /// After update(): pairs, sums, homes, ghosts, payloads and invariants.
    void check() const {
        std::vector<GlobalPair> pairs;
        PairSum sum;
        std::size_t owned = 0;
        for (const auto& rank : ranks) {
            rank->collect(pairs);
            sum += rank->pairSum();
            owned += rank->size();
            EXPECT_EQ("", rank->validate());
            checkProxies(*rank);
        }
        std::sort(pairs.begin(), pairs.end());
        EXPECT_EQ(wholeSet(), pairs);
        PairSum expected;
        for (const GlobalPair& pair : pairs) {
            expected.add(pair);
        }
        EXPECT_EQ(expected, sum);
        EXPECT_EQ(objects.size(), owned);
        for (const auto& [object, it] : objects) {
            EXPECT_TRUE(ranks[it.rank]->isOwned(it.proxy));
            EXPECT_EQ(it.proxy, ranks[it.rank]->find(object));
        }
    }

    [[nodiscard]] std::uint32_t rankCount() const {
        return static_cast<std::uint32_t>(ranks.size());
    }

    struct Object {
        std::uint32_t rank = 0;
        ProxyId proxy;  // there
        ProxyId whole;  // in the one grid
        std::uint32_t payload = 0;
    };

    std::vector<std::unique_ptr<RankGrid<Scalar>>> ranks;
    std::map<GlobalId, Object> objects;

private:
    struct Events {
        std::vector<GlobalPair> born;
        std::vector<GlobalPair> died;

        Events sort() {
            std::sort(born.begin(), born.end());
            std::sort(died.begin(), died.end());
            return *this;
        }
        bool operator==(const Events&) const = default;
        friend void PrintTo(const Events& events, std::ostream* out) {
            *out << events.born.size() << " born, " << events.died.size() << " died:";
            for (const auto* list : {&events.born, &events.died}) {
                for (const GlobalPair& pair : *list) {
                    *out << ' ' << pair.first.value << '-' << pair.second.value;
                }
                *out << ';';
            }
        }
    };

    [[nodiscard]] GlobalPair named(const ProxyPair& pair) const {
        return globalPair(names_.at(pair.first), names_.at(pair.second));
    }
    Events wholeEvents() {
        Events events;
        const PairChanges changes = wholePairs_.update();
        for (const ProxyPair& pair : changes.born) {
            events.born.push_back(named(pair));
        }
        for (const ProxyPair& pair : changes.died) {
            events.died.push_back(named(pair));
        }
        return events.sort();
    }
    [[nodiscard]] std::vector<GlobalPair> wholeSet() const {
        std::vector<ProxyPair> found;
        wholePairs_.collect(found);
        std::vector<GlobalPair> pairs;
        for (const ProxyPair& pair : found) {
            pairs.push_back(named(pair));
        }
        std::sort(pairs.begin(), pairs.end());
        return pairs;
    }
    // Every proxy here is what its object is, and every object that touches the region is here.
    void checkProxies(const RankGrid<Scalar>& rank) const {
        std::size_t count = 0;
        for (const auto& [object, it] : objects) {
            bool touches = it.rank == rank.rank();
            rank.partition().forEachRank(
                whole_.box(it.whole), [&](std::uint32_t each) { touches |= each == rank.rank(); });
            const ProxyId here = rank.find(object);
            ASSERT_EQ(touches, !here.isNull());
            if (!touches) {
                continue;
            }
            ++count;
            EXPECT_TRUE(isSameBits(whole_.box(it.whole), rank.grid().box(here)));
            EXPECT_EQ(it.rank, rank.homeOf(here));
            EXPECT_EQ(it.rank == rank.rank(), rank.isOwned(here));
            if (config_.payloadBytes >= sizeof(it.payload)) {
                std::uint32_t payload = 0;
                std::memcpy(&payload, rank.readPayload(here).data(), sizeof(payload));
                EXPECT_EQ(it.payload, payload);
            }
        }
        EXPECT_EQ(count, rank.grid().size());
    }

    Grid<Scalar> whole_;
    Pairs<Scalar> wholePairs_;
    RankGridConfig config_;
    std::map<ProxyId, GlobalId> names_;  // of the whole, past ones included
    std::uint64_t nextId_ = 1;
};

}  // namespace hashphase::test
