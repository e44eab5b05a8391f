// SPDX-License-Identifier: Zlib
#pragma once

// What the system knows of a program while it runs: process_posix.cpp, process_windows.cpp.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace hashphase::demos {

/// Whether somebody reads stderr on a screen.
[[nodiscard]] bool errIsTerminal() noexcept;

/// The columns of the terminal that shows stdout, or stderr; 0 where none does.
[[nodiscard]] std::size_t outColumns() noexcept;
[[nodiscard]] std::size_t errColumns() noexcept;

inline constexpr std::size_t kUsualColumns = 80;  // of a terminal that does not report them

/// Where the program of that name is, if it is beside the one that runs.
[[nodiscard]] std::filesystem::path programBeside(const std::string& name);

/// Runs the program in this one's place, with what follows its name. Returns its exit code, where there is
/// anything to return to. Throws std::system_error where it cannot be run.
[[nodiscard]] int runInstead(const std::filesystem::path& program,
                             std::vector<std::string> arguments);

/// Sets a variable for the programs that this one starts.
void setEnvironment(const char* name, const char* value) noexcept;

/// Keeps this thread on the core where it is: the scheduler moves threads, and caches do not move along.
/// Where that is refused, times are a little less steady.
void pinToThisCore() noexcept;

[[nodiscard]] std::string processorName();

/// Its name, release and kind of machine: "Linux 6.1.0-18-amd64 x86_64".
[[nodiscard]] std::string operatingSystem();

}  // namespace hashphase::demos
