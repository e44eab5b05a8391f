// SPDX-License-Identifier: Zlib
#include <demos/scenes/bullet_file_check.hpp>
#include <demos/scenes/bullet_world_file.hpp>
#include <demos/scenes/input_error.hpp>
#include <tests/demos/bullet_file.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <random>
#include <sstream>

namespace hashphase::demos {
namespace {

// What a program without a line of ours saves by Bullet's serializer, in each precision.
std::vector<std::string> savedLevels(const std::string& kind) {
    const TemporaryFolder folder;
    std::vector<std::string> levels;
    for (const char* writer : {HASHPHASE_LEVEL_WRITERS}) {
        const std::string path = folder.file("level.bullet");
        const std::string command = std::string(writer) + " " + kind + " " + path;
        EXPECT_EQ(std::system(command.c_str()), 0) << command;
        std::ostringstream bytes;
        bytes << std::ifstream(path, std::ios::binary).rdbuf();
        levels.push_back(bytes.str());
    }
    return levels;
}

// The place of the first chunk without a structure that holds these bytes; its header has 24.
std::size_t placeOfPlainChunk(const std::string& bytes, std::string_view content) {
    return bytes.find(content) - 24;
}

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

TEST(BulletFile, IsAcceptedAsEditorsSaveItWithNamesAndPlainNumbers) {
    for (const char* kind : {"names", "mesh", "multibody", "softbody"}) {
        for (const std::string& level : savedLevels(kind)) {
            EXPECT_EQ(bulletFileFault(level), "") << kind << ' ' << level.substr(0, 8);
            EXPECT_NE(level.find("the floor of the hall"), std::string::npos);
        }
    }
}

TEST(BulletFile, SaysWhatTheImporterPassesOver) {
    for (const std::string& level : savedLevels("multibody")) {
        EXPECT_EQ(bulletFileOmissions(level), "1 multi-body");
    }
    for (const std::string& level : savedLevels("softbody")) {
        EXPECT_EQ(bulletFileOmissions(level), "1 soft body");
    }
    for (const std::string& level : savedLevels("names")) {
        EXPECT_EQ(bulletFileOmissions(level), "");
    }
}

TEST(BulletFile, OfNothingButMultiBodiesIsRefusedInThoseWords) {
    for (std::string level : savedLevels("multibody")) {
        for (std::size_t at = 0; (at = level.find("RBDY", at)) != std::string::npos;) {
            level.replace(at, 4, "NONE");
        }
        EXPECT_EQ(bulletFileFault(level),
                  "the world in it holds 1 multi-body, which Bullet's importer passes over, and no "
                  "collision object besides");
    }
}

TEST(BulletFile, IsRefusedForANameWithoutAnEnd) {
    for (std::string level : savedLevels("names")) {
        const std::size_t place = placeOfPlainChunk(level, "crate");
        level.replace(level.find("crate"), 8, "crateful");
        EXPECT_EQ(bulletFileFault(level),
                  "byte " + std::to_string(place) + ": the name in the chunk has no end");
    }
}

TEST(BulletFile, IsRefusedForPlainNumbersThatDoNotFitTheirChunk) {
    for (std::string level : savedLevels("names")) {
        const std::size_t place = placeOfPlainChunk(level, "crate");
        const std::int32_t count = 9;
        std::memcpy(level.data() + place + 20, &count, sizeof count);
        EXPECT_EQ(bulletFileFault(level),
                  "byte " + std::to_string(place) +
                      ": the chunk holds 8 bytes, but its 9 elements need 9");
    }
}

#if HASHPHASE_HAS_BULLET_IMPORTER

TEST(BulletFile, SavedByAnEditorFillsAWorld) {
    const TemporaryFolder folder;
    for (const auto& [kind, objects] : std::vector<std::pair<std::string, int>>{
             {"names", 3}, {"mesh", 4}, {"multibody", 3}, {"softbody", 3}}) {
        for (const std::string& level : savedLevels(kind)) {
            const BulletWorldFile file(folder.write("w.bullet", level));
            EXPECT_EQ(file.omissions(), bulletFileOmissions(level));
            SmallWorld small;
            WorldContents contents(small.world);
            file.fill(contents);
            EXPECT_EQ(small.world.getNumCollisionObjects(), objects) << kind;
            EXPECT_EQ(small.world.getNumConstraints(), 1) << kind;
            for (int step = 0; step < 10; ++step) {
                small.world.stepSimulation(btScalar(1) / btScalar(60), 0);
            }
        }
    }
}

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
