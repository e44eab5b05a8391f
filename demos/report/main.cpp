// SPDX-License-Identifier: Zlib
#include <demos/accuracy/accuracy_command.hpp>
#include <demos/allocation_count.hpp>
#include <demos/compare/compare_command.hpp>
#include <demos/effects/effects_command.hpp>
#include <demos/paper/paper_command.hpp>
#include <demos/report/report_command.hpp>
#include <demos/stability/stability_command.hpp>

int main(int argc, char** argv) {
    using namespace hashphase::demos;
    return runMain(argc, argv,
                   reportCommand({{compareCommand(), {"--quick"}, 5, 60},
                                  {paperCommand(), {"--quick"}, 20, 90},
                                  {accuracyCommand(), {"--quick"}, 40, 660},
                                  {effectsCommand(kAllocationCount), {"--quick"}, 2, 40},
                                  {stabilityCommand(), {"--quick"}, 20, 70}}));
}
