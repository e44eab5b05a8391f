// SPDX-License-Identifier: Zlib
#pragma once

// Macros for shared libraries: they mark what a library offers; all else is hidden. Each library has a header
// like this, with a macro of its own, because DLLs import functions of others and export their own.
// HASHPHASE_SHARED is 1 where the libraries are shared ones; CMake and pkg-config set it for their users.
// hashphase_<component>_EXPORTS is set where that library itself is compiled.
//
// HASHPHASE_<COMPONENT>_TEMPLATE_EXPORT  the same of a class template that a library instantiates for all, and
//                              HASHPHASE_INSTANCE_EXPORT where it does: MSVC takes a class template that
//                              is exported for one that each source instantiates
// HASHPHASE_ONE_FOR_ALL        before a thread_local variable in a header that all libraries of a program share
// HASHPHASE_SHARES_VARIABLES   1 where they can. DLLs call a function of the one that has it.
// HASHPHASE_ASK_LINKER_FOR(x)  asks for the variable hashphase::x, a const char of the grid's library, where
//                              the compiler leaves out what nothing uses: it does not link without

// Every public header includes this one before any code that older standards reject.
#if defined(_MSVC_LANG) ? _MSVC_LANG <= 201703L : __cplusplus <= 201703L
#error "hashphase needs C++20: -std=c++20, /std:c++20, or target_compile_features(... cxx_std_20)."
#endif

// Macros that are not set are 0, so that every #if asks about a defined macro.
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
