// SPDX-License-Identifier: Zlib
#include <demos/console/format.hpp>
#include <demos/replay/replay_recording.hpp>
#include <demos/report/page.hpp>

#include <algorithm>
#include <numeric>
#include <sstream>
#include <vector>

namespace hashphase::demos {
namespace {

std::string thousands(const Json& number) {
    return withThousands(number.get<std::uint64_t>());
}

/// In how many frames a track has pairs that are too many to be listed, at most.
std::uint64_t framesWithoutPairs(const Json& recording) {
    std::uint64_t most = 0;
    for (const Json& track : recording["tracks"]) {
        std::uint64_t without = 0;
        for (std::size_t frame = 0; frame < track["pairs"].size(); ++frame) {
            without += track["pairsListed"][frame] < track["pairs"][frame] ? 1 : 0;
        }
        most = std::max(most, without);
    }
    return most;
}

std::string whatIsRecorded(const Json& recording, const ReplaySettings& settings,
                           std::size_t framesRun) {
    std::string text = "Recording of " + settings.scene + ": the first " +
                       thousands(recording["frames"]) + " of " + withThousands(framesRun) +
                       " frames";
    const std::string inAll = thousands(recording["objectsInAll"]) + " " + settings.noun;
    if (recording["objects"] < recording["objectsInAll"]) {
        text += ", with " + thousands(recording["objects"]) + " of " + inAll +
                ": those nearest to the middle in the first frame. Only pairs between them are "
                "drawn";
    } else {
        text += " with all " + inAll;
    }
    text += ". ";
    if (const std::uint64_t frames = framesWithoutPairs(recording); frames > 0) {
        text += "In " + withThousands(frames) + " of the frames there are more than " +
                withThousands(settings.pairs) + " pairs, which are counted but not drawn. ";
    }
    if (recording["objectsCut"] > 0) {
        text += "The picture cuts off " + thousands(recording["objectsCut"]) + " of the " +
                settings.noun + " at its border: outside the drawn world, or with a NaN. ";
    }
    if (const Json& ground = recording["ground"]; !ground.is_null()) {
        text += "The terrain is drawn from " + thousands(ground["columns"]) + " x " +
                thousands(ground["rows"]) + " heights. ";
    }
    return text +
           "Missing and extra pairs are found with the exact boxes; the picture rounds boxes to "
           "1/65,535 of the drawn world. The option --replay-frames records more frames, in a "
           "larger page.";
}

DataTable wrongPairsTable(const Json& recording) {
    DataTable table{{{"broadphase", "broadphase"},
                     {"missing", "missing in these frames"},
                     {"extra", "extra in these frames"}},
                    {}};
    for (const Json& broadphase : recording["broadphases"]) {
        const auto sumOf = [&](const char* counts) {
            const auto each = broadphase[counts].get<std::vector<double>>();
            return std::accumulate(each.begin(), each.end(), 0.0);
        };
        table.add({broadphase["name"].get<std::string>(), sumOf("missing"), sumOf("extra")});
    }
    return table;
}

}  // namespace

void addReplayTab(const ReplayRecording& recording, std::size_t framesRun, Page& page) {
    const Json json = recording.json();
    if (json["frames"] == 0) {
        return;
    }
    std::ostringstream html;
    html << "<h2>Replay</h2>\n<div class=\"replay\">\n<noscript><p>The replay needs JavaScript, "
            "which is off. The table lists the wrong pairs.</p></noscript>\n"
            "<script type=\"application/json\">"
         << jsonInScript(json) << "</script>\n</div>\n<p class=\"quiet\">"
         << escaped(whatIsRecorded(json, recording.settings(), framesRun)) << "</p>\n";
    writeTable(wrongPairsTable(json), html);
    page.tabs.push_back({"replay", "Replay", html.str(), replayStyle(), replayScript()});
}

}  // namespace hashphase::demos
