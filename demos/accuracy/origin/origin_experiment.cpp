// SPDX-License-Identifier: Zlib
#include <demos/accuracy/origin/origin_experiment.hpp>

#include <demos/accuracy/experiments.hpp>
#include <demos/console/format.hpp>

#include <cmath>

namespace hashphase::demos {
namespace {

constexpr double kFineUnit = 0x1p-10;  // boxes of 0.5 to 2 m within 20 m

/// So large that a step of the scene is the distance of neighbouring numbers in single precision at
/// the farthest offset, 2^30 m: boxes of 1 to 4 km within 41 km.
constexpr double kCoarseUnit = 0x1p7 / static_cast<double>(OriginScene::kStep);

/// 0, and the powers of two: those next to a thousand, ten thousand, ... up to a billion, or all in
/// between as well.
std::vector<double> offsets(bool areAll) {
    std::vector<double> chosen{0};
    for (int exponent = 10; exponent <= 30; ++exponent) {
        const double offset = std::ldexp(1.0, exponent);
        if (areAll || isNextToPowerOfTen(offset)) {
            chosen.push_back(offset);
        }
    }
    return chosen;
}

}  // namespace

bool isNextToPowerOfTen(double offset) {
    const double power = std::pow(10.0, std::round(std::log10(offset)));
    return offset == std::exp2(std::round(std::log2(power)));
}

std::vector<OriginPoint> runOrigin(std::span<const OriginMethod> methods,
                                   std::span<const SettleMethod> settleMethods,
                                   const OriginSettings& settings, const TellProgress& tell) {
    const OriginScene fine(settings.boxes, settings.rays, 1, settings.seed);
    const OriginScene coarse(settings.boxes, settings.rays, OriginScene::kStep, settings.seed);
    std::vector<OriginPoint> points;
    for (const double offset : settings.offsets) {
        tell(static_cast<double>(points.size()) / static_cast<double>(settings.offsets.size()),
             withThousands(static_cast<std::uint64_t>(offset)) + " m");
        OriginPoint& point = points.emplace_back();
        point.offset = offset;
        point.fine = runAt({offset, kFineUnit}, fine, methods);
        point.coarse = runAt({offset, kCoarseUnit}, coarse, methods);
        point.settled = settleAt(offset, settleMethods);
    }
    return points;
}

Experiment originExperiment() {
    return {"P6",
            "Distance from the origin",
            "What is missed and what is false far from the origin, and what does it cost to be "
            "right there?",
            4,
            40,
            [](const Effort& effort, const TellProgress& tell) {
                OriginSettings settings;
                settings.offsets = offsets(!effort.isQuick);
                settings.boxes = effort.quickOrFull<std::size_t>(400, 1000);
                settings.rays = effort.quickOrFull<std::size_t>(50, 200);
                settings.seed = effort.seed;
                const std::vector<OriginMethod> methods = originMethods();
                const std::vector<SettleMethod> settling = settleMethods();
                const std::vector<OriginPoint> points =
                    runOrigin(methods, settling, settings, tell);
                return judgeOrigin(methods, settling, settings, points);
            }};
}

}  // namespace hashphase::demos
