// SPDX-License-Identifier: Zlib
#include <demos/console/result_file.hpp>

#include <cerrno>
#include <iostream>
#include <system_error>
#include <utility>

namespace hashphase::demos {
namespace {

// Streams of this process: /dev/fd/3, and /dev/stderr, which is a link to a link in /proc. What such a link names, as
// "pipe:[7]", need be no path.
bool isOpenStream(const std::filesystem::path& path) {
    const std::string text = path.string();
    return text.starts_with("/proc/") || text.starts_with("/dev/fd/");
}

std::filesystem::path behindLinks(std::filesystem::path path) {
    constexpr int kMostLinks = 40;  // as systems have it
    std::error_code ignored;
    for (int i = 0;
         i < kMostLinks && !isOpenStream(path) && std::filesystem::is_symlink(path, ignored); ++i) {
        path = path.parent_path() / std::filesystem::read_symlink(path, ignored);
    }
    return path;
}

}  // namespace

ResultFile::ResultFile(std::filesystem::path path) : path_(std::move(path)) {
    if (path_ == "/dev/stdout") {
        stream_ = &std::cout;
    } else if (!path_.empty()) {
        open();
    }
}

ResultFile::~ResultFile() {
    if (!partial_.empty()) {
        file_.close();
        std::error_code ignored;
        std::filesystem::remove(partial_, ignored);
    }
}

std::filesystem::path ResultFile::partialOf(const std::filesystem::path& path) {
    std::filesystem::path partial = behindLinks(path);
    partial += ".partial";
    return partial;
}

void ResultFile::open() {
    target_ = behindLinks(path_);
    std::error_code ignored;
    const std::filesystem::file_status status = std::filesystem::status(target_, ignored);
    if (std::filesystem::is_directory(status)) {
        throw InputError(path_.string() + " is a folder, not a file.");
    }
    errno = 0;
    if (isOpenStream(target_) || std::filesystem::is_other(status)) {
        file_.open(target_, std::ios::binary | std::ios::app);
    } else {
        openPartial(status);
    }
    if (!file_) {
        throw InputError(path_.string() + " cannot be written" + reasonOf(errno) + ".");
    }
}

void ResultFile::openPartial(const std::filesystem::file_status& older) {
    if (std::filesystem::exists(older)) {
        file_.open(target_, std::ios::binary | std::ios::in);  // changes nothing
        if (!file_) {
            return;
        }
        file_.close();
    }
    partial_ = partialOf(target_);
    file_.open(partial_, std::ios::binary);  // the same bytes on any system
    if (!file_) {
        partial_.clear();
    } else if (std::filesystem::exists(older)) {
        std::error_code ignored;
        std::filesystem::permissions(partial_, older.permissions(), ignored);
    }
}

void ResultFile::requireGood() const {
    if (!*stream_) {
        throw InputError(path_.string() + " cannot be written to its end; is the disk full?");
    }
}

void ResultFile::putInPlace() {
    stream_->flush();
    if (file_.is_open()) {
        file_.close();
    }
    requireGood();
    if (!partial_.empty()) {
        const std::filesystem::path whole = std::exchange(partial_, {});
        std::error_code error;
        std::filesystem::rename(whole, target_, error);
        if (error) {
            throw InputError(path_.string() + " cannot be replaced: " + error.message() +
                             "; the results are in " + whole.string() + ".");
        }
    }
}

}  // namespace hashphase::demos
