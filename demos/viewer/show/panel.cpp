// SPDX-License-Identifier: Zlib
#include <demos/viewer/show/panel.hpp>

#include <demos/console/format.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/viewer/draw/palette.hpp>
#include <demos/viewer/show/panel_figures.hpp>

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <functional>

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
        if (guard) {
            guard(command);
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
    io.DisplaySize = {static_cast<float>(session.width), static_cast<float>(session.height)};
    io.DeltaTime = static_cast<float>(std::clamp(seconds, 1e-4, 1.0));
    io.MousePos = {pointer.x, pointer.y};
    io.MouseDown[0] = pointer.left;
    io.MouseDown[1] = pointer.right;
    io.MouseWheel = pointer.wheel;
    if (seconds > 0) {
        frameSeconds_ = frameSeconds_ == 0 ? seconds : 0.9 * frameSeconds_ + 0.1 * seconds;
    }
    messageSeconds_ -= seconds;
    if (session.options.theme == Theme::dark) {
        ImGui::StyleColorsDark();
    } else {
        ImGui::StyleColorsLight();
    }
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
    showZoneLabels(session);
    if (session.options.panel) {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize({kPanelWidth, static_cast<float>(session.height)});
        ImGui::SetNextWindowBgAlpha(1);  // nothing is drawn below it
        ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
        ImGui::Begin(
            "hashphase", nullptr,
            ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoTitleBar);
        ImGui::PopStyleVar();
        showSwitches(session);
        showZones(session);
        ImGui::End();
        showCard(session);
        showRadar(session);
        showLegends(session, legends);
    }
    showBadges(session);
    if (session.options.help) {
        showHelp(session, session.options.panel ? kPanelWidth : 0);
    }
    showMessage(session);
    ImGui::Render();
}

