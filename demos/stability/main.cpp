// SPDX-License-Identifier: Zlib
#include <demos/stability/stability_command.hpp>

int main(int argc, char** argv) {
    return hashphase::demos::runMain(argc, argv, hashphase::demos::stabilityCommand());
}
