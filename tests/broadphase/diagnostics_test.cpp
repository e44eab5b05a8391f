// SPDX-License-Identifier: Zlib

#include <broadphase/diagnostics.hpp>
#include <tests/support/handlers.hpp>

#include <gtest/gtest.h>

namespace hashphase::test {
namespace {

void ignoreMessage(const char* /*message*/) {}
void ignoreAssert(const char* /*condition*/, const char* /*sentence*/, const char* /*file*/,
                  int /*line*/) {}

TEST(Diagnostics, ReplacingAHandlerReturnsThePreviousOne) {
    const MessageHandler messageDefault = setMessageHandler(&ignoreMessage);
    EXPECT_NE(messageDefault, nullptr);
    EXPECT_EQ(setMessageHandler(nullptr), &ignoreMessage);
    EXPECT_EQ(setMessageHandler(nullptr), messageDefault);

    const AssertHandler assertDefault = setAssertHandler(&ignoreAssert);
    EXPECT_NE(assertDefault, nullptr);
    EXPECT_EQ(setAssertHandler(nullptr), &ignoreAssert);
    EXPECT_EQ(setAssertHandler(nullptr), assertDefault);
}

TEST(Diagnostics, TheDefaultMessageHandlerWritesToStderr) {
    testing::internal::CaptureStderr();
    detail::reportMessage("A sentence.");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "hashphase: A sentence.\n");
}

TEST(Diagnostics, AHandlerReceivesTheMessage) {
    const CaughtMessages messages;
    detail::reportMessage("A sentence.");
    EXPECT_EQ(messages.all(), std::vector<std::string>{"A sentence."});
}

TEST(Diagnostics, ABrokenAssertReachesTheHandlerWithItsSentence) {
    const ThrowingAsserts throwing;
    try {
        detail::reportBrokenAssert("a < b", "What would be right.", "file.cpp", 7);
        FAIL();
    } catch (const BrokenAssert& broken) {
        EXPECT_STREQ(broken.what(), "What would be right.");
    }
}

TEST(DiagnosticsDeathTest, TheDefaultAssertHandlerNamesTheFaultAndAborts) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_DEATH(detail::reportBrokenAssert("a < b", "What would be right.", "file.cpp", 7),
                 "What would be right.*file.cpp:7.*a < b");
}

}  // namespace
}  // namespace hashphase::test
