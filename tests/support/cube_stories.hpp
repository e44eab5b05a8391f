// SPDX-License-Identifier: Zlib
#pragma once

// What Pairs tell of a few cubes, as stories in words.

#include <tests/support/box_scenes.hpp>
#include <tests/support/handlers.hpp>
#include <tests/support/pair_world.hpp>

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdlib>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace hashphase::test {

/// Cubes of 1 m on the x axis, each with a letter. Words, `a` standing for any letter:
///     a=X   is added at x = X, or moved there        a:X   is added there, said to rest
///     a-    is removed                               a>X   sweeps by X along x; by 0 no more
///     a!    findPairsNow()                           a#G   gets the groups: parked, moving
///     a?    refilter()                               ??    refilterAll()
///     a~N   gets the colour N; those of one colour above 0 refuse each other
///     a^b   the two are ignored as a pair            a&b   they are not any more
///     |     ends the frame                           z     lets some frames pass without a change
///     +ab -ab    what the last |, !, ?, ^ or & has told; what is told and not written is a fault
/// After each frame all promises of tests/support/pair_world.hpp are checked.
class CubeStory {
public:
    /// `others` stand far away, of which one moves in each frame: where they are many, they come to rest, and
    /// the cubes with them.
    CubeStory(std::size_t others, std::size_t framesOfRest) : framesOfRest_(framesOfRest) {
        for (std::size_t i = 0; i < others; ++i) {
            others_.push_back(world_.add(cubeAt(1000 + 2.0 * static_cast<double>(i))));
        }
    }

    void play(const std::string& words) {
        std::istringstream stream(words);
        for (std::string word; stream >> word && !testing::Test::HasFailure();) {
            SCOPED_TRACE(word);
            playWord(word);
        }
        expectNothingElseTold();
    }

private:
    struct Cube {
        ProxyId id;
        std::uint32_t colour = 0;
    };

    static Aabb<double> cubeAt(double x) { return makeBox<double>(x, 0, 0, x + 1, 1, 1); }

    void playWord(const std::string& word) {
        if (word == "|") {
            endFrame();
        } else if (word == "z") {
            for (std::size_t i = 0; i < framesOfRest_; ++i) {
                endFrame();
            }
        } else if (word == "??") {
            tell([&] { world_.refilterAll(); });
        } else if (word[0] == '+' || word[0] == '-') {
            const std::pair change(word[0] == '+', pairOf(word[1], word[2]));
            EXPECT_EQ(told_.erase(change), 1U) << "is not told";
        } else if (word[1] == '!') {
            tell([&] { world_.findPairsNow(cubes_.at(word[0]).id); });
        } else if (word[1] == '^') {
            tell([&] { world_.ignore(pairOf(word[0], word[2])); });
        } else if (word[1] == '&') {
            tell([&] { world_.stopIgnoring(pairOf(word[0], word[2])); });
        } else if (word[1] == '?') {
            tell([&] { world_.refilter(cubes_.at(word[0]).id); });
        } else {
            change(cubes_[word[0]], word[1], word.substr(2));
        }
    }

    void change(Cube& cube, char what, const std::string& argument) {
        const double number = std::strtod(argument.c_str(), nullptr);
        const bool isNew = cube.id.isNull() || !world_.grid.contains(cube.id);
        if (isNew && (what == '=' || what == ':')) {
            const auto mobility = what == ':' ? Mobility::resting : Mobility::mobile;
            cube = {world_.add(cubeAt(number), mobility)};
        } else if (what == '=') {
            world_.move(cube.id, cubeAt(number));
        } else if (what == '-') {
            world_.remove(cube.id);
        } else if (what == '>') {
            const Sweep mode = number == 0 ? Sweep::none : Sweep::automatic;
            world_.sweep(cube.id, Vector3<double>(number, 0, 0), mode);
        } else if (what == '#') {
            world_.setGroups(cube.id, argument == "parked" ? ProxyGroups{1, 0} : ProxyGroups{});
        } else {
            ASSERT_EQ(what, '~') << "no word that is known";
            cube.colour = static_cast<std::uint32_t>(number);
            world_.colours.set(cube.id, cube.colour);
        }
    }

    void endFrame() {
        if (!others_.empty()) {
            world_.move(others_[0], cubeAt(-1000 - static_cast<double>(++frames_)));
        }
        tell([&] { world_.update(); });
        std::vector<Placed<double>> placed;
        for (const ProxyId id : others_) {
            placed.push_back({id, world_.grid.box(id)});
        }
        for (const auto& [name, cube] : cubes_) {
            if (world_.grid.contains(cube.id)) {
                placed.push_back({cube.id, world_.grid.box(cube.id), cube.colour});
            }
        }
        world_.checkThoroughly(placed);
    }

    template <class Call>
    void tell(const Call& call) {
        expectNothingElseTold();
        const std::set<ProxyPair> before = world_.set();
        for (const auto& [name, cube] : cubes_) {
            names_[cube.id] = name;
        }
        call();
        EXPECT_EQ(world_.pairs.count(), world_.set().size());
        for (const ProxyPair& pair : world_.set()) {
            if (!before.contains(pair)) {
                told_.emplace(true, pair);
            }
        }
        for (const ProxyPair& pair : before) {
            if (!world_.set().contains(pair)) {
                told_.emplace(false, pair);
            }
        }
    }

    void expectNothingElseTold() {
        for (const auto& [isBirth, pair] : told_) {
            ADD_FAILURE() << (isBirth ? '+' : '-') << names_[pair.first] << names_[pair.second]
                          << " is told";
        }
        told_.clear();
    }

    /// Of the last proxies that had the names.
    ProxyPair pairOf(char a, char b) { return makePair(cubes_.at(a).id, cubes_.at(b).id); }

    PairWorld<double> world_;
    std::size_t framesOfRest_;
    std::size_t frames_ = 0;
    std::vector<ProxyId> others_;
    std::map<char, Cube> cubes_;
    std::map<ProxyId, char> names_;  // of whoever had one when something was told
    std::set<std::pair<bool, ProxyPair>> told_;
};

/// Plays the story with few cubes and among many, where `z` is no frame, one, or as many as it takes to rest.
inline void expectStory(const std::string& words) {
    const CaughtMessages aboutNan;
    for (const std::size_t others : {0U, 40U}) {
        for (const std::size_t framesOfRest : {0U, 1U, 12U}) {
            SCOPED_TRACE(testing::Message() << others << " others, z for " << framesOfRest);
            CubeStory(others, framesOfRest).play(words);
        }
    }
}

}  // namespace hashphase::test
