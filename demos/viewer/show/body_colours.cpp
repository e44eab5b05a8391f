// SPDX-License-Identifier: Zlib
#include <demos/viewer/show/body_colours.hpp>

#include <demos/console/format.hpp>

#include <algorithm>
#include <utility>

namespace hashphase::demos {
namespace {

constexpr float kManyPairs = 8;  // of a body: as bright as any

/// The ramp from nothing to `most`, in even steps; the last stands for more, too, where it `isOpen`.
Legend rampOf(std::string title, double most, int digits, bool isOpen = false) {
    constexpr int kSteps = 4;
    Legend legend{std::move(title), {}};
    for (int i = 0; i <= kSteps; ++i) {
        const std::string number = fixed(most * i / kSteps, digits);
        legend.entries.push_back({sequentialColour(static_cast<float>(i) / kSteps),
                                  i == kSteps && isOpen ? number + " and more" : number});
    }
    return legend;
}

}  // namespace

void BodyColours::prepare(const Session& session) {
    palette_ = palette(session.options.theme);
    const std::uint32_t limit = session.stage->indexLimit();
    if (session.options.colouring == Colouring::pairs) {
        pairCounts_.assign(limit, 0);
        for (const PairKey pair : session.pairs) {
            if (secondOf(pair) < limit) {
                ++pairCounts_[firstOf(pair)];
                ++pairCounts_[secondOf(pair)];
            }
        }
    }
    if (session.options.colouring == Colouring::speed) {
        float fastest = 1;
        for (std::uint32_t index = 0; index < limit; ++index) {
            if (session.isVisible(index)) {
                fastest = std::max(fastest, session.stage->body(index).speed);
            }
        }
        fastest_ = std::max(fastest, 0.98F * fastest_);  // or colours would flicker
    }
}

Colour BodyColours::of(const Session& session, std::uint32_t index, const StageBody& body) const {
    if (session.card && session.card->index == index) {
        return palette_.picked;
    }
    if (std::ranges::binary_search(session.selected, index)) {
        return palette_.selected;
    }
    return std::ranges::binary_search(session.recoloured, index)
               ? palette_.accent
               : byColouring(session, index, body);
}

Colour BodyColours::byColouring(const Session& session, std::uint32_t index,
                                const StageBody& body) const {
    const auto& kinds = qualitativeColours(session.options.theme);
    switch (session.options.colouring) {
        case Colouring::agents: {
            if (!session.stage->effects().proximity) {
                return body.isStatic ? palette_.fixed : kinds[index % kinds.size()];
            }
            const auto colours = session.stage->observers().colours();
            return kinds[index < colours.size() ? colours[index] % kinds.size() : 0];
        }
        case Colouring::cells: {
            const Grid<float>* grid = session.stage->grid();
            if (grid == nullptr) {
                return palette_.calm;
            }
            const auto cell = grid->cellAt(body.centre);
            // Neighbouring cells differ, as on a map.
            const auto kind = static_cast<std::uint64_t>(cell[0] + 3 * cell[2] + 5 * cell[1]);
            return kinds[kind % kinds.size()];
        }
        case Colouring::load: {
            const auto load =
                static_cast<float>(session.loads.at(body.centre.x(), body.centre.z()));
            return sequentialColour(load / static_cast<float>(session.loads.full));
        }
        case Colouring::speed:
            return sequentialColour(body.speed / fastest_);
        case Colouring::pairs:
            return sequentialColour(
                static_cast<float>(index < pairCounts_.size() ? pairCounts_[index] : 0) /
                kManyPairs);
        case Colouring::rest:
            return body.isStatic ? palette_.fixed : body.isAsleep ? palette_.calm : palette_.awake;
    }
    return palette_.calm;
}

std::vector<Legend> BodyColours::legends(const Session& session) const {
    std::vector<Legend> legends;
    const ViewOptions& options = session.options;
    const auto tells = [&](Colouring colouring) {
        return options.has(Overlay::bodies) && options.colouring == colouring;
    };
    if (options.has(Overlay::heat) || tells(Colouring::load)) {
        legends.push_back(rampOf("bodies in a column of cells", session.loads.full, 0));
    }
    if (tells(Colouring::speed)) {
        legends.push_back(rampOf("speed [m/s]", fastest_, 1));
    }
    if (tells(Colouring::pairs)) {
        legends.push_back(rampOf("pairs of a body", kManyPairs, 0, true));
    }
    if (tells(Colouring::rest)) {
        legends.push_back({"who rests",
                           {{palette_.fixed, "never moves"},
                            {palette_.calm, "asleep"},
                            {palette_.awake, "awake"}}});
    }
    return legends;
}

}  // namespace hashphase::demos
