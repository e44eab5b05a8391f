// SPDX-License-Identifier: Zlib
#include <broadphase/detail/join.hpp>

namespace hashphase::detail {

// Of two levels, either one's boxes may be looked up among the other's. A box looks at the more rows
// the larger it is, but finds the more in each; a small one among large ones mostly finds nothing.
// TODO
template <class Scalar>
void joinTable(const Table<Scalar>& table, PairList& found, KernelCost& cost) {
    const auto levels = table.levels();
    const Kernels<Scalar>& kernel = kernels<Scalar>();
    const Columns<Scalar> columns = table.columns();
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const Level<Scalar>& level = levels[i];
        if (level.count() == 0) {
            continue;
        }
        found.append([&](PairSink& sink) {
            if (level.hasCells) {
                kernel.joinLevel(table.view(level), level.firstEntry, level.lastEntry, sink, cost);
            } else {
                kernel.joinList(columns.data(), level.firstEntry, level.lastEntry, sink, cost);
            }
            for (const Level<Scalar>& coarser : levels.subspan(i + 1)) {
                if (coarser.count() > 0) {
                    kernel.walkLevel(table.view(coarser), columns.data(), level.firstEntry,
                                     level.lastEntry, sink, cost);
                }
            }
        });
    }
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
