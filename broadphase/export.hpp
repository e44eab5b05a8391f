// SPDX-License-Identifier: Zlib
#pragma once

// Macros for shared libraries: they mark what a library offers; all else is hidden. Each library has a header
// like this, with a macro of its own, because DLLs import functions of others and export their own.
// HASHPHASE_SHARED is 1 where the libraries are shared ones; CMake and pkg-config set it for their users.
// hashphase_<component>_EXPORTS is set where that library itself is compiled.
//
// HASHPHASE_ONE_FOR_ALL stands before a thread_local variable in a header that all libraries of a program
// share. DLLs cannot share it, and have one each.

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
#define HASHPHASE_ONE_FOR_ALL
#elif HASHPHASE_SHARED
#define HASHPHASE_SYMBOL_EXPORT __attribute__((visibility("default")))
#define HASHPHASE_SYMBOL_IMPORT __attribute__((visibility("default")))
#define HASHPHASE_ONE_FOR_ALL __attribute__((visibility("default")))
#else
#define HASHPHASE_SYMBOL_EXPORT
#define HASHPHASE_SYMBOL_IMPORT
#define HASHPHASE_ONE_FOR_ALL
#endif

#ifdef hashphase_broadphase_EXPORTS
#define HASHPHASE_BROADPHASE_EXPORT HASHPHASE_SYMBOL_EXPORT
#else
#define HASHPHASE_BROADPHASE_EXPORT HASHPHASE_SYMBOL_IMPORT
#endif
