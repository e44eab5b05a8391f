# SPDX-License-Identifier: Zlib
# shellcheck shell=bash
#
# WebAssembly: Clang and WASI's C library are packages; the C++ library with exceptions, GoogleTest, GMP and
# Bullet are compiled from source packages, once, into build/check-web/prefix. As by Emscripten there are exceptions
# (-fwasm-exceptions), a file system, and no threads.

# shellcheck source=tests/checks/sources.sh
source "${root:?}/tests/checks/sources.sh"

tools+=(clang++-19:clang-19 wasm-ld-19:lld-19 llvm-ar-19:llvm-19 node:nodejs make:make)
libraries+=(wasi-libc libclang-rt-19-dev-wasm32)
web=$root/build/check-web
web_prefix=$web/prefix
web_files=$root/tests/checks/web

# web_once <name> <command>...: runs it where it has not yet ended well, with these files.
web_once() {
    if [[ -f $web/$1.done && ! $(find "$web_files" "${web_files}.sh" -type f ! -name run.mjs -newer "$web/$1.done") ]]; then
        return
    fi
    say "building $1 for WebAssembly"
    rm -rf "${web:?}/$1"
    mkdir -p "$web/$1"
    "${@:2}" >&2
    touch "$web/$1.done"
}

web_libcxx() {
    local sources
    sources=$(source_package llvm-toolchain-19)
    local language flags=()
    for language in C CXX ASM; do
        flags+=("-DCMAKE_${language}_COMPILER_TARGET=wasm32-wasi" "-DCMAKE_${language}_COMPILER_WORKS=ON"
            "-DCMAKE_${language}_FLAGS=-fwasm-exceptions -isystem $web_files")
    done
    cmake -S "$sources/runtimes" -B "$web/libcxx" -G Ninja -DCMAKE_BUILD_TYPE=Release \
        -DCMAKE_SYSTEM_NAME=Generic -DCMAKE_C_COMPILER=clang-19 -DCMAKE_CXX_COMPILER=clang++-19 \
        -DCMAKE_AR="$(command -v llvm-ar-19)" -DCMAKE_RANLIB="$(command -v llvm-ranlib-19)" \
        "${flags[@]}" -DCMAKE_INSTALL_PREFIX="$web_prefix" "-DLLVM_ENABLE_RUNTIMES=libcxxabi;libcxx" \
        -DLIBCXX_ENABLE_SHARED=OFF -DLIBCXX_USE_COMPILER_RT=ON -DLIBCXX_HAS_MUSL_LIBC=ON \
        -DLIBCXX_HAS_EXTERNAL_THREAD_API=ON -DLIBCXX_INCLUDE_TESTS=OFF \
        -DLIBCXX_INCLUDE_BENCHMARKS=OFF -DLIBCXX_CXX_ABI=libcxxabi \
        -DLIBCXXABI_ENABLE_SHARED=OFF -DLIBCXXABI_USE_COMPILER_RT=ON \
        -DLIBCXXABI_HAS_EXTERNAL_THREAD_API=ON -DLIBCXXABI_USE_LLVM_UNWINDER=OFF \
        -DLIBCXXABI_INCLUDE_TESTS=OFF
    ninja -C "$web/libcxx" install-cxx install-cxxabi
    # Of the unwinder, all that WebAssembly wants.
    clang-19 --target=wasm32-wasi -O2 -DNDEBUG -fwasm-exceptions -fdeclspec -D_LIBUNWIND_HIDE_SYMBOLS \
        -I "$sources/libunwind/include" -c "$sources/libunwind/src/Unwind-wasm.c" -o "$web/libcxx/unwind.o"
    llvm-ar-19 rcs "$web_prefix/lib/libunwind.a" "$web/libcxx/unwind.o"
}

