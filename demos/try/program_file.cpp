// SPDX-License-Identifier: Zlib
#include <demos/try/program_file.hpp>

#include <demos/console/format.hpp>
#include <demos/scenes/input_error.hpp>
#include <demos/try/running_program.hpp>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string_view>

#include <elf.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace hashphase::demos {
namespace {

constexpr const char* kCollisionLibrary = "libBulletCollision";

bool isExecutable(const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::is_regular_file(path, error) && access(path.c_str(), X_OK) == 0;
}

// --- The ELF file --------------------------------------------------------------------------------

#if defined(__x86_64__)
constexpr Elf64_Half kMachine = EM_X86_64;
#elif defined(__aarch64__)
constexpr Elf64_Half kMachine = EM_AARCH64;
#else
constexpr Elf64_Half kMachine = EM_NONE;
#endif

template <class Plain>
bool readAt(std::ifstream& file, std::uint64_t offset, Plain& into) {
    file.seekg(static_cast<std::streamoff>(offset));
    return static_cast<bool>(file.read(reinterpret_cast<char*>(&into), sizeof(into)));
}

// The dynamic loader that the program asks for; nothing where it asks for none.
std::optional<std::string> interpreterOf(std::ifstream& file, const Elf64_Ehdr& header) {
    for (std::uint64_t i = 0; i < header.e_phnum; ++i) {
        Elf64_Phdr part{};
        if (!readAt(file, header.e_phoff + i * header.e_phentsize, part)) {
            return std::nullopt;
        }
        constexpr std::uint64_t kLongestPath = 4096;
        if (part.p_type == PT_INTERP && part.p_filesz < kLongestPath) {
            std::string path(part.p_filesz, '\0');
            file.seekg(static_cast<std::streamoff>(part.p_offset));
            file.read(path.data(), static_cast<std::streamsize>(path.size()));
            return file ? std::optional(std::string(path.c_str())) : std::nullopt;
        }
    }
    return std::nullopt;
}

// Throws InputError for a file that is no program of this machine, and for a static program.
std::string loaderOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        throw InputError(
            path + " cannot be read, so its libraries are unknown: you need the right to read it.");
    }
    Elf64_Ehdr header{};
    const bool isWhole = readAt(file, 0, header);
    if (header.e_ident[0] == '#' && header.e_ident[1] == '!') {
        throw InputError(
            path +
            " is a script: name the program that it starts, or the script's interpreter "
            "with --precision.");
    }
    if (!isWhole || !std::equal(ELFMAG, ELFMAG + SELFMAG, header.e_ident) ||
        header.e_ident[EI_CLASS] != ELFCLASS64 || header.e_machine != kMachine) {
        throw InputError(path + " is not a 64-bit program for this machine.");
    }
    const std::optional<std::string> loader = interpreterOf(file, header);
    if (!loader) {
        throw InputError(path +
                         " is a static program, into which hashphase cannot be loaded: link "
                         "Bullet's shared libraries.");
    }
    return *loader;
}

// --- What is loaded ------------------------------------------------------------------------------

struct SharedLibrary {
    std::string name;  // "libm.so.6"
    std::string path;  // empty: not found
};

struct Output {
    int status = -1;
    std::string text;
};

// Both streams of a program that needs no input.
Output outputOf(std::vector<std::string> words) {
    const std::vector<char*> pointers = pointersTo(words);
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) {
        return {};
    }
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    pid_t child = 0;
    const int error = posix_spawn(&child, pointers[0], &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    Output output;
    std::array<char, 4096> buffer{};
    for (ssize_t count = 0; (count = read(ends[0], buffer.data(), buffer.size())) > 0;) {
        output.text.append(buffer.data(), static_cast<std::size_t>(count));
    }
    close(ends[0]);
    int status = 0;
    if (error == 0 && waitpid(child, &status, 0) == child && WIFEXITED(status)) {
        output.status = WEXITSTATUS(status);
    }
    return output;
}

// A line such as "\tlibm.so.6 => /lib/x86_64-linux-gnu/libm.so.6 (0x00007f9a)".
std::optional<SharedLibrary> libraryOf(const std::string& line) {
    std::istringstream words(line);
    SharedLibrary library;
    std::string arrow;
    if (!(words >> library.name >> arrow >> std::ws) || arrow != "=>") {
        return std::nullopt;
    }
    std::getline(words, library.path);
    library.path.resize(library.path.starts_with('/') ? library.path.rfind(" (") : 0);
    return library;
}

