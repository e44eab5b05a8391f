// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/image.hpp>
#include <tests/viewer/draw/sample_pictures.hpp>

#include <gtest/gtest.h>

#include <fstream>
#include <random>

namespace hashphase::demos {
namespace {

/// What DrawError says, or nothing.
template <typename Action>
std::string faultOf(const Action& action) {
    try {
        action();
    } catch (const DrawError& error) {
        return error.what();
    }
    return {};
}

Image noise() {
    Image image{17, 9, {}};
    std::mt19937 random(3);
    for (int i = 0; i < 17 * 9 * 4; ++i) {
        image.pixels.push_back(static_cast<std::uint8_t>(random()));
    }
    return image;
}

Image sphereAt(float x) {
    const DrawnSphere sphere{{x, 0, -10}, 1, {230, 159, 0}};
    Picture picture;
    picture.camera = sampleCamera({0, 0, 0}, {0, 0, -10});
    picture.spheres = {&sphere, 1};
    return drawn(picture);
}

TEST(Png, GivesBackWhatWasWritten) {
    const std::string path = testing::TempDir() + "hashphase_noise.png";
    writePng(path, noise());
    EXPECT_EQ(readPng(path), noise());
}

TEST(Png, NamesThePathThatCannotBeWritten) {
    const std::string path = testing::TempDir() + "no_such_folder/picture.png";
    const std::string fault = faultOf([&] { writePng(path, noise()); });
    EXPECT_NE(fault.find(path + " cannot be written: No such file"), std::string::npos) << fault;
}

TEST(Png, NamesThePathThatCannotBeRead) {
    const std::string path = testing::TempDir() + "no_such_picture.png";
    const std::string fault = faultOf([&] { (void)readPng(path); });
    EXPECT_NE(fault.find(path + " cannot be read: No such file"), std::string::npos) << fault;
}

TEST(Png, NamesTheFileThatIsNoPicture) {
    const std::string path = testing::TempDir() + "hashphase_text.png";
    std::ofstream(path) << "This is a text.";
    const std::string fault = faultOf([&] { (void)readPng(path); });
    EXPECT_NE(fault.find(path + " is no PNG"), std::string::npos) << fault;
}

TEST(ImageDifference, IsNothingBetweenEqualPictures) {
    const ImageDifference difference = imageDifference(noise(), noise());
    EXPECT_EQ(difference.mean, 0);
    EXPECT_EQ(difference.shareOff, 0);
    EXPECT_TRUE(looksTheSame(difference));
}

TEST(ImageDifference, ToleratesWhatNobodySees) {
    const Image image = sphereAt(0);
    Image other = image;
    std::mt19937 random(5);
    for (std::uint8_t& channel : other.pixels) {
        const int off = static_cast<int>(random() % 5) - 2;
        channel = static_cast<std::uint8_t>(std::clamp(channel + off, 0, 255));
    }
    EXPECT_TRUE(looksTheSame(imageDifference(image, other)));
}

TEST(ImageDifference, SeesASphereThatMovedByAFewPixels) {
    const ImageDifference difference = imageDifference(sphereAt(0), sphereAt(0.2F));
    EXPECT_FALSE(looksTheSame(difference));
    EXPECT_GT(difference.shareOff, 0.001);
}

TEST(ImageDifference, SeesAnotherBrightness) {
    const Image image = sphereAt(0);
    Image other = image;
    for (std::uint8_t& channel : other.pixels) {
        channel = static_cast<std::uint8_t>(std::max(channel - 3, 0));
    }
    EXPECT_FALSE(looksTheSame(imageDifference(image, other)));
}

TEST(ImageDifference, TakesPicturesOfDifferentSizesForDifferent) {
    EXPECT_FALSE(looksTheSame(imageDifference(noise(), sphereAt(0))));
}

}  // namespace
}  // namespace hashphase::demos
