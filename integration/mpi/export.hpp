// SPDX-License-Identifier: Zlib
#pragma once

// What the shared library hashphase_mpi offers: see broadphase/export.hpp.

#include <broadphase/export.hpp>

#ifdef hashphase_mpi_EXPORTS
#define HASHPHASE_MPI_EXPORT HASHPHASE_SYMBOL_EXPORT
#define HASHPHASE_MPI_TEMPLATE_EXPORT HASHPHASE_SYMBOL_TEMPLATE_EXPORT
#else
#define HASHPHASE_MPI_EXPORT HASHPHASE_SYMBOL_IMPORT
#define HASHPHASE_MPI_TEMPLATE_EXPORT HASHPHASE_SYMBOL_IMPORT
#endif