void Panel::draw() {
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Panel::showMessage(const Session& session) const {
    if (messageSeconds_ <= 0) {
        return;
    }
    beginStill("message",
               {static_cast<float>(session.width) / 2, static_cast<float>(session.height) - 12},
               {0.5F, 1});
    ImGui::PushStyleColor(ImGuiCol_Text, isFault_ ? colourOf(palette(session.options.theme).alert)
                                                  : ImGui::GetStyleColorVec4(ImGuiCol_Text));
    ImGui::PushTextWrapPos(700);
    ImGui::TextUnformatted(message_.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
    ImGui::End();
}

// --- Switches ------------------------------------------------------------------------------------

struct Panel::Switches {
    Panel& panel;
    Session& session;

    void run(const std::string& command) const { panel.run(session, command); }

    /// Side by side, where others are before them.
    void press(const std::string& label, const char* command, bool isFirst = false) const {
        if (!isFirst) {
            ImGui::SameLine();
        }
        if (ImGui::Button(label.c_str())) {
            run(command);
        }
    }

    void check(const std::string& label, bool isOn, const std::string& command) const {
        if (ImGui::Checkbox(label.c_str(), &isOn)) {
            run(command);
        }
    }

    /// The name of one of these; the command is "what NAME".
    template <class Things, class NameOf = std::identity>
    void choose(const char* label, const std::string& now, const char* what, const Things& things,
                const NameOf& nameOf = {}) const {
        ImGui::SetNextItemWidth(kItemWidth);
        if (ImGui::BeginCombo(label, now.c_str())) {
            for (const auto& each : things) {
                const std::string name(std::invoke(nameOf, each));
                if (ImGui::Selectable(name.c_str(), name == now)) {
                    run(what + (' ' + name));
                }
            }
            ImGui::EndCombo();
        }
    }

    /// The command is "what NUMBER", with so many digits.
    void slide(const char* label, double now, float low, float high, const char* what, int digits,
               const char* format, ImGuiSliderFlags flags = 0) const {
        auto number = static_cast<float>(now);
        ImGui::SetNextItemWidth(kItemWidth);
        if (ImGui::SliderFloat(label, &number, low, high, format, flags)) {
            run(what + (' ' + fixed(double{number}, digits)));
        }
    }

    void showScene(double frameSeconds) const;
    void showEffects() const;
    void showGrid() const;
    void showView() const;

    static constexpr float kItemWidth = 150;
};

void Panel::showSwitches(Session& session) {
    const Switches switches{*this, session};
    switches.showScene(frameSeconds_);
    showPhases(session);
    switches.showEffects();
    switches.showGrid();
    switches.showView();
}

void Panel::Switches::showScene(double frameSeconds) const {
    const std::string title = titleOf(session.choice);
    ImGui::TextUnformatted(title.c_str());
    if (frameSeconds > 0) {
        alignRight(fixed(1 / frameSeconds, 0) + " frames per second");
    }
    const auto count = [this](const char* label, const char* reading) {
        numberRow(label, withThousands(static_cast<std::uint64_t>(session.reading(reading))));
    };
    for (const char* reading : {"bodies", "visible", "pairs", "selected"}) {
        count(reading, reading);
    }
    if (session.stage->tunnelCount() > 0) {
        count("misses: passed through walls", "tunnelled");
    }
    count("frame", "frame");
    const std::optional<std::int64_t> bytes = session.stage->memoryBytes();
    numberRow("memory of all tables", bytes ? byteSize(*bytes) : "n/a");
    press(session.isPlaying ? "pause (P)" : "play (P)", "pause", true);
    press("step (O)", "step");
    press("restart (R)", "restart");
    press("help (F1)", "help");
    choose("scene", title, "scene", viewerScenes(), &ViewerScene::name);
}

void Panel::Switches::showEffects() const {
    if (!ImGui::CollapsingHeader("effects", ImGuiTreeNodeFlags_DefaultOpen)) {
        return;
    }
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {1, 1});  // as long names need the room
    constexpr int kColumns = 3;
    const float column = ImGui::GetContentRegionAvail().x / kColumns;
    int shown = 0;
    for (const Effect effect : kAllEffects) {
        if (!session.stage->possibleEffects().contains(effect)) {
            continue;
        }
        if (const int place = shown++ % kColumns; place != 0) {
            ImGui::SameLine(ImGui::GetStyle().WindowPadding.x + column * static_cast<float>(place));
        }
        const std::string name(nameOf(effect));
        const bool isDeclared = session.stage->effects().set().contains(effect);
        check(name, isDeclared, "effect " + name + (isDeclared ? " off" : " on"));
    }
    ImGui::PopStyleVar();
    if (const auto& proximity = session.stage->effects().proximity) {
        slide("agent radius [m]", proximity->radius, 0.5F, 30, "radius", 1, "%.1f");
    }
}

void Panel::Switches::showGrid() const {
    if (!ImGui::CollapsingHeader("broadphase and grid", ImGuiTreeNodeFlags_DefaultOpen)) {
        return;
    }
    choose("broadphase (B)", std::string(session.stage->broadphase().name), "broadphase",
           broadphaseKinds(), &BroadphaseKind::name);
    check("verify all pairs (V)", session.isChecking, "check");
    const GridConfig config = session.stage->effects().grid;
    slide("cell size [m]", config.cellSize, 0, 100, "cell", 1,
          config.cellSize == 0 ? "automatic" : "%.1f", ImGuiSliderFlags_Logarithmic);
    if (config.cellSize > 0) {
        slide("level ratio", config.levelRatio, 2, 16, "ratio", 0, "%.0f");
    }
    if (const Grid<float>* grid = session.stage->grid()) {
        numberRow("finest cell size [m]", fixed(double{grid->cellSize()}, 2));
    }
}

void Panel::Switches::showView() const {
    if (!ImGui::CollapsingHeader("view")) {
        return;
    }
    for (std::size_t i = 0; i < kCameraModes.size(); ++i) {
        if (i > 0) {
            ImGui::SameLine();
        }
        const std::string name(kCameraModes[i]);
        if (ImGui::RadioButton(name.c_str(),
                               static_cast<std::size_t>(session.camera.mode()) == i)) {
            run("camera " + name);
        }
    }
    check("freeze frustum (F)", session.frozen.has_value(), "freeze");
    for (std::size_t i = 0; i < kOverlays.size(); ++i) {
        if (i > 0) {
            ImGui::SameLine();
        }
        const std::string name(kOverlays[i]);
        check(name, session.options.overlays[i], "overlay " + name);
    }
    choose("colour by (M)",
           std::string(kColourings[static_cast<std::size_t>(session.options.colouring)]), "colour",
           kColourings);
    slide("smallest radius [pixels]", session.options.dots, 0, 8, "dots", 1, "%.1f");
    press("light or dark theme (T)", "theme", true);
}

}  // namespace hashphase::demos
