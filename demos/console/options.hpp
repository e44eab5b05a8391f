// SPDX-License-Identifier: Zlib
#pragma once

// What the values of options may be, each kind in one place, for all subcommands.

#include <CLI/CLI.hpp>

#include <cstdint>
#include <limits>
#include <string>

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
/// around the items of a list do not matter.
void checkValues(CLI::App& app);

/// What is wrong with the files of the options that were given: two of them would be written to the
/// same file, or one over what another one reads. Empty where nothing is.
[[nodiscard]] std::string pathClash(const CLI::App& app);

}  // namespace hashphase::demos
