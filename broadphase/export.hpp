// SPDX-License-Identifier: Zlib
#pragma once

// What a shared library of hashphase offers, all else being hidden. Each library has such a header,
// with a macro of its own: to DLLs it matters whose functions are meant. HASHPHASE_SHARED is 1 where
// the libraries are shared ones, which their users are told by CMake and pkg-config, and
// hashphase_<component>_EXPORTS is set where that library itself is compiled.
//
// HASHPHASE_ONE_FOR_ALL stands before a variable of a thread in a header, of which all libraries of a
// program are to see the same one. DLLs cannot share it, and have one each.

// Every public header leads here before anything that older compilers stumble over.
#if defined(_MSVC_LANG) ? _MSVC_LANG <= 201703L : __cplusplus <= 201703L
#error "hashphase needs C++20: -std=c++20, /std:c++20, or target_compile_features(... cxx_std_20)."
#endif

// What is not set is 0, so that whoever asks the preprocessor asks about something that is defined.
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
