// SPDX-License-Identifier: Zlib
//
// When pairs are there, when the filter is asked about them, and what happens when its answer changes: in
// words, by refilter(), or by groups and masks that are written without a word.

#include <tests/integration/bullet/boxes.hpp>

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <sstream>
#include <string>

namespace hashphase::test {
namespace {

/// Cubes of 1 m on the x axis, each with a letter. Words, `a` and `b` standing for any letter:
///     a=X     is created at x = X, or set there
///     a#G,M   gets the group and the mask, without a word; before it is created: from the beginning
///     a?      refilter()             a-      is destroyed
///     a~b     their pair is taken out of the cache
///     |       a step; |N so many     [ab,cd] all pairs that there are
class BoxStory {
public:
    explicit BoxStory(AnyBoxes& boxes) : boxes_(boxes) {}

    void play(const std::string& words) {
        SCOPED_TRACE(words);
        std::istringstream stream(words);
        for (std::string word; stream >> word;) {
            playWord(word);
        }
    }

private:
    struct Cube {
        btBroadphaseProxy* proxy = nullptr;
        int group = btBroadphaseProxy::DefaultFilter;
        int mask = btBroadphaseProxy::AllFilter;
    };

    void playWord(const std::string& word) {
        if (word[0] == '|') {
            boxes_.step(word.size() > 1 ? std::stoi(word.substr(1)) : 1);
        } else if (word[0] == '[') {
            EXPECT_EQ(pairs(), word);
        } else {
            act(cubes_[word[0]], word[1], word.substr(2));
        }
    }

    void act(Cube& cube, char verb, const std::string& argument) {
        if (verb == '=') {
            const Box box = cubeAt(btScalar(std::stod(argument)));
            if (cube.proxy == nullptr) {
                cube.proxy = boxes_.create(box, cube.group, cube.mask);
            } else {
                boxes_.set(cube.proxy, box);
            }
        } else if (verb == '#') {
            std::sscanf(argument.c_str(), "%d,%d", &cube.group, &cube.mask);
            if (cube.proxy != nullptr) {
                cube.proxy->m_collisionFilterGroup = cube.group;
                cube.proxy->m_collisionFilterMask = cube.mask;
            }
        } else if (verb == '?') {
            boxes_.hash().refilter(cube.proxy, nullptr);
        } else if (verb == '-') {
            boxes_.destroy(std::exchange(cube.proxy, nullptr));
        } else {
            ASSERT_EQ(verb, '~') << "no word that is known";
            boxes_.pairCache().removeOverlappingPair(cube.proxy, cubes_.at(argument[0]).proxy,
                                                     nullptr);
        }
    }

    [[nodiscard]] std::string pairs() {
        std::string text;
        for (const auto& [a, cubeA] : cubes_) {
            for (const auto& [b, cubeB] : cubes_) {
                if (a < b && cubeA.proxy != nullptr && cubeB.proxy != nullptr &&
                    boxes_.pairCache().findPair(cubeA.proxy, cubeB.proxy) != nullptr) {
                    text += std::string(text.empty() ? "" : ",") + a + b;
                }
            }
        }
        return '[' + text + ']';
    }

