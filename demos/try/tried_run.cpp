// SPDX-License-Identifier: Zlib
#include <demos/try/tried_run.hpp>

#include <demos/console/format.hpp>
#include <demos/scenes/input_error.hpp>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace hashphase::demos {
namespace {

/// A file with a record, mapped; removed in the end.
class RecordFile {
public:
    explicit RecordFile(const TriedRunSettings& settings) : path_(pathOfNone()) {
        const int file = mkstemp(path_.data());
        void* bytes = MAP_FAILED;
        if (file >= 0 && hasRoom(file)) {
            bytes =
                mmap(nullptr, sizeof(tryout::Record), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
        }
        if (file >= 0) {
            close(file);
        }
        if (bytes == MAP_FAILED) {
            unlink(path_.c_str());
            throw InputError("No file of " + std::to_string(sizeof(tryout::Record) >> 20U) +
                             " MiB can be made in the folder of temporary files: make room, or set "
                             "TMPDIR to another folder.");
        }
        record_ = static_cast<tryout::Record*>(bytes);  // of zeros
        record_->format = tryout::Record::kFormat;
        record_->broadphase = settings.broadphase;
    }
    ~RecordFile() {
        munmap(record_, sizeof(tryout::Record));
        unlink(path_.c_str());
    }
    RecordFile(const RecordFile&) = delete;
    RecordFile& operator=(const RecordFile&) = delete;

    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] const tryout::Record& record() const { return *record_; }

private:
    // Of which mkstemp() fills in the end, and which it refuses if it is empty.
    static std::string pathOfNone() {
        std::error_code error;
        const std::filesystem::path folder =
            std::filesystem::absolute(std::filesystem::temp_directory_path(error), error);
        return error ? "" : (folder / "hashphase-try-XXXXXX").string();
    }

    // All of it, now: where there is none, the program would pay for it.
    static bool hasRoom(int file) {
        int error = EINTR;
        while (error == EINTR) {
            error = posix_fallocate(file, 0, sizeof(tryout::Record));
        }
        return error == 0;
    }

    std::string path_;
    tryout::Record* record_ = nullptr;
};

// This process's, with our library before others that are preloaded.
std::vector<std::string> environmentFor(const std::string& preload, const std::string& recordPath) {
    const std::string record = std::string(tryout::kRecordVariable) + "=";
    std::vector<std::string> all;
    std::string preloads = preload;
    for (char** variable = environ; *variable != nullptr; ++variable) {
        const std::string text = *variable;
        if (text.starts_with("LD_PRELOAD=")) {
            preloads += ":" + text.substr(text.find('=') + 1);
        } else if (!text.starts_with(record)) {
            all.push_back(text);
        }
    }
    all.push_back("LD_PRELOAD=" + preloads);
    all.push_back(record + recordPath);
    return all;
}

// Pairs that were calculated outside of steps count where there are no steps. Rays that were cast before
// them are before the next step, too.
std::vector<tryout::StepRow> stepsOf(const tryout::Record& record) {
    const auto isUnwritten = [](const tryout::StepRow& row) { return row.calculations == 0; };
    const auto isNoStep = [](const tryout::StepRow& row) { return row.isStep == 0; };
    const std::uint32_t count = std::min(record.rowCount.load(), tryout::Record::kMaxRows);
    std::vector<tryout::StepRow> rows(record.rows.begin(), record.rows.begin() + count);
    std::erase_if(rows, isUnwritten);
    if (std::all_of(rows.begin(), rows.end(), isNoStep)) {
        return rows;
    }
    float raysBetween = 0;
    std::uint32_t rayBetweenCount = 0;
    for (tryout::StepRow& row : rows) {
        raysBetween += row.raysBetween;
        rayBetweenCount += row.rayBetweenCount;
        if (!isNoStep(row)) {
            row.raysBetween = std::exchange(raysBetween, 0.0F);
            row.rayBetweenCount = std::exchange(rayBetweenCount, 0);
        }
    }
    std::erase_if(rows, isNoStep);
    return rows;
}

ProgramCall callFor(const TriedRunSettings& settings, const std::string& recordPath) {
    for (const std::string& library : settings.preloads) {
        if (library.find_first_of(" :") != std::string::npos) {
            throw InputError(
                library +
                " cannot be preloaded, because its path has a blank or a colon: install "
                "hashphase elsewhere.");
        }
    }
    ProgramCall call = settings.call;
    call.variables = environmentFor(joined(settings.preloads, ":"), recordPath);
    return call;
}

}  // namespace

TriedRun runTried(const TriedRunSettings& settings) {
    const RecordFile file(settings);
    const tryout::Record& record = file.record();
    const ProgramCall call = callFor(settings, file.path());
    if (settings.inputBegin >= 0) {
        lseek(STDIN_FILENO, settings.inputBegin, SEEK_SET);
    }
    TriedRun run;
    run.end = runToTheEnd(call, record);
    run.broadphase = settings.broadphase;
    run.isLoaded = record.isLoaded.load() != 0;
    run.counts = record.counts;
    run.droppedRows = record.rowCount - std::min(record.rowCount.load(), tryout::Record::kMaxRows);
    run.rows = stepsOf(record);
    if (call.stepLimit) {
        run.rows.resize(std::min<std::size_t>(run.rows.size(), *call.stepLimit));
    }
    run.verification = record.verification;
    return run;
}

}  // namespace hashphase::demos