# web_cmake <folder> <sources> <option>...
web_cmake() {
    PKG_CONFIG_LIBDIR=$web_prefix/lib/pkgconfig cmake -S "$2" -B "$web/$1" -G Ninja \
        -DCMAKE_TOOLCHAIN_FILE="$web_files/toolchain.cmake" -DHASHPHASE_WEB="$web_prefix" \
        -DCMAKE_INSTALL_PREFIX="$web_prefix" "${@:3}" >&2
}

web_googletest() {
    web_cmake googletest "$(source_package googletest)" -DCMAKE_BUILD_TYPE=Release -DBUILD_GMOCK=OFF
    ninja -C "$web/googletest" install
}

web_bullet() {
    web_cmake bullet "$(source_package bullet)" -DCMAKE_BUILD_TYPE=Release -DINSTALL_LIBS=ON \
        -DBUILD_{UNIT_TESTS,CPU_DEMOS,BULLET2_DEMOS,OPENGL3_DEMOS,EXTRAS,PYBULLET,BULLET3,EGL,ENET,CLSOCKET}=OFF
    ninja -C "$web/bullet" install
}

# Debian's sources have no doc/; WASI has no processes to be killed.
web_gmp() (
    sources=$(source_package gmp)
    mkdir -p "$sources/doc"
    printf 'all install:\n' >"$sources/doc/Makefile.in"
    cd "$web/gmp" || exit
    "$sources/configure" --host=none --disable-assembly --disable-shared --enable-cxx \
        --prefix="$web_prefix" CC_FOR_BUILD=cc AR=llvm-ar-19 RANLIB=llvm-ranlib-19 NM=llvm-nm-19 CFLAGS=-O1 \
        CC="clang-19 --target=wasm32-wasi -fwasm-exceptions" LDFLAGS="-L$web_prefix/lib" \
        CXX="clang++-19 --target=wasm32-wasi -fwasm-exceptions -nostdinc++ -isystem $web_prefix/include/c++/v1 -isystem $web_files -L$web_prefix/lib" \
        LIBS="-lc++ -lc++abi -lunwind"
    make -j"$(nproc)" SUBDIRS="mpn mpz mpq mpf printf scanf rand cxx" \
        CPPFLAGS="-D_WASI_EMULATED_SIGNAL '-Dkill(process,signal)=raise(signal)'" install
)

# web_build <variant> <compiler flags>: the libraries and the tests of `programs`.
web_build() {
    say "building build/check-web/$1"
    CXXFLAGS=$2 web_cmake "$1" "$root" -DCMAKE_BUILD_TYPE=RelWithDebInfo -DHASHPHASE_ASSERTS=ON \
        -DHASHPHASE_BUILD_DEMOS=OFF -DHASHPHASE_BUILD_BENCHMARKS=OFF -DHASHPHASE_QUICK_BUILD=ON \
        -DCMAKE_GTEST_DISCOVER_TESTS_DISCOVERY_MODE=PRE_TEST
    cmake --build "$web/$1" --target "${programs[@]/%/-tests}" >&2
}

check_web() {
    if [[ $root == *' '* ]]; then
        say "the path of the repository has spaces, which configuring GMP does not support: move it"
        return 1
    fi
    web_once libcxx web_libcxx
    web_once googletest web_googletest
    web_once gmp web_gmp
    web_once bullet web_bullet
    # Nothing but headers.
    mkdir -p "$web_prefix/include" "$web_prefix/share"
    ln -sfn /usr/include/eigen3 "$web_prefix/include/eigen3"
    ln -sfn /usr/share/eigen3 "$web_prefix/share/eigen3"
    # The second has the scalar kernels as well, and compares them.
    programs=(golden)
    web_build scalar ""
    run_programs "$web/scalar" node --no-warnings --single-threaded "$web_files/run.mjs"
    programs=(golden broadphase bullet clients property)
    web_build simd128 -msimd128
    run_programs "$web/simd128" node --no-warnings --single-threaded "$web_files/run.mjs"
}
