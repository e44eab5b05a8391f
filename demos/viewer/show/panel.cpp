// SPDX-License-Identifier: Zlib
#include <demos/viewer/show/panel.hpp>

#include <demos/console/format.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/viewer/draw/palette.hpp>
#include <demos/viewer/session/commands.hpp>
#include <demos/viewer/show/panel_parts.hpp>

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>

namespace hashphase::demos {

Panel::Panel() {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // it would write a file where it is run
    ImGui_ImplOpenGL3_Init("#version 330 core");
}

Panel::~Panel() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext();
}

void Panel::run(Session& session, std::string_view command) {
    try {
        if (guard_) {
            guard_(command);
        }
        session.run(command);
    } catch (const InputError& error) {
        say(error.what(), true);
    }
}

void Panel::say(const std::string& message, bool isFault) {
    message_ = message;
    isFault_ = isFault;
    messageSeconds_ = 6;
}

bool Panel::hasPointer() const {
    return ImGui::GetIO().WantCaptureMouse;
}

void Panel::build(Session& session, std::span<const Legend> legends, const Pointer& pointer,
                  double seconds) {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {static_cast<float>(session.width()), static_cast<float>(session.height())};
    io.DeltaTime = static_cast<float>(std::clamp(seconds, 1e-4, 1.0));
    io.MousePos = {pointer.x, pointer.y};
    io.MouseDown[0] = pointer.left;
    io.MouseDown[1] = pointer.right;
    io.MouseWheel = pointer.wheel;
    if (seconds > 0) {
        frameSeconds_ = frameSeconds_ == 0 ? seconds : 0.9 * frameSeconds_ + 0.1 * seconds;
    }
    messageSeconds_ -= seconds;
    if (session.options().theme == Theme::dark) {
        ImGui::StyleColorsDark();
    } else {
        ImGui::StyleColorsLight();
    }
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
    if (session.options().panel) {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({kPanelWidth, static_cast<float>(session.height())});
        ImGui::SetNextWindowBgAlpha(1);  // nothing is drawn below it
        ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
        ImGui::Begin(
            "hashphase", nullptr,
            ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoTitleBar);
        ImGui::PopStyleVar();
        showScene(session);
        showPhases(session);
        showEffects(session);
        showGrid(session);
        showView(session);
        showZones(session);
        ImGui::End();
        showCard(session);
        showRadar(session);
        showLegends(session, legends);
    }
    showBadge(session);
    showHelp(session);
    showMessage(session);
    ImGui::Render();
}

void Panel::draw() {
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

// --- What is on stage ----------------------------------------------------------------------------

void Panel::showScene(Session& session) {
    ImGui::TextUnformatted(titleOf(session.choice()).c_str());
    if (frameSeconds_ > 0) {
        alignRight(fixed(1 / frameSeconds_, 0) + " pictures a second");
    }
    numberRow("bodies", withThousands(session.stage().size()));
    numberRow("visible", withThousands(session.visibleCount()));
    numberRow("pairs", withThousands(session.stage().pairCount()));
    numberRow("selected", withThousands(session.selected().size()));
    if (!session.stage().tunnelMarks().empty()) {
        numberRow("passed through walls", withThousands(session.stage().tunnelMarks().size()));
    }
    numberRow("frame", withThousands(session.frame()));
    numberRow("memory of grid and tables",
              byteSize(static_cast<std::int64_t>(session.stage().memoryBytes())));
    if (ImGui::Button(session.isPlaying() ? "pause (P)" : "play (P)")) {
        run(session, "pause");
    }
    ImGui::SameLine();
    if (ImGui::Button("step (O)")) {
        run(session, "step");
    }
    ImGui::SameLine();
    if (ImGui::Button("restart (R)")) {
        run(session, "restart");
    }
    ImGui::SameLine();
    if (ImGui::Button("help (F1)")) {
        run(session, "help");
    }
    ImGui::SetNextItemWidth(150);
    const std::string title = titleOf(session.choice());
    if (ImGui::BeginCombo("scene", title.c_str())) {
        for (const ViewerScene& scene : viewerScenes()) {
            if (ImGui::Selectable(scene.name.c_str(), scene.name == title)) {
                run(session, "scene " + scene.name);
            }
        }
        ImGui::EndCombo();
    }
}

void Panel::showEffects(Session& session) {
    if (!ImGui::CollapsingHeader("effects", ImGuiTreeNodeFlags_DefaultOpen)) {
        return;
    }
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {1, 1});  // as long names need the room
    constexpr int kColumns = 3;
    const float column = ImGui::GetContentRegionAvail().x / kColumns;
    int shown = 0;
    for (const Effect effect : kAllEffects) {
        if (!session.stage().possibleEffects().contains(effect)) {
            continue;
        }
        if (const int place = shown++ % kColumns; place != 0) {
            ImGui::SameLine(ImGui::GetStyle().WindowPadding.x + column * static_cast<float>(place));
        }
        bool isDeclared = session.stage().effects().set().contains(effect);
        const std::string name(nameOf(effect));
        if (ImGui::Checkbox(name.c_str(), &isDeclared)) {
            run(session, "effect " + name + (isDeclared ? " on" : " off"));
        }
    }
    ImGui::PopStyleVar();
    if (session.stage().effects().proximity) {
        auto radius = static_cast<float>(session.stage().effects().proximity->radius);
        ImGui::SetNextItemWidth(150);
        if (ImGui::SliderFloat("agents' radius [m]", &radius, 0.5F, 30, "%.1f")) {
            run(session, "radius " + fixed(double{radius}, 1));
        }
    }
}

