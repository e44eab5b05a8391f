// SPDX-License-Identifier: Zlib
#include <demos/swarm/swarm_report.hpp>

#include <demos/console/format.hpp>
#include <demos/report/report_text.hpp>
#include <demos/report/statistics.hpp>

#include <algorithm>
#include <array>
#include <ostream>
#include <string>

namespace hashphase::demos {
namespace {

struct RankNumber {
    const char* name;
    const char* title;
    double RankFrame::*number;
    double unit;  // divides what is shown
};

constexpr std::array kNumbers{
    RankNumber{"objects", "spheres", &RankFrame::objects, 1},
    RankNumber{"ghosts", "ghosts", &RankFrame::ghosts, 1},
    RankNumber{"place_ms", "place [ms]", &RankFrame::place, 1},
    RankNumber{"cut_ms", "balance", &RankFrame::rebalance, 1},
    RankNumber{"tell_ms", "move, tell", &RankFrame::tell, 1},
    RankNumber{"wait_ms", "wait", &RankFrame::wait, 1},
    RankNumber{"pairs_ms", "pairs", &RankFrame::pairs, 1},
    RankNumber{"whole_ms", "whole", &RankFrame::whole, 1},
    RankNumber{"sent_kib", "sent [KiB]", &RankFrame::bytes, 1024},
    RankNumber{"messages", "messages", &RankFrame::messages, 1},
    RankNumber{"migrated", "moving on", &RankFrame::migrated, 1},
    RankNumber{"load", "load", &RankFrame::load, 1},
};

template <class Number>
double median(std::size_t begin, std::size_t end, const Number& number) {
    std::vector<double> numbers;
    for (std::size_t i = begin; i < end; ++i) {
        numbers.push_back(number(i));
    }
    std::ranges::sort(numbers);
    return numbers.empty() ? 0 : percentile(numbers, 0.5);
}

std::size_t firstFrame(const SwarmResult& result) {
    return result.frames.size() > 1 ? 1 : 0;  // in the first one, all pairs begin
}

double imbalance(const std::vector<RankFrame>& ranks) {
    double sum = 0;
    double most = 0;
    for (const RankFrame& rank : ranks) {
        sum += rank.load;
        most = std::max(most, rank.load);
    }
    return sum > 0 ? most * static_cast<double>(ranks.size()) / sum : 1;
}

double slowest(const std::vector<RankFrame>& ranks) {
    return std::ranges::max(ranks, {}, &RankFrame::whole).whole;
}

void printBalance(const SwarmResult& result, std::ostream& out) {
    const auto cuts = std::ranges::count(result.wasRebalanced, true);
    double worst = 1;
    for (std::size_t i = firstFrame(result); i < result.frames.size(); ++i) {
        worst = std::max(worst, imbalance(result.frames[i]));
    }
    out << "Imbalance (the most loaded rank by the mean): "
        << fixed(imbalance(result.frames.back()), 3) << " in the last frame, " << fixed(worst, 3)
        << " at worst; space was cut again " << cuts << (cuts == 1 ? " time.\n" : " times.\n");
}

void printTraffic(const SwarmResult& result, std::ostream& out) {
    const auto sumOf = [&](std::size_t frame, double RankFrame::*number) {
        double sum = 0;
        for (const RankFrame& rank : result.frames[frame]) {
            sum += rank.*number;
        }
        return sum;
    };
    const auto mid = [&](double RankFrame::*number) {
        return median(firstFrame(result), result.frames.size(),
                      [&](std::size_t i) { return sumOf(i, number); });
    };
    const double ghosts = mid(&RankFrame::ghosts);
    out << "All ranks, a frame: " << byteSize(static_cast<std::int64_t>(mid(&RankFrame::bytes)))
        << " in " << fixed(mid(&RankFrame::messages), 0) << " messages; "
        << withThousands(static_cast<std::uint64_t>(ghosts)) << " ghosts, "
        << fixed(100 * ghosts / mid(&RankFrame::objects), 2) << " % of the spheres.\n";
}

// The first thing in which ranks and one process differ; empty where they agree.
std::string differenceOf(const SwarmResult& result, const SingleResult& alone) {
    for (std::size_t frame = 0; frame < result.sums.size(); ++frame) {
        const FrameSums& ours = result.sums[frame];
        const FrameSums& theirs = alone.sums[frame];
        if (!(ours == theirs)) {
            return "In frame " + std::to_string(frame) + " the ranks report " +
                   withThousands(ours.born.count) + " births and " +
                   withThousands(ours.died.count) + " deaths, one process " +
                   withThousands(theirs.born.count) + " and " + withThousands(theirs.died.count) +
                   ", or others.";
        }
    }
    return result.last == alone.last
               ? std::string()
               : "After the last frame the ranks have " + withThousands(result.last.count) +
                     " pairs, one process " + withThousands(alone.last.count) + ", or others.";
}

}  // namespace

DataTable ranksTable(const SwarmResult& result) {
    DataTable table;
    table.columns.push_back({"rank", "rank"});
    for (const RankNumber& number : kNumbers) {
        table.columns.push_back({number.name, number.title});
    }
    for (std::uint32_t rank = 0; rank < result.ranks; ++rank) {
        std::vector<Value> row{static_cast<double>(rank)};
        for (const RankNumber& number : kNumbers) {
            row.emplace_back(
                median(firstFrame(result), result.frames.size(),
                       [&](std::size_t i) { return result.frames[i][rank].*number.number; }) /
                number.unit);
        }
        table.add(std::move(row));
    }
    return table;
}

DataTable framesTable(const SwarmResult& result) {
    DataTable table;
    table.columns = {{"frame"}, {"rank"}};
    for (const RankNumber& number : kNumbers) {
        table.columns.push_back({number.name});
    }
    table.columns.push_back({"imbalance"});
    table.columns.push_back({"cut"});
    for (std::size_t frame = 0; frame < result.frames.size(); ++frame) {
        for (std::uint32_t rank = 0; rank < result.ranks; ++rank) {
            std::vector<Value> row{static_cast<double>(frame), static_cast<double>(rank)};
            for (const RankNumber& number : kNumbers) {
                row.emplace_back(result.frames[frame][rank].*number.number / number.unit);
            }
            row.emplace_back(imbalance(result.frames[frame]));
            row.emplace_back(result.wasRebalanced[frame] ? 1.0 : 0.0);
            table.add(std::move(row));
        }
    }
    return table;
}

void printSwarm(const SwarmResult& result, const std::optional<SingleResult>& alone,
                std::ostream& out) {
    out << "Median over the frames, milliseconds of each phase:\n";
    printTable(ranksTable(result), out);
    printBalance(result, out);
    printTraffic(result, out);
    const std::size_t begin = firstFrame(result);
    const double together = median(begin, result.frames.size(),
                                   [&](std::size_t i) { return slowest(result.frames[i]); });
    out << "A frame of the grid takes " << milliseconds(together) << " ms on " << result.ranks
        << (result.ranks == 1 ? " rank" : " ranks");
    if (alone) {
        const double single =
            median(begin, alone->whole.size(), [&](std::size_t i) { return alone->whole[i]; });
        out << ", " << milliseconds(single)
            << " in one process without MPI: " << ratioText(single / together);
    }
    out << ".\n";
}

bool printComparison(const SwarmResult& result, const SingleRun& alone, std::ostream& out) {
    if (!alone.result) {
        out << "Not compared with one process" << (alone.fault.empty() ? "" : ": ") << alone.fault
            << ".\n";
        return alone.fault.empty();
    }
    const std::string difference = differenceOf(result, *alone.result);
    out << (difference.empty()
                ? "Births and deaths of every frame, and all " + withThousands(result.last.count) +
                      " pairs of the last, are those of one process, each once."
                : "WRONG: " + difference)
        << '\n';
    return difference.empty();
}

}  // namespace hashphase::demos
