// SPDX-License-Identifier: Zlib
#pragma once

// Scripts, as the shell runs them.

#include <tests/support/temporary_folder.hpp>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include <sys/wait.h>

namespace hashphase::demos {

/// What has come of a script.
struct ScriptOutput {
    int status = -1;  // as the shell has it: 128 + n after signal n
    std::string out;
    std::string err;
};

/// Runs the script in the folder.
inline ScriptOutput runInFolder(const TemporaryFolder& folder, const std::string& script) {
    folder.write("script", script + "\n");
    ScriptOutput output;
    std::FILE* pipe =
        popen(("cd '" + folder.path().string() + "' && sh script 2>err").c_str(), "r");
    for (int byte = 0; (byte = std::fgetc(pipe)) != EOF;) {
        output.out += static_cast<char>(byte);
    }
    const int status = pclose(pipe);
    output.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    std::ifstream err(folder.file("err"));
    output.err.assign(std::istreambuf_iterator<char>(err), {});
    return output;
}

/// Lines of a script: they send SIGINT to the last background job as soon as the condition, a command, holds. They go
/// on if the job ends before.
inline std::string interruptOnce(const std::string& condition) {
    return "until " + condition + " || ! kill -0 $!; do sleep 0.01; done\nkill -INT $!\n";
}

}  // namespace hashphase::demos
