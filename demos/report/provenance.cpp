// SPDX-License-Identifier: Zlib
#include <demos/report/provenance.hpp>

#include <demos/console/program.hpp>
#include <demos/report/profile_zones.hpp>
#include <demos/system/process.hpp>

#include <broadphase/core/compiler.hpp>
#include <broadphase/diagnostics.hpp>
#include <broadphase/simd/kernels.hpp>

#include <btBulletCollisionCommon.h>

#include <array>
#include <cstdio>
#include <thread>

namespace hashphase::demos {
namespace {

/// Only the library itself tells whether it was built with them.
bool hasProfileZones() {
    btDefaultCollisionConstructionInfo small;
    small.m_defaultMaxPersistentManifoldPoolSize = 1;
    small.m_defaultMaxCollisionAlgorithmPoolSize = 1;
    btDefaultCollisionConfiguration configuration(small);
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btCollisionWorld world(&dispatcher, &broadphase, &configuration);
    return !profileZonesOf([&world] { world.updateAabbs(); }).empty();
}

}  // namespace

Provenance gatherProvenance(const std::string& commandLine) {
    Provenance provenance;
    provenance.date = utcText(std::chrono::system_clock::now());
    provenance.hashphaseVersion = programVersion();
    provenance.commit = sourceCommit();
    provenance.bulletVersion =
        std::to_string(btGetVersion() / 100) + "." + std::to_string(btGetVersion() % 100);
    provenance.precision = btIsDoublePrecision() ? "double" : "single";
    provenance.hasBulletProfileZones = hasProfileZones();
    provenance.compiler = HASHPHASE_COMPILER;
#ifdef HASHPHASE_COMPILER_FLAGS
    provenance.compilerFlags = HASHPHASE_COMPILER_FLAGS;
    provenance.programFlags = HASHPHASE_PROGRAM_FLAGS;
    provenance.buildType = HASHPHASE_BUILD_TYPE;
    provenance.isForMeasuring = HASHPHASE_BUILT_FOR_MEASURING != 0;
    provenance.hasBulletThreads = HASHPHASE_BULLET_HAS_THREADS != 0;
    provenance.bulletPackage = HASHPHASE_BULLET_PACKAGE;
#endif
    provenance.hasAssertions = HASHPHASE_ENABLE_ASSERTS != 0;
    provenance.instructionSet = detail::nameOf(detail::instructionSet());
    provenance.optimised = HASHPHASE_IS_OPTIMISED != 0;
    provenance.operatingSystem = operatingSystem();
    provenance.cpu = processorName();
    provenance.cores = std::thread::hardware_concurrency();
    provenance.commandLine = commandLine;
    return provenance;
}

std::string utcText(std::chrono::system_clock::time_point time) {
    const auto day = std::chrono::floor<std::chrono::days>(time);
    const std::chrono::year_month_day date(day);
    const std::chrono::hh_mm_ss clock(std::chrono::floor<std::chrono::seconds>(time - day));
    std::array<char, 40> text{};
    std::snprintf(text.data(), text.size(), "%04d-%02u-%02uT%02d:%02d:%02dZ",
                  static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                  static_cast<unsigned>(date.day()), static_cast<int>(clock.hours().count()),
                  static_cast<int>(clock.minutes().count()),
                  static_cast<int>(clock.seconds().count()));
    return text.data();
}

}  // namespace hashphase::demos
