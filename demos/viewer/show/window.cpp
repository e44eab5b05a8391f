// SPDX-License-Identifier: Zlib
#include <demos/viewer/show/window.hpp>

#include <demos/console/format.hpp>
#include <demos/report/stopwatch.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/viewer/session/commands.hpp>
#include <demos/viewer/show/viewer.hpp>

#include <epoxy/gl.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

namespace hashphase::demos {
namespace {

constexpr double kClickReach = 4;       // a drag begins beyond it [pixels]
constexpr double kTurnPerPixel = 0.2;   // [degrees]
constexpr double kStillSeconds = 0.25;  // between the pictures of what stands still [s]

int keyOf(std::string_view name) {
    static const std::map<std::string_view, int> kNamedKeys{
        {"Home", GLFW_KEY_HOME}, {"Delete", GLFW_KEY_DELETE}, {"Escape", GLFW_KEY_ESCAPE},
        {"Tab", GLFW_KEY_TAB},   {"F1", GLFW_KEY_F1},         {"F5", GLFW_KEY_F5},
        {"F10", GLFW_KEY_F10},   {"F12", GLFW_KEY_F12}};
    const auto named = kNamedKeys.find(name);
    return named != kNamedKeys.end() ? named->second : name.front();  // GLFW's codes are ASCII's
}

std::string line(std::string_view command, std::initializer_list<double> numbers) {
    std::string text(command);
    for (const double number : numbers) {
        text += " " + plain(number);
    }
    return text;
}

[[noreturn]] void refuse() {
    const char* reason = nullptr;
    glfwGetError(&reason);
    throw InputError(std::string("No window can be opened: ") +
                     (reason != nullptr ? reason : "there is no OpenGL 3.3") +
                     ". Without a display use --headless, or xvfb-run -s \"-screen 0 1280x800x24\" "
                     "before the command.");
}

/// The window, with an OpenGL context that is current while it lives; and what comes from the keyboard and the
/// mouse until the next frame. Places are the window's, which is as large as the picture or not; commands and
/// the panel have those of the picture.
struct Window {
    Window(int width, int height);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    static Window& of(GLFWwindow* window) {
        return *static_cast<Window*>(glfwGetWindowUserPointer(window));
    }
    void setCallbacks();
    void onKey(int key);
    void onButton(int button, bool isPressed);
    void onMove(double x, double y);
    void steer(const Session& session, double seconds);
    void listen(Session& session, Viewer& viewer, double seconds);
    void present(Session& session, Viewer& viewer, double seconds);
    void rest(const Session& session, double frameSeconds) const;
    [[nodiscard]] Pixel inPicture(const Pixel& place) const { return place.cwiseProduct(scale); }
    [[nodiscard]] bool isDown(int key) const { return glfwGetKey(handle, key) == GLFW_PRESS; }

