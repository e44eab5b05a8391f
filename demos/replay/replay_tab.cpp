// SPDX-License-Identifier: Zlib
#include <demos/replay/replay_tab.hpp>

#include <demos/console/format.hpp>
#include <demos/report/html.hpp>

#include <sstream>

namespace hashphase::demos {
namespace {

std::string whatIsRecorded(const ReplayRecording& recording, std::size_t framesRun) {
    const ReplaySettings& settings = recording.settings();
    std::string text = "Recorded of " + settings.scene + ": the first " +
                       withThousands(recording.frameCount()) + " of " + withThousands(framesRun) +
                       " frames";
    if (recording.recordedObjectCount() < recording.objectCount()) {
        text += ", and of " + withThousands(recording.objectCount()) + " " + settings.noun +
                " the " + withThousands(recording.recordedObjectCount()) +
                " that stand nearest to the middle in the first of them; pairs are drawn where "
                "both are among these";
    } else {
        text += " with all " + withThousands(recording.objectCount()) + " " + settings.noun;
    }
    text += ". ";
    if (recording.framesWithoutPairs() > 0) {
        text += "In " + withThousands(recording.framesWithoutPairs()) +
                " of the frames there are more than " + withThousands(settings.pairs) +
                " pairs, which are counted but not drawn. ";
    }
    if (recording.cutCount() > 0) {
        text += withThousands(recording.cutCount()) + " of the " + settings.noun +
                " reach beyond the drawn world, or hold a NaN: they are cut off at its end. ";
    }
    return text +
           "Which pairs are wrong was told from the boxes as they are; they are drawn rounded to "
           "a 65,535th of the drawn world. For more frames, in a larger page: --replay-frames.";
}

DataTable wrongPairsTable(const ReplayRecording& recording) {
    DataTable table{{{"broadphase", "broadphase"},
                     {"missing", "missing in these frames"},
                     {"extra", "extra in these frames"}},
                    {}};
    for (std::size_t i = 0; i < recording.settings().broadphases.size(); ++i) {
        table.add({recording.settings().broadphases[i],
                   static_cast<double>(recording.missingCount(i)),
                   static_cast<double>(recording.extraCount(i))});
    }
    return table;
}

}  // namespace

void addReplayTab(const ReplayRecording& recording, std::size_t framesRun, Page& page) {
    if (recording.frameCount() == 0) {
        return;
    }
    std::ostringstream html;
    html << "<h2>Replay</h2>\n<div class=\"replay\">\n<noscript><p>The recording is replayed by "
            "JavaScript, which is off, and WebGL2. What was wrong in its frames is in the "
            "table.</p></noscript>\n<script type=\"application/json\">"
         << jsonInScript(recording.json()) << "</script>\n</div>\n<p class=\"quiet\">"
         << escaped(whatIsRecorded(recording, framesRun)) << "</p>\n";
    writeTable(wrongPairsTable(recording), html);
    page.tabs.push_back({"replay", "Replay", html.str(), replayStyle(), replayScript()});
}

}  // namespace hashphase::demos
