// SPDX-License-Identifier: Zlib

// Writes hits without instructions for them. See kernels.inl.

inline std::uint32_t* writeHits(std::uint64_t word, const std::uint32_t* numbers,
                                std::uint32_t* next) {
    for (; word != 0; word &= word - 1) {
        *next++ = numbers[lowestBit(word)];
    }
    return next;
}
