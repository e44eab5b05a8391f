// SPDX-License-Identifier: Zlib
#pragma once

// Export macros of the library hashphase_mpi: see broadphase/export.hpp.

#include <broadphase/export.hpp>

#ifdef hashphase_mpi_EXPORTS
#define HASHPHASE_MPI_EXPORT HASHPHASE_SYMBOL_EXPORT
#define HASHPHASE_MPI_TEMPLATE_EXPORT HASHPHASE_SYMBOL_TEMPLATE_EXPORT
#else
#define HASHPHASE_MPI_EXPORT HASHPHASE_SYMBOL_IMPORT
#define HASHPHASE_MPI_TEMPLATE_EXPORT HASHPHASE_SYMBOL_IMPORT
#endif