// What that loader would load for a program or library, in its order.
std::vector<SharedLibrary> sharedLibrariesOf(const std::string& path, const std::string& loader) {
    const Output output = outputOf({loader, "--list", path});
    std::vector<SharedLibrary> libraries;
    std::istringstream lines(output.text);
    for (std::string line; std::getline(lines, line);) {
        if (const std::optional<SharedLibrary> library = libraryOf(line)) {
            libraries.push_back(*library);
        }
    }
    if (output.status != 0) {
        const std::string reason = printable(output.text.substr(0, output.text.find('\n')));
        throw InputError(path + " cannot be loaded by " + loader +
                         (reason.empty() ? "" : ": " + reason) + ".");
    }
    return libraries;
}

bool fileContains(const std::string& path, const std::string& bytes) {
    std::ifstream file(path, std::ios::binary);
    const std::string content{std::istreambuf_iterator<char>(file), {}};
    return content.find(bytes) != std::string::npos;
}

std::string precisionOf(const SharedLibrary& bullet) {
    // The constructor of a capsule takes two numbers, so that its name tells them.
    if (fileContains(bullet.path, "_ZN14btCapsuleShapeC1Eff")) {
        return "single";
    }
    if (fileContains(bullet.path, "_ZN14btCapsuleShapeC1Edd")) {
        return "double";
    }
    throw InputError(bullet.path +
                     " has no btCapsuleShape, so the precision of this Bullet is unknown.");
}

// Bullet's code in the program, or in a library of its own, as its type's name tells.
void refuseStaticBullet(const std::string& path, const std::vector<SharedLibrary>& libraries) {
    std::vector<std::string> holders{path};
    for (const SharedLibrary& library : libraries) {
        holders.push_back(library.path);
    }
    for (const std::string& holder : holders) {
        if (fileContains(holder, "16btDbvtBroadphase")) {
            throw InputError(
                "Bullet is linked statically into " + holder +
                ", where hashphase cannot replace its broadphase: link Bullet's shared "
                "libraries, or swap the broadphase in the source.");
        }
    }
}

}  // namespace

std::string findProgram(const std::string& word) {
    if (word.find('/') != std::string::npos) {
        if (!isExecutable(word)) {
            throw InputError(quotedWord(word) + " is not a program that can be run.");
        }
        return word;
    }
    const char* path = std::getenv("PATH");
    std::istringstream folders(path != nullptr ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');) {
        const std::filesystem::path file =
            std::filesystem::path(folder.empty() ? "." : folder) / word;
        if (isExecutable(file)) {
            return file.string();
        }
    }
    throw InputError(quotedWord(word) + " was not found in PATH" +
                     (isExecutable(word) ? "; did you mean ./" + word + "?" : "."));
}

std::vector<std::string> bulletsOf(const std::vector<std::string>& libraries) {
    const std::string loader = loaderOf("/proc/self/exe");
    std::vector<std::string> names;
    for (const std::string& path : libraries) {
        if (access(path.c_str(), F_OK) != 0) {
            continue;
        }
        for (const SharedLibrary& library : sharedLibrariesOf(path, loader)) {
            if (library.name.starts_with(kCollisionLibrary)) {
                names.push_back(library.name);
            }
        }
    }
    return names;
}

TriedProgram inspectProgram(const std::string& path, const std::vector<std::string>& ownBullets,
                            const std::string& precision) {
    const std::vector<SharedLibrary> libraries = sharedLibrariesOf(path, loaderOf(path));
    TriedProgram program;
    program.path = path;
    for (const SharedLibrary& library : libraries) {
        if (library.name.starts_with("libasan.so") ||
            library.name.starts_with("libclang_rt.asan")) {
            program.sanitizer = library.path;
        }
    }
    const auto bullet = std::find_if(
        libraries.begin(), libraries.end(),
        [](const SharedLibrary& library) { return library.name.starts_with(kCollisionLibrary); });
    if (bullet == libraries.end()) {
        refuseStaticBullet(path, libraries);
        if (precision.empty()) {
            throw InputError(
                path +
                " links no Bullet. If it loads Bullet while it runs, give the precision "
                "of that Bullet with --precision.");
        }
        program.precision = precision;
        return program;
    }
    if (bullet->path.empty()) {
        throw InputError(path + " cannot be loaded: " + bullet->name +
                         " was not found. Install it, or set LD_LIBRARY_PATH.");
    }
    if (std::find(ownBullets.begin(), ownBullets.end(), bullet->name) == ownBullets.end()) {
        throw InputError(path + " links " + bullet->name + ", and this hashphase was built with " +
                         joined(ownBullets, " or ") +
                         ": build hashphase with the Bullet of the program.");
    }
    program.bullet = bullet->name;
    program.precision = precisionOf(*bullet);
    if (!precision.empty() && precision != program.precision) {
        throw InputError(path + " links " + bullet->name + ", which has " + program.precision +
                         " precision, not " + precision + ": leave out --precision.");
    }
    return program;
}

}  // namespace hashphase::demos