void Panel::showGrid(Session& session) {
    if (!ImGui::CollapsingHeader("broadphase and grid", ImGuiTreeNodeFlags_DefaultOpen)) {
        return;
    }
    ImGui::SetNextItemWidth(150);
    const std::string now(session.stage().broadphase().name);
    if (ImGui::BeginCombo("broadphase (B)", now.c_str())) {
        for (const BroadphaseKind& kind : broadphaseKinds()) {
            const std::string name(kind.name);
            if (ImGui::Selectable(name.c_str(), name == now)) {
                run(session, "broadphase " + name);
            }
        }
        ImGui::EndCombo();
    }
    bool isChecking = session.isChecking();
    if (ImGui::Checkbox("verify all pairs (V)", &isChecking)) {
        run(session, "check");
    }
    const GridConfig config = session.stage().effects().grid;
    auto cellSize = static_cast<float>(config.cellSize);
    ImGui::SetNextItemWidth(150);
    if (ImGui::SliderFloat("cell size [m]", &cellSize, 0, 100, cellSize == 0 ? "automatic" : "%.1f",
                           ImGuiSliderFlags_Logarithmic)) {
        run(session, "cell " + fixed(double{cellSize}, 1));
    }
    if (config.cellSize > 0) {
        auto ratio = static_cast<float>(config.levelRatio);
        ImGui::SetNextItemWidth(150);
        if (ImGui::SliderFloat("levels' ratio", &ratio, 2, 16, "%.0f")) {
            run(session, "ratio " + fixed(double{ratio}, 0));
        }
    }
    if (const Grid<float>* grid = session.stage().grid()) {
        numberRow("finest cells [m]", fixed(double{grid->cellSize()}, 2));
    }
}

void Panel::showView(Session& session) {
    if (!ImGui::CollapsingHeader("view")) {
        return;
    }
    for (std::size_t i = 0; i < kCameraModes.size(); ++i) {
        if (i > 0) {
            ImGui::SameLine();
        }
        const std::string name(kCameraModes[i]);
        if (ImGui::RadioButton(name.c_str(),
                               static_cast<std::size_t>(session.camera().mode()) == i)) {
            run(session, "camera " + name);
        }
    }
    bool isFrozen = session.frozenPose().has_value();
    if (ImGui::Checkbox("freeze the frustum (F)", &isFrozen)) {
        run(session, "freeze");
    }
    for (std::size_t i = 0; i < kOverlays.size(); ++i) {
        if (i > 0) {
            ImGui::SameLine();
        }
        bool isShown = session.options().overlays[i];
        const std::string name(kOverlays[i]);
        if (ImGui::Checkbox(name.c_str(), &isShown)) {
            run(session, "overlay " + name);
        }
    }
    ImGui::SetNextItemWidth(150);
    const std::string now(kColourings[static_cast<std::size_t>(session.options().colouring)]);
    if (ImGui::BeginCombo("colours tell (M)", now.c_str())) {
        for (const std::string_view colouring : kColourings) {
            const std::string name(colouring);
            if (ImGui::Selectable(name.c_str(), name == now)) {
                run(session, "colour " + name);
            }
        }
        ImGui::EndCombo();
    }
    float dots = session.options().dots;
    ImGui::SetNextItemWidth(150);
    if (ImGui::SliderFloat("least dot [pixels]", &dots, 0, 8, "%.1f")) {
        run(session, "dots " + fixed(double{dots}, 1));
    }
    if (ImGui::Button("light or dark (T)")) {
        run(session, "theme");
    }
}

// --- What is said --------------------------------------------------------------------------------

void Panel::showMessage(const Session& session) {
    if (messageSeconds_ <= 0) {
        return;
    }
    const Palette& colours = palette(session.options().theme);
    ImGui::SetNextWindowPos(
        {static_cast<float>(session.width()) / 2, static_cast<float>(session.height()) - 12},
        ImGuiCond_Always, {0.5F, 1});
    ImGui::Begin("message", nullptr, kStill);
    ImGui::PushStyleColor(ImGuiCol_Text, isFault_ ? colourOf(colours.alert)
                                                  : ImGui::GetStyleColorVec4(ImGuiCol_Text));
    ImGui::PushTextWrapPos(700);
    ImGui::TextUnformatted(message_.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
    ImGui::End();
}

void Panel::showHelp(Session& session) {
    if (!session.options().help) {
        return;
    }
    // Beside the panel, where there is room.
    const float left = session.options().panel ? kPanelWidth : 0;
    ImGui::SetNextWindowPos({(left + static_cast<float>(session.width())) / 2,
                             static_cast<float>(session.height()) / 2},
                            ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::Begin("help", nullptr, kStill);
    ImGui::TextUnformatted(
        "click: who is that    drag: select    right button: turn    wheel: nearer");
    ImGui::Separator();
    ImGui::BeginTable("keys", 4, ImGuiTableFlags_SizingFixedFit);
    for (const KeyBinding& binding : keyBindings()) {
        ImGui::TableNextColumn();
        ImGui::TextColored(colourOf(palette(session.options().theme).accent), "%s",
                           std::string(binding.key).c_str());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted((std::string(binding.help) + "    ").c_str());
    }
    ImGui::EndTable();
    ImGui::Separator();
    ImGui::TextUnformatted("Each is a command that a script can run: hashphase wander --list");
    ImGui::End();
}

}  // namespace hashphase::demos
