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

// Its parent ends first; then it steps for a second, under another name.
int renamedOrphan() {
    if (fork() != 0) {
        return 0;
    }
    std::fill(environ[0], environ[0] + std::strlen(environ[0]), 'x');
    for (char** variable = environ + 1; *variable != nullptr; ++variable) {
        std::fill(*variable, *variable + std::strlen(*variable), 'x');
    }
    Scene<> scene;
    addPile(scene);
    for (int i = 0; i < 100; ++i) {
        scene.step(1);
        usleep(5000);
    }
    std::puts("the orphan has ended");
    return 9;
}

// Becomes another program, after some steps.
int restarts() {
    {
        Scene<> scene;
        addPile(scene);
        scene.step(5);
    }
    std::fflush(stdout);
    return execl("/proc/self/exe", "stock-programs", "started", nullptr);
}

// Starts another program and ends, at once or while that takes its time to begin.
int launcher(const char* program, unsigned milliseconds) {
    if (fork() == 0) {
        usleep(milliseconds * 1000);
        execl("/proc/self/exe", "stock-programs", program, nullptr);
    }
    return 0;
}

// Goes on in a process of its own after some steps.
int forksWithAWorld() {
    Scene<> scene;
    addPile(scene);
    scene.step(5);
    if (fork() == 0) {
        scene.step(5);
        _exit(0);
    }
    wait(nullptr);
    return 0;
}

// Says whether its broadphase has trees, and starts itself once more to say so.
int starter(bool isFirst) {
    Scene<> scene;
    addPile(scene);
    scene.step(5);
    std::printf("%s has %s\n", isFirst ? "first" : "second",
                scene.broadphase.m_sets[0].m_root != nullptr ? "trees" : "none");
    std::fflush(stdout);
    if (isFirst && fork() == 0) {
        execl("/proc/self/exe", "stock-programs", "started", nullptr);
    }
    wait(nullptr);
    return 0;
}

// Steps a world of another broadphase, and starts one whose broadphase can be taken over.
int simpleStarter() {
    Scene<btSimpleBroadphase> scene;
    scene.add(scene.things.shape<btSphereShape>(btScalar(1)), 1, {0, 0, 0});
    scene.step(10);
    std::fflush(stdout);
    if (fork() == 0) {
        execl("/proc/self/exe", "stock-programs", "started", nullptr);
    }
    wait(nullptr);
    return 0;
}

// Leaves behind a process, for a minute, whose child has stepped a world, is dead, and never waited for.
int leavesZombie() {
    int ends[2];
    if (pipe(ends) != 0) {
        return 1;
    }
    if (fork() == 0) {
        if (fork() == 0) {
            Scene<> scene;
            addPile(scene);
            scene.step(5);
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
    return static_cast<int>(read(ends[0], &byte, 1));  // returns when the grandchild has ended
}

int readsInput() {
    Scene<> scene;
    addPile(scene);
    scene.step(1);
    char line[64] = "";
    std::printf("read %s", std::fgets(line, sizeof(line), stdin) != nullptr ? line : "nothing\n");
    return 0;
}

// Waits for a line before it makes a world.
int waitsForInput() {
    char line[64] = "";
    return std::fgets(line, sizeof(line), stdin) != nullptr ? readsInput() : 1;
}

}  // namespace

const std::vector<Program>& processPrograms() {
    static const std::vector<Program> list{
        {"renamed-orphan", renamedOrphan},
        {"reads-input", readsInput},
        {"waits-for-input", waitsForInput},
        {"restarts", restarts},
        {"launcher", [] { return launcher("started", 0); }},
        {"slow-launcher", [] { return launcher("started", 300); }},
        {"crash-launcher", [] { return launcher("crashes-without-trees", 100); }},
        {"forks-with-a-world", forksWithAWorld},
        {"starter", [] { return starter(true); }},
        {"started", [] { return starter(false); }},
        {"simple-starter", simpleStarter},
        {"leaves-zombie", leavesZombie}};
    return list;
}

}  // namespace programs
