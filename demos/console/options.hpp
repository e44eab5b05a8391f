// SPDX-License-Identifier: Zlib
#pragma once

// What the values of options may be, each kind in one place, for all subcommands, and what they choose.

#include <demos/console/format.hpp>
#include <demos/scenes/input_error.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

/// A whole number from `least` to `most`, as wholeNumber() reads it, for Option::transform().
[[nodiscard]] CLI::Validator wholeFrom(std::uint64_t least, std::uint64_t most);

/// A seed, up to `most`.
[[nodiscard]] CLI::Validator seedUpTo(
    std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

/// A number above 0.
[[nodiscard]] CLI::Validator positiveSeconds();

/// A number of metres from `least` to `most`.
[[nodiscard]] CLI::Validator metresFrom(double least, double most);

/// An option that names a file to be read, or written, or a folder to be written to.
CLI::Option* addFileToRead(CLI::App& app, const std::string& name, std::string& path,
                           const std::string& description);
CLI::Option* addFileToWrite(CLI::App& app, const std::string& name, std::string& path,
                            const std::string& description);
CLI::Option* addFolderToWrite(CLI::App& app, const std::string& name, std::string& path,
                              const std::string& description);

/// To be called when all options are declared: from then on none takes an empty value, and blanks
/// around the items of a list do not matter. Help names numbers "N" and "NUMBER".
void checkValues(CLI::App& app);

/// What is wrong with the files of the options that were given: two of them would be written to the
/// same file, or one over what another one reads, if only until it is whole. Empty where nothing is.
[[nodiscard]] std::string pathClash(const CLI::App& app);

/// The items with these names, in their own order; all where none is named. Throws InputError for a name that
/// nameOf(item) gives of none.
template <class Item, class NameOf>
[[nodiscard]] std::vector<const Item*> chosenOf(std::string_view whatItIs,
                                                const std::vector<std::string>& names,
                                                std::span<const Item> items, const NameOf& nameOf) {
    std::vector<std::string> known;
    std::vector<const Item*> chosen;
    for (const Item& each : items) {
        known.emplace_back(nameOf(each));
        if (names.empty() || std::ranges::find(names, known.back()) != names.end()) {
            chosen.push_back(&each);
        }
    }
    for (const std::string& name : names) {
        if (std::ranges::find(known, name) == known.end()) {
            throw InputError(unknownNameSentence(whatItIs, name, known));
        }
    }
    return chosen;
}

}  // namespace hashphase::demos
