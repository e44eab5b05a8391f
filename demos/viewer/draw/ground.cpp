// SPDX-License-Identifier: Zlib
#include <demos/viewer/draw/ground.hpp>

#include <demos/viewer/draw/image.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hashphase::demos {

namespace {

constexpr float kLargestError = 0.7F;  // of a level, on the screen [pixels]
constexpr float kLargestEdge = 20;     // of its squares, because light is that of corners [pixels]

std::vector<float> sortedUnique(std::span<const Vector3<float>> corners, int axis) {
    std::vector<float> values;
    values.reserve(corners.size());
    for (const Vector3<float>& corner : corners) {
        values.push_back(corner[axis]);
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

void add(std::vector<std::uint32_t>& indices, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) {
        indices.insert(indices.end(), {a, b, c});
    }
}

void refuseIf(bool isBad) {
    if (isBad) {
        throw DrawError("Ground that is no lattice over x and z cannot be drawn.");
    }
}

}  // namespace

Ground::Ground(std::span<const Vector3<float>> corners)
    : columns_(sortedUnique(corners, 0)), rows_(sortedUnique(corners, 2)) {
    if (corners.empty()) {
        return;
    }
    const int lastColumn = static_cast<int>(columns_.size()) - 1;
    const int lastRow = static_cast<int>(rows_.size()) - 1;
    refuseIf(corners.size() != 6 * static_cast<std::size_t>(lastColumn) * lastRow);
    const Vector3<float> nowhere =
        Vector3<float>::Constant(std::numeric_limits<float>::quiet_NaN());
    vertices_.assign(columns_.size() * rows_.size(), {nowhere, Vector3<float>::Zero()});
    risesWithX_.resize(corners.size() / 6);
    triangleCounts_.resize(corners.size() / 6);
    for (; !corners.empty(); corners = corners.subspan(3)) {
        addTriangle(corners.first<3>());
    }
    for (Point& vertex : vertices_) {
        refuseIf(vertex.position.hasNaN());
        bounds_.extend(vertex.position);
        vertex.normal = vertex.normal.isZero() ? Vector3<float>(Vector3<float>::UnitY())
                                               : vertex.normal.normalized();
    }
    for (int row = 0; row < lastRow; row += kPatchSize) {
        for (int column = 0; column < lastColumn; column += kPatchSize) {
            addPatch({column, row, std::min(column + kPatchSize, lastColumn),
                      std::min(row + kPatchSize, lastRow)});
        }
    }
    patchColumns_ = (lastColumn + kPatchSize - 1) / kPatchSize;
}

// It adds its normal, as long as twice its area, to its corners.
void Ground::addTriangle(std::span<const Vector3<float>, 3> corners) {
    Vector3<float> normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    if (normal.y() < 0) {
        normal = -normal;
    }
    std::array<int, 3> columns{}, rows{};
    for (std::size_t i = 0; i < 3; ++i) {
        columns[i] = placeOf(corners[i].x(), columns_);
        rows[i] = placeOf(corners[i].z(), rows_);
        Point& vertex = vertices_[vertexAt(columns[i], rows[i])];
        refuseIf(vertex.position.y() != corners[i].y() && !vertex.position.hasNaN());
        vertex.position = corners[i];
        vertex.normal += normal;
    }
    const auto [firstColumn, lastColumn] = std::ranges::minmax(columns);
    const auto [firstRow, lastRow] = std::ranges::minmax(rows);
    refuseIf(lastColumn != firstColumn + 1 || lastRow != firstRow + 1);
    // Three of a square's corners have the missing one's column once, and its row once.
    const bool missesLastColumn = std::ranges::count(columns, lastColumn) == 1;
    const bool missesLastRow = std::ranges::count(rows, lastRow) == 1;
    const std::size_t square = squareAt(firstColumn, firstRow);
    risesWithX_[square] = missesLastColumn != missesLastRow;
    refuseIf(++triangleCounts_[square] > 2);
}

std::optional<Ground::Point> Ground::at(float x, float z) const {
    if (patches_.empty() ||
        !(x >= columns_.front() && x < columns_.back() && z >= rows_.front() && z < rows_.back())) {
        return std::nullopt;
    }
    const int i = static_cast<int>(std::ranges::upper_bound(columns_, x) - columns_.begin()) - 1;
    const int k = static_cast<int>(std::ranges::upper_bound(rows_, z) - rows_.begin()) - 1;
    const float width = columns_[i + 1] - columns_[i], depth = rows_[k + 1] - rows_[k];
    const float s = (x - columns_[i]) / width, t = (z - rows_[k]) / depth;
    const float a = heightAt(i, k), b = heightAt(i + 1, k);
    const float c = heightAt(i, k + 1), d = heightAt(i + 1, k + 1);
    // The triangle of the two has one of the square's sides along x, and one along z.
    const bool rises = risesWithX_[squareAt(i, k)];
    const bool hasLastRow = rises ? t > s : s + t > 1;
    const float alongX = hasLastRow ? d - c : b - a;
    const float alongZ = hasLastRow == rises ? c - a : d - b;
    const float first = hasLastRow && !rises ? b + c - d : a;
    return Point{{x, first + s * alongX + t * alongZ, z},
                 Vector3<float>(-alongX / width, 1, -alongZ / depth).normalized()};
}

// --- Levels of detail ----------------------------------------------------------------------------

void Ground::addPatch(Patch patch) {
    for (int k = patch.row; k <= patch.lastRow; ++k) {
        for (int i = patch.column; i <= patch.lastColumn; ++i) {
            patch.bounds.extend(vertices_[vertexAt(i, k)].position);
        }
    }
    for (int level = 1; level < kLevelCount; ++level) {
        measure(patch, level);
    }
    patches_.push_back(patch);
}

void Ground::measure(Patch& patch, int level) const {
    const int stride = 1 << level;
    const int lastColumn = static_cast<int>(columns_.size()) - 1;
    const int lastRow = static_cast<int>(rows_.size()) - 1;
    float error = 0, edge = 0;
    for (int k = patch.row; k <= patch.lastRow; ++k) {
        for (int i = patch.column; i <= patch.lastColumn; ++i) {
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

void Ground::choose(const View& view, std::vector<std::uint32_t>& indices) {
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

int Ground::strideFor(const Patch& patch, const View& view) {
    const float distance = patch.bounds.exteriorDistance(view.eye);
    for (int level = kLevelCount - 1; level > 0; --level) {
        if (view.focalLength * patch.errors[level] <= kLargestError * distance &&
            view.focalLength * patch.edges[level] <= kLargestEdge * distance) {
            return 1 << level;
        }
    }
    return 1;
}

int Ground::strideAt(int patchColumn, int patchRow) const {
    const int patchRows = static_cast<int>(patches_.size()) / patchColumns_;
    if (patchColumn < 0 || patchRow < 0 || patchColumn >= patchColumns_ || patchRow >= patchRows) {
        return 1;
    }
    return patches_[static_cast<std::size_t>(patchRow) * patchColumns_ + patchColumn].stride;
}

void Ground::emit(int patchColumn, int patchRow, std::vector<std::uint32_t>& indices) const {
    const Patch& patch = patches_[static_cast<std::size_t>(patchRow) * patchColumns_ + patchColumn];
    const int lastColumn = patch.lastColumn;
    const int lastRow = patch.lastRow;
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
    for (int k = patch.row; k < lastRow; k += patch.stride) {
        const int nextRow = std::min(k + patch.stride, lastRow);
        for (int i = patch.column; i < lastColumn; i += patch.stride) {
            const int nextColumn = std::min(i + patch.stride, lastColumn);
            const std::uint32_t a = vertex(i, k), b = vertex(nextColumn, k);
            const std::uint32_t c = vertex(i, nextRow), d = vertex(nextColumn, nextRow);
            if (risesWithX_[squareAt(i, k)]) {
                add(indices, a, c, d);
                add(indices, a, d, b);
            } else {
                add(indices, a, c, b);
                add(indices, b, c, d);
            }
        }
    }
}

}  // namespace hashphase::demos
