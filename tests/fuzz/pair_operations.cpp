// SPDX-License-Identifier: Zlib

// Pairs and sweeps, by tests/support/pair_world.hpp.

#include <tests/fuzz/grid_world.hpp>
#include <tests/support/motion_oracle.hpp>
#include <tests/support/pair_world.hpp>

namespace hashphase::test {
namespace {

template <class Scalar>
class PairPlay {
public:
    PairPlay(const Operation& first, OperationLog& story)
        : story_(story), world_(configOf(first)), life_(first, world_, story) {
        // Contacts of moving boxes are exact in double precision but for the extremes.
        maySweep_ = first.arguments[5] % 2 == 1;
        isSeldomUpdated_ = first.arguments[7] % 4 == 3;
        if (maySweep_ && sizeof(Scalar) == sizeof(double)) {
            life_.palette().tame();
        }
    }

    void play(const Operation& operation) {
        life_.play(operation, *this, kOwn);
        EXPECT_EQ(world_.grid.validate(), "");
        EXPECT_EQ(world_.sweeps.validate(), "");
        EXPECT_EQ(world_.pairs.count(), world_.set().size());
    }

private:
    void updateOnce(Arguments& arguments) { update(1, arguments); }

    void clearOrUpdate(Arguments& arguments) {
        if (arguments.flag()) {
            life_.clear();
        } else {
            update(1, arguments);
        }
    }

    void releaseAndRest(Arguments& arguments) {
        const std::uint32_t count = 1 + arguments.below(12);
        if (count % 2 == 0) {
            release(count % 4 == 0);
        }
        update(count, arguments);
    }

    void paint(Placed<Scalar>& proxy, std::uint32_t colour) {
        proxy.colour = colour;
        world_.colours.set(proxy.id, colour);
    }

    void paintAndRefilter(Arguments& arguments) {
        Placed<Scalar>& proxy = life_.list()[life_.any(arguments)];
        paint(proxy, arguments.below(3));
        story_.tell("colour ", proxy.id.index, " with ", proxy.colour);
        world_.refilter(proxy.id);
    }

    void findPairsNow(Arguments& arguments) {
        const ProxyId id = life_.proxies()[life_.any(arguments)].id;
        story_.tell("findPairsNow ", id.index);
        world_.findPairsNow(id);
    }

    void update(std::uint32_t count, Arguments& arguments) {
        if (isSeldomUpdated_ && arguments.byte() % 16 != 15) {
            story_.tell("nothing");
            return;
        }
        story_.tell(count, " updates");
        for (std::uint32_t i = 0; i < count; ++i) {
            world_.update();
            world_.checkThoroughly(life_.proxies());
        }
    }

    static ProxyGroups anyGroups(Arguments& arguments) {
        constexpr std::array<std::uint32_t, 4> kGroups{1, 2, 4, 0};
        constexpr std::array<std::uint32_t, 6> kMasks{~0U, 0, ~2U, 1, 2, 5};
        const std::uint32_t group = kGroups[arguments.below(4)];
        return arguments.below(5) == 0 ? ProxyGroups{}
                                       : ProxyGroups{group, kMasks[arguments.below(6)]};
    }

    void regroup(Arguments& arguments) {
        const ProxyId id = life_.proxies()[life_.any(arguments)].id;
        const ProxyGroups groups = anyGroups(arguments);
        story_.tell("groups ", groups.group, " ", groups.mask, " for ", id.index);
        world_.setGroups(id, groups);
    }

    void regroupMany(Arguments& arguments) {
        const std::uint32_t each = 1 + arguments.below(4);
        const ProxyGroups groups = anyGroups(arguments);
        story_.tell("groups ", groups.group, " ", groups.mask, " for each ", each, "th");
        for (std::size_t i = 0; i < life_.proxies().size(); i += each) {
            world_.setGroups(life_.proxies()[i].id, groups);
        }
    }

    void refilterMany(Arguments& arguments) {
        const std::uint32_t each = 1 + arguments.below(20);
        const std::uint32_t colour = arguments.below(4);
        std::vector<ProxyId> ids;
        for (std::size_t i = 0; i < life_.list().size(); i += each) {
            Placed<Scalar>& proxy = life_.list()[i];
            paint(proxy, colour < 3 ? colour : proxy.colour);
            ids.push_back(proxy.id);
        }
        const bool areAll = arguments.flag();
        story_.tell("colour each ", each, "th with ", colour, areAll ? ", filter all" : ", filter",
                    " again");
        if (areAll) {
            world_.refilterAll();
        } else {
            world_.refilter(ids);
        }
    }

