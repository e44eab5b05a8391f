// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/headless_context.hpp>
#include <demos/viewer/draw/image.hpp>
#include <demos/viewer/draw/renderer.hpp>

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
        Renderer renderer(16, 16);
        renderer.draw({});
        image = renderer.read();
    })
        .join();
    ASSERT_EQ(image.pixels.size(), 4U * 16 * 16);
    EXPECT_GT(image.pixels[0], 100) << "of the sky";
    EXPECT_EQ(image.pixels[3], 255);
}

}  // namespace
}  // namespace hashphase::demos
