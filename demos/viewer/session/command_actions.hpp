// SPDX-License-Identifier: Zlib
#pragma once

// What each command of commands.cpp does. All take the command's words, and nothing may be left of them.

#include <demos/viewer/session/arguments.hpp>
#include <demos/viewer/session/session.hpp>

#include <array>
#include <string_view>

namespace hashphase::demos::actions {

/// Of a reading to a number.
inline constexpr std::array<std::string_view, 6> kRelations{"=", "!=", "<", "<=", ">", ">="};

// The scene, and what runs (scene_actions.cpp).
void scene(Session& session, Arguments& words);
void objects(Session& session, Arguments& words);
void seed(Session& session, Arguments& words);
void restart(Session& session, Arguments& words);
void pause(Session& session, Arguments& words);
void step(Session& session, Arguments& words);
void effect(Session& session, Arguments& words);
void broadphase(Session& session, Arguments& words);
void check(Session& session, Arguments& words);
void cell(Session& session, Arguments& words);
void ratio(Session& session, Arguments& words);
void radius(Session& session, Arguments& words);

// The camera, who is selected, and how it is shown (view_actions.cpp).
void camera(Session& session, Arguments& words);
void home(Session& session, Arguments& words);
void move(Session& session, Arguments& words);
void turn(Session& session, Arguments& words);
void zoom(Session& session, Arguments& words);
void eye(Session& session, Arguments& words);
void pose(Session& session, Arguments& words);
void freeze(Session& session, Arguments& words);
void size(Session& session, Arguments& words);
void pick(Session& session, Arguments& words);
void box(Session& session, Arguments& words);
void drag(Session& session, Arguments& words);
void clear(Session& session, Arguments& words);
void push(Session& session, Arguments& words);
void remove(Session& session, Arguments& words);
void recolour(Session& session, Arguments& words);
void colour(Session& session, Arguments& words);
void overlay(Session& session, Arguments& words);
void dots(Session& session, Arguments& words);
void theme(Session& session, Arguments& words);
void panel(Session& session, Arguments& words);
void help(Session& session, Arguments& words);

// Files and numbers (file_actions.cpp).
void screenshot(Session& session, Arguments& words);
void save(Session& session, Arguments& words);
void capture(Session& session, Arguments& words);
void print(Session& session, Arguments& words);
void quit(Session& session, Arguments& words);
void expect(Session& session, Arguments& words);

}  // namespace hashphase::demos::actions
