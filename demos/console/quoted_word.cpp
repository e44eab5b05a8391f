// SPDX-License-Identifier: Zlib
#include <demos/console/quoted_word.hpp>

#include <algorithm>

namespace hashphase::demos {
namespace {

constexpr std::size_t kMost = 40;

bool continuesCharacter(char byte) {
    return (static_cast<unsigned char>(byte) & 0xc0U) == 0x80;
}

}  // namespace

std::string printable(std::string_view word) {
    std::size_t length = std::min(word.size(), kMost);
    while (length < word.size() && length > 0 && continuesCharacter(word[length])) {
        --length;
    }
    std::string text(word.substr(0, length));
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
    return length < word.size() ? text + "..." : text;
}

std::string quotedWord(std::string_view word) {
    std::string quoted(1, '\'');
    quoted += printable(word);
    return quoted += '\'';
}

}  // namespace hashphase::demos
