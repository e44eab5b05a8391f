// SPDX-License-Identifier: Zlib
#include <demos/accuracy/accuracy_command.hpp>

int main(int argc, char** argv) {
    return hashphase::demos::runMain(argc, argv, hashphase::demos::accuracyCommand());
}
