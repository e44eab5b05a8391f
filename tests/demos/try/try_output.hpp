// SPDX-License-Identifier: Zlib
#pragma once

// `hashphase try` as the shell runs it, and what it writes.

#include <tests/support/shell.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <string>

namespace hashphase::demos {

using Json = nlohmann::ordered_json;

/// What has come of a script.
struct Output : ScriptOutput {
    Json json;  // of the file of that name
};

/// Runs the script in a folder of its own. In it, $try is the program with the word `try`; programs that know
/// nothing of hashphase are in $folder, and $stock runs one by its name.
inline Output runScript(const std::string& script) {
    const TemporaryFolder folder;
    const std::string programs = HASHPHASE_STOCK_FOLDER "/";
    Output output{runInFolder(folder, "try='" HASHPHASE_PROGRAM " try' folder=" + programs +
                                          " stock=" + programs + "stock-programs\n" + script),
                  {}};
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
