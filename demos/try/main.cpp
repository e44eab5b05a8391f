// SPDX-License-Identifier: Zlib
#include <demos/try/try_command.hpp>

int main(int argc, char** argv) {
    return hashphase::demos::runMain(argc, argv, hashphase::demos::tryCommand());
}
