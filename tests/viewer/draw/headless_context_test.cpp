// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/draw_error.hpp>
#include <demos/viewer/draw/headless_context.hpp>

#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

namespace hashphase::demos {
namespace {

/// Ends the process with 0 when a context was refused, after saying why.
[[noreturn]] void openWithoutDrivers() {
    setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/dev/null", 1);
    try {
        const HeadlessContext context;
    } catch (const DrawError& error) {
        std::cerr << error.what();
        std::exit(0);
    }
    std::exit(1);
}

TEST(HeadlessContextDeathTest, SaysWhatToInstallWhereNoDriverIs) {
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    EXPECT_EXIT(openWithoutDrivers(), testing::ExitedWithCode(0),
                "No picture can be drawn without a window.*"
                "apt-get install libegl1 libegl-mesa0 libgl1-mesa-dri");
}

}  // namespace
}  // namespace hashphase::demos
