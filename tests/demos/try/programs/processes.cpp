// SPDX-License-Identifier: Zlib

// Programs of several processes, and what they read.

#include "program.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>

#include <sys/wait.h>
#include <unistd.h>

namespace programs {
namespace {

// Becomes the program of that name.
void become(const char* name) {
    execl("/proc/self/exe", "stock-programs", name, nullptr);
}

// Its parent ends first; then it steps for a second, under another name.
PROGRAM(renamedOrphan) {
    if (fork() != 0) {
        return;
    }
    for (char** variable = environ; *variable != nullptr; ++variable) {
        std::fill(*variable, *variable + std::strlen(*variable), 'x');
    }
    Pile scene;
    for (int i = 0; i < 100; ++i) {
        scene.step(1);
        usleep(5000);
    }
    std::puts("the orphan has ended");
    exitStatus = 9;
}

// Becomes another program, after some steps.
PROGRAM(restarts) {
    { const Pile scene(5); }
    std::fflush(stdout);
    become("started");
}

// Starts another program and ends, at once or while that takes its time to begin.
void launch(const char* program, unsigned milliseconds) {
    if (fork() == 0) {
        usleep(milliseconds * 1000);
        become(program);
    }
}

PROGRAM(launcher) {
    launch("started", 0);
}

PROGRAM(slowLauncher) {
    launch("started", 300);
}

PROGRAM(crashLauncher) {
    launch("crashesWithoutTrees", 100);
}

// Goes on in a process of its own after some steps.
PROGRAM(forksWithAWorld) {
    Pile scene(5);
    if (fork() == 0) {
        scene.step(5);
        _exit(0);
    }
    wait(nullptr);
}

void startAnother() {
    std::fflush(stdout);
    if (fork() == 0) {
        become("started");
    }
    wait(nullptr);
}

// Says whether its broadphase has trees.
void sayTrees(const char* name, const Pile& scene) {
    std::printf("%s has %s\n", name,
                scene.broadphase.m_sets[0].m_root != nullptr ? "trees" : "none");
}

PROGRAM(started) {
    sayTrees("second", Pile(5));
}

// Says so, and starts another one that does.
PROGRAM(starter) {
    const Pile scene(5);
    sayTrees("first", scene);
    startAnother();
}

// Steps a world of another broadphase, and starts one whose broadphase can be taken over.
PROGRAM(simpleStarter) {
    Scene<btSimpleBroadphase> scene;
    scene.add(scene.things.sphere(1), 1, {0, 0, 0});
    scene.step(10);
    startAnother();
}

// Leaves behind a process, for a minute, whose child has stepped a world, is dead, and never waited for.
PROGRAM(leavesZombie) {
    int ends[2];
    if (pipe(ends) != 0) {
        exitStatus = 1;
        return;
    }
    if (fork() == 0) {
        if (fork() == 0) {
            const Pile scene(5);
            _exit(0);
        }
        for (int file : {0, 1, 2, ends[0], ends[1]}) {
            close(file);
        }
        sleep(60);
        _exit(0);
    }
    close(ends[1]);
    char byte = 0;
    exitStatus = static_cast<int>(read(ends[0], &byte, 1));  // waits for the grandchild's end
}

PROGRAM(readsInput) {
    const Pile scene(1);
    char line[64] = "";
    std::printf("read %s", std::fgets(line, sizeof(line), stdin) != nullptr ? line : "nothing\n");
}

// Waits for a line before it makes a world.
PROGRAM(waitsForInput) {
    char line[64] = "";
    if (std::fgets(line, sizeof(line), stdin) != nullptr) {
        readsInput();
    } else {
        exitStatus = 1;
    }
}

}  // namespace
}  // namespace programs
