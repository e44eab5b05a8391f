// SPDX-License-Identifier: Zlib
//
// The parts of the panel that only tell: phases, Bullet's zones, the card of who is picked, the badge.

#include <demos/viewer/show/panel.hpp>

#include <demos/console/format.hpp>
#include <demos/viewer/draw/palette.hpp>
#include <demos/viewer/show/panel_parts.hpp>

#include <algorithm>
#include <cfloat>
#include <vector>

namespace hashphase::demos {
namespace {

ImU32 phaseColour(const Session& session, std::size_t row) {
    const auto& kinds = qualitativeColours(session.options().theme);
    return ImGui::ColorConvertFloat4ToU32(colourOf(kinds[row % kinds.size()]));
}

// A column a frame, its phases on top of each other; a line where a frame would take 8 ms, named at its end.
void drawStack(const Session& session) {
    constexpr float kHeight = 70;
    const PhaseHistory& history = session.history();
    const std::span<const PhaseHistory::Row> rows = history.rows();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::Dummy({width, kHeight});
    const double highest = std::max(8.0, 1.2 * history.p95Total());
    const auto heightOf = [&](double milliseconds) {
        return static_cast<float>(milliseconds / highest) * kHeight;
    };
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float bottom = corner.y + kHeight;
    const float column = width / static_cast<float>(PhaseHistory::kFrames);
    for (std::size_t frame = 0; frame < history.frameCount(); ++frame) {
        const float x = corner.x + column * static_cast<float>(frame);
        float y = bottom;
        for (std::size_t row = 0; row < rows.size(); ++row) {
            const float top =
                std::max(corner.y, y - heightOf(double{history.at(rows[row], frame)}));
            list.AddRectFilled({x, top}, {x + std::max(1.0F, column), y},
                               phaseColour(session, row));
            y = top;
        }
    }
    const float limit = bottom - heightOf(8);
    list.AddLine({corner.x, limit}, {corner.x + width, limit}, ImGui::GetColorU32(ImGuiCol_Text));
    const ImVec2 size = ImGui::CalcTextSize("8 ms");
    const float above = limit - size.y;
    const ImVec2 at{corner.x + width - size.x - 2, above < corner.y ? limit + 1 : above - 1};
    list.AddRectFilled({at.x - 2, at.y}, {at.x + size.x + 2, at.y + size.y},
                       ImGui::GetColorU32(ImGuiCol_WindowBg));
    list.AddText(at, ImGui::GetColorU32(ImGuiCol_Text), "8 ms");
}

// Before a text of that colour's meaning.
void swatch(ImU32 colour) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float side = ImGui::GetTextLineHeight();
    ImGui::GetWindowDrawList()->AddRectFilled({corner.x, corner.y + 2},
                                              {corner.x + side - 4, corner.y + side - 2}, colour);
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + side);
}

// Of all groups, row by row.
std::vector<std::uint32_t> totalsOf(const RadarView& radar) {
    const std::size_t cells = std::size_t{radar.columns} * radar.rows;
    std::vector<std::uint32_t> totals(cells);
    for (std::size_t i = 0; i < radar.counts.size(); ++i) {
        totals[i % cells] += radar.counts[i];
    }
    return totals;
}

void rightInColumn(const std::string& text) {
    ImGui::TableNextColumn();
    const float room = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(text.c_str()).x;
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(0.0F, room));
    ImGui::TextUnformatted(text.c_str());
}

void beginNumbers(const char* name, const char* first, const char* second, const char* third) {
    ImGui::BeginTable(name, 3, ImGuiTableFlags_None);
    ImGui::TableSetupColumn(first, ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn(second, ImGuiTableColumnFlags_WidthFixed, 60);
    ImGui::TableSetupColumn(third, ImGuiTableColumnFlags_WidthFixed, 60);
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(first);
    rightInColumn(second);
    rightInColumn(third);
}

}  // namespace

void Panel::showPhases(const Session& session) {
    if (!ImGui::CollapsingHeader("phases of a frame [ms]", ImGuiTreeNodeFlags_DefaultOpen)) {
        return;
    }
    drawStack(session);
    const PhaseHistory& history = session.history();
    beginNumbers("phases", "", "smoothed", "p95");
    for (std::size_t row = 0; row < history.rows().size(); ++row) {
        const PhaseHistory::Row& phase = history.rows()[row];
        ImGui::TableNextColumn();
        swatch(phaseColour(session, row));
        ImGui::TextUnformatted(std::string(phase.name).c_str());
        rightInColumn(fixed(phase.smoothed, 2));
        rightInColumn(fixed(history.p95(phase), 2));
    }
    ImGui::TableNextColumn();
    ImGui::TextUnformatted("together");
    rightInColumn(fixed(history.smoothedTotal(), 2));
    rightInColumn(fixed(history.p95Total(), 2));
    ImGui::EndTable();
}

void Panel::showZones(const Session& session) {
    if (session.stage().zones().empty() || !ImGui::CollapsingHeader("Bullet's profile zones")) {
        return;
    }
    beginNumbers("zones", "", "ms", "calls");
    for (const Stage::Zone& zone : session.stage().zones()) {
        ImGui::TableNextColumn();
        const std::string indent(2 * static_cast<std::size_t>(zone.depth), ' ');
        ImGui::TextUnformatted((indent + std::string(zone.name)).c_str());
        rightInColumn(fixed(zone.milliseconds, 2));
        rightInColumn(withThousands(zone.calls));
    }
    ImGui::EndTable();
}

