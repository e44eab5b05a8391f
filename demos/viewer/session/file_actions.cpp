// SPDX-License-Identifier: Zlib
#include <demos/viewer/session/command_actions.hpp>

#include <demos/console/format.hpp>
#include <demos/console/result_file.hpp>

#include <array>

namespace hashphase::demos::actions {

// --- Files and numbers ---------------------------------------------------------------------------

void screenshot(Session& session, Arguments& words) {
    const std::string path = words.isEmpty() ? "hashphase.png" : words.word("FILE");
    words.end();
    session.askForScreenshot(path);
}

void save(Session& session, Arguments& words) {
    const std::string path = words.isEmpty() ? "hashphase-wander.json" : words.word("FILE");
    words.end();
    ResultFile file(path);
    file.write([&session](std::ostream& out) { out << session.log().text(); });
    session.say("recorded " + withThousands(session.log().frameCount()) + " frames in " + path);
}

void capture(Session& session, Arguments& words) {
    const std::string path = words.word("FILE");
    const long long frames = words.wholeOr("FRAMES", 1, 1'000'000, 60);
    words.end();
    session.capture(path, static_cast<int>(frames));
}

void quit(Session& session, Arguments& words) {
    words.end();
    session.end();
}

void print(Session& session, Arguments& words) {
    std::string line;
    do {
        const std::string name = words.word("READING");
        line += (line.empty() ? "" : "  ") + name + " " + plain(session.reading(name));
    } while (!words.isEmpty());
    session.say(line);
}

void expect(Session& session, Arguments& words) {
    const std::string name = words.word("READING");
    const std::size_t relation = words.choice("relation", kRelations);
    const double wanted = words.number("NUMBER", -1e18, 1e18);
    words.end();
    const double read = session.reading(name);
    const std::array<bool, 6> holds{read == wanted, read != wanted,
                                    read<wanted, read <= wanted, read> wanted, read >= wanted};
    if (!holds[relation]) {
        session.noteFailure("frame " + std::to_string(session.frame()) + ": " + name + " is " +
                            plain(read) + ", but was to be " + std::string(kRelations[relation]) +
                            " " + plain(wanted));
    }
}

}  // namespace hashphase::demos::actions
