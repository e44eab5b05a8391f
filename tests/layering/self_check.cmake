# SPDX-License-Identifier: Zlib
#
# cmake -DSCRATCH=<folder> -P self_check.cmake
#
# Holds check_layering.cmake against small trees made in SCRATCH: one that keeps every rule, and one
# breach of each rule, which must be named by file, line and rule.

cmake_minimum_required(VERSION 3.22)

function(run_check)
    execute_process(
        COMMAND ${CMAKE_COMMAND} -DROOT=${SCRATCH} -P ${CMAKE_CURRENT_LIST_DIR}/check_layering.cmake
        RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
    set(status ${status} PARENT_SCOPE)
    set(output "${output}" PARENT_SCOPE)
endfunction()

function(make_good_tree)
    file(REMOVE_RECURSE ${SCRATCH})
    file(WRITE ${SCRATCH}/broadphase/grid.hpp
         "#include <Eigen/Geometry>\n#include <vector>\n"
         "  # include <broadphase/hash/table.hpp>// x\n")
    file(WRITE ${SCRATCH}/broadphase/core/compiler.hpp "#if defined(_MSC_VER)\n#include <intrin.h>\n#endif\n")
    file(WRITE ${SCRATCH}/broadphase/simd/kernel.hpp "#include <emmintrin.h>\n")
    file(WRITE ${SCRATCH}/integration/bullet/broadphase.hpp
         "#include <BulletCollision/BroadphaseCollision/btBroadphaseInterface.h>\n"
         "#include <LinearMath/btVector3.h>\n#include <btBulletCollisionCommon.h>\n"
         "#include <broadphase/grid.hpp>\n#include <integration/bullet/pair_cache.hpp>\n")
    file(WRITE ${SCRATCH}/broadphase/nearest.hpp "#include <integration/ai/nearest.hpp>\n")
    file(WRITE ${SCRATCH}/integration/ai/sight.cpp "#include <integration/ai/nearest.hpp>\n")
    file(WRITE ${SCRATCH}/integration/camera/view.cpp
         "#include <integration/camera/camera.hpp>\n#include <broadphase/regions.hpp>\n")
    file(WRITE ${SCRATCH}/integration/culling/culler.hpp "#include <integration/camera/frustum.hpp>\n")
    file(WRITE ${SCRATCH}/integration/picking/pick.cpp
         "#include <integration/picking/pick.hpp>\n#include <integration/camera/camera.hpp>\n"
         "#include <broadphase/core/limits.hpp>\n")
    file(WRITE ${SCRATCH}/integration/tbb/loops.hpp
         "#include <tbb/parallel_for.h>\n#include <broadphase/parallel_for.hpp>\n")
    file(WRITE ${SCRATCH}/integration/distributed/partition.hpp "#include <broadphase/aabb.hpp>\n")
    file(WRITE ${SCRATCH}/integration/mpi/exchange.hpp
         "#include <integration/distributed/partition.hpp>\n#include <mpi.h>\n")
    file(WRITE ${SCRATCH}/integration/effects/plan.cpp
         "#include <integration/picking/pick.hpp>\n#include <cstdint>\n")
    file(WRITE ${SCRATCH}/demos/main.cpp "#include \"scene.hpp\"\n#include <CLI/CLI.hpp>\n")
    file(WRITE ${SCRATCH}/tests/grid.cpp "#include <gtest/gtest.h>\n#include <demos/scene.hpp>\n#if HASHPHASE_SHARED\n#endif\n")
endfunction()

# One breach: `text` in `file` must be refused at `line` with a rule that matches `rule`.
function(expect_breach file line rule text)
    make_good_tree()
    file(APPEND ${SCRATCH}/${file} "${text}")
    run_check()
    if(status EQUAL 0)
        message(FATAL_ERROR "Not noticed in ${file}: ${text}")
    elseif(NOT output MATCHES "${file}:${line}: #include [^\n]*: [^\n]*${rule}")
        message(FATAL_ERROR "${file}:${line} and \"${rule}\" are not named for ${text}:\n${output}")
    endif()
endfunction()

# A condition in a file that is to know no platform.
function(expect_condition_refused file condition)
    make_good_tree()
    file(APPEND ${SCRATCH}/${file} "${condition}\n#endif\n")
    run_check()
    if(status EQUAL 0 OR NOT output MATCHES "${file}: [^\n]*told apart in broadphase/core/compiler")
        message(FATAL_ERROR "Not noticed in ${file}: ${condition}\n${output}")
    endif()
endfunction()

make_good_tree()
run_check()
if(NOT status EQUAL 0)
    message(FATAL_ERROR "A tree that keeps every rule was refused:\n${output}")
endif()

expect_breach(integration/distributed/partition.hpp 2 "integration/distributed/ includes only itself"
              "#include <mpi.h>\n")
expect_breach(integration/mpi/exchange.hpp 3 "integration/mpi/ includes only itself"
              "#include <integration/ai/sight.hpp>\n")
set(core "broadphase/ includes only itself")
expect_breach(broadphase/grid.hpp 4 "${core}" "#include <integration/picking/pick.hpp>\n")
expect_breach(broadphase/grid.hpp 4 "${core}" "#include <btBulletCollisionCommon.h>\n")
expect_breach(broadphase/grid.hpp 5 "${core}" "\n#include <LinearMath/btVector3.h>\n")
expect_breach(broadphase/grid.hpp 4 "${core}" "#include <emmintrin.h>\n")
expect_breach(broadphase/simd/deep.cpp 2 "broadphase/simd/ includes only broadphase/"
              "// one\n#include <demos/scene.hpp>\n")
expect_breach(broadphase/grid.hpp 4 "${core}" "#include <broadphase/../demos/scene.hpp>\n")
expect_breach(broadphase/grid.hpp 4 "in angle brackets" "#include \"hash/table.hpp\"\n")
set(client "integration/picking/ includes only itself")
expect_breach(integration/picking/pick.cpp 4 "${client}" "#include <integration/bullet/b.hpp>\n")
expect_breach(integration/picking/pick.cpp 4 "${client}" "#include <btBulletCollisionCommon.h>\n")
expect_breach(integration/picking/pick.cpp 4 "${client}" "#include <broadphase/hash/table.hpp>\n")
foreach(other IN ITEMS ai bullet effects picking)
    expect_breach(integration/culling/culler.hpp 2 "integration/culling/ includes only itself"
                  "#include <integration/${other}/other.hpp>\n")
    expect_breach(integration/camera/view.cpp 3 "integration/camera/ includes only itself"
                  "#include <integration/${other}/other.hpp>\n")
endforeach()
set(ai "integration/ai/ includes only itself")
expect_breach(integration/ai/sight.cpp 2 "${ai}" "#include <integration/camera/frustum.hpp>\n")
expect_breach(integration/ai/sight.cpp 2 "has moved" "#include <broadphase/frustum.hpp>\n")
expect_breach(integration/picking/pick.cpp 4 "has moved" "#include <integration/picking/view.hpp>\n")
expect_breach(broadphase/nearest.hpp 2 "what has moved" "#include <integration/ai/sight.hpp>\n")
expect_breach(broadphase/nearest.hpp 2 "what has moved" "#include <broadphase/grid.hpp>\n")
expect_breach(broadphase/grid.hpp 4 "has moved" "#include <broadphase/nearest.hpp>\n")
expect_breach(integration/bullet/broadphase.hpp 6 "integration/bullet/ includes only itself"
              "#include <broadphase/store/population.hpp>\n")
expect_breach(integration/bullet/broadphase.hpp 6 "integration/bullet/ includes only itself"
              "#include <integration/camera/camera.hpp>\n")
expect_breach(integration/picking/pick.cpp 4 "${client}" "#include <tests/support/oracle.hpp>\n")
expect_breach(integration/bullet/broadphase.hpp 6 "integration/bullet/ includes only itself"
              "#include <integration/picking/pick.hpp>\n")
expect_breach(integration/effects/plan.cpp 3 "integration/effects/ includes only the clients"
              "#include <LinearMath/btVector3.h>\n")
expect_breach(integration/package/consumer.cpp 1 "integration/package/ includes only what users"
              "#include <demos/scene.hpp>\n")
expect_breach(integration/stray.hpp 1 "only a folder for each client" "#include <vector>\n")

expect_condition_refused(broadphase/grid.hpp "#if defined(__GNUC__)")
expect_condition_refused(integration/ai/sight.cpp "  #  ifdef _WIN32")
expect_condition_refused(demos/main.cpp "#elif !defined(__x86_64__)")
expect_condition_refused(tests/grid.cpp "#if __has_feature(address_sanitizer)")

make_good_tree()
file(WRITE ${SCRATCH}/broadphase/pairs.hpp
     "template <class Scalar>\nclass HASHPHASE_BROADPHASE_TEMPLATE_EXPORT Pairs {};\n#include <vector>\n")
run_check()
if(NOT status EQUAL 0)
    message(FATAL_ERROR "An exported class template was refused:\n${output}")
endif()
file(APPEND ${SCRATCH}/broadphase/grid.hpp "template <class Scalar>\nclass Pairs;\n")
run_check()
if(status EQUAL 0 OR NOT output MATCHES "broadphase/grid.hpp: [^\n]*without the macro that exports Pairs")
    message(FATAL_ERROR "A declaration that does not export was not noticed:\n${output}")
endif()

file(REMOVE_RECURSE ${SCRATCH})
file(MAKE_DIRECTORY ${SCRATCH}/broadphase)
run_check()
if(status EQUAL 0)
    message(FATAL_ERROR "A tree without sources must not pass as checked.")
endif()
