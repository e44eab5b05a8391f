// SPDX-License-Identifier: Zlib

// Counts bits without an instruction for it. See kernels.inl.

// After H. S. Warren, "Hacker's Delight", 5-1.
inline std::uint32_t bitCount(std::uint64_t word) {
    word -= (word >> 1) & 0x5555555555555555U;
    word = (word & 0x3333333333333333U) + ((word >> 2) & 0x3333333333333333U);
    word = (word + (word >> 4)) & 0x0f0f0f0f0f0f0f0fU;
    return static_cast<std::uint32_t>((word * 0x0101010101010101U) >> 56);
}
