// SPDX-License-Identifier: Zlib
#include <demos/report/report_text.hpp>

#include <demos/console/format.hpp>

#include <algorithm>
#include <ostream>
#include <sstream>

namespace hashphase::demos {

std::string spreadText(const std::optional<Spread>& spread) {
    if (!spread) {
        return "-";
    }
    return milliseconds(spread->median) + " (" + milliseconds(spread->low) + "-" +
           milliseconds(spread->high) + ")";
}

std::string ratioText(const std::optional<double>& ratio) {
    return ratio ? fixed(*ratio, *ratio < 10 ? 2 : 1) + "x" : "-";
}

std::string leftOutText(const std::vector<std::string>& names) {
    constexpr std::size_t mostNames = 10;
    std::string text;
    for (std::size_t i = 0; i < std::min(names.size(), mostNames); ++i) {
        text += (i == 0 ? "; left out for want of time: " : ", ") + names[i];
    }
    if (names.size() > mostNames) {
        text += " and " + std::to_string(names.size() - mostNames) + " more";
    }
    return text;
}

std::string boxText(const Aabb<float>& box) {
    std::ostringstream text;
    text.precision(9);
    text << '[' << box.min().x() << ' ' << box.min().y() << ' ' << box.min().z() << " to "
         << box.max().x() << ' ' << box.max().y() << ' ' << box.max().z() << ']';
    return text.str();
}

void printProvenance(const Provenance& provenance, std::ostream& out) {
    out << "hashphase " << provenance.hashphaseVersion << ", Bullet " << provenance.bulletVersion
        << " (" << provenance.precision << " precision), " << provenance.compiler << ", "
        << provenance.cpu << ", " << provenance.cores << " cores, one thread\n";
    if (provenance.loadAverage && (*provenance.loadAverage)[0] > provenance.cores) {
        out << "Other programs kept the processor busy (load "
            << fixed((*provenance.loadAverage)[0], 1) << " on " << provenance.cores
            << " cores), so the times are too long.\n";
    }
}

}  // namespace hashphase::demos