void Panel::showCard(const Session& session) {
    if (!session.card()) {
        return;
    }
    const InfoCard& card = *session.card();
    ImGui::SetNextWindowPos({static_cast<float>(session.width()) - 8, 8}, ImGuiCond_Always, {1, 0});
    ImGui::SetNextWindowSizeConstraints({230, 0}, {230, FLT_MAX});
    ImGui::Begin("card", nullptr, kStill);
    ImGui::TextColored(colourOf(palette(session.options().theme).picked), "body %u", card.index);
    numberRow("cell", std::to_string(card.cell[0]) + ", " + std::to_string(card.cell[1]) + ", " +
                          std::to_string(card.cell[2]));
    numberRow("bodies in that cell", withThousands(card.load));
    numberRow(("within " + fixed(double{card.radius}, 1) + " m").c_str(),
              withThousands(card.neighbours));
    numberRow("candidate pairs", withThousands(card.candidates));
    numberRow("speed [m/s]", fixed(double{card.body.speed}, 1));
    const Vector3<float>& at = card.body.centre;
    numberRow("at [m]", fixed(double{at.x()}, 1) + ", " + fixed(double{at.y()}, 1) + ", " +
                            fixed(double{at.z()}, 1));
    if (card.body.isStatic || card.body.isAsleep) {
        ImGui::TextUnformatted(card.body.isStatic ? "never moves" : "asleep");
    }
    ImGui::End();
}

// Seen from above, x to the right and z downwards, as by the camera above.
void Panel::showRadar(const Session& session) {
    const std::optional<RadarView>& radar = session.stage().radar();
    if (!radar || radar->columns == 0 || radar->rows == 0) {
        return;
    }
    constexpr float kSide = 200;  // of the longer side [pixels]
    constexpr float kBelowCard = 160;
    const std::vector<std::uint32_t> counts = totalsOf(*radar);
    const std::uint32_t most = std::max(1U, *std::max_element(counts.begin(), counts.end()));
    const float side = kSide / static_cast<float>(std::max(radar->columns, radar->rows));
    ImGui::SetNextWindowPos({static_cast<float>(session.width()) - 8, kBelowCard}, ImGuiCond_Always,
                            {1, 0});
    ImGui::Begin("radar", nullptr, kStill);
    ImGui::TextUnformatted(("radar, cells of " + fixed(double{radar->cellSize}, 0) + " m").c_str());
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::Dummy(
        {side * static_cast<float>(radar->columns), side * static_cast<float>(radar->rows)});
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (std::uint32_t cell = 0; cell < counts.size(); ++cell) {
        const float x = corner.x + side * static_cast<float>(cell % radar->columns);
        const float y = corner.y + side * static_cast<float>(cell / radar->columns);
        const float share = static_cast<float>(counts[cell]) / static_cast<float>(most);
        list.AddRectFilled({x, y}, {x + side, y + side},
                           ImGui::ColorConvertFloat4ToU32(colourOf(sequentialColour(share))));
    }
    numberRow("most in a cell", withThousands(most));
    ImGui::End();
}

void Panel::showLegends(const Session& session, std::span<const Legend> legends) {
    if (legends.empty()) {
        return;
    }
    ImGui::SetNextWindowPos(
        {static_cast<float>(session.width()) - 8, static_cast<float>(session.height()) - 8},
        ImGuiCond_Always, {1, 1});
    ImGui::Begin("legends", nullptr, kStill);
    for (const Legend& legend : legends) {
        ImGui::TextUnformatted(legend.title.c_str());
        for (const Legend::Entry& entry : legend.entries) {
            swatch(ImGui::ColorConvertFloat4ToU32(colourOf(entry.colour)));
            ImGui::TextUnformatted(entry.meaning.c_str());
        }
    }
    ImGui::End();
}

void Panel::showBadge(const Session& session) {
    if (!session.isChecking()) {
        return;
    }
    const Palette& colours = palette(session.options().theme);
    const PairCheck* check = session.check();
    std::string text = "pairs are not verified: none are declared, or they are swept";
    Colour colour = colours.warning;
    if (check == nullptr && session.canCheck()) {
        text = "pairs are verified after the next frame";
        colour = colours.unknown;
    } else if (check != nullptr && !check->missing().empty()) {
        text = "WRONG: " + withThousands(check->missing().size()) + " of " +
               withThousands(check->exactCount()) + " pairs are missing";
        colour = colours.alert;
    } else if (check != nullptr) {
        text = "all " + withThousands(check->exactCount()) + " pairs found";
        colour = check->extra().empty() ? colours.confirmed : colours.warning;
        text += check->extra().empty()
                    ? ", and no other"
                    : ", and " + withThousands(check->extra().size()) + " that do not overlap";
    }
    ImGui::SetNextWindowPos({static_cast<float>(session.width()) / 2, 8}, ImGuiCond_Always,
                            {0.5F, 0});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, colourOf(colour));
    const bool isDarkText = !(check != nullptr && !check->missing().empty());
    ImGui::PushStyleColor(ImGuiCol_Text, isDarkText ? ImVec4(0, 0, 0, 1) : ImVec4(1, 1, 1, 1));
    ImGui::Begin("badge", nullptr, kStill);
    ImGui::TextUnformatted(text.c_str());
    ImGui::End();
    ImGui::PopStyleColor(2);
}

}  // namespace hashphase::demos
