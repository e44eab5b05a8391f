// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/stage_queries.hpp>

#include <demos/viewer/stage/body_shape.hpp>

#include <broadphase/proxy_filter.hpp>

#include <algorithm>
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

}  // namespace hashphase::demos
