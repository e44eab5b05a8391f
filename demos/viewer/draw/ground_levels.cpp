// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/ground_levels.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hashphase::demos {

namespace {

constexpr float kLargestError = 0.7F;  // of a level, on the screen [pixels]
constexpr float kLargestEdge = 20;     // of its squares, because light is that of corners [pixels]
constexpr auto kNoVertex = std::numeric_limits<std::uint32_t>::max();

std::vector<float> sortedUnique(const std::vector<GroundVertex>& vertices, int axis) {
    std::vector<float> values;
    values.reserve(vertices.size());
    for (const GroundVertex& vertex : vertices) {
        values.push_back(vertex.position[axis]);
    }
    std::ranges::sort(values);
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return values;
}

int placeOf(float value, const std::vector<float>& sorted) {
    return static_cast<int>(std::ranges::lower_bound(sorted, value) - sorted.begin());
}

/// Whether some of the box may be on the screen. Some boxes beside a corner of the screen count
/// too.
bool isOnScreen(const Eigen::AlignedBox3f& box, const View& view) {
    const Vector3<float> centre = box.center() - view.eye;
    const Vector3<float> halfSizes = box.sizes() / 2;
    const auto isOutside = [&](const Vector3<float>& inwards) {
        return inwards.dot(centre) + inwards.cwiseAbs().dot(halfSizes) < 0;
    };
    const Vector3<float> across = view.tangents.x() * view.forward;
    const Vector3<float> upwards = view.tangents.y() * view.forward;
    return !isOutside(across + view.right) && !isOutside(across - view.right) &&
           !isOutside(upwards + view.up) && !isOutside(upwards - view.up) &&
           !isOutside(view.forward);
}

void addTriangle(std::vector<std::uint32_t>& indices, std::uint32_t a, std::uint32_t b,
                 std::uint32_t c) {
    if (a != b && b != c && c != a) {
        indices.insert(indices.end(), {a, b, c});
    }
}

}  // namespace

GroundLevels::GroundLevels(const GroundMesh& mesh) {
    if (mesh.indices.empty() || !readLattice(mesh) || !readTriangles(mesh)) {
        return;
    }
    const int lastColumn = static_cast<int>(columns_.size()) - 1;
    const int lastRow = static_cast<int>(rows_.size()) - 1;
    for (int row = 0; row < lastRow; row += kPatchSize) {
        for (int column = 0; column < lastColumn; column += kPatchSize) {
            addPatch(mesh, column, row);
        }
    }
    patchColumns_ = (lastColumn + kPatchSize - 1) / kPatchSize;
}

bool GroundLevels::readLattice(const GroundMesh& mesh) {
    columns_ = sortedUnique(mesh.vertices, 0);
    rows_ = sortedUnique(mesh.vertices, 2);
    if (columns_.size() * rows_.size() != mesh.vertices.size()) {
        return false;
    }
    vertices_.assign(mesh.vertices.size(), kNoVertex);
    for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
        const Vector3<float>& position = mesh.vertices[i].position;
        const int column = placeOf(position.x(), columns_), row = placeOf(position.z(), rows_);
        vertices_[static_cast<std::size_t>(row) * columns_.size() + column] = i;
    }
    return std::ranges::count(vertices_, kNoVertex) == 0;
}

bool GroundLevels::readTriangles(const GroundMesh& mesh) {
    const std::size_t squareColumns = columns_.size() - 1;
    const std::size_t squareCount = squareColumns * (rows_.size() - 1);
    if (mesh.indices.size() != 6 * squareCount) {
        return false;
    }
    risesWithX_.assign(squareCount, false);
    std::vector<std::uint8_t> triangles(squareCount);  // in each square
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        std::array<int, 3> columns{}, rows{};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const Vector3<float>& position = mesh.vertices[mesh.indices[i + corner]].position;
            columns[corner] = placeOf(position.x(), columns_);
            rows[corner] = placeOf(position.z(), rows_);
        }
        const auto [firstColumn, lastColumn] = std::ranges::minmax(columns);
        const auto [firstRow, lastRow] = std::ranges::minmax(rows);
        if (lastColumn != firstColumn + 1 || lastRow != firstRow + 1) {
            return false;
        }
        // Three of a square's corners have the missing one's column once, and its row once.
        const std::size_t square = static_cast<std::size_t>(firstRow) * squareColumns +
                                   static_cast<std::size_t>(firstColumn);
        const bool missesLastColumn = std::ranges::count(columns, lastColumn) == 1;
        const bool missesLastRow = std::ranges::count(rows, lastRow) == 1;
        risesWithX_[square] = missesLastColumn != missesLastRow;
        if (++triangles[square] > 2) {
            return false;
        }
    }
    return true;
}

void GroundLevels::addPatch(const GroundMesh& mesh, int column, int row) {
    Patch patch{.column = column, .row = row, .bounds = {}};
    const int lastColumn = std::min(column + kPatchSize, static_cast<int>(columns_.size()) - 1);
    const int lastRow = std::min(row + kPatchSize, static_cast<int>(rows_.size()) - 1);
    for (int k = row; k <= lastRow; ++k) {
        for (int i = column; i <= lastColumn; ++i) {
            patch.bounds.extend(mesh.vertices[vertexAt(i, k)].position);
        }
    }
    for (int level = 1; level < kLevelCount; ++level) {
        measure(mesh, patch, level);
    }
    patches_.push_back(patch);
}

