// SPDX-License-Identifier: Zlib
#include <demos/viewer/show/panel_figures.hpp>

#include <demos/console/format.hpp>
#include <demos/viewer/draw/palette.hpp>
#include <demos/viewer/session/commands.hpp>
#include <demos/viewer/show/annotations.hpp>

#include <algorithm>
#include <cfloat>
#include <optional>
#include <vector>

namespace hashphase::demos {
namespace {

/// Windows that only tell.
constexpr ImGuiWindowFlags kStill = ImGuiWindowFlags_NoDecoration |
                                    ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs |
                                    ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing;

ImU32 packed(Colour colour) {
    return IM_COL32(colour.red, colour.green, colour.blue, colour.alpha);
}

ImU32 phaseColour(const Session& session, std::size_t row) {
    return packed(kindColour(session.options.theme, row));
}

// A column a frame, its phases on top of each other; a line where a frame would take 8 ms, named at its end.
void drawStack(const Session& session) {
    constexpr float kHeight = 70;
    const PhaseHistory& history = session.history;
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
            const float top = std::max(corner.y, y - heightOf(double{rows[row].frames[frame]}));
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

using Texts = std::vector<std::string>;

void numbersRow(const std::string& text, const Texts& numbers, std::optional<ImU32> colour = {}) {
    ImGui::TableNextColumn();
    if (colour) {
        swatch(*colour);
    }
    ImGui::TextUnformatted(text.c_str());
    for (const std::string& number : numbers) {
        rightInColumn(number);
    }
}

/// Median, 95th percentile, worst frame, and the median before.
Texts textsOf(const PhaseLine& line) {
    Texts texts;
    for (const std::optional<double> time : {line.median, line.p95, line.worst, line.before}) {
        texts.push_back(time ? fixed(*time, 2) : "-");
    }
    return texts;
}

/// A table of texts with numbers, in columns of these names.
void beginNumbers(const char* name, const Texts& columns) {
    constexpr float kColumnWidth = 42;  // [pixels]
    ImGui::BeginTable(name, 1 + static_cast<int>(columns.size()), ImGuiTableFlags_None);
    ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch);
    for (const std::string& column : columns) {
        ImGui::TableSetupColumn(column.c_str(), ImGuiTableColumnFlags_WidthFixed, kColumnWidth);
    }
    numbersRow("", columns);
}

}  // namespace

ImVec4 colourOf(Colour colour) {
    return ImGui::ColorConvertU32ToFloat4(packed(colour));
}

void beginStill(const char* name, ImVec2 place, ImVec2 pivot) {
    ImGui::SetNextWindowPos(place, ImGuiCond_Always, pivot);
    ImGui::Begin(name, nullptr, kStill);
}

void alignRight(const std::string& text) {
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - width);
    ImGui::TextUnformatted(text.c_str());
}

void numberRow(const std::string& name, const std::string& number) {
    ImGui::TextUnformatted(name.c_str());
    alignRight(number);
}

// --- In the panel --------------------------------------------------------------------------------

void showPhases(const Session& session) {
    if (!ImGui::CollapsingHeader("phases of a frame [ms]", ImGuiTreeNodeFlags_DefaultOpen)) {
        return;
    }
    drawStack(session);
    const PhaseHistory* const before = session.former ? &session.former->history : nullptr;
    if (before != nullptr) {
        ImGui::TextWrapped("%s", swapText(session).c_str());
    }
    Texts columns{"median", "p95", "worst"};
    columns.resize(before != nullptr ? 4 : 3, "before");
    beginNumbers("phases", columns);
    const std::size_t drawn = session.history.rows().size();
    const std::vector<PhaseLine> lines = phaseLines(session.history, before);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        Texts times = textsOf(lines[i]);
        times.resize(columns.size());
        numbersRow(std::string(lines[i].name), times,
                   i < drawn ? std::optional(phaseColour(session, i)) : std::nullopt);
    }
    ImGui::EndTable();
}

void showZones(const Session& session) {
    if (session.stage->zones().empty() || !ImGui::CollapsingHeader("Bullet's profile zones")) {
        return;
    }
    beginNumbers("zones", {"ms", "calls"});
    for (const ProfileZone& zone : session.stage->zones()) {
        const std::string indent(2 * static_cast<std::size_t>(zone.depth), ' ');
        numbersRow(indent + std::string(zone.name),
                   {fixed(zone.milliseconds, 2), withThousands(zone.calls)});
    }
    ImGui::EndTable();
}

// --- Beside it -----------------------------------------------------------------------------------

void showZoneLabels(const Session& session) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const auto sizeOf = [](const std::string& text) {
        const ImVec2 size = ImGui::CalcTextSize(text.c_str());
        return Eigen::Vector2f(size.x + 6, size.y + 2);  // with a margin
    };
    for (const Label& label : placedApart(zoneLabels(session), sizeOf)) {
        const Eigen::Vector2f half = sizeOf(label.text) / 2;
        const ImVec2 at{label.middle.x() - half.x(), label.middle.y() - half.y()};
        list.AddRectFilled(at, {label.middle.x() + half.x(), label.middle.y() + half.y()},
                           ImGui::GetColorU32(ImGuiCol_WindowBg, 0.8F));
        list.AddText({at.x + 3, at.y + 1}, ImGui::GetColorU32(ImGuiCol_Text), label.text.c_str());
    }
}

