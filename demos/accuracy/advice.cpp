// SPDX-License-Identifier: Zlib
#include <demos/accuracy/advice.hpp>

#include <algorithm>

namespace hashphase::demos {

std::vector<Choice> paretoFront(std::span<const Choice> choices) {
    std::vector<Choice> front;
    std::vector<std::string> tasksDone;
    for (const Choice& first : choices) {
        if (std::find(tasksDone.begin(), tasksDone.end(), first.task) != tasksDone.end()) {
            continue;
        }
        tasksDone.push_back(first.task);
        std::vector<Choice> rivals;
        for (const Choice& each : choices) {
            if (each.task == first.task) {
                rivals.push_back(each);
            }
        }
        std::stable_sort(rivals.begin(), rivals.end(), [](const Choice& a, const Choice& b) {
            return a.milliseconds != b.milliseconds ? a.milliseconds < b.milliseconds
                                                    : a.error < b.error;
        });
        // Each in turn costs more than those before it; it must be worth that.
        const std::size_t begin = front.size();
        for (const Choice& each : rivals) {
            if (front.size() == begin || each.error < front.back().error) {
                front.push_back(each);
            }
        }
    }
    return front;
}

DataTable adviceTable(std::span<const Choice> choices) {
    DataTable table{{{"task", "for"},
                     {"milliseconds", "if you can afford [ms]"},
                     {"method", "use"},
                     {"result", "and you get"},
                     {"error", "error"}},
                    {}};
    for (const Choice& each : paretoFront(choices)) {
        table.add({each.task, each.milliseconds, each.method, each.result, each.error});
    }
    return table;
}

}  // namespace hashphase::demos
