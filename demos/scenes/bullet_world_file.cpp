// SPDX-License-Identifier: Zlib
#include <demos/scenes/bullet_world_file.hpp>

#include <demos/scenes/file_bytes.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/system/interruption.hpp>

#if HASHPHASE_HAS_BULLET_IMPORTER
#include <BulletWorldImporter/btBulletWorldImporter.h>

#include <csignal>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

namespace hashphase::demos {
namespace {

std::string readChecked(const std::filesystem::path& path) {
    std::string bytes = readFile(path);
    const std::string fault = bulletFileFault(bytes);
    if (!fault.empty()) {
        throw InputError(path.string() + ": " + fault + ".");
    }
    return bytes;
}

}  // namespace

#if HASHPHASE_HAS_BULLET_IMPORTER

namespace {

// The importer together with its own copy of the bytes, into which it may write.
struct Import {
    Import(btDynamicsWorld& world, std::string fileBytes)
        : bytes(std::move(fileBytes)), importer(&world) {}
    Import(const Import&) = delete;
    Import& operator=(const Import&) = delete;
    ~Import() { importer.deleteAllData(); }

    std::string bytes;
    btBulletWorldImporter importer;
};

void importAndStep(const BulletWorldFile& file) {
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher(&configuration);
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
    WorldContents contents(world);
    file.fill(contents);
    const btScalar step = btScalar(1) / btScalar(60);
    world.stepSimulation(step, 0);
    world.stepSimulation(step, 0);
}

// Damage inside the chunks (pointers, indices, sizes of shapes) passes every check of the outer
// shape and may crash Bullet or keep it busy for ever. So the file is tried in a process of its own.
bool survivesImport(const BulletWorldFile& file, const TellWaiting& tell) {
    constexpr unsigned kPatience = 30;  // [s]
    const pid_t child = fork();
    if (child == 0) {
        const int nowhere = open("/dev/null", O_WRONLY);
        dup2(nowhere, STDOUT_FILENO);
        dup2(nowhere, STDERR_FILENO);
        alarm(kPatience);
        try {
            importAndStep(file);
        } catch (const InputError&) {
            // A clean refusal, which the caller will meet again.
        }
        _exit(0);
    }
    if (child < 0) {
        return true;
    }
    int status = 0;
    pid_t ended = 0;
    for (std::chrono::microseconds nap{100}; (ended = waitpid(child, &status, WNOHANG)) == 0;) {
        std::this_thread::sleep_for(nap);
        nap = std::min(2 * nap, std::chrono::microseconds{20'000});
        if (isInterrupted()) {
            kill(child, SIGKILL);
            waitpid(child, &status, 0);
            throw Interrupted();
        }
        if (tell) {
            tell("Bullet's importer tries the file");
        }
    }
    return ended != child || status == 0;
}

}  // namespace

BulletWorldFile::BulletWorldFile(const std::filesystem::path& path, const TellWaiting& tell)
    : path_(path.string()), bytes_(readChecked(path)), omissions_(bulletFileOmissions(bytes_)) {
    if (!survivesImport(*this, tell)) {
        throw InputError(path_ +
                         ": Bullet's importer crashes on the file or does not finish: the file is "
                         "damaged inside its chunks.");
    }
}

void BulletWorldFile::fill(WorldContents& contents) const {
    auto import = std::make_shared<Import>(contents.world(), bytes_);
    const bool loaded =
        import->importer.loadFileFromMemory(import->bytes.data(), static_cast<int>(bytes_.size()));
    if (!loaded) {
        throw InputError(path_ + ": Bullet's importer refuses the file.");
    }
    contents.keep(std::move(import));
    if (contents.world().getNumCollisionObjects() == 0) {
        throw InputError(path_ + ": Bullet's importer finds no collision object in the file.");
    }
}

#else

BulletWorldFile::BulletWorldFile(const std::filesystem::path& path, const TellWaiting& /*tell*/)
    : path_(path.string()), bytes_(readChecked(path)), omissions_(bulletFileOmissions(bytes_)) {}

void BulletWorldFile::fill(WorldContents& /*contents*/) const {
    throw InputError(path_ +
                     ": .bullet files need Bullet's world importer (Debian package "
                     "libbullet-extras-dev), but this program was built without it.");
}

#endif

}  // namespace hashphase::demos
