// SPDX-License-Identifier: Zlib
#include <demos/compare/report.hpp>

#include <demos/report/json_values.hpp>

#include <cmath>
#include <ostream>

namespace hashphase::demos {
namespace {

Json tallyJson(const Result& result, std::size_t FrameVerdict::*count) {
    const Tally tally = tallyOf(result, count);
    return {{"total", tally.total}, {"mostInAFrame", tally.most}};
}

// JSON has no numbers for what is not finite.
Json coordinateJson(float value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json boxJson(const Aabb<float>& box) {
    const auto corner = [](const Vector3<float>& point) {
        return Json::array(
            {coordinateJson(point.x()), coordinateJson(point.y()), coordinateJson(point.z())});
    };
    return {{"min", corner(box.min())}, {"max", corner(box.max())}};
}

Json faultJson(const std::optional<Fault>& fault) {
    if (!fault) {
        return nullptr;
    }
    return {{"frame", fault->frame},
            {"kind", fault->missing ? "missing" : "extra"},
            {"objects", Json::array({firstOf(fault->pair), secondOf(fault->pair)})},
            {"boxes", Json::array({boxJson(fault->firstBox), boxJson(fault->secondBox)})}};
}

Json framesJson(const Result& result) {
    Json frames = Json::array();
    for (const FrameRow& row : result.rows) {
        frames.push_back({{"frame", row.frame},
                          {"measured", row.measured},
                          {"pairs", row.verdict.pairs},
                          {"exactPairs", row.verdict.exactPairs},
                          {"missing", row.verdict.missing},
                          {"extra", row.verdict.extra},
                          {"stale", row.verdict.stale},
                          {"setAabbMs", row.setAabbMs},
                          {"calculateMs", row.calculateMs},
                          {"stepMs", orNull(row.stepMs)}});
    }
    return frames;
}

Json resultJson(const Report& report, const Result& result) {
    const std::optional<Timing> timing = timingOf(result);
    const auto part = [&timing](Spread Timing::*member) {
        return spreadJson(timing ? std::optional((*timing).*member) : std::nullopt);
    };
    return {{"name", result.kind->name},
            {"title", result.kind->title},
            {"ours", result.kind->ours},
            {"fillMs", orNull(result.fillMs)},
            {"leftOutAfterSeconds", orNull(result.leftOutAfter)},
            {"removeMs", orNull(result.removeMs)},
            {"setAabbMs", part(&Timing::setAabb)},
            {"calculateMs", part(&Timing::calculate)},
            {"bothMs", part(&Timing::both)},
            {"stepMs", spreadJson(timing ? timing->step : std::nullopt)},
            {"speedAgainstDbvt", orNull(speedAgainstDbvt(report, result))},
            {"memoryBytes", orNull(result.memoryBytes)},
            {"pairs", tallyJson(result, &FrameVerdict::pairs)},
            {"missing", tallyJson(result, &FrameVerdict::missing)},
            {"extra", tallyJson(result, &FrameVerdict::extra)},
            {"stale", tallyJson(result, &FrameVerdict::stale)},
            {"firstFault", faultJson(result.firstFault)},
            {"frames", framesJson(result)}};
}

Json settingsJson(const Report& report) {
    const CompareOptions& options = report.options;
    return {{"scene", report.scene},
            {"description", report.description},
            {"fromFile", !options.file.empty()},
            {"objects", report.objects},
            {"frames", report.framesAsked},
            {"warmUpFrames", report.comparison.warmUpFrames},
            {"seed", options.sceneSeed()},
            {"reference", options.reference == ReferenceMethod::kBrute ? "brute" : "sweep"},
            {"timeLimitSeconds", orNull(options.timeLimit)}};
}

}  // namespace

void writeJson(const Report& report, std::ostream& out) {
    Json json{{"schema", "hashphase-compare"},
              {"schemaVersion", 1},
              {"provenance", provenanceJson(report.provenance)},
              {"settings", settingsJson(report)},
              {"verdict",
               {{"text", verdictLine(report)},
                {"exact", orNull(oursWereExact(report))},
                {"framesDone", report.comparison.framesDone},
                {"objectsRemoved", report.comparison.objectsRemoved},
                {"timeLimitHit", report.comparison.timeLimitHit}}},
              {"broadphases", Json::array()}};
    for (const Result& result : report.comparison.results) {
        json["broadphases"].push_back(resultJson(report, result));
    }
    out << textOf(json);
}

}  // namespace hashphase::demos
