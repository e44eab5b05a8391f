// SPDX-License-Identifier: Zlib
#pragma once

// What the viewer shows and how it is played with, without a window: a scene on stage, a camera, what is
// selected, what is laid over it. A window, a script and a replay steer it by the same commands, one line
// each (commands.hpp), and all that can be seen can be read as numbers.
//
//     Session session({.name = "wander", .objects = 1000});
//     session.run("step 10");
//     session.advance();                     // until isWaiting()
//     session.run("pick 640 400");
//     session.reading("neighbours");
//
// Errors   A command that cannot be done throws InputError with a sentence, and nothing has changed.
// Threads  one at a time
// Units    metres, seconds; on the screen pixels, from the upper left corner

#include <demos/viewer/draw/picture.hpp>
#include <demos/viewer/session/box_recorder.hpp>
#include <demos/viewer/session/camera.hpp>
#include <demos/viewer/session/command_log.hpp>
#include <demos/viewer/session/scene_choice.hpp>
#include <demos/viewer/session/stage_queries.hpp>
#include <demos/viewer/stage/stage.hpp>

#include <integration/culling/culler.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hashphase::demos {

/// What the colour of a body tells.
enum class Colouring : std::uint8_t { agents, cells, load, speed, pairs, rest };
inline constexpr std::array<std::string_view, 6> kColourings{"agents", "cells", "load",
                                                             "speed",  "pairs", "rest"};

/// What is shown of the scene, and laid over it.
enum class Overlay : std::uint8_t { bodies, grid, heat, boxes, pairs };
inline constexpr std::array<std::string_view, 5> kOverlays{"bodies", "grid", "heat", "boxes",
                                                           "pairs"};

inline constexpr std::array<std::string_view, 2> kThemes{"light", "dark"};

/// How wide and high a picture can be [pixels]; twice as much each way would take 4 GB.
inline constexpr int kLeastSide = 16;
inline constexpr int kMostSide = 8192;

/// How it is shown; none of it changes what happens.
struct ViewOptions {
    Colouring colouring = Colouring::agents;
    std::array<bool, kOverlays.size()> overlays{true, true};  // bodies and grid
    float dots = 1.2F;  // bodies are drawn at least with this radius [pixels]
    Theme theme = Theme::light;
    bool panel = true;
    bool help = false;

    [[nodiscard]] bool has(Overlay overlay) const {
        return overlays[static_cast<std::size_t>(overlay)];
    }
};

/// What frames took with the broadphase before the present one.
struct FormerTimes {
    std::string_view broadphase;
    PhaseHistory history;
};

/// Its data are for whoever shows it to read; commands change them.
struct Session {
    /// Throws InputError as makeStage() does.
    explicit Session(const SceneChoice& chosen, int wide = 1280, int high = 800);

    /// Does what the line says. Lines that are empty or comments do nothing.
    void run(std::string_view line);

    /// A frame of the viewer: simulates one of the scene, if it plays or steps are waited for, and looks. Before
    /// a frame that may take long the scene stands still for two, so that whoever looks on can read why.
    void advance();

    /// Whether steps that were asked for have not been simulated.
    [[nodiscard]] bool isWaiting() const noexcept { return stepsWaiting > 0; }

    // --- What commands do ------------------------------------------------------------------------

    /// Puts a scene on stage from its beginning. Where it is another one, it is declared as it is by itself,
    /// and the camera goes home; else all that is declared, the broadphase and the camera stay, which goes home
    /// where other numbers of bodies take other room.
    void choose(const SceneChoice& chosen);
    /// Plays no more after so many frames. A capture takes up those that are simulated later.
    void askForSteps(std::uint64_t count);
    void declare(const SceneEffects& effects);
    /// Declares these effects and no others: each with what the scene says of it by itself, or with defaults
    /// where it says nothing. The grid's variables and the radius of proximity stay as they are.
    void declare(EffectSet effects);
    /// Says beforehand what to expect where so many bodies are too many for it: see advance(). With another one
    /// the history begins again, and the former one is kept, unless no frame was simulated with it.
    void setBroadphase(const BroadphaseKind& kind);
    void setChecking(bool isOn);
    void freeze(bool isFrozen);
    void goHome();
    /// Throws InputError where nobody is picked to be followed.
    void setCameraMode(CameraMode mode);

    /// Picks what is at the pixel, or nobody; what was selected is not any more.
    void pick(const Pixel& pixel);
    /// Selects what is between two pixels.
    void selectBetween(const Pixel& a, const Pixel& b);
    void forgetSelection();
    /// Returns how many it was done to.
    std::size_t removeSelected();
    std::size_t recolourSelected();

