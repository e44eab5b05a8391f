// SPDX-License-Identifier: Zlib
#include <demos/scenes/bullet_file_check.hpp>
#include <demos/scenes/bullet_world_file.hpp>
#include <demos/scenes/input_error.hpp>
#include <tests/demos/bullet_file.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <random>

namespace hashphase::demos {
namespace {

TEST(BulletFile, IsAcceptedAsBulletWritesIt) {
    EXPECT_EQ(bulletFileFault(serialisedWorld(3)), "");
}

TEST(BulletFile, IsRefusedWhenTruncatedAtAnyByte) {
    const std::string whole = serialisedWorld(1);
    for (std::size_t length = 0; length < whole.size(); ++length) {
        const std::string fault = bulletFileFault(whole.substr(0, length));
        ASSERT_EQ(fault.rfind("byte " + std::to_string(length) + ": the file ends ", 0), 0U)
            << length << ": " << fault;
    }
}

TEST(BulletFile, IsRefusedWithoutACollisionObject) {
    EXPECT_EQ(bulletFileFault(serialisedWorld(0)), "the world in it holds no collision object");
}

TEST(BulletFile, IsRefusedForAHeaderThatIsNone) {
    const std::string whole = serialisedWorld(1);
    const auto faultWith = [&whole](std::size_t place, char letter) {
        std::string bytes = whole;
        bytes[place] = letter;
        return bulletFileFault(bytes);
    };
    EXPECT_EQ(faultWith(0, 'X'),
              "byte 0: this is no .bullet file: it must begin with BULLETf or BULLETd");
    EXPECT_EQ(faultWith(7, '+').rfind("byte 7: ", 0), 0U);
    EXPECT_EQ(faultWith(8, 'V'),
              "byte 8: the file was written on a big-endian machine, which is not supported");
    EXPECT_EQ(faultWith(10, 'x'), "byte 10: the Bullet version must be three digits");
}

TEST(BulletFile, IsRefusedForChunksThatDoNotFit) {
    const std::string whole = serialisedWorld(1);
    const auto faultWith = [&whole](std::size_t place, int value) {
        std::string bytes = whole;
        std::memcpy(bytes.data() + place, &value, sizeof value);
        return bulletFileFault(bytes);
    };
    constexpr std::size_t kFirstChunk = 12;  // code, length, 8 bytes of pointer, type, count
    EXPECT_EQ(faultWith(kFirstChunk + 4, -1), "byte 12: the chunk has a negative length or count");
    EXPECT_NE(faultWith(kFirstChunk + 4, 0x7fffffff).find("the file ends inside chunk"),
              std::string::npos);
    EXPECT_EQ(faultWith(kFirstChunk + 16, 30'000),
              "byte 12: the chunk's type is not in the type table");
    EXPECT_NE(faultWith(kFirstChunk + 20, 1'000'000).find("1000000 elements need"),
              std::string::npos);
}

#if HASHPHASE_HAS_BULLET_IMPORTER

TEST(BulletFile, FillsAnyNumberOfWorldsAlike) {
    const TemporaryFolder folder;
    const BulletWorldFile file(folder.write("w.bullet", serialisedWorld(5)));
    for (int copy = 0; copy < 2; ++copy) {
        SmallWorld small;
        WorldContents contents(small.world);
        file.fill(contents);
        ASSERT_EQ(small.world.getNumCollisionObjects(), 5);
        EXPECT_EQ(small.world.getCollisionObjectArray()[4]->getWorldTransform().getOrigin().y(),
                  btScalar(4));
    }
}

TEST(BulletFile, DamagedAtRandomIsReadOrRefusedButNeverCrashes) {
    const TemporaryFolder folder;
    const std::string whole = serialisedWorld(4);
    std::mt19937 random(11);
    int refused = 0;
    for (int round = 0; round < 100; ++round) {
        std::string bytes = whole;
        for (int i = 0; i < 8; ++i) {
            bytes[random() % bytes.size()] = static_cast<char>(random());
        }
        try {
            const BulletWorldFile file(folder.write("w.bullet", bytes));
            SmallWorld small;
            WorldContents contents(small.world);
            file.fill(contents);
        } catch (const InputError& fault) {
            EXPECT_STRNE(fault.what(), "");
            ++refused;
        }
    }
    EXPECT_GT(refused, 0);
    EXPECT_LT(refused, 100);
}

TEST(BulletFile, WrittenByOtherProgramsIsAccepted) {
    const char* folder = std::getenv("HASHPHASE_TEST_DATA");
    if (folder == nullptr) {
        GTEST_SKIP() << "HASHPHASE_TEST_DATA names no folder with .bullet files";
    }
    int read = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() == ".bullet") {
            SmallWorld small;
            WorldContents contents(small.world);
            BulletWorldFile(entry.path()).fill(contents);
            EXPECT_GT(small.world.getNumCollisionObjects(), 0) << entry.path();
            ++read;
        }
    }
    EXPECT_GT(read, 0) << "no .bullet file in " << folder;
}

#else

TEST(BulletFile, IsRefusedWithoutTheImporter) {
    const TemporaryFolder folder;
    const BulletWorldFile file(folder.write("w.bullet", serialisedWorld(1)));
    SmallWorld small;
    WorldContents contents(small.world);
    EXPECT_THROW(file.fill(contents), InputError);
}

#endif

}  // namespace
}  // namespace hashphase::demos
