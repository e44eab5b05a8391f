// SPDX-License-Identifier: Zlib
#include <demos/scenes/bullet_world_file.hpp>
#include <demos/scenes/file_bytes.hpp>
#include <demos/scenes/input_error.hpp>
#include <tests/demos/bullet_file.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <random>
#include <utility>

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
        levels.push_back(readFile(path));
    }
    return levels;
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
    EXPECT_EQ(bulletFileFault(serialisedWorld(0)),
              "the world in the file has no collision objects");
}

// Of a whole world with this value in that place.
template <class Value>
std::string faultWith(std::size_t place, Value value) {
    std::string bytes = serialisedWorld(1);
    std::memcpy(bytes.data() + place, &value, sizeof value);
    return bulletFileFault(bytes);
}

TEST(BulletFile, IsRefusedForAHeaderThatIsNone) {
    EXPECT_EQ(faultWith(0, 'X'),
              "byte 0: this is not a .bullet file: it must begin with BULLETf or BULLETd");
    EXPECT_EQ(faultWith(7, '+').rfind("byte 7: ", 0), 0U);
    EXPECT_EQ(faultWith(8, 'V'),
              "byte 8: the file was written on a big-endian machine, which is not supported");
    EXPECT_EQ(faultWith(10, 'x'), "byte 10: the Bullet version must be three digits");
}

TEST(BulletFile, IsRefusedForChunksThatDoNotFit) {
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
    for (const auto& [kind, omissions] :
         {std::pair("multibody", "1 multi-body"), {"softbody", "1 soft body"}, {"names", ""}}) {
        for (const std::string& level : savedLevels(kind)) {
            EXPECT_EQ(bulletFileOmissions(level), omissions);
        }
    }
}

TEST(BulletFile, OfNothingButMultiBodiesIsRefusedInThoseWords) {
    for (std::string level : savedLevels("multibody")) {
        for (std::size_t at = 0; (at = level.find("RBDY", at)) != std::string::npos;) {
            level.replace(at, 4, "NONE");
        }
        EXPECT_EQ(bulletFileFault(level),
                  "the world in the file has no collision objects, only 1 multi-body, which "
                  "Bullet's importer ignores");
    }
}

TEST(BulletFile, IsRefusedForANameWithoutAnEndAndForPlainNumbersThatDoNotFitTheirChunk) {
    for (const std::string& level : savedLevels("names")) {
        const std::size_t name = level.find("crate");
        const std::size_t chunk = name - 24;  // a header of which the last 4 are the count
        const std::string place = "byte " + std::to_string(chunk);
        std::string endless = level;
        endless.replace(name, 8, "crateful");
        EXPECT_EQ(bulletFileFault(endless),
                  place + ": the name in the chunk has no zero byte at its end");
        std::string large = level;
        large.replace(chunk + 20, 4, std::string("\x09\0\0\0", 4));
        EXPECT_EQ(bulletFileFault(large),
                  place + ": the chunk holds 8 bytes, but its 9 elements need 9");
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
            FilledWorld small(file);
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
        const FilledWorld small(file);
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
            const FilledWorld small(BulletWorldFile(folder.write("w.bullet", bytes)));
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
            const FilledWorld small(BulletWorldFile(entry.path()));
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
    EXPECT_THROW(FilledWorld{file}, InputError);
}

#endif

}  // namespace
}  // namespace hashphase::demos
