# SPDX-License-Identifier: Zlib
#
# Makes hashphase::imported-eigen of Eigen3::Eigen, whether that is imported or a part of the same build,
# whose targets cannot be named in what is installed. Any version since 3.4 will do, also 5 and later.
# Used by the build and by the installed package alike, after either has looked for Eigen.

if(NOT TARGET hashphase::imported-eigen)
    add_library(hashphase::imported-eigen INTERFACE IMPORTED)
    target_link_libraries(hashphase::imported-eigen INTERFACE Eigen3::Eigen)
endif()