void GroundLevels::measure(const GroundMesh& mesh, Patch& patch, int level) const {
    const int stride = 1 << level;
    const int lastColumn = static_cast<int>(columns_.size()) - 1;
    const int lastRow = static_cast<int>(rows_.size()) - 1;
    const auto heightAt = [&](int column, int row) {
        return mesh.vertices[vertexAt(column, row)].position.y();
    };
    float error = 0, edge = 0;
    for (int k = patch.row; k <= std::min(patch.row + kPatchSize, lastRow); ++k) {
        for (int i = patch.column; i <= std::min(patch.column + kPatchSize, lastColumn); ++i) {
            // The coarse square around the point, and where in it the point is.
            const int i0 = std::min(i, lastColumn - 1) / stride * stride;
            const int k0 = std::min(k, lastRow - 1) / stride * stride;
            const int i1 = std::min(i0 + stride, lastColumn), k1 = std::min(k0 + stride, lastRow);
            const float width = columns_[i1] - columns_[i0], depth = rows_[k1] - rows_[k0];
            const float s = (columns_[i] - columns_[i0]) / width;
            const float t = (rows_[k] - rows_[k0]) / depth;
            const float height = (1 - t) * ((1 - s) * heightAt(i0, k0) + s * heightAt(i1, k0)) +
                                 t * ((1 - s) * heightAt(i0, k1) + s * heightAt(i1, k1));
            error = std::max(error, std::abs(height - heightAt(i, k)));
            edge = std::max({edge, width, depth});
        }
    }
    patch.errors[level] = error;
    patch.edges[level] = edge;
}

void GroundLevels::choose(const View& view, std::vector<std::uint32_t>& indices) {
    for (Patch& patch : patches_) {
        patch.stride = strideFor(patch, view);
    }
    indices.clear();
    for (int i = 0; i < static_cast<int>(patches_.size()); ++i) {
        if (isOnScreen(patches_[i].bounds, view)) {
            emit(i % patchColumns_, i / patchColumns_, indices);
        }
    }
}

int GroundLevels::strideFor(const Patch& patch, const View& view) const {
    const float distance = patch.bounds.exteriorDistance(view.eye);
    for (int level = kLevelCount - 1; level > 0; --level) {
        if (view.focalLength * patch.errors[level] <= kLargestError * distance &&
            view.focalLength * patch.edges[level] <= kLargestEdge * distance) {
            return 1 << level;
        }
    }
    return 1;
}

int GroundLevels::strideAt(int patchColumn, int patchRow) const {
    const int patchRows = static_cast<int>(patches_.size()) / patchColumns_;
    if (patchColumn < 0 || patchRow < 0 || patchColumn >= patchColumns_ || patchRow >= patchRows) {
        return 1;
    }
    return patches_[static_cast<std::size_t>(patchRow) * patchColumns_ + patchColumn].stride;
}

void GroundLevels::emit(int patchColumn, int patchRow, std::vector<std::uint32_t>& indices) const {
    const Patch& patch = patches_[static_cast<std::size_t>(patchRow) * patchColumns_ + patchColumn];
    const int lastColumn =
        std::min(patch.column + kPatchSize, static_cast<int>(columns_.size()) - 1);
    const int lastRow = std::min(patch.row + kPatchSize, static_cast<int>(rows_.size()) - 1);
    const int left = strideAt(patchColumn - 1, patchRow);
    const int right = strideAt(patchColumn + 1, patchRow);
    const int above = strideAt(patchColumn, patchRow - 1);
    const int below = strideAt(patchColumn, patchRow + 1);

    // A point on the border with a coarser patch goes to the last one before it that is there too.
    const auto vertex = [&](int column, int row) {
        const int side = column == patch.column ? left : column == lastColumn ? right : 1;
        const int end = row == patch.row ? above : row == lastRow ? below : 1;
        const int i = column == lastColumn ? column : column / end * end;
        const int k = row == lastRow ? row : row / side * side;
        return vertexAt(end > patch.stride ? i : column, side > patch.stride ? k : row);
    };
    const std::size_t squareColumns = columns_.size() - 1;
    for (int k = patch.row; k < lastRow; k += patch.stride) {
        const int nextRow = std::min(k + patch.stride, lastRow);
        for (int i = patch.column; i < lastColumn; i += patch.stride) {
            const int nextColumn = std::min(i + patch.stride, lastColumn);
            const std::uint32_t a = vertex(i, k), b = vertex(nextColumn, k);
            const std::uint32_t c = vertex(i, nextRow), d = vertex(nextColumn, nextRow);
            if (risesWithX_[static_cast<std::size_t>(k) * squareColumns + i]) {
                addTriangle(indices, a, c, d);
                addTriangle(indices, a, d, b);
            } else {
                addTriangle(indices, a, c, b);
                addTriangle(indices, b, c, d);
            }
        }
    }
}

}  // namespace hashphase::demos
