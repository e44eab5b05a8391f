// SPDX-License-Identifier: Zlib
#pragma once

// The standard headers, when there are none of MSVC's: LLVM's, over the C headers of MinGW. They are to take this
// for MinGW's GCC; what comes after them is compiled as MSVC would.

#undef _MSC_VER
#undef _MSVC_LANG
#undef _MSC_EXTENSIONS
#define __GNUC__ 12
#define __GNUC_MINOR__ 0
#define __MINGW32__ 1
#define __MINGW64__ 1
#define __declspec(word) __attribute__((word))

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cassert>
#include <cfloat>
#include <charconv>
#include <chrono>
#include <climits>
#include <cmath>
#include <complex>
#include <concepts>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <initializer_list>
#include <iomanip>
#include <iostream>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>
#include <numeric>
#include <optional>
#include <ranges>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <tuple>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

// <intrin.h> declares another one.
#define _setjmp setjmp_of_mingw
#include <setjmp.h>
#undef _setjmp

#undef __GNUC__
#undef __GNUC_MINOR__
#undef __MINGW32__
#undef __MINGW64__
#undef __declspec
#define _MSC_VER 1940
#define _MSVC_LANG 202002L
