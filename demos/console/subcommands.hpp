// SPDX-License-Identifier: Zlib
#pragma once

// The command line of `hashphase`, of which each subcommand is a program of its own, as git's are:
// `hashphase compare` is hashphase-compare.

#include <demos/console/console.hpp>

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hashphase::demos {

struct SubcommandName {
    std::string_view name;
    std::string_view description;
};

/// All of them.
[[nodiscard]] std::span<const SubcommandName> subcommandNames();

/// Of the subcommand of that name, which there must be.
[[nodiscard]] std::string descriptionOf(std::string_view name);

/// Tells the help, the version and what is wrong, or starts the subcommand that is meant, by its place
/// among `subcommands`, with what follows its name; returns its exit code.
int startSubcommand(const std::vector<std::string>& arguments,
                    std::span<const SubcommandName> subcommands, Console& console,
                    const std::function<int(std::size_t, std::vector<std::string>)>& start);

}  // namespace hashphase::demos
