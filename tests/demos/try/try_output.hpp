// SPDX-License-Identifier: Zlib
#pragma once

// `hashphase try` as the shell runs it, and what it writes.

#include <tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <fstream>
#include <string>

#include <sys/wait.h>

namespace hashphase::demos {

using Json = nlohmann::ordered_json;

/// What has come of a script.
struct Output {
    int status = -1;
    std::string out;
    std::string err;
    Json json;  // of the file of that name
};

/// Runs the script in a folder of its own. In it, $try is the program with the word `try`; programs that know
/// nothing of hashphase are in $folder, and $stock runs one by its name.
inline Output runScript(const std::string& script) {
    const TemporaryFolder folder;
    const std::string programs = HASHPHASE_STOCK_FOLDER "/";
    const std::string file =
        folder.write("script", "try='" HASHPHASE_PROGRAM " try' folder=" + programs +
                                   " stock=" + programs + "stock-programs\n" + script + "\n");
    Output output;
    std::FILE* pipe =
        popen(("cd '" + folder.path().string() + "' && sh script 2>err").c_str(), "r");
    for (int byte = 0; (byte = std::fgetc(pipe)) != EOF;) {
        output.out += static_cast<char>(byte);
    }
    const int status = pclose(pipe);
    output.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    std::ifstream err(folder.file("err"));
    output.err.assign(std::istreambuf_iterator<char>(err), {});
    output.json = Json::parse(std::ifstream(folder.file("json")), nullptr, false);
    return output;
}

/// `try` with these words, which writes the JSON.
inline Output tryWords(const std::string& words) {
    return runScript("$try --quiet --json json " + words);
}

inline bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace hashphase::demos
