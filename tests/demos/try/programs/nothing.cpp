// SPDX-License-Identifier: Zlib

int main() {}