    /// Writes the boxes of all bodies, of now and of so many frames, which are waited for and taken as they are
    /// simulated; says when the file is there, and notes a failure where that cannot be. One at a time. Who
    /// plays goes on playing after it.
    void capture(const std::string& path, int frames);
    /// Gives up a capture that is not complete, and says why: "the scene ends".
    void endCapture(const std::string& reason);

    void askForScreenshot(const std::string& path);
    void say(const std::string& message) { messages.push_back(message); }
    void noteFailure(const std::string& message);

    // --- What is to be seen ----------------------------------------------------------------------

    [[nodiscard]] CameraPose pose() const;
    [[nodiscard]] hashphase::Camera<float> view() const;

    /// Whether it was when the scene was looked at for the last time, for a frame or for a screenshot.
    [[nodiscard]] bool isVisible(std::uint32_t index) const;
    /// By the camera of now. Cost: where it has moved since, that of a look.
    [[nodiscard]] std::size_t visibleCount() const;

    /// Of the last frame; none while it is not checked or cannot be, and none since another broadphase or
    /// something else was declared or bodies were removed, as nobody has looked for pairs since.
    [[nodiscard]] const PairCheck* check() const;
    /// Whether it is checked from the next frame on at the latest: pairs are declared, and not swept.
    [[nodiscard]] bool canCheck() const;

    /// A number that can be seen, by its name. Throws InputError for others, and for what there is not, such
    /// as the neighbours of nobody.
    [[nodiscard]] double reading(std::string_view name) const;

    /// The same where in each frame since the scene began bodies were at the same places and agents had the same
    /// colours, to the last bit. Whoever found the pairs: Bullet's broadphases list more than overlap.
    [[nodiscard]] std::uint64_t hash() const noexcept { return log.hash; }

    /// Files that a picture of this moment is to be written to; and what is to be said.
    [[nodiscard]] std::vector<std::string> takeScreenshots() {
        return std::exchange(screenshots, {});
    }
    [[nodiscard]] std::vector<std::string> takeMessages() { return std::exchange(messages, {}); }

    // --- Data ------------------------------------------------------------------------------------

    SceneChoice choice;
    std::unique_ptr<Stage> stage;
    SceneEffects ownEffects;  // those that the scene declares by itself
    Camera camera;
    ViewOptions options;
    int width;
    int height;
    bool isPlaying = true;
    std::uint64_t stepsWaiting = 0;
    int framesToRead = 0;  // in which the scene stands still for what was said
    std::uint64_t frame = 0;
    std::uint64_t sceneCount = 0;  // scenes that have been put on stage

    /// The camera whose view decides what is visible, where it was frozen.
    std::optional<CameraPose> frozen;
    Culler<float> ownCuller;  // where the camera has moved since the stage's has looked
    bool usesOwnCuller = false;

    std::vector<std::uint32_t> selected;    // sorted
    std::vector<std::uint32_t> recoloured;  // sorted
    std::optional<std::uint32_t> picked;
    std::optional<InfoCard> card;
    std::optional<DrawnRectangle> rectangle;

    bool isChecking = false;
    bool knowsPairs = false;  // whether the stage's are those of its bodies
    PairCheck pairCheck;      // see check()
    CellLoads loads;  // of the last frame; empty while nobody shows them, and without a grid
    std::vector<PairKey>
        pairs;  // those that the broadphase has found, sorted; none while nobody shows them
    PhaseHistory history;               // with the present broadphase
    std::optional<FormerTimes> former;  // none before the scene's first swap

    CommandLog log;
    std::unique_ptr<BoxRecorder> recorder;  // one that is not complete; else null
    std::vector<std::string> screenshots;
    std::vector<std::string> messages;
    int failureCount = 0;  // expectations that do not hold
    bool isOver = false;   // ended by a command

private:
    void beginAnew(bool goesHome);
    void captureFrame();
    [[nodiscard]] std::uint64_t frameHash() const;
    [[nodiscard]] ConvexRegion<float> seenRegion() const;
    [[nodiscard]] const Culler<float>& culler() const;
    void aim();
    void look();
    void see();
};

/// A number that can be seen.
struct Reading {
    std::string_view name;
    std::string_view help;                       // what it is, and its unit
    std::function<double(const Session&)> read;  // throws InputError where there is none
};

[[nodiscard]] std::span<const Reading> readings();

/// "1 body", "30,000 bodies".
[[nodiscard]] std::string bodiesText(std::uint64_t count);

}  // namespace hashphase::demos
