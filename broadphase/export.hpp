// SPDX-License-Identifier: Zlib
#pragma once

// Macros that mark the exported symbols of a shared library; all other symbols are hidden. Each library has its own
// export.hpp with its own macros. CMake and pkg-config set HASHPHASE_SHARED to 1 for shared libraries. CMake defines
// hashphase_<component>_EXPORTS while it compiles a library.
//
// HASHPHASE_<COMPONENT>_EXPORT           marks an exported function or class
// HASHPHASE_<COMPONENT>_TEMPLATE_EXPORT  marks a class template that a library instantiates
// HASHPHASE_INSTANCE_EXPORT              marks the instantiation of an exported class template, for MSVC
// HASHPHASE_ONE_FOR_ALL                  marks a header's thread_local variable that all libraries of a program share
// HASHPHASE_SHARES_VARIABLES             1 if libraries can share a thread_local variable; 0 with DLLs, where a
//                                        function of one library returns the variable
// HASHPHASE_ASK_LINKER_FOR(x)            MSVC only: linking fails unless the grid's library defines the const char
//                                        hashphase::x, even if no code uses x

// Compilers in C++17 mode or older stop here: public headers include this header before their C++20 code.
#if defined(_MSVC_LANG) ? _MSVC_LANG <= 201703L : __cplusplus <= 201703L
#error "hashphase needs C++20. Compile with -std=c++20 or /std:c++20, or ask CMake for cxx_std_20."
#endif

// Sets undefined macros to 0, so that every #if tests a defined macro.
#ifndef HASHPHASE_SHARED
#define HASHPHASE_SHARED 0
#endif
#ifndef HASHPHASE_USE_SCALAR
#define HASHPHASE_USE_SCALAR 0
#endif

#if HASHPHASE_SHARED && defined(_WIN32)
#define HASHPHASE_SYMBOL_EXPORT __declspec(dllexport)
#define HASHPHASE_SYMBOL_IMPORT __declspec(dllimport)
#define HASHPHASE_SHARES_VARIABLES 0
#elif HASHPHASE_SHARED
#define HASHPHASE_SYMBOL_EXPORT __attribute__((visibility("default")))
#define HASHPHASE_SYMBOL_IMPORT __attribute__((visibility("default")))
#define HASHPHASE_ONE_FOR_ALL __attribute__((visibility("default")))
#define HASHPHASE_SHARES_VARIABLES 1
#else
#define HASHPHASE_SYMBOL_EXPORT
#define HASHPHASE_SYMBOL_IMPORT
#define HASHPHASE_ONE_FOR_ALL
#define HASHPHASE_SHARES_VARIABLES 1
#endif
#if HASHPHASE_SHARED && defined(_MSC_VER)
#define HASHPHASE_SYMBOL_TEMPLATE_EXPORT
#define HASHPHASE_INSTANCE_EXPORT __declspec(dllexport)
#else
#define HASHPHASE_SYMBOL_TEMPLATE_EXPORT HASHPHASE_SYMBOL_EXPORT
#define HASHPHASE_INSTANCE_EXPORT
#endif

#ifdef hashphase_broadphase_EXPORTS
#define HASHPHASE_BROADPHASE_EXPORT HASHPHASE_SYMBOL_EXPORT
#define HASHPHASE_BROADPHASE_TEMPLATE_EXPORT HASHPHASE_SYMBOL_TEMPLATE_EXPORT
#else
#define HASHPHASE_BROADPHASE_EXPORT HASHPHASE_SYMBOL_IMPORT
#define HASHPHASE_BROADPHASE_TEMPLATE_EXPORT HASHPHASE_SYMBOL_IMPORT
#endif

#if !defined(_MSC_VER)
#define HASHPHASE_ASK_LINKER_FOR(name)
#else
#if HASHPHASE_SHARED && !defined(hashphase_broadphase_EXPORTS)
#define HASHPHASE_LINKER_NAME(name) "__imp_?" name "@hashphase@@3DB"
#else
#define HASHPHASE_LINKER_NAME(name) "?" name "@hashphase@@3DB"
#endif
#define HASHPHASE_ASK_LINKER_BY_NAME(name)                                                         \
    __pragma(comment(linker, "/include:" HASHPHASE_LINKER_NAME(#name)))
#define HASHPHASE_ASK_LINKER_FOR(name) HASHPHASE_ASK_LINKER_BY_NAME(name)
#endif
