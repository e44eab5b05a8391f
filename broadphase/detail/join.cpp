// SPDX-License-Identifier: Zlib
#include <broadphase/detail/join.hpp>

#include <algorithm>
#include <tuple>

namespace hashphase::detail {

namespace {

// About how many rows of `level` a box that is filed on `own` looks up, in rows or in boxes that are
// read instead, which are faster by this factor.
constexpr double kBoxesPerRowRead = 8;

template <class Scalar>
double rowsLookedUp(const Level<Scalar>& own, const Level<Scalar>& level) {
    double rows = static_cast<double>(level.count()) / kBoxesPerRowRead;
    if (!level.hasCells) {
        return rows;
    }
    double byCells = 1;
    for (const std::size_t axis : {std::size_t{1}, std::size_t{2}}) {
        const auto cellsPerEdge =
            static_cast<double>(own.largestEdge) * static_cast<double>(level.inverseCellSize[axis]);
        byCells *= level.inverseCellSize[axis] == 0 ? 1 : cellsPerEdge + 2;
    }
    // Listed boxes are of any size.
    return own.hasCells ? std::min(rows, byCells) : rows;
}

// The boxes of either level may be looked up among those of the other one. Mostly the small ones
// look for the large ones, of which there are few in each row; but a few large ones, or a few that
// are filed far away, had better look for the small ones themselves.
template <class Scalar>
void joinLevels(const Table<Scalar>& table, const Level<Scalar>& a, const Level<Scalar>& b,
                PairSink& sink, KernelCost& cost) {
    const double fromA = a.count() * rowsLookedUp(a, b);
    const double fromB = b.count() * rowsLookedUp(b, a);
    const auto& [from, to] = fromA <= fromB ? std::tie(a, b) : std::tie(b, a);
    kernels<Scalar>().walkLevel(table.view(to), table.columns().data(), from.firstEntry,
                                from.lastEntry, sink, cost);
}

}  // namespace

template <class Scalar>
void joinTable(const Table<Scalar>& table, PairList& found, KernelCost& cost) {
    const Kernels<Scalar>& kernel = kernels<Scalar>();
    const auto levels = table.levels();
    found.append([&](PairSink& sink) {
        for (std::size_t i = 0; i < levels.size(); ++i) {
            const Level<Scalar>& level = levels[i];
            if (level.count() == 0) {
                continue;
            }
            if (level.hasCells) {
                kernel.joinLevel(table.view(level), level.firstEntry, level.lastEntry, sink, cost);
            } else {
                kernel.joinList(table.columns().data(), level.firstEntry, level.lastEntry, sink,
                                cost);
            }
            for (const Level<Scalar>& other : levels.subspan(i + 1)) {
                if (other.count() > 0) {
                    joinLevels(table, level, other, sink, cost);
                }
            }
        }
    });
}

template <class Scalar>
void walkTable(const Table<Scalar>& table, const Columns<Scalar>& queries, std::uint32_t count,
               PairList& found, KernelCost& cost) {
    const Kernels<Scalar>& kernel = kernels<Scalar>();
    found.append([&](PairSink& sink) {
        for (const Level<Scalar>& level : table.levels()) {
            if (level.count() > 0) {
                kernel.walkLevel(table.view(level), queries.data(), 0, count, sink, cost);
            }
        }
    });
}

template void joinTable<float>(const Table<float>&, PairList&, KernelCost&);
template void joinTable<double>(const Table<double>&, PairList&, KernelCost&);
template void walkTable<float>(const Table<float>&, const Columns<float>&, std::uint32_t, PairList&,
                               KernelCost&);
template void walkTable<double>(const Table<double>&, const Columns<double>&, std::uint32_t,
                                PairList&, KernelCost&);

}  // namespace hashphase::detail
