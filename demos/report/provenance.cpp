// SPDX-License-Identifier: Zlib
#include <demos/report/provenance.hpp>

#include <demos/console/program.hpp>
#include <demos/system/process.hpp>

#include <broadphase/core/compiler.hpp>
#include <broadphase/diagnostics.hpp>
#include <broadphase/simd/kernels.hpp>

#include <LinearMath/btScalar.h>

#include <thread>

namespace hashphase::demos {
Provenance gatherProvenance(const std::string& commandLine) {
    Provenance provenance;
    provenance.hashphaseVersion = programVersion();
    provenance.bulletVersion =
        std::to_string(btGetVersion() / 100) + "." + std::to_string(btGetVersion() % 100);
    provenance.precision = btIsDoublePrecision() ? "double" : "single";
    provenance.compiler = HASHPHASE_COMPILER;
#ifdef HASHPHASE_COMPILER_FLAGS
    provenance.compilerFlags = HASHPHASE_COMPILER_FLAGS;
    provenance.programFlags = HASHPHASE_PROGRAM_FLAGS;
    provenance.buildType = HASHPHASE_BUILD_TYPE;
    provenance.isForMeasuring = HASHPHASE_BUILT_FOR_MEASURING != 0;
#endif
    provenance.hasAssertions = HASHPHASE_ENABLE_ASSERTS != 0;
    provenance.instructionSet = detail::nameOf(detail::instructionSet());
    provenance.optimised = HASHPHASE_IS_OPTIMISED != 0;
    provenance.cpu = processorName();
    provenance.cores = std::thread::hardware_concurrency();
    provenance.loadAverage = loadAverage();
    provenance.commandLine = commandLine;
    return provenance;
}

}  // namespace hashphase::demos
