// SPDX-License-Identifier: Zlib
#include <integration/distributed/questions.hpp>
#include <tests/integration/distributed/rank_world.hpp>

#include <broadphase/regions.hpp>

#include <algorithm>

namespace hashphase::test {
namespace {

template <class Scalar>
using Lists = std::vector<std::vector<Question<Scalar>>>;

/// Carries the questions of all ranks, and hands each rank's answers to check(rank, answers).
template <class Scalar, class Check>
void askAll(const RankWorld<Scalar>& world, const Lists<Scalar>& questions, const Check& check) {
    const std::size_t count = world.ranks.size();
    std::vector<RankQuestions<Scalar>> asked(count);
    const auto carry = [&](const auto& parcelsOf) {
        std::vector<std::vector<Parcel>> received(count);
        for (std::uint32_t rank = 0; rank < count; ++rank) {
            for (const Parcel& parcel : parcelsOf(rank)) {
                received[parcel.rank].push_back({rank, parcel.bytes});
            }
        }
        return received;
    };
    // The bytes of questions last until their rank answers.
    std::vector<RankQuestions<Scalar>> answering(count);
    const auto questionsReceived = carry(
        [&](std::uint32_t rank) { return asked[rank].pack(*world.ranks[rank], questions[rank]); });
    const auto answersReceived = carry([&](std::uint32_t rank) {
        return answering[rank].answer(*world.ranks[rank], questionsReceived[rank]);
    });
    for (std::uint32_t rank = 0; rank < count; ++rank) {
        check(rank, asked[rank].finish(answersReceived[rank]));
    }
}

template <class Scalar>
std::vector<std::pair<Scalar, GlobalId>> bruteForce(const RankWorld<Scalar>& world,
                                                    const Question<Scalar>& question) {
    std::vector<std::pair<Scalar, GlobalId>> found;
    const auto look = [&](const auto& region) {
        for (const auto& [object, it] : world.objects) {
            const Scalar key = region.key(world.box(object));
            if (key >= 0) {
                found.push_back({key, object});
            }
        }
    };
    using Shape = typename Question<Scalar>::Shape;
    if (question.shape == Shape::box) {
        look(BoxRegion<Scalar>{question.extent});
    } else if (question.shape == Shape::sphere) {
        look(SphereRegion<Scalar>(question.from, question.radius));
    } else {
        look(RayRegion<Scalar>(question.from, question.to, question.extent));
    }
    std::sort(found.begin(), found.end());
    found.resize(std::min<std::size_t>(found.size(), question.most));
    return found;
}

template <class Scalar>
Question<Scalar> randomQuestion(Random& random, const BoxScene<Scalar>& scene) {
    const Aabb<Scalar> box = scene.draw(random);
    const Aabb<Scalar> other = scene.draw(random);
    const std::uint32_t most = random.chance(0.5) ? ~0U : random.below(5);
    const auto size = static_cast<Scalar>(random.logBetween(1e-3, 100));
    switch (random.below(4)) {
        case 0:
            return Question<Scalar>::box(
                random.chance(0.5) ? box : Aabb<Scalar>(box.min(), other.max()), most);
        case 1:
            return Question<Scalar>::sphere(box.min(), size, most);
        case 2:
            return Question<Scalar>::ray(box.min(), other.max(), most);
        default:
            return Question<Scalar>::ray(
                box.min(), other.max(), most,
                {Vector3<Scalar>::Constant(-size), Vector3<Scalar>::Constant(size)});
    }
}

template <class Scalar>
void checkScenes(std::uint64_t seed) {
    for (const BoxScene<Scalar>& scene : allBoxScenes<Scalar>()) {
        SCOPED_TRACE(scene.name);
        Random random(seed++);
        const std::uint32_t ranks = 1 + random.below(8);
        RankWorld<Scalar> world(Partition<Scalar>(std::vector<Cut<Scalar>>(ranks - 1)));
        for (int i = 0; i < 150; ++i) {
            world.add(random.below(ranks), scene.draw(random));
        }
        world.update();
        world.setPartition(world.balanced());
        world.update();
        Lists<Scalar> questions(ranks);
        for (auto& list : questions) {
            const std::size_t count = random.below(30);
            while (list.size() < count) {
                list.push_back(randomQuestion(random, scene));
            }
        }
        askAll<Scalar>(world, questions, [&](std::uint32_t rank, const Answers<Scalar>& answers) {
            ASSERT_EQ(questions[rank].size() + 1, answers.begins.size());
            for (std::size_t i = 0; i < questions[rank].size(); ++i) {
                const auto expected = bruteForce(world, questions[rank][i]);
                const auto found = answers.of(i);
                ASSERT_EQ(expected.size(), found.size()) << "question " << i << " of " << rank;
                for (std::size_t j = 0; j < found.size(); ++j) {
                    EXPECT_EQ(expected[j].first, found[j].key);
                    EXPECT_EQ(expected[j].second, found[j].object);
                    EXPECT_EQ(world.objects.at(found[j].object).rank, found[j].home);
                }
            }
        });
    }
}

TEST(RankQuestions, FindWhatBruteForceFinds) {
    for (std::uint64_t seed = 0; seed < 300; seed += 100) {
        checkScenes<float>(seed);
    }
}

TEST(RankQuestions, FindWhatBruteForceFindsInDoublePrecision) {
    checkScenes<double>(5000);
}

TEST(RankQuestions, GoToTheRanksConcernedAlone) {
    // Four slabs along x; the objects are small.
    RankWorld<float> world(Partition<float>(std::vector<Cut<float>>{{20, 0}, {10, 0}, {30, 0}}));
    for (int i = 0; i < 40; ++i) {
        world.add(0, makeBox<float>(i, 0, 0, i + 0.5, 1, 1));
    }
    world.update();
    RankQuestions<float> asked;
    const auto parcelsFor = [&](const Question<float>& question) {
        std::vector<std::uint32_t> to;
        for (const Parcel& parcel : asked.pack(*world.ranks[0], std::span(&question, 1))) {
            to.push_back(parcel.rank);
        }
        return to;
    };
    using Ranks = std::vector<std::uint32_t>;
    EXPECT_EQ(Ranks{}, parcelsFor(Question<float>::sphere({5, 0, 0}, 1)));
    EXPECT_EQ(Ranks{1}, parcelsFor(Question<float>::box(makeBox<float>(9, 0, 0, 12, 1, 1))));
    EXPECT_EQ(Ranks({2, 3}), parcelsFor(Question<float>::ray({25, 0, 0}, {35, 1, 0})));
}

TEST(RankQuestions, RefuseBytesThatAreNone) {
    RankWorld<float> world(Partition<float>(std::vector<Cut<float>>{{0, 0}}));
    world.add(0, makeBox<float>(-1, 0, 0, 1, 1, 1));
    world.update();
    RankQuestions<float> asking;
    const auto question = Question<float>::sphere({5, 0, 0}, 20);
    const auto sent = asking.pack(*world.ranks[0], std::span(&question, 1));
    ASSERT_EQ(1U, sent.size());
    const std::vector<std::byte> bytes(sent[0].bytes.begin(), sent[0].bytes.end());
    RankQuestions<float> answering;
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        const Parcel parcel{0, std::span(bytes).first(size)};
        EXPECT_THROW(answering.answer(*world.ranks[1], std::span(&parcel, 1)), RankError);
    }
    for (std::size_t at = 0; at < bytes.size(); ++at) {
        auto changed = bytes;
        changed[at] ^= std::byte{0xff};
        const Parcel parcel{0, changed};
        try {
            answering.answer(*world.ranks[1], std::span(&parcel, 1));
        } catch (const RankError& error) {
            EXPECT_NE("", std::string(error.what()));
        }
    }
    const Parcel ofNobody{7, bytes};
    EXPECT_THROW(answering.answer(*world.ranks[1], std::span(&ofNobody, 1)), RankError);

    // Answers, of one object each.
    const Parcel right{0, bytes};
    const auto answered = answering.answer(*world.ranks[1], std::span(&right, 1));
    ASSERT_EQ(1U, answered.size());
    const std::vector<std::byte> answer(answered[0].bytes.begin(), answered[0].bytes.end());
    for (std::size_t size = 0; size < answer.size(); ++size) {
        const Parcel parcel{1, std::span(answer).first(size)};
        EXPECT_THROW(asking.finish(std::span(&parcel, 1)), RankError);
    }
    for (const std::size_t at : {0U, 4U, 12U, 16U}) {  // what it is, bytes, question, number
        auto changed = answer;
        changed[at] ^= std::byte{0x3f};
        const Parcel parcel{1, changed};
        EXPECT_THROW(asking.finish(std::span(&parcel, 1)), RankError) << at;
    }
    asking.pack(*world.ranks[0], std::span(&question, 1));
    const Parcel parcel{1, answer};
    EXPECT_EQ(1U, asking.finish(std::span(&parcel, 1)).of(0).size());
}

}  // namespace
}  // namespace hashphase::test
