// SPDX-License-Identifier: Zlib
#include <demos/allocation_count.hpp>
#include <demos/effects/effects_command.hpp>

int main(int argc, char** argv) {
    using namespace hashphase::demos;
    return runMain(argc, argv, effectsCommand(kAllocationCount));
}
