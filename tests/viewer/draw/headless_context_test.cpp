// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/draw_error.hpp>
#include <demos/viewer/draw/frame_target.hpp>
#include <demos/viewer/draw/headless_context.hpp>

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <memory>
#include <thread>

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

TEST(HeadlessContext, OutlivesAnotherOne) {
    Image image;
    std::thread([&image] {  // other tests' context stays current in this one
        auto first = std::make_unique<HeadlessContext>();
        const HeadlessContext second;
        first.reset();
        const FrameTarget target(16, 16);
        glClearColor(1, 0, 0, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        image = target.read();
    })
        .join();
    ASSERT_EQ(image.pixels.size(), 4U * 16 * 16);
    EXPECT_EQ(image.pixels[0], 255);
    EXPECT_EQ(image.pixels[1], 0);
}

}  // namespace
}  // namespace hashphase::demos
