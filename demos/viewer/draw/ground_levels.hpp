// SPDX-License-Identifier: Zlib
#pragma once

// Which triangles of the ground a camera needs: those on the screen, and larger ones where it sees
// no difference. Software rendering takes as long for a triangle of a pixel as for one of fifty.

#include <demos/viewer/draw/ground_mesh.hpp>
#include <demos/viewer/draw/view.hpp>

#include <array>

namespace hashphase::demos {

/// Levels of detail of ground whose corners are a lattice over x and z, as terrain mostly is; any
/// other ground has none, and is drawn as it is. All levels share the vertices of the mesh. Where
/// levels meet, the finer one bends its border to the coarser one's, so there are no cracks.
class GroundLevels {
public:
    /// Of no ground.
    GroundLevels() = default;

    explicit GroundLevels(const GroundMesh& mesh);

    /// Whether the ground is a lattice.
    [[nodiscard]] bool hasLevels() const { return !patches_.empty(); }

    /// Replaces `indices` by the triangles to be drawn. Nothing on the screen moves by as much as a
    /// pixel from where the finest level has it.
    void choose(const View& view, std::vector<std::uint32_t>& indices);

private:
    static constexpr int kPatchSize = 16;  // squares each way
    static constexpr int kLevelCount = 5;  // a square is 1, 2, 4, 8 or 16 squares wide

    /// A square of squares.
    struct Patch {
        int column;  // of the first square
        int row;
        Eigen::AlignedBox3f bounds;
        std::array<float, kLevelCount> errors{};  // how far a level is off at most [m]
        std::array<float, kLevelCount>
            edges{};     // the longest edge of a square, seen from above [m]
        int stride = 1;  // of the chosen level
    };

    [[nodiscard]] bool readLattice(const GroundMesh& mesh);
    [[nodiscard]] bool readTriangles(const GroundMesh& mesh);
    void addPatch(const GroundMesh& mesh, int column, int row);
    void measure(const GroundMesh& mesh, Patch& patch, int level) const;
    [[nodiscard]] int strideFor(const Patch& patch, const View& view) const;
    [[nodiscard]] int strideAt(int patchColumn, int patchRow) const;
    void emit(int patchColumn, int patchRow, std::vector<std::uint32_t>& indices) const;
    [[nodiscard]] std::uint32_t vertexAt(int column, int row) const {
        return vertices_[static_cast<std::size_t>(row) * columns_.size() + column];
    }

    std::vector<float> columns_;           // x of the lattice's points
    std::vector<float> rows_;              // z
    std::vector<std::uint32_t> vertices_;  // of the mesh, row by row
    std::vector<bool> risesWithX_;         // for each square, whether its diagonal goes along +x +z
    std::vector<Patch> patches_;           // row by row
    int patchColumns_ = 0;
};

}  // namespace hashphase::demos