    void ignore(Arguments& arguments) {
        const ProxyId a = life_.proxies()[life_.any(arguments)].id;
        const ProxyId b = life_.proxies()[life_.any(arguments)].id;
        if (a != b) {
            ignoreOrNot(makePair(a, b), arguments.below(3) > 0);
        }
    }
    void ignoreMany(Arguments& arguments) {
        const std::vector<ProxyPair> present(world_.set().begin(), world_.set().end());
        const std::uint32_t each = 1 + arguments.below(6);
        for (std::size_t i = 0; i < present.size(); i += each) {
            ignoreOrNot(present[i], true);
        }
        const bool doesEnd = arguments.flag();
        for (std::size_t i = 0; i < present.size() && doesEnd; i += 2 * each) {
            ignoreOrNot(present[i], false);
        }
    }
    void ignoreOrNot(const ProxyPair& pair, bool isIgnored) {
        story_.tell(isIgnored ? "ignore " : "ignore no more ", pair.first.index, " and ",
                    pair.second.index, "; ");
        if (!world_.grid.contains(pair.first) || !world_.grid.contains(pair.second)) {
            return;
        }
        isIgnored ? world_.ignore(pair) : world_.stopIgnoring(pair);
    }

    void release(bool isAll) {
        story_.tell("release unused memory; ");
        world_.grid.releaseUnusedMemory();
        if (isAll) {
            world_.pairs.releaseUnusedMemory();
            world_.sweeps.releaseUnusedMemory();
        }
    }

    void sweep(Arguments& arguments) {
        const Placed<Scalar>& proxy = life_.proxies()[life_.any(arguments)];
        constexpr std::array<Sweep, 4> kModes{Sweep::automatic, Sweep::line, Sweep::box,
                                              Sweep::none};
        const std::uint32_t drawn = arguments.below(8);
        const Sweep mode = kModes[drawn % 4];
        const bool hasOwnBox = drawn >= 4;
        Vector3<Scalar> way;
        for (int axis = 0; axis < 3; ++axis) {
            const std::uint8_t byte = arguments.byte();
            way[axis] = (byte % 2 == 0 ? 1 : -1) * life_.palette().extent(byte / 2);
        }
        if (!maySweep_) {
            story_.tell("nothing: nobody sweeps here");
            return;
        }
        story_.tell("sweep ", proxy.id.index, " in mode ", static_cast<int>(mode), " by ", way);
        if (hasOwnBox) {
            const Aabb<Scalar> start = life_.proxies()[life_.any(arguments)].box;
            story_.tell("from ", start);
            world_.sweep(proxy.id, MovingBox<Scalar>{start, way}, mode);
        } else {
            world_.sweep(proxy.id, way, mode);
        }
    }

    // Nothing that is touched on a way is left out; nothing is found that no box around a way touches.
    void ask(Arguments& arguments) {
        const Aabb<Scalar> box = life_.palette().box(arguments, life_.proxies());
        story_.tell("box ", box);
        std::vector<ProxyId> found;
        CollectAll collect(found);
        world_.sweeps.visit(BoxRegion<Scalar>{box}, collect);
        std::sort(found.begin(), found.end());
        EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end()) << "each once";
        for (const Placed<Scalar>& proxy : life_.proxies()) {
            const bool sweeps = world_.doesSweep(proxy.id);
            const MovingBox<Scalar> moving = world_.motion(proxy);
            const bool isFound = std::binary_search(found.begin(), found.end(), proxy.id);
            const bool touches =
                sweeps ? overlaps(moving.box, box) ||
                             firstContactByRationals(moving, MovingBox<Scalar>{box}).has_value()
                       : overlaps(proxy.box, box);
            EXPECT_TRUE(isFound || !touches) << proxy.id.index << " is left out";
            EXPECT_TRUE(!isFound || touches || (sweeps && overlaps(sweptBounds(moving), box)))
                << proxy.id.index << " is nowhere near";
        }
    }

    static constexpr std::array<void (PairPlay::*)(Arguments&), 17> kOwn{
        &PairPlay::updateOnce,
        &PairPlay::updateOnce,
        &PairPlay::updateOnce,
        &PairPlay::clearOrUpdate,
        &PairPlay::releaseAndRest,
        &PairPlay::paintAndRefilter,
        &PairPlay::findPairsNow,
        &PairPlay::sweep,
        &PairPlay::sweep,
        &PairPlay::regroup,
        &PairPlay::regroup,
        &PairPlay::regroupMany,
        &PairPlay::refilterMany,
        &PairPlay::ignore,
        &PairPlay::ignore,
        &PairPlay::ignoreMany,
        &PairPlay::ask};

    OperationLog& story_;
    bool maySweep_ = false;
    bool isSeldomUpdated_ = false;
    PairWorld<Scalar> world_;
    BoxModel<Scalar, PairWorld<Scalar>> life_;
};

}  // namespace

Verdict playPairs(std::span<const Operation> operations, bool tellsStory) {
    return playInEither<PairPlay>(operations, tellsStory);
}

}  // namespace hashphase::test
