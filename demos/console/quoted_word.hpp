// SPDX-License-Identifier: Zlib
#pragma once

// Words of a user's, for messages.

#include <string>
#include <string_view>

namespace hashphase::demos {

/// The word: not all of a long one, and nothing that a terminal would obey. UTF-8 stays whole.
[[nodiscard]] std::string printable(std::string_view word);

/// The same between quotes.
[[nodiscard]] std::string quotedWord(std::string_view word);

}  // namespace hashphase::demos