    GLFWwindow* handle = nullptr;
    std::vector<std::string> commands;
    Panel::Pointer pointer;
    bool overPanel = false;
    std::optional<Pixel> pressedAt;  // the left button, on the scene
    bool isDragging = false;
    bool isSteering = false;  // by keys that are held down
    // The pointer's buttons are down for a frame at least, so that no click is lost.
    bool leftIsDown = false;
    bool rightIsDown = false;
    Pixel lastAt{0, 0};
    Pixel scale{1, 1};  // of the picture, by the window
};

void Window::setCallbacks() {
    glfwSetWindowUserPointer(handle, this);
    glfwSetKeyCallback(handle, [](GLFWwindow* from, int key, int, int action, int modifiers) {
        constexpr int kNotOurs = GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER;
        if (action == GLFW_PRESS && (modifiers & kNotOurs) == 0) {
            of(from).onKey(key);
        }
    });
    glfwSetMouseButtonCallback(handle, [](GLFWwindow* from, int button, int action, int) {
        of(from).onButton(button, action == GLFW_PRESS);
    });
    glfwSetCursorPosCallback(handle,
                             [](GLFWwindow* from, double x, double y) { of(from).onMove(x, y); });
    glfwSetScrollCallback(handle, [](GLFWwindow* from, double, double steps) {
        Window& input = of(from);
        input.pointer.wheel += static_cast<float>(steps);
        if (!input.overPanel) {
            input.commands.push_back(line("zoom", {std::pow(1.15, steps)}));
        }
    });
    glfwSetFramebufferSizeCallback(handle, [](GLFWwindow* from, int width, int height) {
        if (width >= 16 && height >= 16) {
            of(from).commands.push_back(line("size", {double(width), double(height)}));
        }
    });
}

void Window::onKey(int key) {
    for (const KeyBinding& binding : keyBindings()) {
        if (keyOf(binding.key) == key) {
            commands.emplace_back(binding.command);
        }
    }
}

void Window::onButton(int button, bool isPressed) {
    if (button == GLFW_MOUSE_BUTTON_RIGHT) {
        rightIsDown = isPressed;
        pointer.right = pointer.right || isPressed;
    }
    if (button != GLFW_MOUSE_BUTTON_LEFT) {
        return;
    }
    leftIsDown = isPressed;
    pointer.left = pointer.left || isPressed;
    if (isPressed && !overPanel) {
        pressedAt = lastAt;
    } else if (!isPressed && pressedAt) {
        const Pixel from = inPicture(*std::exchange(pressedAt, std::nullopt));
        const Pixel to = inPicture(lastAt);
        commands.push_back(std::exchange(isDragging, false)
                               ? line("box", {from.x(), from.y(), to.x(), to.y()})
                               : line("pick", {from.x(), from.y()}));
    }
}

void Window::onMove(double x, double y) {
    const Pixel way = Pixel(x, y) - lastAt;
    lastAt = {x, y};
    const Pixel at = inPicture(lastAt);
    pointer.x = static_cast<float>(at.x());
    pointer.y = static_cast<float>(at.y());
    if (pressedAt && (lastAt - *pressedAt).norm() > kClickReach) {
        isDragging = true;
    }
    if (isDragging) {
        const Pixel from = inPicture(*pressedAt);
        commands.push_back(line("drag", {from.x(), from.y(), at.x(), at.y()}));
    }
    if (rightIsDown && !overPanel) {
        commands.push_back(line("turn", {-kTurnPerPixel * way.x(), -kTurnPerPixel * way.y()}));
    }
}

// While keys are held down.
void Window::steer(const Session& session, double seconds) {
    const auto held = [this](int plus, int minus) {
        return (isDown(plus) ? 1.0 : 0.0) - (isDown(minus) ? 1.0 : 0.0);
    };
    const double pace = 0.15 * double{session.stage->bounds().sizes().norm()} * seconds;
    const double right = pace * held(GLFW_KEY_D, GLFW_KEY_A);
    const double up = pace * held(GLFW_KEY_E, GLFW_KEY_Q);
    const double forward = pace * held(GLFW_KEY_W, GLFW_KEY_S);
    if (right != 0 || up != 0 || forward != 0) {
        commands.push_back(line("move", {right, up, forward}));
    }
    const double left = 60 * seconds * held(GLFW_KEY_LEFT, GLFW_KEY_RIGHT);
    const double higher = 60 * seconds * held(GLFW_KEY_UP, GLFW_KEY_DOWN);
    isSteering = right != 0 || up != 0 || forward != 0 || left != 0 || higher != 0;
    if (left != 0 || higher != 0) {
        commands.push_back(line("turn", {left, higher}));
    }
}

Window::Window(int width, int height) {
    if (glfwInit() != GLFW_TRUE) {
        refuse();
    }
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    handle = glfwCreateWindow(width, height, "hashphase wander", nullptr, nullptr);
    if (handle == nullptr) {
        glfwTerminate();
        refuse();
    }
    glfwMakeContextCurrent(handle);
    glfwSwapInterval(1);
    setCallbacks();
}

Window::~Window() {
    glfwDestroyWindow(handle);
    glfwTerminate();
}

// What has been pressed and moved since the last frame becomes commands, and they are run.
void Window::listen(Session& session, Viewer& viewer, double seconds) {
    int width = 0;
    int height = 0;
    glfwGetWindowSize(handle, &width, &height);
    if (width > 0 && height > 0) {  // it has none while it is an icon
        scale = {double(session.width) / width, double(session.height) / height};
    }
    glfwPollEvents();
    steer(session, std::min(seconds, 0.1));
    for (const std::string& command : std::exchange(commands, {})) {
        viewer.panel().run(session, command);
    }
}

void Window::present(Session& session, Viewer& viewer, double seconds) {
    int width = 0;
    int height = 0;
    glfwGetFramebufferSize(handle, &width, &height);
    const bool fits = width == session.width && height == session.height;
    const Stopwatch watch;
    try {
        viewer.show(session, pointer, seconds, fits);
    } catch (const InputError& error) {  // a picture that cannot be written
        viewer.panel().say(error.what(), true);
    }
    pointer.wheel = 0;
    pointer.left = leftIsDown;
    pointer.right = rightIsDown;
    if (viewer.framebuffer() != 0) {
        glBindFramebuffer(GL_READ_FRAMEBUFFER, viewer.framebuffer());
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
        glBlitFramebuffer(0, 0, session.width, session.height, 0, 0, width, height,
                          GL_COLOR_BUFFER_BIT, GL_NEAREST);
    }
    glfwSwapBuffers(handle);
    viewer.keepPace(watch.milliseconds() / 1000);
}

// No frame is shorter than the scene's, or it would run too fast. What stands still is drawn again when
// somebody does something, and now and then.
void Window::rest(const Session& session, double frameSeconds) const {
    const bool isBusy = isSteering || leftIsDown || rightIsDown;
    if (!session.isPlaying && !session.isWaiting() && !isBusy) {
        glfwWaitEventsTimeout(kStillSeconds);
    }
    const Stopwatch watch;
    double left = double{kFrameSeconds} - frameSeconds;
    while (left > 0) {
        glfwWaitEventsTimeout(left);
        left = double{kFrameSeconds} - frameSeconds - watch.milliseconds() / 1000;
    }
}

}  // namespace

FrameRate showInWindow(Session& session, std::uint64_t frames, const std::function<bool()>& isDone,
                       const std::function<void(std::string_view)>& guard) {
    Window window(session.width, session.height);
    Viewer viewer(session.width, session.height);
    viewer.panel().guard = guard;
    FrameRate rate;
    const Stopwatch watch;
    double before = 0;  // [s]
    while (glfwWindowShouldClose(window.handle) == GLFW_FALSE &&
           (frames == 0 || session.frame < frames) && !isDone() && !session.isOver) {
        const double now = watch.milliseconds() / 1000;
        const double seconds = now - std::exchange(before, now);
        window.listen(session, viewer, seconds);
        session.advance();
        window.present(session, viewer, seconds);
        for (const std::string& message : session.takeMessages()) {
            viewer.panel().say(message);
        }
        window.overPanel = viewer.panel().hasPointer();
        window.rest(session, watch.milliseconds() / 1000 - now);
        rate.note(watch.milliseconds() / 1000);
    }
    return rate;
}

}  // namespace hashphase::demos