void showCard(const Session& session) {
    if (!session.card) {
        return;
    }
    const InfoCard& card = *session.card;
    ImGui::SetNextWindowSizeConstraints({230, 0}, {230, FLT_MAX});
    beginStill("card", {static_cast<float>(session.width) - 8, 8}, {1, 0});
    ImGui::TextColored(colourOf(palette(session.options.theme).picked), "body %u", card.index);
    numberRow("cell", std::to_string(card.cell[0]) + ", " + std::to_string(card.cell[1]) + ", " +
                          std::to_string(card.cell[2]));
    numberRow("bodies in this cell", withThousands(card.load));
    numberRow("bodies within " + fixed(double{card.radius}, 1) + " m",
              withThousands(card.neighbours));
    numberRow("candidate pairs", withThousands(card.candidates));
    numberRow("speed [m/s]", fixed(double{card.body.speed}, 1));
    const Vector3<float>& at = card.body.centre;
    numberRow("position [m]", fixed(double{at.x()}, 1) + ", " + fixed(double{at.y()}, 1) + ", " +
                                  fixed(double{at.z()}, 1));
    if (card.body.isStatic || card.body.isAsleep) {
        ImGui::TextUnformatted(card.body.isStatic ? "static" : "asleep");
    }
    ImGui::End();
}

// Seen from above, x to the right and z downwards, as by the camera above.
void showRadar(const Session& session) {
    const std::optional<RadarView>& radar = session.stage->radar();
    if (!radar || radar->columns == 0 || radar->rows == 0) {
        return;
    }
    constexpr float kSide = 200;  // of the longer side [pixels]
    constexpr float kBelowCard = 160;
    const std::vector<std::uint32_t> counts = totalsOf(*radar);
    const std::uint32_t most = std::max(1U, *std::max_element(counts.begin(), counts.end()));
    const float side = kSide / static_cast<float>(std::max(radar->columns, radar->rows));
    beginStill("radar", {static_cast<float>(session.width) - 8, kBelowCard}, {1, 0});
    ImGui::TextUnformatted(("radar, cells of " + fixed(double{radar->cellSize}, 0) + " m").c_str());
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::Dummy(
        {side * static_cast<float>(radar->columns), side * static_cast<float>(radar->rows)});
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (std::uint32_t cell = 0; cell < counts.size(); ++cell) {
        const float x = corner.x + side * static_cast<float>(cell % radar->columns);
        const float y = corner.y + side * static_cast<float>(cell / radar->columns);
        const float share = static_cast<float>(counts[cell]) / static_cast<float>(most);
        list.AddRectFilled({x, y}, {x + side, y + side}, packed(sequentialColour(share)));
    }
    numberRow("most bodies in a cell", withThousands(most));
    ImGui::End();
}

void showLegends(const Session& session, std::span<const Legend> legends) {
    if (legends.empty()) {
        return;
    }
    beginStill("legends",
               {static_cast<float>(session.width) - 8, static_cast<float>(session.height) - 8},
               {1, 1});
    for (const Legend& legend : legends) {
        ImGui::TextUnformatted(legend.title.c_str());
        for (const Legend::Entry& entry : legend.entries) {
            swatch(packed(entry.colour));
            ImGui::TextUnformatted(entry.meaning.c_str());
        }
    }
    ImGui::End();
}

void showBadges(const Session& session) {
    float top = 8;
    int place = 0;
    for (const Badge& badge : badges(session)) {
        ImGui::PushStyleColor(ImGuiCol_WindowBg, colourOf(badge.colour));
        ImGui::PushStyleColor(ImGuiCol_Text,
                              badge.isAlert ? ImVec4(1, 1, 1, 1) : ImVec4(0, 0, 0, 1));
        // By its place, as windows of new names are seen a frame later.
        beginStill(("badge " + std::to_string(place++)).c_str(),
                   {static_cast<float>(session.width) / 2, top}, {0.5F, 0});
        ImGui::TextUnformatted(badge.text.c_str());
        ImGui::End();
        ImGui::PopStyleColor(2);
        top += ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().WindowPadding.y + 4;
    }
}

void showHelp(const Session& session, float left) {
    beginStill(
        "help",
        {(left + static_cast<float>(session.width)) / 2, static_cast<float>(session.height) / 2},
        {0.5F, 0.5F});
    ImGui::TextUnformatted(
        "click: pick a body    drag: select bodies    right button: turn    wheel: zoom");
    ImGui::Separator();
    ImGui::BeginTable("keys", 4, ImGuiTableFlags_SizingFixedFit);
    for (const KeyBinding& binding : keyBindings()) {
        ImGui::TableNextColumn();
        ImGui::TextColored(colourOf(palette(session.options.theme).accent), "%s",
                           std::string(binding.key).c_str());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted((std::string(binding.help) + "    ").c_str());
    }
    ImGui::EndTable();
    ImGui::Separator();
    ImGui::TextUnformatted("Scripts run the same commands: hashphase wander --list");
    ImGui::End();
}

}  // namespace hashphase::demos
