// SPDX-License-Identifier: Zlib

// A class of that name, as a program has it that links Bullet statically.

struct btDbvtBroadphase {
    virtual ~btDbvtBroadphase() = default;
};

int main(int argc, char** /*argv*/) {
    const btDbvtBroadphase* broadphase = new btDbvtBroadphase();
    delete broadphase;
    return argc > 9 ? 1 : 0;
}
