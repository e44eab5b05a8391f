// SPDX-License-Identifier: Zlib
#pragma once

// A file for results.
//
// Early     A path that cannot be written is refused before anything runs.
// Whole     Bytes go to `<path>.partial`, which takes the file's place when all of them are there. Until then, and if
//           the run ends early or the disk is full, an older file at the path stays as it is.
// Devices   and pipes are written directly; /dev/stdout is the program's own standard output.

#include <demos/scenes/input_error.hpp>

#include <filesystem>
#include <fstream>
#include <iosfwd>
#include <string>

namespace hashphase::demos {

class ResultFile {
public:
    /// Opens the file; an empty path means none. Throws InputError if it cannot be written.
    explicit ResultFile(std::filesystem::path path);

    /// Removes the bytes unless they are in their place.
    ~ResultFile();
    ResultFile(const ResultFile&) = delete;
    ResultFile& operator=(const ResultFile&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

    /// `<path>.partial`, of what a symbolic link at the path leads to.
    [[nodiscard]] static std::filesystem::path partialOf(const std::filesystem::path& path);

    /// Takes the bytes of the file.
    [[nodiscard]] std::ostream& stream() noexcept { return *stream_; }

    /// Throws InputError if bytes could not be written.
    void requireGood() const;

    /// Closes the file and puts it in its place. Throws InputError if not all bytes could be written, or if the
    /// place is not to be had: then all bytes stay in `<path>.partial`.
    void putInPlace();

    /// Calls writeTo(std::ostream&) and puts the file in its place; does nothing if there is none.
    template <class WriteTo>
    void write(const WriteTo& writeTo) {
        if (!path_.empty()) {
            writeTo(stream());
            putInPlace();
        }
    }

private:
    void open();
    void openPartial(const std::filesystem::file_status& older);

    std::filesystem::path path_;
    std::filesystem::path target_;   // behind symbolic links
    std::filesystem::path partial_;  // empty: the target is written directly
    std::ofstream file_;
    std::ostream* stream_ = &file_;
};

/// Of several files, those that cannot be written do not cost the others.
class ResultFaults {
public:
    /// Calls write(), and keeps what its InputError says.
    template <class Write>
    void collect(const Write& write) {
        try {
            write();
        } catch (const InputError& fault) {
            text_ += (text_.empty() ? "" : " ") + std::string(fault.what());
        }
    }

    /// A sentence for each fault; empty: there is none.
    [[nodiscard]] const std::string& text() const noexcept { return text_; }

    /// Throws InputError with the text, if there is one.
    void throwIfAny() const {
        if (!text_.empty()) {
            throw InputError(text_);
        }
    }

private:
    std::string text_;
};

}  // namespace hashphase::demos
