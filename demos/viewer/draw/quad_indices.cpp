// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/quad_indices.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace hashphase::demos {

namespace {

constexpr std::array<std::uint32_t, 6> kTriangles{0, 1, 2, 2, 1, 3};

}  // namespace

void QuadIndices::draw(std::size_t first, std::size_t count) {
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer_.name());
    if (first + count > capacity_) {
        grow(first + count);
    }
    const std::size_t offset = first * kTriangles.size() * sizeof(std::uint32_t);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(count * kTriangles.size()), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(offset));
}

void QuadIndices::grow(std::size_t quadCount) {
    capacity_ = quadCount + quadCount / 2;
    std::vector<std::uint32_t> indices;
    indices.reserve(capacity_ * kTriangles.size());
    for (std::uint32_t quad = 0; quad < capacity_; ++quad) {
        for (const std::uint32_t corner : kTriangles) {
            indices.push_back(static_cast<std::uint32_t>(kCorners) * quad + corner);
        }
    }
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(indices.size() * sizeof(std::uint32_t)), indices.data(),
                 GL_STATIC_DRAW);
}

}  // namespace hashphase::demos
