// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/stage_queries.hpp>

#include <broadphase/proxy_filter.hpp>
#include <integration/bullet/detail/sequential_ramp.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace hashphase::demos {

InfoCard infoCard(const Stage& stage, const Grid<float>& grid, std::uint32_t index, float radius) {
    // The grid files the ground as well.
    const auto isBody = [&](ProxyId id) { return stage.contains(id.index); };
    const auto isOther = [&](ProxyId id) { return id.index != index && isBody(id); };
    const auto countIn = [&](const auto& region) {
        CollectCount count;
        CollectIf others(count, isOther);
        grid.visit(region, others);
        return count.count();
    };
    InfoCard card;
    card.index = index;
    card.body = stage.body(index);
    card.radius = radius;
    card.cell = grid.cellAt(card.body.centre);
    CollectCount load;
    CollectIf bodies(load, isBody);
    grid.visitCell(card.cell, bodies);
    card.load = load.count();
    card.neighbours = countIn(SphereRegion<float>(card.body.centre, radius));
    card.candidates = countIn(BoxRegion<float>{boxAround(card.body)});
    return card;
}

PairCheck checkPairs(const Stage& stage) {
    std::vector<Aabb<float>> boxes;
    std::vector<CollisionFilter> filters;
    std::vector<PairKey> listed;
    stage.listBoxes(boxes, filters);
    stage.listPairs(listed);
    PairCheck check;
    findExactPairs(ReferenceMethod::kSweep, boxes, filters, check.exact);
    std::ranges::set_difference(check.exact, listed, std::back_inserter(check.missing));
    std::ranges::set_difference(listed, check.exact, std::back_inserter(check.extra));
    return check;
}

CellLoads::CellLoads(const Grid<float>& grid, const Aabb<float>& bounds) {
    const float extent = std::max(bounds.sizes().x(), bounds.sizes().z());
    const float finest = grid.cellSize();
    cellSize = finest * std::max(1.0F, std::ceil(extent / (finest * (kMostColumns - 2))));
    corner = cellSize * Eigen::Vector2f(std::floor(bounds.min().x() / cellSize),
                                        std::floor(bounds.min().z() / cellSize));
    // Far from the origin, cells may be smaller than what coordinates are rounded to.
    const auto countTo = [this](float length) {
        const float count = std::max(1.0F, std::floor(length / cellSize) + 1);
        return static_cast<std::uint32_t>(std::min(count, float{kMostColumns}));
    };
    columns = countTo(bounds.max().x() - corner.x());
    rows = countTo(bounds.max().z() - corner.y());
    counts.assign(std::size_t{columns} * rows, 0);
    grid.forEach([this](ProxyId, const Aabb<float>& box) {
        if (const auto cell = cellAt(box.center().x(), box.center().z())) {
            largest = std::max(largest, ++counts[*cell]);
        }
    });
    full = std::max(largest, detail::kFullLoad);
    shades.resize(counts.size());
    std::ranges::transform(counts, shades.begin(), [this](std::uint32_t load) {
        return static_cast<std::uint8_t>(load * 255 / full);
    });
}

std::optional<std::size_t> CellLoads::cellAt(float x, float z) const {
    const float column = (x - corner.x()) / cellSize;
    const float row = (z - corner.y()) / cellSize;
    const bool isInside = column >= 0 && row >= 0 && column < static_cast<float>(columns) &&
                          row < static_cast<float>(rows);
    return isInside ? std::optional(std::size_t{static_cast<std::uint32_t>(row)} * columns +
                                    static_cast<std::uint32_t>(column))
                    : std::nullopt;
}

}  // namespace hashphase::demos
