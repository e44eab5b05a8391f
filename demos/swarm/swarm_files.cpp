// SPDX-License-Identifier: Zlib
#include <demos/swarm/swarm_files.hpp>

#include <demos/scenes/input_error.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <system_error>

namespace hashphase::demos {
namespace {

std::string numbered(const char* begin, std::uint32_t number, const std::string& end) {
    const std::string digits = std::to_string(number);
    return begin + std::string(6 - std::min<std::size_t>(digits.size(), 6), '0') + digits + end;
}

VtkPoint pointOf(const Vector3<float>& at) {
    return {at[0], at[1], at[2]};
}

std::string pieceName(std::uint32_t frame, std::uint32_t rank) {
    return numbered("swarm_", frame, "_" + std::to_string(rank) + ".vtp");
}

}  // namespace

SwarmFiles::SwarmFiles(std::string folder, std::uint32_t rank, float side)
    : folder_(std::move(folder)), rank_(rank), side_(side) {
    if (folder_.empty() || rank_ != 0) {
        return;
    }
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (std::error_code ignored; !std::filesystem::is_directory(folder_, ignored)) {
        throw InputError("The folder " + folder_ + " cannot be made: " + error.message() + ".");
    }
}

void SwarmFiles::write(std::uint32_t frame, const RankGrid<float>& grid) {
    if (folder_.empty()) {
        return;
    }
    writeSpheres(path(pieceName(frame, rank_)), grid);
    if (rank_ != 0) {
        return;
    }
    std::vector<std::string> pieces;
    for (std::uint32_t rank = 0; rank < grid.partition().rankCount(); ++rank) {
        pieces.push_back(pieceName(frame, rank));
    }
    const std::vector<VtkField> fields{{"radius", std::span<const float>()},
                                       {"rank", std::span<const std::uint32_t>()},
                                       {"id", std::span<const std::uint64_t>()}};
    spheres_.push_back({frame, numbered("swarm_", frame, ".pvtp")});
    writeVtkPieces(path(spheres_.back().fileName), VtkPieceKind::points, pieces, fields);
    regions_.push_back({frame, numbered("regions_", frame, ".vtp")});
    writeRegions(path(regions_.back().fileName), grid.partition());
}

void SwarmFiles::writeSpheres(const std::string& name, const RankGrid<float>& grid) const {
    std::vector<VtkPoint> points;
    std::vector<float> radii;
    std::vector<std::uint64_t> ids;
    grid.forEachOwned([&](ProxyId proxy, const Aabb<float>& box) {
        if (box.sizes().maxCoeff() < 2 * side_) {  // no plane
            points.push_back(pointOf(box.center()));
            radii.push_back(box.sizes().minCoeff() / 2);
            ids.push_back(grid.globalId(proxy).value);
        }
    });
    const std::vector<std::uint32_t> ranks(points.size(), rank_);
    const std::vector<VtkField> fields{{"radius", radii}, {"rank", ranks}, {"id", ids}};
    writeVtkPoints(name, points, fields);
}

void SwarmFiles::writeRegions(const std::string& name, const Partition<float>& partition) const {
    std::vector<VtkBox> boxes;
    std::vector<std::uint32_t> ranks;
    for (std::uint32_t rank = 0; rank < partition.rankCount(); ++rank) {
        const Aabb<float> region = partition.region(rank);
        const auto within = [&](const Vector3<float>& corner) {
            return pointOf(corner.cwiseMax(0.F).cwiseMin(side_));
        };
        boxes.push_back({within(region.min()), within(region.max())});
        ranks.push_back(rank);
    }
    const std::vector<VtkField> fields{{"rank", ranks}};
    writeVtkBoxes(name, boxes, fields);
}

void SwarmFiles::finish() const {
    if (!folder_.empty() && rank_ == 0) {
        writeVtkSeries(path("swarm.pvd"), spheres_);
        writeVtkSeries(path("regions.pvd"), regions_);
    }
}

}  // namespace hashphase::demos
