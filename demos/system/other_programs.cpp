// SPDX-License-Identifier: Zlib
#include <demos/system/other_programs.hpp>

#include <algorithm>
#include <istream>
#include <string>
#include <utility>

namespace hashphase::demos {

std::optional<double> busyTicks(std::istream& stat) {
    std::string name;
    double user = 0;  // guests included
    double nice = 0;
    double system = 0;
    double idle = 0;
    double waitForDevices = 0;
    double interrupts = 0;
    double softInterrupts = 0;
    double stolen = 0;  // by other virtual machines
    stat >> name >> user >> nice >> system >> idle >> waitForDevices >> interrupts >>
        softInterrupts >> stolen;
    return stat && name == "cpu"
               ? std::optional(user + nice + system + interrupts + softInterrupts + stolen)
               : std::nullopt;
}

OtherPrograms::OtherPrograms(Read read) : read_(std::move(read)), begin_(read_()) {}

std::optional<double> OtherPrograms::cores() const {
    constexpr double kShortest = 0.5;  // [s]
    const std::optional<ProcessorTimes> end = read_();
    if (!begin_ || !end || end->wall - begin_->wall < kShortest) {
        return std::nullopt;
    }
    const double others = (end->all - begin_->all) - (end->own - begin_->own);
    return std::max(others, 0.0) / (end->wall - begin_->wall);
}

}  // namespace hashphase::demos
