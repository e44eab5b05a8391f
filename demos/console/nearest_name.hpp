// SPDX-License-Identifier: Zlib
#pragma once

// Suggests the name that was probably meant.

#include <span>
#include <string>
#include <string_view>

namespace hashphase::demos {

/// How many letters must be inserted, removed, replaced, or swapped with their neighbour to turn
/// one word into the other.
[[nodiscard]] std::size_t editDistance(std::string_view a, std::string_view b);

/// The known name nearest to `name`, the first of several; empty when none is near enough to be a
/// misspelling (more than a third of the letters differ, and more than two).
[[nodiscard]] std::string nearestName(std::string_view name, std::span<const std::string> known);

/// What follows a sentence about a name that is none: "; did you mean 'paper'?", with such quotes, or the whole
/// list where none is near.
[[nodiscard]] std::string suggestion(std::string_view name, std::span<const std::string> known,
                                     const std::string& quote);

/// "There is no scene 'papr'; did you mean 'paper'?", or the whole list where none is near.
[[nodiscard]] std::string unknownNameSentence(std::string_view whatItIs, std::string_view name,
                                              std::span<const std::string> known);

}  // namespace hashphase::demos
