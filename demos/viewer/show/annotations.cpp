// SPDX-License-Identifier: Zlib
#include <demos/viewer/show/annotations.hpp>

#include <demos/console/format.hpp>
#include <demos/viewer/draw/palette.hpp>

namespace hashphase::demos {
namespace {

Badge pairBadge(const Session& session) {
    const Palette& colours = palette(session.options.theme);
    const PairCheck* check = session.check();
    if (check == nullptr && session.canCheck()) {
        return {"pairs are verified after the next frame", colours.unknown};
    }
    if (check == nullptr) {
        return {"pairs are not verified: none are declared, or they are swept", colours.warning};
    }
    const std::string exact = withThousands(check->exact.size());
    if (!check->missing.empty()) {
        return {"WRONG: " + withThousands(check->missing.size()) + " of " + exact +
                    " pairs are missing",
                colours.alert, true};
    }
    if (!check->extra.empty()) {
        return {"all " + exact + " pairs found, and " + withThousands(check->extra.size()) +
                    " that do not overlap",
                colours.warning};
    }
    return {"all " + exact + " pairs found, and no other", colours.confirmed};
}

}  // namespace

std::vector<Badge> badges(const Session& session) {
    std::vector<Badge> all;
    if (session.isChecking) {
        all.push_back(pairBadge(session));
    }
    if (session.frozen) {
        all.push_back({"frustum frozen (F)", palette(session.options.theme).warning});
    }
    return all;
}

}  // namespace hashphase::demos
