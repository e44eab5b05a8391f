// SPDX-License-Identifier: Zlib
#include <demos/scenes/file_bytes.hpp>

#include <demos/console/format.hpp>
#include <demos/scenes/input_error.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <system_error>

namespace hashphase::demos {
namespace {

// By its mark, or by the zero in one of the first two bytes that a letter of ours has there.
bool isWideText(std::string_view bytes) {
    return bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff") ||
           (bytes.size() > 1 && (bytes[0] == '\0') != (bytes[1] == '\0'));
}

struct FileKind {
    std::string_view beginning;
    std::string_view name;
};

using namespace std::string_view_literals;
constexpr std::array kOtherKinds{
    FileKind{"\x89PNG\r\n"sv, "a PNG picture"},
    FileKind{"PK\3\4"sv, "a ZIP archive or an office document"},
    FileKind{"\x1f\x8b"sv, "a gzip archive"},
    FileKind{"BULLETf"sv, "a world that Bullet saved, whose name should end in .bullet"},
    FileKind{"BULLETd"sv, "a world that Bullet saved, whose name should end in .bullet"},
};

// What is wrong with a text, to follow "is "; empty: it is UTF-8 without zeros.
std::string faultOfText(std::string_view bytes) {
    if (isWideText(bytes)) {
        return "UTF-16 or UTF-32: save it again as UTF-8";
    }
    for (const FileKind& kind : kOtherKinds) {
        if (bytes.starts_with(kind.beginning)) {
            return std::string(kind.name) + ", not a text file";
        }
    }
    for (std::size_t place = 0; place < bytes.size();) {
        const std::size_t length = characterLength(bytes.substr(place));
        if (length == 0) {
            return "not in UTF-8 (byte " + withThousands(place + 1) + "): save it again as UTF-8";
        }
        if (bytes[place] == '\0') {
            return "not a text file: byte " + withThousands(place + 1) + " is 0";
        }
        place += length;
    }
    return {};
}

}  // namespace

void requireFile(const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (std::filesystem::is_directory(status)) {
        throw InputError(path.string() + " is a folder, not a file.");
    }
    if (error) {
        throw InputError(path.string() + " cannot be read: " + error.message() + ".");
    }
    if (!std::filesystem::is_regular_file(status)) {
        throw InputError(path.string() +
                         " is a device or a pipe, not a file: save its content to a file first.");
    }
}

std::ifstream openToRead(const std::filesystem::path& path) {
    requireFile(path);
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw InputError(path.string() + " cannot be read" + reasonOf(errno) + ".");
    }
    return file;
}

std::string readFile(const std::filesystem::path& path) {
    std::ifstream file = openToRead(path);
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (!error && size > kLargestFile) {
        throw InputError(path.string() + " has " + withThousands(size) +
                         " bytes; a file may have at most " + withThousands(kLargestFile) + ".");
    }
    std::string bytes(error ? 0 : static_cast<std::size_t>(size), '\0');
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (error || static_cast<std::size_t>(file.gcount()) != bytes.size()) {
        throw InputError(path.string() + " cannot be read.");
    }
    return bytes;
}

std::string readText(const std::filesystem::path& path) {
    constexpr std::string_view kMark = "\xef\xbb\xbf";
    std::string text = readFile(path);
    if (const std::string fault = faultOfText(text); !fault.empty()) {
        throw InputError(path.string() + " is " + fault + ".");
    }
    if (text.starts_with(kMark)) {
        text.erase(0, kMark.size());
    }
    return text;
}

bool hasExtension(const std::filesystem::path& path, std::string_view extension) {
    const std::string own = path.extension().string();
    return std::equal(
        own.begin(), own.end(), extension.begin(), extension.end(),
        [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); });
}

}  // namespace hashphase::demos
