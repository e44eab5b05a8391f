// SPDX-License-Identifier: Zlib
#include <demos/paper/paper_command.hpp>

int main(int argc, char** argv) {
    return hashphase::demos::runMain(argc, argv, hashphase::demos::paperCommand());
}
