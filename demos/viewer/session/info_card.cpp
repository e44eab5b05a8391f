// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/info_card.hpp>

#include <demos/viewer/stage/body_shape.hpp>

namespace hashphase::demos {
InfoCard infoCard(const Stage& stage, const Grid<float>& grid, std::uint32_t index, float radius) {
    InfoCard card;
    card.index = index;
    card.body = stage.body(index);
    card.radius = radius;
    card.cell = grid.cellAt(card.body.centre);
    CollectCount load;
    grid.visitCell(card.cell, load);
    CollectCount near;
    grid.visit(SphereRegion<float>(card.body.centre, radius), near);
    CollectCount touching;
    grid.visit(BoxRegion<float>{boxAround(card.body)}, touching);
    card.load = load.count();
    card.neighbours = near.count() - 1;
    card.candidates = touching.count() - 1;
    return card;
}

}  // namespace hashphase::demos
