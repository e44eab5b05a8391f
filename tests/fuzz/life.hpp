// SPDX-License-Identifier: Zlib
#pragma once

// Plays operations on a world: a structure under test beside its naive model. What the world expects
// by GoogleTest's macros is caught here, so that a life can be tried, cut short and told again.

#include <broadphase/aabb.hpp>
#include <tests/fuzz/operation.hpp>
#include <tests/support/handlers.hpp>

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <sstream>
#include <string>

namespace hashphase::test {

template <class Scalar>
[[nodiscard]] std::string textOf(const Vector3<Scalar>& v) {
    std::ostringstream text;
    text.precision(std::numeric_limits<Scalar>::max_digits10);
    text << '(' << v[0] << ", " << v[1] << ", " << v[2] << ')';
    return text.str();
}
template <class Scalar>
[[nodiscard]] std::string textOf(const Aabb<Scalar>& box) {
    return textOf<Scalar>(box.min()) + ".." + textOf<Scalar>(box.max());
}

/// What an operation does, in words, while a story is told; else nothing is written.
class OperationLog {
public:
    explicit OperationLog(bool isTold) : isTold_(isTold) {}

    template <class... Parts>
    void tell(const Parts&... parts) {
        if (isTold_) {
            (write(parts), ...);
        }
    }
    std::string take() {
        std::string text = text_.str();
        text_.str({});
        return text;
    }

private:
    template <class Part>
    void write(const Part& part) {
        if constexpr (requires { textOf(part); }) {
            text_ << textOf(part);
        } else {
            text_ << part;
        }
    }

    bool isTold_;
    std::ostringstream text_;
};

namespace life_detail {

inline std::string firstFailure(const testing::TestPartResultArray& results) {
    for (int i = 0; i < results.size(); ++i) {
        const testing::TestPartResult& result = results.GetTestPartResult(i);
        if (result.failed()) {
            return std::string(result.file_name() != nullptr ? result.file_name() : "") + ":" +
                   std::to_string(result.line_number()) + ": " + result.message();
        }
    }
    return {};
}

}  // namespace life_detail

/// World has
///   World(const Operation& first, OperationLog&)   made as the first operation says
///   void play(const Operation&)             one operation, with all comparisons
/// and expects by EXPECT_... and ASSERT_... A broken assertion of the library is a fault, too.
template <class World>
Verdict playLife(std::span<const Operation> operations, bool tellsStory) {
    Verdict verdict;
    const CaughtMessages aboutBadData;
    const ThrowingAsserts brokenAssertsAreFaults;
    OperationLog story(tellsStory);
    std::unique_ptr<World> world;
    testing::TestPartResultArray results;
    for (const Operation& operation : operations) {
        ++verdict.length;
        try {
            const testing::ScopedFakeTestPartResultReporter reporter(
                testing::ScopedFakeTestPartResultReporter::INTERCEPT_ONLY_CURRENT_THREAD, &results);
            if (world == nullptr) {
                world = std::make_unique<World>(operation, story);
            } else {
                world->play(operation);
            }
        } catch (const BrokenAssert& broken) {
            verdict.fault = std::string("broken assertion: ") + broken.what();
        }
        if (tellsStory) {
            verdict.story.push_back(story.take());
        }
        if (verdict.fault.empty() && results.size() > 0) {
            verdict.fault = life_detail::firstFailure(results);
        }
        if (!verdict.fault.empty()) {
            break;
        }
    }
    return verdict;
}

/// In the precision that the first operation's kind chooses.
template <template <class> class World>
Verdict playInEither(std::span<const Operation> operations, bool tellsStory) {
    return operations.empty() || operations[0].kind % 2 == 0
               ? playLife<World<float>>(operations, tellsStory)
               : playLife<World<double>>(operations, tellsStory);
}

}  // namespace hashphase::test