    AnyBoxes& boxes_;
    std::map<char, Cube> cubes_;
};

void expectStory(const std::string& words,
                 std::unique_ptr<btOverlappingPairCache> cache = nullptr) {
    AnyBoxes boxes(std::move(cache), eagerCharactersAndSensors());
    BoxStory(boxes).play(words);
    EXPECT_EQ(boxes.hash().validate(), "");
}

// --- Whom the filter is asked about --------------------------------------------------------------

TEST(Filters, AreAskedOnceForAPairThatLasts) {
    FilterBy filter(true);
    Boxes boxes;
    boxes.cache.setOverlapFilterCallback(&filter);
    for (const btScalar x : {btScalar(0), btScalar(0.5), btScalar(9)}) {
        boxes.create(cubeAt(x));
    }
    for (int frame = 0; frame < 30; ++frame) {
        boxes.set(boxes.proxies[0], cubeAt(btScalar(frame) / 100));
        boxes.check();
        ASSERT_EQ(boxes.pairCount(), 1);
    }
    EXPECT_EQ(filter.asked, 1U);
}

TEST(Filters, AreAskedAgainForARefusedPairOnlyWhenEitherMoves) {
    FilterBy filter(false);
    Boxes boxes;
    boxes.cache.setOverlapFilterCallback(&filter);
    boxes.create(cubeAt(0));
    boxes.create(cubeAt(btScalar(0.5)));
    const auto expectAfter = [&](int steps, std::size_t asked, int pairCount) {
        boxes.step(steps);
        EXPECT_EQ(filter.asked, asked);
        EXPECT_EQ(boxes.pairCount(), pairCount);
    };
    expectAfter(1, 1, 0);
    expectAfter(30, 1, 0);  // long enough to come to rest
    boxes.set(boxes.proxies[1], cubeAt(0));
    expectAfter(1, 2, 0);
    filter.answer = true;
    boxes.set(boxes.proxies[0], cubeAt(btScalar(0.5)));
    expectAfter(1, 3, 1);
}

TEST(Filters, LeaveAPairAloneUntilItSeparatesUnlessRefiltered) {
    expectStory("a=0 b=.5 | a#1,0 a=.5 | [ab] a=9 | a=0 | []");
}

// --- refilter() ----------------------------------------------------------------------------------

TEST(Filters, AreAskedAtOnceByRefilterOfEither) {
    expectStory("a=0 b=.5 | a#1,0 a? [] | [] a#1,-1 b? [ab] | [ab]");
}

TEST(Filters, AreAskedByRefilterAboutProxiesAtRestToo) {
    expectStory("a=0 b#1,0 b=.5 |40 [] b#1,-1 a? [ab] |40 b#1,0 b? [] | []");
}

TEST(Filters, AreAskedByRefilterAboutWhatBeganInThisStep) {
    expectStory("a=0 b=.5 a? [ab] b#1,0 b? [] | []");
}

// What separates and comes back within a step was together at both ends of it.
TEST(Filters, AreAskedByRefilterAboutPairsThatAreApartForTheMoment) {
    expectStory("a=0 b=.5 | a=9 a#1,0 a? a=0 | []");
    // Sensors have their pairs at once.
    expectStory("a=0 b#16,-1 b=9 | b=0 [ab] b=9 b#16,0 b? b=0 | []");
}

TEST(Filters, AskedByRefilterNeverNameADestroyedProxy) {
    expectStory("a=0 b=.5 c=0 | b- a? [ac] | [ac]");
}

TEST(Filters, OfManyProxiesAreAskedOnceAboutEachTwo) {
    FilterBy filter{true};
    Boxes boxes;
    boxes.cache.setOverlapFilterCallback(&filter);
    for (int i = 0; i < 1000; ++i) {
        boxes.create(boxAround({btScalar(1.5) * btScalar(i), 0, 0}, {1, 1, 1}));
    }
    boxes.check();
    ASSERT_EQ(boxes.pairCount(), 999);
    for (const bool areAll : {true, false}) {
        filter.answer = !filter.answer;
        filter.asked = 0;
        if (areAll) {
            boxes.broadphase.refilterAll(nullptr);
        } else {
            boxes.broadphase.refilter(boxes.proxies, nullptr);
        }
        EXPECT_EQ(filter.asked, 999U);
        EXPECT_EQ(boxes.pairCount(), filter.answer ? 999 : 0);
        EXPECT_EQ(boxes.broadphase.validate(), "");
    }
}

TEST(Filters, AreObeyedAfterTheStepByACacheThatDefersRemoval) {
    const auto expect = [](const std::string& words) {
        expectStory("a=0 b=.5 c=0 | [ab,ac,bc] " + words,
                    makeCache<btSortedOverlappingPairCache>());
    };
    expect("c#1,0 c? | [ab] c#1,-1 c? | [ab,ac,bc]");
    expect("a=9 c? a=0 | [ab,ac,bc]");
}

// --- Written without a word ----------------------------------------------------------------------

TEST(Filters, ThatAreWrittenCountWhenEitherOfTheTwoMovesAsUnderDbvt) {
    for (const bool isOurs : {false, true}) {
        for (const std::string moved : {"a=9", "b=0"}) {
            for (const std::string steps : {"|1", "|40"}) {
                AnyBoxes boxes(isOurs ? makeBroadphase<SpatialHashBroadphase>()
                                      : makeBroadphase<ExactDbvt>());
                BoxStory(boxes).play("a#1,0 a=0 b=9 " + steps + " a#1,-1 | [] " + moved +
                                     " | [ab]");
            }
        }
    }
}

TEST(Filters, ThatAreWrittenCountWhenTheBoxIsSetToWhatItWas) {
    // A pair stays one until its boxes part.
    expectStory("a#1,0 a=0 b=.5 |20 a#1,-1 a=0 | [ab] a#1,0 a=0 | [ab] a=9 | []");
}

TEST(Filters, ThatAreWrittenBringEagerPairsAtOnce) {
    expectStory("a#16,0 a=0 b=.5 | [] a#16,-1 a=0 [ab] | [ab]");
}

// A pair of a proxy whose mask has been written since stands until the two part, whoever else is reset.
TEST(Filters, AreNotAskedAboutOtherPairsThanThoseThatAreTakenOut) {
    expectStory("a=0 b=.4 c=.8 d=20 | a#1,0 b~c [ab,ac] d=30 | [ab,ac,bc]");
}

// --- Eager groups --------------------------------------------------------------------------------

// Characters, sensors, and characters that are debris as well.
TEST(EagerGroups, HaveTheirPairsDirectlyAfterCreateProxyAndSetAabb) {
    for (const std::string group : {"32", "16", "40"}) {
        // Others have theirs after calculateOverlappingPairs.
        expectStory("a=0 b=.5 [] c#" + group + ",-1 c=0 [ac,bc] | [ab,ac,bc]");
        // New pairs at once; old ones stay until then. What is not eager neither gains nor loses any.
        expectStory("a=0 b=9 c=9 d#" + group +
                    ",-1 d=0 | [ad,bc] d=9 [ad,bc,bd,cd] c=0 [ad,bc,bd,cd] | [ac,bd]");
        // The pairs of a place that they passed stay until the step ends.
        expectStory("a=0 b#" + group + ",-1 b=9 | b=0 b=9 [ab] | [] b=0 b=.5 [ab] | [ab]");
    }
}

// --- Callbacks that come and go ------------------------------------------------------------------

TEST(Filters, DecideInPlaceOfGroupsAndMasksWhileTheyAreSet) {
    for (const CacheKind& kind : {kCacheKinds[0], kCacheKinds[3]}) {
        SCOPED_TRACE(kind.name);
        AnyBoxes three(kind.make());
        BoxStory story(three);
        const auto refilterBy = [&](FilterBy* filter) {
            three.pairCache().setOverlapFilterCallback(filter);
            three.hash().refilterAll(nullptr);
        };
        FilterBy accept(true);
        FilterBy refuse(false);
        story.play("a#1,0 a=0 b=.5 c=0 | [bc]");
        refilterBy(&accept);
        story.play("[ab,ac,bc]");
        refilterBy(&refuse);
        story.play("[]");
        three.pairCache().setOverlapFilterCallback(nullptr);
        three.step();
        refilterBy(nullptr);
        story.play("[bc] | [bc]");
        EXPECT_EQ(three.hash().validate(), "");
    }
}

/// Of a kind that Bullet does not know, and takes the two whatever their masks.
struct OwnCache : btHashedOverlappingPairCache {
    bool needsBroadphaseCollision(btBroadphaseProxy*, btBroadphaseProxy*) const { return true; }
};

TEST(Filters, AreNotNeededByACacheThatDecidesItself) {
    AnyBoxes two(std::make_unique<OwnCache>());
    BoxStory story(two);
    story.play("a#1,0 b#1,0 a=0 b=.5 |");
    EXPECT_EQ(two.hash().validate(), "");
    EXPECT_EQ(two.hash().lastCost().pairsWatched, 0U);
    story.play("a=.5 |");
    EXPECT_EQ(two.hash().lastCost().pairsWatched, 1U) << "the cache was asked";
}

}  // namespace
}  // namespace hashphase::test
