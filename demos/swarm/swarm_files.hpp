// SPDX-License-Identifier: Zlib
#pragma once

// A swarm for ParaView: open swarm.pvd for the spheres, regions.pvd for the parts of space.

#include <demos/swarm/vtk_file.hpp>
#include <integration/mpi/distributed_grid.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace hashphase::demos {

class SwarmFiles {
public:
    /// Writes to `folder`, which all ranks share and rank 0 makes. Empty: nothing. Regions that reach to infinity end
    /// at the cube from 0 to `side` [m]. Throws InputError on rank 0 where there can be no such folder.
    SwarmFiles(std::string folder, std::uint32_t rank, float side);

    /// Writes this rank's spheres; rank 0 also what joins all of them, and the regions. On all ranks.
    void write(std::uint32_t frame, const RankGrid<float>& grid);

    /// Writes the series, on rank 0.
    void finish() const;

private:
    [[nodiscard]] std::string path(const std::string& name) const { return folder_ + "/" + name; }
    void writeSpheres(const std::string& name, const RankGrid<float>& grid) const;
    void writeRegions(const std::string& name, const Partition<float>& partition) const;

    std::string folder_;
    std::uint32_t rank_;
    float side_;
    std::vector<VtkSeriesEntry> spheres_;
    std::vector<VtkSeriesEntry> regions_;
};

}  // namespace hashphase::demos
