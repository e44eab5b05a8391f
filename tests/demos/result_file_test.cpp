// SPDX-License-Identifier: Zlib
#include <demos/console/result_file.hpp>
#include <demos/scenes/file_bytes.hpp>
#include <demos/scenes/input_error.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <ostream>
#include <stdexcept>
#include <string>
#include <thread>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

namespace hashphase::demos {
namespace {

/// While it lives, files have at most so many bytes, as on a disk that is full.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;
    ~FileSizeLimit() {
        setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }

private:
    void (*handler_)(int);
    rlimit before_{};
};

/// A folder with the file "r", which holds "old".
class ResultFiles : public testing::Test {
protected:
    void expectAsItWas() const {
        EXPECT_EQ(readFile(path_), "old");
        EXPECT_FALSE(std::filesystem::exists(partial_));
    }
    static void writeNew(ResultFile& file) {
        file.write([](std::ostream& out) { out << "new"; });
    }

    TemporaryFolder folder_;
    std::string path_ = folder_.write("r", "old");
    std::string partial_ = path_ + ".partial";
};

TEST_F(ResultFiles, LeaveTheOlderFileUntilAllIsWritten) {
    {
        ResultFile file(path_);
        file.stream() << "new" << std::flush;
        EXPECT_EQ(readFile(path_), "old");
        EXPECT_EQ(readFile(partial_), "new");
    }
    expectAsItWas();
    ResultFile file(path_);
    writeNew(file);
    EXPECT_EQ(readFile(path_), "new");
    EXPECT_FALSE(std::filesystem::exists(partial_));
}

TEST_F(ResultFiles, LeaveTheOlderFileWhenWritingFails) {
    const auto interrupted = [this] {
        ResultFile(path_).write([](std::ostream& out) {
            out << "new";
            throw std::runtime_error("interrupted");
        });
    };
    EXPECT_THROW(interrupted(), std::runtime_error);
    expectAsItWas();
}

TEST_F(ResultFiles, LeaveTheOlderFileWhenTheDiskIsFull) {
    std::string message;
    {
        const FileSizeLimit limit(1000);
        message = messageOf<InputError>([this] {
            ResultFile(path_).write([](std::ostream& out) { out << std::string(100'000, 'x'); });
        });
    }
    EXPECT_EQ(message, path_ + " cannot be written to its end; is the disk full?");
    expectAsItWas();
}

TEST_F(ResultFiles, StayWhereTheyAreWhenTheirPlaceIsNotToBeHad) {
    std::string message;
    {
        ResultFile file(path_);
        std::filesystem::remove(path_);
        std::filesystem::create_directory(path_);
        message = messageOf<InputError>([&file] { writeNew(file); });
    }
    EXPECT_EQ(message,
              path_ + " cannot be replaced: Is a directory; the results are in " + partial_ + ".");
    EXPECT_EQ(readFile(partial_), "new");
}

TEST_F(ResultFiles, KeepTheRightsOfTheOlderFile) {
    std::filesystem::permissions(path_, std::filesystem::perms{0640});
    ResultFile file(path_);
    writeNew(file);
    EXPECT_EQ(std::filesystem::status(path_).permissions(), std::filesystem::perms{0640});
}

TEST_F(ResultFiles, AreWrittenWhereASymbolicLinkLeads) {
    const std::string link = folder_.file("link");
    const std::string dangling = folder_.file("dangling");
    std::filesystem::create_symlink("r", link);
    std::filesystem::create_symlink(folder_.file("none"), dangling);
    for (const std::string& path : {link, dangling}) {
        ResultFile file(path);
        writeNew(file);
        EXPECT_TRUE(std::filesystem::is_symlink(path));
        EXPECT_EQ(readFile(path), "new");
    }
    EXPECT_EQ(readFile(path_), "new");
}

TEST_F(ResultFiles, AreRefusedEarlyWithTheReason) {
    const auto faultOf = [](const std::string& path) {
        return messageOf<InputError>([&path] { const ResultFile file(path); });
    };
    const std::string nowhere = folder_.file("none/r");
    EXPECT_EQ(faultOf(nowhere), nowhere + " cannot be written: No such file or directory.");
    EXPECT_EQ(faultOf(folder_.path()), folder_.path().string() + " is a folder, not a file.");
    if (geteuid() != 0) {  // who may do anything
        std::filesystem::permissions(path_, std::filesystem::perms::owner_read);
        EXPECT_EQ(faultOf(path_), path_ + " cannot be written: Permission denied.");
        expectAsItWas();
    }
}

TEST_F(ResultFiles, AreNotThereWhereNoneIsNamed) {
    ResultFile none("");
    none.write([](std::ostream&) { FAIL(); });
}

TEST_F(ResultFiles, GoStraightToPipesAndDevices) {
    const std::string pipe = folder_.file("pipe");
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    std::string taken;
    std::thread reader([&] {
        std::ifstream file(pipe);
        taken.assign(std::istreambuf_iterator<char>(file), {});
    });
    {
        ResultFile file(pipe);
        writeNew(file);
    }
    reader.join();
    EXPECT_EQ(taken, "new");
    EXPECT_TRUE(std::filesystem::is_fifo(pipe));
    if (std::filesystem::exists("/dev/full")) {
        ResultFile full("/dev/full");
        EXPECT_EQ(messageOf<InputError>([&full] { writeNew(full); }),
                  "/dev/full cannot be written to its end; is the disk full?");
    }
}

TEST_F(ResultFiles, ThatCannotBeWrittenDoNotCostOthers) {
    ResultFaults faults;
    faults.throwIfAny();
    faults.collect([] { throw InputError("The first."); });
    ResultFile file(path_);
    faults.collect([&file] { writeNew(file); });
    faults.collect([] { throw InputError("The third."); });
    EXPECT_EQ(readFile(path_), "new");
    EXPECT_EQ(messageOf<InputError>([&faults] { faults.throwIfAny(); }), "The first. The third.");
}

// As the shell names them: `--json >(gzip >r.gz)`, `--json /dev/fd/3 3>r`.
TEST_F(ResultFiles, GoStraightToOpenStreams) {
    std::array<int, 2> ends{};
    ASSERT_EQ(pipe(ends.data()), 0);
    const int opened = open(path_.c_str(), O_WRONLY | O_TRUNC);
    for (const int stream : {ends[1], opened}) {
        ResultFile file("/dev/fd/" + std::to_string(stream));
        writeNew(file);
    }
    std::array<char, 4> taken{};
    EXPECT_EQ(read(ends[0], taken.data(), taken.size()), 3);
    EXPECT_STREQ(taken.data(), "new");
    EXPECT_EQ(lseek(opened, 0, SEEK_END), 3) << "the same file";
    for (const int stream : {ends[0], ends[1], opened}) {
        close(stream);
    }
}

}  // namespace
}  // namespace hashphase::demos
