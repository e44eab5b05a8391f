// SPDX-License-Identifier: Zlib
#pragma once

// A file for results, opened before anything runs, so that a wrong path costs no waiting.

#include <demos/scenes/input_error.hpp>

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

namespace hashphase::demos {

class ResultFile {
public:
    /// Opens the file; an empty path means none. Throws InputError when it cannot be written.
    explicit ResultFile(const std::string& path) : path_(path) {
        if (!path_.empty()) {
            file_.open(path_, std::ios::binary);  // the same bytes on any system
            refuseIfBad();
        }
    }

    /// Calls writeTo(std::ostream&) and closes the file; does nothing when there is none.
    template <class WriteTo>
    void write(const WriteTo& writeTo) {
        if (!path_.empty()) {
            writeTo(file_);
            file_.close();
            refuseIfBad();
        }
    }

private:
    void refuseIfBad() const {
        if (!file_) {
            std::error_code error;
            throw InputError(path_ + (std::filesystem::is_directory(path_, error)
                                          ? " is a folder, not a file."
                                          : " cannot be written."));
        }
    }

    std::string path_;
    std::ofstream file_;
};

}  // namespace hashphase::demos
