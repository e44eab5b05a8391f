// SPDX-License-Identifier: Zlib
#pragma once

// The ground as it is drawn: a lattice over x and z with smooth normals, of which a camera needs those triangles
// that are on the screen, and larger ones where it sees no difference. Software rendering takes as long for a
// triangle of a pixel as for one of fifty.

#include <demos/viewer/draw/picture.hpp>
#include <demos/viewer/draw/view.hpp>

#include <array>
#include <optional>
#include <vector>

namespace hashphase::demos {

/// Where levels of detail meet, the finer one bends its border to the coarser one's, so there are no cracks.
class Ground {
public:
    /// None.
    Ground() = default;

    /// Of triangles, three corners each, in any order. A corner's normal is the mean of its triangles', by area.
    /// Throws DrawError unless they are two for each square of a lattice. Cost: two binary searches a corner.
    explicit Ground(std::span<const Vector3<float>> corners);

    struct Point {
        Vector3<float> position;
        Vector3<float> normal;  // upwards, of length one
    };

    /// Of the lattice, row by row.
    [[nodiscard]] const std::vector<Point>& vertices() const { return vertices_; }
    [[nodiscard]] const Eigen::AlignedBox3f& bounds() const { return bounds_; }

    /// The ground there, with the normal of its triangle; nothing beside it. Cost: two binary searches.
    [[nodiscard]] std::optional<Point> at(float x, float z) const;

    /// Replaces `indices` by the triangles to be drawn. Nothing on the screen moves by as much as a
    /// pixel from where the finest level has it.
    void choose(const View& view, std::vector<std::uint32_t>& indices);

private:
    static constexpr int kPatchSize = 16;  // squares each way
    static constexpr int kLevelCount = 5;  // a square is 1, 2, 4, 8 or 16 squares wide

    /// A square of squares.
    struct Patch {
        int column;  // of the first square, and the one behind the last
        int row;
        int lastColumn;
        int lastRow;
        Eigen::AlignedBox3f bounds = {};
        std::array<float, kLevelCount> errors{};  // how far a level is off at most [m]
        std::array<float, kLevelCount> edges{};   // longest of a square, seen from above [m]
        int stride = 1;                           // of the chosen level
    };

    void addTriangle(std::span<const Vector3<float>, 3> corners);
    void addPatch(Patch patch);
    void measure(Patch& patch, int level) const;
    [[nodiscard]] static int strideFor(const Patch& patch, const View& view);
    [[nodiscard]] int strideAt(int patchColumn, int patchRow) const;
    void emit(int patchColumn, int patchRow, std::vector<std::uint32_t>& indices) const;
    [[nodiscard]] std::uint32_t vertexAt(int column, int row) const {
        return static_cast<std::uint32_t>(static_cast<std::size_t>(row) * columns_.size() + column);
    }
    [[nodiscard]] float heightAt(int column, int row) const {
        return vertices_[vertexAt(column, row)].position.y();
    }
    [[nodiscard]] std::size_t squareAt(int column, int row) const {
        return static_cast<std::size_t>(row) * (columns_.size() - 1) + column;
    }

    std::vector<float> columns_;  // x of the lattice's points
    std::vector<float> rows_;     // z
    std::vector<Point> vertices_;
    Eigen::AlignedBox3f bounds_;
    std::vector<bool> risesWithX_;     // for each square, whether its diagonal goes along +x +z
    std::vector<int> triangleCounts_;  // in each square
    std::vector<Patch> patches_;       // row by row
    int patchColumns_ = 0;
};

}  // namespace hashphase::demos
