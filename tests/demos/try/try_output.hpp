// SPDX-License-Identifier: Zlib
#pragma once

// `hashphase try` as the shell runs it, and what it writes.

#include <demos/console/program.hpp>
#include <demos/try/try_report.hpp>
#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>

#include <sys/wait.h>

namespace hashphase::demos {

using Json = nlohmann::ordered_json;

struct Output {
    int status = -1;
    std::string out;
    std::string err;
};

/// What the shell makes of the command.
inline Output runCommand(const std::string& command, const TemporaryFolder& folder = {}) {
    Output output;
    std::FILE* pipe = popen((command + " 2>'" + folder.file("err") + "'").c_str(), "r");
    for (int byte = 0; (byte = std::fgetc(pipe)) != EOF;) {
        output.out += static_cast<char>(byte);
    }
    const int status = pclose(pipe);
    output.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    std::stringstream err;
    err << std::ifstream(folder.file("err")).rdbuf();
    output.err = err.str();
    return output;
}

inline const std::string kTry = std::string(HASHPHASE_PROGRAM) + " try ";

/// A file in the folder of the programs that know nothing of hashphase.
inline std::string stock(const std::string& file) {
    return std::string(HASHPHASE_STOCK_FOLDER) + "/" + file;
}

/// To be followed by the name of a program.
inline const std::string kStock = stock("stock-programs") + " ";

/// The outcome of `try` with these words, and what it has written as JSON.
inline std::pair<Output, Json> measureWords(const std::string& words) {
    const TemporaryFolder folder;
    const std::string file = folder.file("try.json");
    Output output = runCommand("folder=" + stock("") + " stock=" + stock("stock-programs") + "\n" +
                                   kTry + "--quiet --json '" + file + "' " + words,
                               folder);
    return {output, Json::parse(std::ifstream(file), nullptr, false)};
}

inline std::pair<Output, Json> measure(const std::string& options, const std::string& program) {
    return measureWords(options + " -- " + program);
}

inline std::size_t countOf(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) {
        ++count;
    }
    return count;
}

/// The last line, without its end.
inline std::string lastLineOf(const std::string& text) {
    const std::size_t end = text.find_last_not_of('\n') + 1;
    const std::size_t before = text.find_last_of('\n', end - 1);
    return text.substr(before + 1, end - before - 1);
}

inline bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace hashphase::demos
