// SPDX-License-Identifier: Zlib
#include <demos/paper/paper_tables.hpp>

#include <demos/console/format.hpp>

#include <cmath>

namespace hashphase::demos {
namespace {

constexpr double kSmoothRate = 60;  // [frames/s]; more is not told apart in the paper
constexpr double kSecond = 1000;    // [ms]

GradedText gradedRate(const MethodResult* method, bool showMilliseconds) {
    if (method == nullptr || !method->isMeasured()) {
        return {"-", Grade::kNone};
    }
    return {showMilliseconds ? milliseconds(method->time().median) : rateText(method->rate()),
            gradeOf(method->rate())};
}

GradedText gradedPrint(std::string_view printed, bool showMilliseconds) {
    if (printed.empty()) {
        return {"-", Grade::kNone};
    }
    return {showMilliseconds ? printedMilliseconds(printed) : std::string(printed),
            gradeOfPrinted(printed)};
}

void addFigureRows(const PhaseResult& result, bool showMilliseconds, GradedTable& table) {
    const auto& [phase, objects, seed, radius] = result.task;
    const std::string first = withThousands(objects);
    std::vector<GradedText> paper{
        {first},
        {"paper, 2005"},
        gradedPrint(printedRate(phase, objects, std::nullopt), showMilliseconds)};
    std::vector<GradedText> today{
        {first},
        {"paper, today"},
        gradedRate(result.find(MethodKind::unoptimized, std::nullopt), showMilliseconds)};
    std::vector<GradedText> ours{{first}, {"hashphase"}, {"", Grade::kNone}};
    for (const double cellSize : kPrintedCellSizes) {
        paper.push_back(gradedPrint(printedRate(phase, objects, cellSize), showMilliseconds));
        today.push_back(gradedRate(result.find(MethodKind::paperGrid, cellSize), showMilliseconds));
        ours.push_back(gradedRate(result.find(MethodKind::hashphase, cellSize), showMilliseconds));
    }
    paper.push_back({"", Grade::kNone});
    today.push_back({"", Grade::kNone});
    ours.push_back(gradedRate(result.find(MethodKind::hashphase, std::nullopt), showMilliseconds));
    for (std::vector<GradedText>* row : {&paper, &today, &ours}) {
        table.rows.push_back(std::move(*row));
    }
}

template <class Number>
Value valueOfNumber(const std::optional<Number>& number) {
    return number ? Value(static_cast<double>(*number)) : Value();
}

Value medianOf(const MethodResult& method) {
    return method.isMeasured() ? Value(method.time().median) : Value();
}

void addMeasurementRows(const std::string& part, const PhaseResult& result, DataTable& table) {
    const bool isFigure = part == "figure";
    const auto& [phase, objects, seed, radius] = result.task;
    for (const MethodResult& method : result.methods) {
        const std::string_view printed =
            isFigure && (method.kind == MethodKind::paperGrid ||
                         method.kind == MethodKind::unoptimized || method.cellSize)
                ? printedRate(phase, objects, method.cellSize)
                : std::string_view();
        const Spread time = method.isMeasured() ? method.time() : Spread{};
        const auto timed = [&](double number) {
            return method.isMeasured() ? Value(number) : Value();
        };
        // Pairs file and find at once.
        const bool isApart = method.isMeasured() &&
                             (phase != Phase::collision || method.kind != MethodKind::hashphase);
        const Value hashing = isApart ? Value(spreadOf(method.hashMs).median) : Value();
        const Value ground = method.isMeasured() && phase == Phase::collision
                                 ? Value(spreadOf(method.standMs).median)
                                 : Value();
        table.add({part,
                   static_cast<double>(figureNumber(phase)),
                   std::string(nameOf(phase)),
                   static_cast<double>(objects),
                   std::string(nameOf(method.kind)),
                   valueOfNumber(method.cellSize),
                   phase == Phase::ai ? Value(static_cast<double>(radius)) : Value(),
                   printed.empty() ? Value() : Value(std::string(printed)),
                   timed(time.median),
                   timed(time.low),
                   timed(time.high),
                   hashing,
                   ground,
                   valueOfNumber(method.rate()),
                   static_cast<double>(method.frameMs.size()),
                   static_cast<double>(method.checkedFrames),
                   static_cast<double>(method.checkedTimed),
                   static_cast<double>(method.checkedObjects),
                   static_cast<double>(method.wrongFrames),
                   valueOfNumber(method.bytes),
                   timed(static_cast<double>(result.side)),
                   timed(static_cast<double>(result.triangles))});
    }
}

}  // namespace

Grade gradeOf(std::optional<double> rate) {
    if (!rate) {
        return Grade::kNone;
    }
    return *rate >= kSmoothRate     ? Grade::kGood
           : *rate >= kRealTimeRate ? Grade::kFair
                                    : Grade::kPoor;
}

Grade gradeOfPrinted(std::string_view printed) {
    if (printed.empty()) {
        return Grade::kNone;
    }
    if (isTooSlow(printed)) {
        return Grade::kPoor;
    }
    return printed == "60+" ? Grade::kGood : gradeOf(exactRate(printed));
}

std::string rateText(std::optional<double> rate) {
    if (!rate) {
        return "-";
    }
    constexpr double kFewest = 9.95;  // below, the digit after the point matters
    return *rate < kFewest ? fixed(*rate, *rate < 0.0995 ? 3 : 1)
                           : withThousands(static_cast<std::uint64_t>(std::floor(*rate)));
}

std::string printedMilliseconds(std::string_view printed) {
    if (printed == "60+") {
        return "<=16.7";
    }
    const std::optional<double> rate = exactRate(printed);
    return rate ? milliseconds(kSecond / *rate) : ">1000";
}

GradedTable figureTable(const PaperResults& results, Phase phase, bool showMilliseconds) {
    GradedTable table;
    table.caption = "Figure " + std::to_string(figureNumber(phase)) + ", " +
                    std::string(nameOf(phase)) + ": " +
                    (showMilliseconds ? "milliseconds a frame" : "frames a second") +
                    " by number of objects and cell size";
    table.legend = {"60 frames a second or more", "20 to 60", "below 20: too slow for real time"};
    table.header = {"objects", "", "un-optimized"};
    for (const double cellSize : kPrintedCellSizes) {
        table.header.push_back(fixed(cellSize, 0) + " m");
    }
    table.header.emplace_back("automatic");
    for (const PhaseResult& result : results.figures) {
        if (result.task.phase == phase) {
            addFigureRows(result, showMilliseconds, table);
        }
    }
    return table;
}

DataTable measurementRows(const PaperResults& results) {
    DataTable table{{{"part"},
                     {"figure"},
                     {"phase"},
                     {"objects"},
                     {"method"},
                     {"cell_m", "cell [m]"},
                     {"ai_radius_m", "AI radius [m]"},
                     {"paper", "paper [frames/s]"},
                     {"frame_ms", "frame [ms]"},
                     {"p5_ms", "5th percentile"},
                     {"p95_ms", "95th percentile"},
                     {"hashing_ms", "of which hashing [ms]"},
                     {"ground_ms", "of which the ground [ms]"},
                     {"frames_per_second", "frames/s"},
                     {"frames", "frames timed"},
                     {"checked_frames", "frames checked"},
                     {"checked_timed_frames", "of these, timed"},
                     {"checked_objects", "objects checked in them"},
                     {"wrong_frames", "wrong frames"},
                     {"bytes"},
                     {"side_m", "domain [m]"},
                     {"triangles"}},
                    {}};
    for (const PhaseResult& result : results.figures) {
        addMeasurementRows("figure", result, table);
    }
    for (const PhaseResult& result : results.radii) {
        addMeasurementRows("radius", result, table);
    }
    addMeasurementRows("cell size", results.cellSizes, table);
    return table;
}

DataTable fewFramesTable(const PaperResults& results) {
    DataTable table{{{"phase", "phase"},
                     {"objects", "objects"},
                     {"method", "method"},
                     {"frames", "frames timed"}},
                    {}};
    for (const PhaseResult& result : results.figures) {
        for (const MethodResult& method : result.methods) {
            if (method.isMeasured() && method.frameMs.size() < results.plan.effort.frames) {
                table.add({std::string(nameOf(result.task.phase)),
                           withThousands(result.task.objects), describe(method),
                           static_cast<double>(method.frameMs.size())});
            }
        }
    }
    return table;
}

DataTable radiusTable(const PaperResults& results) {
    DataTable table{{{"radius", "radius [m]"}, {"neighbours", "neighbours of an agent"}}, {}};
    for (std::size_t i = 0; i < results.radii.size(); ++i) {
        const PhaseResult& result = results.radii[i];
        std::vector<Value> row{static_cast<double>(result.task.aiRadius), results.neighbours[i]};
        for (const MethodResult& method : result.methods) {
            if (i == 0) {
                const std::string name = describe(method);
                table.columns.push_back({name, name + " [ms]"});
            }
            row.push_back(medianOf(method));
        }
        table.add(std::move(row));
    }
    return table;
}

DataTable cellSizeTable(const PaperResults& results) {
    DataTable table{{{"method", "method"},
                     {"cell", "cell [m]"},
                     {"ms", "frame [ms]"},
                     {"low"},
                     {"high"},
                     {"mebibytes", "memory [MiB]"}},
                    {}};
    constexpr double kMebibyte = 1024.0 * 1024.0;
    for (const MethodKind kind : {MethodKind::paperGrid, MethodKind::hashphase}) {
        for (const MethodResult& method : results.cellSizes.methods) {
            if (method.kind == kind && method.isMeasured() && method.bytes) {
                const Spread time = method.time();
                const bool isFixed = method.cellSize.has_value();
                table.add({isFixed ? std::string(nameOf(kind)) : describe(method),
                           valueOfNumber(isFixed ? method.cellSize : method.chosenCellSize),
                           time.median, time.low, time.high,
                           static_cast<double>(*method.bytes) / kMebibyte});
            }
        }
    }
    return table;
}

DataTable volumeTable(const PaperResults& results) {
    DataTable table{{{"volume", "first pass by"},
                     {"candidates", "pairs from the grid"},
                     {"passed", "pass"},
                     {"false", "of these, false"},
                     {"touching", "touch"},
                     {"first_ms", "first pass [ms]"},
                     {"exact_ms", "exact test [ms]"},
                     {"ms", "together [ms]"}},
                    {}};
    for (const VolumeResult& each : results.volumes.volumes) {
        const double firstPass = spreadOf(each.firstPassMs).median;
        const double exact = spreadOf(each.exactMs).median;
        table.add({std::string(nameOf(each.kind)), each.candidates, each.passed,
                   each.passed - each.touching, each.touching, firstPass, exact,
                   firstPass + exact});
    }
    return table;
}

}  // namespace hashphase::demos
