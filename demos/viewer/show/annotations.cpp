// SPDX-License-Identifier: Zlib
#include <demos/viewer/show/annotations.hpp>

#include <demos/console/format.hpp>
#include <demos/viewer/draw/palette.hpp>

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

namespace hashphase::demos {
namespace {

Badge pairBadge(const Session& session) {
    const Palette& colours = palette(session.options.theme);
    const PairCheck* check = session.check();
    if (check == nullptr && session.canCheck()) {
        return {"pairs are verified after the next frame", colours.unknown};
    }
    if (check == nullptr) {
        return {"pairs are not verified: the effect pairs is off, or sweep is on", colours.warning};
    }
    const std::string exact = withThousands(check->exact.size());
    if (!check->missing.empty()) {
        return {"WRONG: " + withThousands(check->missing.size()) + " of " + exact +
                    " pairs are missing",
                colours.alert, true};
    }
    if (!check->extra.empty()) {
        return {"all " + exact + " pairs found, plus " + withThousands(check->extra.size()) +
                    " that do not overlap",
                colours.warning};
    }
    return {"all " + exact + " pairs found, no false ones", colours.confirmed};
}

/// Where the camera shows a place; nothing where that is not in the picture.
std::optional<Eigen::Vector2f> onScreen(const Session& session, const Vector3<float>& place) {
    const Eigen::Vector4f clip = cameraView(session.pose()).viewProjection * place.homogeneous();
    if (!(clip.w() > 0) || clip.head<2>().cwiseAbs().maxCoeff() > clip.w()) {
        return std::nullopt;
    }
    const Eigen::Vector2f device = clip.head<2>() / clip.w();
    return Eigen::Vector2f((1 + device.x()) / 2 * static_cast<float>(session.width),
                           (1 - device.y()) / 2 * static_cast<float>(session.height));
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

std::string swapText(const Session& session) {
    if (!session.former) {
        return {};
    }
    const auto timed = [](std::string_view broadphase, const PhaseHistory& history) {
        return std::string(broadphase) +
               (history.toldCount() > 0 ? " " + fixed(history.medianTotal(), 2) + " ms" : "");
    };
    return timed(session.stage->broadphase().name, session.history) +
           ", before: " + timed(session.former->broadphase, session.former->history);
}

std::vector<Label> zoneLabels(const Session& session) {
    std::vector<Label> labels;
    for (const InterestZone& zone : session.stage->interestZones()) {
        if (const auto middle = onScreen(session, zone.centre)) {
            labels.push_back({*middle, bodiesText(zone.bodyCount), zone.radius});
        }
    }
    return labels;
}

std::vector<Label> placedApart(std::vector<Label> labels,
                               const std::function<Eigen::Vector2f(const std::string&)>& sizeOf) {
    std::ranges::stable_sort(labels, std::greater<>(), &Label::radius);
    std::vector<Label> placed;
    std::vector<Eigen::AlignedBox2f> taken;
    for (Label& label : labels) {
        const Eigen::Vector2f size = sizeOf(label.text);
        const Eigen::Vector2f middle = label.middle;
        for (const float lines : {0.0F, 1.0F, -1.0F}) {
            label.middle.y() = middle.y() + lines * (size.y() + 1);
            const Eigen::AlignedBox2f box(label.middle - size / 2, label.middle + size / 2);
            if (std::ranges::none_of(taken,
                                     [&](const auto& other) { return box.intersects(other); })) {
                taken.push_back(box);
                placed.push_back(std::move(label));
                break;
            }
        }
    }
    return placed;
}

}  // namespace hashphase::demos
